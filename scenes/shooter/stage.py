"""Stage files of the shooter: the records of the format, and the functions that read a file.

A stage is a list of events in the order of their times. The clock of the stage [s] stops while a mid-boss or boss
fights. Lengths are in pixels of the picture (480 x 270), speeds in px/s, angles in degrees: 0 to the right, 90 down.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from game.files.json_file import read_json
from game.places import ASSETS
from scenes.shooter.bullets import HOSTILE_LOOKS
from scenes.shooter.stage_fields import Choice, List, Number, Reader, Record, Text, Variant

STAGE = ASSETS / "stages" / "shooter.json"
FORMAT, VERSION = "hitbox stage", 1
GROUNDS = ("sea", "coast", "storm")
KIND_NAMES = ("dart", "saucer", "gunship", "hornet", "turret")
ITEMS = ("power", "bomb", "life")
SIDES = ("left", "right", "below")
LONGEST = 600  # [s] of a stage's clock
MOST_PLANES = 80  # planes in one wave
SLOWEST = 20.0  # [px/s] a slower bullet would stay for ever
MOST_FIRE = 1000  # bullets per second of a phase, over all its patterns


@dataclass(frozen=True)
class Group:
    """A group of planes of one kind, which enter one after another.

    kind: kind of the planes; places: for each plane, its position along the edge at which it enters (0..1); after: time
    of the first plane [s]; every: time between planes [s]; carries: item that the last plane drops, or "".

    Only some kinds use the other fields. hover: y at which a plane stops [px]; sway: amplitude of its weaving [px];
    side: edge at which it enters; bend: angle of its arc [deg].
    """

    kind: str
    places: tuple
    every: float
    after: float
    carries: str
    hover: float = 56.0
    sway: float = 40.0
    side: str = ""
    bend: float = 0.0


@dataclass(frozen=True)
class Pattern:
    """The firing pattern of one gun.

    shoot: kind of fire ("aimed", "fan", ...). It decides which of the other fields are used.

    The first shot is fired after `after` [s], the next ones every `every` [s]. After a burst of `shots` shots, the gun
    waits for another `rest` [s]. faster: increase of the speed from each shot of a burst to the next [px/s]. muzzles:
    points relative to the plane's centre [px]; bullets start at distance `out` [px] from a muzzle.
    """

    shoot: str
    bullet: str
    speed: float
    every: float
    after: float
    shots: int
    rest: float
    faster: float
    muzzles: tuple
    out: float = 0.0
    count: int = 1
    spread: float = 0.0
    heading: float | None = None
    turn: float = 0.0
    sway: float = 0.0
    period: float = 1.0
    spacing: float = 0.0
    gap: float = 0.0
    shift: float = 0.0

    @property
    def per_second(self):
        """Average number of bullets per second."""
        each = WALL_WIDTH / self.spacing if self.shoot == "wall" else self.count
        return each * len(self.muzzles) * self.shots / (self.shots * self.every + self.rest)


@dataclass(frozen=True)
class Move:
    """The path of a mid-boss or boss, in the form of an eight around its home position.

    across, down: amplitudes [px]; seconds: time for one round.
    """

    across: float
    down: float
    seconds: float


@dataclass(frozen=True)
class Phase:
    """A phase of a boss fight. It ends after `seconds`, or earlier when shots have used up its `health` [plain shots].

    name: name on the screen; bonus: points if the health was used up; move: path of the leader; patterns: fire of its
    guns.
    """

    name: str
    health: float
    seconds: float
    bonus: int
    move: Move
    patterns: tuple


@dataclass(frozen=True)
class Event:
    """An event of a stage, at time `at` [s]. event: kind of the event, which decides which other fields are used.

    "wave": groups; "midboss" and "boss": phases; "backdrop": ground; "item": item, across (0..1 of the width); "pace":
    the factors of the difficulty (speed, patience, armour, extra).
    """

    event: str
    at: float
    name: str = ""
    groups: tuple = ()
    phases: tuple = ()
    ground: str = ""
    item: str = ""
    across: float = 0.5
    speed: float = 1.0
    patience: float = 1.0
    armour: float = 1.0
    extra: int = 0


@dataclass(frozen=True)
class Stage:
    """One stage of the shooter: its events in the order of time. Its `title` and `name` are shown at the start."""

    title: str
    name: str
    events: tuple


def _group(**fields):
    return Record(
        Group,
        places=List(Number(0, 1), 1, 30),
        every=Number(0.05, 10),
        after=Number(0, 30, 0.0),
        carries=Choice(ITEMS, ""),
        **fields,
    )


def _pattern(**fields):
    return Record(Pattern, **fields)


WALL_WIDTH = 480.0  # [px] width of a wall across the sky
HOVER = Number(24, 120, 56.0)
GROUPS = {
    "dart": _group(hover=HOVER),
    "gunship": _group(hover=HOVER),
    "saucer": _group(sway=Number(-220, 220, 40.0)),
    "hornet": _group(side=Choice(SIDES), bend=Number(-360, 360, 0.0)),
    "turret": _group(),
}
COUNT, TURN = Number(1, 64, whole=True), Number(-360, 360, 0.0)
PATTERNS = {
    "aimed": _pattern(),
    "fan": _pattern(count=COUNT, spread=Number(0, 360), heading=Number(-360, 360, None)),
    "ring": _pattern(count=COUNT, turn=TURN),
    "spiral": _pattern(count=COUNT, turn=TURN, sway=Number(0, 360, 0.0), period=Number(0.2, 60, 1.0)),
    "wall": _pattern(spacing=Number(6, 120), gap=Number(24, 300), shift=Number(0, 400, 120.0)),
    "lead": _pattern(count=Number(1, 64, 1, whole=True), spread=Number(0, 360, 0.0)),
    "stream": _pattern(turn=TURN),
}
MUZZLE = List(Number(-80, 80), 2, 2)
PATTERN = Variant(
    "shoot",
    PATTERNS,
    bullet=Choice(HOSTILE_LOOKS),
    speed=Number(SLOWEST, 400),
    every=Number(0.03, 30),
    after=Number(0, 30, 0.0),
    shots=Number(1, 200, 1, whole=True),
    rest=Number(0, 30, 0.0),
    faster=Number(-100, 100, 0.0),
    muzzles=List(MUZZLE, 1, 8, ((0.0, 0.0),)),
    out=Number(0, 80, 0.0),
)
MOVE = Record(Move, across=Number(0, 180), down=Number(0, 60), seconds=Number(1, 60))
PHASE = Record(
    Phase,
    name=Text(24),
    health=Number(1, 5000),
    seconds=Number(5, 120),
    bonus=Number(0, 1_000_000, whole=True),
    move=MOVE,
    patterns=List(PATTERN, 1, 8),
)
EVENTS = {
    "backdrop": Record(Event, ground=Choice(GROUNDS)),
    "pace": Record(
        Event,
        speed=Number(0.5, 2, 1.0),
        patience=Number(0.3, 3, 1.0),
        armour=Number(0.5, 4, 1.0),
        extra=Number(0, 8, 0, whole=True),
    ),
    "wave": Record(Event, name=Text(24), groups=List(Variant("kind", GROUPS), 1, 8)),
    "item": Record(Event, item=Choice(ITEMS), across=Number(0.05, 0.95)),
    "midboss": Record(Event, name=Text(24), phases=List(PHASE, 1, 1)),
    "boss": Record(Event, name=Text(24), phases=List(PHASE, 1, 3)),
}
FILE = {
    "format": Choice((FORMAT,)),
    "version": Number(VERSION, VERSION, whole=True),
    "title": Text(16),
    "name": Text(28),
    "about": List(Text(200), 0, 40, ()),
    "events": List(Variant("event", EVENTS, at=Number(0, LONGEST)), 2, 400),
}


def load_stage(path=None):
    """Return the Stage of a file, or the game's own stage if `path` is None.

    Raises FileError, which names the file, the position in it and the reason.
    """
    return _own() if path is None else read_stage(path)


@lru_cache(maxsize=1)
def _own():
    return read_stage(STAGE)


def read_stage(path):
    """Return the Stage of a file. Raises FileError if the file is invalid."""
    reader, data = Reader(path), read_json(path)
    _check_version(reader, data)
    fields = reader.fields("", data, FILE)
    events = fields["events"]
    _check_order(reader, events)
    for number, event in enumerate(events):
        _check_event(reader, f"events[{number}]", event)
    return Stage(fields["title"], fields["name"], events)


def _check_version(reader, data):
    # The version is checked first, because a newer file may have fields that are unknown here.
    version = data.get("version") if isinstance(data, dict) else None
    if isinstance(version, int) and not isinstance(version, bool) and version > VERSION:
        reader.fail("version", f"is {version}, newer than this game can read ({VERSION})")


def _check_order(reader, events):
    for number, (before, after) in enumerate(pairwise(events), 1):
        if after.at < before.at:
            reader.fail(f"events[{number}].at", f"is {after.at:g}, before that of the event above ({before.at:g})")
    if events[0].event != "backdrop" or events[0].at != 0.0:
        reader.fail("events[0]", "must be the first backdrop, at 0")
    bosses = [number for number, event in enumerate(events) if event.event == "boss"]
    if not bosses:
        reader.fail("events", "have no boss: the stage would never end")
    if bosses[0] != len(events) - 1:
        reader.fail(f"events[{bosses[0] + 1}]", "comes after the boss, which ends the stage")


def _check_event(reader, place, event):
    planes = sum(len(group.places) for group in event.groups)
    if planes > MOST_PLANES:
        reader.fail(f"{place}.groups", f"send {planes} planes; at most {MOST_PLANES} in one wave")
    for number, phase in enumerate(event.phases):
        for row, pattern in enumerate(phase.patterns):
            slowest = pattern.speed + min(pattern.faster, 0.0) * (pattern.shots - 1)
            if slowest < SLOWEST:
                reader.fail(
                    f"{place}.phases[{number}].patterns[{row}].faster",
                    f"leaves the last shot {slowest:g} px/s; at least {SLOWEST:g}",
                )
        fired = sum(pattern.per_second for pattern in phase.patterns)
        if fired > MOST_FIRE:
            reader.fail(f"{place}.phases[{number}].patterns", f"fire {fired:.0f} bullets a second; at most {MOST_FIRE}")
