"""Targets of kinematic bodies: where they are to be at the end of the next step, and the velocity that leads there.

They are set between steps, aimed at when a step begins, by its length, and reached when it ends: to the bit.
"""

import numpy as np

from physics import checks
from physics.checks import Pair
from physics.dynamics import sleep
from physics.dynamics.integrate import refresh_centers
from physics.reshaping import check_grid_stands
from physics.tables.body import KINEMATIC
from physics.tables.rows import rows_of
from physics.world_state import WorldState


def set_target(world: WorldState, identity: int, position: Pair, angle: float | None) -> None:
    """Have a kinematic body arrive at a position [px] and an angle [rad] (None: as it is) at the end of the next step.
    Raises TypeError, ValueError."""
    world._unlocked()
    row = world._body_row(identity)
    x, y = checks.position("position", position)
    turned = float(row["angle"]) if angle is None else checks.number("angle", angle)
    if row["kind"] != KINEMATIC:
        raise ValueError(f"set_target needs a kinematic body; body {identity} is not (got {checks.shown(position)})")
    turn = turned - float(row["angle"])
    check_grid_stands(world._shapes_of[identity], turn, "the turn to angle")
    world._needs("rotation", f"set_target with angle {angle}", turn != 0.0)
    aimed = _velocities(world.bodies[[world._row_number(identity)]], np.array([(x, y, turned)]), world.dt)
    limit = world.tolerances.speed_limit
    if not np.abs(aimed[:, :2]).max() < limit:
        raise ValueError(f"position must be within {limit * world.dt:g} px of the body (got {checks.shown(position)})")
    row["vx"], row["vy"], row["angular_velocity"] = aimed[0]
    world._targets[identity] = (x, y, turned)
    if not row["awake"]:
        sleep.disturb(world, [identity])


def _velocities(bodies: np.ndarray, targets: np.ndarray, dt: float) -> np.ndarray:
    """(n, 3) velocity of the centre of mass and angular velocity that take BODY rows to poses (n, 3) in dt [s]."""
    cosine, sine = np.cos(targets[:, 2]), np.sin(targets[:, 2])
    x, y = bodies["local_center_x"], bodies["local_center_y"]
    return np.stack(
        [
            (targets[:, 0] + (cosine * x - sine * y) - bodies["center_x"]) / dt,
            (targets[:, 1] + (sine * x + cosine * y) - bodies["center_y"]) / dt,
            (targets[:, 2] - bodies["angle"]) / dt,
        ],
        axis=1,
    )


def _rows(world) -> tuple[np.ndarray, np.ndarray]:
    """Body rows that have a target, and the targets."""
    return rows_of(world.bodies, np.array([*world._targets], np.int64)), np.array([*world._targets.values()])


def aim(world: WorldState, dt: float) -> None:
    """Give the bodies with a target the velocity that takes them there in dt [s]; in no time nobody gets anywhere."""
    if not world._targets or dt == 0.0:
        return
    rows, targets = _rows(world)
    aimed = _velocities(world.bodies[rows], targets, dt)
    for k, name in enumerate(("vx", "vy", "angular_velocity")):
        world.bodies[name][rows] = aimed[:, k]


def arrive(world: WorldState, dt: float) -> None:
    """Put who had a target exactly there, at rest. What was quarantined on the way stays where it is."""
    if not world._targets or dt == 0.0:
        return
    rows, targets = _rows(world)
    bodies = world.bodies
    there = ~bodies["quarantined"][rows]
    rows, targets = rows[there], targets[there]
    for k, name in enumerate(("x", "y", "angle")):
        bodies[name][rows] = targets[:, k]
    for name in ("vx", "vy", "angular_velocity"):
        bodies[name][rows] = 0.0
    refresh_centers(rows, bodies)
    world._targets.clear()
