"""PixelMask: the solid pixels of a sprite as a shape."""

import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.checks import Pair
from physics.raster.bits import packed
from physics.raster.rotate import Turned, bucket_of, turn
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes.blocks import solid_blocks
from physics.shapes.mass import NOTHING, Mass
from physics.shapes.own_values import OwnValues
from physics.shapes.tiles import bools
from physics.vec2 import Vec2

LARGEST = 1 << 15  # [px] a side of what a mask is scaled to: 128 MB of pixels


class PixelMask(OwnValues):
    """The solid pixels of a sprite: pixel (i, j) is the square [i, i+1) x [j, j+1), less the origin.

    Tested as it is drawn, on the pixel grid and at angles in buckets, by AND of packed 64-bit words.
    """

    def __init__(self, solid: ArrayLike, origin: Pair | None = None, snap: bool = True) -> None:
        solid = bools("solid", solid)
        if snap is not True:
            raise ValueError(f"snap must be True (got {checks.shown(snap)}): masks are tested as drawn")
        height, width = solid.shape
        self.snap = True
        self.size = (width, height)
        self.origin = Vec2(width / 2.0, height / 2.0) if origin is None else checks.vector("origin", origin)
        self.solid = solid
        solid.flags.writeable = False
        self._turned, self._blocks = {}, {}
        self.fitted = {}  # tier -> the shapes that stand for it, kept by fitting.fit

    @classmethod
    def from_array(cls, solid: ArrayLike, origin: Pair | None = None, snap: bool = True) -> "PixelMask":
        """From solid[row, col]; origin in pixels, None = the image centre. Raises ValueError, TypeError."""
        return cls(solid, origin, snap)

    @classmethod
    def from_surface(
        cls, surface: Any, threshold: int = 127, origin: Pair | None = None, snap: bool = True
    ) -> "PixelMask":
        """From a pygame surface: solid where alpha > threshold; a colour key is clear. Raises TypeError."""
        import pygame  # the one door through which sprites enter

        if not isinstance(surface, pygame.Surface):
            raise TypeError(f"surface must be a pygame.Surface (got {checks.shown(surface)})")
        threshold = checks.whole("threshold", threshold, 0, 255)
        if 0 in surface.get_size():
            return cls(np.zeros(surface.get_size()[::-1], bool), origin, snap)
        solid = pygame.surfarray.array_alpha(surface) > threshold
        if surface.get_colorkey() is not None:
            solid &= pygame.surfarray.array_colorkey(surface) > 0
        return cls(np.ascontiguousarray(solid.T), origin, snap)

    @classmethod
    def from_mask(cls, mask: Any, origin: Pair | None = None, snap: bool = True) -> "PixelMask":
        """From a pygame Mask; origin in pixels, None = the image centre. Raises TypeError, ValueError."""
        import pygame

        if not isinstance(mask, pygame.Mask):
            raise TypeError(f"mask must be a pygame.Mask (got {checks.shown(mask)})")
        if 0 in mask.get_size():
            return cls(np.zeros(mask.get_size()[::-1], bool), origin, snap)
        drawn = mask.to_surface(setcolor=(255, 255, 255, 255), unsetcolor=(0, 0, 0, 0))
        return cls(np.ascontiguousarray(pygame.surfarray.array_alpha(drawn).T > 0), origin, snap)

    def flipped(self, x: bool = False, y: bool = False) -> "PixelMask":
        """Mirrored left to right (x) and top to bottom (y), with its origin and own values. Raises TypeError."""
        x, y = checks.flag("x", x), checks.flag("y", y)
        width, height = self.size
        origin = (width - self.origin[0] if x else self.origin[0], height - self.origin[1] if y else self.origin[1])
        return PixelMask(self.solid[:: -1 if y else 1, :: -1 if x else 1], origin).with_values_of(self)

    def scaled(self, factor: float) -> "PixelMask":
        """Larger or smaller, with its origin and own values: each pixel is the one that its centre comes from.

        A side of n px becomes n · factor, rounded, at least 1. Raises TypeError, and ValueError for a factor that is
        not > 0, or that makes a side of more than 32768 px.
        """
        factor = checks.number("factor", factor, above=0.0)
        if max(self.size) * factor > LARGEST:
            raise ValueError(f"factor must leave a {self} within {LARGEST} px a side (got {factor})")
        columns, rows = (_nearest(size, factor) for size in self.size)
        origin = (self.origin[0] * factor, self.origin[1] * factor)
        return PixelMask(self.solid[np.ix_(rows, columns)], origin).with_values_of(self)

    def turned(self, angle: float = 0.0) -> Turned:
        """The mask at the angle bucket nearest to `angle` [rad], cached; always turned from the source."""
        return self.turned_to(bucket_of(checks.number("angle", angle), MASK_ANGLE_BUCKETS))

    def turned_to(self, bucket: int) -> Turned:
        if bucket not in self._turned:
            self._turned[bucket] = turn(self.solid, self.origin, bucket, MASK_ANGLE_BUCKETS)
        return self._turned[bucket]

    def blocks(self, bucket: int) -> list[tuple[int, int, int, int]]:
        """Blocks (left, top, right, bottom) of its solid pixels when it is turned to an angle bucket."""
        if bucket not in self._blocks:
            self._blocks[bucket] = solid_blocks(self.turned_to(bucket).solid)
        return self._blocks[bucket]

    @cached_property
    def words(self) -> np.ndarray:
        """(h, ceil(w/64)) uint64: bit b of word k in a row is x = 64k + b."""
        return packed(self.solid)

    @cached_property
    def area(self) -> int:
        """Solid pixels."""
        return int(self.solid.sum())

    @cached_property
    def centroid(self) -> Vec2 | None:
        """Mean of the solid pixels' centres in body space [px]; None when there is none."""
        rows, columns = np.nonzero(self.solid)
        if not len(rows):
            return None
        return Vec2(float(columns.mean()) + 0.5 - self.origin[0], float(rows.mean()) + 0.5 - self.origin[1])

    @cached_property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """(min_x, min_y, max_x, max_y) of the solid pixels in body space [px]; None when there is none."""
        rows, columns = np.nonzero(self.solid)
        if not len(rows):
            return None
        x, y = self.origin
        return (columns.min() - x, rows.min() - y, columns.max() + 1 - x, rows.max() + 1 - y)

    @property
    def smallest_half(self) -> float:
        if self.bounds is None:
            return 0.5
        return min(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]) / 2.0

    def mass_of(self, density: float) -> Mass:
        """Of the union of pixel squares: each adds 1/6 to the second moment about its own centre."""
        if self.area == 0:
            return NOTHING
        rows, columns = np.nonzero(self.solid)
        x, y = columns + (0.5 - self.origin[0]), rows + (0.5 - self.origin[1])
        center = Vec2(float(x.mean()), float(y.mean()))
        second = float(((x - center[0]) ** 2 + (y - center[1]) ** 2).sum()) + self.area / 6.0
        return Mass(density * self.area, center, density * second)

    def reach(self, x: float, y: float) -> float:
        if self.bounds is None:
            return 0.0
        left, top, right, bottom = self.bounds
        return float(np.hypot(max(x - left, right - x), max(y - top, bottom - y)))

    def __repr__(self):
        return f"PixelMask({self.size[0]} x {self.size[1]}, {self.area} solid, origin {self.origin})"


def _nearest(size: int, factor: float) -> np.ndarray:
    """Of each pixel of a scaled side, the pixel that its centre comes from."""
    wanted = max(1, math.floor(size * factor + 0.5)) if size else 0
    return np.minimum(((np.arange(wanted) + 0.5) / factor).astype(np.int64), size - 1)
