"""The character is drawn at its place on a slightly tilted crate, not lowered to the tiles below the crate."""

from types import SimpleNamespace

import pytest

from scenes.platformer.view import lowered


def hero(slope):
    return SimpleNamespace(slope=slope, box=(100.0, 76.0, 110.0, 100.0))


def level(drop):
    """Return a stand-in for a level whose tiles lie `drop` [px] below the character's feet."""
    return SimpleNamespace(drop_to_ground=lambda x, bottom, most: min(drop, most))


def test_a_crate_that_tilts_a_little_lowers_him_by_as_little():
    assert lowered(level(40.0), hero(0.0008)) == pytest.approx(0.004)


@pytest.mark.parametrize("slope", [0.5, -0.5, 1.0])
def test_on_a_slope_of_tiles_his_feet_are_at_their_middle(slope):
    assert lowered(level(abs(slope) * 5.0), hero(slope)) == pytest.approx(abs(slope) * 5.0)


def test_where_a_slope_ends_the_tiles_say_how_far_it_is():
    assert lowered(level(1.0), hero(1.0)) == 1.0


def test_on_the_flat_he_stands_where_he_is():
    assert lowered(level(40.0), hero(0.0)) == 0.0
