"""Shapes: immutable values in body space, in pixels; x right, y down, angles clockwise on the screen.

A shape knows its geometry and its mass; where it is, its body knows. All but PixelMask and TileGrid compare by value.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from physics import checks
from physics.masks.rotate import Turned, bucket_of, turn
from physics.settings import MASK_ANGLE_BUCKETS

MAX_CORNERS = 16


@dataclass(frozen=True)
class Mass:
    """Mass, centre of mass in body space [px], and inertia about that centre."""
    mass: float
    center: tuple[float, float]
    inertia: float


@dataclass(frozen=True)
class Circle:
    """A disc. Raises ValueError for a radius that is not > 0."""
    radius: float
    center: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "radius", checks.number("radius", self.radius, above=0.0))
        object.__setattr__(self, "center", checks.vector("center", self.center))

    @property
    def smallest_half(self):
        return self.radius

    def mass_of(self, density):
        mass = density * math.pi * self.radius * self.radius
        return Mass(mass, self.center, mass * self.radius * self.radius / 2.0)


@dataclass(frozen=True)
class Polygon:
    """A convex polygon of 3 to 16 corners in either winding; kept clockwise on the screen.

    Raises ValueError for too few or many corners, for zero area, for three corners in line or equal ones, and for a
    concave outline.
    """
    points: tuple[tuple[float, float], ...]

    def __post_init__(self):
        points = checks.columns("points", self.points)
        if not 3 <= len(points) <= MAX_CORNERS:
            raise ValueError(f"points must be 3..{MAX_CORNERS} corners (got {len(points)})")
        edges = np.roll(points, -1, axis=0) - points
        following = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
        scale = np.hypot(*edges.T) * np.hypot(*following.T)
        if np.any(np.abs(turns) <= 1e-12 * scale):
            raise ValueError(f"points must have no equal corners and no three in line (got {points.tolist()})")
        # All turns to one side, and once around: a star also turns to one side only.
        around = np.arctan2(turns, (edges * following).sum(axis=1)).sum()
        if not (np.all(turns > 0) or np.all(turns < 0)) or abs(around) > 1.5 * math.tau:
            raise ValueError(f"points must be convex (got {points.tolist()}); split a concave outline into convex parts")
        if turns[0] < 0:
            points = points[::-1]
        object.__setattr__(self, "points", tuple((float(x), float(y)) for x, y in points))

    @classmethod
    def box(cls, width, height, center=(0.0, 0.0), angle=0.0):
        """A box of full sizes, turned about its centre."""
        half_width = checks.number("width", width, above=0.0) / 2.0
        half_height = checks.number("height", height, above=0.0) / 2.0
        x, y = checks.vector("center", center)
        angle = checks.number("angle", angle)
        cosine, sine = math.cos(angle), math.sin(angle)
        corners = ((-half_width, -half_height), (half_width, -half_height),
                   (half_width, half_height), (-half_width, half_height))
        return cls(tuple((x + cosine * u - sine * v, y + sine * u + cosine * v) for u, v in corners))

    @property
    def smallest_half(self):
        """Half of the least width, over the directions of the edges' normals."""
        points = np.array(self.points)
        edges = np.roll(points, -1, axis=0) - points
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(*edges.T)[:, None]
        return float(np.ptp(points @ normals.T, axis=0).min() / 2.0)

    def mass_of(self, density):
        """Shoelace integrals about the first corner, so that a far polygon loses no digits."""
        base = np.array(self.points[0])
        a = np.array(self.points) - base
        b = np.roll(a, -1, axis=0)
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        area = cross.sum() / 2.0
        center = ((a + b) * cross[:, None]).sum(axis=0) / (6.0 * area)
        a, b = a - center, b - center
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        second = (cross * ((a * a).sum(1) + (a * b).sum(1) + (b * b).sum(1))).sum() / 12.0
        return Mass(density * area, tuple((base + center).tolist()), density * second)


class TileGrid:
    """Solid tiles of one size; origin at the top left corner of tile (0, 0).

    solid[row, col] bool; one_way[row, col] bool: open from below; slopes[row, col] = (left, right): height of the
    surface above the tile's bottom as a fraction 0..1, (0, 1) rises to the right, (0, 0) is no slope. Raises
    ValueError when the arrays differ in shape, a slope is out of range, or a cell is of two kinds.
    """

    def __init__(self, solid, tile_size, one_way=None, slopes=None):
        self.solid = _bools("solid", solid)
        self.tile_size = checks.number("tile_size", tile_size, above=0.0)
        self.one_way = _bools("one_way", one_way if one_way is not None else np.zeros_like(self.solid))
        try:
            slopes = np.zeros(self.solid.shape + (2,)) if slopes is None else np.array(slopes, dtype=np.float64)
        except (TypeError, ValueError):
            raise TypeError(f"slopes must be an array [row, col, 2] of numbers (got {type(slopes).__name__})") from None
        if self.one_way.shape != self.solid.shape:
            raise ValueError(f"one_way must have the shape of solid, {self.solid.shape} (got {self.one_way.shape})")
        if slopes.shape != self.solid.shape + (2,):
            raise ValueError(f"slopes must have shape {self.solid.shape + (2,)} (got {slopes.shape})")
        bad = ~((slopes >= 0.0) & (slopes <= 1.0)).all(axis=2)
        if bad.any():
            at = tuple(int(v) for v in np.argwhere(bad)[0])
            raise ValueError(f"slopes[{at[0]}, {at[1]}] must be within 0..1 (got {slopes[at].tolist()})")
        kinds = self.solid.astype(int) + self.one_way + (slopes > 0.0).any(axis=2)
        if (kinds > 1).any():
            at = tuple(int(v) for v in np.argwhere(kinds > 1)[0])
            raise ValueError(f"cell [{at[0]}, {at[1]}] must be one of solid, one_way and slope (got {kinds[at]} of them)")
        self.slopes = slopes
        for array in (self.solid, self.one_way, self.slopes):
            array.flags.writeable = False

    @property
    def smallest_half(self):
        return self.tile_size / 2.0

    def mass_of(self, density):
        return Mass(0.0, (0.0, 0.0), 0.0)        # tiles are ground: they only carry

    def __repr__(self):
        return f"TileGrid({self.solid.shape[0]} x {self.solid.shape[1]} tiles of {self.tile_size} px)"


def _bools(name, value):
    try:
        array = np.array(value)
    except ValueError:
        raise TypeError(f"{name} must be an array [row, col] of bool (got rows of different lengths)") from None
    if array.ndim != 2:
        raise ValueError(f"{name} must be an array [row, col] (got {array.ndim} dimensions)")
    if array.dtype != np.bool_ and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{name} must be an array of bool (got {array.dtype})")
    return np.ascontiguousarray(array != 0)


class PixelMask:
    """The solid pixels of a sprite: pixel (i, j) is the square [i, i+1) x [j, j+1), less the origin.

    Tested as it is drawn, on the pixel grid and at angles in buckets, by AND of packed 64-bit words.
    """

    def __init__(self, solid, origin=None, snap=True):
        solid = _bools("solid", solid)
        if snap is not True:
            raise ValueError(f"snap must be True (got {snap!r}): masks are tested as drawn")
        height, width = solid.shape
        self.snap = True
        self.size = (width, height)
        self.origin = (width / 2.0, height / 2.0) if origin is None else checks.vector("origin", origin)
        self.solid = solid
        solid.flags.writeable = False
        self._turned = {}
        self.fitted = {}               # tier -> the shapes that stand for it, kept by fitting.fit

    @classmethod
    def from_array(cls, solid, origin=None, snap=True) -> "PixelMask":
        """From solid[row, col]; origin in pixels, None = the image centre. Raises ValueError, TypeError."""
        return cls(solid, origin, snap)

    @classmethod
    def from_surface(cls, surface, threshold=127, origin=None, snap=True) -> "PixelMask":
        """From a pygame surface: solid where alpha > threshold; a colour key is clear. Raises TypeError."""
        import pygame           # the one door through which sprites enter
        if not isinstance(surface, pygame.Surface):
            raise TypeError(f"surface must be a pygame.Surface (got {surface!r})")
        threshold = checks.whole("threshold", threshold, 0, 255)
        if 0 in surface.get_size():
            return cls(np.zeros(surface.get_size()[::-1], bool), origin, snap)
        solid = pygame.surfarray.array_alpha(surface) > threshold
        if surface.get_colorkey() is not None:
            solid &= pygame.surfarray.array_colorkey(surface) > 0
        return cls(np.ascontiguousarray(solid.T), origin, snap)

    def turned(self, angle=0.0) -> Turned:
        """The mask at the angle bucket nearest to `angle` [rad], cached; always turned from the source."""
        return self.turned_to(bucket_of(checks.number("angle", angle), MASK_ANGLE_BUCKETS))

    def turned_to(self, bucket: int) -> Turned:
        if bucket not in self._turned:
            self._turned[bucket] = turn(self.solid, self.origin, bucket, MASK_ANGLE_BUCKETS)
        return self._turned[bucket]

    @cached_property
    def words(self):
        """(h, ceil(w/64)) uint64: bit b of word k in a row is x = 64k + b."""
        return packed(self.solid)

    @cached_property
    def area(self):
        """Solid pixels."""
        return int(self.solid.sum())

    @cached_property
    def centroid(self):
        """Mean of the solid pixels' centres in body space [px]; None when there is none."""
        rows, columns = np.nonzero(self.solid)
        if not len(rows):
            return None
        return (float(columns.mean()) + 0.5 - self.origin[0], float(rows.mean()) + 0.5 - self.origin[1])

    @cached_property
    def bounds(self):
        """(min_x, min_y, max_x, max_y) of the solid pixels in body space [px]; None when there is none."""
        rows, columns = np.nonzero(self.solid)
        if not len(rows):
            return None
        x, y = self.origin
        return (columns.min() - x, rows.min() - y, columns.max() + 1 - x, rows.max() + 1 - y)

    @property
    def smallest_half(self):
        if self.bounds is None:
            return 0.5
        return min(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1]) / 2.0

    def mass_of(self, density):
        """Of the union of pixel squares: each adds 1/6 to the second moment about its own centre."""
        if self.area == 0:
            return Mass(0.0, (0.0, 0.0), 0.0)
        rows, columns = np.nonzero(self.solid)
        x, y = columns + (0.5 - self.origin[0]), rows + (0.5 - self.origin[1])
        center = (float(x.mean()), float(y.mean()))
        second = float(((x - center[0]) ** 2 + (y - center[1]) ** 2).sum()) + self.area / 6.0
        return Mass(density * self.area, center, density * second)

    def __repr__(self):
        return f"PixelMask({self.size[0]} x {self.size[1]}, {self.area} solid, origin {self.origin})"


def packed(solid: np.ndarray) -> np.ndarray:
    """solid[row, col] as (rows, ceil(columns/64)) uint64, lowest bit first."""
    height, width = solid.shape
    padded = np.zeros((height, -(-width // 64) * 64), bool)
    padded[:, :width] = solid
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)


@dataclass(frozen=True)
class Bounds:
    """The wrapped shape's world AABB at its pose, as a shape: the AABB tier."""
    shape: Circle | Polygon | PixelMask

    def __post_init__(self):
        if not isinstance(self.shape, (Circle, Polygon, PixelMask)):
            raise TypeError(f"shape must be a Circle, Polygon or PixelMask (got {self.shape!r})")

    @property
    def smallest_half(self):
        return self.shape.smallest_half

    def mass_of(self, density):
        return self.shape.mass_of(density)


SHAPES = (Circle, Polygon, TileGrid, PixelMask, Bounds)


@dataclass(frozen=True)
class Material:
    """What a shape is made of: density [mass per px2], friction >= 0, restitution >= 0. Raises ValueError."""
    density: float = 1.0
    friction: float = 0.6
    restitution: float = 0.0

    def __post_init__(self):
        object.__setattr__(self, "density", checks.number("density", self.density, above=0.0))
        object.__setattr__(self, "friction", checks.number("friction", self.friction, low=0.0))
        object.__setattr__(self, "restitution", checks.number("restitution", self.restitution, low=0.0))


@dataclass(frozen=True)
class Filter:
    """Two shapes meet if a.membership & b.mask and b.membership & a.mask; 32 bits each. Raises ValueError."""
    membership: int = 1
    mask: int = 0xFFFFFFFF

    def __post_init__(self):
        object.__setattr__(self, "membership", checks.whole("membership", self.membership, 0, 0xFFFFFFFF))
        object.__setattr__(self, "mask", checks.whole("mask", self.mask, 0, 0xFFFFFFFF))

    @classmethod
    def from_packed(cls, bits: int) -> "Filter":
        """Low 16 bits membership, high 16 bits mask."""
        bits = checks.whole("bits", bits, 0, 0xFFFFFFFF)
        return cls(bits & 0xFFFF, bits >> 16)


Filter.ALL = Filter(0xFFFFFFFF, 0xFFFFFFFF)


def mass_of(shapes, density) -> Mass:
    """Mass of one shape or several together: inertia about the common centre of mass.

    Raises TypeError for what is no shape, ValueError for a density that is not > 0.
    """
    density = checks.number("density", density, above=0.0)
    shapes = shapes if isinstance(shapes, (tuple, list)) else (shapes,)
    for shape in shapes:
        if not isinstance(shape, SHAPES):
            raise TypeError(f"shapes must be shapes (got {shape!r})")
    parts = [shape.mass_of(density) for shape in shapes]
    mass = sum(part.mass for part in parts)
    if mass == 0.0:
        return Mass(0.0, (0.0, 0.0), 0.0)
    x = sum(part.mass * part.center[0] for part in parts) / mass
    y = sum(part.mass * part.center[1] for part in parts) / mass
    inertia = sum(part.inertia + part.mass * ((part.center[0] - x) ** 2 + (part.center[1] - y) ** 2) for part in parts)
    return Mass(mass, (x, y), inertia)
