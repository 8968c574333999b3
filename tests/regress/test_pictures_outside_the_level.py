"""A level can use only pictures of the game, found by name, and pictures in its own folder."""

import os
import shutil

import pygame
import pytest

from game.drawing.sprites import load_image
from game.drawing.tile_picture import TilePicture
from game.drawing.tilemap import load_tilemap
from game.errors import FileError
from game.places import IMAGES, LEVELS
from scenes.platformer.level import level_of
from tests.scenes.test_platformer_maps import save, small


@pytest.fixture
def folder(tmp_path):
    """Return a folder levels/ next to a picture that levels must not use."""
    made = tmp_path / "levels"
    (made / "art").mkdir(parents=True)
    shutil.copy(IMAGES / "tiles.png", tmp_path / "secret.png")
    return made


def with_picture(folder, name):
    level = small()
    level["tilesets"][0]["image"] = name
    return save(folder, level)


OUTSIDE = [
    "../secret.png",
    "art/../../secret.png",
    "./../secret.png",
    "..\\secret.png",
    "art\\..\\..\\secret.png",
    "../levels/mine.png",  # it comes back in: not asked about
    "{here}/secret.png",
    "{here}/levels/mine.png",
    "/etc/hostname",
    "C:\\secret.png",
    "C:secret.png",
    "\\\\server\\share\\secret.png",
    "//server/share/secret.png",
    "\\secret.png",
    "..",
]
DOORS = {"platformer": level_of, "tiles": lambda path: TilePicture(load_tilemap(path), "solid")}


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("name", OUTSIDE)
def test_a_path_out_of_the_folder_is_refused(tmp_path, folder, door, name):
    shutil.copy(IMAGES / "tiles.png", folder / "mine.png")
    path = with_picture(folder, name.format(here=tmp_path))
    with pytest.raises(FileError, match=r"tilesets\[0\].image: .* leads out of the level's folder"):
        DOORS[door](path)


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links here")
@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("link, to, name", [
    ("mine.png", "../secret.png", "mine.png"),
    ("mine.png", "{here}/secret.png", "mine.png"),
    ("far", "..", "far/secret.png"),
    ("art/mine.png", "../../secret.png", "art/mine.png"),
])  # fmt: skip
def test_a_link_out_of_the_folder_is_refused(tmp_path, folder, door, link, to, name):
    (folder / link).symlink_to(to.format(here=tmp_path))
    with pytest.raises(FileError, match=r"tilesets\[0\].image: .* leads out of the level's folder"):
        DOORS[door](with_picture(folder, name))


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("name", ["mine.png", "art/mine.png", "./art/mine.png", "art\\mine.png"])
def test_a_picture_in_the_folder_is_taken(folder, door, name):
    shutil.copy(IMAGES / "tiles.png", folder / name.replace("\\", "/"))
    made = DOORS[door](with_picture(folder, name))
    if door == "platformer":
        assert made.picture == (folder / name.replace("\\", "/")).resolve()


def test_a_link_within_the_folder_and_a_folder_that_is_a_link_are_taken(tmp_path, folder):
    shutil.copy(IMAGES / "tiles.png", folder / "art" / "mine.png")
    (folder / "mine.png").symlink_to("art/mine.png")
    (tmp_path / "other").symlink_to("levels")
    with_picture(folder, "mine.png")
    assert level_of(tmp_path / "other" / "mine.tmj").picture == (folder / "art" / "mine.png").resolve()


@pytest.mark.parametrize("name", ["tiles.png", "../images/tiles.png", "..\\images\\tiles.png", "/far/away/tiles.png"])
def test_the_game_s_own_picture_is_found_by_its_name_wherever_the_path_leads(tmp_path, folder, name):
    other = pygame.Surface((8, 8))
    pygame.image.save(other, tmp_path / "tiles.png")  # not that of the folder above
    found = level_of(with_picture(folder, name)).picture
    assert found == IMAGES / "tiles.png"
    assert load_image(found).get_size() != (8, 8)


def test_one_s_own_picture_goes_before_the_game_s_of_its_name(folder):
    shutil.copy(IMAGES / "tiles.png", folder / "tiles.png")
    assert level_of(with_picture(folder, "tiles.png")).picture == (folder / "tiles.png").resolve()


@pytest.mark.parametrize("name", ["", ".", "art", "none.png", "art/none.png"])
def test_no_picture(folder, name):
    with pytest.raises(FileError, match=r"tilesets\[0\].image: there is no picture"):
        level_of(with_picture(folder, name))


def test_the_game_s_own_level_has_its_picture():
    assert level_of(LEVELS / "platformer.tmj").picture == IMAGES / "tiles.png"
