"""Description of a scene, independent of any engine: metres, seconds and radians; x right, y down."""

import math
from dataclasses import dataclass

GRAVITY = 10.0  # [m/s2]
STEP = 1 / 60  # [s]
FRICTION = 0.6  # between all bodies unless said


@dataclass(frozen=True)
class Part:
    """A disc (one point and a radius) or a convex polygon with its corners clockwise on the
    screen, in body space [m].
    """

    points: tuple[tuple[float, float], ...]
    radius: float = 0.0


def box(width, height, x=0.0, y=0.0):
    """Return a box as a `Part` with its centre at (x, y)."""
    w, h = 0.5 * width, 0.5 * height
    return Part(((x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)))


def disc(radius):
    return Part(((0.0, 0.0),), radius)


def polygon(points):
    """Return (x, y, part): the centroid of a polygon, and the polygon relative to it. points:
    corners in either order.
    """
    area = x = y = 0.0
    for (ax, ay), (bx, by) in zip(points, (*points[1:], points[0]), strict=True):
        cross = ax * by - bx * ay
        area, x, y = area + 0.5 * cross, x + (ax + bx) * cross / 6.0, y + (ay + by) * cross / 6.0
    x, y = x / area, y / area
    about = tuple((px - x, py - y) for px, py in points)
    return x, y, Part(about if area > 0.0 else about[::-1])


@dataclass(frozen=True)
class Solid:
    """A body whose parts are given relative to its centre of mass, which is its origin.

    friction, restitution: values of the contact between two bodies with equal values.
    """

    parts: tuple[Part, ...]
    x: float
    y: float
    angle: float = 0.0
    vx: float = 0.0
    vy: float = 0.0
    spin: float = 0.0  # [rad/s]
    kind: str = "dynamic"  # or static, or kinematic
    density: float = 1.0  # [kg/m2]
    friction: float = FRICTION
    restitution: float = 0.0

    @property
    def least(self):
        """Return the smaller of the first part's extents along x and y [m]."""
        part = self.parts[0]
        extents = (max(each) - min(each) for each in zip(*part.points, strict=True))
        return min(extents) + 2.0 * part.radius


@dataclass(frozen=True)
class Fall:
    """Limits beyond which a dynamic body counts as fallen; the scene ends when one falls.

    A body has fallen if it moved sideways by more than both `share` of its smallest extent and `shift` [m], or turned
    by more than `turn` [rad].
    """

    share: float = 0.5
    shift: float = 0.15
    turn: float = 0.35


TURNS = Fall(share=math.inf, shift=math.inf, turn=0.1)


@dataclass(frozen=True)
class Scene:
    """The bodies, duration and settings of a scene. removals: (step before which to remove,
    index of the removed body).
    """

    solids: tuple[Solid, ...]
    seconds: float
    gravity: float = GRAVITY
    sleeping: bool = False
    fall: Fall | None = None
    removals: tuple[tuple[int, int], ...] = ()

    @property
    def steps(self):
        return round(self.seconds / STEP)

    @property
    def dynamic(self):
        """Return the indices of the dynamic bodies."""
        return [k for k, solid in enumerate(self.solids) if solid.kind == "dynamic"]


def floor(friction=FRICTION, restitution=0.0, angle=0.0):
    """Return a thick floor whose surface passes through the origin; a positive angle slopes it down to the right."""
    return Solid(
        (box(400.0, 2.0),),
        x=-math.sin(angle),
        y=math.cos(angle),
        angle=angle,
        kind="static",
        friction=friction,
        restitution=restitution,
    )
