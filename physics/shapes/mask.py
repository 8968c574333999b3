"""PixelMask: the solid pixels of a sprite as a shape."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from functools import cached_property
from hashlib import blake2b
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks, hints
from physics.annotations import Pair
from physics.hints import explained
from physics.math2d import Vec2
from physics.raster.bits import Turned, bucket_of, packed, turn
from physics.raster.pixel_tiles import PixelTiles
from physics.settings import MASK_ANGLE_BUCKETS, SMOOTH
from physics.shapes.mass import NOTHING, Mass
from physics.shapes.outline import OutlinePart, Stretch, outline_by_tile, outline_of, surfaces_of
from physics.shapes.placement import turn_of_mask
from physics.shapes.shape import (
    EqualByArrays,
    Filter,
    Material,
    Parts,
    Placed,
    Shape,
    immutable,
    parts_of,
    read_only,
    rectangle,
    turned_parts,
)
from physics.shapes.values import Capsule, Circle, Polygon, bools, solid_blocks
from physics.tables.body import DYNAMIC
from physics.tables.shape import MASK, WHOLE_MASK

LARGEST = 1 << 15  # [px] largest side of a scaled mask: 128 MB of pixels
TURNED_KEPT = 1 << 20  # [px] of rotated copies that a mask caches: 5 MB, all angles of a sprite of 64 px


@immutable
class PixelMask(EqualByArrays):
    """The solid pixels of a sprite as a shape: pixel (i, j) is the square [i, i+1) x [j, j+1), minus the origin.

    PixelMask.from_surface and PixelMask.from_mask make a PixelMask of a pygame Surface or Mask.

    solid: solid pixels, bool [row, col].
    origin: origin of body space in the image (x, y) [px]; None: the centre of the image.
    snap: True: tested as it is drawn, at a whole pixel and at the nearest of 128 angles, by AND of packed 64-bit words.
        False: tested as the union of its squares at the exact pose. Two masks are tested as drawn if both have
        snap=True.
    smooth: greatest distance of the outline from the pixels' edges [px], >= 0. Response, sweeps and characters use the
        outline.
    one_way: whether bodies pass through the mask from below. Only for static and kinematic bodies.

    size: (width, height) of the image [px].

    A one-way mask pushes only with the upper side of its outline, and only bodies that were above that side. Bodies
    that come from below or from a side, or overlap the mask, pass. As with one-way tiles, there is no response without
    the effect `one_way`. Tests by pixels are unaffected. Raises TypeError or ValueError if solid is not a grid of
    bools, if smooth is not a number >= 0, if origin is not a finite point, and if snap or one_way is not a bool.

    >>> ship = PixelMask([[0, 1], [1, 1]], origin=(0, 0))
    >>> ship.area, ship.size
    (3, (2, 2))
    >>> rock = world.add_body(PixelMask.from_surface(pygame.Surface((32, 16))), position=(100, 100))
    """

    snap: bool
    smooth: float
    one_way: bool
    size: tuple[int, int]
    origin: Vec2
    carved: bool  # whether this mask is the remainder of a carved one
    _solid: np.ndarray  # None for a carved mask until its pixels are read
    _turned: dict[int, Turned]  # by angle bucket
    _blocks: dict[int, list[tuple[int, int, int, int]]]  # by angle bucket
    fitted: dict[Any, Any]  # (tier, tolerance) -> the shapes that replace the mask, cached by approximate.fit
    _kind, _has_mass = MASK, True
    _array_names, _value_names = ("words",), ("size", "origin", "snap", "smooth", "one_way")

    @explained
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
        vars(self).update(
            snap=checks.flag("snap", snap),
            smooth=checks.number("smooth", smooth, low=0.0),
            one_way=checks.flag("one_way", one_way),
            size=(width, height),
            origin=Vec2(width / 2.0, height / 2.0) if origin is None else checks.vector("origin", origin),
            carved=False,
            _solid=read_only(solid),
        )
        self._forget()

    def _forget(self):
        """Clear all cached values that are derived from the pixels."""
        vars(self).update(_turned={}, _blocks={}, fitted={})

    def with_tiles(self, tiles: PixelTiles) -> PixelMask:
        """Return a mask of the same size with the given pixels, after carving. All other values are those of this mask.

        tiles: the new pixels, see PixelMask.tiles.
        """
        found = object.__new__(PixelMask)
        kept = {name: vars(self)[name] for name in ("snap", "smooth", "one_way", "size", "origin")}
        vars(found).update(kept, tiles=tiles, carved=True, _solid=None)
        found._forget()
        return found.with_values_of(self)

    def with_(
        self,
        material: Material | None = None,
        filter: Filter | None = None,
        sensor: bool | None = None,
        one_way: bool | None = None,
    ) -> PixelMask:
        """Return a copy of the mask with its own material, filter and sensor, used instead of the body's values.

        material, filter, sensor: a Material, a Filter, a bool; None for each: the body's value applies.
        one_way: whether bodies pass through the mask from below; None: as in this mask.

        Raises TypeError for a value of another type.
        """
        wanted = self.one_way if one_way is None else checks.flag("one_way", one_way)
        if wanted == self.one_way:
            return super().with_(material, filter, sensor)
        return self._opened(wanted).with_(material, filter, sensor)

    def _opened(self, wanted):
        """Return the mask with one_way = wanted, and without its own material, filter and sensor.

        Repeated calls return the same object, so that a library stores the geometry once.
        """
        # The two masks share `fitted`, the values derived from their pixels.
        self.fitted.setdefault("one way", {})[self.one_way] = self.bare
        pair = self.fitted["one way"]
        if wanted not in pair:
            pair[wanted] = copy.copy(self.bare)
            vars(pair[wanted])["one_way"] = wanted
        return pair[wanted]

    def with_values_of(self, other: Shape) -> PixelMask:
        """Return a copy of this mask with the material, filter and sensor of another shape.

        If the other shape is a mask, its one_way is also copied.
        """
        one_way = other.one_way if isinstance(other, PixelMask) else None
        return self.with_(other.material, other.filter, other.sensor, one_way)

    def like(self, solid: np.ndarray, origin: Pair) -> PixelMask:
        """Return a mask with the given pixels [row, col] and origin [px]. Its other values are those of this mask."""
        return PixelMask(solid, origin, self.snap, self.smooth).with_values_of(self)

    @property
    def solid(self) -> np.ndarray:
        """Solid pixels [row, col] bool, read-only."""
        if self._solid is None:
            vars(self)["_solid"] = read_only(self.tiles.solid)
        return self._solid

    @cached_property
    def tiles(self) -> PixelTiles:
        """Pixels stored in square tiles, so that carving can replace single tiles."""
        return PixelTiles.of(self.solid)

    def window(self, left: int, top: int, size: int) -> np.ndarray:
        """Return a square of the mask's pixels, (size, size) bool, whose first pixel is at column `left`, row `top`.

        Pixels outside the mask are clear.
        """
        if self._solid is None:
            return self.tiles.window(left, top, size)
        found = np.zeros((size, size), bool)
        inside = self.solid[max(top, 0) : max(top + size, 0), max(left, 0) : max(left + size, 0)]
        y, x = max(-top, 0), max(-left, 0)
        found[y : y + inside.shape[0], x : x + inside.shape[1]] = inside
        return found

    @classmethod
    @explained
    def from_array(
        cls,
        solid: ArrayLike,
        origin: Pair | None = None,
        snap: bool = True,
        smooth: float = SMOOTH,
        one_way: bool = False,
    ) -> PixelMask:
        """Return a PixelMask made from an array, as the constructor does.

        solid: solid pixels, bool [row, col]; an array of pygame.surfarray is [x, y], and needs .T.
        origin: origin of body space in the image (x, y) [px]; None: the centre of the image.
        snap: True: tested as drawn, on whole pixels; False: at the exact pose.
        smooth: greatest distance of the outline from the pixels' edges [px], >= 0.
        one_way: whether bodies pass through the mask from below.

        Raises TypeError or ValueError for the same arguments as PixelMask.
        """
        return cls(solid, origin, snap, smooth, one_way)

    @classmethod
    @explained
    def from_surface(
        cls,
        surface: Any,
        threshold: int = 127,
        origin: Pair | None = None,
        snap: bool = True,
        smooth: float = SMOOTH,
        one_way: bool = False,
    ) -> PixelMask:
        """Return a PixelMask of the opaque pixels of a pygame surface.

        surface: a pygame.Surface: solid where alpha > threshold, clear where it has its colour key. Without alpha and
            colour key, as after convert(), it is solid everywhere.
        threshold: largest alpha of a clear pixel, 0 to 255.
        origin: origin of body space in the image (x, y) [px]; None: the centre of the image.
        snap: True: tested as drawn, on whole pixels; False: at the exact pose.
        smooth: greatest distance of the outline from the pixels' edges [px], >= 0.
        one_way: whether bodies pass through the mask from below.

        Raises TypeError if surface is not a pygame.Surface, ValueError for a threshold out of range, and the errors of
        PixelMask.
        """
        import pygame  # pygame is needed only for this import of sprites

        if not isinstance(surface, pygame.Surface):
            hint = hints.in_place_of_surface(surface)
            raise TypeError(f"surface must be a pygame.Surface (got {checks.shown(surface)}){hint}")
        threshold = checks.whole("threshold", threshold, 0, 255)
        if 0 in surface.get_size():
            return cls(np.zeros(surface.get_size()[::-1], bool), origin, snap, smooth, one_way)
        if surface.get_bytesize() == 4 and surface.get_masks()[3]:
            solid = pygame.surfarray.pixels_alpha(surface) > threshold  # 7 times faster than array_alpha
        else:
            solid = pygame.surfarray.array_alpha(surface) > threshold
        if surface.get_colorkey() is not None:
            solid &= pygame.surfarray.array_colorkey(surface) > 0
        return cls(np.ascontiguousarray(solid.T), origin, snap, smooth, one_way)

    @classmethod
    @explained
    def from_mask(
        cls, mask: Any, origin: Pair | None = None, snap: bool = True, smooth: float = SMOOTH, one_way: bool = False
    ) -> PixelMask:
        """Return a PixelMask with the set pixels of a pygame Mask.

        mask: a pygame.Mask.
        origin: origin of body space in the image (x, y) [px]; None: the centre of the image.
        snap: True: tested as drawn, on whole pixels; False: at the exact pose.
        smooth: greatest distance of the outline from the pixels' edges [px], >= 0.
        one_way: whether bodies pass through the mask from below.

        Raises TypeError if mask is not a pygame.Mask, and the errors of PixelMask.
        """
        import pygame

        if not isinstance(mask, pygame.Mask):
            hint = hints.in_place_of_surface(mask)
            raise TypeError(f"mask must be a pygame.Mask (got {checks.shown(mask)}){hint}")
        if 0 in mask.get_size():
            return cls(np.zeros(mask.get_size()[::-1], bool), origin, snap, smooth, one_way)
        drawn = mask.to_surface(setcolor=(255, 255, 255, 255), unsetcolor=(0, 0, 0, 0))
        return cls(np.ascontiguousarray(pygame.surfarray.array_alpha(drawn).T > 0), origin, snap, smooth, one_way)

    def flipped(self, x: bool = False, y: bool = False) -> PixelMask:
        """Return a mirrored copy of the mask. Its origin is mirrored too.

        x: True to mirror left to right; y: True to mirror top to bottom.

        snap, smooth, one_way, material, filter and sensor are kept. Raises TypeError for an x or y that is not a bool.
        """
        x, y = checks.flag("x", x), checks.flag("y", y)
        width, height = self.size
        origin = (width - self.origin[0] if x else self.origin[0], height - self.origin[1] if y else self.origin[1])
        solid = self.solid[:: -1 if y else 1, :: -1 if x else 1]
        return PixelMask(solid, origin, self.snap, self.smooth).with_values_of(self)

    def scaled(self, factor: float) -> PixelMask:
        """Return a copy of the mask scaled by nearest-neighbour sampling at pixel centres. Its origin is scaled too.

        factor: > 0. A side of n px becomes n · factor, rounded, at least 1.

        snap, smooth, one_way, material, filter and sensor are kept. Raises TypeError for a factor that is not a number,
        ValueError for a factor <= 0 or one that makes a side longer than 32768 px.
        """
        factor = checks.number("factor", factor, above=0.0)
        if max(self.size) * factor > LARGEST:
            raise ValueError(f"factor must leave a {self} within {LARGEST} px a side (got {factor})")
        columns, rows = (_nearest(size, factor) for size in self.size)
        origin = (self.origin[0] * factor, self.origin[1] * factor)
        return PixelMask(self.solid[np.ix_(rows, columns)], origin, self.snap, self.smooth).with_values_of(self)

    def turned(self, angle: float = 0.0) -> Turned:
        """Return the pixels rotated by an angle, as a Turned. With snap=True, tests by pixels use the result.

        angle: [rad], rounded to the nearest of 128 angles.

        The pixels are always rotated from angle 0, so errors do not add up. Results are cached; for large masks only
        the last one. Raises TypeError or ValueError for an angle that is not a finite number.
        """
        return self.turned_to(self.bucket_at(angle))

    def bucket_at(self, angle: float) -> int:
        """Return the index of the angle bucket nearest to `angle` [rad]. A full turn has 128 angle buckets.

        Raises TypeError or ValueError for an angle that is not a finite number.
        """
        return bucket_of(checks.number("angle", angle), MASK_ANGLE_BUCKETS)

    def turned_to(self, bucket: int) -> Turned:
        known = self._turned
        if bucket not in known:
            known[bucket] = turn(self.solid, self.origin, bucket, MASK_ANGLE_BUCKETS)
            for array in (known[bucket].solid, known[bucket].source_x, known[bucket].source_y):
                read_only(array)
            kept = sum(each.solid.size for each in known.values())
            while kept > TURNED_KEPT and len(known) > 1:  # drop the oldest: a rotating body returns to it last
                kept -= known.pop(next(iter(known))).solid.size
        return known[bucket]

    def blocks(self, bucket: int) -> list[tuple[int, int, int, int]]:
        """Return rectangles that together cover the mask's solid pixels at an angle bucket.

        bucket: index of one of 128 angles. A rectangle is (left, top, right, bottom) [px], right and bottom exclusive.
        """
        if bucket not in self._blocks:
            self._blocks[bucket] = solid_blocks(self.turned_to(bucket).solid)
        return self._blocks[bucket]

    @cached_property
    def words(self) -> np.ndarray:
        """Pixels as bits, (h, ceil(w/64)) uint64, read-only. Bit b of word k in a row is column 64k + b."""
        return read_only(self.tiles.packed[: self.size[1]] if "tiles" in vars(self) else packed(self.solid))

    @cached_property
    def _sums(self):
        """Integer sums over the solid pixels: (number, sum of columns, sum of rows, sum of column² + row²)."""
        if "tiles" in vars(self):
            return self.tiles.sums
        rows, columns = np.nonzero(self.solid)
        return len(rows), int(columns.sum()), int(rows.sum()), int((columns * columns + rows * rows).sum())

    @property
    def area(self) -> int:
        """Number of solid pixels."""
        return self._sums[0]

    @cached_property
    def centroid(self) -> Vec2 | None:
        """Mean of the solid pixels' centres in body space [px]; None for a mask without solid pixels."""
        count, x, y, _ = self._sums
        return Vec2(x / count + 0.5 - self.origin[0], y / count + 0.5 - self.origin[1]) if count else None

    @cached_property
    def solid_box(self) -> tuple[int, int, int, int] | None:
        """Box (left, top, right, bottom) of the solid pixels, right and bottom exclusive; None if there are none."""
        if "tiles" in vars(self):
            return self.tiles.bounds
        columns, rows = (np.flatnonzero(self.solid.any(axis=axis)).tolist() for axis in (0, 1))
        return (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1) if rows else None

    @cached_property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """Bounding box (min_x, min_y, max_x, max_y) [px] of the solid pixels in body space; None if there are none."""
        if self.solid_box is None:
            return None
        left, top, right, bottom = self.solid_box
        x, y = self.origin
        return (left - x, top - y, right - x, bottom - y)

    @cached_property
    def fingerprint(self) -> bytes:
        """Hash of the pixels, 16 bytes."""
        return blake2b(self.words.tobytes(), digest_size=16).digest()

    @cached_property
    def outline(self) -> tuple[Circle | Capsule | Polygon, ...]:
        """Convex shapes in body space whose union has the mask's outline; () for a mask without solid pixels.

        Contact response, sweeps and characters use these shapes, at the exact pose. Each point of the outline is within
        `smooth` px of the pixels' edges. Each point of these edges is within smooth + 0.21 px of the outline. With
        smooth = 0 the outline is the pixels' edges. Separate pieces and holes are kept. Centres of solid pixels are
        inside, centres of clear pixels outside. A corner between two straight rows of pixel edges, both of 3 px or
        more, stays sharp. A full rectangle becomes a box. The shapes share sides, but no area.

        A round piece becomes one Circle, Capsule or Polygon with a radius. A Circle may be 0.13 px farther from the
        pixels' edges, and may contain centres of clear pixels up to 0.2 px inside it.
        """
        return tuple(part.shape for part in outline_of(self))

    @property
    def min_half_extent(self) -> float:
        if self.bounds is None:
            return 0.5
        return min(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]) / 2.0

    def mass_of(self, density: float) -> Mass:
        """Return the Mass of the solid pixels, as the union of their squares.

        density: mass per area [per px²]; it is not checked.
        """
        if self.centroid is None:
            return NOTHING
        count, x, y, squares = self._sums
        # Integers up to the last division: the result is the same whether the pixels are an array or tiles.
        second = (count * squares - x * x - y * y) / count + count / 6.0
        return Mass(density * count, self.centroid, density * second)

    @property
    def _thinnest_half(self) -> float:
        """Smallest inradius [px] of the outline's convex parts, at least 0.5.

        A body that moves farther than this in a step is swept. The inradius of the whole mask would not be enough:
        sprites of 3 px blocks passed 1 px walls at half their size per step (measured). A part thinner than 1 px counts
        as 1 px thick, because it adjoins a thicker part.
        """
        return min((max(0.5, part.shape.min_half_extent) for part in outline_of(self)), default=self.min_half_extent)

    def reach(self, x: float, y: float) -> float:
        if self.bounds is None:
            return 0.0
        left, top, right, bottom = self.bounds
        return float(np.hypot(max(x - left, right - x), max(y - top, bottom - y)))

    @property
    def _key(self) -> tuple:
        return (*self.size, *self.origin, self.snap, self.solid.tobytes())

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        origin = np.array(self.origin)
        return [(np.array(rectangle(*block)) - origin, 0.0) for block in self.blocks(0)]

    @property
    def _parts(self) -> Parts:
        if "outline parts" not in self.fitted:
            shapes = [part.shape for part in outline_of(self.bare)]
            self.fitted["outline parts"] = parts_of([each.points for each in shapes], [each.radius for each in shapes])
        return self.fitted["outline parts"]

    def _box_at(self, angle: float) -> Parts:
        if not (self.snap and self.area):
            return super()._box_at(angle)
        turned = self.turned(angle)
        rows, columns = np.nonzero(turned.solid)
        x, y = turned.origin
        return parts_of([rectangle(columns.min() - x, rows.min() - y, columns.max() + 1 - x, rows.max() + 1 - y)])

    def _rotation(self, angle: float) -> tuple[float, float]:
        return turn_of_mask(angle)

    def _parts_at(self, placed: Placed) -> Parts:
        if placed.swept:
            return turned_parts(self._parts, *placed.offset, *self._rotation(placed.angle))
        if not self.snap:
            return super()._parts_at(placed)
        dx, dy = (float(placed.shapes[placed.row][name]) - at for name, at in (("left", placed.x), ("top", placed.y)))
        blocks = self.blocks(bucket_of(placed.angle, MASK_ANGLE_BUCKETS))
        return parts_of([rectangle(dx + left, dy + top, dx + right, dy + down) for left, top, right, down in blocks])

    def _response_parts(self) -> Sequence[tuple[int, Sequence[OutlinePart | Stretch]]]:
        """Return the outline parts that collide in place of the mask, by tile: [(tile number, parts)].

        For a one-way mask, the parts are chains along its upper side.
        """
        return [(WHOLE_MASK, surfaces_of(self))] if self.one_way else outline_by_tile(self)

    def _check_body(self, kind: int, angles: ArrayLike) -> None:
        if self.one_way and kind == DYNAMIC:
            raise ValueError(f"a mask with one_way=True needs kind static or kinematic (got dynamic, {self})")

    def __repr__(self):
        exact = "" if self.snap else ", snap=False"
        exact += "" if self.smooth == SMOOTH else f", smooth={self.smooth}"
        exact += ", one_way=True" if self.one_way else ""
        return f"PixelMask({self.size[0]} x {self.size[1]}, {self.area} solid, origin {self.origin}{exact})"


def _nearest(size: int, factor: float) -> np.ndarray:
    """Return the index of the nearest source column for each column of a scaled mask: (n,) int64.

    It is the column that contains the centre of the scaled column. Also used for rows. size: number of columns of the
    source; factor: scale.
    """
    wanted = max(1, math.floor(size * factor + 0.5)) if size else 0
    return np.minimum(((np.arange(wanted) + 0.5) / factor).astype(np.int64), size - 1)
