"""Time of impact: closed forms, rotating bodies compared with dense sampling, and starts in contact."""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Capsule, Chain, Circle, PixelMask, Polygon, Segment, TileGrid, distance, time_of_impact
from physics.ccd.rotational import Sweep, new_rotational_workspace, sweep_rotational
from physics.ccd.time_of_impact import advance, new_advance_workspace, separate_at
from physics.jit import kernel
from physics.shapes.library import Library, rounding_of
from physics.tables.body import BODY
from physics.tables.shape import SHAPE
from physics.tables.step_state import CAP_HITS, COUNTERS, GJK_ITERATIONS
from tests.oracles import hulls

ORIGIN = (0.0, 0.0, 0.0)
BOX = Polygon.box(2, 2)


def missed(found):
    return (found.hit, found.fraction, found.point, found.normal) == (False, 1.0, None, None)


def test_two_discs_in_closed_form():
    """Two discs hit at the closed-form time to 1e-12; exchanged shapes give the opposite normal."""
    found = time_of_impact(Circle(0.3), (-3, 0.3, 0), (197, 0.3, 0), Circle(0.3), ORIGIN, ORIGIN)
    assert found.hit and found.fraction == pytest.approx(0.012401923788647, abs=1e-14)
    assert found.normal == pytest.approx((math.sqrt(0.75), -0.5)) and found.point == pytest.approx(
        (-0.3 * math.sqrt(0.75), 0.15)
    )
    turned = time_of_impact(Circle(0.3), ORIGIN, ORIGIN, Circle(0.3), (-3, 0.3, 0), (197, 0.3, 0))
    assert turned.fraction == found.fraction and turned.normal == (-found.normal[0], -found.normal[1])
    assert time_of_impact(Circle(0.5), ORIGIN, ORIGIN, Circle(0.5), (10, 0, 0), (0, 0, 0)).fraction == pytest.approx(
        0.9, abs=1e-15
    )


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_disc_to_the_corner_of_a_box(angle):
    c, s = math.cos(angle), math.sin(angle)
    start, end = ((c * p - s * p, s * p + c * p, 0.0) for p in (2.0, 0.5))
    found = time_of_impact(Circle(1.0), start, end, BOX, (0, 0, angle), (0, 0, angle))
    assert found.fraction == pytest.approx((math.sqrt(2) - 1) / (1.5 * math.sqrt(2)), abs=1e-12)


def test_box_and_segment():
    """A box that moves onto a segment hits it exactly at fraction 0.5 (docs/stability.md, G20).

    The slop is not subtracted from the distance.
    """
    found = time_of_impact(BOX, ORIGIN, ORIGIN, Segment((0, -1), (0, 1)), (2, 0, 0), ORIGIN)
    assert found.fraction == pytest.approx(0.5, abs=1e-12) and found.normal == (1.0, 0.0) and found.point[0] == 1.0


@pytest.mark.parametrize("swap", [False, True])
def test_disc_at_a_segment_that_was_turned_by_rounding(swap):
    """A disc hits a segment at fraction 0.5, although the segment's end points have rounding errors.

    The errors come from its rotation by -pi/2 (docs/stability.md, C17).
    """
    upright = (1, 0, -math.pi / 2)
    disc, wall = (Circle(0.5), ORIGIN, (1, 0, 0)), (Segment((-1, 0), (1, 0)), upright, upright)
    found = time_of_impact(*(wall + disc if swap else disc + wall))
    assert found.hit and found.fraction == pytest.approx(0.5, abs=1e-9)
    assert found.normal[0] == pytest.approx(-1.0 if swap else 1.0)


@pytest.mark.parametrize("half", [2e-4, 1e-5])
def test_point_like_disc_past_a_short_edge(half):
    """A tiny disc that passes a short edge misses it or hits it with a unit normal (docs/stability.md, C2)."""
    edge = Polygon.box(1.0, 2 * half)
    found = time_of_impact(Circle(1e-9), (0.506, 0.0035, 0), (0.496, -0.4965, 0), edge, ORIGIN, ORIGIN)
    assert not found.hit or math.hypot(*found.normal) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("gap", [0.0, -0.5])
@pytest.mark.parametrize(
    "move, hit", [((1, 0), True), ((-1, 0), False), ((0, 5), False), ((0, 0), False), ((1e-9, 3), True)]
)
@pytest.mark.parametrize(
    "shapes", [(BOX, BOX), (Circle(1), Circle(1)), (BOX, Circle(1)), (Capsule((0, -1), (0, 1), 1), BOX)]
)
def test_touching_at_the_start_counts_when_it_approaches(shapes, move, hit, gap):
    """Shapes that touch or overlap at the start hit at 0 if they approach, and miss if they separate, slide or rest
    (docs/stability.md, C16).
    """
    if move == (0, 5) and gap < 0.0 and shapes[1] == Circle(1) and shapes[0] == Circle(1):
        return  # overlapping discs that pass each other part at once
    found = time_of_impact(shapes[0], ORIGIN, (*move, 0), shapes[1], (2 + gap, 0, 0), (2 + gap, 0, 0))
    assert found.fraction == 0.0 and found.hit and found.normal == pytest.approx((1, 0)) if hit else missed(found)


def test_what_leaves_and_comes_back_by_turning_is_met_then():
    rod = Polygon.box(20, 1)
    found = time_of_impact(rod, ORIGIN, (0, 0, 2 * math.pi), Circle(1.0), (8.0, -1.5, 0), (8.0, -1.5, 0))
    assert found.hit and 0.4 < found.fraction < 0.5, "the other end of the rod comes round after half a turn"
    late = found.fraction * 2 * math.pi
    assert distance(rod, (0, 0, late), Circle(1.0), (8.0, -1.5, 0)).distance == pytest.approx(0.0, abs=1e-9)


def test_grazing_tangent_and_a_hair_beside():
    """A grazing touch is a hit; shapes that pass 1e-9 apart miss (docs/stability.md, C16)."""
    assert time_of_impact(Circle(1), (-5, 2, 0), (5, 2, 0), Circle(1), ORIGIN, ORIGIN).fraction == pytest.approx(0.5)
    assert missed(time_of_impact(Circle(1), (-5, 2 + 1e-9, 0), (5, 2 + 1e-9, 0), Circle(1), ORIGIN, ORIGIN))
    assert missed(time_of_impact(BOX, (-5, 2 + 1e-9, 0), (5, 2 + 1e-9, 0), BOX, ORIGIN, ORIGIN))
    assert time_of_impact(BOX, (-5, 2, 0), (5, 2, 0), BOX, ORIGIN, ORIGIN).fraction == pytest.approx(0.3)


def test_ends_exactly_at_the_touch_or_one_step_short():
    assert time_of_impact(BOX, ORIGIN, (3, 0, 0), BOX, (5, 0, 0), (5, 0, 0)).fraction == 1.0
    assert missed(time_of_impact(BOX, ORIGIN, (3 - 1e-9, 0, 0), BOX, (5, 0, 0), (5, 0, 0)))


def random_motion(rng):
    return np.array([*rng.uniform(-6, 6, 2), rng.uniform(-3, 3), *rng.uniform(-8, 8, 2), rng.uniform(-9, 9)])


@pytest.mark.parametrize("seed", range(3))
def test_turning_hulls_meet_where_dense_sampling_sees_it(seed):
    """Rotating hulls hit at separation 0, never later than the first overlapping sample of a dense sampling."""
    rng, room, hits = np.random.default_rng(seed), new_advance_workspace(), 0
    for _ in range(120 if JIT else 8):
        outlines = [
            hulls.random_outline(rng, rng.integers(1, 10), 10.0 ** -rng.uniform(0, 3), rng.uniform(0.5, 3))
            for _ in "ab"
        ]
        radii = [float(rng.choice([0.0, 0.3])) for _ in "ab"]
        room.motion_a[:], room.motion_b[:] = random_motion(rng), random_motion(rng)
        for local, outline in zip((room.local_a, room.local_b), outlines, strict=True):
            local[: len(outline)] = outline
        counts = (len(outlines[0]), radii[0], len(outlines[1]), radii[1])
        samples = np.array([separate_at(*counts, t, room) for t in np.linspace(0, 1, 1001 if JIT else 101)])
        if samples[0] <= 0.0:
            continue
        room.totals[:] = 0.0
        fraction = advance(*counts, room)
        assert room.totals[1] == 0, "no cap was hit"
        if (samples <= 0.0).any():
            hits += 1
            assert fraction <= np.argmax(samples <= 0.0) / (len(samples) - 1) + 1e-12
        if fraction <= 1.0:
            assert abs(separate_at(*counts, fraction, room)) <= 1e-9 * 30
            assert (samples[: int(fraction * (len(samples) - 1))] > 0.0).all()
        else:
            assert samples.min() > 0.0
    assert hits > 8 or not JIT


KINDS = {
    "circle": Circle(4.0, (3.0, 1.0)),
    "capsule": Capsule((-6, 0), (5, 2), 2.0),
    "polygon": Polygon([(-7, -2), (6, -4), (3, 5)]),
    "rounded": Polygon([(-7, -2), (6, -4), (3, 5)], 1.5),
    "segment": Segment((-8, 0), (7, 3)),
    "mask": PixelMask.from_array(np.array([[1, 1, 1, 0], [0, 1, 0, 0], [1, 1, 1, 1]], bool)),
    "bounds": Bounds(Polygon.box(9, 3)),
    "tiles": TileGrid(np.array([[1, 0, 1], [1, 1, 0]], bool), 6.0),
    "chain": Chain([(-9, 0), (-2, -3), (4, 1), (10, 0)]),
}


@pytest.mark.parametrize("kind_a", sorted(KINDS))
@pytest.mark.parametrize("kind_b", sorted(KINDS))
def test_every_pair_of_kinds_meets_at_distance_nothing_and_mirrors(kind_a, kind_b):
    rng = np.random.default_rng([sorted(KINDS).index(kind_a), sorted(KINDS).index(kind_b)])
    a, b, hits = KINDS[kind_a], KINDS[kind_b], 0
    for _ in range(6 if JIT else 2):
        # Whole angles for what is measured on the pixel grid, none for tiles.
        turns = [0.0 if {kind} & {"tiles", "mask"} else float(rng.uniform(-2, 2)) for kind in (kind_a, kind_b)]
        start_a, start_b = (-30.0, float(rng.uniform(-8, 8)), 0.0), (30.0, float(rng.uniform(-8, 8)), 0.0)
        end_a, end_b = (30.0, 0.0, turns[0]), (-30.0, 0.0, turns[1])
        found = time_of_impact(a, start_a, end_a, b, start_b, end_b)
        turned = time_of_impact(b, start_b, end_b, a, start_a, end_a)
        assert found.hit == turned.hit and found.fraction == turned.fraction and found.point == turned.point
        if not found.hit:
            continue
        hits += 1
        assert turned.normal == (0.0 - found.normal[0], 0.0 - found.normal[1]) and math.hypot(
            *found.normal
        ) == pytest.approx(1.0)
        if "mask" not in (kind_a, kind_b):
            poses = [
                tuple(p + found.fraction * (q - p) for p, q in zip(*each, strict=True))
                for each in ((start_a, end_a), (start_b, end_b))
            ]
            between = distance(a, poses[0], b, poses[1]).distance
            # What came through a chain from behind may still be in one link when it meets the front of the next.
            assert between <= 1e-8 and (between >= -1e-8 or "chain" in (kind_a, kind_b))
            before = [
                tuple(p + max(0.0, found.fraction - 1e-3) * (q - p) for p, q in zip(*each, strict=True))
                for each in ((start_a, end_a), (start_b, end_b))
            ]
            assert distance(a, before[0], b, before[1]).distance > 0.0 or "chain" in (kind_a, kind_b)
    assert hits == 0 if {kind_a, kind_b} <= {"tiles", "chain"} else hits > 0 or "chain" in (kind_a, kind_b)


def test_tiles_have_no_seams_and_chains_no_back():
    tiles, box = TileGrid(np.ones((2, 20), bool), 16.0), Polygon.box(10, 10)
    assert missed(time_of_impact(box, (20, -5, 0), (250, -5, 0), tiles, ORIGIN, ORIGIN)), "slides over the seams"
    assert time_of_impact(box, (20, -40, 0), (250, 60, 0), tiles, ORIGIN, ORIGIN).fraction == pytest.approx(0.35)
    floor = Chain([(0, 0), (50, 0), (100, 0)])
    assert missed(time_of_impact(box, (10, -5, 0), (90, -5, 0), floor, ORIGIN, ORIGIN))
    assert missed(time_of_impact(box, (50, 40, 0), (50, -60, 0), floor, ORIGIN, ORIGIN))
    assert time_of_impact(box, (50, -40, 0), (50, 60, 0), floor, ORIGIN, ORIGIN).fraction == pytest.approx(0.35)
    shelf = TileGrid(np.zeros((1, 3), bool), 16.0, one_way=np.ones((1, 3), bool))
    assert time_of_impact(box, (24, -20, 0), (24, 40, 0), shelf, ORIGIN, ORIGIN).fraction == pytest.approx(0.25)
    assert missed(time_of_impact(box, (24, 40, 0), (24, -40, 0), shelf, ORIGIN, ORIGIN))


def test_bounds_that_grow_as_they_turn():
    """A rotating Bounds hits when its AABB, which reaches cos t + sin t at angle t, touches a circle."""
    wanted = math.asin(1.2**2 - 1.0) / 2.0
    found = time_of_impact(Bounds(BOX), ORIGIN, (0, 0, math.pi / 4), Circle(0.2), (1.4, 0, 0), (1.4, 0, 0))
    assert found.fraction == pytest.approx(wanted / (math.pi / 4), abs=1e-8)


@kernel
def sweep(sweep_inout):
    """Compute the time of impact of row 0 against row 1."""
    return sweep_rotational(0, 1, sweep_inout.slack, -1, sweep_inout)


def swept(mover, motion, other, slack=0.16, motion_b=(0.0,) * 6):
    """Return (fraction, normal x, normal y, id of the tile or link) of the first impact in the sweep of a world.

    motion: (x, y, angle) of the mover at the start, then at the end, in one tuple. motion_b: the same of the other
    shape.
    """
    library, bodies, shapes, work = Library(), np.zeros(2, BODY), np.zeros(2, SHAPE), np.zeros(len(COUNTERS), np.int64)
    for row, shape in enumerate((mover, other)):
        s = shapes[row : row + 1]
        s["kind"], s["geometry"], s["wrapped"] = library.add(shape)
        s["radius"], s["local_x"], s["local_y"] = rounding_of(shape)
        s["body_row"] = row
    bodies["min_half_extent"] = mover.min_half_extent
    motions, pairs, room = (
        np.array([motion, motion_b], np.float64),
        np.zeros((1, 2), np.int64),
        new_rotational_workspace(),
    )
    fast, tables = np.zeros(2, bool), library.tables
    found = sweep(Sweep(tables, bodies, shapes, pairs, False, True, slack, False, motions, fast, motions, room, work))
    assert work[CAP_HITS] == 0 and work[GJK_ITERATIONS] >= 0
    return found


TILES = TileGrid(np.ones((2, 40), bool), 16.0)
FLOOR = Chain([(16.0 * k, 0.0) for k in range(41)])


@pytest.mark.parametrize("ground", [TILES, FLOOR], ids=["tiles", "chain"])
@pytest.mark.parametrize(
    "mover",
    [
        Polygon.box(10, 10),
        Circle(5.0),
        Capsule((0, -2), (0, 2), 3.0),
        Polygon([(-4, -4), (4, -4), (4, 4), (-4, 4)], 1.0),
    ],
    ids=["box", "circle", "capsule", "rounded"],
)
@pytest.mark.parametrize("sunk", [-0.1, 0.0, 0.1])
def test_what_slides_on_the_ground_is_not_held_by_it(mover, ground, sunk):
    """A body that slides along ground in pieces is not stopped by a seam (docs/stability.md, G5, E4).

    It touches the ground, or overlaps it by less than the slop.
    """
    for end in (90.0, 600.0):
        assert swept(mover, (20, -5 + sunk, 0, end, -5 + sunk, 0), ground)[0] > 1.0
        assert swept(mover, (20, -5 + sunk, 0, end, -5 + sunk + 0.05, 0), ground)[0] > 1.0


@pytest.mark.parametrize("ground", [TILES, FLOOR], ids=["tiles", "chain"])
@pytest.mark.parametrize("angle", [0.0, 1.0, 20.0])
def test_what_rests_on_the_ground_does_not_go_through_it(ground, angle):
    """A body that rests on the ground and is thrown into it at any slant is stopped (docs/stability.md, E9).

    It is stopped before its centre is below the surface.
    """
    box = Polygon.box(10, 10)
    for x in (20.0, 40.0, 90.0, 300.0):
        fraction, nx, ny, _ = swept(box, (20, -5, 0, x, 120, angle), ground)
        # The normal is that of the moment when it is a slop deep: it has turned a little.
        assert fraction <= 1.0 and (nx + 0.0, ny) == pytest.approx((0, -1), abs=1e-9 + 0.005 * angle)
        assert -5 + fraction * 125 <= 0.0


def test_rod_that_turns_fast_meets_a_ball_and_a_wall():
    rod = Polygon.box(100, 2)
    fraction, nx, ny, _ = swept(rod, (0, -60, 0, 0, -60, math.pi), Circle(5.0), motion_b=(30, -30, 0, 30, -30, 0))
    assert 0.1 < fraction < 0.3 and math.hypot(nx, ny) == pytest.approx(1.0)
    fraction = swept(rod, (-60, 0, 0, 300, 0, 12.0), Segment((0, -200), (0, 200)))[0]
    assert 0.0 < fraction < 60 / 360
    assert swept(rod, (-60, 0, 0, -60, 0, 12.0), Segment((0, -200), (0, 200)))[0] > 1.0


def test_fast_thin_rods_never_pass_a_thin_wall():
    rng, wall = np.random.default_rng(3), Segment((0, -1000), (0, 1000))
    for _ in range(200 if JIT else 10):
        rod = Polygon.box(float(rng.uniform(4, 60)), float(rng.uniform(0.5, 3)))
        start = (-rng.uniform(40, 90), rng.uniform(-50, 50), rng.uniform(-3, 3))
        end = (rng.uniform(40, 900), rng.uniform(-50, 50), start[2] + rng.uniform(-20, 20))
        fraction, nx, _, _ = swept(rod, (*start, *end), wall, slack=0.0)
        assert fraction < 1.0 and nx < -0.999
        assert start[0] + fraction * (end[0] - start[0]) < 0.0, "its centre stays in front"


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match="end_b"):
        time_of_impact(BOX, ORIGIN, ORIGIN, TileGrid(np.ones((1, 1), bool), 4.0), ORIGIN, (0, 0, 1.0))
    with pytest.raises(TypeError, match="shape_a"):
        time_of_impact("ball", ORIGIN, ORIGIN, BOX, ORIGIN, ORIGIN)
    with pytest.raises(ValueError, match="start_a"):
        time_of_impact(BOX, (0, math.inf, 0), ORIGIN, BOX, ORIGIN, ORIGIN)
