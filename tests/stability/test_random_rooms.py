"""Random rooms come to rest without a lost body, and passive scenes gain no energy, all under the default settings."""

import pytest

from tests.stability.piles import needs_speed
from tests.stability.rooms import PASSIVE, SECONDS, most_energy, play

ROOMS = 200
RISE = 1e-3  # greatest rise of mechanical energy in a step, as a share of that at the start
GAIN = 1.005  # greatest energy of a passive scene, as a share of that at the start
OVERLAP = 1.0  # [px] at rest


def check(seed, **settings):
    found = play(seed, **settings)
    assert (found.left, found.pops) == (0, 0), (seed, found)
    assert found.awake == 0 and found.asleep_after <= SECONDS, (seed, found)
    assert found.rise <= RISE and found.overlap <= OVERLAP, (seed, found)


@needs_speed
@pytest.mark.parametrize("seed", range(5))
def test_small_rooms_come_to_rest(seed):
    check(seed, most=80)


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("seed", range(ROOMS))
def test_rooms_of_up_to_three_hundred_bodies_come_to_rest(seed):
    check(seed)


# kind: greatest rise of energy in a step of the first ten seconds.
TEN_SECONDS = {"bowl": 5e-4, "eccentric disc": 4e-4, "balls": 4e-4, "boxes": 5e-4, "masks": 8e-4}


@needs_speed
@pytest.mark.parametrize("kind", PASSIVE)
def test_passive_scenes_gain_no_energy_in_ten_seconds(kind):
    for seed in range(3):
        most, rise = most_energy(kind, seed, 10)
        assert most <= GAIN and rise <= TEN_SECONDS[kind], (seed, most, rise)


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("kind", PASSIVE)
def test_passive_scenes_gain_no_energy_in_ten_minutes(kind, seed):
    most, rise = most_energy(kind, seed, 600)
    assert most <= GAIN and rise <= RISE, (most, rise)
