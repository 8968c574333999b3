"""PixelMask: the solid pixels of a sprite as a shape. Bounds: the AABB tier of another shape."""

import copy
import math
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.checks import Pair
from physics.math2d import Vec2
from physics.raster.bits import Turned, bucket_of, packed, turn
from physics.raster.pixel_tiles import PixelTiles
from physics.settings import MASK_ANGLE_BUCKETS, SMOOTH
from physics.shapes.outline import outline_of
from physics.shapes.values import (
    NOTHING,
    Capsule,
    Circle,
    EqualByValue,
    Filter,
    Mass,
    Material,
    OwnValues,
    Polygon,
    bools,
    solid_blocks,
)

# ---- mask ------------------------------------------------------------------------------------------------------------
# PixelMask: the solid pixels of a sprite as a shape.

LARGEST = 1 << 15  # [px] a side of what a mask is scaled to: 128 MB of pixels
TURNED_KEPT = 1 << 20  # [px] in all that a mask keeps of itself at other angles: 5 MB, all angles of a sprite of 64 px


class PixelMask(OwnValues):
    """The solid pixels of a sprite: pixel (i, j) is the square [i, i+1) x [j, j+1), less the origin.

    snap=True: tested as it is drawn, on the pixel grid and at angles in buckets, by AND of packed 64-bit words.
    snap=False: the union of its squares at the exact pose. Two snapped masks are tested as drawn, any other two
    exactly. What is pushed, swept or walks meets its outline, smoothed by up to `smooth` [px].

    one_way=True: open from below. What responds meets only the upper side of the outline, and only who was above it:
    what comes from below or from a side, or stands inside, passes. As with one-way tiles, nobody is pushed where the
    effect `one_way` is not declared; verdicts by pixels are what they are without it. For static and kinematic bodies.

    Raises ValueError and TypeError for solid that is no grid of bools, for a smooth that is not a number >= 0, and for
    snap and one_way that are no bools.
    """

    def __init__(
        self,
        solid: ArrayLike,
        origin: Pair | None = None,
        snap: bool = True,
        smooth: float = SMOOTH,
        one_way: bool = False,
    ) -> None:
        solid = bools("solid", solid)
        height, width = solid.shape
        self.snap = checks.flag("snap", snap)
        self.smooth = checks.number("smooth", smooth, low=0.0)
        self.one_way = checks.flag("one_way", one_way)
        self.size = (width, height)
        self.origin = Vec2(width / 2.0, height / 2.0) if origin is None else checks.vector("origin", origin)
        self.carved = False  # whether it is what is left of another
        solid.flags.writeable = False
        self._solid: np.ndarray | None = solid
        self._forget()

    def _forget(self):
        """Nothing that follows from the pixels is known yet."""
        self._turned, self._blocks = {}, {}
        self.fitted = {}  # (tier, tolerance) -> the shapes that stand for it, kept by fit

    def with_tiles(self, tiles: PixelTiles) -> "PixelMask":
        """The same mask with other pixels, in a raster of the same size: what is left of it, once something is gone."""
        found = copy.copy(self.bare)
        for name in ("words", "_sums", "solid_box", "bounds", "centroid", "fingerprint", "outline"):
            vars(found).pop(name, None)
        found.tiles, found.carved, found._solid = tiles, True, None
        found._forget()
        return found.with_values_of(self)

    def with_(
        self,
        material: Material | None = None,
        filter: Filter | None = None,
        sensor: bool | None = None,
        one_way: bool | None = None,
    ) -> "PixelMask":
        """The same mask with values of its own; None: the body's. one_way: open from below or not, None: as it is.

        Raises TypeError.
        """
        wanted = self.one_way if one_way is None else checks.flag("one_way", one_way)
        if wanted == self.one_way:
            return super().with_(material, filter, sensor)
        return self._opened(wanted).with_(material, filter, sensor)

    def _opened(self, wanted):
        """The bare mask that is open from below, or not: one for all, so that a library has it once."""
        # Both share what is known of their pixels, and so this too.
        self.fitted.setdefault("one way", {})[self.one_way] = self.bare
        pair = self.fitted["one way"]
        if wanted not in pair:
            pair[wanted] = copy.copy(self.bare)
            pair[wanted].one_way = wanted
        return pair[wanted]

    def with_values_of(self, other: OwnValues) -> "PixelMask":
        """This mask with the own values of another shape, open from below if that is a mask that is."""
        one_way = other.one_way if isinstance(other, PixelMask) else None
        return self.with_(other.material, other.filter, other.sensor, one_way)

    def like(self, solid: np.ndarray, origin: Pair) -> "PixelMask":
        """A mask of other pixels, told apart and valued as this one."""
        return PixelMask(solid, origin, self.snap, self.smooth).with_values_of(self)

    @property
    def solid(self) -> np.ndarray:
        """solid[row, col] bool, read only."""
        if self._solid is None:
            self._solid = self.tiles.solid
            self._solid.flags.writeable = False
        return self._solid

    @cached_property
    def tiles(self) -> PixelTiles:
        """The same pixels in tiles, some of which can be replaced."""
        return PixelTiles.of(self.solid)

    def window(self, left: int, top: int, size: int) -> np.ndarray:
        """(size, size) bool: its pixels from column left and row top on, clear beyond it."""
        if self._solid is None:
            return self.tiles.window(left, top, size)
        found = np.zeros((size, size), bool)
        inside = self.solid[max(top, 0) : max(top + size, 0), max(left, 0) : max(left + size, 0)]
        y, x = max(-top, 0), max(-left, 0)
        found[y : y + inside.shape[0], x : x + inside.shape[1]] = inside
        return found

    @classmethod
    def from_array(
        cls,
        solid: ArrayLike,
        origin: Pair | None = None,
        snap: bool = True,
        smooth: float = SMOOTH,
        one_way: bool = False,
    ) -> "PixelMask":
        """From solid[row, col]; origin in pixels, None = the image centre. Raises ValueError, TypeError."""
        return cls(solid, origin, snap, smooth, one_way)

    @classmethod
    def from_surface(
        cls,
        surface: Any,
        threshold: int = 127,
        origin: Pair | None = None,
        snap: bool = True,
        smooth: float = SMOOTH,
        one_way: bool = False,
    ) -> "PixelMask":
        """From a pygame surface: solid where alpha > threshold; a colour key is clear. Raises TypeError, ValueError."""
        import pygame  # the one door through which sprites enter

        if not isinstance(surface, pygame.Surface):
            raise TypeError(f"surface must be a pygame.Surface (got {checks.shown(surface)})")
        threshold = checks.whole("threshold", threshold, 0, 255)
        if 0 in surface.get_size():
            return cls(np.zeros(surface.get_size()[::-1], bool), origin, snap, smooth, one_way)
        if surface.get_bytesize() == 4 and surface.get_masks()[3]:
            solid = pygame.surfarray.pixels_alpha(surface) > threshold  # a seventh of array_alpha's time
        else:
            solid = pygame.surfarray.array_alpha(surface) > threshold
        if surface.get_colorkey() is not None:
            solid &= pygame.surfarray.array_colorkey(surface) > 0
        return cls(np.ascontiguousarray(solid.T), origin, snap, smooth, one_way)

    @classmethod
    def from_mask(
        cls, mask: Any, origin: Pair | None = None, snap: bool = True, smooth: float = SMOOTH, one_way: bool = False
    ) -> "PixelMask":
        """From a pygame Mask; origin in pixels, None = the image centre. Raises TypeError, ValueError."""
        import pygame

        if not isinstance(mask, pygame.Mask):
            raise TypeError(f"mask must be a pygame.Mask (got {checks.shown(mask)})")
        if 0 in mask.get_size():
            return cls(np.zeros(mask.get_size()[::-1], bool), origin, snap, smooth, one_way)
        drawn = mask.to_surface(setcolor=(255, 255, 255, 255), unsetcolor=(0, 0, 0, 0))
        return cls(np.ascontiguousarray(pygame.surfarray.array_alpha(drawn).T > 0), origin, snap, smooth, one_way)

    def flipped(self, x: bool = False, y: bool = False) -> "PixelMask":
        """Mirrored left to right (x) and top to bottom (y), with its origin and own values. Raises TypeError."""
        x, y = checks.flag("x", x), checks.flag("y", y)
        width, height = self.size
        origin = (width - self.origin[0] if x else self.origin[0], height - self.origin[1] if y else self.origin[1])
        solid = self.solid[:: -1 if y else 1, :: -1 if x else 1]
        return PixelMask(solid, origin, self.snap, self.smooth).with_values_of(self)

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
        return PixelMask(self.solid[np.ix_(rows, columns)], origin, self.snap, self.smooth).with_values_of(self)

    def turned(self, angle: float = 0.0) -> Turned:
        """The mask at the angle bucket nearest to `angle` [rad]; always turned from the source.

        Cached, of large masks at the latest angles only. Raises TypeError and ValueError for what is no angle.
        """
        return self.turned_to(self.bucket_at(angle))

    def bucket_at(self, angle: float) -> int:
        """Which of the angle buckets (128 to a full turn) is nearest to `angle` [rad]. Raises as `turned`."""
        return bucket_of(checks.number("angle", angle), MASK_ANGLE_BUCKETS)

    def turned_to(self, bucket: int) -> Turned:
        known = self._turned
        if bucket not in known:
            known[bucket] = turn(self.solid, self.origin, bucket, MASK_ANGLE_BUCKETS)
            kept = sum(each.solid.size for each in known.values())
            while kept > TURNED_KEPT and len(known) > 1:  # the oldest: what turns on does not come back to it soon
                kept -= known.pop(next(iter(known))).solid.size
        return known[bucket]

    def blocks(self, bucket: int) -> list[tuple[int, int, int, int]]:
        """Blocks (left, top, right, bottom) of its solid pixels when it is turned to an angle bucket."""
        if bucket not in self._blocks:
            self._blocks[bucket] = solid_blocks(self.turned_to(bucket).solid)
        return self._blocks[bucket]

    @cached_property
    def words(self) -> np.ndarray:
        """(h, ceil(w/64)) uint64: bit b of word k in a row is x = 64k + b."""
        return self.tiles.packed[: self.size[1]] if "tiles" in vars(self) else packed(self.solid)

    @cached_property
    def _sums(self):
        """(pixels, sums of their columns, of their rows, of the squares of both), exactly."""
        if "tiles" in vars(self):
            return self.tiles.sums
        rows, columns = np.nonzero(self.solid)
        return len(rows), int(columns.sum()), int(rows.sum()), int((columns * columns + rows * rows).sum())

    @property
    def area(self) -> int:
        """Solid pixels."""
        return self._sums[0]

    @cached_property
    def centroid(self) -> Vec2 | None:
        """Mean of the solid pixels' centres in body space [px]; None when there is none."""
        count, x, y, _ = self._sums
        return Vec2(x / count + 0.5 - self.origin[0], y / count + 0.5 - self.origin[1]) if count else None

    @cached_property
    def solid_box(self) -> tuple[int, int, int, int] | None:
        """(left, top, right, bottom) of the solid pixels in the raster, the last two exclusive; None without any."""
        if "tiles" in vars(self):
            return self.tiles.bounds
        columns, rows = (np.flatnonzero(self.solid.any(axis=axis)).tolist() for axis in (0, 1))
        return (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1) if rows else None

    @cached_property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """(min_x, min_y, max_x, max_y) of the solid pixels in body space [px]; None when there is none."""
        if self.solid_box is None:
            return None
        left, top, right, bottom = self.solid_box
        x, y = self.origin
        return (left - x, top - y, right - x, bottom - y)

    @cached_property
    def fingerprint(self) -> bytes:
        """What tells its pixels from others: 16 bytes."""
        return blake2b(self.words.tobytes(), digest_size=16).digest()

    @cached_property
    def outline(self) -> tuple[Circle | Capsule | Polygon, ...]:
        """The convex shapes in body space whose union is the mask's outline; () for a mask without pixels.

        What response, sweeps and characters meet, at the exact pose. Each point of the outline is within `smooth` px
        of the pixels' edges, each point of those within smooth + 0.21 of the outline; 0: the edges themselves. Pieces
        and holes are kept, every solid pixel's centre is inside and every clear one's outside, and a corner between
        straight runs of 3 px and more stays sharp. A round piece is one Circle or Capsule, or a Polygon with a radius
        (a Circle and the edges may be 0.13 px farther from each other, and clear centres 0.2 px inside it); a full
        rectangle is its box. No shape shares more than its sides with another.
        """
        return tuple(part.shape for part in outline_of(self))

    @property
    def smallest_half(self) -> float:
        if self.bounds is None:
            return 0.5
        return min(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]) / 2.0

    def mass_of(self, density: float) -> Mass:
        """Of the union of pixel squares: each adds 1/6 to the second moment about its own centre."""
        if self.centroid is None:
            return NOTHING
        count, x, y, squares = self._sums
        # In whole numbers up to the last division: the same whichever way the pixels are kept.
        second = (count * squares - x * x - y * y) / count + count / 6.0
        return Mass(density * count, self.centroid, density * second)

    def reach(self, x: float, y: float) -> float:
        if self.bounds is None:
            return 0.0
        left, top, right, bottom = self.bounds
        return float(np.hypot(max(x - left, right - x), max(y - top, bottom - y)))

    def __repr__(self):
        exact = "" if self.snap else ", snap=False"
        exact += "" if self.smooth == SMOOTH else f", smooth={self.smooth}"
        exact += ", one_way=True" if self.one_way else ""
        return f"PixelMask({self.size[0]} x {self.size[1]}, {self.area} solid, origin {self.origin}{exact})"


def _nearest(size: int, factor: float) -> np.ndarray:
    """Of each pixel of a scaled side, the pixel that its centre comes from."""
    wanted = max(1, math.floor(size * factor + 0.5)) if size else 0
    return np.minimum(((np.arange(wanted) + 0.5) / factor).astype(np.int64), size - 1)


# ---- bounds ----------------------------------------------------------------------------------------------------------
# Bounds: the AABB tier of another shape.


@dataclass(frozen=True)
class Bounds(EqualByValue):
    """The wrapped shape's world AABB at its pose, as a shape: the AABB tier. It has the own values of what it wraps.

    Raises TypeError for what is no Circle, Capsule, Polygon or PixelMask.
    """

    shape: Circle | Capsule | Polygon | PixelMask

    def __post_init__(self):
        if not isinstance(self.shape, (Circle, Capsule, Polygon, PixelMask)):
            raise TypeError(f"shape must be a Circle, Capsule, Polygon or PixelMask (got {checks.shown(self.shape)})")
        inner = self.shape
        object.__setattr__(self, "shape", inner.bare)
        if inner is not inner.bare:
            vars(self).update(vars(copy.copy(self).with_values_of(inner)))

    @property
    def smallest_half(self) -> float:
        return self.shape.smallest_half

    def mass_of(self, density: float) -> Mass:
        return self.shape.mass_of(density)

    def reach(self, x: float, y: float) -> float:
        """Of the AABB at any angle: no corner of it is further from the origin than the shape reaches, times sqrt 2."""
        return math.sqrt(2.0) * self.shape.reach(0.0, 0.0) + math.hypot(x, y)
