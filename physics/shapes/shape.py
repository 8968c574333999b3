"""The protocol of all shapes, the values that a shape may have of its own, and the convex parts of a shape."""

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.checks import Points
from physics.shapes.mass import NOTHING, Mass
from physics.tables.geometry import Geometry

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


# ---- parts -----------------------------------------------------------------------------------------------------------
# Convex decomposition of shapes into rounded hulls, between which distance and time of impact are measured.

NEAR = 1e-9  # relative to the coordinates: margin of a query box, since casts round as well


class Parts(NamedTuple):
    """Convex parts of one shape."""

    corners: np.ndarray  # (n, 16, 2) [px]
    counts: np.ndarray  # (n,) corners of each
    boxes: np.ndarray  # min_x min_y max_x max_y of each part, rounding included
    radii: np.ndarray  # (n,) rounding of each [px]


def parts_of(outlines: Sequence, radii: ArrayLike = 0.0) -> Parts:
    """Return the Parts of outlines of 1 to 16 corners (n, 2), clockwise on the screen, with their rounding [px]."""
    corners, counts = np.zeros((len(outlines), 16, 2)), np.zeros(len(outlines), np.int64)
    for k, outline in enumerate(outlines):
        counts[k] = len(outline)
        corners[k, : len(outline)] = outline
    return with_boxes(corners, counts, np.full(len(outlines), radii, np.float64))


def with_boxes(corners: np.ndarray, counts: np.ndarray, radii: np.ndarray) -> Parts:
    """Return Parts of corners (n, 16, 2), counts and roundings, with their bounding boxes."""
    used = (np.arange(16)[None, :] < counts[:, None])[:, :, None]
    low, high = np.where(used, corners, np.inf).min(axis=1), np.where(used, corners, -np.inf).max(axis=1)
    return Parts(corners, counts, np.concatenate([low - radii[:, None], high + radii[:, None]], axis=1), radii)


def turned_parts(parts: Parts, x: float, y: float, cosine: float, sine: float) -> Parts:
    """Return parts in body space moved to the pose of their body: (x, y) [px], cosine and sine of its angle."""
    corners = parts.corners @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y)
    return with_boxes(corners, parts.counts, parts.radii)


def parts_near(parts: Parts, left: float, top: float, right: float, bottom: float) -> Parts:
    """Return the parts whose boxes meet a closed box [px], enlarged by a rounding margin."""
    reach = NEAR * max(map(abs, (left, top, right, bottom)))
    low, high = parts.boxes[:, :2], parts.boxes[:, 2:]
    keep = (low <= (right + reach, bottom + reach)).all(axis=1) & (high >= (left - reach, top - reach)).all(axis=1)
    return Parts(*(column[keep] for column in parts))


def rectangle(left: float, top: float, right: float, bottom: float) -> list[tuple[float, float]]:
    """Return the corners of a box, clockwise on the screen."""
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


class Placed(NamedTuple):
    """A shape at the pose of its SHAPE row, seen from a point, to which its parts are relative."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE
    row: int  # of shapes
    x: float  # [px] the point
    y: float
    feet: float  # [px] lowest point of the other shape: a one-way tile is present only for shapes wholly above it
    swept: bool = False  # a mask is represented by its outline at the exact pose, as in sweeps, not by its pixels

    @property
    def body(self) -> Any:
        """The BODY row."""
        return self.bodies[self.shapes[self.row]["body_row"]]

    @property
    def angle(self) -> float:
        """Angle of the body [rad]."""
        return float(self.body["angle"])

    @property
    def offset(self) -> tuple[float, float]:
        """Position of the body, seen from the point [px]."""
        body = self.body
        return float(body["x"]) - self.x, float(body["y"]) - self.y


# ---- protocol --------------------------------------------------------------------------------------------------------


class Shape:
    """Protocol of all shapes: immutable values in body space [px], x right, y down, without a pose.

    Callers ask the shape, never for its type. The answers given here are those of ground: without mass, its pieces
    turned with its body. Convex (values.py) answers all from corners and a radius; SHAPES (kinds.py) lists the types.
    """

    material: Material | None = None  # values of its own; None, for all three: the body's value
    filter: Filter | None = None
    sensor: bool | None = None

    points: Points  # of a convex shape: its 1 to 16 corners, clockwise on the screen; of a chain: the ends of its links
    radius: float  # rounding of a shape with points [px]
    snap: bool = False  # whether it is a mask that is tested as drawn
    _kind: int  # of its SHAPE row, which decides how it collides: CIRCLE, POLYGON, …
    _is_convex: bool = False  # one rounded hull at each pose
    _has_mass: bool = False  # it has an area, which weighs and can be carved with or wrapped in a Bounds
    _is_ground: bool = False  # static or kinematic, and it never meets other ground
    _may_turn: bool = True  # a body that has it may have an angle

    def mass_of(self, density: float) -> Mass:
        """Return its mass; density [mass per px2]."""
        return NOTHING

    @property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """Bounds (min_x, min_y, max_x, max_y) in body space [px] of a shape with mass; None for an empty one."""
        return None

    @property
    def min_half_extent(self) -> float:
        """Inradius [px]: from the centre of mass to the nearest point of its surface; 0 of lines."""
        return 0.0

    @property
    def _thinnest_half(self) -> float:
        """Inradius at its thinnest part [px], where it responds by parts."""
        return self.min_half_extent

    def reach(self, x: float, y: float) -> float:
        """Return the distance [px] from (x, y) to its furthest point."""
        return max(math.hypot(px - x, py - y) for px, py in self.points) + self.radius

    @property
    def _inner(self) -> "Shape":
        """The shape inside a Bounds; else the shape itself."""
        return self

    @property
    def _key(self) -> tuple:
        """Numbers and bytes that order the shapes of one type."""
        return (self.radius, len(self.points), *(each for point in self.points for each in point))

    def _hulls(self) -> list[tuple[np.ndarray, float]]:
        """Return the convex hulls [(corners (n, 2), radius)] in body space that make it up; of a mask its pixels."""
        return []

    @property
    def _pixel_parts(self) -> Parts:
        """Its hulls as Parts in body space."""
        hulls = self._hulls()
        return parts_of([corners for corners, _ in hulls], [radius for _, radius in hulls])

    @property
    def _parts(self) -> Parts:
        """Its convex parts in body space, for sweeps: its hulls; of a mask those of its outline."""
        return self._pixel_parts

    def _box_at(self, angle: float) -> Parts:
        """Return its AABB in a body at an angle [rad], as one part; no part if it is empty."""
        boxes = turned_parts(self._pixel_parts, 0.0, 0.0, math.cos(angle), math.sin(angle)).boxes
        return parts_of([rectangle(*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0))] if len(boxes) else [])

    def _rotation(self, angle: float) -> tuple[float, float]:
        """Return (cosine, sine) of the angle [rad] of its body."""
        return math.cos(angle), math.sin(angle)

    def _parts_at(self, placed: Placed) -> Parts:
        """Return its convex parts at the pose of its SHAPE row."""
        cosine, sine = self._rotation(placed.angle)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        return parts_of([corners @ turn + placed.offset for corners, _ in self._hulls()])

    def _response_parts(self) -> Sequence[tuple[int, Sequence]]:
        """Return [(tile, parts)] that respond in place of the shape, each with a SHAPE row; (): it responds."""
        return ()

    def _check_body(self, kind: int, angles: ArrayLike) -> None:
        """Raise ValueError where a body of a kind at angles [rad] cannot have it."""

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

    def with_values_of(self, other: "Shape") -> Self:
        """Return this shape with the own values of another one."""
        return self.with_(other.material, other.filter, other.sensor)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


@dataclass(frozen=True)
class EqualByValue(Shape):
    """Base of the shapes that are equal when their geometry and their own values are."""

    material: Material | None = field(default=None, init=False, repr=False)
    filter: Filter | None = field(default=None, init=False, repr=False)
    sensor: bool | None = field(default=None, init=False, repr=False)
