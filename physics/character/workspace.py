"""Walk: all that the kernels of a character read and write, in one named context."""

from typing import NamedTuple

import numpy as np

from physics.collision.manifold import POINTS
from physics.dynamics.quarantine import is_sound_walk
from physics.jit import kernel, subkernel
from physics.tables.geometry import Geometry
from physics.tables.rows import row_of
from physics.tables.world_tables import WorldTables


class Scratch(NamedTuple):
    """Room for one test in flight."""

    mine: np.ndarray  # (16, 2) corners of the character [px]
    theirs: np.ndarray  # (16, 2) corners of what it may meet
    points: np.ndarray  # (POINTS,) a manifold in flight, see collision/clipping.py


class Settings(NamedTuple):
    """What of the world a walk depends on."""

    stacking: int  # 1: dynamic bodies stop, carry and squeeze characters
    rotation: int  # 1: they turn
    conveyor: int  # 1: surfaces run
    dt: float  # [s] that a move, or the step, stands for
    slop: float  # [px]


class Walk(NamedTuple):
    """Tables, what is near each character, and scratch room."""

    geometry: Geometry
    bodies: np.ndarray  # BODY, written: forces, and where the characters are
    shapes: np.ndarray  # SHAPE
    characters: np.ndarray  # CHARACTER, written
    near: np.ndarray  # shape rows, in order, of one character after the other
    spans: np.ndarray  # (characters, 2) where those of each start, and how many there are
    found: np.ndarray  # solids in reach of a character, see solids.gather
    found_beside: np.ndarray  # the same, for a character that is moved by another
    scratch: Scratch
    settings: Settings


def new_scratch() -> Scratch:
    """Scratch room for the walks of one world."""
    return Scratch(np.zeros((16, 2)), np.zeros((16, 2)), np.zeros(POINTS))


def walk_for(tables: WorldTables, characters: np.ndarray, near: np.ndarray, spans: np.ndarray, dt: float) -> Walk:
    """The context of a world, or of its StepState, for dt [s]. characters: CHARACTER rows; near, spans: as in Walk."""
    effects = tables.effects
    room = len(near) + 1
    rows = tables.workspace.rows_for(2 * room)
    return Walk(
        tables.library.tables,
        tables.bodies,
        tables.shapes,
        characters,
        near,
        spans,
        rows[:room],
        rows[room : 2 * room],
        tables.workspace.walk,
        Settings(int(effects.stacking), int(effects.rotation), int(effects.conveyor), dt, tables.tolerances.slop),
    )


@subkernel
def character_of(characters, body):
    """The row of the character with that body id, or -1. O(log characters)."""
    low = 0
    high = len(characters)
    while low < high:
        middle = (low + high) // 2
        if characters[middle].body < body:
            low = middle + 1
        else:
            high = middle
    return low if low < len(characters) and characters[low].body == body else -1


@kernel
def can_walk(me, characters):
    """Whether the numbers of a character are such as it can be moved with."""
    return is_sound_walk(characters[me])


@kernel
def find_own_rows(bodies, shapes, characters_inout):
    """Write the rows of the characters' bodies and shapes. O(characters · log shapes)."""
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        c.body_row = row_of(bodies, c.body)
        c.shape_row = row_of(shapes, c.shape)


@subkernel
def place_body(c, body_inout):
    """Put the body of a character (row c) where its box is."""
    body_inout.x = c.left + c.offset_x
    body_inout.y = c.top + c.offset_y
    body_inout.center_x = body_inout.x + body_inout.local_center_x
    body_inout.center_y = body_inout.y + body_inout.local_center_y


@subkernel
def settle(me, walk_inout):
    """Put the character's body where its box is."""
    c = walk_inout.characters[me]
    place_body(c, walk_inout.bodies[c.body_row])
