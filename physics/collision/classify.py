"""Which kind of pair each candidate is, and which of them a pass looks at."""

from physics.collision.ahead import reach_of
from physics.collision.approach import most_nearing, nearing
from physics.collision.box_pairs import NO_SENSORS, SENSORS, SOLIDS, is_wanted, may_change
from physics.collision.manifold import (
    CHAIN_ANY,
    CIRCLES,
    GRID_ANY,
    MASK_CIRCLE,
    MASK_HULL_EXACT,
    MASK_POLYGON,
    MASKS,
    MASKS_EXACT,
    NOTHING,
    POLYGON_CIRCLE,
    POLYGONS,
    SURFACE_ANY,
)
from physics.jit import inlined, kernel
from physics.shapes.placement import drawn_beyond, is_drawn_when_asked
from physics.tables.counters import NARROW_TESTS, SENSOR_TESTS
from physics.tables.shape import CHAIN, CIRCLE, MASK, PART, TILES

# Behind the kinds of pairs: where it is counted how many are of parts, and of masks that are drawn for the test.
PARTED, DRAWN_PAIRS = NOTHING + 1, NOTHING + 2


@inlined
def kind_of_pair(low, high):
    """The kind of pair of two shape kinds, the lower first."""
    if low == CIRCLE and high == CIRCLE:
        return CIRCLES
    # Grids and chains carry, and are never moved by what they meet.
    if high == CHAIN:
        return CHAIN_ANY if low != TILES and low != CHAIN else NOTHING
    if high == TILES or low == TILES:
        return GRID_ANY if low != high else NOTHING
    if low == MASK and high == MASK:
        return MASKS
    if low == MASK or high == MASK:
        return MASK_CIRCLE if low == CIRCLE else MASK_POLYGON
    return POLYGON_CIRCLE if low == CIRCLE else POLYGONS


@inlined
def as_snapped(kind, a, b):
    """The kind of pair of two SHAPE rows, when `kind` is that of their kinds: two snapped masks are met as drawn, and a
    snapped mask by a hull; a mask that is not snapped is met at its exact pose. A chain that is a mask's part is its
    surface."""
    if kind == CHAIN_ANY:
        chain = a if a.kind == CHAIN else b
        return SURFACE_ANY if chain.role == PART else kind
    if kind == MASKS:
        return kind if a.snap and b.snap else MASKS_EXACT
    if kind == MASK_CIRCLE or kind == MASK_POLYGON:
        return kind if a.snap or b.snap else MASK_HULL_EXACT
    return kind


@inlined
def boxes_apart(a, b, margin):
    """Whether the boxes of two SHAPE rows are further apart than a margin [px]."""
    return (
        a.min_x - margin > b.max_x
        or b.min_x - margin > a.max_x
        or a.min_y - margin > b.max_y
        or b.min_y - margin > a.max_y
    )


@inlined
def kind_asked(bodies, a, b, margin, ahead, which):
    """The kind of a candidate pair of SHAPE rows, NOTHING if this pass does not look at it. which: see classify."""
    if not is_wanted(which, a, b):
        return NOTHING
    kind = as_snapped(kind_of_pair(min(a.kind, b.kind), max(a.kind, b.kind)), a, b)
    if kind == NOTHING or which <= NO_SENSORS:
        return kind
    if which == SENSORS:
        margin += drawn_beyond(bodies[a.body_row], a) + drawn_beyond(bodies[b.body_row], b)
    if boxes_apart(a, b, margin):
        if ahead <= 0.0 or kind > POLYGONS:
            return NOTHING
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        if ahead * most_nearing(p, q) <= margin:
            return NOTHING
        _, _, speed = nearing(p, q)
        if boxes_apart(a, b, reach_of(p, q, speed, margin, ahead)):
            return NOTHING
    if which == SOLIDS and not may_change(bodies[a.body_row], bodies[b.body_row]):
        return NOTHING
    return kind


@inlined
def is_of_part(a, b):
    """Whether a side of a pair of SHAPE rows is a part of another shape."""
    return a.owner != a.id or b.owner != b.id


@kernel
def classify(
    # read
    bodies,
    shapes,
    candidates,
    count,
    margin,
    ahead,
    which,
    # write
    kind_out,
    counts_out,
    work_inout,
):
    """Write the kind of every candidate pair and how many there are of each. O(candidates).

    counts_out[PARTED]: in how many a side is a part of another shape; counts_out[DRAWN_PAIRS]: in how many a side is
    drawn for the test. which: ALL, or what has NO_SENSORS, or only the SOLIDS of pairs that something can change and
    whose boxes are within `margin` [px], or meet within `ahead` [s], or only the SENSORS. The others are NOTHING.
    """
    for i in range(len(counts_out)):
        counts_out[i] = 0
    sensors = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        kind = kind_asked(bodies, a, b, margin, ahead, which)
        kind_out[i] = kind
        counts_out[kind] += 1
        if kind != NOTHING:
            counts_out[PARTED] += int(is_of_part(a, b))
            counts_out[DRAWN_PAIRS] += int(is_drawn_when_asked(a) or is_drawn_when_asked(b))
            sensors += int(a.sensor or b.sensor)
    work_inout[NARROW_TESTS] += count - counts_out[NOTHING]
    work_inout[SENSOR_TESTS] += sensors
