"""Tiled levels: the supported contents, and the message for each kind of damage."""

import base64
import copy
import json
import struct
import zlib

import pytest

from game.drawing.tilemap import load_tilemap
from game.errors import FileError

LEVEL = {
    "type": "map",
    "orientation": "orthogonal",
    "infinite": False,
    "width": 3,
    "height": 2,
    "tilewidth": 16,
    "tileheight": 16,
    "tilesets": [
        {
            "firstgid": 1,
            "tilecount": 8,
            "columns": 4,
            "image": "tiles.png",
            "tiles": [
                {"id": 0, "properties": [{"name": "kind", "value": "solid"}]},
                {"id": 1, "properties": [{"name": "kind", "value": "one_way"}]},
                {
                    "id": 2,
                    "properties": [
                        {"name": "kind", "value": "slope"},
                        {"name": "left", "value": 0},
                        {"name": "right", "value": 0.5},
                    ],
                },
                {"id": 3, "properties": [{"name": "kind", "value": "spikes"}]},
            ],
        }
    ],
    "layers": [
        {"type": "tilelayer", "name": "solid", "data": [0, 2, 3, 1, 1, 4 | 0x80000000]},
        {
            "type": "objectgroup",
            "name": "things",
            "objects": [
                {
                    "type": "coin",
                    "name": "",
                    "x": 8,
                    "y": 4.5,
                    "width": 0,
                    "height": 0,
                    "properties": [{"name": "worth", "value": 3}],
                },
                {"class": "goal", "x": 1, "y": 2, "width": 3, "height": 4},
            ],
        },
    ],
}


def load(tmp_path, level):
    path = tmp_path / "level.tmj"
    path.write_text(level if isinstance(level, str) else json.dumps(level))
    return load_tilemap(path)


def test_tiles_kinds_and_things(tmp_path):
    level = load(tmp_path, LEVEL)
    grid = level.grid("solid")
    assert grid.solid.tolist() == [[False, False, False], [True, True, False]]
    assert grid.one_way.tolist()[0] == [False, True, False]
    assert grid.slopes[0, 2].tolist() == [0.0, 0.5]
    assert level.cells("spikes") == [(2, 1)]
    assert level.flips["solid"][1, 2] == 0x80000000
    (coin,) = level.things_of("coin")
    assert (coin.x, coin.y, coin.properties) == (8, 4.5, {"worth": 3})
    assert level.one("goal").width == 3
    assert level.size == (48, 32)


@pytest.mark.parametrize("compression", ["", "zlib"])
def test_base64_layers(tmp_path, compression):
    level = copy.deepcopy(LEVEL)
    raw = struct.pack("<6I", *level["layers"][0]["data"])
    packed = zlib.compress(raw) if compression else raw
    level["layers"][0] |= {"encoding": "base64", "compression": compression, "data": base64.b64encode(packed).decode()}
    assert load(tmp_path, level).grid().solid.sum() == 2


DAMAGE = [
    (lambda m: m.update(width=0), "map.width", "1.."),
    (lambda m: m.update(width=10**9), "map.width", "1.."),
    (lambda m: m.update(infinite=True), "infinite", "untick"),
    (lambda m: m.update(orientation="isometric"), "orientation", "orthogonal"),
    (lambda m: m.update(tileheight=8), "tileheight", "square"),
    (lambda m: m.pop("layers"), "map.layers", "missing"),
    (lambda m: m.update(tilesets=[{"firstgid": 1, "source": "a.tsj"}]), "tilesets[0].source", "embed"),
    (lambda m: m["layers"][0]["data"].pop(), "layers[0].data", "must hold 6"),
    (lambda m: m["layers"][0]["data"].__setitem__(4, 77), "layers[0].data[4]", "column 1 row 1"),
    (lambda m: m["layers"][0]["data"].__setitem__(4, "x"), "layers[0].data[4]", "tile number"),
    (lambda m: m["layers"][0].update(encoding="base64", data="%%%"), "layers[0].data", "unpacked"),
    (lambda m: m["layers"][0].update(encoding="base64", compression="zlib", data="AAAA"), "layers[0].data", "unpacked"),
    (lambda m: m["layers"][1]["objects"][0].update(x="left"), "layers[1].objects[0].x", "number"),
    (lambda m: m["tilesets"][0]["tiles"][0]["properties"][0].update(value="sold"), "tiles[0].kind", "one of"),
    (lambda m: m["tilesets"][0]["tiles"][2]["properties"][2].update(value=3), "tiles[2].right", "0..1"),
]


@pytest.mark.parametrize("spoil, place, reason", DAMAGE)
def test_damage_is_named(tmp_path, spoil, place, reason):
    level = copy.deepcopy(LEVEL)
    spoil(level)
    with pytest.raises(FileError) as caught:
        load(tmp_path, level)
    message = str(caught.value)
    assert "level.tmj" in message and place in message and reason in message


@pytest.mark.parametrize("text, place", [('{\n "width": ,', "line 2"), ("[]", "map"), ("", "line 1")])
def test_not_a_map(tmp_path, text, place):
    with pytest.raises(FileError, match=place):
        load(tmp_path, text)


def test_a_missing_file(tmp_path):
    with pytest.raises(FileError, match="No such file"):
        load_tilemap(tmp_path / "none.tmj")


def test_missing_and_double_objects_are_named(tmp_path):
    with pytest.raises(FileError, match="one hero_start, hold 0"):
        load(tmp_path, LEVEL).one("hero_start")
