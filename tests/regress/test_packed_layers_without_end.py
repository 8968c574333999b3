"""A layer of a level is unpacked only up to the bytes that its map can hold.

A level of 400 KB was once unpacked into 1.2 GB.
"""

import base64
import copy
import gzip
import tracemalloc
import zlib

import pytest

from game.drawing.tilemap import MOST_TILES, load_tilemap
from game.errors import FileError
from scenes.platformer.level import level_of
from tests.game.test_tilemap import LEVEL, load
from tests.scenes.test_platformer_maps import save, small

PACKERS = {"": bytes, "zlib": zlib.compress, "gzip": gzip.compress}
WANTED = 6 * 4  # bytes: the map has 3 x 2 tiles
MEMORY = 2_000_000  # bytes that reading may take beside the file's text


def packed(raw, compression, more=b""):
    """Return LEVEL with one layer made of these bytes. more: bytes that follow the packed ones in the file."""
    level = copy.deepcopy(LEVEL)
    data = PACKERS[compression](raw) + more
    level["layers"][0] |= {"encoding": "base64", "compression": compression, "data": base64.b64encode(data).decode()}
    return level


def peak_of(call):
    """Return (result or FileError of a call, greatest memory that it used [bytes])."""
    tracemalloc.start()
    try:
        try:
            found = call()
        except FileError as error:
            found = error
        return found, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("compression", PACKERS)
@pytest.mark.parametrize("size", [0, 1, 4, WANTED - 4, WANTED - 1, WANTED + 1, WANTED + 4, 100_000])
def test_any_other_number_of_bytes_is_refused(tmp_path, compression, size):
    with pytest.raises(FileError, match=r"layers\[0\].data: must hold 6 tiles \(24 bytes\)"):
        load(tmp_path, packed(bytes(size), compression))


@pytest.mark.parametrize("compression", PACKERS)
def test_as_many_as_the_map_holds_are_read(tmp_path, compression):
    level = load(tmp_path, packed(bytes(WANTED), compression))
    assert (level.layers["solid"] == -1).all() and level.layers["solid"].shape == (2, 3)


@pytest.mark.parametrize("compression", ["zlib", "gzip"])
@pytest.mark.parametrize("megabytes", [1, 10, 100])
def test_it_takes_no_more_memory_than_the_map(tmp_path, compression, megabytes):
    level = packed(bytes(megabytes << 20), compression)
    error, peak = peak_of(lambda: load(tmp_path, level))
    assert isinstance(error, FileError)
    assert peak < MEMORY + 12 * len(level["layers"][0]["data"])


@pytest.mark.parametrize("compression", ["zlib", "gzip"])
@pytest.mark.parametrize(
    "more",
    [
        pytest.param(b"\0", id="a byte"),
        pytest.param(b"more", id="text"),
        pytest.param(gzip.compress(bytes(WANTED), mtime=0), id="another gzip"),
        pytest.param(zlib.compress(bytes(WANTED)), id="another zlib"),
    ],
)
def test_bytes_behind_the_packed_ones_are_refused(tmp_path, compression, more):
    with pytest.raises(FileError, match="must hold 6 tiles"):
        load(tmp_path, packed(bytes(WANTED), compression, more))


@pytest.mark.parametrize("compression", ["zlib", "gzip"])
def test_a_layer_that_is_cut_off_anywhere_cannot_be_unpacked(tmp_path, compression):
    level = packed(bytes(range(WANTED)), compression)
    data = base64.b64decode(level["layers"][0]["data"])
    for kept in range(len(data)):
        level["layers"][0]["data"] = base64.b64encode(data[:kept]).decode()
        with pytest.raises(FileError, match=r"layers\[0\].data: cannot be unpacked"):
            load(tmp_path, level)


def test_zstd_is_refused_with_the_cure(tmp_path):
    level = packed(bytes(WANTED), "")
    level["layers"][0]["compression"] = "zstd"
    with pytest.raises(FileError, match="must be zlib, gzip or none .got 'zstd'.; .*Tile Layer Format"):
        load(tmp_path, level)


@pytest.mark.parametrize("width, height, layers", [(10_000, 10_000, 1), (2048, 2048, 2), (1024, 1024, 5)])
def test_no_more_tiles_in_all_layers_than_memory_is_there_for(tmp_path, width, height, layers):
    level = copy.deepcopy(LEVEL)
    data = base64.b64encode(zlib.compress(bytes(4 * width * height))).decode()
    level |= {"width": width, "height": height}
    layer = {"type": "tilelayer", "encoding": "base64", "compression": "zlib", "data": data}
    level["layers"] = [{**layer, "name": str(number % 4)} for number in range(layers)]
    error, peak = peak_of(lambda: load(tmp_path, level))
    assert f"at most {MOST_TILES} are read" in str(error)
    assert peak < MEMORY + 42 * MOST_TILES


def test_the_platformer_refuses_a_size_before_it_unpacks(tmp_path):
    level = small()
    width, height = 1024, 1024  # tiles; 256 high is the most that it plays
    data = base64.b64encode(zlib.compress(bytes(4 * width * height))).decode()
    level |= {"width": width, "height": height}
    level["layers"][0] = {
        "type": "tilelayer",
        "name": "solid",
        "encoding": "base64",
        "compression": "zlib",
        "data": data,
    }
    path = save(tmp_path, level)
    error, peak = peak_of(lambda: level_of(path))
    assert "map.height: must be a whole number 1..256 (got 1024)" in str(error)
    assert peak < MEMORY


def test_the_game_s_own_level_is_within_the_bounds():
    level = level_of().map
    assert level.columns * level.rows * len(level.layers) < MOST_TILES
    assert load_tilemap(level.path).size == level.size
