"""The plain and the compiled form of every kernel give equal results in every call, even for
invalid numbers in bodies.
"""

import math
import random
from itertools import product

import numpy as np
import pytest

pytest.importorskip("numba")  # what compares the two forms imports the compiler

import physics
from physics import Circle, Effects, PixelMask, Polygon, World
from physics.collision.masks import pixel_range
from physics.jit import generic, kernel, subkernel
from physics.shapes.placement import NOWHERE, bucket_at, snapped
from tests.both_forms import FormsDiffer, compared, same_value
from tests.hostile import COLUMNS, KINDS, NUMBERS, STRATEGIES, ask, crowded

pytestmark = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")

WAYS = [(kind, solver) for kind, (_, solvers) in KINDS.items() for solver in solvers]
SEEDS, MANY_SEEDS = 2, 40
FAR = 2.0**20  # [px] a character is carried by so many pixels one by one: more would take minutes


def write_wrong(world, rng, walkers):
    """Write invalid or extreme NUMBERS into random columns of random bodies, and wake most of these bodies.

    walkers: True if the world has characters; then very large finite numbers are left out.
    """
    columns = rng.sample(COLUMNS, rng.choice((1, 3)))
    numbers = [each for each in NUMBERS if not (walkers and FAR < abs(each) < math.inf)]
    share = rng.choice((0.1, 0.5))
    for row in range(len(world)):
        if rng.random() < share and not world.bodies["quarantined"][row]:
            world.bodies[rng.choice(columns)][row] = rng.choice(numbers)
            if rng.random() < 0.7:
                world.touch(world.bodies["id"][row])


def play_wrong(kind, solver, strategy, seed):
    """Step a world and run queries while invalid numbers are written into its bodies between steps."""
    rng = random.Random(seed)
    walkers = seed % 2 == 0
    world = crowded(kind, strategy, solver, seed, walkers)
    world.step()
    for _ in range(3):
        write_wrong(world, rng, walkers)
        if rng.random() < 0.5:
            ask(world, rng.choice((0.0, 30.0, 2.0**31, 1e15, -(2.0**40))))
        world.step()
    ask(world)


@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize("kind, solver", WAYS)
def test_forms_are_the_same_where_numbers_are_wrong(kind, solver, strategy):
    with compared() as seen:
        for seed in range(SEEDS):
            play_wrong(kind, solver, strategy, seed)
    assert seen.calls > 100 and len(seen.kernels) > 15


@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # NumPy's, in both forms alike: what is compared are the kernels
@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize("kind, solver", WAYS)
def test_forms_are_the_same_where_many_numbers_are_wrong(kind, solver, strategy):
    with compared(stop=False):
        for seed in range(SEEDS, MANY_SEEDS):
            play_wrong(kind, solver, strategy, seed)


@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize("kind, solver", WAYS)
def test_forms_are_the_same_in_sound_worlds(kind, solver, strategy):
    with compared() as seen:
        world = crowded(kind, strategy, solver)
        for _ in range(8):
            world.step()
        ask(world)
    assert seen.calls > 100


@pytest.mark.parametrize("value", NUMBERS)
@pytest.mark.parametrize(
    "column", ["x", "angle", "angular_velocity", "sleep_time", "inverse_mass", "inverse_inertia", "extent"]
)
@pytest.mark.parametrize(
    "kind, touched",
    [
        ("dynamic", True),
        *(pytest.param(*each, marks=pytest.mark.nightly) for each in (("static", True), ("dynamic", False))),
        ("static", False),
    ],
)
def test_one_wrong_number_of_a_turned_mask(column, value, kind, touched):
    """A rotated mask with one invalid number, under a resting box, gives equal results in both forms.

    Such a number has no pixel column as a position, no bucket as an angle, and is no whole number of steps as a sleep
    time.
    """
    effects, _ = KINDS["stacked"]
    with compared():
        world = World(effects, gravity=(0.0, 300.0))
        mask = world.add_body(PixelMask(np.ones((6, 30), bool)), angle=0.1, kind=kind)
        world.add_body(Polygon.box(6.0, 6.0), position=(0.0, -6.0))
        world.step()
        world.bodies[column][0] = value
        if touched:
            world.touch(mask.id)
        world.overlap(Circle(3.0), (0.0, -2.0, 0.0))
        world.closest((0.0, -20.0))
        for _ in range(2):
            world.step()


@pytest.mark.parametrize("column", ["inverse_mass", "inverse_inertia"])
@pytest.mark.parametrize("value", [-1e-3, -1e300, -math.inf])
def test_a_negative_inverse_mass_is_quarantined(column, value):
    """A body with a negative inverse mass or inertia is quarantined; its contacts would have no effective mass."""
    world = World(Effects.rigid_bodies())
    world.add_body(Circle(5.0))
    world.bodies[column][0] = value
    world.step()
    assert world.events.quarantined["body"].tolist() == [0]


@pytest.mark.parametrize("column", ["x", "y", "angle", "extent"])
@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
def test_closest_ends_where_no_body_is_anywhere(column, value):
    """World.closest() returns although no body has a finite box.

    Its search box grows until a body is inside; it must not grow for ever.
    """
    world = World(Effects())
    world.add_body(PixelMask(np.ones((4, 4), bool)), position=(300.0, 0.0))
    world.bodies[column][0] = value
    found = world.closest((0.0, 0.0))
    assert found is None or math.isfinite(found[2])
    assert column != "extent" or found[2] == pytest.approx(298.0)


@kernel
def columns_of(values, origin, buckets, columns_out, buckets_out):
    """Write two numbers for each value: its pixel column as a position, and the index of its bucket as an angle."""
    for k in range(len(values)):
        columns_out[k] = snapped(values[k], origin)
        buckets_out[k] = bucket_at(values[k], buckets)


def test_what_has_no_pixel_is_nowhere_in_both_forms():
    values = np.array([*NUMBERS, 2.5, -2.5, -0.5])
    columns, buckets = np.zeros((2, len(values)), np.int64)
    with compared():
        columns_of(values, 0.0, 128, columns, buckets)
    for value, column, bucket in zip(values.tolist(), columns.tolist(), buckets.tolist(), strict=True):
        assert column == (math.floor(value + 0.5) if abs(value) < 2.0**62 else NOWHERE)
        assert 0 <= bucket < 128


@kernel
def ranges_of(values, set_low, set_high, ranges_out):
    """Write the range of pixels (first, end) between every two of the values.

    set_low, set_high: range of solid pixels to which the results are clipped, end exclusive.
    """
    found = 0
    for low in range(len(values)):
        for high in range(len(values)):
            ranges_out[found, 0], ranges_out[found, 1] = pixel_range(values[low], values[high], 3, set_low, set_high)
            found += 1


@pytest.mark.parametrize("set_low, set_high", [(0, 9), (2, 3), (0, 0)])
def test_ranges_of_pixels_stay_within_the_solid_ones(set_low, set_high):
    """The range of pixels between two positions lies within the solid pixels.

    If both positions are finite, it contains exactly the pixels found by testing each one.
    """
    values = np.array([*NUMBERS, 2.5, 3.0, 4.0, 5.25, 9.0, 30.0])
    ranges = np.zeros((len(values) ** 2, 2), np.int64)
    with compared():
        ranges_of(values, set_low, set_high, ranges)
    for (low, high), (first, last) in zip(product(values.tolist(), repeat=2), ranges.tolist(), strict=True):
        assert set_low <= first <= set_high and set_low <= last <= set_high
        if low < high:
            assert list(range(first, last)) == [
                k for k in range(set_low, set_high) if low < 3 + k + 1 and 3 + k <= high
            ]


# --- the comparison itself ---


@subkernel
def root_of_it(x):
    """Return the square root of x."""
    return math.sqrt(x)


@kernel
def roots(values, roots_out):
    """Write the square roots of the values and return the last one."""
    for k in range(len(values)):
        roots_out[k] = root_of_it(values[k])
    return roots_out[-1]


@generic
def doubled(values_inout):
    """Double the values in place."""
    for k in range(len(values_inout)):
        values_inout[k] = 2.0 * values_inout[k]


def test_what_raises_in_one_form_alone_is_seen():
    with pytest.raises(FormsDiffer, match=r"roots raises ValueError\('math domain error'\) in root_of_it when plain"):
        with compared():
            roots(np.array([4.0, -1.0]), np.zeros(2))


@pytest.mark.parametrize(
    "wrong, words", [("result", "returns 3.0 when plain, 2.0 when"), ("array", "writes 3.0 when plain, 2.0")]
)
def test_what_differs_is_seen(wrong, words):
    def twin(values, roots_out):
        roots_out[0] = 3.0 if wrong == "array" else 2.0
        return 3.0 if wrong == "result" else 2.0

    before = roots._plain
    roots._plain = twin
    try:
        with pytest.raises(FormsDiffer, match=words):
            with compared():
                roots(np.array([4.0]), np.zeros(1))
        with pytest.raises(FormsDiffer, match=r"\(2 times\)"):
            with compared(stop=False):
                roots(np.array([4.0]), np.zeros(1)), roots(np.array([4.0]), np.zeros(1))
    finally:
        roots._plain = before


def test_views_of_one_buffer_stay_views_of_one():
    """Arguments that are views of one buffer also share a buffer in the copies for the plain form.

    Otherwise the plain form would not read what it has written through another argument.
    """
    buffer = np.ones(8)
    with compared() as seen:
        roots(buffer[:4], buffer[2:6])
        doubled(buffer[::2])
    assert seen.calls == 2 and seen.kernels == {roots.name, doubled.name}
    assert buffer.tolist() == [2.0, 1.0] * 4


@pytest.mark.parametrize(
    "one, two, same",
    [
        (0.0, -0.0, False),
        (math.nan, -math.nan, True),
        (1, True, True),
        (1, 1.0, False),
        ((1.0, 2), (1.0, 2), True),
        ((1.0,), (1.0, 2), False),
    ],
)
def test_values_are_the_same_by_their_bits(one, two, same):
    assert same_value(one, two) == same


def test_a_form_that_is_at_hand_is_not_looked_for_and_calls_are_as_before():
    assert "__call__" not in vars(type(roots))
    with compared():
        roots(np.array([4.0]), np.zeros(1))
    assert "__call__" not in vars(type(roots)) and roots(np.array([9.0]), np.zeros(1)) == 3.0
