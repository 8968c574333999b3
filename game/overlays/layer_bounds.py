"""AABBs and bounding motion rectangles: what the broad phase looks at."""

import numpy as np
import pygame

from game.colors import FOG, GREEN, ORANGE, PINK, RED, SKY, faded
from physics import debug

ALONE, STILL, PAIRED, TOUCHING, SENSOR = 0, 1, 2, 3, 4
COLORS = {ALONE: GREEN, STILL: faded(FOG, 0.35), PAIRED: ORANGE, TOUCHING: RED, SENSOR: PINK}
BOX_BUDGET = 3000          # boxes drawn per picture; the note says how many there are


def draw_boxes(frame, lens, rows, colors):
    """Outline (n, 4) world boxes, colors[i] each; what is outside the view is skipped."""
    x0, y0 = lens.points(rows[:, 0], rows[:, 1])
    x1, y1 = lens.points(rows[:, 2], rows[:, 3])
    wide, high = np.maximum(np.ceil(x1 - x0), 1.0) + 1.0, np.maximum(np.ceil(y1 - y0), 1.0) + 1.0
    # A box far larger than the view is cut just outside it: its sides beyond cost time and show nothing.
    clip = lens.clip
    left, top = np.maximum(np.floor(x0), clip.left - 2.0), np.maximum(np.floor(y0), clip.top - 2.0)
    wide = np.minimum(wide - (left - np.floor(x0)), clip.right + 2.0 - left)
    high = np.minimum(high - (top - np.floor(y0)), clip.bottom + 2.0 - top)
    surface, rect = frame.surface, pygame.draw.rect
    tones = {color: frame.tone(color) for color in set(colors)}
    for color, box in zip(colors, np.column_stack((left, top, wide, high)).astype(int).tolist(), strict=True):
        rect(surface, tones[color], box, 1)


class Bounds:
    """The tight AABB of every shape: green alone, orange in a candidate pair, red in contact, grey static."""

    name, title, key, color = "bounds", "Bounding boxes", "1", GREEN

    def begin(self, views=1):
        """Start a picture of so many views, which share the budget evenly."""
        self.drawn = self.total = 0
        self.room = BOX_BUDGET // views

    def draw(self, frame, lens, world):
        """Draw one world through one lens."""
        rows = debug.bounds(world)
        self.total += len(rows)
        seen = np.flatnonzero(lens.seen(rows))[: self.room] if len(rows) else []
        if len(seen) == 0:
            return
        self.drawn += len(seen)
        state = _states(world, debug.shape_rows(world))[seen]
        order = np.argsort(state, kind="stable")     # red last, over its neighbours
        draw_boxes(frame, lens, rows[seen][order], [COLORS[s] for s in state[order].tolist()])

    def notes(self):
        """(color, text) lines for the legend."""
        return [(self.color, f"boxes {self.drawn} of {self.total}"), (ORANGE, "boxes meet"), (RED, "touch")]


def _states(world, shapes):
    ids = shapes["shape"]
    state = np.where(shapes["kind"] == 0, STILL, ALONE)
    state[shapes["sensor"].astype(bool)] = SENSOR
    state[np.isin(ids, world.candidates)] = PAIRED
    contacts = world.contacts
    touching = np.concatenate((contacts["shape_a"], contacts["shape_b"]))
    state[np.isin(ids, touching)] = TOUCHING
    return state


class Motion:
    """The bounding motion rectangle of every moving body: where it is, was and will be in one step."""

    name, title, key, color = "motion", "Motion rectangles", "2", SKY

    def begin(self, views=1):
        """Start a picture of so many views, which share the budget evenly."""
        self.drawn = self.total = 0
        self.room = BOX_BUDGET // views

    def draw(self, frame, lens, world):
        """Draw one world through one lens."""
        rows = debug.motion(world)
        self.total += len(rows)
        if len(rows) == 0:
            return
        seen = np.flatnonzero(lens.seen(rows))[: self.room]
        self.drawn += len(seen)
        draw_boxes(frame, lens, rows[seen], [self.color] * len(seen))

    def notes(self):
        """(color, text) lines for the legend."""
        return [(self.color, f"motion {self.drawn} of {self.total}")]
