"""The objects of a level, as rows for Tiled's object layers. They are made from the letters that are not tiles.

A row is (type, x, y, width, height, properties) in px; (x, y) is the top left corner.
"""

from assets.platformer import rope_bridge
from assets.platformer.decoration import TILE

# letter: (type, width, height) of objects that stand on the tile's bottom, centred on the tile
STANDING = {
    "H": ("hero_start", 10, 20),
    "s": ("spring", 16, 16),
    "w": ("walker", 20, 16),
    "h": ("hedgehog", 20, 14),
    "K": ("checkpoint", 16, 32),
    "?": ("sign", 20, 17),
    "o": ("coin", 14, 14),
    "$": ("secret", 14, 14),
    "c": ("crate", 16, 16),
    "Q": ("bomb", 14, 16),
}
HANGING = {"V": ("bat", 20, 14)}  # its upper edge is the tile's
RUNS = {">": ("belt", 60.0), "<": ("belt", -60.0), "^": ("spikes", None)}  # a row of the letter is one object
FLOATING = ("coin", "secret")
WALKERS = ("walker", "hedgehog")
FLOORS = "#BR-<>"
WALLS = "#BRcW^/\\1234"
SPIKES_INSET = (3, 7)  # [px] smaller than drawn: the points' outer pixels do not hurt


def objects(level):
    """Return the objects of a level for the map file, a list of rows (kind, x, y, width, height, properties) [px].

    Objects on the map come first, column by column from the left, each from top to bottom. Zones and covers follow.
    level: the level, a level_text.Map.
    """
    out, signs, platforms = [], iter(level.signs), iter(level.platforms)
    for x in range(level.width):
        for y in range(level.height):
            letter = level.at(x, y)
            if letter in STANDING:
                out.append(_standing(level, letter, x, y, signs))
            elif letter in HANGING:
                kind, width, height = HANGING[letter]
                out.append((kind, x * TILE + (TILE - width) // 2, y * TILE, width, height, {}))
            elif letter == "C":
                out.append(("crate", x * TILE, (y - 1) * TILE, 2 * TILE, 2 * TILE, {}))
            elif letter == "~":
                out.append(("bridge", x * TILE, y * TILE, rope_bridge.WIDTH, 2 * TILE, {}))
            elif letter == "X":
                out.append(("crumble", x * TILE, y * TILE, 2 * TILE, TILE, {}))
            elif letter == "P":
                to_x, to_y, period, width = next(platforms)
                properties = {"to_x": x * TILE + to_x, "to_y": y * TILE + to_y, "period": period}
                out.append(("platform", x * TILE, y * TILE, width, TILE, properties))
            elif letter == "G":
                out.append(("goal", x * TILE, (y - 2) * TILE, 2 * TILE, 3 * TILE, {}))
            elif letter == "L" and level.at(x, y - 1) != "L":
                height = next(i for i in range(1, level.height + 1) if level.at(x, y + i) != "L")
                out.append(("ladder", x * TILE, y * TILE, TILE, height * TILE, {}))
            elif letter == "W" and "W" not in (level.at(x - 1, y), level.at(x, y - 1)):
                width, height = _extent(level, x, y)
                out.append(("blast_wall", x * TILE, y * TILE, width * TILE, height * TILE, {}))
            elif letter in RUNS and level.at(x - 1, y) != letter:
                out.append(_run(level, letter, x, y))
    for act, rect, view in level.zones:
        rows = {"view_top": view[0] * TILE, "view_bottom": view[1] * TILE} if view else {}
        out.append(("zone", *_pixels(rect), {"act": act} | rows))
    return out + [("cover", *_pixels(rect), {}) for rect in level.covers]


def hints(level):
    """Return the points that guide the bot along its path, in order, as rows like those of objects().

    level: the level, a level_text.Map.
    """
    return [
        ("hint", x * TILE, y * TILE, TILE, TILE, {"order": number, "act": act})
        for number, (x, y, act) in enumerate(level.hints)
    ]


def _standing(level, letter, x, y, signs):
    kind, width, height = STANDING[letter]
    bottom = (y + 1) * TILE - (1 if kind in FLOATING else 0)
    properties = {}
    if kind == "sign":
        properties["text"] = next(signs)
    elif kind in WALKERS:
        properties["range"] = walking_range(level, x, y)
    return kind, x * TILE + (TILE - width) // 2, bottom - height, width, height, properties


def _extent(level, x, y):
    """Return (columns, rows), the size of the block of equal letters whose top left tile is at (x, y).

    level: the level, a level_text.Map.
    """
    letter = level.at(x, y)
    width = next(i for i in range(1, level.width + 1) if level.at(x + i, y) != letter)
    return width, next(i for i in range(1, level.height + 1) if level.at(x, y + i) != letter)


def _run(level, letter, x, y):
    kind, speed = RUNS[letter]
    length = next(i for i in range(1, level.width + 1) if level.at(x + i, y) != letter)
    if kind == "belt":
        return kind, x * TILE, y * TILE, length * TILE, TILE, {"speed": speed}
    aside, down = SPIKES_INSET
    return kind, x * TILE + aside, y * TILE + down, length * TILE - 2 * aside, TILE - down, {}


def _pixels(rect):
    return tuple(value * TILE for value in rect)


def walking_range(level, x, y, most=4):
    """Return the distance [px] that a walking enemy may walk from its first tile, to the left and to the right.

    The ground must be level and free over this distance on both sides. On a platform, the enemy must stay on the
    platform. level: the level, a level_text.Map; x, y: the first tile; most: greatest distance in tiles.
    """
    deck = _deck(level, x, y + 1)
    for step in range(1, most + 1):
        for side in (-1, 1):
            place = (x + side * step, y + 1)
            bears = _deck(level, *place) == deck if deck else level.at(*place) in FLOORS
            if level.at(x + side * step, y) in WALLS or not bears:
                return (step - 1) * TILE
    return most * TILE


def _deck(level, x, y):
    """Return the first tile (column, row) of the platform that covers the tile (x, y), or None without a platform.

    The first tile is the one with the letter of the platform. level: the level, a level_text.Map.
    """
    for (column, row), (_, _, _, width) in zip(level.places("P"), level.platforms, strict=True):
        if row == y and 0 <= x - column < width // TILE:
            return column, row
    return None
