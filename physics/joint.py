"""Joint, a handle on one row of `world.joints`; and the functions that add, change and remove joints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import fields
from typing import Any, get_args

import numpy as np

from physics import checks, hints
from physics.annotations import JointSolverName, Pair, Range
from physics.gear import gear_rows, hang, report_gears, side_of, sum_with, with_gears
from physics.islands import sleep
from physics.joints.kinds import (
    KINDS,
    Drive,
    Kind,
    Spring,
    Weld,
    checked_breaks,
    checked_limits,
    checked_ratio,
    checked_spring,
    motor_fields,
    tooth_at,
)
from physics.math2d import Vec2, rotate
from physics.solver.joint_report import report_joints
from physics.tables.body import DYNAMIC
from physics.tables.joint import ANGLE, BROKEN, GEARED, JOINT, LENGTH, NO_COORDINATE, NO_JOINT, WORLD
from physics.tables.table import row_number, rows_in
from physics.world_state import WorldState

JOINT_SOLVERS: tuple[JointSolverName, ...] = get_args(JointSolverName)
NO_JOINTS, NONE_BROKEN = np.zeros(0, JOINT), np.zeros(0, BROKEN)

# ---- adding ----------------------------------------------------------------------------------------------------------


def add(
    world: WorldState, kind: Any, bodies_a: np.ndarray, bodies_b: np.ndarray, columns: dict[str, Any]
) -> np.ndarray:
    """Append joints of one kind to a world, and return their ids (n,).

    kind: a Kind with the settings of all joints; bodies_a, bodies_b: ids (n,) int64, WORLD for the world; columns:
    anchors (n, 2) [px] and axes (n, 2), by argument name. Raises TypeError or ValueError for invalid arguments,
    KeyError for an unknown body; the world is then unchanged.
    """
    n = len(bodies_a)
    check_bodies(world, bodies_a, bodies_b)
    given = kind.columns()
    _check_effects(world, kind, given)
    rows = np.zeros(n, JOINT)
    for name, value in given.items():
        rows[name] = 0.0 if value is None else value
    rows["kind"] = KINDS.index(type(kind))
    rows["body_a"], rows["body_b"] = bodies_a, bodies_b
    rows["body_row_a"], rows["body_row_b"] = (rows_in(world._bodies, ids) for ids in (bodies_a, bodies_b))
    poses = [_poses(world, ids) for ids in (bodies_a, bodies_b)]
    rows["reference"] = poses[1][:, 2] - poses[0][:, 2]
    anchors = _anchors(kind, columns, poses)
    for (x, y), points, pose in zip((("local_ax", "local_ay"), ("local_bx", "local_by")), anchors, poses, strict=True):
        rows[x], rows[y] = points.T if kind.local else _to_local(points, pose).T
    world_anchors = [_to_world(p, pose) if kind.local else p for p, pose in zip(anchors, poses, strict=True)]
    if kind.AXIS:
        axes = columns["axis"]
        lengths = np.sqrt((axes * axes).sum(axis=1))
        if (lengths == 0.0).any():
            raise ValueError(f"axis must have a length (got {axes[np.argmin(lengths)].tolist()})")
        axes = axes / lengths[:, None]
        turned = poses[0].copy()
        turned[:, :2] = 0.0
        rows["axis_x"], rows["axis_y"] = axes.T if kind.local else _to_local(axes, turned).T
    spread = world_anchors[1] - world_anchors[0]
    lengths = np.sqrt((spread * spread).sum(axis=1))
    if given.get("coordinate") == LENGTH and (lengths == 0.0).any():
        raise ValueError(
            f"at_a and at_b must be two points (got {world_anchors[0][np.argmin(lengths)].tolist()} twice)"
        )
    kind.with_lengths(rows, lengths)
    if kind.GROUND:
        hang(kind, columns, world_anchors, rows)
    return _append(world, kind, rows)


def add_gears(
    world: WorldState, kind: Any, sides_a: list[tuple[bool, int]], sides_b: list[tuple[bool, int]]
) -> np.ndarray:
    """Append gears to a world, and return their ids (n,). Arguments and errors as in gear.gear_rows, and as in add."""
    _check_effects(world, kind, kind.columns())
    rows = gear_rows(world, kind, sides_a, sides_b)
    rows["kind"] = KINDS.index(type(kind))
    return _append(world, kind, rows)


def _append(world, kind, rows):
    """Append JOINT rows (n,) of one kind to a world, wake their bodies, and return the new ids."""
    n = len(rows)
    rows["id"] = np.arange(world._next_joint, world._next_joint + n)
    world._next_joint += n
    world._joints.append(n)[:] = rows
    if kind.user is not None:
        world._joint_users.update(dict.fromkeys(rows["id"].tolist(), kind.user))
    set_apart(world, wake(world, rows))
    if kind.COUPLES:
        report_gears(world, kind, n)
    else:
        report_joints(world.bodies, world.joints[world._joints.count - n :])
    return rows["id"].copy()


def _poses(world, ids):
    """Return the poses of bodies (ids): (n, 3) x, y [px], angle [rad]; (0, 0, 0) for WORLD."""
    found = np.zeros((len(ids), 3))
    there = ids != WORLD
    rows = world.rows(ids[there])
    for k, name in enumerate(("x", "y", "angle")):
        found[there, k] = world.bodies[name][rows]
    return found


def _anchors(kind, columns, poses):
    """Return (anchors of A, anchors of B), each (n, 2), from `columns`; zeros for a kind without anchors."""
    n = len(poses[0])
    if not kind.POINTS:
        return np.zeros((n, 2)), np.zeros((n, 2))
    first, second = columns[kind.POINTS[0]], columns[kind.POINTS[-1]]
    return first, second


def _to_local(points, poses):
    x, y = points[:, 0] - poses[:, 0], points[:, 1] - poses[:, 1]
    cosine, sine = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    return np.stack([cosine * x + sine * y, cosine * y - sine * x], axis=1)


def _to_world(points, poses):
    cosine, sine = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    x, y = points.T
    return np.stack([poses[:, 0] + cosine * x - sine * y, poses[:, 1] + sine * x + cosine * y], axis=1)


def check_bodies(world: WorldState, bodies_a: np.ndarray, bodies_b: np.ndarray) -> None:
    """Raise ValueError unless each joint has two different bodies, one of them dynamic, and no body of a character.

    bodies_a, bodies_b: ids (n,), WORLD for the world. Raises KeyError for an unknown body.
    """
    same = bodies_a == bodies_b
    if same.any():
        which = bodies_a[same][0]
        raise ValueError(
            f"b must be another body than a (got {'the world' if which == WORLD else f'body {which}'} twice)"
        )
    dynamic = np.zeros(len(bodies_a), bool)
    for name, ids in (("a", bodies_a), ("b", bodies_b)):
        there = ids != WORLD
        dynamic[there] |= world.bodies["kind"][world.rows(ids[there])] == DYNAMIC
        walking = np.isin(ids, world.characters.rows["body"])
        if walking.any():
            raise ValueError(
                f"{name} must not be the body of a character, which joints cannot move (got body {ids[walking][0]})"
            )
    if not dynamic.all():
        k = int(np.argmin(dynamic))
        shown = ["the world" if each == WORLD else f"body {each}" for each in (bodies_a[k], bodies_b[k])]
        raise ValueError(f"a or b must be a dynamic body (got {shown[0]} and {shown[1]})")


def _check_effects(world, kind, given):
    """Raise ValueError if the world lacks the solver or an effect that joints of a kind need.

    given: the JOINT columns of the kind.
    """
    name = type(kind).__name__
    world._needs("joints", name, True)
    if not world.stacks:
        raise ValueError(f"{name} needs one of the solvers soft_step, sequential_impulse (got {world.solver!r})")
    asked = given["motor_max"] if "motor_max" in given else 0.0
    asked = asked or given.get("spring_hertz") or max(given["lower"], -given["upper"]) > -math.inf
    world._needs("rotation", f"{name} with limits, motor or spring", given.get("coordinate") == ANGLE and bool(asked))
    world._needs("rotation", f"{name} with a motor", bool(given.get("turns_motor") and given.get("motor_max")))
    world._needs("rotation", f"{name} with angular_velocity", bool(given.get("target_spin")))
    world._needs("rotation", f"{name} with angular_spring", type(kind) is Weld and bool(given.get("angle_hertz")))


def add_one(world: WorldState, kind: Any) -> Joint:
    """Add the joint that a Kind describes, and return its handle. Raises the errors of World.add_joint."""
    world._unlocked()
    if not isinstance(kind, Kind) or type(kind) not in KINDS:
        hint = ": write Revolute(a, b, at)" if hints.is_own(kind, "Body") or isinstance(kind, int) else ""
        if isinstance(kind, type) and kind in KINDS:
            hint = f": write {kind.__name__}(…), a joint of this kind"
        raise TypeError(f"joint must be one of {_names()} (got {checks.shown(kind)}){hint}")
    a, b = kind.sides()
    if kind.COUPLES:
        sides = side_of(world, "joint_a", a, Joint), side_of(world, "joint_b", b, Joint)
        return Joint(world, int(add_gears(world, kind, [sides[0]], [sides[1]])[0]))
    name = "b" if "b" in vars(kind) else "body"
    bodies_a, bodies_b = _body_ids(world, "a", [a]), _body_ids(world, name, [b])
    given, columns = vars(kind), {}
    for name in kind.POINTS:
        point = given[name]
        if point is None:
            name_of_default = "at" if name == "point" else name
            point = _default_point(world, kind, name, bodies_b.item(0))
            point = checks.position(name_of_default, point)
        columns[name] = np.array([checks.position(name, point)])
    for name in kind.GROUND:
        columns[name] = np.array([checks.position(name, given[name])])
    if kind.AXIS:
        columns["axis"] = np.array([checks.vector("axis", given["axis"])])
    return Joint(world, int(add(world, kind, bodies_a, bodies_b, columns)[0]))


def _hint_of_kind(value) -> str:
    if isinstance(value, Kind):
        return f": write {type(value).__name__}, the class, and its settings as arguments of add_joints"
    similar = hints.near(value, [each.__name__ for each in KINDS]) if isinstance(value, str) else ""
    return f": write {similar}, the class" if similar else ""


def _names() -> str:
    return ", ".join(each.__name__ for each in KINDS)


def _default_point(world, kind, name, body):
    """Return the anchor for which an argument None stands, or None if the argument must be given.

    It is kind.at for Target.point, and B's centre of mass for Motor.at. name: name of the argument; body: id of B.
    """
    if name == "point":
        return kind.at
    if "at" not in type(kind).__dataclass_fields__ or type(kind).__dataclass_fields__["at"].default is not None:
        return None
    row = world._body_row(body)
    return (0.0, 0.0) if kind.local else (row["center_x"].item(), row["center_y"].item())


def _body_ids(world, name, values) -> np.ndarray:
    """Return the ids (n,) int64 of Bodies, ids or None (the world). name: name of the argument in messages.

    Raises TypeError or ValueError for invalid arguments, KeyError for an unknown body.
    """
    found = [WORLD if each is None else world._identity(name, each) for each in values]
    for each in found:
        if each != WORLD:
            world._row_at(each)
    return np.array(found, np.int64).reshape(len(found))


def add_many(world: WorldState, kind: Any, bodies_a: Any, bodies_b: Any, settings: dict[str, Any]) -> np.ndarray:
    """Add joints of one kind between pairs of bodies, and return their ids.

    Arguments and errors as in World.add_joints.
    """
    world._unlocked()
    if not (isinstance(kind, type) and kind in KINDS):
        raise TypeError(f"kind must be one of {_names()} (got {checks.shown(kind)}){_hint_of_kind(kind)}")
    sides = [name for name in ("a", "b", "body", "joint_a", "joint_b") if name in kind.__dataclass_fields__]
    known = {field.name for field in fields(kind)}.difference(sides)
    if wrong := {name: settings[name] for name in settings.keys() - known}:
        raise hints.unexpected(f"World.add_joints({kind.__name__})", sorted(known), wrong)
    for name, each in (("bodies_a", bodies_a), ("bodies_b", bodies_b)):
        if each is not None and not isinstance(each, Iterable):
            raise TypeError(f"{name} must be Bodies or ids, or None (got {checks.shown(each)})")
    first, second = (None if each is None else [*each] for each in (bodies_a, bodies_b))
    n = len(first or second or ())
    if kind.COUPLES:
        return _add_many_gears(world, kind, first or [], second or [], settings)
    first, second = (
        _body_ids(world, name, [None] * n if each is None else each)
        for name, each in (("bodies_a", first), ("bodies_b", second))
    )
    if len(first) != len(second):
        raise ValueError(f"bodies_b must have as many entries as bodies_a (got {len(second)} and {len(first)})")
    points = (*kind.POINTS, *kind.GROUND)
    columns = {name: _column(kind, name, settings, n) for name in (*points, *(("axis",) if kind.AXIS else ()))}
    rest = {name: value for name, value in settings.items() if name not in columns}
    made = kind(**dict.fromkeys(sides), **{name: (0.0, 0.0) for name in points}, **rest)
    return add(world, made, first, second, columns)


def _add_many_gears(world, kind, first, second, settings) -> np.ndarray:
    """Add a gear of one kind for each pair of joints or bodies, and return their ids (n,). Errors as in add_many."""
    if len(first) != len(second):
        raise ValueError(f"bodies_b must have as many entries as bodies_a (got {len(second)} and {len(first)})")
    made = kind(None, None, **settings)
    sides = [
        [side_of(world, f"{name}[{k}]", each, Joint) for k, each in enumerate(given)]
        for name, given in (("bodies_a", first), ("bodies_b", second))
    ]
    return add_gears(world, made, *sides)


def _column(kind, name, settings, n) -> np.ndarray:
    """Return the argument `name`, anchors or an axis, as an array (n, 2) for n joints.

    A single pair is repeated for all joints. settings: the keyword arguments of World.add_joints. Raises TypeError or
    ValueError for invalid arguments.
    """
    if name not in settings and name != "axis":
        raise TypeError(f"add_joints() needs {name}, an array (n, 2) of points, for {kind.__name__}")
    given = settings.get(name, kind.axis if name == "axis" else None)
    if np.ndim(given) == 1 and len(given) == 2:
        return np.repeat([checks.vector(name, given)], n, axis=0)
    return checks.columns(name, given, n, like="bodies_a")


# ---- changes ---------------------------------------------------------------------------------------------------------


def wake(world: WorldState, rows: np.ndarray) -> list[int]:
    """Wake the bodies of JOINT rows, if they still exist, and return their ids."""
    ids = np.unique(np.concatenate([rows["body_a"], rows["body_b"]]))
    ids = [each for each in ids.tolist() if each in world._shapes_of]
    sleep.disturb(world, ids)
    return ids


def set_apart(world: WorldState, ids: Iterable[int]) -> None:
    """Have the next step find anew which pairs of bodies a joint keeps apart. ids: bodies of the changed joints."""
    world._apart = (world._apart or set[int]()).union(ids)


def keep_apart(world: WorldState) -> None:
    """Set the pairs of bodies that the broad phase leaves out, because a joint forbids contacts between them.

    A step calls this function first if joints have changed. If the pairs changed, the pairs of the bodies of changed
    joints are searched again. O(joints log joints).
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
    """Remove joints, given as Joints or ids, one or many, and the gears that couple them.

    The next step reports these gears as broken, with the reason "removed". Raises KeyError for an unknown joint,
    TypeError for anything but Joints and ids, ValueError for a Joint of another world, RuntimeError during a step.
    Nothing is removed then.
    """
    world._unlocked()
    rows = joint_rows(world, ids)
    asked = world.joints["id"][rows]
    gone = drop(world, with_gears(world, rows))
    world._lost_joints += told(gone[~np.isin(gone["id"], asked)], "removed").tolist()


def drop(world: WorldState, rows: np.ndarray) -> np.ndarray:
    """Remove the joints with these row numbers and wake their bodies. Return copies of the rows."""
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
        world._lost_joints += told(drop(world, with_gears(world, mine)), "removed").tolist()


def told(rows: np.ndarray, reason: str | np.ndarray) -> np.ndarray:
    """Return a BROKEN row, which reports a broken joint, for each JOINT row.

    reason: "force", "torque" or "removed"; one value for all rows, or one per row.
    """
    found = np.zeros(len(rows), BROKEN)
    found["joint"], found["body_a"], found["body_b"] = rows["id"], rows["body_a"], rows["body_b"]
    found["force"] = np.hypot(rows["force_x"], rows["force_y"])
    found["torque"], found["reason"] = rows["torque"], reason
    return found


def break_joints(world: WorldState, events: Any) -> None:
    """Remove the joints that broke in the last step, and report them in events.broken.

    Gears that couple a broken joint are removed and reported too. So are joints of bodies that were removed before the
    step.
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
    events.broken = np.concatenate([lost, told(gone, reason)])


def joint_rows(world: WorldState, ids: Any) -> np.ndarray:
    """Return the row numbers of joints, given as Joints or ids, one or many. Each row is listed once.

    Raises KeyError for an unknown joint, TypeError for anything but Joints and ids, ValueError for a Joint of another
    world.
    """
    if isinstance(ids, (Joint, int, np.integer)):
        ids = [ids]
    if not isinstance(ids, Iterable):
        raise TypeError(f"ids must be Joints or ids (got {checks.shown(ids)})")
    numbers = checks.ids("ids", [_identity(world, each) for each in ids], repeats=True)
    rows = rows_in(world._joints, np.unique(numbers))
    if (rows < 0).any():
        raise checks.NoSuchId(f"no joint {np.unique(numbers)[rows < 0][0]} in this world")
    return rows


def row_of(world: WorldState, joint: Any) -> int:
    """Return the row number of one joint, given as a Joint or id.

    Raises KeyError for an unknown one, TypeError for anything else.
    """
    return int(joint_rows(world, [_identity(world, joint)])[0])


def _identity(world, value):
    if isinstance(value, Joint):
        if value.world is not world:
            raise ValueError(f"joint must be of this world (got {checks.shown(value)} of another one)")
        return value.id
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"joint must be a Joint or an id (got {checks.shown(value)})")
    return int(value)


# ---- handle ----------------------------------------------------------------------------------------------------------


class Joint:
    """A handle on one joint of a world.

    world: the World of the joint; identity: the id of the joint, a whole number.

    Properties other than world and id raise KeyError for a joint that was removed or broke; point, joint_a, joint_b,
    ratio, phase, ratchet and length raise AttributeError for kinds without them. A setter raises TypeError or
    ValueError for an invalid value, RuntimeError during a step. The world is then unchanged.
    """

    __slots__ = ("_world", "_id")

    def __init__(self, world: WorldState, identity: int) -> None:
        self._world, self._id = world, int(identity)

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
        """Write the given columns (keyword arguments) of the JOINT row, and wake the two bodies."""
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
        """The Body of side A, None for the world."""
        return self._body("body_a")

    @property
    def body_b(self) -> Any:
        """The Body of side B, None for the world."""
        return self._body("body_b")

    def _body(self, name):
        identity = self._row[name].item()
        return None if identity == WORLD else self.world.body(identity)

    @property
    def anchor_a(self) -> Vec2:
        """The anchor of A in the world [px]."""
        return self._anchor("a")

    @property
    def anchor_b(self) -> Vec2:
        """The anchor of B in the world [px]."""
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
        """The angle of B relative to A [rad] after the last step. It was 0 when the joint was made."""
        return self._row["angle"].item()

    @property
    def translation(self) -> float:
        """The translation of B along the axis [px] after the last step; for a Distance the distance of the anchors.

        For a Gear the sum of coordinates that it holds, for a Pulley the length of rope in use.
        """
        return self._row["translation"].item()

    @property
    def speed(self) -> float:
        """Rate of change of the joint's angle [rad/s], or of its translation or length [px/s], after the last step.

        For a joint whose kind controls neither, it is that of the angle.
        """
        return self._row["speed"].item()

    @property
    def separation(self) -> float:
        """The error of the joint [px]: distance of held anchors, distance from the axis, or excess over limits.

        For a Gear the error of its sum, in the unit of the coordinate of joint_a.
        """
        return self._row["separation"].item()

    @property
    def force(self) -> float:
        """Magnitude of the force in the last step [mass px/s²].

        The JOINT columns force_x and force_y hold the vector.
        """
        row = self._row
        return math.hypot(row["force_x"].item(), row["force_y"].item())

    @property
    def torque(self) -> float:
        """The torque on B in the last step [mass px²/s²], in addition to the torque of the force at the anchor."""
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
        """The motor: a Drive or None. Setting one raises ValueError for a kind without a coordinate."""
        row = self._row
        return Drive(row["motor_speed"].item(), row["motor_max"].item()) if row["motor_max"] > 0.0 else None

    @motor.setter
    def motor(self, value: Drive | None) -> None:
        self._takes("motor", value is not None)
        self._set(**motor_fields(value))

    @property
    def spring(self) -> Spring | None:
        """The spring on the joint's angle, translation or length: a Spring or None. Setting one raises as for motor."""
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
        """The limits (low, high) of the joint's angle, translation or length; None: no limits.

        A value is -inf or inf where only the other side is limited. Setting them raises as for motor, and for a
        Ratchet.
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
        """The (force [mass px/s²], torque [mass px²/s²]) above which the joint breaks; inf: it never does."""
        row = self._row
        return row["break_force"].item(), row["break_torque"].item()

    @breaks.setter
    def breaks(self, value: Range | None) -> None:
        force, torque = checked_breaks(value)
        self._set(break_force=force, break_torque=torque)

    @property
    def contacts(self) -> bool:
        """Whether the two bodies may touch each other."""
        return bool(self._row["contacts"])

    @contacts.setter
    def contacts(self, value: bool) -> None:
        self._set(contacts=checks.flag("contacts", value))

    @property
    def enabled(self) -> bool:
        """Whether the joint acts. A disabled joint keeps its settings."""
        return bool(self._row["enabled"])

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self._set(enabled=checks.flag("enabled", value))

    @property
    def point(self) -> Vec2:
        """The point of the world to which a Target pulls its body [px]. Raises AttributeError for other kinds."""
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
        """The joint of side A of a Gear, None if the side is a body. Raises AttributeError for other kinds."""
        return self._coupled("joint_a")

    @property
    def joint_b(self) -> Joint | None:
        """The joint of side B of a Gear, None if the side is a body. Raises AttributeError for other kinds."""
        return self._coupled("joint_b")

    def _coupled(self, name):
        identity = self._is_one_of(name, "Gear")[name].item()
        return None if identity == NO_JOINT else Joint(self._world, identity)

    @property
    def ratio(self) -> float:
        """The ratio of a Gear or Pulley. Raises AttributeError for other kinds.

        A change keeps the present poses: the phase of a gear, or the length of a rope, changes too.
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
        """The sum of coordinates that a Gear holds, or the angle of a tooth of a Ratchet [rad]."""
        return self._is_one_of("phase", "Gear", "Ratchet")["phase"].item()

    @phase.setter
    def phase(self, value: float) -> None:
        row = self._is_one_of("phase", "Gear", "Ratchet")
        value = checks.number("phase", value)
        teeth = tooth_at(self.angle, value, row["ratchet"].item()) if self.kind == "Ratchet" else {}
        self._set(phase=value, **teeth)

    @property
    def ratchet(self) -> float:
        """The angle from tooth to tooth of a Ratchet [rad], in the direction in which B may turn.

        A change sets the last tooth by the present angle. Raises AttributeError for other kinds.
        """
        return self._is_one_of("ratchet", "Ratchet")["ratchet"].item()

    @ratchet.setter
    def ratchet(self, value: float) -> None:
        row = self._is_one_of("ratchet", "Ratchet")
        value = checked_ratio(value, "ratchet")
        self._set(ratchet=value, **tooth_at(self.angle, row["phase"].item(), value))

    @property
    def length(self) -> float:
        """The length of the rope of a Pulley [px]. A change hauls the rope in or pays it out."""
        return self._is_one_of("length", "Pulley")["upper"].item()

    @length.setter
    def length(self, value: float) -> None:
        row = self._is_one_of("length", "Pulley")
        value = checks.number("length", value, above=0.0)
        self._set(upper=value, lower=value if row["lower"] == row["upper"] else -math.inf)

    @property
    def user(self) -> Any:
        """Any object that the caller attached to the joint, or None."""
        self._must_exist()
        return self._world._joint_users.get(self._id)

    @user.setter
    def user(self, value: Any) -> None:
        self._must_exist()
        self._world._joint_users[self._id] = value

    def remove(self) -> None:
        """Remove the joint and wake its bodies."""
        remove(self._world, self)
