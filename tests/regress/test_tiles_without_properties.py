"""A solid layer may use a tile without properties in its tileset; it once raised a KeyError."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from game.drawing.tilemap import map_picture
from game.errors import FileError
from scenes.platformer.level import EMPTY, level_of
from tests.scenes.test_platformer_maps import OWN, save, small

ROOT = Path(__file__).resolve().parents[2]


def with_tile(number, listed):
    """Return a level with tile `number` once in its solid layer, and with properties for the `listed` tiles only."""
    level = small()
    tileset = level["tilesets"][0] = dict(level["tilesets"][0])
    tileset["tiles"] = [tile for tile in tileset["tiles"] if tile["id"] in listed]
    level["layers"][0]["data"][40] = number + tileset["firstgid"]
    return level


ALL = {tile["id"] for tile in OWN["tilesets"][0]["tiles"]}
PLAIN = next(tile["id"] for tile in OWN["tilesets"][0]["tiles"])


@pytest.mark.parametrize("number", [1, 5, 40])
def test_a_tile_that_nothing_is_said_of_is_decoration(tmp_path, number):
    level = level_of(save(tmp_path, with_tile(number, ALL - {number})))
    assert level.kind(10, 1) == EMPTY and level.kinds[1][10] == EMPTY
    assert not level.grid.solid[1, 10]
    assert np.array(level.kinds).shape == level.grid.solid.shape


def test_a_tileset_that_says_nothing(tmp_path):
    raw = with_tile(3, ())
    del raw["tilesets"][0]["tiles"]
    level = level_of(save(tmp_path, raw))
    assert all(kind == EMPTY for row in level.kinds for kind in row)


@pytest.mark.parametrize("beyond", [0, 1, 5000])
def test_a_tile_beyond_the_tileset_is_named(tmp_path, beyond):
    count = OWN["tilesets"][0]["tilecount"]
    with pytest.raises(FileError, match=rf"tile {count + beyond + 1} is not in the tileset .*column 10 row 1"):
        level_of(save(tmp_path, with_tile(count + beyond, ALL)))


def test_the_program_says_so_too(tmp_path):
    path = save(tmp_path, with_tile(40, ALL - {40}))
    map_picture(level_of(path).map)  # the level's picture has that tile
    arguments = ["--scene", "platformer", "--level", str(path), "--headless", "--frames", "2", "--json"]
    run = subprocess.run([sys.executable, "main.py", *arguments], cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stderr[-500:]
    assert json.loads(run.stdout)["frames"] == 2
