"""Feature ids: numbers of the corners or faces that identify a contact point from step to step."""

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
    """The feature id of each contact point, with a colour for each id. Both stay the same while a body slides."""

    name, title, key, color = "features", "Feature ids", "f", PAPER

    def begin(self, views: int = 1) -> None:
        """Start a new picture. Its `views` views share the limit of drawn objects evenly."""
        self.drawn = self.total = 0
        self.room = FEATURE_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the contact points of a world; lens: maps world to frame coordinates."""
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
        """Write each id beside its point, at the first free one of four places."""
        scale = frame.text_scale
        for text, x, y, color in self.labels:
            for dx, dy, align in ((3, -7, "left"), (-3, -7, "right"), (3, 3, "left"), (-3, 3, "right")):
                if frame.text_if_free(text, x + dx * scale, y + dy * scale, color, SMALL, scale, align, True):
                    self.drawn += 1
                    break

    def notes(self) -> list[LegendLine]:
        """Return (color, text) lines for the legend.

        The count is that of the points, because the ids are written after the legend.
        """
        return [(self.color, f"feature ids {len(self.labels)} of {self.total}, where room")]


def text_of(feature: int) -> str:
    """Return a feature id as text: a number, or "link:corner" on chains and tiles."""
    link, corner = divmod(int(feature), PER_LINK)
    return f"{link}:{corner}" if link else f"{corner}"
