"""Candidate pairs: the pairs of shapes that the broad phase and the filter pass on to the narrow phase."""

import numpy as np
import pygame

from game.drawing.colors import RED
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from physics import World, debug

PAIR_BUDGET = 1500  # lines per picture; the note says how many pairs there are
MISS = (150, 140, 190)


class Pairs(Layer):
    """A line between the shapes of each candidate pair: red if the narrow phase found a hit, otherwise grey."""

    name, title, key, color = "pairs", "Candidate pairs", "4", RED

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = self.hits = 0
        self.room = PAIR_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the candidate pairs of a world. lens: maps world to frame coordinates."""
        rows = debug.pairs(world)
        self.total += len(rows)
        if len(rows) == 0:
            return
        self.hits += int(np.count_nonzero(rows[:, 4]))
        corners = np.column_stack(
            (
                np.minimum(rows[:, 0], rows[:, 2]),
                np.minimum(rows[:, 1], rows[:, 3]),
                np.maximum(rows[:, 0], rows[:, 2]),
                np.maximum(rows[:, 1], rows[:, 3]),
            )
        )
        seen = np.flatnonzero(lens.seen(corners))
        seen = seen[np.argsort(-rows[seen, 4], kind="stable")][: self.room]
        self.drawn += len(seen)
        x0, y0 = lens.points(rows[seen, 0], rows[seen, 1])
        x1, y1 = lens.points(rows[seen, 2], rows[seen, 3])
        starts, ends = np.column_stack((x0, y0)).tolist(), np.column_stack((x1, y1)).tolist()
        line, surface = pygame.draw.line, frame.surface
        hit, miss = frame.tone(RED), frame.tone(MISS)
        for i in reversed(range(len(seen))):  # hits last, on top
            line(surface, hit if rows[seen[i], 4] else miss, starts[i], ends[i])

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [(self.color, f"pairs {self.drawn} of {self.total}, {self.hits} hit")]
