"""Pictures of scenes: each scene has a menu picture, frames are averaged in integers, and moments are found."""

import json

import numpy as np
import pytest

from assets import FOLDER
from assets.build import PRODUCTS
from assets.craft import png
from assets.publish.films import filmed
from scenes import SCENES, filming, moments

PICTURES = FOLDER / "images" / "pictures"


@pytest.mark.parametrize("scene", SCENES)
def test_scene_has_a_picture_worth_looking_at(scene):
    picture = png.decode((PICTURES / filming.picture_name(scene)).read_bytes())
    assert picture.shape == (90, 160, 3)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 12
    assert picture.std() > 8


def test_no_two_pictures_are_the_same_and_none_is_left_over():
    kept = {path.name: path.read_bytes() for path in PICTURES.iterdir()}
    assert set(kept) == {filming.picture_name(scene) for scene in SCENES}
    assert len(set(kept.values())) == len(SCENES)
    assert PRODUCTS["images/pictures"][1] == "picture_files"


def test_one_picture_regenerates():
    """The menu picture of lab/cradle equals a newly made one; the nightly build compares all of them."""
    kept = png.decode((PICTURES / "lab_cradle.png").read_bytes())
    assert (filming.menu_picture("lab/cradle") == kept).all()


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
    assert set(moments.MOMENTS) == {"shooter", "platformer", "lander"}
    for found in moments.MOMENTS.values():
        assert len(found) == len({moment.caption for moment in found}) == 12


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


def test_the_program_writes_moments_with_their_captions(tmp_path, monkeypatch):
    found = (moments.Moment("soon", lambda scene: scene.frame >= 2), moments.Moment("later", lambda scene: True, 3))
    monkeypatch.setitem(moments.MOMENTS, "lab/stacks", found)
    assert filming.main(["moments", "lab/stacks", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["00.png", "01.png", "captions.json"]
    assert json.loads((tmp_path / "captions.json").read_text()) == ["soon", "later"]
    assert png.decode((tmp_path / "01.png").read_bytes()).shape == (270, 480, 3)


def test_the_program_writes_a_reel(tmp_path):
    target = tmp_path / "reel.png"
    assert filming.main(["reel", "lab/stacks", "1", "0", "9", "4", str(target)]) == 0
    assert png.decode(target.read_bytes()).shape == (90, 8 * 160, 3)


def test_the_moving_picture_has_every_third_step_with_the_overlays_of_its_part(tmp_path, monkeypatch):
    start = moments.Moment("soon", lambda scene: scene.frame >= 3)
    parts = ((6, ()), (7, ("bounds",)))
    monkeypatch.setattr(filming, "CLIPS", [filming.Clip("lab/stacks", start, parts)])
    pictures = list(filming.clip_pictures(filming.CLIPS[0]))
    assert [each.shape for each in pictures] == [(405, 720, 3)] * 5  # of 13 steps, the 1st, 4th, 7th, 10th and 13th
    plain = filming.film("lab/stacks", moments.SEED, [4, 7, 10])
    shrunk = [plain[frame].reshape(405, 2, 720, 2, 3).mean(axis=(1, 3)) for frame in (4, 7, 10)]
    off = [np.abs(picture - other) for picture, other in zip(pictures, shrunk, strict=False)]
    assert [(each > 0.51).any() for each in off] == [False, False, True], "plain, plain, with boxes"
    filming.main(["moving", str(tmp_path / "moving.webp")])
    assert (tmp_path / "moving.webp").read_bytes().count(b"ANMF") == 5


def test_a_clip_whose_moment_does_not_come_is_named(monkeypatch):
    monkeypatch.setattr(filming, "MOST", 5)
    never = filming.Clip("lab/stacks", moments.Moment("never", lambda scene: False), ((3, ()),))
    with pytest.raises(ValueError, match="'never' did not come within 5"):
        next(filming.clip_pictures(never))


@pytest.mark.parametrize(
    "arguments, why",
    [
        (["reel", "lab/stacks", "1", "9", "3", "4", "x.png"], "must not be after the last"),
        (["reel", "lab/nothing", "1", "0", "3", "4", "x.png"], "lab/nothing"),
        (["pictures", "/no/such/folder"], "is no folder"),
    ],
)
def test_the_program_refuses_what_cannot_be(arguments, why, capsys):
    with pytest.raises(SystemExit) as left:
        filming.main(arguments)
    assert left.value.code == 2 and why in capsys.readouterr().err


def test_the_reason_why_filming_failed_is_reported():
    with pytest.raises(RuntimeError, match="invalid choice: 'lab/nothing'"):
        filmed("moments", "lab/nothing")
