"""Shapes as immutable values: convex shapes, lines, tile grids, with their filter, material and mass."""

import copy
import math
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.checks import Pair, Points
from physics.math2d import Vec2
from physics.settings import MAX_CORNERS

# ---- filter ----------------------------------------------------------------------------------------------------------
# Collision filter, applied before any narrow phase.


@dataclass(frozen=True)
class Filter:
    """Collision filter: shapes collide if a.membership & b.mask and b.membership & a.mask; 32 bits each.

    Raises ValueError.
    """

    ALL: ClassVar["Filter"]  # collides with every shape

    membership: int = 1
    mask: int = 0xFFFFFFFF

    def __post_init__(self):
        object.__setattr__(self, "membership", checks.whole("membership", self.membership, 0, 0xFFFFFFFF))
        object.__setattr__(self, "mask", checks.whole("mask", self.mask, 0, 0xFFFFFFFF))

    @classmethod
    def from_packed(cls, bits: int) -> "Filter":
        """Return the filter with the low 16 bits as membership and the high 16 bits as mask."""
        bits = checks.whole("bits", bits, 0, 0xFFFFFFFF)
        return cls(bits & 0xFFFF, bits >> 16)


Filter.ALL = Filter(0xFFFFFFFF, 0xFFFFFFFF)


# ---- material --------------------------------------------------------------------------------------------------------
# Material: surface and density of a shape.


@dataclass(frozen=True)
class Material:
    """Material of a shape: density [mass per px2] > 0; friction, restitution and rolling_resistance >= 0.

    surface_speed [px/s]: speed of its surface, as of a conveyor belt. rolling_resistance: share of the radius; the
    torque against rolling is at most that times radius and load. Raises ValueError.
    """

    density: float = 1.0
    friction: float = 0.6
    restitution: float = 0.0
    rolling_resistance: float = 0.0
    surface_speed: float = 0.0

    def __post_init__(self):
        object.__setattr__(self, "density", checks.number("density", self.density, above=0.0))
        for name in ("friction", "restitution", "rolling_resistance"):
            object.__setattr__(self, name, checks.number(name, getattr(self, name), low=0.0))
        object.__setattr__(self, "surface_speed", checks.number("surface_speed", self.surface_speed))


# ---- own values ------------------------------------------------------------------------------------------------------
# Values that a shape may have in place of those of its body: material, filter, sensor.


class OwnValues:
    """Base of all shapes: the values that may replace the body's. Shapes are immutable, and copies share them."""

    material: Material | None = None  # None, for all three: the body's value
    filter: Filter | None = None
    sensor: bool | None = None

    def with_(self, material: Material | None = None, filter: Filter | None = None, sensor: bool | None = None) -> Self:
        """Return the same shape with values of its own; None: the body's. Its density counts in the body's mass.

        Changing the body's material, filter or sensor leaves these values unchanged. Raises TypeError.
        """
        for name, value, wanted in (("material", material, Material), ("filter", filter, Filter)):
            if value is not None and not isinstance(value, wanted):
                raise TypeError(f"{name} must be a {wanted.__name__} or None (got {checks.shown(value)})")
        sensor = None if sensor is None else checks.flag("sensor", sensor)
        bare = self.bare
        if material is None and filter is None and sensor is None:
            return bare
        found = copy.copy(bare)
        vars(found).update(material=material, filter=filter, sensor=sensor, _bare=bare)
        return found

    @property
    def bare(self) -> Self:
        """The shape without values of its own, as a library stores it: one for all shapes that differ only in them."""
        return vars(self).get("_bare", self)

    def with_values_of(self, other: "OwnValues") -> Self:
        """Return this shape with the own values of another one."""
        return self.with_(other.material, other.filter, other.sensor)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


@dataclass(frozen=True)
class EqualByValue(OwnValues):
    """Base of the shapes that are equal when their geometry and their own values are."""

    material: Material | None = field(default=None, init=False, repr=False)
    filter: Filter | None = field(default=None, init=False, repr=False)
    sensor: bool | None = field(default=None, init=False, repr=False)


# ---- mass ------------------------------------------------------------------------------------------------------------
# Masses of plane figures: exact sums over parts, each about its own centre, for precision far from the origin.


@dataclass(frozen=True)
class Mass:
    """Mass, centre of mass in body space [px], and inertia about that centre."""

    mass: float
    center: Vec2
    inertia: float


NOTHING = Mass(0.0, Vec2(0.0, 0.0), 0.0)


def together(parts: Iterable[Mass]) -> Mass:
    """Return the mass of several parts, with the inertia about the common centre (parallel axis theorem)."""
    parts = [part for part in parts if part.mass > 0.0]
    if not parts:
        return NOTHING
    # Relative to the first part's centre, for precision far from the origin.
    base_x, base_y = parts[0].center
    mass = math.fsum(part.mass for part in parts)
    x = math.fsum(part.mass * (part.center[0] - base_x) for part in parts) / mass
    y = math.fsum(part.mass * (part.center[1] - base_y) for part in parts) / mass
    inertia = math.fsum(
        part.inertia + part.mass * ((part.center[0] - base_x - x) ** 2 + (part.center[1] - base_y - y) ** 2)
        for part in parts
    )
    return Mass(mass, Vec2(base_x + x, base_y + y), inertia)


def polygon_mass(points: Points, density: float) -> Mass:
    """Return the mass of a polygon, points (n, 2) clockwise on the screen: shoelace integrals about the first
    corner.
    """
    base = np.array(points[0])
    a = np.array(points) - base
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2.0
    center = ((a + b) * cross[:, None]).sum(axis=0) / (6.0 * area)
    a, b = a - center, b - center
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (cross * ((a * a).sum(1) + (a * b).sum(1) + (b * b).sum(1))).sum() / 12.0
    return Mass(float(density * area), Vec2(*(base + center).tolist()), float(density * second))


def rounded_mass(points: Points, radius: float, density: float) -> Mass:
    """Return the mass of a rounded polygon: the polygon, a rectangle along every edge, a disc sector at every
    corner.
    """
    parts = [polygon_mass(points, density)]
    count = len(points)
    edges = [
        (points[(k + 1) % count][0] - points[k][0], points[(k + 1) % count][1] - points[k][1]) for k in range(count)
    ]
    for k, (dx, dy) in enumerate(edges):
        length = math.hypot(dx, dy)
        out_x, out_y = dy / length, -dx / length
        mass = density * length * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + 0.5 * dx + 0.5 * radius * out_x, points[k][1] + 0.5 * dy + 0.5 * radius * out_y),
                mass * (length * length + radius * radius) / 12.0,
            )
        )
        before_x, before_y = edges[k - 1]
        turn = math.atan2(before_x * dy - before_y * dx, before_x * dx + before_y * dy)
        # The axis of the sector is the bisector of the two outward normals.
        other = math.hypot(before_x, before_y)
        bisector_x, bisector_y = out_x + before_y / other, out_y - before_x / other
        size = math.hypot(bisector_x, bisector_y)
        away = 4.0 * radius * math.sin(0.5 * turn) / (3.0 * turn)
        mass = density * 0.5 * turn * radius * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + away * bisector_x / size, points[k][1] + away * bisector_y / size),
                mass * (0.5 * radius * radius - away * away),
            )
        )
    return together(parts)


# ---- convex ----------------------------------------------------------------------------------------------------------
# Convex shapes: a hull of corners with a rounding radius.
# Circle has one corner, Capsule two, Polygon three to sixteen.

STRAIGHT = 1e-12  # [rad] smaller turns count as straight
CORNER_OF = partial(tuple.__new__, Vec2)  # from two numbers; Vec2._make would count them first
PHYSICS = __name__.removesuffix(".shapes.values")  # the package that a user imports
SHORTEST = 1e-9  # relative to a hull's size: a shorter edge loses its direction by rounding when the hull moves


def reach(points: Iterable[Pair], radius: float, x: float, y: float) -> float:
    """Return the distance [px] from (x, y) to the furthest point of a rounded hull."""
    return max(math.hypot(px - x, py - y) for px, py in points) + radius


@dataclass(frozen=True)
class Circle(EqualByValue):
    """A disc. Raises ValueError for a radius that is not > 0."""

    radius: float
    center: Pair = Vec2(0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "radius", checks.number("radius", self.radius, above=0.0))
        object.__setattr__(self, "center", checks.vector("center", self.center))

    @property
    def min_half_extent(self) -> float:
        return self.radius

    def mass_of(self, density: float) -> Mass:
        mass = density * math.pi * self.radius * self.radius
        return Mass(mass, Vec2(*self.center), mass * self.radius * self.radius / 2.0)

    def reach(self, x: float, y: float) -> float:
        return reach((self.center,), self.radius, x, y)


@dataclass(frozen=True)
class Capsule(EqualByValue):
    """All points within a radius of the line from a to b.

    Raises ValueError for a radius that is not > 0, or no length.
    """

    a: Pair
    b: Pair
    radius: float

    def __post_init__(self):
        a, b = checks.vector("a", self.a), checks.vector("b", self.b)
        radius = checks.number("radius", self.radius, above=0.0)
        if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST * max(radius, *map(abs, a), *map(abs, b)):
            raise ValueError(
                f"a and b must be two points with a length between them (got {a} and {b}); "
                "a capsule without length is a Circle"
            )
        object.__setattr__(self, "a", a)
        object.__setattr__(self, "b", b)
        object.__setattr__(self, "radius", radius)

    @property
    def points(self) -> tuple[Pair, Pair]:
        return self.a, self.b

    @property
    def min_half_extent(self) -> float:
        return self.radius

    def mass_of(self, density: float) -> Mass:
        """Return the mass of a rectangle and two half discs, whose centres of mass lie 4r/3π beyond the line's ends."""
        length = math.hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])
        r = self.radius
        middle, ends = density * 2.0 * r * length, density * math.pi * r * r
        inertia = middle * (length * length + 4.0 * r * r) / 12.0 + ends * (
            r * r / 2.0 + length * length / 4.0 + length * 4.0 * r / (3.0 * math.pi)
        )
        center = Vec2(self.a[0] + 0.5 * (self.b[0] - self.a[0]), self.a[1] + 0.5 * (self.b[1] - self.a[1]))
        return Mass(middle + ends, center, inertia)

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, self.radius, x, y)


@dataclass(frozen=True)
class Polygon(EqualByValue):
    """A convex polygon of 3 to 16 corners in either winding, stored clockwise on the screen, rounded by a radius.

    Raises ValueError for too few or many corners, for zero area, for three collinear corners or equal ones, for a
    concave outline, and for a radius that is not >= 0.
    """

    points: Points
    radius: float = 0.0

    def __post_init__(self):
        points = checks.columns("points", self.points)
        object.__setattr__(self, "radius", checks.number("radius", self.radius, low=0.0))
        if not 3 <= len(points) <= MAX_CORNERS:
            raise ValueError(f"points must be 3..{MAX_CORNERS} corners (got {len(points)})")
        edges = np.roll(points, -1, axis=0) - points
        following = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
        scale = np.hypot(*edges.T) * np.hypot(*following.T)
        shortest = np.hypot(*edges.T).min() <= SHORTEST * np.ptp(points, axis=0).max()
        if shortest or np.any(np.abs(turns) <= STRAIGHT * scale):
            raise ValueError(f"points must have no equal corners and no three in line (got {points.tolist()})")
        # All turns have one sign, and sum to one full turn: those of a star have one sign, too.
        around = np.arctan2(turns, (edges * following).sum(axis=1)).sum()
        if not (np.all(turns > 0) or np.all(turns < 0)) or abs(around) > 1.5 * math.tau:
            raise ValueError(
                f"points must be convex (got {checks.shown(points.tolist())}); {PHYSICS}.decompose splits a concave "
                "outline into convex parts"
            )
        if turns[0] < 0:
            points = points[::-1]
        object.__setattr__(self, "points", tuple(Vec2(x, y) for x, y in points.tolist()))

    @classmethod
    def known(cls, points: list[list[float]]) -> "Polygon":
        """Return the polygon of valid corners [px], convex and clockwise on the screen, without a check.

        For the outlines of masks, which have thousands.
        """
        found = object.__new__(cls)
        vars(found).update(points=tuple(map(CORNER_OF, points)), radius=0.0)
        return found

    @classmethod
    def box(cls, width: float, height: float, center: Pair = (0.0, 0.0), angle: float = 0.0) -> "Polygon":
        """Return a box of full sizes, rotated by `angle` [rad] about its centre."""
        half_width = checks.number("width", width, above=0.0) / 2.0
        half_height = checks.number("height", height, above=0.0) / 2.0
        x, y = checks.vector("center", center)
        angle = checks.number("angle", angle)
        cosine, sine = math.cos(angle), math.sin(angle)
        corners = (
            (-half_width, -half_height),
            (half_width, -half_height),
            (half_width, half_height),
            (-half_width, half_height),
        )
        return cls(tuple((x + cosine * u - sine * v, y + sine * u + cosine * v) for u, v in corners))

    @cached_property
    def min_half_extent(self) -> float:
        """Inradius [px]: distance from the centre of mass to the nearest edge, plus the radius; half the shorter side
        of a box.
        """
        points = np.array(self.points)
        edges = np.roll(points, -1, axis=0) - points
        outward = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(*edges.T)[:, None]
        from_center = points - np.array(self.mass_of(1.0).center)
        return float((from_center * outward).sum(axis=1).min()) + self.radius

    def mass_of(self, density: float) -> Mass:
        if self.radius == 0.0:
            return polygon_mass(self.points, density)
        return rounded_mass(self.points, self.radius, density)

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, self.radius, x, y)


# ---- blocks ----------------------------------------------------------------------------------------------------------
# Cover of the solid cells of a grid, or of the pixels of a mask, by rectangles.


def solid_blocks(solid: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Return rectangles (left, top, right, bottom) that cover solid[row, col]: runs along rows, equal runs merged."""
    found, open_runs = [], {}
    edges = np.diff(np.pad(solid, ((0, 1), (1, 1))).astype(np.int8), axis=1)
    for row, line in enumerate(edges):
        runs = set(zip(np.flatnonzero(line > 0).tolist(), np.flatnonzero(line < 0).tolist(), strict=True))
        for run in sorted(open_runs.keys() - runs):
            found.append((run[0], open_runs.pop(run), run[1], row))
        for run in runs - open_runs.keys():
            open_runs[run] = row
    return found


# ---- tiles -----------------------------------------------------------------------------------------------------------


class TileGrid(OwnValues):
    """Solid tiles of one size; origin at the top left corner of tile (0, 0).

    solid[row, col] bool; one_way[row, col] bool: open from below; slopes[row, col] = (left, right): height of the
    surface above the tile's bottom as a fraction 0..1, (0, 1) rises to the right, (0, 0) is no slope. Raises ValueError
    when the arrays differ in shape, a slope is out of range, or a cell is of two kinds.
    """

    def __init__(
        self, solid: ArrayLike, tile_size: float, one_way: ArrayLike | None = None, slopes: ArrayLike | None = None
    ) -> None:
        self.solid = bools("solid", solid)
        self.tile_size = checks.number("tile_size", tile_size, above=0.0)
        self.one_way = bools("one_way", one_way if one_way is not None else np.zeros_like(self.solid))
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
            raise ValueError(
                f"cell [{at[0]}, {at[1]}] must be one of solid, one_way and slope (got {kinds[at]} of them)"
            )
        self.slopes = slopes
        for array in (self.solid, self.one_way, self.slopes):
            array.flags.writeable = False

    @cached_property
    def blocks(self) -> tuple[list[tuple[int, int, int, int]], list[list[int]], list[tuple[int, int, int, int]]]:
        """Blocks (left, top, right, bottom) of solid cells, cells with a slope, and blocks of one-way cells."""
        return (
            solid_blocks(self.solid),
            np.argwhere((self.slopes > 0.0).any(axis=2)).tolist(),
            solid_blocks(self.one_way),
        )

    @cached_property
    def is_empty(self) -> bool:
        """True if all cells are empty."""
        return not (self.solid.any() or self.one_way.any() or (self.slopes > 0.0).any())

    @property
    def min_half_extent(self) -> float:
        return self.tile_size / 2.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING  # tiles are ground without mass

    def reach(self, x: float, y: float) -> float:
        height, width = self.solid.shape
        far_x = max(abs(x), abs(width * self.tile_size - x))
        far_y = max(abs(y), abs(height * self.tile_size - y))
        return math.hypot(far_x, far_y)

    def __repr__(self):
        return f"TileGrid({self.solid.shape[0]} x {self.solid.shape[1]} tiles of {self.tile_size} px)"


def bools(name: str, value: ArrayLike) -> np.ndarray:
    """Return a C-ordered bool array [row, col]. Raises TypeError, ValueError."""
    _refuse_pixels_of_pygame(name, value)
    try:
        array = np.array(value)
    except ValueError:
        raise TypeError(f"{name} must be an array [row, col] of bool (got rows of different lengths)") from None
    if array.ndim != 2:
        raise ValueError(f"{name} must be an array [row, col] (got {array.ndim} dimensions)")
    if array.dtype != np.bool_ and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{name} must be an array of bool (got {array.dtype})")
    return np.ascontiguousarray(array != 0)


def _refuse_pixels_of_pygame(name: str, value: Any) -> None:
    """Reject pygame masks and surfaces: NumPy would misread the words of a Mask, packed by columns, as pixels."""
    pygame = sys.modules.get("pygame")  # a caller with a Mask has imported it; physics does not
    for kind, way_in in (("Mask", "from_mask(mask)"), ("Surface", "from_surface(surface)")):
        known = getattr(pygame, kind, None)
        if isinstance(known, type) and isinstance(value, known):
            raise TypeError(
                f"{name} must be an array [row, col] of bool (got the pygame {kind} {value!r}): "
                f"PixelMask.{way_in} takes it"
            )


# ---- lines -----------------------------------------------------------------------------------------------------------
# Lines without an inside: Segment, two-sided, and Chain, one-sided.

SHORTEST_LINK = 1e-12  # relative to the largest coordinate: a shorter link has no direction


def _check_length(name, a, b):
    if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST_LINK * max(map(abs, (*a, *b))):
        raise ValueError(f"{name} must be two points with a length between them (got {a} and {b})")


@dataclass(frozen=True)
class Segment(EqualByValue):
    """The line from a to b, solid from both sides; no mass. Raises ValueError for one without length."""

    a: Pair
    b: Pair

    def __post_init__(self):
        object.__setattr__(self, "a", checks.vector("a", self.a))
        object.__setattr__(self, "b", checks.vector("b", self.b))
        _check_length("a and b", self.a, self.b)

    @property
    def points(self) -> tuple[Pair, Pair]:
        return self.a, self.b

    @property
    def min_half_extent(self) -> float:
        return 0.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, 0.0, x, y)


@dataclass(frozen=True)
class Chain(EqualByValue):
    """One-sided links from point to point, solid from the side of (dy, -dx). No mass; for static and kinematic bodies.

    A floor is listed left to right, a solid island clockwise on the screen, a room counter-clockwise. ghosts: (before,
    after), neighbours of the first and last point that only smooth the ends, either may be None. materials: one
    Material per link (None: the body's). Raises ValueError for too few points, a link without length, ghosts of a loop.
    """

    points: Points
    loop: bool = False
    ghosts: Sequence[Pair | None] | None = None
    materials: Sequence[Material] | None = None

    def __post_init__(self):
        points = tuple(Vec2(x, y) for x, y in checks.columns("points", self.points).tolist())
        loop = checks.flag("loop", self.loop)
        least = 3 if loop else 2
        if len(points) < least:
            raise ValueError(
                f"points must be at least {least} for {'a loop' if loop else 'a chain'} (got {len(points)})"
            )
        for k in range(len(points) if loop else len(points) - 1):
            following = (k + 1) % len(points)
            hint = " (a loop closes itself)" if following == 0 else ""
            _check_length(f"points[{k}] and points[{following}]{hint}", points[k], points[following])
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "loop", loop)
        object.__setattr__(self, "ghosts", self._checked_ghosts())
        object.__setattr__(self, "materials", self._checked_materials())

    def _checked_ghosts(self):
        if self.ghosts is None:
            return None
        if self.loop:
            raise ValueError(
                "ghosts must be None for a loop, whose ends are each other's neighbours "
                f"(got {checks.shown(self.ghosts)})"
            )
        try:
            before, after = self.ghosts
        except (TypeError, ValueError):
            raise TypeError(
                f"ghosts must be a pair of points (before, after) (got {checks.shown(self.ghosts)})"
            ) from None
        ghosts = tuple(
            None if each is None else checks.vector(f"ghosts[{k}]", each) for k, each in enumerate((before, after))
        )
        for k, end in enumerate((self.points[0], self.points[-1])):
            if ghosts[k] is not None:
                _check_length(f"ghosts[{k}] and the end it smooths", ghosts[k], end)
        return ghosts

    def _checked_materials(self):
        if self.materials is None:
            return None
        if not isinstance(self.materials, (tuple, list)):
            raise TypeError(f"materials must be a tuple of Material, one per link (got {checks.shown(self.materials)})")
        materials = tuple(self.materials)
        for k, each in enumerate(materials):
            if not isinstance(each, Material):
                raise TypeError(f"materials[{k}] must be a Material (got {checks.shown(each)})")
        if len(materials) != self.links:
            raise ValueError(f"materials must be {self.links}, one per link (got {len(materials)})")
        return materials

    @property
    def links(self) -> int:
        """Number of links."""
        return len(self.points) if self.loop else len(self.points) - 1

    @property
    def min_half_extent(self) -> float:
        return 0.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING

    def reach(self, x: float, y: float) -> float:
        return reach(self.points, 0.0, x, y)
