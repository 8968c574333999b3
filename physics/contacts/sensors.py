"""Sensors: overlaps at the final poses of a step, in worlds that respond."""

import numpy as np

from physics.broadphase.proxies import cover_final_poses
from physics.collision.hull_pairs import measure_approach
from physics.collision.narrow_phase import SENSORS
from physics.islands.sleep import in_order
from physics.jit import kernel
from physics.shapes.placement import PLACED
from physics.tables.contact import CONTACT
from physics.tables.step_state import StepState, stage
from physics.tables.table import joined

NO_CONTACTS, NO_ROWS = np.zeros(0, CONTACT), np.zeros(0, np.int64)


@kernel
def is_any_sensor(pairs, shapes):
    """Return whether a side of any of the pairs of shape rows is a sensor. O(pairs)."""
    for i in range(len(pairs)):
        if shapes[pairs[i, 0]].sensor or shapes[pairs[i, 1]].sensor:
            return True
    return False


@stage(
    "sensors",
    reads=(
        "awake",
        "bodies",
        "shapes",
        "library",
        "pairs",
        "broadphase",
        *("effects", "stacks", "tolerances", "gravity", "dt"),  # for new swept AABBs
        "swept_sensors",
        "workspace",
    ),
    writes=("sensed", "swept_sensors", "pairs", "broadphase", "work", "workspace", "library", *PLACED),
)
def sense(state: StepState) -> None:
    """Detect sensor overlaps at the final poses, and add those of the sweeps."""
    bodies, shapes, swept = state.bodies, state.shapes, state.swept_sensors
    # Without sensors the loops are empty. The kernels are those of every step, so none is compiled when the first
    # sensor is added.
    asked = state.pairs.sensors > 0
    cover_final_poses(state, state.awake.shapes if asked else NO_ROWS)
    pairs = state.pairs.rows
    if not is_any_sensor(pairs if asked else pairs[:0], shapes) and not len(swept):
        state.sensed = NO_CONTACTS
        return
    sensed = state.workspace.sensing.collide(state.library, bodies, shapes, pairs, 0.0, state.work, which=SENSORS)
    if len(swept):
        known = sensed["shape_a"] << 32 | sensed["shape_b"]
        swept = swept[~np.isin(swept["shape_a"] << 32 | swept["shape_b"], known)]
        sensed = in_order(joined([sensed, swept]))
        state.swept_sensors = swept[:0]
    measure_approach(bodies, sensed)
    state.sensed = sensed
