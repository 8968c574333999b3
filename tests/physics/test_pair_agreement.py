"""All queries of two shapes agree: overlap, depth, distance, contact and time of impact (invariants U7, U8, U10)."""

import math

import numpy as np
import pytest

from physics import (
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
    collide,
    distance,
    time_of_impact,
)

SOLID = np.array([[0, 1, 1, 0], [1, 1, 1, 1], [0, 1, 1, 1]], bool)
CONVEX = {
    "circle": Circle(3.0, (1, -0.5)),
    "box": Polygon.box(6, 4, (0.5, 0)),
    "capsule": Capsule((-3, 1), (2, -1), 1.5),
    "triangle": Polygon([(-4, 2), (4, 2.5), (1, -4)]),
    "rounded": Polygon([(-3, -2), (3, -2), (2, 2)], radius=1.0),
    "segment": Segment((-4, -1), (3, 2)),
    "sixteen": Polygon([(5 * math.cos(a), 3 * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 16, endpoint=False)]),
    "bounds": Bounds(Polygon.box(5, 3, angle=0.3)),
}
GROUNDS = {
    "chain": Chain([(-9, 3), (0, 2), (9, 4)]),
    "tiles": TileGrid(SOLID, 4.0),
    "mask": PixelMask(SOLID.repeat(3, 0).repeat(3, 1)),
}
PAIRS = [(a, b) for a in CONVEX for b in CONVEX]
STILL = (0.0, 0.0, 0.0)


def poses(seed, count, spread=9.0):
    """Yield random poses of two shapes: (pose of A, offset of B from A (2,), angle of B).

    About half of the pairs overlap.
    """
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield (
            tuple(rng.uniform(-40, 40, 2)) + (rng.uniform(-7, 7),),
            rng.uniform(-spread, spread, 2),
            rng.uniform(-7, 7),
        )


def pair_poses(seed, count):
    for pose, (dx, dy), angle in poses(seed, count):
        yield pose, (pose[0] + dx, pose[1] + dy, angle)


@pytest.mark.parametrize("a, b", PAIRS)
def test_all_answers_agree_whether_two_shapes_overlap(a, b):
    """collide, distance, depth and World.overlap agree on whether two shapes overlap."""
    world, hits = World(Effects(rotation=True)), 0
    one, two = (world.add_body(CONVEX[name], kind="kinematic") for name in (a, b))
    for pose_a, pose_b in pair_poses(1, 60):
        met, gap = collide(CONVEX[a], pose_a, CONVEX[b], pose_b), distance(CONVEX[a], pose_a, CONVEX[b], pose_b)
        if abs(gap.distance) < 1e-9:
            continue
        hits += gap.distance <= 0
        assert (len(met) > 0) == (gap.distance <= 0)
        assert math.hypot(*gap.normal) == pytest.approx(1.0, abs=1e-12)
        across = [p + gap.distance * n for p, n in zip(gap.point_a, gap.normal, strict=True)]
        assert gap.point_b == pytest.approx(across, abs=1e-9)
        if len(met) and "segment" not in (a, b):
            assert min(met.separations) == pytest.approx(gap.distance, abs=1e-9)
        one.move_to(pose_a[:2], pose_a[2])
        two.move_to(pose_b[:2], pose_b[2])
        world.step(0.0)
        assert ((world.contacts["separation"] <= 0).any()) == (gap.distance <= 0)
        assert [body.id for body in world.overlap(CONVEX[a], pose_a)] == ([0, 1] if gap.distance <= 0 else [0])
    assert 5 < hits < 55, "the poses test both"


@pytest.mark.parametrize("a, b", [(a, b) for a in CONVEX for b in [*CONVEX, *GROUNDS]])
def test_swapped_pair_is_mirrored(a, b):
    """Exchanging two shapes, ground included, negates the normal and keeps depths and points."""
    shapes = {**CONVEX, **GROUNDS}
    for pose_a, pose_b in pair_poses(2, 25):
        pose_b = pose_b[:2] + ((0.0,) if b in ("tiles",) else pose_b[2:])
        one, two = (
            collide(shapes[a], pose_a, shapes[b], pose_b, 0.5),
            collide(shapes[b], pose_b, shapes[a], pose_a, 0.5),
        )
        assert len(one) == len(two)
        if len(one):
            assert one.normal == pytest.approx([-n for n in two.normal], abs=1e-12)
            assert sorted(one.separations) == pytest.approx(sorted(two.separations), abs=1e-12)
            assert np.allclose(sorted(map(tuple, one.points)), sorted(map(tuple, two.points)), rtol=0.0, atol=1e-10)


def turned_by_quarters(pose, quarters):
    """Return a pose rotated about the origin by quarter turns, then moved by (8, -16)."""
    x, y = pose[:2]
    for _ in range(quarters):
        x, y = -y, x
    return (x + 8.0, y - 16.0, pose[2] + quarters * math.pi / 2)


@pytest.mark.parametrize("a, b", PAIRS)
def test_pair_turned_by_quarters_and_moved_is_the_same(a, b):
    """A pair rotated about the origin by 90, 180 or 270 degrees has the same gap, and its normal rotated likewise."""
    if "bounds" in (a, b):
        pytest.skip("the box of a turned shape is another box")
    for pose_a, pose_b in pair_poses(3, 12):
        first = distance(CONVEX[a], pose_a, CONVEX[b], pose_b)
        for quarters in (1, 2, 3):
            moved_a, moved_b = turned_by_quarters(pose_a, quarters), turned_by_quarters(pose_b, quarters)
            again = distance(CONVEX[a], moved_a, CONVEX[b], moved_b)
            assert again.distance == pytest.approx(first.distance, abs=1e-12 * 50)
            if first.distance > 1e-6:
                x, y = first.normal
                for _ in range(quarters):
                    x, y = -y, x
                assert again.normal == pytest.approx((x, y), abs=1e-9)


@pytest.mark.parametrize("a, b", PAIRS)
def test_time_of_impact_is_the_first_touch(a, b):
    """Two shapes touch at their time of impact, to 1e-9 of their size, and are separate before it.

    If no hit is reported, they stay separate on the whole path.
    """
    rng, hits = np.random.default_rng(4), 0
    for pose_a, pose_b in pair_poses(5, 40):
        turn = (0.0, 0.0) if "bounds" in (a, b) else rng.uniform(-2, 2, 2)
        end_a = tuple(np.add(pose_a, (*rng.uniform(-25, 25, 2), turn[0])))
        end_b = tuple(np.add(pose_b, (*rng.uniform(-25, 25, 2), turn[1])))
        if distance(CONVEX[a], pose_a, CONVEX[b], pose_b).distance < 0.01:
            continue
        found = time_of_impact(CONVEX[a], pose_a, end_a, CONVEX[b], pose_b, end_b)

        def gap(fraction, ways=((pose_a, end_a), (pose_b, end_b))):
            at = [tuple(p + fraction * (q - p) for p, q in zip(*ends, strict=True)) for ends in ways]
            return distance(CONVEX[a], at[0], CONVEX[b], at[1]).distance

        before = [gap(f) for f in np.linspace(0, found.fraction, 60)[:-1]]
        assert min(before) > -1e-8
        if found.hit:
            hits += 1
            assert abs(gap(found.fraction)) < 1e-8 and math.hypot(*found.normal) == pytest.approx(1.0, abs=1e-12)
        else:
            assert found.fraction == 1.0 and found.point is None and found.normal is None
    assert hits > 3


def test_times_of_impact_in_closed_form():
    still = (0.0, 0.0, 0.0)
    disc = time_of_impact(Circle(0.5), still, still, Circle(0.1), (-3.0, 0.3, 0.0), (197.0, 0.3, 0.0))
    assert disc.hit and disc.fraction == pytest.approx(0.012401923788647, abs=1e-12)
    disc = time_of_impact(Circle(0.5), still, (10.0, 0.0, 0.0), Circle(0.5), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0))
    assert disc.fraction == pytest.approx(0.9, abs=1e-12) and disc.normal == pytest.approx((1.0, 0.0), abs=1e-12)
    corner = time_of_impact(Circle(1.0), (2.0, 2.0, 0.0), (0.5, 0.5, 0.0), Polygon.box(2, 2), still, still)
    assert corner.fraction == pytest.approx((math.sqrt(2) - 1) / (1.5 * math.sqrt(2)), abs=1e-12)
    box = time_of_impact(Polygon.box(2, 2), STILL, STILL, Segment((0, -1), (0, 1)), (2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert box.fraction == pytest.approx(0.5, abs=1e-9)
    for first in (True, False):
        pairs = [(Circle(0.5), STILL, (1.0, 0.0, 0.0)), (Segment((1 - 1e-16, -2), (1, 2)), STILL, STILL)]
        found = time_of_impact(*pairs[0], *pairs[1]) if first else time_of_impact(*pairs[1], *pairs[0])
        assert found.fraction == pytest.approx(0.5, abs=1e-9)


def test_impact_of_touching_shapes_is_now_when_they_approach_and_later_when_they_part():
    box = Polygon.box(2, 2)
    assert time_of_impact(box, STILL, STILL, box, (2.0, 0, 0), (0.0, 0, 0)).fraction == 0.0
    gone = time_of_impact(box, STILL, STILL, box, (2.0, 0, 0), (5.0, 0, 0))
    assert (gone.hit, gone.fraction, gone.point, gone.normal) == (False, 1.0, None, None)


@pytest.mark.parametrize("exponent", range(-15, 0))
@pytest.mark.parametrize("shapes", [("box", "box"), ("box", "circle"), ("sixteen", "triangle"), ("capsule", "rounded")])
def test_gap_is_told_to_the_last_digits_on_both_sides_of_touching(shapes, exponent):
    """Gaps and overlaps of 10^-15 to 10^-1 are exact within 1e-12 of the size, with the correct sign
    (docs/stability.md, C9).
    """
    a, b = (CONVEX[name] for name in shapes)
    start = time_of_impact(a, STILL, STILL, b, (40.0, 0.3, 0.4), (-40.0, 0.3, 0.4))
    touch = 40.0 - 80.0 * start.fraction
    slope = start.normal[0]
    for sign in (1, -1):
        step = sign * 10.0**exponent
        found = distance(a, STILL, b, (touch + step / slope, 0.3, 0.4))
        assert found.distance == pytest.approx(step, abs=2e-9 + 1e-3 * abs(step))
        assert (len(collide(a, STILL, b, (touch + step / slope, 0.3, 0.4))) > 0) == (found.distance <= 0)
