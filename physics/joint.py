"""Joint, a handle on one row of `world.joints`, and the functions that change and remove joints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, get_args

import numpy as np

from physics import checks, hints
from physics.annotations import JointSolverName, Pair, Range
from physics.gear import sum_with, with_gears
from physics.islands import sleep
from physics.joints.kinds import (
    KINDS,
    Drive,
    Spring,
    checked_breaks,
    checked_limits,
    checked_ratio,
    checked_spring,
    motor_fields,
    tooth_at,
)
from physics.math2d import Vec2, rotate
from physics.tables.body import DYNAMIC
from physics.tables.joint import ANGLE, BROKEN, GEARED, JOINT, LENGTH, NO_COORDINATE, NO_JOINT, WORLD
from physics.tables.table import row_number, rows_in
from physics.world_state import WorldState

JOINT_SOLVERS: tuple[JointSolverName, ...] = get_args(JointSolverName)
NO_JOINTS, NONE_BROKEN = np.zeros(0, JOINT), np.zeros(0, BROKEN)

# ---- changes ---------------------------------------------------------------------------------------------------------


def wake(world: WorldState, rows: np.ndarray) -> list[int]:
    """Wake the bodies of the joints `rows` (JOINT rows), and return the ids of these bodies. Skip removed bodies."""
    ids = np.unique(np.concatenate([rows["body_a"], rows["body_b"]]))
    ids = [each for each in ids.tolist() if each in world._shapes_of]
    sleep.disturb(world, ids)
    return ids


def set_apart(world: WorldState, ids: Iterable[int]) -> None:
    """Have the next step call keep_apart, because joints have changed. ids: ids of the bodies of these joints."""
    world._apart = (world._apart or set[int]()).union(ids)


def keep_apart(world: WorldState) -> None:
    """Update the pairs of bodies that the broad phase skips because a joint forbids contacts between the two bodies.

    A step calls this function first if joints have changed. If the skipped pairs changed, the candidate pairs of the
    bodies of changed joints are searched again. O(joints log joints).
    """
    joints, ids = world.joints, np.array(sorted(world._apart or ()), np.int64)
    world._apart = None
    a, b = joints["body_a"], joints["body_b"]
    apart = ~joints["contacts"] & joints["enabled"] & (a != WORLD) & (b != WORLD)
    apart &= a != b  # a gear may couple two motions of one body
    low, high = np.minimum(a[apart], b[apart]), np.maximum(a[apart], b[apart])
    ids = ids[np.isin(ids, world.bodies["id"])]
    if world.pairs.keep_apart(np.unique(low << 32 | high)) and len(ids):
        world.pairs.touch(world.shapes["proxy"][world._shape_rows_of(world.rows(ids))])


def remove(world: WorldState, ids: Any) -> None:
    """Remove joints and the gears that couple these joints. ids: Joints or ids, one or many.

    The next step reports the gears as broken, with the reason "removed". Raises KeyError for an unknown joint,
    TypeError for anything but Joints and ids, ValueError for a Joint of another world, RuntimeError during a step. No
    joint is then removed.
    """
    world._unlocked()
    rows = joint_rows(world, ids)
    asked = world.joints["id"][rows]
    gone = drop(world, with_gears(world, rows))
    world._lost_joints += broken_rows(gone[~np.isin(gone["id"], asked)], "removed").tolist()


def drop(world: WorldState, rows: np.ndarray) -> np.ndarray:
    """Remove joints and wake their bodies. Return copies of the removed JOINT rows. rows: row numbers of the joints."""
    gone = world.joints[rows].copy()
    keep = np.ones(world._joints.count, bool)
    keep[rows] = False
    world._joints.keep(keep)
    for identity in gone["id"].tolist():
        world._joint_users.pop(identity, None)
    set_apart(world, wake(world, gone))
    return gone


def drop_of_bodies(world: WorldState, ids: np.ndarray) -> None:
    """Remove the joints of bodies (ids) that are about to be removed, and the gears that couple these joints.

    The next step reports the joints as broken.
    """
    joints = world.joints
    mine = np.flatnonzero(np.isin(joints["body_a"], ids) | np.isin(joints["body_b"], ids))
    if len(mine):
        world._lost_joints += broken_rows(drop(world, with_gears(world, mine)), "removed").tolist()


def broken_rows(rows: np.ndarray, reason: str | np.ndarray) -> np.ndarray:
    """Return a BROKEN row for each JOINT row in `rows`. A BROKEN row reports a joint that broke or was removed.

    reason: "force", "torque" or "removed"; one value for all rows, or one for each row.
    """
    found = np.zeros(len(rows), BROKEN)
    found["joint"], found["body_a"], found["body_b"] = rows["id"], rows["body_a"], rows["body_b"]
    found["force"] = np.hypot(rows["force_x"], rows["force_y"])
    found["torque"], found["reason"] = rows["torque"], reason
    return found


def break_joints(world: WorldState, events: Any) -> None:
    """Remove the joints that broke in the last step, and report them in events.broken.

    Gears that couple a broken joint are removed and reported too. Joints that were removed before the step, together
    with a body or another joint, are also reported.
    """
    joints = world.joints
    broken = np.flatnonzero(joints["broken"])
    lost = np.array(world._lost_joints, BROKEN) if world._lost_joints else NONE_BROKEN
    world._lost_joints = []
    if not len(broken):
        events.broken = lost
        return
    gone = drop(world, with_gears(world, broken))
    reason = np.where(np.hypot(gone["force_x"], gone["force_y"]) > gone["break_force"], "force", "torque")
    reason = np.where(gone["broken"], reason, "removed")
    events.broken = np.concatenate([lost, broken_rows(gone, reason)])


def joint_rows(world: WorldState, ids: Any) -> np.ndarray:
    """Return the row numbers of joints in world.joints, ascending, each once. ids: Joints or ids, one or many.

    Raises KeyError for an unknown joint, TypeError for anything but Joints and ids, ValueError for a Joint of another
    world.
    """
    if isinstance(ids, (Joint, int, np.integer)):
        ids = [ids]
    each_id = checks.listed(ids)
    if each_id is None:
        raise TypeError(f"ids: each joint must be a Joint or an id (got {checks.shown(ids)})")
    numbers = checks.ids("ids", [_identity(world, each) for each in each_id], repeats=True)
    rows = rows_in(world._joints, np.unique(numbers))
    if (rows < 0).any():
        raise checks.NoSuchId(f"no joint {np.unique(numbers)[rows < 0][0]} in this world")
    return rows


def row_of(world: WorldState, joint: Any) -> int:
    """Return the row number in world.joints of one joint. joint: a Joint or the id of a joint.

    Raises KeyError for an unknown joint, TypeError for any other value, ValueError for a Joint of another world.
    """
    return int(joint_rows(world, [_identity(world, joint)])[0])


def _identity(world, value):
    if isinstance(value, Joint):
        if value.world is not world:
            raise ValueError(f"joint must be of this world (got {checks.shown(value)} of another one)")
        return value.id
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"joint must be a Joint or an id (got {checks.shown(value)})")
    if not 0 <= value < 2**62:
        raise checks.NoSuchId(f"no joint {checks.shown(int(value))} in this world")
    return int(value)


# ---- handle ----------------------------------------------------------------------------------------------------------


@checks.setting_by(checks.set_known)
class Joint(metaclass=hints.WithForeignNames):
    """A handle on one joint of a world.

    world: the World of the joint; identity: the id of the joint, a whole number.

    For a joint that was removed or broke, all properties except world and id raise KeyError. The properties point,
    joint_a, joint_b, ratio, phase, ratchet and length exist only for some kinds; for other kinds they raise
    AttributeError. A setter raises TypeError or ValueError for an invalid value, RuntimeError during a step. The world
    is then unchanged.
    """

    __slots__ = ("_world", "_id")

    def __init__(self, world: WorldState, identity: int) -> None:
        if not isinstance(world, WorldState):
            raise TypeError(f"world must be a World (got {checks.shown(world)})")
        self._world, self._id = world, _identity(world, identity)

    def __eq__(self, other):
        return isinstance(other, Joint) and other._world is self._world and other._id == self._id

    def __hash__(self):
        return hash((id(self._world), self._id, "joint"))

    def __repr__(self):
        if row_number(self._world._joints, self._id) < 0:
            return f"Joint({self._id}, gone)"
        a, b = self._row["body_a"].item(), self._row["body_b"].item()
        sides = ["world" if each == WORLD else f"body {each}" for each in (a, b)]
        return f"Joint({self._id}, {self.kind}, {sides[0]}, {sides[1]})"

    @property
    def world(self) -> Any:
        """The World of the joint."""
        return self._world

    @property
    def id(self) -> int:
        """The id of the joint, which is never used again in its world."""
        return self._id

    def _must_exist(self) -> int:
        """Return the row number of the joint. Raises KeyError if it was removed or broke."""
        row = row_number(self._world._joints, self._id)
        if row < 0:
            raise checks.NoSuchId(f"joint {self._id} is not in this world (removed, broken, or never added)")
        return row

    @property
    def _row(self) -> np.void:
        return self._world._joints.data[self._must_exist()]

    def _set(self, **columns) -> None:
        """Write values to columns of the joint's JOINT row, and wake its bodies. columns: {name: value}."""
        self._world._unlocked()
        at = self._must_exist()
        rows = np.asarray(self._world.joints)[at : at + 1]  # its columns may have computed names
        for name, value in columns.items():
            rows[name] = value
        ids = wake(self._world, rows)
        if columns.keys() & {"contacts", "enabled"}:
            set_apart(self._world, ids)

    # --- state ------------------------------------------------------------------------------------------------------

    @property
    def kind(self) -> str:
        """The name of the kind of the joint: "Revolute", "Distance", …"""
        return KINDS[self._row["kind"].item()].__name__

    @property
    def body_a(self) -> Any:
        """The first body of the joint, as a Body; None for the world."""
        return self._body("body_a")

    @property
    def body_b(self) -> Any:
        """The second body of the joint, as a Body; None for the world."""
        return self._body("body_b")

    def _body(self, name):
        identity = self._row[name].item()
        return None if identity == WORLD else self.world.body(identity)

    @property
    def anchor_a(self) -> Vec2:
        """The anchor on body A, in the world (x, y) [px]."""
        return self._anchor("a")

    @property
    def anchor_b(self) -> Vec2:
        """The anchor on body B, in the world (x, y) [px]."""
        return self._anchor("b")

    def _anchor(self, side):
        row = self._row
        x, y, body = row[f"local_{side}x"].item(), row[f"local_{side}y"].item(), row[f"body_{side}"].item()
        if body == WORLD:
            return Vec2(x, y)
        b = self._world._body_row(body)
        angle = b["angle"].item()
        u, v = rotate(x, y, math.cos(angle), math.sin(angle))
        return Vec2(b["x"].item() + u, b["y"].item() + v)

    @property
    def angle(self) -> float:
        """The angle of body B relative to body A [rad] after the last step, minus their relative angle at creation."""
        return self._row["angle"].item()

    @property
    def translation(self) -> float:
        """The translation of body B along the axis of the joint [px] after the last step.

        For a Distance it is the distance of the anchors; for a Gear, the sum of coordinates that the gear keeps
        constant; for a Pulley, the length of rope in use.
        """
        return self._row["translation"].item()

    @property
    def speed(self) -> float:
        """The rate of change of the joint's angle [rad/s], or of its translation or length [px/s], after the last step.

        For a kind that controls none of these coordinates, it is the rate of the angle. For a Wheel it is the speed of
        the suspension; the wheel itself rotates at body_b.angular_velocity.
        """
        return self._row["speed"].item()

    @property
    def separation(self) -> float:
        """The error of the joint [px]: distance between the anchors, distance from the axis, or excess over limits.

        For a Gear it is the error of the sum of coordinates, in the unit of joint_a's coordinate. For a Target it is
        the distance between the anchor and the target point.
        """
        return self._row["separation"].item()

    @property
    def force(self) -> float:
        """The magnitude of the joint's force on body B in the last step [mass px/s²].

        The vector is in the columns force_x and force_y of world.joints.
        """
        row = self._row
        return math.hypot(row["force_x"].item(), row["force_y"].item())

    @property
    def torque(self) -> float:
        """The torque on body B in the last step [mass px²/s²], without the torque of the force at the anchor."""
        return self._row["torque"].item()

    @property
    def awake(self) -> bool:
        """Whether the joint is enabled and at least one of its bodies is dynamic and awake."""
        row, world = self._row, self._world
        ids = [row[name].item() for name in ("body_a", "body_b")]
        return bool(row["enabled"]) and any(
            b["awake"].item() and b["kind"].item() == DYNAMIC for b in (world._body_row(i) for i in ids if i != WORLD)
        )

    # --- settings ---------------------------------------------------------------------------------------------------

    @property
    def motor(self) -> Drive | None:
        """The motor, a Drive; None: no motor. Setting a Drive raises ValueError for a kind without a coordinate."""
        row = self._row
        return Drive(row["motor_speed"].item(), row["motor_max"].item()) if row["motor_max"] > 0.0 else None

    @motor.setter
    def motor(self, value: Drive | None) -> None:
        self._takes("motor", value is not None)
        self._set(**motor_fields(value))

    @property
    def spring(self) -> Spring | None:
        """The spring on the joint's angle, translation or length, a Spring; None: no spring.

        Setting a Spring raises ValueError for a kind without a coordinate.
        """
        row = self._row
        names = ("spring_hertz", "spring_damping", "spring_target")
        return Spring(*(row[name].item() for name in names)) if row["spring_hertz"] > 0.0 else None

    @spring.setter
    def spring(self, value: Spring | None) -> None:
        self._takes("spring", value is not None)
        value = checked_spring(value)
        if value is None:
            self._set(spring_hertz=0.0, spring_force=0.0)
        else:
            target = self._coordinate if value.target is None else value.target
            self._set(spring_hertz=value.hertz, spring_damping=value.damping, spring_target=target)

    @property
    def _coordinate(self):
        row = self._row
        return row["angle" if row["coordinate"] == ANGLE else "translation"].item()

    @property
    def limits(self) -> tuple[float, float] | None:
        """The limits (low, high) of the joint's angle [rad], or of its translation or length [px]; None: no limits.

        A missing lower limit is -inf, a missing upper limit inf. Setting the limits raises TypeError or ValueError for
        invalid limits, and ValueError for a joint without a coordinate and for a Ratchet.
        """
        row = self._row
        lower, upper = row["lower"].item(), row["upper"].item()
        return None if (lower, upper) == (-math.inf, math.inf) else (lower, upper)

    @limits.setter
    def limits(self, value: Range | None) -> None:
        self._takes("limits", value is not None)
        if self.kind == "Ratchet":
            raise ValueError(f"limits of a Ratchet are its teeth; set phase or ratchet (got {checks.shown(value)})")
        lower, upper = checked_limits(value, low=0.0 if self._row["coordinate"] == LENGTH else None)
        self._set(lower=lower, upper=upper)

    def _takes(self, name, asked):
        if asked and self._row["coordinate"] == NO_COORDINATE:
            raise ValueError(f"{name} needs a joint with a coordinate; {self.kind} has none")
        turns = self._row["coordinate"] == ANGLE or (name == "motor" and self._row["turns_motor"])
        self._world._needs("rotation", f"{name} of a {self.kind}", bool(asked and turns))

    @property
    def breaks(self) -> tuple[float, float]:
        """The (force [mass px/s²], torque [mass px²/s²]) above which the joint breaks; inf: it does not break."""
        row = self._row
        return row["break_force"].item(), row["break_torque"].item()

    @breaks.setter
    def breaks(self, value: Range | None) -> None:
        force, torque = checked_breaks(value)
        self._set(break_force=force, break_torque=torque)

    @property
    def contacts(self) -> bool:
        """Whether the two bodies of the joint can collide with each other."""
        return bool(self._row["contacts"])

    @contacts.setter
    def contacts(self, value: bool) -> None:
        self._set(contacts=checks.flag("contacts", value))

    @property
    def enabled(self) -> bool:
        """Whether the joint acts on its bodies. A disabled joint keeps its settings."""
        return bool(self._row["enabled"])

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self._set(enabled=checks.flag("enabled", value))

    @property
    def point(self) -> Vec2:
        """The world point (x, y) [px] towards which a Target pulls its body. Raises AttributeError for other kinds."""
        self._is_target("point")
        return self.anchor_a

    @point.setter
    def point(self, value: Pair) -> None:
        self._is_target("point")
        x, y = checks.position("point", value)
        row = self._row
        if (row["local_ax"], row["local_ay"]) != (x, y):
            self._set(local_ax=x, local_ay=y)

    def _is_target(self, name):
        if self.kind != "Target":
            raise AttributeError(f"{name} belongs to a Target; joint {self._id} is a {self.kind}")

    # --- gears, pulleys and ratchets ----------------------------------------------------------------------------------

    def _is_one_of(self, name, *kinds):
        if self.kind not in kinds:
            raise AttributeError(f"{name} belongs to a {' or '.join(kinds)}; joint {self._id} is a {self.kind}")
        return self._row

    @property
    def joint_a(self) -> Joint | None:
        """The first joint that a Gear couples, or None if it couples a body instead.

        Raises AttributeError for other kinds.
        """
        return self._coupled("joint_a")

    @property
    def joint_b(self) -> Joint | None:
        """The second joint that a Gear couples, or None if it couples a body instead.

        Raises AttributeError for other kinds.
        """
        return self._coupled("joint_b")

    def _coupled(self, name):
        identity = self._is_one_of(name, "Gear")[name].item()
        return None if identity == NO_JOINT else Joint(self._world, identity)

    @property
    def ratio(self) -> float:
        """The ratio of a Gear or Pulley. Raises AttributeError for other kinds.

        Setting it also changes the phase of the Gear or the length of the rope, so that no body has to move.
        """
        return self._is_one_of("ratio", "Gear", "Pulley")["ratio"].item()

    @ratio.setter
    def ratio(self, value: float) -> None:
        row = self._is_one_of("ratio", "Gear", "Pulley")
        of_gear = row["hold"] == GEARED
        value = checked_ratio(value) if of_gear else checks.number("ratio", value, above=0.0)
        change = sum_with(self._world, self._id, value) - sum_with(self._world, self._id, row["ratio"].item())
        names = ("phase",) if of_gear else ("lower", "upper")
        self._set(ratio=value, **{name: row[name].item() + change for name in names})

    @property
    def phase(self) -> float:
        """The sum of coordinates that a Gear keeps constant, or the angle of one tooth of a Ratchet [rad].

        Raises AttributeError for other kinds.
        """
        return self._is_one_of("phase", "Gear", "Ratchet")["phase"].item()

    @phase.setter
    def phase(self, value: float) -> None:
        row = self._is_one_of("phase", "Gear", "Ratchet")
        value = checks.number("phase", value)
        teeth = tooth_at(self.angle, value, row["ratchet"].item()) if self.kind == "Ratchet" else {}
        self._set(phase=value, **teeth)

    @property
    def ratchet(self) -> float:
        """The angle between adjacent teeth of a Ratchet [rad]. Its sign is the direction in which body B may rotate.

        Setting it computes the last passed tooth again from the present angle. Raises AttributeError for other kinds.
        """
        return self._is_one_of("ratchet", "Ratchet")["ratchet"].item()

    @ratchet.setter
    def ratchet(self, value: float) -> None:
        row = self._is_one_of("ratchet", "Ratchet")
        value = checked_ratio(value, "ratchet")
        self._set(ratchet=value, **tooth_at(self.angle, row["phase"].item(), value))

    @property
    def length(self) -> float:
        """The length of the rope of a Pulley [px]. Setting it shortens or lengthens the rope, which moves the bodies.

        Raises AttributeError for other kinds.
        """
        return self._is_one_of("length", "Pulley")["upper"].item()

    @length.setter
    def length(self, value: float) -> None:
        row = self._is_one_of("length", "Pulley")
        value = checks.number("length", value, above=0.0)
        self._set(upper=value, lower=value if row["lower"] == row["upper"] else -math.inf)

    @property
    def user(self) -> Any:
        """Any value that the caller attaches to the joint; None by default."""
        self._must_exist()
        return self._world._joint_users.get(self._id)

    @user.setter
    def user(self, value: Any) -> None:
        self._must_exist()
        self._world._joint_users[self._id] = value

    def remove(self) -> None:
        """Remove the joint from the world, together with the gears that couple it, and wake its bodies."""
        remove(self._world, self)
