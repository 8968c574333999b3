"""Base class of all shapes, the classes Filter and Material for values of shapes, and convex parts of shapes."""

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b
from typing import Any, ClassVar, NamedTuple, Never, Self

import numpy as np
from numpy.typing import ArrayLike

from physics import checks, hints
from physics.hints import MATERIALS, unexpected, without_others
from physics.math2d import Vec2
from physics.shapes.mass import NOTHING, Mass
from physics.tables.geometry import Geometry

# ---- filter ----------------------------------------------------------------------------------------------------------
# Collision filter, applied before any narrow phase.


@hints.unchangeable("body.filter = replace(body.filter, {name}={value}), of the module dataclasses")
@dataclass(frozen=True)
class Filter:
    """Collision filter: categories that a shape belongs to, and categories that it collides with, 32 bits each.

    membership: bits of the categories that the shape belongs to, 0 to 0xFFFFFFFF.
    mask: bits of the categories that the shape collides with, 0 to 0xFFFFFFFF.

    Shapes a and b collide if a.membership & b.mask and b.membership & a.mask are both not 0. Filter.ALL has all bits
    set. Raises TypeError for a value that is not a whole number, ValueError for a value out of range.
    """

    ALL: ClassVar["Filter"]  # collides with every shape

    membership: int = 1
    mask: int = 0xFFFFFFFF

    @without_others
    def __init__(self, membership: int = 1, mask: int = 0xFFFFFFFF, **others: Never) -> None:
        if others:
            raise unexpected("Filter", ("membership", "mask"), others)
        object.__setattr__(self, "membership", checks.whole("membership", membership, 0, 0xFFFFFFFF))
        object.__setattr__(self, "mask", checks.whole("mask", mask, 0, 0xFFFFFFFF))

    def __repr__(self):
        """Return the constructor call as text, with hexadecimal bits, or "Filter.ALL"."""
        if self.membership == self.mask == 0xFFFFFFFF:
            return "Filter.ALL"
        mask = "" if self.mask == 0xFFFFFFFF else f", mask={self.mask:#x}"
        return f"Filter(membership={self.membership:#x}{mask})"

    @classmethod
    def from_packed(cls, bits: int) -> "Filter":
        """Return the Filter whose two fields are packed in one 32-bit number.

        bits: membership in the low 16 bits, mask in the high 16 bits, 0 to 0xFFFFFFFF.

        Raises TypeError for a value that is not a whole number, ValueError for a value out of range.
        """
        bits = checks.whole("bits", bits, 0, 0xFFFFFFFF)
        return cls(bits & 0xFFFF, bits >> 16)


Filter.ALL = Filter(0xFFFFFFFF, 0xFFFFFFFF)


# ---- material --------------------------------------------------------------------------------------------------------
# Material: surface and density of a shape.


@hints.unchangeable("body.material = replace(body.material, {name}={value}), of the module dataclasses")
@dataclass(frozen=True)
class Material:
    """Density and surface properties of a shape.

    density: mass per area [per px²], > 0.
    friction: coefficient, >= 0; a contact has the geometric mean of both materials.
    restitution: speed after an impact divided by the approach speed, >= 0; a contact has the greater of both.
    rolling_resistance: >= 0; a contact has the greater of both, and a torque against rolling of at most
        rolling_resistance · radius · load.
    surface_speed: speed of the surface along its tangent [px/s], as on a conveyor belt.

    Except for density, a value acts only with an effect of the world: friction and restitution with the effect of the
    same name, surface_speed with conveyor, rolling_resistance with friction. Raises TypeError for a value that is not a
    number, ValueError for a value out of range.
    """

    density: float = 1.0
    friction: float = 0.6
    restitution: float = 0.0
    rolling_resistance: float = 0.0
    surface_speed: float = 0.0

    @without_others
    def __init__(
        self,
        density: float = 1.0,
        friction: float = 0.6,
        restitution: float = 0.0,
        rolling_resistance: float = 0.0,
        surface_speed: float = 0.0,
        **others: Never,
    ) -> None:
        if others:
            raise unexpected("Material", MATERIALS, others)
        write = object.__setattr__
        write(self, "density", checks.number("density", density, above=0.0))
        write(self, "friction", checks.number("friction", friction, low=0.0))
        write(self, "restitution", checks.number("restitution", restitution, low=0.0))
        write(self, "rolling_resistance", checks.number("rolling_resistance", rolling_resistance, low=0.0))
        write(self, "surface_speed", checks.number("surface_speed", surface_speed))


def checked_material(value: Any) -> Material:
    """Return `value` if it is a Material, else raise TypeError."""
    if not isinstance(value, Material):
        hint = hints.in_place_of_material(value)
        raise TypeError(f"material must be a Material (got {checks.shown(value)}){hint}")
    return value


def checked_filter(value: Any) -> Filter:
    """Return `value` if it is a Filter, else raise TypeError."""
    if not isinstance(value, Filter):
        raise TypeError(f"filter must be a Filter (got {checks.shown(value)}){hints.in_place_of_filter(value)}")
    return value


# ---- parts -----------------------------------------------------------------------------------------------------------
# Convex decomposition of shapes into hulls with a rounding radius, between which distance and time of impact are
# measured.

NEAR = 1e-9  # margin of a query box relative to its coordinates: casts have rounding errors of this size


class Parts(NamedTuple):
    """Convex parts of one shape: polygons, each enlarged by a rounding radius."""

    corners: np.ndarray  # (n, 16, 2) [px]
    counts: np.ndarray  # (n,) number of corners of each part
    boxes: np.ndarray  # (n, 4) AABB of each part with its rounding: min_x, min_y, max_x, max_y [px]
    radii: np.ndarray  # (n,) rounding radius of each part [px]


def parts_of(outlines: Sequence, radii: ArrayLike = 0.0) -> Parts:
    """Return Parts made of convex outlines, each of 1 to 16 corners [px] clockwise on the screen.

    radii [px]: rounding radius, one number for all outlines or one each.
    """
    corners, counts = np.zeros((len(outlines), 16, 2)), np.zeros(len(outlines), np.int64)
    for k, outline in enumerate(outlines):
        counts[k] = len(outline)
        corners[k, : len(outline)] = outline
    return with_boxes(corners, counts, np.full(len(outlines), radii, np.float64))


def with_boxes(corners: np.ndarray, counts: np.ndarray, radii: np.ndarray) -> Parts:
    """Return Parts with the given columns, and with AABBs computed from them. For shapes and units see Parts."""
    used = (np.arange(16)[None, :] < counts[:, None])[:, :, None]
    low, high = np.where(used, corners, np.inf).min(axis=1), np.where(used, corners, -np.inf).max(axis=1)
    return Parts(corners, counts, np.concatenate([low - radii[:, None], high + radii[:, None]], axis=1), radii)


def turned_parts(parts: Parts, x: float, y: float, cosine: float, sine: float) -> Parts:
    """Return Parts transformed from body space to the world, for a body at (x, y) [px] rotated by (cosine, sine)."""
    corners = parts.corners @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y)
    return with_boxes(corners, parts.counts, parts.radii)


def parts_near(parts: Parts, left: float, top: float, right: float, bottom: float) -> Parts:
    """Return the subset of `parts` whose AABBs overlap or touch the box (left, top, right, bottom) [px].

    The box is first enlarged by a margin for rounding errors.
    """
    reach = NEAR * max(map(abs, (left, top, right, bottom)))
    low, high = parts.boxes[:, :2], parts.boxes[:, 2:]
    keep = (low <= (right + reach, bottom + reach)).all(axis=1) & (high >= (left - reach, top - reach)).all(axis=1)
    return Parts(*(column[keep] for column in parts))


def rectangle(left: float, top: float, right: float, bottom: float) -> list[tuple[float, float]]:
    """Return the four corners of the box (left, top, right, bottom), clockwise on the screen from the top left."""
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


class Placed(NamedTuple):
    """A shape of a world at its pose. For precision, coordinates are relative to a point (x, y) near the shape."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE
    row: int  # row of `shapes`
    x: float  # [px] (x, y): point to which coordinates are relative
    y: float
    feet: float  # [px] lowest point of the other shape: a one-way tile is present only for shapes wholly above it
    swept: bool = False  # True: parts of a mask are its outline at the exact pose, as in sweeps, not its pixels

    @property
    def body(self) -> Any:
        """BODY row of the shape's body."""
        return self.bodies[self.shapes[self.row]["body_row"]]

    @property
    def angle(self) -> float:
        """Angle of the body [rad]."""
        return float(self.body["angle"])

    @property
    def offset(self) -> tuple[float, float]:
        """Position [px] of the body relative to the point (x, y)."""
        body = self.body
        return float(body["x"]) - self.x, float(body["y"]) - self.y


# ---- protocol --------------------------------------------------------------------------------------------------------

immutable = hints.unchangeable("body.set_shapes({kind}(…)), with a new {kind}", ", as shapes are immutable")


def read_only(array: np.ndarray) -> np.ndarray:
    """Make an array read-only, and return it."""
    array.flags.writeable = False
    return array


@immutable
class Shape:
    """Base of all shapes. A shape is an immutable value in body space [px], x right, y down, without a pose.

    material, filter, sensor: own Material, Filter and bool of the shape, see with_; None for each: those of the body.
    points: corners of a convex shape, clockwise on the screen, or ends of the links of a chain [px].
    radius: radius of a circle or capsule, rounding of a polygon [px], 0 for other shapes.

    Callers use these methods and never test the type. The methods of this base class suit ground shapes: they have no
    mass, and hulls that rotate with the body. Convex (values.py) computes all results from corners and a radius. SHAPES
    (kinds.py) lists the types.
    """

    material: Material | None = None  # own material, filter and sensor of the shape; None: its body's
    filter: Filter | None = None
    sensor: bool | None = None

    # Of a convex shape: its 1 to 16 corners, clockwise on the screen; of a chain: the ends of its links.
    points: Sequence[Vec2]
    radius: float  # rounding of a shape with points [px]
    snap: bool = False  # whether the shape is a mask that is tested as drawn
    _kind: int  # kind of the SHAPE row: CIRCLE, POLYGON, …; it decides how the shape collides
    _is_convex: bool = False  # at each pose the shape is one convex hull with a rounding radius
    _has_mass: bool = False  # the shape has an area: it has mass, and it can carve and be wrapped in a Bounds
    _is_ground: bool = False  # only for static and kinematic bodies, and never tested against other ground
    _may_turn: bool = True  # a body with this shape may have an angle other than 0

    def mass_of(self, density: float) -> Mass:
        """Return the Mass of the shape, which is 0 for lines and tiles.

        density: mass per area [per px²]; it is not checked.
        """
        return NOTHING

    @property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """AABB (min_x, min_y, max_x, max_y) [px] in body space; None for empty shapes, tile grids and chains."""
        return None

    @property
    def min_half_extent(self) -> float:
        """Inradius [px]: distance from the centre of mass to the nearest point of the surface; 0 for lines."""
        return 0.0

    @property
    def _thinnest_half(self) -> float:
        """Smallest inradius [px] of the parts with which the shape collides; min_half_extent if it has no parts."""
        return self.min_half_extent

    def reach(self, x: float, y: float) -> float:
        """Return the distance [px] from the point (x, y) to the farthest point of the shape.

        x, y: coordinates in body space [px]; they are not checked.
        """
        return max(math.hypot(px - x, py - y) for px, py in self.points) + self.radius

    @property
    def _inner(self) -> "Shape":
        """The shape that a Bounds wraps; for any other shape, the shape itself."""
        return self

    @property
    def _key(self) -> tuple:
        """Sort key of the shape among shapes of the same type: a tuple of numbers and bytes."""
        return (self.radius, len(self.points), *(each for point in self.points for each in point))

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        """Return the convex hulls of the shape in body space: [(corners (n, 2) [px], rounding radius [px])].

        The hulls of a mask are rectangles of pixels.
        """
        return []

    @property
    def _pixel_parts(self) -> Parts:
        """The shape's hulls (see _hulls) as Parts in body space; for a mask, rectangles of pixels."""
        hulls = self._hulls()
        return parts_of([corners for corners, _ in hulls], [radius for _, radius in hulls])

    @property
    def _parts(self) -> Parts:
        """Convex parts of the shape in body space, for sweeps: its hulls, or for a mask the parts of its outline."""
        return self._pixel_parts

    def _box_at(self, angle: float) -> Parts:
        """Return the shape's AABB as Parts with one part, for a body at (0, 0) and an angle [rad].

        For an empty shape the result has no part.
        """
        boxes = turned_parts(self._pixel_parts, 0.0, 0.0, math.cos(angle), math.sin(angle)).boxes
        return parts_of([rectangle(*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0))] if len(boxes) else [])

    def _rotation(self, angle: float) -> tuple[float, float]:
        """Return (cosine, sine) of an angle [rad] with the rounding that kernels use for this type of shape."""
        return math.cos(angle), math.sin(angle)

    def _parts_at(self, placed: Placed) -> Parts:
        """Return the convex Parts of a shape at its body's pose, in coordinates relative to (placed.x, placed.y)."""
        cosine, sine = self._rotation(placed.angle)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        return parts_of([corners @ turn + placed.offset for corners, _ in self._hulls()])

    def _response_parts(self) -> Sequence[tuple[int, Sequence]]:
        """Return the parts that collide in place of the shape, by tile: [(tile number, parts)]; () if it has no parts.

        Each part has a SHAPE row.
        """
        return ()

    def _check_body(self, kind: int, angles: ArrayLike) -> None:
        """Raise ValueError if a body of this kind at one of these angles [rad] cannot have the shape.

        kind: STATIC, KINEMATIC or DYNAMIC.
        """

    def with_(self, material: Material | None = None, filter: Filter | None = None, sensor: bool | None = None) -> Self:
        """Return a copy of the shape with its own material, filter and sensor, used instead of the body's values.

        material, filter, sensor: a Material, a Filter, a bool; None for each: the body's value applies.

        The density of such a material is used for the body's mass. Raises TypeError for a value of another type.
        """
        material = None if material is None else checked_material(material)
        filter = None if filter is None else checked_filter(filter)
        sensor = None if sensor is None else checks.flag("sensor", sensor)
        bare = self.bare
        if material is None and filter is None and sensor is None:
            return bare
        found = copy.copy(bare)
        vars(found).update(material=material, filter=filter, sensor=sensor, _bare=bare)
        return found

    @property
    def bare(self) -> Self:
        """The shape without its own material, filter and sensor.

        Shapes that differ only in these values have the same `bare` shape, so a library stores their geometry once.
        """
        return vars(self).get("_bare", self)

    def with_values_of(self, other: "Shape") -> Self:
        """Return a copy of this shape with the material, filter and sensor of another shape."""
        return self.with_(other.material, other.filter, other.sensor)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


@immutable
@dataclass(frozen=True)
class EqualByValue(Shape):
    """Base of shapes that are equal if their geometry, material, filter and sensor are equal."""

    material: Material | None = field(default=None, init=False, repr=False)
    filter: Filter | None = field(default=None, init=False, repr=False)
    sensor: bool | None = field(default=None, init=False, repr=False)


class EqualByArrays(Shape):
    """Base of shapes made of arrays. They are equal if their arrays, material, filter and sensor are equal.

    The arrays are read-only. The hash is computed when it is first needed, and stored.
    """

    _array_names: ClassVar[tuple[str, ...]] = ()  # attributes that are compared as arrays; the first one is hashed
    _value_names: ClassVar[tuple[str, ...]] = ()  # other attributes that are compared

    @cached_property
    def _hash(self) -> int:
        # It depends on no random seed of the process, so a pickled shape keeps it; copies by with_ share it.
        first: np.ndarray = getattr(self, self._array_names[0])
        return int.from_bytes(blake2b(first.tobytes(), digest_size=7).digest(), "little")

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        """Return whether the other value is a shape of the same type with equal values."""
        if self is other:
            return True
        if type(self) is not type(other):
            return NotImplemented
        names = (*self._value_names, "material", "filter", "sensor")
        if any(getattr(self, name) != getattr(other, name) for name in names):
            return False
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in self._array_names)
