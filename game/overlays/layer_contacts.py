"""Contacts: the points where two shapes touch or are about to touch, with normals, depths and distances."""

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, ORANGE, PINK, SKY, SLATE
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from physics import World, debug

NORMAL_LENGTH = 9.0  # [canvas px] drawn length of a normal, before the depth is added
CONTACT_BUDGET = 800  # contacts per picture; the note says how many there are
LABEL_BUDGET = 40  # depths written out per picture
LEAST_DEPTH = 0.05  # [px] smaller depths are not written
SPECULATIVE, NEW, PERSISTED, SENSOR, ASLEEP = range(5)
STATES = ("speculative", "new", "persisted", "sensor", "asleep")
COLORS = (FOG, GREEN, SKY, PINK, SLATE)


class Contacts(Layer):
    """A dot at each contact point in the colour of its state, with its normal (from A to B) and its depth [px]."""

    name, title, key, color = "contacts", "Contacts and normals", "6", ORANGE

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.states = np.zeros(len(STATES), int)
        self.room = CONTACT_BUDGET // views
        self.labels = []  # (text, x, y, align, colour), drawn after all fixed text is placed

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the contact points of a world. lens: maps world to frame coordinates."""
        rows = debug.contact_points(world)
        self.total += len(rows)
        if len(rows) == 0:
            return
        self.states += np.bincount(rows["state"], minlength=len(STATES))[: len(STATES)]
        x, y = lens.points(rows["point_x"], rows["point_y"])
        seen = seen_points(lens, x, y)[: self.room]
        self.drawn += len(seen)
        columns = (x[seen], y[seen], *(rows[name][seen] for name in ("normal_x", "normal_y", "separation", "state")))
        for x, y, nx, ny, separation, state in zip(*(column.tolist() for column in columns), strict=True):
            self._draw_one(frame, lens, x, y, nx, ny, separation, state)

    def _draw_one(self, frame, lens, x, y, nx, ny, separation, state):
        depth = max(0.0, -separation)
        reach = NORMAL_LENGTH * frame.scale + min(depth, 24.0) * lens.scale
        end_x, end_y = x + nx * reach, y + ny * reach
        if state in (SPECULATIVE, ASLEEP):  # no force here: a short line, a hollow dot
            end_x, end_y = x + nx * reach / 2, y + ny * reach / 2
        tone = frame.tone(COLORS[state])
        pygame.draw.line(
            frame.surface,
            frame.tone(ORANGE) if state in (NEW, PERSISTED) else tone,
            (x, y),
            (end_x, end_y),
            max(1, frame.scale - 1),
        )
        hollow = 1 if state in (SPECULATIVE, SENSOR) else 0
        pygame.draw.circle(frame.surface, tone, (x, y), frame.scale + 1 + hollow, hollow)
        if separation > LEAST_DEPTH:  # the gap between the two surfaces, with the point in its middle
            half = separation / 2.0 * lens.scale
            ends = (x - nx * half, y - ny * half), (x + nx * half, y + ny * half)
            pygame.draw.line(frame.surface, tone, *ends, max(1, frame.scale - 1))
            if len(self.labels) < LABEL_BUDGET:
                self.labels.append((f"+{separation:.1f}", end_x, end_y, "left" if nx >= 0 else "right", FOG))
        elif depth > LEAST_DEPTH and len(self.labels) < LABEL_BUDGET:
            self.labels.append((f"{depth:.1f}", end_x, end_y, "left" if nx >= 0 else "right", GOLD))

    def draw_labels(self, frame: Frame) -> None:
        """Write the depths of contacts and the distances of speculative contacts, where they cover no other text."""
        for text, x, y, align, color in self.labels:
            frame.text_if_free(text, x, y, color, SMALL, frame.text_scale, align, True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        states = [(COLORS[i], f"{count} {STATES[i]}") for i, count in enumerate(self.states.tolist()) if count]
        return [(self.color, f"contacts {self.drawn} of {self.total}, px deep, + px apart"), *states]


def seen_points(lens: Lens, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the indices of the points (x, y) [frame px] that are inside the view of `lens`."""
    clip = lens.clip
    return np.flatnonzero((x >= clip.left) & (x < clip.right) & (y >= clip.top) & (y < clip.bottom))
