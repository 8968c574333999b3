"""Convert assets/levels/platformer.txt, one letter per tile, to a Tiled map (.tmj) with the tileset embedded.

Layers, back to front: "wall", "decor", "solid" (tiles), "cover" (tiles that hide rooms until the hero is inside), then
"things" and "bot hints" (objects). Objects are rectangles in px, given by their top left corner (x, y). A moving
platform has to_x, to_y (its corner at the far end [px]) and period (time there and back [s]). Belts have speed [px/s].
Zones have the act that determines their look.
"""

import itertools
import json

from assets import FOLDER
from assets.platformer.decoration import TILE
from assets.platformer.level_text import Map
from assets.platformer.level_things import hints, objects
from assets.platformer.level_tiles import cover_names, decor_names, tile_name
from assets.platformer.tiles import tile_table

SHEET_WIDTH = 256  # [px] as craft/atlas.py packs the sheet "tiles", without gaps


def _properties(values):
    kinds = {str: "string", float: "float", int: "int"}
    return [{"name": name, "type": kinds[type(value)], "value": value} for name, value in values.items()]


def tileset(table):
    """Return the tileset to embed in the map, a dict: for each tile its position in images/tiles.png and its kind.

    table: result of tile_table().
    """
    columns = SHEET_WIDTH // TILE
    rows = -(-len(table) // columns)
    return {
        "firstgid": 1,
        "name": "tiles",
        "image": "../images/tiles.png",
        "imagewidth": SHEET_WIDTH,
        "imageheight": rows * TILE,
        "tilewidth": TILE,
        "tileheight": TILE,
        "margin": 0,
        "spacing": 0,
        "columns": columns,
        "tilecount": len(table),
        "tiles": [
            {"id": i, "properties": _properties({"name": name} | table[name][1])} for i, name in enumerate(table)
        ],
    }


def tiled_map(level):
    """Return the whole map as Tiled's JSON structure, a dict. level: the level, a level_text.Map."""
    table = tile_table()
    groups = _object_layers(level)
    layers = _tile_layers(level, table) + groups
    return {
        "type": "map",
        "version": "1.10",
        "tiledversion": "1.10.2",
        "orientation": "orthogonal",
        "renderorder": "right-down",
        "infinite": False,
        "compressionlevel": -1,
        "width": level.width,
        "height": level.height,
        "tilewidth": TILE,
        "tileheight": TILE,
        "nextlayerid": len(layers) + 1,
        "nextobjectid": 1 + sum(len(group["objects"]) for group in groups),
        "tilesets": [tileset(table)],
        "layers": [{"id": i, **layer} for i, layer in enumerate(layers, 1)],
    }


def _tile_layers(level, table):
    """Return the tile layers, back to front, as Tiled's JSON structure, a list.

    table: all tiles in the order of the tileset. They are numbered from 1; 0 means no tile. level: the level, a
    level_text.Map.
    """
    numbers = {name: i for i, name in enumerate(table, 1)}
    cells = [(x, y) for y in range(level.height) for x in range(level.width)]
    decor, walls = decor_names(level)
    pictures = {
        "wall": walls,
        "decor": decor,
        "solid": {place: tile_name(level, *place) for place in cells},
        "cover": cover_names(level),
    }
    size = {"width": level.width, "height": level.height, "x": 0, "y": 0, "opacity": 1, "visible": True}
    # A tree may extend past the map or have clear corners without tiles: neither is in the data.
    return [
        {"name": name, "type": "tilelayer", **size, "data": [numbers.get(names.get(place), 0) for place in cells]}
        for name, names in pictures.items()
    ]


def _object_layers(level):
    """Return the object layers as Tiled's JSON structure, a list. Objects are numbered from 1 across both layers.

    level: the level, a level_text.Map.
    """
    numbers, groups = itertools.count(1), []
    for name, rows in (("things", objects(level)), ("bot hints", hints(level))):
        things = [
            {
                "id": next(numbers),
                "name": "",
                "type": kind,
                "x": x,
                "y": y,
                "width": width,
                "height": height,
                "rotation": 0,
                "visible": True,
                "properties": _properties(properties),
            }
            for kind, x, y, width, height, properties in rows
        ]
        groups.append(
            {
                "name": name,
                "type": "objectgroup",
                "draworder": "index",
                "opacity": 1,
                "visible": True,
                "x": 0,
                "y": 0,
                "objects": things,
            }
        )
    return groups


def to_tmj(structure):
    """Return the result of tiled_map() as bytes, with a line per map row, tile and object, so that changes give small
    diffs.
    """
    text = json.dumps(structure, ensure_ascii=False)
    for layer in structure["layers"]:
        if "data" in layer:
            flat = json.dumps(layer["data"])
            width, data = layer["width"], layer["data"]
            rows = [json.dumps(data[i : i + width])[1:-1] for i in range(0, len(data), width)]
            text = text.replace(flat, "[\n" + ",\n".join(rows) + "]", 1)
    text = text.replace('}, {"id": ', '},\n{"id": ').replace('"layers": [', '\n"layers": [\n')
    return (text.replace('"tiles": [', '"tiles": [\n').replace('"objects": [', '"objects": [\n') + "\n").encode()


def level_files():
    """Return {path relative to assets/: bytes} of all levels."""
    path = FOLDER / "levels" / "platformer.txt"
    level = Map(path.read_text(encoding="utf-8"), path.name)
    return {"levels/platformer.tmj": to_tmj(tiled_map(level))}
