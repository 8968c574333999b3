"""Choice of the pictures for a level's tiles.

The letter of a tile determines its material. The neighbouring tiles determine which picture of the material it has.
"""

from assets.platformer.decoration import SCENERY
from assets.platformer.level_text import GROUND, SOLIDS, Filled
from assets.platformer.level_things import HANGING, STANDING
from assets.platformer.tiles import DEPTHS, NE, NW, SE, SW, E, N, S, W, reduced

DEEP = 4  # [tiles] below the surface, from which ground is dark
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
WALLS = {",": "back_wall", ":": "back_cave"}  # behind these letters, and behind things among them
THINGS = "".join(STANDING) + "".join(HANGING) + "!ijxgnLCPW-"
AROUND = ((N, 0, -1), (NE, 1, -1), (E, 1, 0), (SE, 1, 1), (S, 0, 1), (SW, -1, 1), (W, -1, 0), (NW, -1, -1))
GROWTH = (("tuft_0", 30), ("tuft_1", 55), ("flower_0", 62), ("flower_1", 67))  # running percent of free grass tiles


def tile_name(level, x, y):
    """Return the name of the tile at (x, y) if it collides, otherwise None. level: the level, a level_text.Map."""
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
    """Return the name of the ground, rock or stone tile at (x, y), which depends on its neighbours.

    level: the level, a level_text.Map.
    """
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
    """Return {(x, y): tile name} of the layer "cover", which hides rooms as if they were filled.

    It covers the hidden rooms and the solid tiles around them. level: the level, a level_text.Map.
    """
    rooms = level.rooms
    if not rooms:
        return {}
    filled = Filled(level, rooms)
    around = {(x + dx, y + dy) for x, y in rooms for dx in (-1, 0, 1) for dy in (-1, 0, 1)}
    return {place: solid_name(filled, *place) for place in around if filled.at(*place) in SOLIDS}


def _depth(level, x, y):
    """Return the number of solid tiles between the tile (x, y) and the nearest open tile, at most DEEP.

    A covered room does not count as open, so that the tiles do not reveal the room. level: the level, a level_text.Map.
    """
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
    """Return a pseudo-random number 0..99 that is always the same for the tile (x, y)."""
    return (x * 7919 + y * 104729 + x * y * 31 + (x ^ y) * 613) % 9973 % 100


def decor_names(level):
    """Return (decor, walls), two dicts {(x, y): tile name}: the decoration layer, and the layer of walls behind it.

    level: the level, a level_text.Map.
    """
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
    """Return the name of the wall that is drawn behind the tile (x, y), or None.

    A letter in WALLS stands for a wall. Behind a letter in THINGS (an object, not a tile), the wall of the nearest
    other tile in the row is drawn. Behind a plank it may also be the wall of the tile below. level: the level, a
    level_text.Map.
    """
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
