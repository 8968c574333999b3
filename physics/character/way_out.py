"""The way out of a still solid that a character has come to stand in: put there, or the ground was changed around it.

Walking never leads into one, so who is in one was placed so: it is let out by the shortest of eight straight ways, some
pixels in each move, whatever it was told to do. What moves and stands in a character is none of this: see crush.py.
"""

from physics.character.feel import feel
from physics.character.ground import FREE, GIVE
from physics.character.solids import blocked_at, gather
from physics.character.workspace import settle
from physics.jit import kernel, subkernel
from physics.tables.body import STATIC

PACE = 2  # [px] of a way out in one move: about what overlapping bodies are pushed apart by in a step


@subkernel
def keep_still(walk, rows_inout):
    """Keep of the rows that gather listed those of static bodies."""
    kept = 0
    for k in range(1, rows_inout[0] + 1):
        row = rows_inout[k]
        if row >= 0 and walk.bodies[walk.shapes[row].body_row].kind == STATIC:
            kept += 1
            rows_inout[kept] = row
    rows_inout[0] = kept


@subkernel
def is_inside(me, walk_inout):
    """Whether a character stands in a still solid; walk_inout.found: what is near it, of which the still is kept.
    O(solids near)."""
    c = walk_inout.characters[me]
    keep_still(walk_inout, walk_inout.found)
    what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left, c.top, 0, 0, 0.0)
    return what != FREE


@kernel
def lead_out(
    # read
    me,
    reach,
    # write
    walk_inout,
    moved_inout,
):
    """Move a character that stands in a still solid towards the nearest free place, up rather than aside rather than
    down, no further than `reach` [px] off; without one it stays. O(reach · solids near).

    walk_inout: a Walk with what is near as far as that; moved_inout: as walk writes it, with what this adds.
    """
    c = walk_inout.characters[me]
    rows = walk_inout.found
    gather(walk_inout, me, -1, reach + 1.0, reach + 1.0, reach + 1.0, rows)
    way_x = 0
    way_y = 0
    nearest = 2 * reach * reach + 1
    for turn in range(8):
        # Up, left, right, the slants upwards, down, those downwards.
        dx = 0 if turn == 0 or turn == 5 else (-1 if turn == 1 or turn == 3 or turn == 6 else 1)
        dy = -1 if turn == 0 or turn == 3 or turn == 4 else (0 if turn < 3 else 1)
        for far in range(1, reach + 1):
            if far * far * (dx * dx + dy * dy) >= nearest:
                break
            what, by, slope = blocked_at(walk_inout, me, rows, c.left + far * dx, c.top + far * dy, 0, 0, GIVE)
            if what == FREE:
                nearest = far * far * (dx * dx + dy * dy)
                pixels = min(far, PACE)
                way_x = pixels * dx
                way_y = pixels * dy
                break
    c.left += way_x
    c.top += way_y
    moved_inout[0] += way_x
    moved_inout[1] += way_y
    if way_x != 0 or way_y != 0:
        settle(me, walk_inout)
        feel(me, walk_inout)
