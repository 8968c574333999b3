"""Results of a stage of the step for all joints of a world, in words: tiers, forces, limits, gaps, breaks, sleep."""

from typing import NamedTuple

import numpy as np

from game.drawing.number_text import amount_text, count_text, percent_text
from game.measure.joint_inspector import FINE, FORCE, MILLI
from physics import World
from physics.tables.joint import COUPLED_STATE, LENGTH, NO_COORDINATE, ON_AXIS, PINNED, STATE

COLUMNS = tuple(name for name, _ in (*STATE, *COUPLED_STATE))  # those of JOINT that are no scratch of the solver
MOST_NAMED = 4  # joints that are listed by their ids


class Results(NamedTuple):
    """Results of a stage for the joints. solved, measured, asleep: texts; "" if the stage did nothing of the kind."""

    solved: str = ""
    measured: str = ""
    asleep: str = ""

    def __str__(self) -> str:
        return "; ".join(text for text in self if text)


def joint_results(world: World, before: np.ndarray, after: np.ndarray, stage: str) -> Results:
    """Return the Results of the stage `stage` of a world. before, after: JOINT rows before and after the stage."""
    if not len(after) or len(before) != len(after):
        return Results()
    slept = int(np.count_nonzero(before["awake"] & ~after["awake"])) if stage != world.solver else 0
    return Results(
        solved(after) if stage == world.solver else "",
        measured(after, world.tolerances.pixels_per_meter) if stage == "joints" else "",
        f"{count_text(slept, 'joint')} fell asleep" if slept else "",
    )


def solved(rows: np.ndarray) -> str:
    """Return a text about the tiers, forces, limits and motors of solved joints. rows: JOINT rows after the solver."""
    awake = rows["awake"]
    direct, iterative = (int(np.count_nonzero(awake & each)) for each in (rows["direct"], ~rows["direct"]))
    counts = [(direct, "direct"), (iterative, "iterative"), (len(rows) - direct - iterative, "not solved")]
    words = [", ".join(f"{count} {name}" for count, name in counts if count)]
    rows = rows[awake]
    if not len(rows):
        return words[0]
    force = np.hypot(rows["force_x"], rows["force_y"])
    most = int(np.argmax(force))
    if force[most] > 0.0:
        words.append(f"force up to {amount_text(float(force[most]))} {FORCE} (joint {rows['id'][most]})")
    share = np.maximum(force / rows["break_force"], np.abs(rows["torque"]) / rows["break_torque"])
    if np.isfinite(rows["break_force"]).any() or np.isfinite(rows["break_torque"]).any():
        nearest = int(np.argmax(share))
        words.append(f"{percent_text(float(share[nearest]))} of what breaks it (joint {rows['id'][nearest]})")
    limited = (rows["coordinate"] != NO_COORDINATE) & (rows["lower"] != rows["upper"])
    at_limit = int(np.count_nonzero(limited & ((rows["lower_force"] > 0.0) | (rows["upper_force"] > 0.0))))
    if at_limit:
        words.append(f"{at_limit} at a limit")
    motors = rows["motor_max"] > 0.0
    full = int(np.count_nonzero(motors & (np.abs(rows["motor_force"]) >= 0.999 * rows["motor_max"])))
    if motors.any():
        words.append(f"{full} of {count_text(int(np.count_nonzero(motors)), 'motor')} at its maximum")
    return ", ".join(words)


def measured(rows: np.ndarray, scale: float) -> str:
    """Return a text about the gaps and breaks of joints.

    rows: JOINT rows after the stage that measures them; scale: pixels per metre.
    """
    words = []
    held = (np.isin(rows["hold"], (PINNED, ON_AXIS)) & rows["follows_point"]) | (rows["coordinate"] == LENGTH)
    held &= rows["enabled"] & (rows["point_hertz"] == 0.0)  # a spring may stretch
    if held.any():
        gaps = np.where(held, rows["separation"], -1.0)
        widest = int(np.argmax(gaps))
        gap = float(gaps[widest])
        text = f"{amount_text(gap)} px ({amount_text(MILLI * gap / scale)} mm)"
        text = f"less than {FINE:g} px" if 0.0 < gap < FINE else text
        words.append(f"widest gap {text}" + (f" of joint {rows['id'][widest]}" if gap >= FINE else ""))
    broken = rows["id"][rows["broken"]].tolist()
    if broken:
        named = ", ".join(map(str, broken[:MOST_NAMED])) + (" and others" if len(broken) > MOST_NAMED else "")
        words.append(f"{len(broken)} broken, removed after the step: {named}")
    elif np.isfinite(rows["break_force"]).any() or np.isfinite(rows["break_torque"]).any():
        words.append("none broken")
    return ", ".join(words) or "coordinates and speeds measured"
