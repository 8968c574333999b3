"""Groups, offsets and tile objects of Tiled levels, and the keys that are refused by name."""

import copy
import json

import numpy as np
import pytest

from game.drawing.tilemap import load_tilemap
from game.errors import FileError
from tests.game.test_tilemap import LEVEL

SOLID, THINGS = LEVEL["layers"][0], LEVEL["layers"][1]


def loaded(tmp_path, **changes):
    """Load LEVEL with some values of the map replaced."""
    path = tmp_path / "level.tmj"
    path.write_text(json.dumps({**copy.deepcopy(LEVEL), **changes}))
    return load_tilemap(path)


def group(*layers, **keys):
    return {"type": "group", "name": "group", "layers": list(layers), **keys}


def places(tilemap):
    return [(thing.x, thing.y) for thing in tilemap.things]


@pytest.mark.parametrize("layers, moved", [
    ([SOLID, THINGS], (0, 0)),
    ([group(SOLID, THINGS)], (0, 0)),
    ([group(group(SOLID), group(THINGS, offsetx=3.5), offsety=-2)], (3.5, -2)),
    ([SOLID, {**THINGS, "offsetx": 5, "offsety": -0.25}], (5, -0.25)),
    ([SOLID, group({**THINGS, "offsetx": 1}, offsetx=10, offsety=20)], (11, 20)),
])  # fmt: skip
def test_objects_move_with_their_layers_and_groups(tmp_path, layers, moved):
    before = places(loaded(tmp_path))
    if layers[0].get("offsety"):
        layers[0]["layers"][0]["offsety"] = 2  # the tiles stay where they are
    after = loaded(tmp_path, layers=layers)
    assert places(after) == [(x + moved[0], y + moved[1]) for x, y in before]
    assert (after.layers["solid"] == loaded(tmp_path).layers["solid"]).all()


@pytest.mark.parametrize(
    "inner, outer", [((16, 0), (0, 0)), ((0, 0), (16, 0)), ((24, 8), (-8, -8)), ((32, 16), (-16, -16))]
)
def test_tiles_move_by_whole_tiles(tmp_path, inner, outer):
    data = [1, 4 | 0x80000000, 0, 3, 0, 0]
    layer = {**SOLID, "data": data, "offsetx": inner[0], "offsety": inner[1]}
    tilemap = loaded(tmp_path, layers=[group(layer, offsetx=outer[0], offsety=outer[1])])
    assert tilemap.layers["solid"].tolist() == [[-1, 0, 3], [-1, 2, -1]]
    assert tilemap.flips["solid"].astype(np.int64).tolist() == [[0, 0, 0x80000000], [0, 0, 0]]
    assert tilemap.grid().solid.tolist() == [[False, True, False], [False, False, False]]


@pytest.mark.parametrize("gid, y", [(None, 40.0), (1, 28.0), (2 | 0x80000000, 28.0)])
def test_the_origin_of_a_tile_object_is_its_bottom_left(tmp_path, gid, y):
    thing = {"type": "crate", "x": 8, "y": 40, "width": 16, "height": 12, **({"gid": gid} if gid else {})}
    tilemap = loaded(tmp_path, layers=[SOLID, {**THINGS, "objects": [thing], "offsety": 100}])
    (found,) = tilemap.things
    assert (found.x, found.y, found.width, found.height) == (8, y + 100, 16, 12)


LAYER = [
    ("visible", False), ("opacity", 0.5), ("opacity", 0), ("parallaxx", 0.5), ("parallaxy", 2), ("tintcolor", "#f00"),
    ("visible", None), ("opacity", "1"), ("x", 3), ("type", "imagelayer"),
]  # fmt: skip


@pytest.mark.parametrize("key, value", LAYER)
@pytest.mark.parametrize("place", ["layers[1]", "layers[0]", "layers[0].layers[0]"])
def test_keys_of_layers_that_move_or_hide_are_refused_by_name(tmp_path, key, value, place):
    layers = copy.deepcopy([group(SOLID), THINGS])
    chosen = {"layers[1]": layers[1], "layers[0]": layers[0], "layers[0].layers[0]": layers[0]["layers"][0]}[place]
    chosen[key] = value
    with pytest.raises(FileError) as error:
        loaded(tmp_path, layers=layers)
    assert f"{place}.{key}" in str(error.value) and "must be" in str(error.value)


@pytest.mark.parametrize(
    "key, value", [("rotation", 90), ("rotation", -0.5), ("visible", False), ("opacity", 0.5), ("template", "a.tx")]
)
def test_keys_of_objects_that_turn_or_hide_are_refused_by_name(tmp_path, key, value):
    layers = copy.deepcopy([SOLID, THINGS])
    layers[1]["objects"][1][key] = value
    with pytest.raises(FileError, match=rf"layers\[1\].objects\[1\].{key}"):
        loaded(tmp_path, layers=layers)


@pytest.mark.parametrize("key, value", [("tileoffset", {"x": 0, "y": 4}), ("margin", 1), ("spacing", 2)])
def test_keys_of_the_tileset_that_move_tiles_are_refused_by_name(tmp_path, key, value):
    with pytest.raises(FileError, match=rf"tilesets\[0\].{key}"):
        loaded(tmp_path, tilesets=[{**LEVEL["tilesets"][0], key: value}])


def test_other_alignments_of_tile_objects_are_refused(tmp_path):
    tilesets = [{**LEVEL["tilesets"][0], "objectalignment": "center"}]
    assert places(loaded(tmp_path, tilesets=tilesets)) == places(loaded(tmp_path)), "there is no tile object"
    things = {**THINGS, "objects": [{"gid": 1, "x": 0, "y": 16, "width": 16, "height": 16}]}
    with pytest.raises(FileError, match=r"tilesets\[0\].objectalignment"):
        loaded(tmp_path, tilesets=tilesets, layers=[SOLID, things])


@pytest.mark.parametrize("keys, reason", [
    ({"offsetx": 8}, r"layers\[0\].offsetx.*multiple of the tile size 16.*got 8"),
    ({"offsety": 1.5}, r"layers\[0\].offsety.*multiple"),
    ({"offsety": -16}, r"layers\[0\].*moves the tile at column 1 row 0 out of the map"),
    ({"offsetx": "3"}, r"layers\[0\].offsetx.*must be a number"),
])  # fmt: skip
def test_offsets_that_tiles_cannot_have(tmp_path, keys, reason):
    with pytest.raises(FileError, match=reason):
        loaded(tmp_path, layers=[{**SOLID, **keys}])


def test_groups_without_end_are_refused(tmp_path):
    layers = [SOLID]
    for _ in range(60):
        layers = [group(*layers)]
    with pytest.raises(FileError, match="20 deep"):
        loaded(tmp_path, layers=layers)
    with pytest.raises(FileError, match=r"layers\[0\].layers"):
        loaded(tmp_path, layers=[{"type": "group", "layers": 5}])


@pytest.mark.parametrize("name", ["tilewidth", "tileheight"])
@pytest.mark.parametrize("value", [8, 17, 32, "16", None])
def test_a_tileset_of_another_tile_size_is_refused(tmp_path, name, value):
    tileset = LEVEL["tilesets"][0]
    loaded(tmp_path, tilesets=[{**tileset, name: LEVEL[name]}])
    with pytest.raises(FileError, match=rf"tilesets\[0\]\.{name}.*{LEVEL[name]}"):
        loaded(tmp_path, tilesets=[{**tileset, name: value}])
