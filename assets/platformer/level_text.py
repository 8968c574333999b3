"""A level as text, assets/levels/platformer.txt: one letter per tile under [map], and further sections below it."""

from assets.platformer.decoration import TILE

GROUND = "#"
SOLIDS = {"#": "ground", "B": "stone", "R": "rock"}
ACTS = ("meadow", "cave", "keep")


class Map:
    """A level, read from a text: the letters of its tiles, and its other sections. source: name of the file, for
    errors.
    """

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
        """Return the letter of the tile (x, y). Outside the map it is GROUND, so that the map's edges look like its
        inside.
        """
        return self.rows[y][x] if 0 <= x < self.width and 0 <= y < self.height else GROUND

    def buried(self, x, y):
        """Return the letter of the tile (x, y) as if all covered rooms were filled with ground."""
        return Filled(self, self.rooms).at(x, y)

    def places(self, letter):
        """Return a list of all tiles (x, y) with this letter, column by column from the left, each from
        top to bottom.
        """
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
    """Return the `count` integers in a line, as a tuple.

    Raises ValueError with the text `rule` if the line has other contents. source: name of the file, for errors.
    """
    try:
        values = [int(word) for word in line.split()]
    except ValueError:
        values = []
    if len(values) != count:
        raise ValueError(f"{source}: {rule} (got {line!r})")
    return tuple(values)


def _platform(line, source):
    try:
        to_x, to_y, period, width = line.split()
        return int(to_x) * TILE, int(to_y) * TILE, float(period), int(width) * TILE
    except ValueError:
        raise ValueError(f"{source}: a platform is 'x y seconds width' (got {line!r})") from None


def _zone(line, source):
    """Return (act, rectangle, rows) of a zone, read from a line.

    act: one of ACTS, the look of the zone; rectangle: (x, y, width, height) in tiles; rows: (top, bottom) in tiles
    that the camera may show, or () if the line has none; source: name of the file, for errors.
    """
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


class Filled:
    """A level in which covered rooms are filled up, so that no room is visible.

    A filled tile has the letter of the nearest tile above its room.
    """

    def __init__(self, level, rooms):
        self.level, self.rooms = level, rooms

    def at(self, x, y):
        """Return the letter of the tile (x, y), with covered rooms filled."""
        while (x, y) in self.rooms:
            y -= 1
        return self.level.at(x, y)

    buried = at
