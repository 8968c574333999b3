"""Overlay of speeds: a line from each dynamic body to its position a quarter of a second later."""

import numpy as np
import pygame

from game.drawing.colors import YELLOW
from game.overlays.layer import Layer
from physics import DYNAMIC

SPEED_BUDGET = 500  # bodies per picture; the note says how many there are
SECONDS = 0.25


class Speeds(Layer):
    """Overlay with a line along the velocity of each dynamic body in the view."""

    name, title, key, color = "speeds", "Speeds", "y", YELLOW

    def begin(self, views=1):
        self.drawn = self.total = 0
        self.room = SPEED_BUDGET // views

    def draw(self, frame, lens, world):
        bodies = world.bodies[world.bodies["kind"] == DYNAMIC]
        x, y = bodies["center_x"], bodies["center_y"]
        seen = np.flatnonzero(lens.seen(np.column_stack((x, y, x, y))))[: self.room]
        self.drawn, self.total = self.drawn + len(seen), self.total + len(bodies)
        starts = np.column_stack(lens.points(x[seen], y[seen]))
        ways = np.column_stack((bodies["vx"][seen], bodies["vy"][seen])) * SECONDS * lens.scale
        for start, way in zip(starts.tolist(), ways.tolist(), strict=True):
            end = (start[0] + way[0], start[1] + way[1])
            pygame.draw.line(frame.surface, frame.tone(self.color), start, end, frame.scale)

    def notes(self):
        return [(self.color, f"speeds {self.drawn} of {self.total}, {SECONDS} s long")]
