"""Which candidates are looked at, and the pass over them that stops at AABBs."""

from physics.collision.manifold import add_point
from physics.dynamics.awake import is_active, wakes
from physics.jit import inlined, kernel, subkernel
from physics.tables.counters import SENSOR_TESTS

# The candidates that a narrow phase looks at: ALL; those without a sensor; of these, SOLIDS, those that a step can
# change; those with a sensor.
ALL, NO_SENSORS, SOLIDS, SENSORS = 0, 1, 2, 3


@inlined
def may_change(a, b):
    """Whether a step can change the contact of two bodies."""
    return is_active(a) or is_active(b) or wakes(a, b) or wakes(b, a)


@inlined
def is_wanted(which, a, b):
    """Whether two SHAPE rows are among those looked at, by which of them are sensors."""
    return which == ALL or (a.sensor or b.sensor) == (which == SENSORS)


@subkernel
def is_asked(which, bodies, a, b):
    """Whether two SHAPE rows are looked at, see ALL, and of the SOLIDS whether something can change them."""
    if not is_wanted(which, a, b):
        return False
    return which != SOLIDS or may_change(bodies[a.body_row], bodies[b.body_row])


@kernel
def collide_boxes(
    # read
    batch,
    which,
    # write
    manifolds_out,
    work_inout,
):
    """Contacts of candidates by their AABBs alone: normal along the axis of least overlap, point in its middle.

    which: see is_asked. Returns the number of contacts. O(candidates).
    """
    shapes = batch.shapes
    candidates = batch.candidates
    found = 0
    for i in range(batch.count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        if not is_asked(which, batch.bodies, a, b):
            continue
        if a.sensor or b.sensor:
            work_inout[SENSOR_TESTS] += 1
        right = a.max_x - b.min_x
        left = b.max_x - a.min_x
        down = a.max_y - b.min_y
        up = b.max_y - a.min_y
        least = min(min(right, left), min(down, up))
        if least < 0.0:
            continue
        nx = 0.0
        ny = -1.0
        if least == right:
            nx = 1.0
            ny = 0.0
        elif least == left:
            nx = -1.0
            ny = 0.0
        elif least == down:
            ny = 1.0
        x = 0.5 * (max(a.min_x, b.min_x) + min(a.max_x, b.max_x))
        y = 0.5 * (max(a.min_y, b.min_y) + min(a.max_y, b.max_y))
        found = add_point(shapes, candidates, i, found, nx, ny, x, y, -least, 0.0, 0, manifolds_out)
    return found
