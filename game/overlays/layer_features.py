"""Feature ids of contact points.

A feature id is the number of a corner or face, and identifies the point in later steps.
"""

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import PAPER, SERIES
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_contacts import seen_points
from physics import World, debug

FEATURE_BUDGET = 150  # contacts per picture
PER_LINK = 4096  # feature id on a chain or grid: PER_LINK times the number of the link or tile run, plus the corner


class Features(Layer):
    """The feature id of each contact point, in a colour that depends on the id.

    Id and colour stay the same while a body slides.
    """

    name, title, key, color = "features", "Feature ids", "f", PAPER

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = FEATURE_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the contact points of a world. lens: maps world to frame coordinates."""
        rows = debug.contact_points(world)
        self.total += len(rows)
        if len(rows) == 0:
            return
        across, down = lens.points(rows["point_x"], rows["point_y"])
        seen = seen_points(lens, across, down)[: self.room]
        features = rows["feature"][seen].tolist()
        for x, y, feature in zip(across[seen].tolist(), down[seen].tolist(), features, strict=True):
            color = frame.tone(SERIES[feature % len(SERIES)])
            pygame.draw.circle(frame.surface, color, (x, y), frame.scale)
            self.labels.append((text_of(feature), x, y, color))

    def draw_labels(self, frame: Frame) -> None:
        """Write each feature id beside its point, at the first of four positions where it covers no other text."""
        scale = frame.text_scale
        for text, x, y, color in self.labels:
            for dx, dy, align in ((3, -7, "left"), (-3, -7, "right"), (3, 3, "left"), (-3, 3, "right")):
                if frame.text_if_free(text, x + dx * scale, y + dy * scale, color, SMALL, scale, align, True):
                    self.drawn += 1
                    break

    def notes(self) -> list[LegendLine]:
        """Return the layer's lines for the legend, a list of (color, text).

        The legend counts the contact points, because the ids are written after the legend.
        """
        return [(self.color, f"feature ids {len(self.labels)} of {self.total}, where room")]


def text_of(feature: int) -> str:
    """Return a feature id as text: a number, or "link:corner" for chains and tiles."""
    link, corner = divmod(int(feature), PER_LINK)
    return f"{link}:{corner}" if link else f"{corner}"
