"""Classes of shapes, which are immutable values: convex shapes, tile grids and lines."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from physics import checks, hints
from physics.annotations import Pair, Points
from physics.hints import explained
from physics.math2d import Vec2
from physics.settings import MAX_CORNERS
from physics.shapes.mass import Mass, convex_mass
from physics.shapes.placement import write_hull
from physics.shapes.shape import (
    EqualByArrays,
    EqualByValue,
    Material,
    Parts,
    Placed,
    immutable,
    parts_of,
    read_only,
    rectangle,
)
from physics.tables.body import DYNAMIC, KINDS
from physics.tables.shape import CAPSULE, CHAIN, CIRCLE, POLYGON, SEGMENT, TILES

# ---- convex ----------------------------------------------------------------------------------------------------------
# Convex shapes: a hull of corners with a rounding radius.
# Circle has one corner, Capsule two, Polygon three to sixteen.

MIDDLE = Vec2(0.0, 0.0)
STRAIGHT = 1e-12  # [rad] smaller turns count as straight
CORNER_OF = partial(tuple.__new__, Vec2)  # makes a Vec2 of two numbers; Vec2._make would count them first
PHYSICS = __name__.removesuffix(".shapes.values")  # the package that a user imports
SHORTEST = 1e-9  # share of the hull's size: a shorter edge loses its direction to rounding errors when the hull moves


class Convex(EqualByValue):
    """Base of the convex shapes: the hull of `points`, 1 to 16 corners clockwise on the screen, rounded by `radius`.

    A subclass is a frozen dataclass that provides `points`. A hull of one corner collides as a circle, one of two
    corners as a capsule or segment, one of more corners as a polygon.
    """

    radius = 0.0  # a subclass declares a field `radius` without a default with field(), else 0.0 would be its default
    _is_convex = True
    _has_mass = True  # False for a line

    @property
    def _kind(self) -> int:
        few = (CIRCLE, CAPSULE if self.radius > 0.0 else SEGMENT)
        return few[len(self.points) - 1] if len(self.points) < 3 else POLYGON

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        (xs, ys), r = zip(*self.points, strict=True), self.radius
        return min(xs) - r, min(ys) - r, max(xs) + r, max(ys) + r

    @cached_property
    def min_half_extent(self) -> float:
        if len(self.points) < 3:
            return self.radius
        points = np.array(self.points)
        edges = np.roll(points, -1, axis=0) - points
        outward = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(*edges.T)[:, None]
        from_center = points - np.array(self.mass_of(1.0).center)
        return float((from_center * outward).sum(axis=1).min()) + self.radius

    def mass_of(self, density: float) -> Mass:
        return convex_mass(self.points, self.radius, density) if self._has_mass else super().mass_of(density)

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        return [(np.array(self.points, np.float64), self.radius)]

    def _parts_at(self, placed: Placed) -> Parts:
        corners = np.zeros((16, 2))
        count, radius = write_hull(placed.geometry, placed.shapes, placed.row, *placed.offset, placed.angle, corners)
        return parts_of([corners[:count]], radius)

    def _facts(self) -> dict[str, Any]:
        """Return the constructor's arguments except `points` as {name: value}, for a snapshot.

        JSON can represent all values.
        """
        return {each.name: getattr(self, each.name) for each in fields(self) if each.init and each.name != "points"}

    @classmethod
    def _load(cls, points: Points, facts: dict[str, Any]) -> Self:
        """Return the shape stored in a snapshot. points: its corners; facts: the result of `_facts`.

        Raises TypeError or ValueError for arguments that the constructor rejects.
        """
        given = {"points": points} if any(each.name == "points" for each in fields(cls)) else {}
        return cls(**given, **facts)


@immutable
@dataclass(frozen=True)
class Circle(Convex):
    """A disc.

    radius: [px], > 0.
    center: (x, y) in body space [px]; the default (0, 0) is the body's position.

    Raises TypeError or ValueError for a radius that is not a number > 0, or a center that is not a finite point.

    >>> Circle(10, center=(5, 0)).bounds
    (-5.0, -10.0, 15.0, 10.0)
    """

    radius: float = field()
    center: Vec2 = MIDDLE

    @explained
    def __init__(self, radius: float, center: Pair = MIDDLE) -> None:
        object.__setattr__(self, "radius", checks.number("radius", radius, above=0.0))
        object.__setattr__(self, "center", checks.vector("center", center))

    @property
    def points(self) -> tuple[Vec2]:
        return (self.center,)


@immutable
@dataclass(frozen=True)
class Capsule(Convex):
    """A capsule: all points within a distance `radius` of the line from a to b.

    a, b: ends of the line (x, y), in body space [px], two different points.
    radius: [px], > 0.

    Raises TypeError for arguments of other types, and ValueError for a radius <= 0. Also raises ValueError if a and b
    are so close to each other that the line has no direction.
    """

    a: Vec2
    b: Vec2
    radius: float = field()

    @explained
    def __init__(self, a: Pair, b: Pair, radius: float) -> None:
        a, b = checks.vector("a", a), checks.vector("b", b)
        radius = checks.number("radius", radius, above=0.0)
        if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST * max(radius, *map(abs, a), *map(abs, b)):
            raise ValueError(
                f"a and b must be two points with a length between them (got {a} and {b}), more than {SHORTEST:g} of "
                f"the radius {radius}; a capsule without length is a Circle"
            )
        object.__setattr__(self, "a", a)
        object.__setattr__(self, "b", b)
        object.__setattr__(self, "radius", radius)

    @property
    def points(self) -> tuple[Vec2, Vec2]:
        return self.a, self.b


@immutable
@dataclass(frozen=True)
class Polygon(Convex):
    """A convex polygon, rounded by a radius.

    points: 3 to 16 corners (n, 2) in body space [px], in either winding; they are stored clockwise on the screen.
    radius: rounding radius, added around the polygon [px], >= 0.

    Raises TypeError for arguments of other types. Raises ValueError for another number of corners, zero area, equal
    corners, three collinear corners, a concave outline (`decompose` divides it), and a radius below 0.
    """

    points: tuple[Vec2, ...]
    radius: float = 0.0

    @explained
    def __init__(self, points: Points, radius: float = 0.0) -> None:
        points = checks.columns("points", points, of="Polygon")
        object.__setattr__(self, "radius", checks.number("radius", radius, low=0.0))
        if not 3 <= len(points) <= MAX_CORNERS:
            hint = ": write Segment(a, b), or Capsule(a, b, radius)" if len(points) == 2 else ""
            raise ValueError(f"points must be 3..{MAX_CORNERS} corners (got {len(points)}){hint}")
        edges = np.roll(points, -1, axis=0) - points
        following = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
        scale = np.hypot(*edges.T) * np.hypot(*following.T)
        shortest = np.hypot(*edges.T).min() <= SHORTEST * np.ptp(points, axis=0).max()
        if shortest or np.any(np.abs(turns) <= STRAIGHT * scale):
            raise ValueError(f"points must have no equal corners and no three in line (got {points.tolist()})")
        # The turns of a convex polygon have one sign and sum to one full turn; a star's turns also have one sign.
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
    def known(cls, points: list[list[float]]) -> Polygon:
        """Return a polygon without checking its corners.

        points: corners [px], convex and clockwise on the screen.

        This saves time for the outlines of masks, which have thousands of polygons.
        """
        found = object.__new__(cls)
        vars(found).update(points=tuple(map(CORNER_OF, points)), radius=0.0)
        return found

    @classmethod
    @explained
    def box(cls, width: float, height: float, center: Pair = (0.0, 0.0), angle: float = 0.0) -> Polygon:
        """Return a rectangle as a Polygon.

        width, height: full side lengths [px], > 0.
        center: centre of the rectangle (x, y) in body space [px].
        angle: rotation of the rectangle about its centre [rad].

        Raises TypeError for arguments of other types, ValueError for values out of range.

        >>> Polygon.box(40, 20).points
        (Vec2(x=-20.0, y=-10.0), Vec2(x=20.0, y=-10.0), Vec2(x=20.0, y=10.0), Vec2(x=-20.0, y=10.0))
        """
        half_width = checks.number("width", width, above=0.0) / 2.0
        half_height = checks.number("height", height, above=0.0) / 2.0
        if min(half_width, half_height) <= SHORTEST * max(half_width, half_height):
            raise ValueError(
                f"width and height must differ by a factor below {1.0 / SHORTEST:g}, or corner points would be equal "
                f"(got {width} and {height})"
            )
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


# ---- blocks ----------------------------------------------------------------------------------------------------------
# Cover of the solid cells of a grid, or of the pixels of a mask, by rectangles.


def solid_blocks(solid: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Return disjoint rectangles (left, top, right, bottom) that cover the solid cells of solid[row, col].

    Right and bottom are exclusive. Each rectangle starts as a maximal sequence of solid cells in one row. The rectangle
    is extended down over the following rows that have a sequence with the same ends.
    """
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


@immutable
class TileGrid(EqualByArrays):
    """A grid of square tiles of one size, for static and kinematic bodies at angle 0.

    solid: solid tiles, bool [row, col]. The origin of body space is the top left corner of tile [0, 0].
    tile_size: side of a tile [px], > 0.
    one_way: one-way platforms, bool [row, col]; bodies pass through them from below, if the world has
        the effect `one_way`. None: no platforms.
    slopes: number [row, col, 2]: height of the surface above the tile's bottom at its left and right side, as a
        fraction 0 to 1 of the tile; (0, 1) rises to the right, (0, 0) is no slope; None: no slopes.

    Raises ValueError if the arrays differ in shape, a slope is out of range, or a cell is more than one of solid,
    one-way and slope; TypeError for arrays of other types.
    """

    solid: np.ndarray
    tile_size: float
    one_way: np.ndarray
    slopes: np.ndarray
    _kind, _is_ground, _may_turn = TILES, True, False
    _array_names, _value_names = ("solid", "one_way", "slopes"), ("tile_size",)

    @explained
    def __init__(
        self, solid: ArrayLike, tile_size: float, one_way: ArrayLike | None = None, slopes: ArrayLike | None = None
    ) -> None:
        solid, tile_size = bools("solid", solid), checks.number("tile_size", tile_size, above=0.0)
        one_way = bools("one_way", one_way if one_way is not None else np.zeros_like(solid))
        try:
            slopes = np.zeros(solid.shape + (2,)) if slopes is None else np.array(slopes, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"slopes must be an array [row, col, 2] of numbers (got {type(slopes).__name__})") from None
        if one_way.shape != solid.shape:
            raise ValueError(f"one_way must have the shape of solid, {solid.shape} (got {one_way.shape})")
        if slopes.shape != solid.shape + (2,):
            raise ValueError(f"slopes must have shape {solid.shape + (2,)} (got {slopes.shape})")
        bad = ~((slopes >= 0.0) & (slopes <= 1.0)).all(axis=2)
        if bad.any():
            at = tuple(int(v) for v in np.argwhere(bad)[0])
            raise ValueError(f"slopes[{at[0]}, {at[1]}] must be within 0..1 (got {slopes[at].tolist()})")
        kinds = solid.astype(int) + one_way + (slopes > 0.0).any(axis=2)
        if (kinds > 1).any():
            at = tuple(int(v) for v in np.argwhere(kinds > 1)[0])
            raise ValueError(
                f"cell [{at[0]}, {at[1]}] must be one of solid, one_way and slope (got {kinds[at]} of them)"
            )
        arrays = {"solid": solid, "one_way": one_way, "slopes": slopes}
        vars(self).update({name: read_only(array) for name, array in arrays.items()}, tile_size=tile_size)

    @cached_property
    def blocks(self) -> tuple[list[tuple[int, int, int, int]], list[list[int]], list[tuple[int, int, int, int]]]:
        """Rectangles that cover the tiles: (solid rectangles, [row, column] of each slope, one-way rectangles).

        A rectangle is (left, top, right, bottom) in cells, right and bottom exclusive.
        """
        return (
            solid_blocks(self.solid),
            np.argwhere((self.slopes > 0.0).any(axis=2)).tolist(),
            solid_blocks(self.one_way),
        )

    @cached_property
    def is_empty(self) -> bool:
        """Whether all cells are empty."""
        return not (self.solid.any() or self.one_way.any() or (self.slopes > 0.0).any())

    @property
    def min_half_extent(self) -> float:
        return self.tile_size / 2.0

    def reach(self, x: float, y: float) -> float:
        height, width = self.solid.shape
        far_x = max(abs(x), abs(width * self.tile_size - x))
        far_y = max(abs(y), abs(height * self.tile_size - y))
        return math.hypot(far_x, far_y)

    @property
    def _key(self) -> tuple:
        cells = (self.solid.tobytes(), self.slopes.tobytes(), self.one_way.tobytes())
        return (*self.solid.shape, self.tile_size, *cells)

    def _outlines(self, x: float, y: float, feet: float) -> list:
        """Return the convex outlines of the tiles, each a list of corners (x, y) [px].

        x, y [px]: position of the grid's origin; feet [px]: y of the lowest point of the other shape, relative to the
        grid's origin. The outline of a one-way tile is the line along its top. This line is omitted if the other
        shape's lowest point is below it.
        """
        size = self.tile_size
        solid, slopes, one_way = self.blocks
        found = [
            rectangle(x + left * size, y + top * size, x + right * size, y + bottom * size)
            for left, top, right, bottom in solid
        ]
        for row, column in slopes:
            left, right = (y + (row + 1) * size - height * size for height in self.slopes[row, column].tolist())
            x_left, x_right, bottom = x + column * size, x + (column + 1) * size, y + (row + 1) * size
            corners = [(x_left, left), (x_right, right), (x_right, bottom), (x_left, bottom)]
            found.append([each for k, each in enumerate(corners) if k > 1 or each[1] < bottom])
        for left, top, right, bottom in one_way:
            found += [
                [(x + left * size, y + row * size), (x + right * size, y + row * size)]
                for row in range(top, bottom)
                if feet <= row * size
            ]
        return found

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        return [(np.array(each, np.float64), 0.0) for each in self._outlines(0.0, 0.0, -math.inf)]

    def _parts_at(self, placed: Placed) -> Parts:
        return parts_of(self._outlines(*placed.offset, placed.feet - float(placed.body["y"])))

    def _check_body(self, kind: int, angles: ArrayLike) -> None:
        if kind == DYNAMIC or np.any(np.asarray(angles) != 0.0):
            raise ValueError(
                f"a TileGrid needs kind static or kinematic and angle 0 (got {KINDS[kind]}, "
                f"{np.asarray(angles).tolist()})"
            )

    def __repr__(self):
        return f"TileGrid({self.solid.shape[0]} x {self.solid.shape[1]} tiles of {self.tile_size} px)"


def bools(name: str, value: ArrayLike) -> np.ndarray:
    """Return an array [row, col] of bools or integers as a C-contiguous array of bools.

    name: name of the argument, for messages. Raises TypeError for other values and for rows of different lengths,
    ValueError for an array that is not 2D.
    """
    _refuse_pixels_of_pygame(name, value)
    try:
        array = np.array(value)
    except ValueError:
        raise TypeError(f"{name} must be an array [row, col] of bool (got rows of different lengths)") from None
    if array.ndim != 2:
        got = f"shape {array.shape}" if array.ndim > 2 else checks.shown(value)
        wrong = ValueError if array.ndim else TypeError
        raise wrong(f"{name} must be an array [row, col] of bool (got {got}){hints.in_place_of_solid(value)}")
    if array.dtype != np.bool_ and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{name} must be an array of bool (got {array.dtype}){hints.in_place_of_solid(value)}")
    return np.ascontiguousarray(array != 0)


def _refuse_pixels_of_pygame(name: str, value: Any) -> None:
    """Raise TypeError for a pygame Mask or Surface, which NumPy would read as an array of wrong pixels.

    name: name of the argument, for the message.
    """
    pygame = sys.modules.get("pygame")  # a caller with a Mask has imported it; physics does not
    for kind, way_in in (("Mask", "from_mask(mask)"), ("Surface", "from_surface(surface)")):
        known = getattr(pygame, kind, None)
        if isinstance(known, type) and isinstance(value, known):
            raise TypeError(
                f"{name} must be an array [row, col] of bool (got the pygame {kind} {value!r}): "
                f"PixelMask.{way_in} takes it"
            )


# ---- lines -----------------------------------------------------------------------------------------------------------
# Lines without an inside: Segment (two-sided) and Chain (one-sided).

SHORTEST_LINK = 1e-12  # share of the largest coordinate: a shorter link has no direction


def _check_length(name, a, b):
    if math.hypot(b[0] - a[0], b[1] - a[1]) <= SHORTEST_LINK * max(map(abs, (*a, *b))):
        raise ValueError(f"{name} must be two points with a length between them (got {a} and {b})")


@immutable
@dataclass(frozen=True)
class Segment(Convex):
    """The line from a to b, solid from both sides, without mass.

    a, b: ends of the line (x, y), in body space [px], two different points.

    Raises TypeError for arguments of other types, ValueError if a and b coincide.
    """

    a: Vec2
    b: Vec2
    _has_mass = False

    @explained
    def __init__(self, a: Pair, b: Pair) -> None:
        object.__setattr__(self, "a", checks.vector("a", a))
        object.__setattr__(self, "b", checks.vector("b", b))
        _check_length("a and b", self.a, self.b)

    @property
    def points(self) -> tuple[Vec2, Vec2]:
        return self.a, self.b


@immutable
@dataclass(frozen=True)
class Chain(EqualByValue):
    """Connected one-sided lines (links) from point to point, without mass; for static and kinematic bodies.

    points: ends of the links (n, 2), in body space [px]; at least 2, at least 3 for a loop.
    loop: whether the last point is linked to the first.
    ghosts: (before, after), points (x, y) [px] that continue the chain beyond its two ends; each may be None.
        Ghosts only smooth collisions at the ends, and are not solid themselves.
    materials: one Material per link; None: the material of the shape or body.

    A link of direction (dx, dy) is solid from the side to which (dy, -dx) points. So list the points of a floor from
    left to right. List those of a solid island clockwise on the screen, and those of a room counter-clockwise. Raises
    TypeError for arguments of other types; ValueError for too few points, a link without length, a number of materials
    other than the number of links, and ghosts of a loop.
    """

    points: tuple[Vec2, ...]
    loop: bool = False
    ghosts: tuple[Vec2 | None, Vec2 | None] | None = None
    materials: tuple[Material, ...] | None = None
    radius, _kind, _is_ground = 0.0, CHAIN, True

    @explained
    def __init__(
        self,
        points: Points,
        loop: bool = False,
        ghosts: Sequence[Pair | None] | None = None,
        materials: Sequence[Material] | None = None,
    ) -> None:
        points = tuple(Vec2(x, y) for x, y in checks.columns("points", points, of="Chain").tolist())
        loop = checks.flag("loop", loop)
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
        object.__setattr__(self, "ghosts", self._checked_ghosts(ghosts))
        object.__setattr__(self, "materials", self._checked_materials(materials))

    def _checked_ghosts(self, given):
        if given is None:
            return None
        if self.loop:
            raise ValueError(
                f"ghosts must be None for a loop, whose ends are each other's neighbours (got {checks.shown(given)})"
            )
        pair = checks.two(given)
        if pair is None:
            raise TypeError(f"ghosts must be a pair of points (before, after) (got {checks.shown(given)})")
        ghosts = tuple(None if each is None else checks.vector(f"ghosts[{k}]", each) for k, each in enumerate(pair))
        for k, end in enumerate((self.points[0], self.points[-1])):
            if ghosts[k] is not None:
                _check_length(f"ghosts[{k}] and the end it smooths", ghosts[k], end)
        return ghosts

    def _checked_materials(self, given):
        if given is None:
            return None
        if not isinstance(given, (tuple, list)):
            raise TypeError(f"materials must be a tuple of Material, one per link (got {checks.shown(given)})")
        materials = tuple(given)
        for k, each in enumerate(materials):
            if not isinstance(each, Material):
                raise TypeError(f"materials[{k}] must be a Material (got {checks.shown(each)})")
        if len(materials) != self.links:
            raise ValueError(f"materials must be {self.links}, one per link (got {len(materials)})")
        return materials

    @property
    def links(self) -> int:
        """Number of links (lines between successive points)."""
        return len(self.points) if self.loop else len(self.points) - 1

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        """Return each link as a hull of two corners with radius 0."""
        points = list(self.points) + ([self.points[0]] if self.loop else [])
        return [(np.array(each, np.float64), 0.0) for each in pairwise(points)]

    def _check_body(self, kind: int, angles: ArrayLike) -> None:
        if kind == DYNAMIC:
            raise ValueError("a Chain needs kind static or kinematic (got dynamic): it has no inside and no mass")
