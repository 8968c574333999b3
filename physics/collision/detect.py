"""The narrow phase as stages: where bodies stand before a solver pushes them, and what sensors see in the end."""

import numpy as np

from physics.broadphase.rectangles import cover_final_poses
from physics.collision.approach import measure_approach
from physics.collision.box_pairs import ALL, NO_SENSORS, SENSORS
from physics.collision.carry_over import carry_over, take_places
from physics.dynamics.sleepers import in_order
from physics.jit import kernel
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.tables.rows import joined
from physics.tables.step_state import StepState, stage

NOTHING, UNANCHORED, NO_ROWS = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR), np.zeros(0, np.int64)
PLACE = ("count", "normal_x", "normal_y", *(f"{name}_{k}" for k in (1, 2) for name in ("x", "y", "separation", "area")))
BIAS = 0.1  # of the slop: how much nearer another face must be to take over from the last one
GRAZE = 1.5  # slops that who slides by a side may overlap it: what rests on the floor beside it may be in it by one


def detect(state: StepState) -> np.ndarray:
    """Manifolds at the present poses, with how fast their sides approach; state.manifolds: those before.

    Where bodies are pushed sensors are left to `sense`, which sees them where they end.
    """
    slop = state.tolerances.slop
    narrow = state.workspace.narrow
    manifolds = narrow.collide(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows,
        slop,
        state.work,
        which=NO_SENSORS if state.effects.response else ALL,
        bias=BIAS * slop,
        previous=state.manifolds,
    )
    measure_approach(state.bodies, manifolds)
    return manifolds


def touch_where_they_are(state: StepState, met: np.ndarray) -> None:
    """Write points, normals and separations to manifolds that a sweep found, where it has put their bodies."""
    found = state.workspace.narrow.collide(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows[met["candidate"]],
        state.tolerances.slop,
        state.work,
        bias=BIAS * state.tolerances.slop,
    )
    pair = found["candidate"]
    alike = met["normal_x"][pair] * found["normal_x"] + met["normal_y"][pair] * found["normal_y"]
    # Where a pair touches in several places, what the sweep met is that with its normal.
    best = np.lexsort((-alike, pair))
    best = best[np.unique(pair[best], return_index=True)[1]]
    best = best[alike[best] > 0.0]
    for name in PLACE:
        met[name][pair[best]] = found[name][best]


@stage(
    "narrow_phase",
    reads=("effects", "tolerances", "bodies", "shapes", "library", "pairs", "manifolds", "workspace"),
    writes=("manifolds", "work", "workspace"),
)
def detect_ended(state: StepState) -> None:
    """Manifolds where the bodies ended."""
    state.manifolds = detect(state)


@stage(
    "narrow_phase",
    reads=("tolerances", "dt", "awake", "bodies", "shapes", "library", "pairs", "manifolds", "anchors", "workspace"),
    writes=("manifolds", "anchors", "work", "workspace"),
)
def detect_piles(state: StepState) -> None:
    """Manifolds where the step begins, up to the speculative distance, with the forces of the step before."""
    tolerances, previous, anchors = state.tolerances, state.manifolds, state.anchors
    if not len(state.awake.bodies):
        state.manifolds, state.anchors = NOTHING, UNANCHORED
        return
    places = state.library.tables, state.bodies, state.shapes
    news = state.workspace.narrow.update(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows,
        tolerances.speculative,
        state.work,
        BIAS * tolerances.slop,
        GRAZE * tolerances.slop,
        state.dt,
        previous,
        anchors,
        tolerances.recycle,
    )
    if news is None:
        return
    found, stale = news
    if not (len(found) or len(stale)):
        return
    kept = len(previous) - len(stale)
    other_manifolds, other_anchors = state.workspace.contacts_beside(previous, anchors, kept + len(found))
    if kept and take_places(*places, stale, found, other_anchors, previous, anchors):
        return
    count = carry_over(*places, previous, anchors, stale, found, other_manifolds, other_anchors)
    state.manifolds, state.anchors = other_manifolds[:count], other_anchors[:count]


@kernel
def is_any_sensor(
    # read
    pairs,
    shapes,
):
    """Whether a side of any of the pairs of shape rows is a sensor. O(pairs)."""
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
        *("effects", "stacks", "tolerances", "gravity", "dt"),  # of new motion rectangles
        "swept_sensors",
        "workspace",
    ),
    writes=(
        "sensed",
        "swept_sensors",
        "pairs",
        "broadphase",
        "work",
        "workspace",
        "library",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def sense(state: StepState) -> None:
    """Sensors see the final poses, and what a sweep met on the way."""
    bodies, shapes, swept = state.bodies, state.shapes, state.swept_sensors
    # Where the world has no sensor nothing is gone over; the kernels are those of every step, so that none is compiled
    # when the first sensor comes.
    asked = state.pairs.sensors > 0
    cover_final_poses(state, state.awake.shapes if asked else NO_ROWS)
    pairs = state.pairs.rows
    if not is_any_sensor(pairs if asked else pairs[:0], shapes) and not len(swept):
        state.sensed = NOTHING
        return
    sensed = state.workspace.sensing.collide(state.library, bodies, shapes, pairs, 0.0, state.work, which=SENSORS)
    if len(swept):
        known = sensed["shape_a"] << 32 | sensed["shape_b"]
        swept = swept[~np.isin(swept["shape_a"] << 32 | swept["shape_b"], known)]
        sensed = in_order(joined([sensed, swept]))
        state.swept_sensors = swept[:0]
    measure_approach(bodies, sensed)
    state.sensed = sensed
