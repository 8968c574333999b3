"""The plan of lab/carving's bot: the tool, the pointer's position and the pointer's button at every step."""

from typing import NamedTuple

from game.input.inputs import InputFrame


class Move(NamedTuple):
    """A stroke of the pointer with its button held: from `start` to `end` [canvas px], in `steps` steps from `frame`
    on.
    """

    frame: int
    steps: int
    start: tuple
    end: tuple


SETTINGS = {0: ("blast", 14), 100: ("dig", 8), 160: ("dig", 6), 250: ("sprite", 15), 290: ("blast", 18)}
MOVES = (
    Move(24, 2, (142, 168), (142, 168)),  # the bridge, first beside the hill
    Move(56, 2, (222, 172), (222, 172)),  # then beside its pillar
    Move(106, 16, (262, 146), (304, 186)),  # the neck, aslant
    Move(166, 70, (384, 196), (384, 128)),  # behind the cliff's overhang, from below
    Move(256, 2, (88, 162), (88, 162)),  # under the bracket
    Move(300, 2, (34, 166), (34, 166)),  # under the crates
)
NAMES = ("blast", "dig", "box", "sprite", "hand")


def plan(frame):
    """Return the bot's InputFrame for frame number `frame`."""
    changes = ()
    if frame in SETTINGS:
        name, radius = SETTINGS[frame]
        changes = (("slider:tool", NAMES.index(name)), ("slider:radius", radius))
    at = MOVES[0].start
    for move in MOVES:
        if frame >= move.frame:
            share = min(1.0, (frame - move.frame) / max(1, move.steps - 1))
            at = tuple(round(a + (b - a) * share) for a, b in zip(move.start, move.end, strict=True))
            if frame < move.frame + move.steps:
                return InputFrame(frozenset(), at, True, 0, changes)
    return InputFrame(frozenset(), at, False, 0, changes)
