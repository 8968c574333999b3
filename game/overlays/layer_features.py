"""Feature ids: the corner or face that identifies a contact point from step to step."""

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import PAPER, SERIES
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_contacts import seen_points
from physics import World, debug

FEATURE_BUDGET = 150  # contacts per picture
PER_LINK = 4096  # feature of a chain or grid: number of the link or run times this, plus the corner on it


class Features(Layer):
    """Number of each contact point, in its colour. While a body slides, number and colour stay."""

    name, title, key, color = "features", "Feature ids", "f", PAPER

    def begin(self, views: int = 1) -> None:
        """Start a picture of `views` views, which share the budget evenly."""
        self.drawn = self.total = 0
        self.room = FEATURE_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw one world through one lens."""
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
        """Write the numbers above or below their points, left or right, where there is room."""
        scale = frame.text_scale
        for text, x, y, color in self.labels:
            for dx, dy, align in ((3, -7, "left"), (-3, -7, "right"), (3, 3, "left"), (-3, 3, "right")):
                if frame.text_if_free(text, x + dx * scale, y + dy * scale, color, SMALL, scale, align, True):
                    self.drawn += 1
                    break

    def notes(self) -> list[LegendLine]:
        """Return (color, text) lines for the legend. Labels are drawn after the legend, so it counts points."""
        return [(self.color, f"feature ids {len(self.labels)} of {self.total}, where room")]


def text_of(feature: int) -> str:
    """Return a feature as text: link:corner on chains and tiles."""
    link, corner = divmod(int(feature), PER_LINK)
    return f"{link}:{corner}" if link else f"{corner}"
