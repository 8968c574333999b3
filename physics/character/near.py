"""What may carry, push or stop each character in a step: what is near those that something may have stirred."""

import numpy as np

from physics.character.workspace import character_of
from physics.jit import kernel, subkernel
from physics.tables.body import STATIC
from physics.tables.rows import row_of
from physics.tables.step_state import StepState


@subkernel
def motion_of(b):
    """How far [px] any point of a body was moved by the step, at most."""
    turn = abs(b.angle - b.previous_angle) * (b.extent + abs(b.local_center_x) + abs(b.local_center_y))
    return abs(b.x - b.previous_x) + abs(b.y - b.previous_y) + turn


@kernel
def find_stirred(
    # read
    bodies,
    shapes,
    characters,
    pairs,
    count,
    # write
    stirred_out,
):
    """Flag the characters that ride something, or stand on a belt, or that something which is not static may have met.

    pairs (count, 2): shape rows out of the broad phase; stirred_out (characters,). Returns how far [px] any point of
    what is ridden or may have been met was moved by the step. O(pairs · log characters).
    """
    most = 0.0
    for me in range(len(characters)):
        c = characters[me]
        stirred_out[me] = c.riding >= 0 or c.belt != 0.0
        row = row_of(bodies, c.riding) if c.riding >= 0 else -1
        if row >= 0:
            most = max(most, motion_of(bodies[row]))
    for k in range(count):
        for side in range(2):
            me = character_of(characters, shapes[pairs[k, side]].body)
            b = bodies[shapes[pairs[k, 1 - side]].body_row]
            if me >= 0 and b.kind != STATIC:
                stirred_out[me] = True
                most = max(most, motion_of(b))
    return most


def near_characters(state: StepState) -> tuple[np.ndarray, np.ndarray]:
    """(near, spans) of a Walk for this step: the shape rows that may carry, push or stop each character."""
    rows, pairs = state.characters, state.pairs.rows
    stirred = np.zeros(len(rows), bool)
    motion = find_stirred(state.bodies, state.shapes, rows, pairs, len(pairs), stirred)
    near, spans, start = [], np.zeros((len(rows), 2), np.int64), 0
    for me in np.flatnonzero(stirred).tolist():
        if not near:
            state.queries.begin(state)
        row = rows[me]
        # Carried as far as anything moved, or pressed out of it; up and down a slope on the way.
        reach = 2.0 * motion + abs(float(row["belt"])) * state.dt + 8.0
        climb = reach * float(row["climb"])
        left, top = float(row["left"]), float(row["top"])
        right, bottom = left + float(row["width"]), top + float(row["height"])
        found = state.queries.rows_in(
            state, (left - reach, top - reach - climb), (right + reach, bottom + reach + climb)
        )
        near.append(found)
        spans[me] = start, len(found)
        start += len(found)
    return np.concatenate(near) if near else np.zeros(0, np.int64), spans
