"""Turns assets/levels/platformer.txt, one letter per tile, into a Tiled map (.tmj) with the tileset embedded.

Layers, back to front: "decor" and "solid" (tiles), "things" (objects). Objects are rectangles in px, x and y the top
left corner; moving platforms carry to_x, to_y (px, of that corner at the far end) and period (s, there and back).
"""

import json

from assets import FOLDER
from assets.decoration import SCENERY
from assets.tiles import DEPTHS, NE, NW, SE, SW, TILE, E, N, S, W, reduced, tile_table

SHEET_WIDTH = 256   # [px] as assets/atlas.py packs the sheet "tiles", without gaps
GROUND, STONE = "#", "B"
DEEP = 4   # [tiles] below the surface the ground is dark
SLOPE_LETTERS = {
    "/": "slope_up", "\\": "slope_down", "1": "slope_up_low", "2": "slope_up_high", "3": "slope_down_high",
    "4": "slope_down_low",
}
SCENERY_LETTERS = {"T": "tree_green", "A": "tree_autumn", "Y": "tree_small", "b": "bush"}
DECOR_LETTERS = {"f": "fence", "m": "mushroom", "k": "rock", "*": "flower_1", "v": "vine", "!": "torch"}
# letter: (type, width, height) of objects that stand on the tile's bottom, centred on the tile
STANDING = {
    "H": ("hero_start", 10, 20), "s": ("spring", 16, 16), "w": ("walker", 20, 16), "K": ("checkpoint", 16, 32),
    "?": ("sign", 20, 17), "o": ("coin", 14, 14), "c": ("crate", 16, 16),
}
AROUND = ((N, 0, -1), (NE, 1, -1), (E, 1, 0), (SE, 1, 1), (S, 0, 1), (SW, -1, 1), (W, -1, 0), (NW, -1, -1))
GROWTH = (("tuft_0", 30), ("tuft_1", 55), ("flower_0", 62), ("flower_1", 67))   # running percent of free grass tiles


class Map:
    """The letters of a level and what its text says besides them."""

    def __init__(self, text, source):
        sections = _sections(text, source)
        self.rows = sections.get("map", [])
        self.platforms = [_platform(line, source) for line in sections.get("platforms", [])]
        self.signs = sections.get("signs", [])
        self.width, self.height = len(self.rows[0]) if self.rows else 0, len(self.rows)
        for number, row in enumerate(self.rows, 1):
            if len(row) != self.width:
                raise ValueError(f"{source}: map row {number} has {len(row)} tiles, the first has {self.width}")
        for letter, given, name in (("P", self.platforms, "[platforms]"), ("?", self.signs, "[signs]")):
            if len(self.places(letter)) != len(given):
                raise ValueError(f"{source}: {len(self.places(letter))} {letter!r} on the map, {len(given)} in {name}")

    def at(self, x, y):
        """The letter at a tile; outside counts as ground, so that edges of the map are drawn as inside."""
        return self.rows[y][x] if 0 <= x < self.width and 0 <= y < self.height else GROUND

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


def _platform(line, source):
    try:
        to_x, to_y, period = line.split()
        return int(to_x) * TILE, int(to_y) * TILE, float(period)
    except ValueError:
        raise ValueError(f"{source}: a platform is 'x y seconds' (got {line!r})") from None


def tile_name(level, x, y):
    """The name of the colliding tile at (x, y), or None."""
    letter = level.at(x, y)
    if letter in SLOPE_LETTERS:
        return SLOPE_LETTERS[letter]
    if letter == "-":
        before, after = level.at(x - 1, y) == "-", level.at(x + 1, y) == "-"
        return "plank_" + {(0, 0): "single", (0, 1): "left", (1, 0): "right", (1, 1): "middle"}[(before, after)]
    if letter not in (GROUND, STONE):
        return None
    if level.at(x, y - 1) in SLOPE_LETTERS:
        return f"under_{SLOPE_LETTERS[level.at(x, y - 1)]}"
    depth = _depth(level, x, y) if letter == GROUND else 0
    if depth >= DEEP:
        roll = _scatter(x, y)
        return f"ground_deep_{4 if roll < 2 else 3 if roll < 5 else roll % 3}"
    if depth == DEEP - 1:
        return f"ground_fading_{_scatter(x, y) % 2}"
    mask = sum(bit for bit, dx, dy in AROUND if _joins(level, x + dx, y + dy))
    name = f"{'ground' if letter == GROUND else 'stone'}_{reduced(mask)}"
    variant = _scatter(x, y) % (DEPTHS + 3)
    return f"{name}_{variant}" if mask == 255 and 0 < variant < DEPTHS else name


def _depth(level, x, y):
    """Tiles from here to the nearest open one, at most DEEP."""
    for reach in range(1, DEEP + 1):
        ring = [(dx, dy) for dx in range(-reach, reach + 1) for dy in range(-reach, reach + 1)
                if max(abs(dx), abs(dy)) == reach and abs(dx) + abs(dy) < 2 * reach]   # without its corners: rounder
        if any(level.at(x + dx, y + dy) not in (GROUND, STONE) for dx, dy in ring):
            return reach - 1
    return DEEP


def _joins(level, x, y):
    return level.at(x, y) in (GROUND, STONE) or level.at(x, y) in SLOPE_LETTERS


def _scatter(x, y):
    """A fixed pseudo-random number 0..99 per tile."""
    return (x * 7919 + y * 104729 + x * y * 31 + (x ^ y) * 613) % 9973 % 100


def decor_names(level):
    """Return {(x, y): tile name} of the decoration layer."""
    out = {}
    for y in range(level.height):
        for x in range(level.width):
            letter = level.at(x, y)
            if letter in ",!" or _in_front_of_wall(level, x, y):
                out[x, y] = f"back_wall_{_scatter(x, y) % 2}"
            if letter == "^":
                out[x, y] = "spikes"
            elif letter in DECOR_LETTERS:
                out[x, y] = DECOR_LETTERS[letter]
            elif letter == "." and level.at(x, y + 1) == GROUND and (x, y) not in out:
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
    return out


def _in_front_of_wall(level, x, y):
    """Whether a thing or plank hangs before a back wall: its own letter hides the wall's, its row tells."""
    if level.at(x, y) == "-":
        return level.at(x, y + 1) in ",!" or _in_front_of_wall(level, x, y + 1)
    if level.at(x, y) not in STANDING:
        return False
    for step in (-1, 1):
        beside = x
        while level.at(beside, y) in STANDING:
            beside += step
        if level.at(beside, y) in ",!":
            return True
    return False


def objects(level):
    """Return the object rows in reading order: (type, x, y, width, height, properties), px."""
    out, signs, platforms = [], iter(level.signs), iter(level.platforms)
    for x in range(level.width):
        for y in range(level.height):
            letter = level.at(x, y)
            if letter in STANDING:
                kind, width, height = STANDING[letter]
                bottom = (y + 1) * TILE - (1 if kind == "coin" else 0)
                properties = {}
                if kind == "sign":
                    properties["text"] = next(signs)
                elif kind == "walker":
                    properties["range"] = walking_range(level, x, y)
                out.append((kind, x * TILE + (TILE - width) // 2, bottom - height, width, height, properties))
            elif letter == "C":
                out.append(("crate", x * TILE, (y - 1) * TILE, 2 * TILE, 2 * TILE, {}))
            elif letter == "P":
                to_x, to_y, period = next(platforms)
                properties = {"to_x": to_x, "to_y": to_y, "period": period}
                out.append(("platform", x * TILE, y * TILE, 3 * TILE, TILE, properties))
            elif letter == "G":
                out.append(("goal", x * TILE, (y - 2) * TILE, 2 * TILE, 3 * TILE, {}))
            elif letter == "^" and level.at(x - 1, y) != "^":
                run = next(i for i in range(1, level.width) if level.at(x + i, y) != "^")
                # Kinder than it looks: the points' outer pixels do not hurt.
                out.append(("spikes", x * TILE + 3, y * TILE + 7, run * TILE - 6, TILE - 7, {}))
    return out


def walking_range(level, x, y, most=4):
    """How far in px a walker may go to either side: flat free ground, at most `most` tiles."""
    for step in range(1, most + 1):
        for side in (-1, 1):
            if level.at(x + side * step, y) in "#B^/\\1234" or level.at(x + side * step, y + 1) not in "#B":
                return (step - 1) * TILE
    return most * TILE


def _properties(values):
    kinds = {str: "string", float: "float", int: "int"}
    return [{"name": name, "type": kinds[type(value)], "value": value} for name, value in values.items()]


def tileset(table):
    """The embedded tileset: where each tile is in images/tiles.png and what it is."""
    columns = SHEET_WIDTH // TILE
    rows = -(-len(table) // columns)
    return {
        "firstgid": 1, "name": "tiles", "image": "../images/tiles.png", "imagewidth": SHEET_WIDTH,
        "imageheight": rows * TILE, "tilewidth": TILE, "tileheight": TILE, "margin": 0, "spacing": 0,
        "columns": columns, "tilecount": len(table),
        "tiles": [
            {"id": i, "properties": _properties({"name": name} | table[name][1])} for i, name in enumerate(table)
        ],
    }


def tiled_map(level):
    """Return the whole map as Tiled's JSON structure."""
    table = tile_table()
    gids = {name: i + 1 for i, name in enumerate(table)}
    decor = decor_names(level)
    cells = [(x, y) for y in range(level.height) for x in range(level.width)]
    solid = [gids.get(tile_name(level, x, y), 0) for x, y in cells]
    # A tree may reach past the map or have clear corners that are no tiles: both are 0.
    behind = [gids.get(decor.get((x, y)), 0) for x, y in cells]
    size = {"width": level.width, "height": level.height, "x": 0, "y": 0, "opacity": 1, "visible": True}
    things = [
        {"id": i, "name": "", "type": kind, "x": x, "y": y, "width": width, "height": height, "rotation": 0,
         "visible": True, "properties": _properties(properties)}
        for i, (kind, x, y, width, height, properties) in enumerate(objects(level), 1)
    ]
    return {
        "type": "map", "version": "1.10", "tiledversion": "1.10.2", "orientation": "orthogonal",
        "renderorder": "right-down", "infinite": False, "compressionlevel": -1, "width": level.width,
        "height": level.height, "tilewidth": TILE, "tileheight": TILE, "nextlayerid": 4,
        "nextobjectid": len(things) + 1,
        "tilesets": [tileset(table)],
        "layers": [
            {"id": 1, "name": "decor", "type": "tilelayer", **size, "data": behind},
            {"id": 2, "name": "solid", "type": "tilelayer", **size, "data": solid},
            {"id": 3, "name": "things", "type": "objectgroup", "draworder": "index", "opacity": 1, "visible": True,
             "x": 0, "y": 0, "objects": things},
        ],
    }


def to_tmj(structure):
    """Return the map's bytes with a line per map row, tile and object, so that a change shows as a small diff."""
    text = json.dumps(structure, ensure_ascii=False, indent=None)
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
