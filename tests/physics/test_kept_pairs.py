"""collide() and distance() keep the tables of recent pairs and use them again.

The results equal those with new tables.
"""

import gc
import math
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from physics import Capsule, Chain, Circle, PixelMask, Polygon, TileGrid, collide, distance
from physics.queries import pairs
from physics.queries.pairs import KEPT_PAIRS


def shapes():
    rng = np.random.default_rng(11)
    masks = [PixelMask(rng.random((9 + k, 12)) < 0.7, snap=bool(k % 2)) for k in range(6)]
    grid = TileGrid(np.ones((2, 5), int), 8.0)
    chain = Chain([(30.0, 6.0), (0.0, 2.0), (-30.0, 6.0)])
    return [*masks, grid, chain, Circle(5.0), Polygon.box(10.0, 6.0), Capsule((-4, 0), (4, 0), 2.0)]


def asked(seed, count):
    """Return random (shape A, pose A, shape B, pose B) tuples in which each pair of shapes occurs several times."""
    known, rng = shapes(), np.random.default_rng(seed)
    found = []
    for _ in range(count):
        a, b = (known[k] for k in rng.choice(len(known), 2))
        turn = float(rng.uniform(-math.pi, math.pi)) if isinstance(b, (PixelMask, Circle, Polygon, Capsule)) else 0.0
        found.append((a, (0.0, 0.0, 0.0), b, (*map(float, rng.uniform(-12, 12, 2)), turn)))
    return found


def answers(query, forget=False):
    found = []
    for question in query:
        if forget:
            vars(pairs.THREAD).clear()
        m, d = collide(*question, margin=1.0), distance(*question)
        found.append((tuple(m.normal), m.points.tolist(), m.separations.tolist(), m.features.tolist(), m.area))
        found.append((d.distance, tuple(d.normal), tuple(d.point_a), tuple(d.point_b)))
    return found


@pytest.mark.parametrize("seed", range(6))
def test_kept_tables_answer_as_new_ones(seed):
    query = asked(seed, 120)
    assert answers(query) == answers(query, forget=True)


def test_threads_do_not_share_tables():
    queries = [asked(seed, 60) for seed in range(4)]
    alone = [answers(query) for query in queries]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(answers, queries)) == alone


def test_no_more_than_the_last_pairs_are_kept():
    vars(pairs.THREAD).clear()
    pose = (0.0, 0.0, 0.0)
    first = PixelMask(np.ones((4, 4), bool))
    gone = weakref.ref(first)
    collide(first, pose, Circle(2.0), pose)
    for _ in range(3 * KEPT_PAIRS):
        collide(PixelMask(np.ones((4, 4), bool)), pose, Circle(2.0), pose)
    assert len(pairs.THREAD.pairs) == KEPT_PAIRS
    del first
    gc.collect()
    assert gone() is None, "a shape that nobody uses any more is freed"
