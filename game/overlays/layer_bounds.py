"""Bounding boxes, the input of the broad phase: AABBs of shapes, and swept AABBs of bodies.

A swept AABB, also called bounding motion rectangle, covers a body's motion in one step.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.colors import FOG, GREEN, ORANGE, PINK, RED, SKY, Color, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from physics import World, debug

ALONE, STILL, PAIRED, TOUCHING, SENSOR = 0, 1, 2, 3, 4
COLORS = (GREEN, faded(FOG, 0.35), ORANGE, RED, PINK)  # in the order of these states
STAMPED = 48  # [frame px] boxes up to this size are blitted from a cached image
BOX_BUDGET = 3000  # boxes drawn per picture; the note says how many there are


def draw_boxes(frame: Frame, lens: Lens, rows: np.ndarray, palette: Sequence[Color], colors: np.ndarray) -> None:
    """Draw the outlines of boxes at window resolution. Large boxes are drawn first, so that small ones are over them.

    rows: (n, 4) world boxes (min x, min y, max x, max y); palette: list of colours; colors: (n,) index into `palette`
    of each box.
    """
    x0, y0 = lens.points(rows[:, 0], rows[:, 1])
    x1, y1 = lens.points(rows[:, 2], rows[:, 3])
    wide, high = np.maximum(np.ceil(x1 - x0), 1.0) + 1.0, np.maximum(np.ceil(y1 - y0), 1.0) + 1.0
    # A box far larger than the view is clipped just outside it: drawing its sides beyond costs time and shows nothing.
    clip = lens.clip
    left, top = np.maximum(np.floor(x0), clip.left - 2.0), np.maximum(np.floor(y0), clip.top - 2.0)
    wide = np.minimum(wide - (left - np.floor(x0)), clip.right + 2.0 - left)
    high = np.minimum(high - (top - np.floor(y0)), clip.bottom + 2.0 - top)
    tones = [frame.tone(color) for color in palette]
    left, top, wide, high = (each.astype(int) for each in (left, top, wide, high))
    large = (wide > STAMPED) | (high > STAMPED)
    for i in np.flatnonzero(large).tolist():
        pygame.draw.rect(frame.surface, tones[colors[i]], (left[i], top[i], wide[i], high[i]), 1)
    # Each combination of size and colour is looked up once for all boxes that share it.
    small = np.flatnonzero(~large)
    kinds, which = np.unique((colors[small] << 16) | (wide[small] << 8) | high[small], return_inverse=True)
    images = [outline(tones[kind >> 16], kind >> 8 & 255, kind & 255) for kind in kinds.tolist()]
    places = zip(left[small].tolist(), top[small].tolist(), strict=True)
    blit_many(frame.surface, [(images[i], place) for i, place in zip(which.tolist(), places, strict=True)])


@lru_cache(maxsize=2048)
def outline(color: Color, width: int, height: int) -> pygame.Surface:
    """Return an image of the outline of a box of `width` x `height` frame px.

    The images are cached, so that many equal boxes can be drawn by one blit call.
    """
    image = pygame.Surface((width, height))
    clear = (0, 0, 0) if color[:3] != (0, 0, 0) else (255, 255, 255)
    image.fill(clear)
    image.set_colorkey(clear, pygame.RLEACCEL)
    pygame.draw.rect(image, color, image.get_rect(), 1)
    return image


class Bounds(Layer):
    """The tight AABB of every shape: orange if it is in a candidate pair, red if it is in contact, otherwise green.

    AABBs of static shapes are grey, and those of sensors pink.
    """

    name, title, key, color = "bounds", "Bounding boxes", "1", GREEN

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = BOX_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the AABBs of all shapes of a world. lens: maps world to frame coordinates."""
        rows = debug.bounds(world)
        self.total += len(rows)
        seen = np.flatnonzero(lens.seen(rows))[: self.room] if len(rows) else []
        if len(seen) == 0:
            return
        self.drawn += len(seen)
        state = _states(world, debug.shape_rows(world))[seen]
        order = np.argsort(state, kind="stable")  # red last, over its neighbours
        draw_boxes(frame, lens, rows[seen][order], COLORS, state[order])

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [(self.color, f"boxes {self.drawn} of {self.total}"), (ORANGE, "boxes meet"), (RED, "touch")]


def _states(world, shapes):
    ids = np.ascontiguousarray(shapes["shape"])
    state = np.where(shapes["kind"] == 0, STILL, ALONE)
    state[shapes["sensor"].astype(bool)] = SENSOR
    rows = world.reported_rows()
    touching = np.concatenate((rows["parent_a"], rows["parent_b"]))
    for among, value in ((world.candidates.ravel(), PAIRED), (touching, TOUCHING)):
        rows = np.minimum(np.searchsorted(ids, among), len(ids) - 1)
        state[rows[ids[rows] == among]] = value  # a shape removed since the step has no row
    return state


class Motion(Layer):
    """The swept AABB (bounding motion rectangle) of every moving body, which covers the body's motion in one step."""

    name, title, key, color = "motion", "Motion rectangles", "2", SKY

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = BOX_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the swept AABBs of a world's moving bodies. lens: maps world to frame coordinates."""
        rows = debug.motion(world)
        self.total += len(rows)
        if len(rows) == 0:
            return
        seen = np.flatnonzero(lens.seen(rows))[: self.room]
        self.drawn += len(seen)
        draw_boxes(frame, lens, rows[seen], (self.color,), np.zeros(len(seen), int))

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [(self.color, f"motion {self.drawn} of {self.total}")]
