"""Shapes a hair from touching, told apart by arithmetic without rounding (hard_cases B9, B10, C9).

A sign that flickers by one rounding begins and ends contacts; one that is wrong lets a needle through.
"""

import math

import numpy as np
import pytest

from physics import JIT, Polygon, collide, distance
from tests.oracles.exact_gaps import gaps_on_a_lattice, sign_of_gap

STILL = (0.0, 0.0, 0.0)
HAIR = 1e-12  # of the size
BOX = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)]
KITE = [(-4.0, 0.0), (0.0, -3.0), (4.0, 0.0), (0.0, 5.0)]
SIXTEEN = [(6.0 * math.cos(k * math.pi / 8.0), 5.0 * math.sin(k * math.pi / 8.0)) for k in range(16)]
MEETINGS = {  # two outlines, where the second touches the first, and the way that parts them
    "corner at corner": (BOX, BOX, (8.0, 6.0), (1.0, 1.0)),
    "edge on edge": (BOX, BOX, (8.0, 1.25), (1.0, 0.0)),
    "edge on edge, ends alike": (BOX, BOX, (0.0, 6.0), (0.0, 1.0)),
    "corner at edge": (BOX, KITE, (8.0, 1.0), (1.0, 0.0)),
    "corner at slanted edge": (KITE, BOX, (6.0, -4.5), (3.0, -4.0)),
    "corner at corner of kites": (KITE, KITE, (8.0, 0.0), (1.0, 0.0)),
    "slanted edge on edge": (KITE, KITE[::-1], (4.0, 5.0), (5.0, 4.0)),
    "many corners at an edge": (SIXTEEN, BOX, (10.0, 0.5), (1.0, 0.0)),
    "needle at a box": (BOX, [(0.0, -2.0), (2e4, -1.0), (2e4, 3.0)], (4.0, 1.0), (1.0, 0.0)),
}


def moved(corners, way, by):
    """Corners moved along a way by a length, as floats."""
    along = by / math.hypot(*way)
    return [(x + along * way[0], y + along * way[1]) for x, y in corners]


def told(a, b):
    """The sign of the distance, and whether collide has found a contact; both must say the same."""
    a, b = Polygon(a), Polygon(b)
    gap = distance(a, STILL, b, STILL).distance
    assert (gap <= 0.0) == (len(collide(a, STILL, b, STILL)) > 0)
    assert (distance(b, STILL, a, STILL).distance <= 0.0) == (gap <= 0.0)
    return (gap > 0.0) - (gap < 0.0)


@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 3.7, 2.0**20])
@pytest.mark.parametrize("name", MEETINGS)
def test_a_hair_apart_is_apart_and_a_hair_inside_overlaps(name, scale):
    """Gaps and overlaps of 1e-12 to 1e-1 of the size: the sign is that of the rationals. In between it changes once."""
    a, b, place, way = MEETINGS[name]
    size = scale * max(math.hypot(x, y) for corners in (a, b) for x, y in corners)
    a = [(scale * x, scale * y) for x, y in a]
    b = [(scale * (x + place[0]), scale * (y + place[1])) for x, y in b]
    for exponent in range(1, 13):
        for sign in (1, -1):
            near = moved(b, way, sign * size * 10.0**-exponent)
            assert sign_of_gap(a, near) == sign and told(a, near) == sign, (exponent, sign)
    steps = [told(a, moved(b, way, k * size * HAIR / 64.0)) for k in range(-64, 65)]
    assert sum(one != two for one, two in zip(steps, steps[1:], strict=False)) <= 2, "it flickers"
    assert steps == sorted(steps)


@pytest.mark.parametrize("name", ["corner at corner", "edge on edge", "edge on edge, ends alike", "corner at edge"])
def test_touching_is_a_contact_of_no_depth(name):
    """Whole numbers, without rounding: closed shapes that touch overlap, at distance 0."""
    a, b, (x, y), way = MEETINGS[name]
    b = [(u + x, v + y) for u, v in b]
    assert sign_of_gap(a, b) == 0 and told(a, b) == 0
    beyond = [
        (math.nextafter(u, math.inf) if way[0] else u, math.nextafter(v, math.inf) if way[1] else v) for u, v in b
    ]
    assert sign_of_gap(a, beyond) == 1


def test_needles_that_cross_at_a_thousandth_of_a_degree():
    """B10: 100 px by 0.001 px, on a lattice on which every product is whole: no crossing is missed, none is made up."""
    rng, count, unit = np.random.default_rng(1), 100_000 if JIT else 2_000, 2.0**-20
    turns = np.radians(rng.choice([-1.0, 1.0], (2, count)) * 10.0 ** rng.uniform(-4.0, -2.0, (2, count)))
    middle = np.stack([rng.uniform(-100.0, 100.0, count), rng.uniform(-4e-3, 4e-3, count)], axis=1)
    outlines = []
    for turn, place in ((turns[0], 0.0 * middle), (turns[1], middle)):
        u, v = np.array([(-50.0, -5e-4), (50.0, -5e-4), (50.0, 5e-4), (-50.0, 5e-4)]).T
        x, y = np.cos(turn)[:, None] * u - np.sin(turn)[:, None] * v, np.sin(turn)[:, None] * u + v
        outlines.append(np.rint((np.stack([x, y], axis=2) + place[:, None]) / unit).astype(np.int64))
    exact = gaps_on_a_lattice(*outlines) * unit
    assert 0.3 < (exact <= 0.0).mean() < 0.7
    a, b = ([Polygon(corners) for corners in (each * unit).tolist()] for each in outlines)
    found = np.array([distance(one, STILL, two, STILL).distance for one, two in zip(a, b, strict=True)])
    contact = np.array([len(collide(one, STILL, two, STILL)) > 0 for one, two in zip(a, b, strict=True)])
    clear = np.abs(exact) > 10.0 * HAIR  # a tenth of a hair of 100 px
    assert clear.mean() > 0.99
    assert ((found <= 0.0) == (exact <= 0.0))[clear].all() and (contact == (exact <= 0.0))[clear].all()
    overlap = exact <= 0.0
    assert np.abs(found - exact)[overlap].max() <= 100.0 * HAIR, "of an overlap the widest gap over faces is the depth"
