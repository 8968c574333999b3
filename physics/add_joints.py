"""Creation of joints: checks of the arguments, and the JOINT rows computed from a kind, its bodies and anchors."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np

from physics import checks, hints
from physics.gear import gear_rows, hang, report_gears, side_of
from physics.joint import Joint, set_apart, wake
from physics.joints.kinds import KINDS, Kind, Weld
from physics.solver.joint_report import report_joints
from physics.tables.body import DYNAMIC
from physics.tables.joint import ANGLE, JOINT, LENGTH, WORLD
from physics.tables.table import rows_in
from physics.world_state import WorldState


def add(
    world: WorldState, kind: Any, bodies_a: np.ndarray, bodies_b: np.ndarray, columns: dict[str, Any]
) -> np.ndarray:
    """Append joints of one kind to a world, and return their ids (n,).

    kind: a Kind with the settings of all joints; bodies_a, bodies_b: ids (n,) int64 of the bodies, WORLD means the
    world; columns: {argument name: array (n, 2) of anchors [px] or axes}. Raises TypeError or ValueError for invalid
    arguments, KeyError for an unknown body; the world is then unchanged.
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
    """Append gears to a world, and return their ids (n,).

    kind: a Gear with the settings of all gears; sides_a, sides_b: the two sides of each gear, each side a tuple
    (True, id of a joint) or (False, id of a body). Raises the errors of gear.gear_rows and of add.
    """
    _check_effects(world, kind, kind.columns())
    rows = gear_rows(world, kind, sides_a, sides_b)
    rows["kind"] = KINDS.index(type(kind))
    return _append(world, kind, rows)


def _append(world, kind, rows):
    """Append JOINT rows (n,) of one kind to a world, wake the bodies of the joints, and return the joint ids (n,)."""
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
    """Return the poses of bodies as an array (n, 3) of x, y [px] and angle [rad].

    ids: ids (n,) of the bodies; the id WORLD has the pose (0, 0, 0).
    """
    found = np.zeros((len(ids), 3))
    there = ids != WORLD
    rows = world.rows(ids[there])
    for k, name in enumerate(("x", "y", "angle")):
        found[there, k] = world.bodies[name][rows]
    return found


def _anchors(kind, columns, poses):
    """Return (anchors of A, anchors of B), two arrays (n, 2); both are 0 for a kind without anchors.

    columns: the arrays by argument name, see add; poses: two arrays (n, 3), from which only n is used.
    """
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
    """Raise ValueError unless each joint has two different bodies, at least one of which is dynamic.

    Also raise it for the body of a character. bodies_a, bodies_b: ids (n,) of the bodies of n joints, WORLD means the
    world. Raises KeyError for an unknown body.
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
    """Raise ValueError if the world's solver cannot solve joints, or if an effect that the joint needs is off.

    kind: a Kind with the settings of the joint; given: kind.columns(), the JOINT columns of these settings.
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
    """Add one joint, and return its handle. Raises the errors of World.add_joint.

    kind: a Kind with the bodies, anchors and settings of the joint.
    """
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
    """Return the default anchor for an anchor argument that is None; None if the argument has no default.

    The default of Target.point is kind.at. The default of Motor.at is B's centre of mass, or (0, 0) if kind.local.
    name: name of the argument; body: id of body B.
    """
    if name == "point":
        return kind.at
    if "at" not in type(kind).__dataclass_fields__ or type(kind).__dataclass_fields__["at"].default is not None:
        return None
    row = world._body_row(body)
    return (0.0, 0.0) if checks.flag("local", kind.local) else (row["center_x"].item(), row["center_y"].item())


def _body_ids(world, name, values) -> np.ndarray:
    """Return the ids (n,) int64 of n bodies. values: n Bodies, ids or None; None means the world, whose id is WORLD.

    name: name of the argument in messages. Raises TypeError or ValueError for an invalid value, KeyError for an unknown
    body.
    """
    found = [WORLD if each is None else world._identity(name, each) for each in values]
    for each in found:
        if each != WORLD:
            world._row_at(each)
    return np.array(found, np.int64).reshape(len(found))


def add_many(world: WorldState, kind: Any, bodies_a: Any, bodies_b: Any, settings: dict[str, Any]) -> np.ndarray:
    """Add n joints of one kind between pairs of bodies, and return the ids (n,) of the joints.

    The arguments and errors are those of World.add_joints. settings: the keyword arguments of World.add_joints.
    """
    world._unlocked()
    if not (isinstance(kind, type) and kind in KINDS):
        raise TypeError(f"kind must be one of {_names()} (got {checks.shown(kind)}){_hint_of_kind(kind)}")
    sides = [name for name in ("a", "b", "body", "joint_a", "joint_b") if name in kind.__dataclass_fields__]
    known = {field.name for field in fields(kind)}.difference(sides)
    if wrong := {name: settings[name] for name in settings.keys() - known}:
        raise hints.unexpected(f"World.add_joints({kind.__name__})", sorted(known), wrong)
    for name, each in (("bodies_a", bodies_a), ("bodies_b", bodies_b)):
        checks.in_order(name, each, "bodies_b" if name == "bodies_a" else "bodies_a")
    first, second = (None if each is None else checks.listed(each) for each in (bodies_a, bodies_b))
    for name, each, found in (("bodies_a", bodies_a, first), ("bodies_b", bodies_b, second)):
        if each is not None and found is None:
            raise TypeError(f"{name} must be Bodies or ids, or None (got {checks.shown(each)})")
    n = len(first or second or ())
    users = checks.users(settings.pop("user", None), n)
    if kind.COUPLES:
        ids = _add_many_gears(world, kind, first or [], second or [], settings)
    else:
        ids = _add_many_of_bodies(world, kind, first, second, settings)
    world._joint_users.update((k, user) for k, user in zip(ids.tolist(), users, strict=True) if user is not None)
    return ids


def _add_many_of_bodies(world, kind, first, second, settings) -> np.ndarray:
    """Add a joint for each of n pairs of bodies, and return the ids (n,) of the joints. All joints are of one kind.

    first, second: lists with bodies A and B of the pairs, as Bodies, ids or None (the world); None instead of a list
    means the world in all pairs. settings: keyword arguments of World.add_joints. Raises the errors of add_many.
    """
    n = len(first or second or ())
    sides = [name for name in ("a", "b", "body") if name in kind.__dataclass_fields__]
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
    """Add a gear for each of n pairs of sides, and return the ids (n,) of the gears. Raises the errors of add_many.

    kind: the class Gear; first, second: lists with sides A and B of the gears, as Joints, ids of joints, or Bodies;
    settings: keyword arguments of World.add_joints.
    """
    if len(first) != len(second):
        raise ValueError(f"bodies_b must have as many entries as bodies_a (got {len(second)} and {len(first)})")
    made = kind(None, None, **settings)
    sides = [
        [side_of(world, f"{name}[{k}]", each, Joint) for k, each in enumerate(given)]
        for name, given in (("bodies_a", first), ("bodies_b", second))
    ]
    return add_gears(world, made, *sides)


def _column(kind, name, settings, n) -> np.ndarray:
    """Return the anchors [px] or axes of n joints as an array (n, 2), from the argument `name` in `settings`.

    A single pair (x, y) is used for all joints. settings: the keyword arguments of World.add_joints. Raises TypeError
    or ValueError for an invalid argument.
    """
    if name not in settings and name != "axis":
        raise TypeError(f"add_joints() needs {name}, an array (n, 2) of points, for {kind.__name__}")
    given = settings.get(name, kind.axis if name == "axis" else None)
    try:
        single = np.ndim(given) == 1 and len(given) == 2
    except ValueError:  # rows of different lengths, of which checks.columns makes an error
        single = False
    if single:
        return np.repeat([checks.vector(name, given)], n, axis=0)
    return checks.columns(name, given, n, like="bodies_a")
