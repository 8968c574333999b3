"""Gears and pulleys as JOINT rows: creation of the rows, their present state, and removal of dependent gears."""

from typing import Any

import numpy as np

from physics import checks
from physics.joints.kinds import KINDS, coupled_coordinate
from physics.solver.joint_report import report_joints
from physics.tables.body import DYNAMIC
from physics.tables.joint import ANGLE, GEARED, JOINT, NO_COORDINATE, NO_JOINT, WORLD
from physics.tables.table import rows_in
from physics.world_state import Handle, WorldState

# ---- adding ----------------------------------------------------------------------------------------------------------


def gear_rows(
    world: WorldState, kind: Any, sides_a: list[tuple[bool, int]], sides_b: list[tuple[bool, int]]
) -> np.ndarray:
    """Return JOINT rows (n,) of new gears. The caller, add_joints.add_gears, sets the ids and appends the rows.

    kind: a Gear with the settings of all gears; sides_a, sides_b: the sides of n gears, each (True, id of a joint) or
    (False, id of a body). The phases are set later by report_gears. Raises ValueError for a joint that neither rotates
    nor slides, two equal sides, a gear without a dynamic body, and the body of a character. Also raises it without the
    effect `rotation`. The world is unchanged.
    """
    rows = np.zeros(len(sides_a), JOINT)
    for name, value in kind.columns().items():
        rows[name] = value
    turning = False
    for row, (a, b) in zip(rows, zip(sides_a, sides_b, strict=True), strict=True):
        if a == b:
            shown = f"{'joint' if a[0] else 'body'} {a[1]}"
            raise ValueError(f"joint_b must be another side than joint_a (got {shown} twice)")
        dynamic = False
        for side, (of_joint, identity) in (("a", a), ("b", b)):
            joint, body, turns, moves = _side(world, f"joint_{side}", of_joint, identity)
            row[f"joint_{side}"], row[f"body_{side}"] = joint, body
            turning, dynamic = turning or turns, dynamic or moves
        if not dynamic:
            raise ValueError(f"joint_a or joint_b must have a dynamic body (got {_shown(a)} and {_shown(b)})")
    world._needs("rotation", "Gear of joints that turn", turning)
    for side in ("a", "b"):
        rows[f"body_row_{side}"] = rows_in(world._bodies, rows[f"body_{side}"])
    return rows


def _shown(side):
    return f"{'joint' if side[0] else 'body'} {side[1]}"


def _side(world, name, of_joint, identity):
    """Check one side of a gear, which is a joint or a body, and return its properties.

    The result is (joint id or NO_JOINT, body id, whether the coordinate of the side is an angle, whether the side has a
    dynamic body). For a joint, the body is B if B is dynamic, otherwise A if A is dynamic. name: name of the argument,
    for messages; of_joint: True: `identity` is the id of a joint, False: of a body.
    """
    if not of_joint:
        row = world._body_row(identity)
        if (world.characters.rows["body"] == identity).any():
            raise ValueError(
                f"{name} must not be the body of a character, which joints cannot move (got body {identity})"
            )
        return NO_JOINT, identity, True, row["kind"].item() == DYNAMIC
    row = world.joints[rows_in(world._joints, np.array([identity]))[0]]
    coordinate = coupled_coordinate(row)
    if coordinate == NO_COORDINATE:
        kind = KINDS[row["kind"].item()].__name__
        raise ValueError(
            f"{name} must be a joint that turns or slides, such as Revolute, Prismatic, Wheel or Angle "
            f"(got joint {identity}, a {kind})"
        )
    ids = [row[each].item() for each in ("body_b", "body_a")]
    dynamic = [each for each in ids if each != WORLD and world._body_row(each)["kind"].item() == DYNAMIC]
    body = (dynamic or [each for each in ids if each != WORLD])[0]
    return identity, body, coordinate == ANGLE, bool(dynamic)


def side_of(world: WorldState, name: str, value: Any, joint: Any) -> tuple[bool, int]:
    """Return one side of a gear as (True, id of a joint) or (False, id of a body).

    value: a Joint, the id of a joint, or a Body; name: name of the argument, for messages; joint: the class Joint.
    Raises TypeError for any other value, ValueError for a Joint or Body of another world, and NoSuchId (a KeyError and
    ValueError) for a joint or body that was removed.
    """
    if isinstance(value, Handle):
        identity = world._identity(name, value)
        world._row_at(identity)
        return False, identity
    if isinstance(value, joint):
        if value.world is not world:
            raise ValueError(f"{name} must be of this world (got {checks.shown(value)} of another one)")
        value = value.id
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} must be a Joint, the id of one, or a Body (got {checks.shown(value)})")
    known = 0 <= value < 2**62 and rows_in(world._joints, np.array([value], np.int64))[0] >= 0
    if not known:
        raise checks.NoSuchId(f"{name} must be a joint of this world (got {value}: removed, broken, or never added)")
    return True, int(value)


def report_gears(world: WorldState, kind: Any, count: int) -> None:
    """Write the present state of new gears to their JOINT rows, which are the last `count` rows of world.joints.

    kind: the Gear with their settings. If kind.phase is None, the phase becomes the present sum of coordinates.
    """
    total = len(world.joints)
    made = at_present(world, np.arange(total - count, total))
    if kind.phase is None:
        made["phase"] = made["translation"]
        made["separation"] = 0.0
    world.joints[total - count :] = made


def hang(kind: Any, columns: dict[str, Any], anchors: list[np.ndarray], rows: np.ndarray) -> None:
    """Write the positions of the two pulley wheels and the length of the rope to JOINT rows (n,) of Pulleys.

    kind: the Pulley with the settings of the rows; columns: see add_joints.add; anchors: world positions [px] of the
    anchors of A and of B, two arrays (n, 2). Raises ValueError if an anchor coincides with its wheel.
    """
    lengths = []
    for side, name, points in zip("ab", kind.GROUND, anchors, strict=True):
        ground = columns[name]
        rows[f"ground_{side}x"], rows[f"ground_{side}y"] = ground.T
        away = points - ground
        lengths.append(np.sqrt((away * away).sum(axis=1)))
        if (lengths[-1] == 0.0).any():
            shown = ground[np.argmin(lengths[-1])].tolist()
            raise ValueError(f"at_{side} and {name} must be two points (got {shown} twice)")
    kind.with_rope(rows, *lengths)


def sum_with(world: WorldState, identity: int, ratio: float) -> float:
    """Return the sum of coordinates of a gear or pulley (id) at the present poses, computed with another `ratio`."""
    rows = rows_in(world._joints, np.array([identity]))
    return at_present(world, rows, ratio)["translation"].item()


def at_present(world: WorldState, rows: np.ndarray, ratio: float | None = None) -> np.ndarray:
    """Return copies of JOINT rows (n,), with the state of the joints at the present poses of the bodies.

    The rows in world.joints are not changed and have the state after the last step. rows: ascending row numbers in
    world.joints; ratio: ratio of the copies, None: the ratio of each joint. Only these joints and the joints that they
    couple are read: O(n log joints).
    """
    joints = np.asarray(world.joints)
    sides = rows_in(world._joints, np.concatenate([joints["joint_a"][rows], joints["joint_b"][rows]]))
    taken = np.union1d(rows, sides[sides >= 0])  # ascending, as report_joints needs them
    found, mine = joints[taken], np.searchsorted(taken, rows)
    if ratio is not None:
        found["ratio"][mine] = ratio
    report_joints(world.bodies, found)
    return found[mine]


# ---- removal ---------------------------------------------------------------------------------------------------------


def with_gears(world: WorldState, rows: np.ndarray) -> np.ndarray:
    """Return the row numbers `rows` of joints, together with the row numbers of all gears that couple these joints.

    The result is an ascending int64 array without repetitions.
    """
    joints = world.joints
    gears = np.flatnonzero(joints["hold"] == GEARED)
    if not len(gears):
        return rows
    ids, on = joints["id"][rows], joints[gears]
    lost = np.isin(on["joint_a"], ids) | np.isin(on["joint_b"], ids)
    return np.union1d(rows, gears[lost])
