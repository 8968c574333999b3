"""find_pairs of every broad phase, compared with a double loop over all bodies."""

import numpy as np
import pytest

from physics import JIT, BruteForce, DynamicTree, SpatialHashGrid, SweepAndPrune
from tests.oracles.boxes import touching_pairs

STRATEGIES = {
    "brute": BruteForce(),
    "all pairs": BruteForce(incremental=False),
    "sweep": SweepAndPrune(),
    "both": SweepAndPrune(axes="both"),
    "hash": SpatialHashGrid(),
    "hash_fine": SpatialHashGrid(0.37),
    "hash_coarse": SpatialHashGrid(500.0),
    "tree": DynamicTree(),
    "tree_of_two": DynamicTree(width=2),
    "tree_tight": DynamicTree(margin=0.0),
}
every_strategy = pytest.mark.parametrize("strategy", STRATEGIES.values(), ids=STRATEGIES.keys())


def found(strategy, lower, upper):
    pairs = strategy.find_pairs(lower, upper)
    assert pairs.dtype == np.int32 and pairs.shape[1:] == (2,)
    return list(map(tuple, pairs.tolist()))


def random_boxes(seed, n, spread, size):
    rng = np.random.default_rng(seed)
    lower = rng.uniform(-spread, spread, (n, 2))
    return lower, lower + rng.exponential(size, (n, 2))


@every_strategy
@pytest.mark.parametrize("n", [0, 1, 2, 17, 256])
def test_random_boxes_pair_as_the_double_loop_says(strategy, n):
    lower, upper = random_boxes(n, n if JIT else min(n, 120), 200.0, 12.0)
    assert found(strategy, lower, upper) == touching_pairs(lower.tolist(), upper.tolist())


@every_strategy
def test_two_thousand_boxes_pair_as_the_double_loop_says(strategy):
    lower, upper = random_boxes(5, 2000 if JIT else 400, 900.0, 15.0)
    assert found(strategy, lower, upper) == touching_pairs(lower.tolist(), upper.tolist())


AWKWARD = {
    "edges touch": [(0, 0, 10, 10), (10, 0, 20, 10), (0, 10, 10, 20)],
    "corners touch": [(0, 0, 10, 10), (10, 10, 20, 20), (-10, -10, 0, 0)],
    "one ulp apart": [(0, 0, 10, 10), (np.nextafter(10, 11), 0, 20, 10), (0, -5, 10, np.nextafter(0, -1))],
    "points": [(5, 5, 5, 5), (5, 5, 5, 5), (0, 0, 10, 10), (10, 10, 10, 10), (11, 10, 11, 10)],
    "segments": [(0, 5, 20, 5), (10, 0, 10, 20), (10, 5, 10, 5), (21, 5, 30, 5)],
    "identical": [(1, 2, 3, 4)] * 6,
    "nested": [(0, 0, 100, 100), (10, 10, 90, 90), (40, 40, 41, 41), (0, 0, 100, 100)],
    "negative": [(-30, -30, -20, -20), (-20, -20, -10, -10), (-25, -25, 5, 5), (-10, -10, 0, 0), (0, 0, 1, 1)],
    "minus zero": [(-0.0, -0.0, 1, 1), (-1, -1, 0.0, 0.0), (-1, -1, -0.0, -0.0)],
    "cell borders": [(16 * i, 16 * j, 16 * i + 16, 16 * j + 16) for i in range(-3, 3) for j in range(-3, 3)],
    "huge": [
        (1e12, 1e12, 1e12 + 5, 1e12 + 5),
        (1e12 + 5, 1e12, 1e12 + 9, 1e12 + 9),
        (-1e12, -1e12, 1e12, 1e12),
        (1e12 + 6, 1e12 + 6, 1e12 + 7, 1e12 + 7),
        (0, 0, 1, 1),
    ],
    "huge spread": [(-1e12, 0, -1e12 + 1, 1), (1e12, 0, 1e12 + 1, 1), (-2e12, 0, 2e12, 1), (0, 0, 1, 1)] * 2,
    "tiny": [(0, 0, 1e-12, 1e-12), (1e-12, 0, 2e-12, 1e-12), (3e-12, 0, 4e-12, 1e-12), (0, 0, 1, 1)],
    "denormal": [(0, 0, 5e-324, 5e-324), (5e-324, 0, 1e-320, 5e-324), (-1, -1, 0, 0)],
    "infinite": [
        (-np.inf, -np.inf, np.inf, np.inf),
        (0, 0, 1, 1),
        (np.inf, 0, np.inf, 1),
        (-np.inf, 0.5, 0, 0.5),
        (5, 5, 6, np.inf),
        (5.5, 100, 6, 101),
        (2, 2, 3, 3),
    ],
    "all infinite": [(-np.inf, -np.inf, np.inf, np.inf)] * 4,
    "largest doubles": [(-1.7e308, -1.7e308, 1.7e308, 1.7e308), (1e308, 1e308, 1.7e308, 1.7e308), (0, 0, 1, 1)],
    "thin and long": [(0, 7 * i, 4000, 7 * i + 0.1) for i in range(8)]
    + [(500 * i, 0, 500 * i + 0.1, 60) for i in range(8)],
}


@every_strategy
@pytest.mark.parametrize("name", AWKWARD)
def test_awkward_boxes_pair_as_the_double_loop_says(strategy, name):
    boxes = np.array(AWKWARD[name], float)
    assert found(strategy, boxes[:, :2], boxes[:, 2:]) == touching_pairs(boxes[:, :2].tolist(), boxes[:, 2:].tolist())


@every_strategy
def test_boxes_on_cell_borders_of_any_grid_pair_exactly(strategy):
    rng = np.random.default_rng(3)
    lower = rng.integers(-8, 8, (90, 2)) * 0.37
    upper = lower + rng.integers(0, 4, (90, 2)) * 0.37
    assert found(strategy, lower, upper) == touching_pairs(lower.tolist(), upper.tolist())


@every_strategy
def test_128_boxes_at_one_point_make_8128_pairs(strategy):
    lower = np.full((128, 2), 7.5)
    assert len(strategy.find_pairs(lower, lower + 3.0)) == 8128


@every_strategy
def test_giant_ground_under_small_boxes_pairs_with_each(strategy):
    n = 1000 if JIT else 150
    x = np.linspace(-4.9e5, 4.9e5, n)
    lower = np.vstack([[-5e5, 0.0], np.stack([x, np.full(n, -1.0)], 1)])
    upper = np.vstack([[5e5, 1.0], np.stack([x + 1.0, np.zeros(n)], 1)])
    assert found(strategy, lower, upper) == [(0, k) for k in range(1, n + 1)]


@every_strategy
@pytest.mark.parametrize("bad, value", [("lower", np.nan), ("upper", np.nan)])
def test_nan_is_refused_and_the_row_named(strategy, bad, value):
    lower, upper = random_boxes(1, 40, 10.0, 2.0)
    {"lower": lower, "upper": upper}[bad][17, 1] = value
    with pytest.raises(ValueError, match=rf"{bad}\[17\].*nan"):
        strategy.find_pairs(lower, upper)


@every_strategy
def test_reversed_and_misshapen_boxes_are_refused(strategy):
    with pytest.raises(ValueError, match=r"lower\[1\].*upper\[1\]"):
        strategy.find_pairs([(0, 0), (5, 0)], [(1, 1), (4, 1)])
    with pytest.raises(ValueError, match="lower"):
        strategy.find_pairs([(0, 0, 0)], [(1, 1, 1)])
    with pytest.raises(ValueError, match="lower and upper"):
        strategy.find_pairs([(0, 0)], [(1, 1), (2, 2)])
    with pytest.raises(TypeError, match="upper"):
        strategy.find_pairs([(0, 0)], "ab")


@every_strategy
def test_lists_float32_and_strided_arrays_give_the_same_pairs(strategy):
    lower, upper = np.array([(0, 0), (1, 1), (5, 5)]), np.array([(1, 1), (2, 2), (6, 6)])
    wide = np.zeros((6, 4))
    wide[::2, ::2] = lower
    for low in (
        lower.tolist(),
        lower.astype(np.float32),
        lower.astype(np.int8),
        wide[::2, ::2],
        np.asfortranarray(lower),
    ):
        assert found(strategy, low, upper) == [(0, 1)]


def test_boxes_of_every_size_pair_under_hypothesis():
    hypothesis = pytest.importorskip("hypothesis")
    from hypothesis import strategies as st

    number = st.one_of(st.integers(-40, 40).map(float), st.floats(-1e3, 1e3), st.sampled_from([0.0, 16.0, 1e9, -1e9]))
    box = st.tuples(
        number, number, st.sampled_from([0.0, 1.0, 16.0, 33.0, 1e6]), st.sampled_from([0.0, 1.0, 16.0, 1e7])
    )

    @hypothesis.settings(derandomize=True, deadline=None, max_examples=150 if JIT else 25, database=None)
    @hypothesis.given(st.lists(box, max_size=24))
    def check(boxes):
        array = np.array(boxes, float).reshape(-1, 4)
        lower, upper = array[:, :2], array[:, :2] + array[:, 2:]
        wanted = touching_pairs(lower.tolist(), upper.tolist())
        for name, strategy in STRATEGIES.items():
            assert found(strategy, lower, upper) == wanted, name

    check()
