"""Symmetries of two shapes: order, mirroring, translation, unit of length.

test_pair_agreement.py covers rotation and exchange; these tests cover the rest, for collide, distance and
time_of_impact.
"""

import math

import numpy as np
import pytest

from physics import Capsule, Circle, Polygon, Segment, collide, distance, mass_of, time_of_impact

KINDS = {
    "circle": lambda s, m: Circle(3.0 * s, (s * m, -0.5 * s)),
    "box": lambda s, m: Polygon.box(6.0 * s, 4.0 * s, (0.5 * s * m, 0.0)),
    "capsule": lambda s, m: Capsule((-3.0 * s * m, s), (2.0 * s * m, -s), 1.5 * s),
    "triangle": lambda s, m: Polygon([(-4.0 * s * m, 2.0 * s), (4.0 * s * m, 2.5 * s), (s * m, -4.0 * s)]),
    "rounded": lambda s, m: Polygon([(-3.0 * s * m, -2.0 * s), (3.0 * s * m, -2.0 * s), (2.0 * s * m, 2.0 * s)], s),
    "segment": lambda s, m: Segment((-4.0 * s * m, -s), (3.0 * s * m, 2.0 * s)),
}
pairs = pytest.mark.parametrize("a, b", [(a, b) for a in KINDS for b in KINDS])


def poses(seed, count=15):
    """Yield lists of four poses: start of A, end of A, start of B, end of B.

    About half of the pairs overlap at the start. Positions are multiples of 2^-20 px.
    """
    rng = np.random.default_rng(seed)
    for _ in range(count):
        x, y = rng.uniform(-40.0, 40.0, 2)
        dx, dy, vx, vy = rng.uniform((-9.0, -9.0, -25.0, -25.0), (9.0, 9.0, 25.0, 25.0))
        found = np.array([(x, y), (x, y), (x + dx, y + dy), (x + dx + vx, y + dy + vy)])
        angles = rng.uniform(-3.0, 3.0, 2)
        yield [
            (px, py, angle)
            for (px, py), angle in zip(
                (np.rint(found * 2**20) / 2**20).tolist(), angles.repeat(2).tolist(), strict=True
            )
        ]


def ask(a, b, at):
    """Return the results of collide, distance and time_of_impact for two shapes. at: start and end of A, then of B."""
    met, gap = collide(a, at[0], b, at[2]), distance(a, at[0], b, at[2])
    way = time_of_impact(a, at[0], at[1], b, at[2], at[3])
    return met, gap, way


@pairs
@pytest.mark.parametrize("exponent", [-20, -3, 20])
def test_another_unit_changes_no_bit(a, b, exponent):
    s = 2.0**exponent
    for at in poses(1, 6):
        one = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), at)
        two = ask(KINDS[a](s, 1), KINDS[b](s, 1), [(s * x, s * y, angle) for x, y, angle in at])
        assert two[0].normal == one[0].normal and (two[0].features == one[0].features).all()
        assert (two[0].points == s * one[0].points).all() and (two[0].separations == s * one[0].separations).all()
        assert (two[1].distance, two[1].normal) == (s * one[1].distance, one[1].normal)
        assert (two[1].point_a, two[1].point_b) == (one[1].point_a * s, one[1].point_b * s)
        assert (two[2].hit, two[2].fraction, two[2].normal) == (one[2].hit, one[2].fraction, one[2].normal)


@pairs
def test_moved_by_whole_numbers_far_out_all_is_the_same(a, b):
    """A pair moved 2^23 px away gives the same results, up to the digits lost there.

    Positions there still resolve 2^-20 px, so the moved pair is exactly the same.
    """
    x, y, left = 2.0**23, -(2.0**22), 2.0**-26
    for at in poses(2):
        one = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), at)
        two = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), [(x + u, y + v, angle) for u, v, angle in at])
        assert len(one[0]) == len(two[0]) and (one[0].features == two[0].features).all()
        assert two[0].normal == pytest.approx(one[0].normal, abs=left)
        assert np.allclose(two[0].points - (x, y), one[0].points, rtol=0.0, atol=left)
        assert np.allclose(two[0].separations, one[0].separations, rtol=0.0, atol=left)
        assert two[1].distance == pytest.approx(one[1].distance, abs=1e-13)
        assert two[1].normal == pytest.approx(one[1].normal, abs=1e-12)
        assert two[2].hit == one[2].hit and two[2].fraction == pytest.approx(one[2].fraction, abs=left)


@pairs
def test_mirrored_pairs_have_mirrored_answers(a, b):
    for at in poses(3):
        one = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), at)
        two = ask(KINDS[a](1.0, -1), KINDS[b](1.0, -1), [(-x, y, -angle) for x, y, angle in at])
        assert len(one[0]) == len(two[0])
        assert two[1].distance == pytest.approx(one[1].distance, abs=1e-13)
        if len(one[0]):
            assert two[0].normal == pytest.approx((-one[0].normal[0], one[0].normal[1]), abs=1e-12)
            there = sorted(map(tuple, two[0].points * (-1.0, 1.0)))
            assert np.allclose(sorted(map(tuple, one[0].points)), there, rtol=0.0, atol=1e-12)
            assert sorted(two[0].separations) == pytest.approx(sorted(one[0].separations), abs=1e-12)
        if one[1].distance > 0.0:
            assert two[1].normal == pytest.approx((-one[1].normal[0], one[1].normal[1]), abs=1e-12)
        assert two[2].hit == one[2].hit and two[2].fraction == pytest.approx(one[2].fraction, abs=1e-9)


@pairs
def test_contacts_turn_by_quarters_with_their_pair(a, b):
    """Contacts rotate with a pair that is rotated about the origin by a quarter turn.

    The positions are rotated exactly; only the angles are rounded.
    """
    for at in poses(4):
        one = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), at)
        two = ask(KINDS[a](1.0, 1), KINDS[b](1.0, 1), [(-y, x, angle + math.pi / 2) for x, y, angle in at])
        assert len(one[0]) == len(two[0])
        assert a == b or sorted(one[0].features) == sorted(two[0].features)  # of two alike the pose says which is first
        if len(one[0]):
            assert two[0].normal == pytest.approx((-one[0].normal[1], one[0].normal[0]), abs=1e-12)
            there = np.stack([two[0].points[:, 1], -two[0].points[:, 0]], axis=1)
            assert np.allclose(sorted(map(tuple, one[0].points)), sorted(map(tuple, there)), rtol=0.0, atol=1e-12)
        assert two[2].hit == one[2].hit and two[2].fraction == pytest.approx(one[2].fraction, abs=1e-9)


@pairs
def test_whoever_is_named_first_distance_is_the_same_to_the_bit(a, b):
    for at in poses(5):
        one = distance(KINDS[a](1.0, 1), at[0], KINDS[b](1.0, 1), at[2])
        two = distance(KINDS[b](1.0, 1), at[2], KINDS[a](1.0, 1), at[0])
        assert (two.distance, two.point_a, two.point_b) == (one.distance, one.point_b, one.point_a)
        assert two.normal == -one.normal


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "segment"])
def test_masses_mirror_and_scale(kind):
    """Scaling lengths by 2^5 scales mass by 2^10 and inertia by 2^20, to the bit; mirroring keeps both."""
    one, far, mirrored = (mass_of(KINDS[kind](s, m), 0.7) for s, m in ((1.0, 1), (32.0, 1), (1.0, -1)))
    assert (far.mass, far.center, far.inertia) == (one.mass * 2**10, one.center * 32.0, one.inertia * 2**20)
    assert (mirrored.mass, mirrored.inertia) == pytest.approx((one.mass, one.inertia), rel=1e-14)
    assert mirrored.center == pytest.approx((-one.center[0], one.center[1]), abs=1e-14)
