"""Turns assets/levels/platformer.txt, one letter per tile, into a Tiled map (.tmj) with the tileset embedded.

Layers, back to front: "decor" and "solid" (tiles), "cover" (tiles that hide rooms until somebody is inside), "things" and
"bot hints" (objects). Objects are rectangles in px, x and y the top left corner; moving platforms carry to_x, to_y (px, of
that corner at the far end) and period (s, there and back), belts speed (px/s), zones the act whose look they have.
"""

import itertools
import json

from assets import FOLDER
from assets.decoration import SCENERY, TILE
from assets.level_things import HANGING, STANDING, hints, objects
from assets.tiles import DEPTHS, NE, NW, SE, SW, E, N, S, W, reduced, tile_table

SHEET_WIDTH = 256  # [px] as assets/atlas.py packs the sheet "tiles", without gaps
GROUND = "#"
SOLIDS = {"#": "ground", "B": "stone", "R": "rock"}
DEEP = 4  # [tiles] below the surface the ground is dark
SLOPE_LETTERS = {
    "/": "slope_up",
    "\\": "slope_down",
    "1": "slope_up_low",
    "2": "slope_up_high",
    "3": "slope_down_high",
    "4": "slope_down_low",
}
SCENERY_LETTERS = {"T": "tree_green", "A": "tree_autumn", "Y": "tree_small", "b": "bush"}
DECOR_LETTERS = {
    "f": "fence",
    "m": "mushroom",
    "k": "rock",
    "*": "flower_1",
    "v": "vine",
    "!": "torch",
    "i": "stalactite",
    "j": "stalagmite",
    "x": "crystal_0",
    "g": "glowcap",
    "n": "banner",
    "L": "ladder",
}
WALLS = {",": "back_wall", ":": "back_cave"}  # behind these letters, and behind what stands or hangs among them
THINGS = "".join(STANDING) + "".join(HANGING) + "!ijxgnLCP-"
AROUND = ((N, 0, -1), (NE, 1, -1), (E, 1, 0), (SE, 1, 1), (S, 0, 1), (SW, -1, 1), (W, -1, 0), (NW, -1, -1))
GROWTH = (("tuft_0", 30), ("tuft_1", 55), ("flower_0", 62), ("flower_1", 67))  # running percent of free grass tiles
ACTS = ("meadow", "cave", "keep")


class Map:
    """The letters of a level and what its text says besides them."""

    def __init__(self, text, source):
        sections = _sections(text, source)
        self.rows = sections.get("map", [])
        self.platforms = [_platform(line, source) for line in sections.get("platforms", [])]
        self.signs = sections.get("signs", [])
        self.zones = [_zone(line, source) for line in sections.get("zones", [])]
        self.covers = [
            _numbers(line, 4, source, "a cover is 'x y width height'") for line in sections.get("covers", [])
        ]
        self.hints = [_hint(line, source) for line in sections.get("hints", [])]
        self.width, self.height = len(self.rows[0]) if self.rows else 0, len(self.rows)
        for number, row in enumerate(self.rows, 1):
            if len(row) != self.width:
                raise ValueError(f"{source}: map row {number} has {len(row)} tiles, the first has {self.width}")
        for letter, given, name in (("P", self.platforms, "[platforms]"), ("?", self.signs, "[signs]")):
            if len(self.places(letter)) != len(given):
                raise ValueError(f"{source}: {len(self.places(letter))} {letter!r} on the map, {len(given)} in {name}")
        self.rooms = {
            (x, y)
            for left, top, width, height in self.covers
            for x in range(left, left + width)
            for y in range(top, top + height)
            if self.at(x, y) not in SOLIDS
        }  # open tiles under covers

    def at(self, x, y):
        """The letter at a tile; outside counts as ground, so that edges of the map are drawn as inside."""
        return self.rows[y][x] if 0 <= x < self.width and 0 <= y < self.height else GROUND

    def buried(self, x, y):
        """The letter at a tile, covered rooms being filled."""
        return Filled(self, self.rooms).at(x, y)

    def places(self, letter):
        """Tiles (x, y) of a letter, left to right, top to bottom within a column."""
        return [(x, y) for x in range(self.width) for y in range(self.height) if self.rows[y][x] == letter]


def _sections(text, source):
    sections, lines = {}, None
    for line in text.splitlines():
        if line.startswith(";") or not line.strip():
            continue
        if line.startswith("["):
            lines = sections.setdefault(line.strip("[]"), [])
        elif lines is None:
            raise ValueError(f"{source}: text before the first [section]")
        else:
            lines.append(line.rstrip())
    return sections


def _numbers(line, count, source, rule):
    """So many whole numbers of a line, as a tuple."""
    try:
        values = tuple(int(word) for word in line.split())
    except ValueError:
        values = ()
    if len(values) != count:
        raise ValueError(f"{source}: {rule} (got {line!r})")
    return values


def _platform(line, source):
    try:
        to_x, to_y, period, width = line.split()
        return int(to_x) * TILE, int(to_y) * TILE, float(period), int(width) * TILE
    except ValueError:
        raise ValueError(f"{source}: a platform is 'x y seconds width' (got {line!r})") from None


def _zone(line, source):
    """(act, rectangle, rows that the camera may show or None), tiles."""
    act, _, rest = line.partition(" ")
    if act not in ACTS:
        raise ValueError(f"{source}: a zone is one of {', '.join(ACTS)} (got {line!r})")
    count = 6 if len(rest.split()) > 4 else 4
    values = _numbers(rest, count, source, "a zone is 'act x y width height', and 'top bottom' of the view")
    return act, values[:4], values[4:]


def _hint(line, source):
    x, _, rest = line.partition(" ")
    y, _, act = rest.partition(" ")
    return *_numbers(f"{x} {y}", 2, source, "a hint is 'x y act'"), act or "run"


def tile_name(level, x, y):
    """The name of the colliding tile at (x, y), or None."""
    letter = level.at(x, y)
    if letter in SLOPE_LETTERS:
        return SLOPE_LETTERS[letter]
    if letter == "L" and level.at(x, y - 1) != "L":
        return "ladder_top"
    if letter == "-":
        before, after = level.at(x - 1, y) == "-", level.at(x + 1, y) == "-"
        return "plank_" + {(0, 0): "single", (0, 1): "left", (1, 0): "right", (1, 1): "middle"}[(before, after)]
    return solid_name(level, x, y) if letter in SOLIDS else None


def solid_name(level, x, y):
    """The name of the ground, rock or stone tile at (x, y), by its neighbours."""
    letter = level.at(x, y)
    if level.at(x, y - 1) in SLOPE_LETTERS:
        return f"under_{SLOPE_LETTERS[level.at(x, y - 1)]}"
    material = SOLIDS[letter]
    mask = sum(bit for bit, dx, dy in AROUND if _joins(level, x + dx, y + dy))
    depth = _depth(level, x, y) if mask == 255 else 0
    roll = _scatter(x, y)
    if depth >= DEEP and letter == GROUND:
        return f"ground_deep_{4 if roll < 2 else 3 if roll < 5 else roll % 3}"
    if depth >= DEEP - 1:
        return f"{material}_{'deep' if depth >= DEEP else 'fading'}_{roll % 2}"
    name = f"{material}_{reduced(mask)}"
    variant = roll % (DEPTHS + 3)
    return f"{name}_{variant}" if mask == 255 and 0 < variant < DEPTHS else name


def cover_names(level):
    """Return {(x, y): tile name} of the layer that makes covered rooms, and the walls around them, look like solid ground."""
    rooms = level.rooms
    if not rooms:
        return {}
    filled = Filled(level, rooms)
    around = {(x + dx, y + dy) for x, y in rooms for dx in (-1, 0, 1) for dy in (-1, 0, 1)}
    return {place: solid_name(filled, *place) for place in around if filled.at(*place) in SOLIDS}


class Filled:
    """A level whose rooms are filled with what is above them."""

    def __init__(self, level, rooms):
        self.level, self.rooms = level, rooms

    def at(self, x, y):
        """The letter at a tile."""
        while (x, y) in self.rooms:
            y -= 1
        return self.level.at(x, y)

    buried = at


def _depth(level, x, y):
    """Tiles from here to the nearest open one, at most DEEP. A covered room is not open: nothing may tell where it is."""
    for reach in range(1, DEEP + 1):
        ring = [
            (dx, dy)
            for dx in range(-reach, reach + 1)
            for dy in range(-reach, reach + 1)
            if max(abs(dx), abs(dy)) == reach and abs(dx) + abs(dy) < 2 * reach
        ]  # without its corners: rounder
        if any(level.buried(x + dx, y + dy) not in SOLIDS for dx, dy in ring):
            return reach - 1
    return DEEP


def _joins(level, x, y):
    return level.at(x, y) in SOLIDS or level.at(x, y) in SLOPE_LETTERS


def _scatter(x, y):
    """A fixed pseudo-random number 0..99 per tile."""
    return (x * 7919 + y * 104729 + x * y * 31 + (x ^ y) * 613) % 9973 % 100


def decor_names(level):
    """Return ({(x, y): tile name} of the decoration layer, the same of the walls behind it)."""
    out, walls = {}, {}
    for y in range(level.height):
        for x in range(level.width):
            letter = level.at(x, y)
            wall = _wall_behind(level, x, y)
            if wall:
                walls[x, y] = f"{wall}_{_scatter(x, y) % 2}"
            if letter == "^":
                out[x, y] = "spikes"
            elif letter == "x":
                out[x, y] = f"crystal_{_scatter(x, y) % 2}"
            elif letter in DECOR_LETTERS:
                out[x, y] = DECOR_LETTERS[letter]
            elif letter == "." and level.at(x, y + 1) == GROUND:
                grown = [name for name, percent in GROWTH if _scatter(x, y) < percent]
                out.update({(x, y): grown[0]} if grown else {})
    for letter, name in SCENERY_LETTERS.items():
        for foot_x, foot_y in level.places(letter):
            columns, rows = SCENERY[name]
            for row in range(rows):
                for column in range(columns):
                    place = (foot_x - columns // 2 + column, foot_y - rows + 1 + row)
                    if level.at(*place) not in SLOPE_LETTERS:
                        out[place] = f"{name}_{column}_{row}"
    return out, walls


def _wall_behind(level, x, y):
    """The wall behind a tile: its own letter's, or of the nearest tile in its row that is not another thing. Or None."""
    if level.at(x, y) in WALLS:
        return WALLS[level.at(x, y)]
    if level.at(x, y) not in THINGS:
        return None
    for step in (-1, 1):
        beside = x
        while level.at(beside, y) in THINGS:
            beside += step
        if level.at(beside, y) in WALLS:
            return WALLS[level.at(beside, y)]
    below = level.at(x, y + 1)
    return WALLS[below] if level.at(x, y) == "-" and below in WALLS else None


def _properties(values):
    kinds = {str: "string", float: "float", int: "int"}
    return [{"name": name, "type": kinds[type(value)], "value": value} for name, value in values.items()]


def tileset(table):
    """The embedded tileset: where each tile is in images/tiles.png and what it is."""
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
    """Return the whole map as Tiled's JSON structure."""
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
    """The layers of tiles, back to front. table: all tiles in the order of the tileset, counted from 1; 0 is no tile."""
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
    # A tree may reach past the map or have clear corners that are no tiles: neither is in the data.
    return [
        {"name": name, "type": "tilelayer", **size, "data": [numbers.get(names.get(place), 0) for place in cells]}
        for name, names in pictures.items()
    ]


def _object_layers(level):
    """The layers of objects, which are numbered through from 1."""
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
    """Return the map's bytes with a line per map row, tile and object, so that a change shows as a small diff."""
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
    """Return {relative path: bytes} of every level."""
    path = FOLDER / "levels" / "platformer.txt"
    level = Map(path.read_text(encoding="utf-8"), path.name)
    return {"levels/platformer.tmj": to_tmj(tiled_map(level))}
