"""Levels made with Tiled (.tmj): tile layers, tile properties, objects.

An error names the file, the place and the reason.

The reader accepts finite orthogonal maps with one embedded tileset. Layer data are CSV or base64 (plain, zlib, gzip).
Layers may be in groups. Layers and groups may have offsets. The offset of a tile layer must be a whole number of tiles.

The reader rejects infinite maps, external tilesets and other encodings. It also rejects keys that move or hide drawn
objects (parallax, opacity, tint, rotation ...). Packed data are unpacked only up to the size that the map can have.
"""

import base64
import zlib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from game.errors import FileError
from game.files.json_file import read_json
from game.files.pictures import picture_of, png_size
from game.places import IMAGES
from physics import TileGrid

FLIPS = 0xF0000000  # the top bits of a tile number hold its mirroring
FLIP_X, FLIP_Y, FLIP_DIAGONAL = 0x80000000, 0x40000000, 0x20000000
LARGEST = 10_000  # tiles along a side; a larger number is a damaged file
MOST_TILES = 2**22  # in all layers together: each takes 40 bytes while it is read, 16 from then on
LARGEST_PICTURE = 4096  # [px] of a tileset's picture each way: 64 MB
PACKINGS = {"zlib": zlib.MAX_WBITS, "gzip": zlib.MAX_WBITS | 16}  # compression -> zlib window bits: the header
OFFSETS = ("offsetx", "offsety")  # [px] of a layer or a group
DEEPEST = 20  # groups within groups
# Keys that move, turn or hide what is drawn. They are not supported: only these values are accepted.
LAYER_DEFAULTS = {"visible": True, "opacity": 1, "parallaxx": 1, "parallaxy": 1, "tintcolor": None, "x": 0, "y": 0}
OBJECT_DEFAULTS = {"visible": True, "opacity": 1, "rotation": 0, "template": None}
TILESET_DEFAULTS = {"tileoffset": None, "margin": 0, "spacing": 0}
KINDS = ("solid", "one_way", "slope", "spikes", "decor")


@dataclass(frozen=True)
class Thing:
    """An object of the map: kind, name, rectangle in world px, and properties.

    place: its place in the file, as text.
    """

    kind: str
    name: str
    x: float
    y: float
    width: float
    height: float
    properties: dict = field(default_factory=dict)
    place: str = ""


@dataclass(frozen=True)
class TileMap:
    """A level. layers[name]: (rows, columns) array of tile numbers, -1 for an empty tile.

    tiles[number]: properties of the tile with this number.
    """

    path: Path
    columns: int
    rows: int
    tile_size: int
    layers: dict
    flips: dict  # layer name -> (rows, columns) flip bits
    tiles: dict
    image: str  # the tileset's picture, relative to the map
    image_columns: int
    things: tuple
    properties: dict

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in world pixels."""
        return self.columns * self.tile_size, self.rows * self.tile_size

    def kind_of(self, number: int) -> str:
        """Return the kind of the tile `number`, one of KINDS; "decor" if the tileset names no kind."""
        return self.tiles.get(int(number), {}).get("kind", "decor")

    def grid(self, layer: str = "solid") -> TileGrid:
        """Return the layer `layer` as a physics.TileGrid, with its one-way tiles and slopes."""
        numbers = self._layer(layer)
        solid, one_way = np.zeros(numbers.shape, bool), np.zeros(numbers.shape, bool)
        slopes = np.zeros((*numbers.shape, 2))
        for number in np.unique(numbers[numbers >= 0]).tolist():
            here, kind = numbers == number, self.kind_of(number)
            solid |= here & (kind == "solid")
            one_way |= here & (kind == "one_way")
            if kind == "slope":
                sides, flips = (
                    (self.tiles[number].get("left", 0.0), self.tiles[number].get("right", 0.0)),
                    self._flips(layer),
                )
                slopes[here] = sides
                slopes[here & (flips & FLIP_X > 0)] = sides[::-1]
                self._refuse_turned(layer, here & (flips & (FLIP_Y | FLIP_DIAGONAL) > 0))
        return TileGrid(solid, self.tile_size, one_way, slopes)

    def cells(self, kind: str, layer: str = "solid") -> list[tuple[int, int]]:
        """Return the (column, row) of every tile of the kind `kind` in a layer, for example of all spikes."""
        numbers = self._layer(layer)
        matching = [number for number in np.unique(numbers).tolist() if number >= 0 and self.kind_of(number) == kind]
        return [(int(c), int(r)) for r, c in np.argwhere(np.isin(numbers, matching))]

    def things_of(self, kind: str) -> list[Thing]:
        """Return the map objects of the kind `kind`, in the order of the file."""
        return [thing for thing in self.things if thing.kind == kind]

    def one(self, kind: str) -> Thing:
        """Return the only map object of the kind `kind`. Raises FileError if there is none or more than one."""
        found = self.things_of(kind)
        if len(found) != 1:
            raise FileError(self.path, "objects", f"must hold one {kind}, hold {len(found)}")
        return found[0]

    def _flips(self, layer):
        return self.flips.get(layer, np.zeros((self.rows, self.columns), int))

    def _refuse_turned(self, layer, turned):
        """Raise FileError if a slope is rotated or flipped vertically.

        turned: (rows, columns) bool, True for such a slope. A slope may only be flipped horizontally. The collision
        shape of any other slope would not match its picture.
        """
        for row, column in np.argwhere(turned)[:1].tolist():
            raise FileError(
                self.path,
                f"layer {layer}",
                f"the slope at column {column} row {row} is turned or upside down; mirror slopes left and right only",
            )

    def _layer(self, name):
        if name not in self.layers:
            raise FileError(self.path, "layers", f"no tile layer {name!r}; there are {', '.join(self.layers)}")
        return self.layers[name]


def load_tilemap(path: Path, largest: tuple[int, int] = (LARGEST, LARGEST)) -> TileMap:
    """Return the TileMap in a .tmj file. Raises FileError, which names the file, the place and the reason.

    largest: greatest allowed (columns, rows).
    """
    data = read_json(path)
    reader = _Reader(path, largest)
    return reader.read(data)


def map_picture(tilemap: TileMap) -> Path:
    """Return the path of the tileset's picture: a file in the map's folder, or one of the game's own pictures.

    Raises FileError if there is no such file, or if the picture is too small for the map's tiles.
    """
    path = picture_of(tilemap.path, "tilesets[0].image", tilemap.image, IMAGES)
    width, height = png_size(path, LARGEST_PICTURE)
    most = max((int(layer.max()) for layer in tilemap.layers.values() if layer.size), default=-1)
    columns, size = tilemap.image_columns, tilemap.tile_size
    if most >= height // size * columns or columns * size > width:
        raise FileError(tilemap.path, "tilesets[0].image", f"{tilemap.image} is too small for tile {most}")
    return path


def unpacked(packed: bytes, packing: int, most: int) -> bytes:
    """Return unpacked data, at most `most` + 1 bytes. The caller must reject a result of more than `most` bytes.

    packing: one of PACKINGS. Bytes after the packed data count as additional data. Raises zlib.error for damaged data,
    and ValueError for truncated data.
    """
    reader = zlib.decompressobj(packing)
    content = reader.decompress(packed, most + 1)
    if len(content) <= most and not reader.eof:
        raise ValueError("it is cut off")
    return content + reader.unused_data[:1] if len(content) == most else content


class _Reader:
    """Reader of a map file that checks each value. fail() raises FileError with a place in the file and a reason."""

    def __init__(self, path, largest):
        self.path, self.largest = Path(path), largest

    def fail(self, place, reason):
        raise FileError(self.path, place, reason)

    def read(self, data):
        if not isinstance(data, dict):
            self.fail("map", "is not an object")
        if data.get("infinite"):
            self.fail("infinite", "infinite maps are not read; untick Map > Infinite in Tiled")
        if data.get("orientation", "orthogonal") != "orthogonal":
            self.fail("orientation", f"must be orthogonal (got {data['orientation']!r:.60})")
        columns = self.whole(data, "map", "width", self.largest[0])
        rows = self.whole(data, "map", "height", self.largest[1])
        size = self.whole(data, "map", "tilewidth", 1024)
        if self.whole(data, "map", "tileheight", 1024) != size:
            self.fail("tileheight", "tiles must be square")
        first, count, tileset = self.tileset(data)
        layers, flips, things, held = {}, {}, [], 0
        for place, name, layer, offset in self.flat_layers(data, "map", "", (0.0, 0.0)):
            if layer["type"] == "tilelayer":
                held += columns * rows
                if held > MOST_TILES:
                    self.fail(place, f"the layers up to this one hold {held} tiles; at most {MOST_TILES} are read")
                found = self.tiles(layer, place, (rows, columns), first, count)
                layers[name], flips[name] = self.shifted(found, place, offset, size)
            else:
                things += self.things(layer, place, offset, tileset)
        return TileMap(
            self.path,
            columns,
            rows,
            size,
            layers,
            flips,
            self.tile_properties(tileset),
            str(tileset.get("image", "")),
            self.whole(tileset, "tilesets[0]", "columns", LARGEST),
            tuple(things),
            self.properties(data, "map"),
        )

    def flat_layers(self, data, place, prefix, offset, depth=0):
        """Yield (place, name, layer, offset [px]) of all tile and object layers in order, including layers in groups.

        data: the map, or a group of layers; place: its place in the file, as text; offset: its offset (x, y) [px].
        prefix: text with which the places of its layers begin, such as "layers[2]."; depth: number of groups that
        contain `data`.
        """
        for index, layer in enumerate(self.listing(data, place, "layers")):
            here = f"{prefix}layers[{index}]"
            if not isinstance(layer, dict):
                self.fail(here, "is not an object")
            self.refuse(layer, here, LAYER_DEFAULTS)
            kind = layer.get("type")
            if kind not in ("tilelayer", "objectgroup", "group"):
                self.fail(f"{here}.type", f"must be tilelayer, objectgroup or group (got {kind!r:.60})")
            x, y = (each + self.number(layer, here, name) for each, name in zip(offset, OFFSETS, strict=True))
            if kind != "group":
                yield here, str(layer.get("name", index)), layer, (x, y)
            elif depth == DEEPEST:
                self.fail(here, f"groups may hold groups {DEEPEST} deep")
            else:
                yield from self.flat_layers(layer, here, f"{here}.", (x, y), depth + 1)

    def refuse(self, data, place, defaults):
        """Raise FileError if a key in `data` does not have its default value.

        The keys are those that move, rotate or hide drawn objects. place: place of `data` in the file, as text;
        defaults: {key: default value}.
        """
        for name, default in defaults.items():
            value = data.get(name, default)
            if type(value) not in (type(default), int, float) or value != default:
                usual = "absent" if default is None else repr(default).lower()
                self.fail(f"{place}.{name}", f"is not supported: must be {usual} (got {value!r:.60})")

    def shifted(self, found, place, offset, size):
        """Return the tiles of a layer, moved by the layer's `offset` (x, y) [px], as (tile numbers, flips).

        found: the unmoved tiles, also (tile numbers, flips), two arrays [row, column]. size: side of a tile [px];
        place: place of the layer in the file, as text. Raises FileError if the offset is not a whole number of tiles,
        or if it moves a tile out of the map.
        """
        if offset == (0.0, 0.0):
            return found
        for name, each in zip(OFFSETS, offset, strict=True):
            if each % size:
                self.fail(
                    f"{place}.{name}", f"must be a multiple of the tile size {size}, with its groups (got {each:g})"
                )
        columns, rows = (int(each // size) for each in offset)
        tiles, flips = found
        height, width = tiles.shape
        at_row, at_column = np.nonzero(tiles >= 0)
        to_row, to_column = at_row + rows, at_column + columns
        out = np.flatnonzero((to_row < 0) | (to_row >= height) | (to_column < 0) | (to_column >= width))
        if len(out):
            column, row = int(at_column[out[0]]), int(at_row[out[0]])
            self.fail(place, f"its offset moves the tile at column {column} row {row} out of the map")
        moved, turned = np.full_like(tiles, -1), np.zeros_like(flips)
        moved[to_row, to_column], turned[to_row, to_column] = tiles[at_row, at_column], flips[at_row, at_column]
        return moved, turned

    def whole(self, data, place, name, largest):
        value = data.get(name)
        if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= largest:
            self.fail(f"{place}.{name}", f"must be a whole number 1..{largest} (got {value!r:.60})")
        return value

    def number(self, data, place, name):
        value = data.get(name, 0.0)
        if not isinstance(value, (int, float)) or isinstance(value, bool) or value != value or abs(value) > 1e9:
            self.fail(f"{place}.{name}", f"must be a number (got {value!r:.60})")
        return float(value)

    def listing(self, data, place, name, default=None):
        value = data.get(name, default)
        if not isinstance(value, list):
            self.fail(f"{place}.{name}", "is missing or not a list")
        return value

    def tileset(self, data):
        tilesets = self.listing(data, "map", "tilesets")
        if len(tilesets) != 1 or not isinstance(tilesets[0], dict):
            self.fail("tilesets", f"must hold one tileset (holds {len(tilesets)})")
        if "source" in tilesets[0]:
            self.fail("tilesets[0].source", "the tileset is in a file of its own; embed it in Tiled (Embed Tileset)")
        self.refuse(tilesets[0], "tilesets[0]", TILESET_DEFAULTS)
        for name in ("tilewidth", "tileheight"):
            if tilesets[0].get(name, data[name]) != data[name]:
                value = tilesets[0][name]
                self.fail(f"tilesets[0].{name}", f"must be the {name} of the map, {data[name]} (got {value!r:.60})")
        first = self.whole(tilesets[0], "tilesets[0]", "firstgid", LARGEST)
        return first, self.whole(tilesets[0], "tilesets[0]", "tilecount", LARGEST), tilesets[0]

    def tiles(self, layer, place, shape, first, count):
        raw = self.layer_numbers(layer, place, shape[0] * shape[1])
        numbers, flip = raw & ~FLIPS & 0xFFFFFFFF, raw & FLIPS
        bad = np.flatnonzero((numbers != 0) & ((numbers < first) | (numbers >= first + count)))
        if len(bad):
            at = int(bad[0])
            self.fail(
                f"{place}.data[{at}]",
                f"tile {int(numbers[at])} is not in the tileset "
                f"({first}..{first + count - 1}), column {at % shape[1]} row {at // shape[1]}",
            )
        tiles = np.where(numbers == 0, -1, numbers - first)
        return tiles.reshape(shape), flip.reshape(shape)

    def layer_numbers(self, layer, place, wanted):
        data, encoding = layer.get("data"), layer.get("encoding", "csv")
        if encoding == "csv":
            if not isinstance(data, list):
                self.fail(f"{place}.data", "is missing or not a list")
            if len(data) != wanted:
                self.fail(f"{place}.data", f"must hold {wanted} tiles, holds {len(data)}")
            for at, value in enumerate(data):
                if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= 0xFFFFFFFF:
                    self.fail(f"{place}.data[{at}]", f"must be a tile number (got {value!r:.60})")
            return np.array(data, dtype=np.int64)
        if encoding != "base64":
            self.fail(f"{place}.encoding", f"must be csv or base64 (got {encoding!r:.60})")
        compression = layer.get("compression", "")
        if compression not in ("", *PACKINGS):
            cure = "choose it in Tiled: Map > Map Properties > Tile Layer Format"
            self.fail(f"{place}.compression", f"must be zlib, gzip or none (got {compression!r:.60}); {cure}")
        size = 4 * wanted
        try:
            packed = base64.b64decode(data, validate=True)
            content = unpacked(packed, PACKINGS[compression], size) if compression else packed
        except (TypeError, ValueError, zlib.error) as error:
            self.fail(f"{place}.data", f"cannot be unpacked: {error}")
        if len(content) != size:
            holds = f"{len(content)} bytes" if len(content) < size or not compression else "more"
            self.fail(f"{place}.data", f"must hold {wanted} tiles ({size} bytes), holds {holds}")
        return np.frombuffer(content, dtype="<u4").astype(np.int64)

    def properties(self, data, place):
        found = {}
        for index, entry in enumerate(self.listing(data, place, "properties", [])):
            if not isinstance(entry, dict) or not isinstance(entry.get("name"), str) or "value" not in entry:
                self.fail(f"{place}.properties[{index}]", "must have a name and a value")
            found[entry["name"]] = entry["value"]
        return found

    def tile_properties(self, tileset):
        found = {}
        for index, tile in enumerate(self.listing(tileset, "tilesets[0]", "tiles", [])):
            place = f"tilesets[0].tiles[{index}]"
            if not isinstance(tile, dict) or not isinstance(tile.get("id"), int):
                self.fail(place, "must have a whole number as id")
            found[tile["id"]] = properties = self.properties(tile, place)
            if properties.get("kind", "decor") not in KINDS:
                self.fail(f"{place}.kind", f"must be one of {', '.join(KINDS)} (got {properties['kind']!r:.60})")
            for side in ("left", "right"):
                if not 0.0 <= self.number(properties, place, side) <= 1.0:
                    self.fail(f"{place}.{side}", f"must be 0..1 (got {properties[side]!r:.60})")
        return found

    def things(self, layer, place, offset, tileset):
        """Return the objects of a layer as Things. The position of a Thing is its top left corner.

        In the file, the position of an object with a tile is its bottom left corner. place: place of the layer in the
        file, as text; offset: the layer's offset (x, y) [px].
        """
        found = []
        for index, entry in enumerate(self.listing(layer, place, "objects")):
            here = f"{place}.objects[{index}]"
            if not isinstance(entry, dict):
                self.fail(here, "is not an object")
            self.refuse(entry, here, OBJECT_DEFAULTS)
            kind = entry.get("type") or entry.get("class") or ""
            x, y, width, height = (self.number(entry, here, name) for name in ("x", "y", "width", "height"))
            if "gid" in entry:
                if tileset.get("objectalignment", "unspecified") not in ("unspecified", "bottomleft"):
                    self.fail(
                        "tilesets[0].objectalignment", "must be bottomleft: tile objects are placed by that corner"
                    )
                y -= height
            name, properties = str(entry.get("name", "")), self.properties(entry, here)
            found.append(Thing(str(kind), name, x + offset[0], y + offset[1], width, height, properties, here))
        return found
