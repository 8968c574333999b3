"""Validation of the platformer's maps. Each error names the file, the position in the file and the reason."""

from dataclasses import dataclass

from game.errors import FileError

TILE_SIZE = 16
SMALLEST, LARGEST = (30, 17), (1024, 256)  # [tiles] size of the picture; greatest size that is quick to check and draw
MOST_THINGS = 1500
ACTS = ("meadow", "cave", "keep")
HINTS = ("run", "jump", "climb", "kick", "ride", "drop", "push", "fall", "spring", "throw")
FAR = 1e5  # [px] beyond any map


@dataclass(frozen=True)
class Kind:
    """Requirements for one kind of object in a map. least, most: allowed number of such objects.

    properties: a tuple (name, type, least, most, needed) for each property of the object. least, most: limits of a
    number, or of the length of a text. For a text with fixed choices, `least` is the tuple of these choices. needed:
    whether the property is required.
    """

    least: int = 0
    most: int = MOST_THINGS
    properties: tuple = ()
    outside: bool = False  # may extend over the map's edge


def _number(name, least, most, needed=True):
    return name, float, least, most, needed


KINDS = {
    "hero_start": Kind(1, 1),
    "goal": Kind(1, 1),
    "coin": Kind(),
    "secret": Kind(),
    "checkpoint": Kind(),
    "spring": Kind(),
    "spikes": Kind(),
    "crate": Kind(),
    "crumble": Kind(),
    "blast_wall": Kind(),
    "bridge": Kind(),
    "bomb": Kind(),
    "ladder": Kind(),
    "sign": Kind(properties=(("text", str, 1, 120, True),)),
    "walker": Kind(properties=(_number("range", 0.0, FAR),)),
    "hedgehog": Kind(properties=(_number("range", 0.0, FAR),)),
    "bat": Kind(),
    "platform": Kind(properties=(_number("to_x", 0.0, FAR), _number("to_y", 0.0, FAR), _number("period", 0.5, 120.0))),
    "belt": Kind(properties=(_number("speed", -400.0, 400.0),)),
    "zone": Kind(
        properties=(
            ("act", str, ACTS, None, True),
            _number("view_top", 0.0, FAR, False),
            _number("view_bottom", 0.0, FAR, False),
        ),
        outside=True,
    ),
    "cover": Kind(),
    "hint": Kind(properties=(_number("order", 0, 1e6), ("act", str, HINTS, None, True))),
}


def check_level(tilemap):
    """Check whether a map is a playable level, and raise FileError for the first error."""
    _check_size(tilemap)
    for thing in tilemap.things:
        _check_thing(tilemap, thing)
    for name, kind in KINDS.items():
        count = len(tilemap.things_of(name))
        if not kind.least <= count <= kind.most:
            wanted = f"exactly {kind.least}" if kind.least == kind.most else f"{kind.least} to {kind.most}"
            raise FileError(tilemap.path, "objects", f"a level needs {wanted} {name}, this one has {count}")
    start = tilemap.one("hero_start")
    column, row = int((start.x + start.width / 2) // TILE_SIZE), int((start.y + start.height - 1) // TILE_SIZE)
    if tilemap.kind_of(int(tilemap.layers["solid"][row, column])) == "solid":
        raise FileError(tilemap.path, start.place, f"hero_start is inside the solid tile at column {column} row {row}")
    orders = [thing.properties["order"] for thing in tilemap.things_of("hint")]
    if len(set(orders)) < len(orders):
        raise FileError(tilemap.path, "objects", "two hints have the same order")


def _check_size(tilemap):
    path = tilemap.path
    if tilemap.tile_size != TILE_SIZE:
        raise FileError(path, "tilewidth", f"must be {TILE_SIZE} (got {tilemap.tile_size})")
    for name, size, least, most in (
        ("width", tilemap.columns, SMALLEST[0], LARGEST[0]),
        ("height", tilemap.rows, SMALLEST[1], LARGEST[1]),
    ):
        if not least <= size <= most:
            raise FileError(path, f"map.{name}", f"must be {least}..{most} tiles (got {size})")
    if "solid" not in tilemap.layers:
        raise FileError(path, "layers", f"no tile layer 'solid'; there are {', '.join(tilemap.layers) or 'none'}")
    if len(tilemap.things) > MOST_THINGS:
        raise FileError(path, "objects", f"at most {MOST_THINGS} (got {len(tilemap.things)})")


def _check_thing(tilemap, thing):
    path, place = tilemap.path, thing.place
    if thing.kind not in KINDS:
        raise FileError(path, place, f"unknown type {thing.kind!r:.60}; a level's objects are {', '.join(KINDS)}")
    place = f"{place} ({thing.kind})"
    kind, (width, height) = KINDS[thing.kind], tilemap.size
    if not (0.0 < thing.width <= width and 0.0 < thing.height <= height):
        raise FileError(path, place, f"must have a size within the map (got {thing.width:g} x {thing.height:g})")
    if not kind.outside and not (0.0 <= thing.x <= width - thing.width and 0.0 <= thing.y <= height - thing.height):
        raise FileError(
            path, place, f"is outside the map (x {thing.x:g}, y {thing.y:g}; the map is {width} x {height} px)"
        )
    for name, wanted, least, most, needed in kind.properties:
        if name in thing.properties:
            _check_value(path, f"{place}.{name}", thing.properties[name], wanted, least, most)
        elif needed:
            raise FileError(path, place, f"needs the property {name!r}")


def _check_value(path, place, value, wanted, least, most):
    if wanted is str:
        if isinstance(least, tuple):
            if value not in least:
                raise FileError(path, place, f"must be one of {', '.join(least)} (got {value!r:.60})")
        elif not isinstance(value, str) or not least <= len(value) <= most:
            raise FileError(path, place, f"must be a text of {least} to {most} letters (got {value!r:.60})")
        return
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value <= most:
        raise FileError(path, place, f"must be a number {least:g}..{most:g} (got {value!r:.60})")
