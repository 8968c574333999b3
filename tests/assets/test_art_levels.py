"""The level is real Tiled JSON, big enough, every tile and object in it is known, and its text is checked."""

import json

import pytest

from assets import FOLDER, png
from assets.levels import Map, walking_range
from assets.tiles import TILE

KINDS = {"solid", "one_way", "slope", "spikes", "decor"}
TYPES = {"hero_start", "coin", "spring", "crate", "walker", "platform", "spikes", "goal", "sign", "checkpoint"}


@pytest.fixture(scope="module")
def tmj():
    return json.loads((FOLDER / "levels" / "platformer.tmj").read_text(encoding="utf-8"))


def things(tmj, kind):
    return [thing for thing in tmj["layers"][2]["objects"] if thing["type"] == kind]


def properties(entry):
    return {row["name"]: row["value"] for row in entry["properties"]}


def kind_at(tmj, x, y):
    gid = tmj["layers"][1]["data"][y * tmj["width"] + x]
    return properties(tmj["tilesets"][0]["tiles"][gid - 1])["kind"] if gid else None


def test_level_is_large_and_every_gid_exists(tmj):
    assert tmj["width"] >= 100 and tmj["height"] >= 20
    assert [layer["name"] for layer in tmj["layers"]] == ["decor", "solid", "things"]
    count = tmj["tilesets"][0]["tilecount"]
    for layer in tmj["layers"][:2]:
        assert len(layer["data"]) == tmj["width"] * tmj["height"]
        assert all(0 <= gid <= count for gid in layer["data"])


def test_tileset_fits_its_picture_and_names_its_kinds(tmj):
    tileset = tmj["tilesets"][0]
    picture = png.decode((FOLDER / "levels" / tileset["image"]).read_bytes())
    assert picture.shape[:2] == (tileset["imageheight"], tileset["imagewidth"])
    sheet = json.loads((FOLDER / "images" / "tiles.json").read_text(encoding="utf-8"))["frames"]
    assert len(tileset["tiles"]) == tileset["tilecount"] == len(sheet)
    for tile in tileset["tiles"]:
        values = properties(tile)
        place = sheet[values["name"]]
        row, column = divmod(tile["id"], tileset["columns"])
        assert (place["x"], place["y"]) == (column * TILE, row * TILE)
        assert values["kind"] in KINDS
        if values["kind"] == "slope":
            assert {values["left"], values["right"]} in ({0.0, 1.0}, {0.0, 0.5}, {0.5, 1.0})


def test_level_uses_every_kind_of_ground(tmj):
    tiles = tmj["tilesets"][0]["tiles"]
    used = {properties(tiles[gid - 1])["name"] for gid in tmj["layers"][1]["data"] if gid}
    slopes = {name for name in used if name.startswith("slope_")}
    assert {"slope_up", "slope_down", "slope_down_high", "slope_down_low"} <= slopes
    assert any(name.startswith("plank_") for name in used) and any(name.startswith("stone_") for name in used)


def test_objects_are_known_and_inside(tmj):
    assert {thing["type"] for thing in tmj["layers"][2]["objects"]} == TYPES
    for thing in tmj["layers"][2]["objects"]:
        assert 0 <= thing["x"] and thing["x"] + thing["width"] <= tmj["width"] * TILE
        assert 0 <= thing["y"] and thing["y"] + thing["height"] <= tmj["height"] * TILE
    assert len(things(tmj, "hero_start")) == 1 and len(things(tmj, "goal")) == 1
    assert things(tmj, "hero_start")[0]["x"] < things(tmj, "goal")[0]["x"]
    assert len(things(tmj, "coin")) >= 40


@pytest.mark.parametrize("kind", ["hero_start", "spring", "walker", "crate", "goal", "checkpoint"])
def test_what_stands_has_ground_under_it(tmj, kind):
    for thing in things(tmj, kind):
        bottom = thing["y"] + thing["height"]
        assert bottom % TILE == 0
        middle = int(thing["x"] + thing["width"] / 2) // TILE
        stacked = kind == "crate" and any(other["y"] == bottom and other["x"] <= middle * TILE < other["x"] + other["width"]
                                          for other in things(tmj, "crate"))
        assert stacked or kind_at(tmj, middle, bottom // TILE) == "solid", f"{kind} {thing['id']} hangs in the air"
        assert kind_at(tmj, middle, bottom // TILE - 1) is None, f"{kind} {thing['id']} is in the ground"


def test_platforms_dock_flush_and_walkers_have_room(tmj):
    for platform in things(tmj, "platform"):
        values = properties(platform)
        assert values["period"] > 0
        left = kind_at(tmj, platform["x"] // TILE - 1, platform["y"] // TILE)
        right = kind_at(tmj, (values["to_x"] + platform["width"]) // TILE, values["to_y"] // TILE)
        assert left == right == "solid"
    assert all(properties(walker)["range"] >= TILE for walker in things(tmj, "walker"))
    assert all(properties(sign)["text"] for sign in things(tmj, "sign"))


def test_level_text_is_checked():
    with pytest.raises(ValueError, match="row 2 has 2 tiles"):
        Map("[map]\n...\n..\n", "x.txt")
    with pytest.raises(ValueError, match=r"1 'P' on the map, 0 in \[platforms\]"):
        Map("[map]\nP\n", "x.txt")
    with pytest.raises(ValueError, match="x y seconds"):
        Map("[map]\nP\n[platforms]\n3 four 5\n", "x.txt")
    with pytest.raises(ValueError, match="before the first"):
        Map("...\n", "x.txt")


def test_walkers_stop_before_edges_and_walls():
    level = Map("[map]\n........\n..w....#\n########\n", "x.txt")
    assert walking_range(level, 2, 1) == 2 * TILE   # outside the map counts as ground
    level = Map("[map]\n#..w....\n####.###\n", "x.txt")
    assert walking_range(level, 3, 0) == 0
