"""A level with a wrong type for properties, tiles or compression gives a message, not a TypeError."""

import base64
import copy
import json
import struct
import zlib

import pytest

from game.drawing.tilemap import load_tilemap
from game.errors import FileError
from tests.game.test_tilemap import LEVEL

ODD = (None, True, -1, 0, 10**30, 0.5, float("nan"), "", "odd", [], [None], [[]], {}, {"name": []})


def places(value, place=()):
    """Yield the positions of all values in a nested structure, as tuples of keys and indices from the top."""
    yield place
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inside:
        yield from places(each, (*place, key))


FULL = copy.deepcopy(LEVEL)
TILES = base64.b64encode(zlib.compress(struct.pack("<6I", *LEVEL["layers"][0]["data"]))).decode()
FULL["layers"][0] |= {"encoding": "base64", "compression": "zlib", "data": TILES}
FULL["layers"].append({"type": "tilelayer", "name": "more", "encoding": "csv", "data": [0] * 6})
FULL["properties"] = [{"name": "title", "value": "x"}]


def test_it_can_be_read(tmp_path):
    path = tmp_path / "level.tmj"
    path.write_text(json.dumps(FULL))
    assert load_tilemap(path).size == (48, 32)


@pytest.mark.parametrize(
    "place", [place for place in places(FULL) if place], ids=lambda place: ".".join(map(str, place))
)
def test_whatever_stands_there_it_is_read_or_refused(tmp_path, place):
    path = tmp_path / "level.tmj"
    for odd in ODD:
        level = copy.deepcopy(FULL)
        inside = level
        for key in place[:-1]:
            inside = inside[key]
        inside[place[-1]] = odd
        path.write_text(json.dumps(level))
        try:
            load_tilemap(path)
        except FileError as error:
            assert "level.tmj" in str(error)
