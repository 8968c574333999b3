"""Inspector of a joint: shows its bodies and settings, and the result of each stage of the last step for it.

The time of the joint alone is measured on request: a thousand copies of the joint with its bodies are stepped beside a
thousand copies of the bodies alone, in five steps after a warm-up, see joint_batch.py.
"""

from math import atan2, degrees, hypot, isinf
from typing import Any, NamedTuple

import numpy as np

from game.drawing.number_text import amount_text, count_text, percent_text, plain_name
from game.measure.contact_inspector import MICRO, Part
from game.measure.joint_batch import JointBatch
from game.measure.timing import LEAST_PAIRS, Cost
from game.overlays.layer_joints import anchored
from physics import DYNAMIC, JIT, World
from physics.annotations import Substeps
from physics.jit import tiers
from physics.joints.kinds import KINDS
from physics.settings import AUTO_SUBSTEPS
from physics.solver.joint_schur import MOST_SCHUR
from physics.tables.joint import (
    ANGLE,
    FREE,
    GEARED,
    LENGTH,
    NO_COORDINATE,
    NO_JOINT,
    ON_AXIS,
    PINNED,
    SLUNG,
    TOOTHED,
    TRANSLATION,
    WORLD,
)

MASS, FORCE, TORQUE = "density px2", "mass px/s2", "mass px2/s2"  # units of the columns of BODY and JOINT
COORDINATES = {ANGLE: ("angle", "rad"), TRANSLATION: ("translation", "px"), LENGTH: ("length", "px")}
MILLI = 1e3
FINE = 1e-4  # [px or rad] smaller errors are shown as less than this
FEW = 8  # copies that are timed where kernels run as plain Python


class Found(NamedTuple):
    """A joint near a point: its id, and its distance from the point [px]."""

    joint: int
    distance: float


def near(world: World, x: float, y: float, reach: float) -> list[Found]:
    """Return the joints within `reach` [px] of (x, y) [px], the nearest first.

    The distance is that of the nearer anchor. For a rope, rod or spring it is the distance of the line between the
    anchors.
    """
    if not len(world.joints):
        return []
    rows = anchored(world)
    ends = np.stack([np.column_stack([rows[side + "x"], rows[side + "y"]]) for side in "ab"])
    away = np.hypot(ends[..., 0] - x, ends[..., 1] - y).min(axis=0)
    lines = (rows["hold"] == FREE) & (rows["coordinate"] == LENGTH)
    along = ends[1] - ends[0]
    square = np.maximum((along * along).sum(axis=1), np.finfo(float).tiny)
    share = np.clip(((np.array([x, y]) - ends[0]) * along).sum(axis=1) / square, 0.0, 1.0)
    foot = ends[0] + share[:, None] * along
    away = np.where(lines, np.hypot(foot[:, 0] - x, foot[:, 1] - y), away)
    order = np.argsort(away, kind="stable")
    return [Found(int(rows["joint"][k]), float(away[k])) for k in order if away[k] <= reach]


def is_there(world: World, identity: int) -> bool:
    """Return whether the world has a joint with this id."""
    return bool((world.joints["id"] == identity).any())


def title_of(world: World, identity: int) -> str:
    """Return the title of a joint's card: "How does Revolute 5 hold 3 and 4?". Raises KeyError for an unknown joint."""
    row = _row(world, identity)
    holds = row["hold"] in (PINNED, ON_AXIS) and row["follows_point"] or row["coordinate"] == LENGTH
    bodies = [row[name] for name in ("body_a", "body_b") if row[name] != WORLD]
    named = f"{bodies[0]} and {bodies[1]}" if len(bodies) == 2 else f"body {bodies[0]}" + " to the world" * holds
    return f"How does {_kind(row)} {identity} {'hold' if holds else 'act on'} {named}?"


def explain(world: World, identity: int) -> list[Part]:
    """Return the Parts about a joint: its bodies, its settings, and the result of each stage of the last step for it.

    Raises KeyError for an unknown joint.
    """
    row = _row(world, identity)
    parts = [
        Part("bodies", _bodies(world, row)),
        Part("setting", _setting(world, row)),
        Part("islands", _islands(world, row)),
    ]
    if _is_idle_kind(row):
        return [*parts, Part("broad phase", _apart(row))]
    parts.append(Part(f"substeps, {_substeps_name(world)}", _substeps(world, row)))
    tier = "direct" if row["direct"] else "iterative"
    parts.append(Part(f"joint solver, {tier}" if row["awake"] else "joint solver", _tier(world, row)))
    parts.append(Part("warm start", _warm_start(world, row)))
    parts.append(Part(f"solver, {plain_name(world.solver)}", _forces(world, row) + _stage(world, world.solver)))
    parts.append(Part("joints", _report(world, row) + _stage(world, "joints")))
    return parts


def cost_of(world: World, identity: int) -> Cost | None:
    """Return the time [s] of a joint in a step, measured with copies of it; None if the joint was not solved.

    None, too, while kernels are being compiled. Raises KeyError for an unknown joint.
    """
    row = _row(world, identity)
    if not row["awake"] or (tiers.background and tiers.wanted):
        return None
    substeps: Substeps = world.substeps
    if substeps == "auto":
        now, following = _substeps_by_load(world, row)
        substeps = now or following or "auto"
    return JointBatch(world, identity, LEAST_PAIRS if JIT else FEW, substeps).cost()


def untimed(world: World, identity: int) -> str:
    """Return the reason in words why cost_of() returned None. Raises KeyError for an unknown joint."""
    if _row(world, identity)["awake"]:
        return "not timed while kernels compile"
    return "not solved in this step: it costs nothing"


# --- the joint ------------------------------------------------------------------------------------------------------


def _row(world, identity) -> dict[str, Any]:
    """Return the JOINT row of a joint as a dict. Raises KeyError for an unknown joint."""
    world.joint(identity)
    rows = world.joints
    at = int(np.searchsorted(rows["id"], identity))
    return {name: rows[name][at].item() for name in rows.dtype.names or ()}


def _kind(row):
    return KINDS[row["kind"]].__name__


def _is_idle_kind(row):
    """Return whether the joint has no forces, and only prevents contacts."""
    return row["hold"] == FREE and row["coordinate"] == NO_COORDINATE and not row["locks_angle"]


def _stage(world, name):
    seconds = world.profile.stages.get(name)
    return "" if seconds is None else f"; the stage took {MICRO * seconds:.0f} us"


def _bodies(world, row):
    words = []
    for side in ("a", "b"):
        identity = row[f"body_{side}"]
        if identity == WORLD:
            words.append(f"{side.upper()} the world")
            continue
        body = world.body(identity)
        name = f' "{body.user}"' if isinstance(body.user, str) else ""
        shapes = body.shapes
        shape = type(shapes[0]).__name__ if len(shapes) == 1 else count_text(len(shapes), "shape")
        mass = f", mass {amount_text(body.mass)} {MASS}" if body.kind == "dynamic" else ""
        words.append(f"{side.upper()} body {identity}{name}, {body.kind} {shape}{mass}")
    return "; ".join(words)


# --- its settings ---------------------------------------------------------------------------------------------------


def _setting(world, row):
    words = [] if row["enabled"] else ["switched off"]
    words += _coordinate_setting(row) + _hold_setting(row) + _coupling_setting(world, row)
    if not _is_idle_kind(row):
        limits = [
            f"{amount_text(row[name])} {unit}"
            for name, unit in (("break_force", FORCE), ("break_torque", TORQUE))
            if not isinf(row[name])
        ]
        words.append(f"breaks above {' or '.join(limits)}" if limits else "never breaks")
    words.append("contacts between its bodies" if row["contacts"] else "no contacts between its bodies")
    return ", ".join(words)


def _coordinate_setting(row):
    """Return texts of limits, motor and spring of the joint's coordinate."""
    name, unit = COORDINATES.get(row["coordinate"], ("", ""))
    lower, upper = row["lower"], row["upper"]
    if not name or row["hold"] == TOOTHED:
        return []
    words, absent = [], []
    if lower == upper:
        words.append(f"{name} held at {amount_text(lower)} {unit}")
    elif isinf(lower) and isinf(upper):
        absent.append("limits")
    elif isinf(upper):
        words.append(f"{name} at least {amount_text(lower)} {unit}")
    elif isinf(lower) or (lower == 0.0 and row["coordinate"] == LENGTH):
        words.append(f"{name} at most {amount_text(upper)} {unit}")
    else:
        words.append(f"{name} from {amount_text(lower)} to {amount_text(upper)} {unit}")
    if row["motor_max"] > 0.0:
        rate, most = ("rad/s", TORQUE) if row["turns_motor"] or unit == "rad" else ("px/s", FORCE)
        words.append(
            f"motor to {amount_text(row['motor_speed'])} {rate} with up to {amount_text(row['motor_max'])} {most}"
        )
    else:
        absent.append("motor")
    if row["spring_hertz"] > 0.0:
        rest = f"rest at {amount_text(row['spring_target'])} {unit}"
        words.append(f"spring of {row['spring_hertz']:.3g} Hz, damping ratio {row['spring_damping']:.3g}, {rest}")
    else:
        absent.append("spring")
    if absent and lower != upper:
        words.append(
            f"{'' if words else name + ' '}without {', '.join(absent[:-1])}{' or ' * (len(absent) > 1)}{absent[-1]}"
        )
    return words


def _hold_setting(row):
    """Return texts of the springs and bounds with which anchors and angle are held."""
    words = []
    for part, held, unit in (("point", "anchors", FORCE), ("angle", "angle", TORQUE)):
        if part == "angle" and not row["locks_angle"] or part == "point" and row["hold"] not in (PINNED, ON_AXIS):
            continue
        most = row[f"{part}_max"]
        bound = "" if isinf(most) else f" with up to {amount_text(most)} {unit}"
        if row[f"{part}_hertz"] > 0.0:
            hertz, damping = row[f"{part}_hertz"], row[f"{part}_damping"]
            words.append(f"{held} held by a spring of {hertz:.3g} Hz, damping ratio {damping:.3g}{bound}")
        elif not row[f"follows_{part}"]:
            speed = hypot(row["target_vx"], row["target_vy"]) if part == "point" else row["target_spin"]
            words.append(f"{held} driven at {speed:.3g} {'px/s' if part == 'point' else 'rad/s'}{bound}")
        else:
            words.append(f"{held} held {'on an axis' if row['hold'] == ON_AXIS and part == 'point' else 'rigidly'}")
    return words


def _coupling_setting(world, row):
    """Return texts of a gear, pulley or ratchet."""
    if row["hold"] == GEARED:
        a, b = (
            f"body {row[f'body_{side}']}" if row[f"joint_{side}"] == NO_JOINT else f"joint {row[f'joint_{side}']}"
            for side in ("a", "b")
        )
        unit = "px" if _slides(world, row) else "rad"
        sign = "-" if row["ratio"] < 0.0 else "+"
        return [f"keeps {a} {sign} {abs(row['ratio']):.3g} x {b} at {amount_text(row['phase'])} {unit}"]
    if row["hold"] == SLUNG:
        rope = "rod" if row["lower"] == row["upper"] else "rope"
        return [f"a {rope} of {row['upper']:.4g} px over two wheels, ratio {row['ratio']:.3g}"]
    if row["hold"] == TOOTHED:
        return [f"a tooth every {abs(row['ratchet']):.3g} rad"]
    return []


# --- the stages -----------------------------------------------------------------------------------------------------


def _apart(row):
    return "no forces: " + ("it allows contacts" if row["contacts"] else "the pair of its bodies is left out")


def _movers(world, row):
    """Return the BODY rows of the joint's dynamic bodies."""
    ids = np.array(sorted({row["body_a"], row["body_b"]} - {WORLD}), np.int64)
    bodies = world.bodies[world.rows(ids)]
    return bodies[bodies["kind"] == DYNAMIC]


def _islands(world, row):
    if not row["enabled"]:
        return "switched off: it does not act, and keeps nothing awake"
    movers = _movers(world, row)
    if not len(movers):
        return "idle: neither body is dynamic"
    if not world.effects.sleeping:
        return "awake: sleeping is not declared"
    if not movers["awake"].any():
        return "asleep with its island: no stage visits it"
    return f"awake, in the island of body {int(movers['island'].max())}" if movers["island"].max() >= 0 else "awake"


def _substeps_name(world):
    return "by load" if world.substeps == "auto" else "fixed"


def _substeps_by_load(world, row):
    """Return the numbers of substeps of the joint's group in the last and in the next step; 0: not known."""
    movers, plan, now = _movers(world, row), world.workspace.contacts.selection.plan, 0
    if plan.joint_count[0] and not plan.in_one_group[0]:  # else by another step than the last one
        now = AUTO_SUBSTEPS[int(plan.classes[[row["motion_a"], row["motion_b"]]].max())]
    return now, int(movers["substeps"].max()) if len(movers) else 0


def _substeps(world, row):
    if world.substeps != "auto":
        return f"{world.substeps} a step: world.substeps"
    if not row["awake"]:
        return "not solved in this step"
    now, following = _substeps_by_load(world, row)
    later = f"{following} in the next" if following else "not known for the next"
    return f"its group took {now} in this step, {later}" if now else f"of its group: {later}"


def tree_rows(row: dict[str, Any]) -> int:
    """Return the number of equations of a joint that a tree can solve exactly, 0 to 3. row: a JOINT row as a dict.

    See holds_point, holds_angle and holds_coordinate of physics/solver/joint_rows.py.
    """
    point = row["hold"] != FREE and row["follows_point"] and isinf(row["point_max"])
    angle = row["locks_angle"] and row["follows_angle"] and isinf(row["angle_max"])
    spring = row["spring_hertz"] > 0.0
    coordinate = row["coordinate"] != NO_COORDINATE and (row["lower"] == row["upper"] or spring)
    return (2 if row["hold"] == PINNED else 1) * bool(point) + bool(angle) + bool(coordinate)


def _tier(world, row):
    if not row["awake"]:
        return "not solved in this step"
    chosen = f'joint_solver is "{world.joint_solver}"'
    if world.joint_solver == "auto":
        chosen += f": trees are exact, with up to {MOST_SCHUR} equations of loops"
    has_limits = row["coordinate"] != NO_COORDINATE and row["lower"] < row["upper"]
    has_limits &= not (isinf(row["lower"]) and isinf(row["upper"]))
    extras = [(row["exact_limits"], "limits", has_limits), (row["exact_motor"], "motor", row["motor_max"] > 0.0)]
    if row["direct"]:
        others, loops = _linked(world, row)
        among = f"exact, with {count_text(others, 'other')} in its tree" if others else "exact, alone in its tree"
        among += f" and {count_text(loops, 'loop')}" if loops else ""
        beside = [name for exact, name, there in extras if there and not exact]
        late = f", its {' and '.join(beside)} iterative" if beside else ""
        return f"{among}{late}; {chosen}"
    exact = [name for exact, name, _ in extras if exact]
    if exact:
        return f"its {' and '.join(exact)} exact, beside the tree of its bodies; {chosen}"
    if world.joint_solver == "iterative":
        return f"joint after joint in each substep; {chosen}"
    if row["hold"] >= TOOTHED:
        return f"couplings are not part of trees; {chosen}"
    if not tree_rows(row):
        return f"a tree needs a hold without bounds, which it has not; {chosen}"
    return f"its loops have more than {MOST_SCHUR} equations, or too many for the size of the tree; {chosen}"


def _linked(world, row):
    """Return (number of other direct joints in the joint's tree, number of loops among the dynamic bodies)."""
    rows = world.joints[world.joints["direct"] & world.joints["awake"]]
    bodies = world.bodies
    dynamic = {int(each) for each in bodies["id"][(bodies["kind"] == DYNAMIC) & (bodies["inverse_mass"] > 0.0)]}
    links = {}
    for k, ends in enumerate(zip(rows["body_a"].tolist(), rows["body_b"].tolist(), strict=True)):
        for each in dynamic.intersection(ends):
            links.setdefault(each, []).append((k, *ends))
    reached = dynamic & {row["body_a"], row["body_b"]}
    joints, waiting = set(), list(reached)
    while waiting:
        for k, *ends in links.get(waiting.pop(), ()):
            joints.add((k, len(dynamic.intersection(ends))))
            fresh = dynamic.intersection(ends) - reached
            reached |= fresh
            waiting += fresh
    inner = sum(count == 2 for _, count in joints)
    return len(joints) - 1, max(inner - (len(reached) - 1), 0)


def _warm_start(world, row):
    names = ("hold_torque", "spring_force", "motor_force", "lower_force", "upper_force")
    kept = [hypot(row["point_force_x"], row["point_force_y"]), *(abs(row[name]) for name in names)]
    if not any(kept):
        return "nothing is kept: the next step begins at no force"
    words = [f"{amount_text(kept[0])} {FORCE} between its anchors"] if kept[0] else []
    if row["hold_torque"]:
        words.append(f"{amount_text(abs(row['hold_torque']))} {TORQUE} on its angle")
    rest = sum(kept[2:])
    if rest:
        turning = row["coordinate"] == ANGLE or (row["hold"] == GEARED and not _slides(world, row))
        turning |= row["turns_motor"] and row["motor_force"] != 0.0
        unit = TORQUE if turning else FORCE
        words.append(f"{amount_text(rest)} {unit} along its coordinate")
    return f"the next step begins at {', '.join(words)}"


def _forces(world, row):
    """Return a text about force, torque, limits, motor and spring of the joint in the last step."""
    force = hypot(row["force_x"], row["force_y"])
    words = []
    if force > 0.0:
        angle = degrees(atan2(row["force_y"], row["force_x"]))
        words.append(f"{amount_text(force)} {FORCE} on B at {angle:.0f} deg{_weights(world, row, force)}")
    if row["torque"]:
        words.append(f"torque {amount_text(row['torque'])} {TORQUE} on B")
    words = words or ["bears nothing"]
    for name, value in (("break_force", force), ("break_torque", abs(row["torque"]))):
        if not isinf(row[name]):
            words.append(f"{percent_text(value / row[name])} of its {plain_name(name)}")
    words += _limit_words(row)
    if row["motor_max"] > 0.0:
        words.append(f"motor at {percent_text(abs(row['motor_force']) / row['motor_max'])} of its maximum")
    if row["spring_hertz"] > 0.0:
        unit = TORQUE if row["coordinate"] == ANGLE else FORCE
        words.append(f"spring {amount_text(row['spring_force'])} {unit}")
    return ", ".join(words)


def _weights(world, row, force):
    """Return a text that compares a force with the weight of the lighter body; "" without gravity."""
    movers = _movers(world, row)
    masses = movers["mass"][movers["inverse_mass"] > 0.0]
    pull = hypot(*world.gravity) if world.effects.gravity else 0.0
    if not len(masses) or pull == 0.0:
        return ""
    return f" ({amount_text(force / (float(masses.min()) * pull))} x the weight of its lighter body)"


def _limit_words(row):
    lower, upper = row["lower"], row["upper"]
    if row["hold"] == SLUNG:
        return ["rope taut" if row["upper_force"] > 0.0 else "rope slack"] if lower != upper else []
    if row["coordinate"] == NO_COORDINATE or lower == upper or (isinf(lower) and isinf(upper)):
        return []
    if row["hold"] == TOOTHED:
        return ["held by a tooth" if row["lower_force"] or row["upper_force"] else "between two teeth"]
    value = row["angle" if row["coordinate"] == ANGLE else "translation"]
    if row["lower_force"] > 0.0 or value <= lower:
        return ["at its lower limit"]
    if row["upper_force"] > 0.0 or value >= upper:
        return ["at its upper limit"]
    return ["between its limits at the end" if not isinf(lower) and not isinf(upper) else "off its limit at the end"]


def _report(world, row):
    """Return a text about coordinate, speed and separation of the joint after the last step."""
    words, (name, unit) = [], COORDINATES.get(row["coordinate"], ("", ""))
    if name:
        value = row["angle" if row["coordinate"] == ANGLE else "translation"]
        words.append(f"{name} {_measured(value)} {unit}, {_measured(row['speed'])} {unit}/s")
    elif row["hold"] == SLUNG:
        words.append(f"{amount_text(row['translation'])} px of rope in use")
    turning = row["hold"] == GEARED and not _slides(world, row)
    if row["hold"] in (PINNED, ON_AXIS, GEARED, SLUNG) and row["follows_point"] or row["coordinate"] == LENGTH:
        of_length = "off its length by" if row["lower"] == row["upper"] else "beyond its limits by"
        what = {
            PINNED: "anchors apart by",
            ON_AXIS: "off its axis by",
            GEARED: "sum off by",
            SLUNG: "rope too long by",
        }.get(row["hold"], of_length)
        words.append(f"{what} {_gap(row['separation'], 'rad' if turning else 'px', world)}")
    elif not name:
        words.append("nothing to measure: it controls a speed")
    if row["broken"]:
        words.append("broken: it is removed at the end of the step")
    return ", ".join(words)


def _measured(value):
    """Return a coordinate or its rate as text. Numbers below FINE squared are rounding errors, and shown as 0."""
    return amount_text(value if abs(value) >= FINE * FINE else 0.0)


def _slides(world, row):
    """Return whether the first side of a gear is a slider, whose coordinate is in px."""
    if row["joint_a"] == NO_JOINT:
        return False
    side = _row(world, row["joint_a"])
    return side["coordinate"] != ANGLE and not side["turns_motor"]


def _gap(value, unit, world):
    text = amount_text(value) if value == 0.0 or value >= FINE else f"less than {FINE:g}"
    if unit == "rad":
        return f"{text} rad"
    mm = MILLI * max(value, FINE if value else 0.0) / world.tolerances.pixels_per_meter
    return f"{text} px ({'<' if 0.0 < value < FINE else ''}{amount_text(mm)} mm)"
