"""Kinds of joints: one dataclass for each kind. Its method `columns` converts settings to columns of JOINT rows.

A joint has two anchors, one on each body. It holds the anchors together in both directions (PINNED), only across an
axis of A (ON_AXIS), or not at all (FREE). It may also hold the angle. On one coordinate (an angle, a translation or a
length) it may have limits, a motor and a spring. A gear couples two other joints, and a pulley couples two bodies. To
add a kind, define a class here and add it to KINDS.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from physics import checks, hints
from physics.annotations import BodyRef, Pair, Range
from physics.hints import explained_class
from physics.tables.joint import ANGLE, GEARED, LENGTH, NO_COORDINATE, ON_AXIS, PINNED, SLUNG, TOOTHED, TRANSLATION

# ---- settings --------------------------------------------------------------------------------------------------------


@explained_class
@dataclass(frozen=True)
class Drive:
    """A joint motor, which drives the coordinate of its joint: an angle, a translation or a length.

    speed: target speed of the coordinate [px/s, or rad/s for an angle].
    max: greatest force [mass px/s²] or torque [mass px²/s²], >= 0; it must be given.

    A force of mass · a accelerates a mass by a [px/s²]. At the rim of a wheel, the torque is mass · a · radius.

    Raises TypeError if a value is not a number, ValueError if max is missing or below 0, or if a number is not finite.
    """

    speed: float
    max: float | None = None

    def __post_init__(self):
        checks.number("speed", self.speed)
        if self.max is None:
            raise ValueError("max must be given, the greatest force or torque of the motor: a number >= 0 (got None)")
        checks.number("max", self.max, low=0.0)


@explained_class
@dataclass(frozen=True)
class Spring:
    """A joint spring, on the coordinate of its joint: an angle, a translation or a length.

    hertz: frequency [1/s], > 0; damping: damping ratio, >= 0; 1 is critical.
    target: the coordinate at which the spring rests [px or rad]; None: the coordinate when the joint is made.

    Frequency and damping are those of the two bodies and their joint alone, without other forces. A door swings about
    its hinge with this frequency, and does not overshoot with a damping of 1. The stiffness is k = m (2 pi hertz)²,
    where m is the effective mass or moment of inertia of this motion.

    Raises TypeError if a value is not a number; ValueError for hertz <= 0, damping < 0, or a number that is not finite.
    """

    hertz: float
    damping: float = 1.0
    target: float | None = None

    def __post_init__(self):
        checks.number("hertz", self.hertz, above=0.0)
        checks.number("damping", self.damping, low=0.0)
        if self.target is not None:
            checks.number("target", self.target)


def is_endless(value: Any, end: float) -> bool:
    """Return whether a value is the float `end`, which is inf or -inf and stands for no limit."""
    return isinstance(value, float) and value == end


def checked_limits(value: Any, low: float | None = None) -> tuple[float, float]:
    """Return the limits of a coordinate as (low, high), with -inf or inf for no limit.

    value: a pair (low, high) in which None means no limit on that side, or None for no limits at all. low: least
    allowed limit. Raises TypeError if value is not a pair of numbers; ValueError for low > high, or a limit below
    `low`.
    """
    if value is None:
        return -math.inf, math.inf
    pair = checks.two(value)
    if pair is None:
        hint = hints.in_place_of_limits(value)
        raise TypeError(f"limits must be a pair (low, high) (got {checks.shown(value)}){hint}")
    lower, upper = (
        end if each is None or is_endless(each, end) else checks.number(f"limits[{k}]", each, low)
        for k, (each, end) in enumerate(zip(pair, (-math.inf, math.inf), strict=True))
    )
    if lower > upper:
        raise ValueError(f"limits must be (low, high) with low <= high (got {checks.shown(value)})")
    return lower, upper


def checked_breaks(value: Any) -> tuple[float, float]:
    """Return the (force, torque) above which a joint breaks. inf: this value never breaks the joint.

    value: a pair (force, torque) in which None or inf means unbreakable, or None for an unbreakable joint. Raises
    TypeError if value is not a pair of numbers; ValueError for a number <= 0.
    """
    if value is None:
        return math.inf, math.inf
    pair = checks.two(value)
    if pair is None:
        raise TypeError(f"breaks must be a pair (force, torque) (got {checks.shown(value)})")
    force, torque = (
        math.inf if each is None or is_endless(each, math.inf) else checks.number(f"breaks[{k}]", each, above=0.0)
        for k, each in enumerate(pair)
    )
    return force, torque


def motor_fields(motor: Any) -> dict[str, float]:
    """Return the JOINT columns motor_speed and motor_max for `motor`, a Drive or None (no motor).

    Raises TypeError for any other value.
    """
    if motor is None:
        return {"motor_speed": 0.0, "motor_max": 0.0}
    if not isinstance(motor, Drive):
        hint = f": write Drive({motor}, max=…)" if hints.is_number(motor) else ""
        raise TypeError(f"motor must be a Drive(speed, max) (got {checks.shown(motor)}){hint}")
    return {"motor_speed": float(motor.speed), "motor_max": float(motor.max or 0.0)}


def checked_spring(spring: Any, name: str = "spring") -> Spring | None:
    """Return `spring` unchanged if it is a Spring or None. Raises TypeError for any other value.

    name: name of the argument in error messages.
    """
    if spring is not None and not isinstance(spring, Spring):
        hint = f": write Spring({spring})" if hints.is_number(spring) else ""
        raise TypeError(f"{name} must be a Spring(hertz, damping, target) (got {checks.shown(spring)}){hint}")
    return spring


def greatest(name: str, value: Any) -> float:
    """Return an upper bound of a force or torque as a float; inf for None. name: name of the argument in messages.

    Raises TypeError if the value is not a number, ValueError if it is below 0.
    """
    return math.inf if value is None else checks.number(name, value, low=0.0)


DEFAULTS = {
    "enabled": True,
    "follows_point": True,
    "follows_angle": True,
    "lower": -math.inf,
    "upper": math.inf,
    "point_max": math.inf,
    "angle_max": math.inf,
}  # JOINT columns with another default than 0

# ---- kinds -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Kind:
    """Base class with the arguments of all joints. A kind adds arguments for its bodies, anchors and coordinate.

    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.
    """

    PARTS: ClassVar[Mapping[str, Any]] = {}  # values of JOINT columns that define the kind
    GROUND: ClassVar[tuple[str, ...]] = ()  # arguments with points of the world, for A and for B
    COUPLES: ClassVar[bool] = False  # whether the two sides are joints, or bodies, that the kind couples
    POINTS: ClassVar[tuple[str, ...]] = ("at",)  # arguments with anchors: one for both bodies, or one for each of A, B
    AXIS: ClassVar[bool] = False  # whether the kind has an argument `axis`
    COORDINATE: ClassVar[tuple[str, ...]] = ("limits", "motor", "spring")  # settings of the coordinate

    breaks: Range | None = None
    contacts: bool = False
    local: bool = False
    user: Any = None

    def sides(self) -> tuple[Any, Any]:
        """Return the arguments for the two bodies or joints that the joint connects, unchanged: (for A, for B)."""
        given = vars(self)
        return given["a"], given["b"]

    def columns(self) -> dict[str, Any]:
        """Return the JOINT columns that follow from the settings of the joint.

        Raises TypeError for a setting of a wrong type, ValueError for a value out of range.
        """
        given = vars(self)
        force, torque = checked_breaks(self.breaks)
        checks.flag("local", self.local)
        found = DEFAULTS | dict(self.PARTS) | {"break_force": force, "break_torque": torque}
        found["contacts"] = checks.flag("contacts", self.contacts)
        if "limits" in self.COORDINATE:
            found["lower"], found["upper"] = checked_limits(given["limits"])
        if "motor" in self.COORDINATE:
            found |= motor_fields(given["motor"])
        if "spring" in self.COORDINATE and (spring := checked_spring(given["spring"])):
            found |= {"spring_hertz": spring.hertz, "spring_damping": spring.damping, "spring_target": spring.target}
        return found

    def with_lengths(self, rows: np.ndarray, lengths: np.ndarray) -> None:
        """Write the columns that depend on the distances of the anchors.

        rows: JOINT rows (n,), which are changed; lengths: distances of the anchors (n,) [px].
        """


@explained_class
@dataclass(frozen=True)
class Revolute(Kind):
    """A hinge, which holds the anchors of both bodies together. Its coordinate is the angle of B relative to A.

    a, b: Bodies or ids; None for one of them: the world.
    at: the anchor of both bodies (x, y) [px].
    limits: least and greatest value of the angle (low, high) [rad], None on a side: no limit there; None: no limits.
    motor: a Drive that drives the angle; None: no motor; spring: a Spring on the angle; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    The world needs the effect `joints`. World.add_joint checks the arguments, and raises TypeError or ValueError.

    >>> motor = world.add_joint(Revolute(floor, ball, at=(200, 290), motor=Drive(3.0, max=1e7)))
    >>> motor
    Joint(1, Revolute, body 0, body 1)
    """

    PARTS = {"hold": PINNED, "coordinate": ANGLE}

    a: BodyRef | None
    b: BodyRef | None
    at: Pair
    limits: Range | None = None
    motor: Drive | None = None
    spring: Spring | None = None


@explained_class
@dataclass(frozen=True)
class Prismatic(Kind):
    """A slider: B moves along an axis that is fixed to A.

    a, b: Bodies or ids; None for one of them: the world.
    at: the anchor of both bodies (x, y) [px].
    axis: direction of the axis (x, y), of any length but 0; turns: whether B may also rotate.
    limits: least and greatest value of the translation (low, high) [px], None on a side: no limit there; None: no
        limits.
    motor: a Drive that drives the translation; None: no motor; spring: a Spring on the translation; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    The translation is 0 when the joint is made. The world needs the effect `joints`. World.add_joint checks the
    arguments, and raises TypeError or ValueError.

    >>> lift = world.add_joint(Prismatic(None, ball, at=(200, 280), axis=(0, 1), limits=(-50, 0)))
    >>> lift.limits, lift.translation
    ((-50.0, 0.0), 0.0)
    """

    PARTS = {"hold": ON_AXIS, "coordinate": TRANSLATION}
    AXIS = True

    a: BodyRef | None
    b: BodyRef | None
    at: Pair
    axis: Pair = (1, 0)
    turns: bool = False
    limits: Range | None = None
    motor: Drive | None = None
    spring: Spring | None = None

    def columns(self) -> dict[str, Any]:
        return super().columns() | {"locks_angle": not checks.flag("turns", self.turns)}


@explained_class
@dataclass(frozen=True)
class Wheel(Kind):
    """A wheel on a suspension: B rotates freely, and moves along an axis of A against a spring.

    The motor drives the angle of B. Limits and spring act on the translation along the axis, which `translation` and
    `speed` of the Joint report.

    a, b: chassis and wheel, Bodies or ids; None for one of them: the world.
    at: the anchor of both bodies (x, y) [px].
    axis: direction of the suspension (x, y), of any length but 0.
    limits: least and greatest translation (low, high) [px], None on a side: no limit there; None: no limits.
    motor: a Drive that drives the angle of B; None: no motor; spring: a Spring on the translation; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    The world needs the effect `joints`. World.add_joint checks the arguments, and raises TypeError or ValueError.

    >>> front = world.add_joint(Wheel(box, ball, at=(200, 280), spring=Spring(4.0, 0.7)))
    >>> front.motor = Drive(speed=20.0, max=1e7)
    """

    PARTS = {"hold": ON_AXIS, "coordinate": TRANSLATION, "turns_motor": True}
    AXIS = True

    a: BodyRef | None
    b: BodyRef | None
    at: Pair
    axis: Pair = (0, 1)
    limits: Range | None = None
    motor: Drive | None = None
    spring: Spring | None = Spring(2.0, 0.7)


@explained_class
@dataclass(frozen=True)
class Distance(Kind):
    """A rod, rope, spring or winch between two anchors. Its coordinate is their distance.

    a, b: Bodies or ids; None for one of them: the world.
    at_a, at_b: anchors of A and B (x, y) [px], two different points.
    length: length of the rod, or rest length of a spring without a target [px], > 0; None: the distance of the anchors
        when the joint is made.
    limits: least and greatest value of the distance (low, high) [px], None on a side: no limit there; None: no limits.
    motor: a Drive that drives the distance; None: no motor; spring: a Spring on the distance; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    Without limits, motor and spring the joint is a rigid rod. With limits and nothing else it is a rope: the distance
    is free between the limits. The world needs the effect `joints`. World.add_joint checks the arguments, and raises
    TypeError or ValueError.

    >>> rope = world.add_joint(Distance(None, ball, (200, 200), (200, 280), limits=(0, 90)))
    >>> rope.limits
    (0.0, 90.0)
    """

    PARTS = {"coordinate": LENGTH}
    POINTS = ("at_a", "at_b")

    a: BodyRef | None
    b: BodyRef | None
    at_a: Pair
    at_b: Pair
    length: float | None = None
    limits: Range | None = None
    motor: Drive | None = None
    spring: Spring | None = None

    def columns(self) -> dict[str, Any]:
        if self.length is not None:
            checks.number("length", self.length, above=0.0)
        found = super().columns()
        found["lower"], found["upper"] = checked_limits(self.limits, low=0.0)
        return found

    def with_lengths(self, rows: np.ndarray, lengths: np.ndarray) -> None:
        rest = lengths if self.length is None else np.full(len(rows), float(self.length))
        if self.spring is not None and self.spring.target is None:
            rows["spring_target"] = rest
        if self.limits is None and self.spring is None and self.motor is None:
            rows["lower"] = rows["upper"] = rest


@explained_class
@dataclass(frozen=True)
class Weld(Kind):
    """A rigid connection: it keeps the position and angle of B relative to A.

    a, b: Bodies or ids; None for one of them: the world.
    at: the anchor of both bodies (x, y) [px].
    spring: a Spring makes the joint soft in translation; angular_spring: a Spring makes it soft in rotation. None:
        rigid. The targets of both springs are ignored.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    The world needs the effect `joints`. World.add_joint checks the arguments, and raises TypeError or ValueError.

    >>> world.add_joint(Weld(box, ball, at=(220, 280), breaks=(1e7, None)))
    Joint(1, Weld, body 2, body 1)
    """

    PARTS = {"hold": PINNED, "locks_angle": True}
    COORDINATE = ()

    a: BodyRef | None
    b: BodyRef | None
    at: Pair
    spring: Spring | None = None
    angular_spring: Spring | None = None

    def columns(self) -> dict[str, Any]:
        found = super().columns()
        springs = checked_spring(self.spring), checked_spring(self.angular_spring, "angular_spring")
        for name, spring in zip(("point", "angle"), springs, strict=True):
            if spring is not None:
                found |= {f"{name}_hertz": spring.hertz, f"{name}_damping": spring.damping}
        return found


@explained_class
@dataclass(frozen=True)
class Angle(Kind):
    """A rotary spring, limit or motor on the angle of B relative to A, without an anchor.

    a, b: Bodies or ids; None for one of them: the world.
    limits: least and greatest value of the angle (low, high) [rad], None on a side: no limit there; None: no limits.
    motor: a Drive that drives the angle; None: no motor; spring: a Spring on the angle; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: without effect, because there are no anchors.
    user: any value of the game, kept as joint.user.

    The angle is 0 when the joint is made. The world needs the effect `joints`. World.add_joint checks the arguments,
    and raises TypeError or ValueError.

    >>> world.add_joint(Angle(box, ball, spring=Spring(1.0)))
    Joint(1, Angle, body 2, body 1)
    """

    PARTS = {"coordinate": ANGLE}
    POINTS = ()

    a: BodyRef | None
    b: BodyRef | None
    limits: Range | None = None
    motor: Drive | None = None
    spring: Spring | None = None


@explained_class
@dataclass(frozen=True)
class Motor(Kind):
    """A motor that drives B relative to A with bounded force and torque: friction joints, top-down tyres, conveyors.

    a, b: Bodies or ids; None for one of them: the world.
    at: the anchor (x, y) [px]; None: the centre of mass of B.
    velocity: target velocity of B relative to A (x, y) [px/s], in the space of A.
    angular_velocity: target angular velocity of B relative to A [rad/s].
    max_force: greatest force [mass px/s²]; max_torque: greatest torque [mass px²/s²]. Both must be given, >= 0.
    spring: a Spring that replaces the target velocities. It pulls B back to the pose relative to A that B had when the
        joint was made; None: no spring.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    Raises ValueError if max_force or max_torque is missing. The world needs the effect `joints`. World.add_joint checks
    the arguments, and raises TypeError or ValueError.

    >>> world.add_joint(Motor(floor, ball, max_force=1e5, max_torque=1e6))
    Joint(1, Motor, body 0, body 1)
    """

    PARTS = {"hold": PINNED, "locks_angle": True, "axis_x": 1.0}
    COORDINATE = ()

    a: BodyRef | None
    b: BodyRef | None
    at: Pair | None = None
    velocity: Pair = (0, 0)
    angular_velocity: float = 0.0
    max_force: float | None = None
    max_torque: float | None = None
    spring: Spring | None = None

    def columns(self) -> dict[str, Any]:
        velocity = checks.vector("velocity", self.velocity)
        found = super().columns() | {
            "target_vx": velocity[0],
            "target_vy": velocity[1],
            "target_spin": checks.number("angular_velocity", self.angular_velocity),
            "follows_point": self.spring is not None,
            "follows_angle": self.spring is not None,
        }
        for name in ("max_force", "max_torque"):
            if getattr(self, name) is None:
                raise ValueError(f"{name} must be given, a number >= 0 (got None)")
        found |= {
            "point_max": greatest("max_force", self.max_force),
            "angle_max": greatest("max_torque", self.max_torque),
        }
        if (spring := checked_spring(self.spring)) is not None:
            found |= {f"{part}_hertz": spring.hertz for part in ("point", "angle")}
            found |= {f"{part}_damping": spring.damping for part in ("point", "angle")}
        return found


@explained_class
@dataclass(frozen=True)
class Target(Kind):
    """A spring that pulls a point of a body to a point of the world: mouse drag, grapple, tractor beam.

    body: the pulled body, a Body or an id.
    at: the point of the body (x, y) [px].
    point: the target in the world (x, y) [px], which joint.point changes; None: the position of `at`.
    spring: the Spring, whose target is ignored; max_force: greatest force [mass px/s²], >= 0; None: no bound.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    The world needs the effect `joints`. World.add_joint checks the arguments, and raises TypeError or ValueError.

    >>> drag = world.add_joint(Target(ball, at=(200, 280), max_force=1e6))
    >>> drag.point = (230, 250)
    """

    PARTS = {"hold": PINNED}
    POINTS = ("point", "at")
    COORDINATE = ()

    body: BodyRef
    at: Pair
    point: Pair | None = None
    spring: Spring = Spring(5.0, 1.0)
    max_force: float | None = None

    def sides(self) -> tuple[Any, Any]:
        return None, self.body

    def columns(self) -> dict[str, Any]:
        spring = checked_spring(self.spring)
        if spring is None:
            raise TypeError("spring must be a Spring(hertz, damping) (got None)")
        return super().columns() | {
            "point_hertz": spring.hertz,
            "point_damping": spring.damping,
            "point_max": greatest("max_force", self.max_force),
        }


@explained_class
@dataclass(frozen=True)
class NoContact(Kind):
    """A joint without forces, which only prevents contacts between two bodies.

    a, b: Bodies or ids; None for one of them: the world.
    breaks: without effect, because there is no force.
    contacts: True lets A and B touch each other after all; local: without effect, because there are no anchors.
    user: any value of the game, kept as joint.user.

    The world needs the effect `joints`. World.add_joint checks the arguments, and raises TypeError or ValueError.

    >>> world.add_joint(NoContact(floor, ball))
    Joint(1, NoContact, body 0, body 1)
    """

    POINTS = ()
    COORDINATE = ()

    a: BodyRef | None
    b: BodyRef | None


@explained_class
@dataclass(frozen=True)
class Gear(Kind):
    """A gear that keeps the sum of two coordinates constant: coordinate of A + ratio · coordinate of B = phase.

    joint_a, joint_b: Joints or their ids. The coordinate of a hinge (Revolute, Wheel, Angle, Ratchet) is its angle
        [rad], that of a slider (Prismatic) its translation [px]. The coordinate of a Body is its angle in the world.
    ratio: any number but 0: teeth of B over teeth of A. If positive, the sides turn in opposite directions.
    phase: the constant sum; None: the present sum.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: without effect, because there are no anchors.
    user: any value of the game, kept as joint.user.

    Two hinges are a pair of gears, and a hinge and a slider are a rack and pinion. The force and torque that the Joint
    reports act on B. If one of its joints is removed, the gear is removed too. The world needs the effect `joints`.
    World.add_joint checks the arguments, and raises TypeError, ValueError or KeyError.

    >>> other = world.add_joint(Revolute(None, ball, at=(200, 280)))
    >>> world.add_joint(Gear(hinge, other, ratio=2.0))
    Joint(2, Gear, body 2, body 1)
    """

    PARTS = {"hold": GEARED, "point_max": 0.0}
    POINTS = ()
    COORDINATE = ()
    COUPLES = True

    joint_a: Any
    joint_b: Any
    ratio: float = 1.0
    phase: float | None = None

    def sides(self) -> tuple[Any, Any]:
        return self.joint_a, self.joint_b

    def columns(self) -> dict[str, Any]:
        found = super().columns() | {"ratio": checked_ratio(self.ratio)}
        if self.phase is not None:
            found["phase"] = checks.number("phase", self.phase)
        return found


@explained_class
@dataclass(frozen=True)
class Pulley(Kind):
    """A rope from one body over two pulleys to another body. Its coordinate is length at A + ratio · length at B.

    a, b: Bodies or ids; None for one of them: the world.
    at_a, at_b: anchors of A and B (x, y) [px].
    ground_a, ground_b: the pulleys, points of the world (x, y) [px].
    ratio: factor on B's length of rope, and on the tension on B (a block and tackle), > 0.
    length: distance of A from its pulley + ratio · distance of B from its pulley [px], > 0; None: the present length.
    rigid: True: the rope also pushes; False: it can be slack.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: True for anchors and axes in body space, not in the world.
    user: any value of the game, kept as joint.user.

    An anchor stops at its pulley. The world needs the effect `joints`. World.add_joint checks the arguments, and raises
    TypeError or ValueError.

    >>> world.add_joint(Pulley(ball, box, (200, 280), (240, 280), (200, 100), (240, 100)))
    Joint(1, Pulley, body 1, body 2)
    """

    PARTS = {"hold": SLUNG, "point_max": 0.0}
    POINTS = ("at_a", "at_b")
    GROUND = ("ground_a", "ground_b")
    COORDINATE = ()

    a: BodyRef | None
    b: BodyRef | None
    at_a: Pair
    at_b: Pair
    ground_a: Pair
    ground_b: Pair
    ratio: float = 1.0
    length: float | None = None
    rigid: bool = False

    def columns(self) -> dict[str, Any]:
        if self.length is not None:
            checks.number("length", self.length, above=0.0)
        checks.flag("rigid", self.rigid)
        return super().columns() | {"ratio": checks.number("ratio", self.ratio, above=0.0)}

    def with_rope(self, rows: np.ndarray, lengths_a: np.ndarray, lengths_b: np.ndarray) -> None:
        """Write the length of the rope to the columns of limits.

        rows: JOINT rows (n,), which are changed; lengths_a, lengths_b: distances of the anchors from their pulleys (n,)
            [px].
        """
        rows["upper"] = lengths_a + self.ratio * lengths_b if self.length is None else self.length
        if self.rigid:
            rows["lower"] = rows["upper"]


@explained_class
@dataclass(frozen=True)
class Ratchet(Kind):
    """A ratchet: B may turn in one direction relative to A, and back only to the last tooth that B has passed.

    a, b: Bodies or ids; None for one of them: the world.
    phase: angle of a tooth relative to the present angle [rad].
    ratchet: angle from tooth to tooth [rad], other than 0. Its sign is the direction in which B may turn. The argument
        must be given.
    breaks: greatest (force [mass px/s²], torque [mass px²/s²]), above which the joint breaks; None: it never breaks.
    contacts: whether A and B may touch each other; local: without effect, because there are no anchors.
    user: any value of the game, kept as joint.user.

    Its coordinate is the angle, 0 when the joint is made. `limits` of the Joint contains the last tooth. Raises
    ValueError if ratchet is missing. The world needs the effect `joints`. World.add_joint checks the arguments, and
    raises TypeError or ValueError.

    >>> world.add_joint(Ratchet(None, ball, ratchet=math.radians(15)))
    Joint(1, Ratchet, world, body 1)
    """

    PARTS = {"hold": TOOTHED, "point_max": 0.0, "coordinate": ANGLE}
    POINTS = ()
    COORDINATE = ()

    a: BodyRef | None
    b: BodyRef | None
    phase: float = 0.0
    ratchet: float | None = None

    def columns(self) -> dict[str, Any]:
        phase = checks.number("phase", self.phase)
        if self.ratchet is None:
            raise ValueError("ratchet must be given, the angle from tooth to tooth: a number other than 0 (got None)")
        ratchet = checked_ratio(self.ratchet, "ratchet")
        return super().columns() | {"phase": phase, "ratchet": ratchet} | tooth_at(0.0, phase, ratchet)


def checked_ratio(value: Any, name: str = "ratio") -> float:
    """Return `value` as a ratio. Raises TypeError if it is not a number, ValueError if it is 0 or not finite.

    name: name of the argument in messages.
    """
    ratio = checks.number(name, value)
    if ratio == 0.0:
        raise ValueError(f"{name} must be finite and other than 0 (got {checks.shown(value)})")
    return ratio


def tooth_at(angle: float, phase: float, ratchet: float) -> dict[str, float]:
    """Return the JOINT columns `lower` and `upper` of a ratchet, from its last tooth at or before `angle` [rad].

    phase, ratchet: see Ratchet.
    """
    tooth = phase + (angle - phase) // ratchet * ratchet
    tooth = tooth if math.isfinite(tooth) else angle
    return {"lower": tooth, "upper": math.inf} if ratchet > 0.0 else {"lower": -math.inf, "upper": tooth}


def coupled_coordinate(row: Any) -> int:
    """Return the coordinate of a JOINT row on which a gear acts: ANGLE, TRANSLATION, or NO_COORDINATE for none."""
    if row["coordinate"] == ANGLE or row["turns_motor"]:
        return ANGLE
    return TRANSLATION if row["coordinate"] == TRANSLATION else NO_COORDINATE


KINDS: list[type[Kind]] = [
    Revolute,
    Prismatic,
    Wheel,
    Distance,
    Weld,
    Angle,
    Motor,
    Target,
    NoContact,
    Gear,
    Pulley,
    Ratchet,
]
