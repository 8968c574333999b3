"""Every scene has its picture for the menu; filming itself: a part of the frame, averaged in whole numbers."""

import numpy as np
import pytest

from assets import FOLDER, filming, moments, png
from assets.build import PRODUCTS
from scenes import SCENES


@pytest.mark.parametrize("scene", SCENES)
def test_scene_has_a_picture_worth_looking_at(scene):
    picture = png.decode((FOLDER / filming.picture_name(scene)).read_bytes())
    assert picture.shape == (90, 160, 3)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 12
    assert picture.std() > 8


def test_no_two_pictures_are_the_same_and_none_is_left_over():
    folder = FOLDER / "images" / "pictures"
    kept = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(kept) == {filming.picture_name(scene).rsplit("/", 1)[1] for scene in SCENES}
    assert len(set(kept.values())) == len(SCENES)
    assert PRODUCTS["images/pictures"][1] == "picture_files"


@pytest.mark.parametrize("scene, shot", filming.SHOTS.items())
def test_shot_lies_on_the_canvas(scene, shot):
    left, top, width, height = shot.part
    assert scene in SCENES and (isinstance(shot.frame, moments.Moment) or shot.frame > 0)
    assert left >= 0 and top >= 0 and left + width <= 480 and top + height <= 270


def test_reduced_averages_blocks_of_the_part():
    pixels = np.zeros((810, 1440, 3), np.uint8)
    pixels[30:36, 60:66] = 90  # the canvas pixels (20..21, 10..11)
    assert (filming.reduced(pixels, (20, 10, 160, 90), 1)[0, 0] == 90).all()
    half = filming.reduced(pixels, (20, 10, 320, 180), 2)
    assert half.shape == (90, 160, 3) and (half[0, 0] == 90).all() and not half[1:].any()
    shifted = filming.reduced(pixels, (21, 10, 320, 180), 2)
    assert (shifted[0, 0] == 45).all()


def test_a_filmed_run_is_the_same_every_time():
    first = filming.film("lab/stacks", 1, [3, 30])
    again = filming.film("lab/stacks", 1, [30])
    assert sorted(first) == [3, 30] and (first[30] == again[30]).all()
    assert (first[3] != first[30]).any()


def test_moments_are_twelve_for_each_game():
    assert set(moments.MOMENTS) == {"shooter", "platformer"}
    for found in moments.MOMENTS.values():
        assert len(found) == moments.COLUMNS * moments.ROWS == 12
        assert len({moment.caption for moment in found}) == 12


def test_moments_are_looked_for_in_order_and_a_missing_one_is_named(monkeypatch):
    monkeypatch.setattr(filming, "MOST", 12)
    later = moments.Moment("later", lambda scene: scene.frame >= 5, 2)
    seen = []
    last = moments.Moment("last", lambda scene: seen.append(scene.frame) or scene.frame >= 8)
    first, second = filming.film_moments("lab/stacks", 1, [later, last])
    assert first.shape == second.shape == (810, 1440, 3)
    assert seen == [7, 8]
    with pytest.raises(ValueError, match="'never' did not come within 12"):
        filming.film_moments("lab/stacks", 1, [moments.Moment("never", lambda scene: False)])
