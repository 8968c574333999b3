"""Whether what moves stands in a character that could not give way: it is squeezed as long as that is so."""

from physics.character.chains import deepest_link
from physics.character.ground import FREE, GIVE
from physics.character.meet import meet, place_outline
from physics.character.solids import gather, in_shape
from physics.character.workspace import character_of
from physics.jit import subkernel
from physics.tables.body import KINEMATIC, STATIC
from physics.tables.shape import CHAIN


@subkernel
def depth_in(me, row, walk_inout):
    """(depth [px], normal from the character) of a character where it is, in a loose shape."""
    c = walk_inout.characters[me]
    if walk_inout.shapes[row].kind == CHAIN:
        return deepest_link(walk_inout, me, row, c.left, c.top)
    count, radius = place_outline(walk_inout, me, c.left, c.top)
    depth, nx, ny, x, y = meet(walk_inout, row, count, radius)
    return depth, nx, ny


@subkernel
def is_in_drawn(me, row, walk_inout):
    """Whether a character is, where it is, in a shape that keeps to the pixel grid: some way there leads deeper."""
    c = walk_inout.characters[me]
    for side in range(-1, 2, 2):
        what, slope = in_shape(walk_inout, me, row, c.left, c.top, side, 0, 0.0)
        if what != FREE:
            return True
        what, slope = in_shape(walk_inout, me, row, c.left, c.top, 0, side, 0.0)
        if what != FREE:
            return True
    return False


@subkernel
def is_crushed(me, all_kinds, walk_inout):
    """Whether something that moves stands in a character by more than what is loose may. O(solids near).

    all_kinds: also what the solver pushes on, else only what goes its way by itself.
    """
    gather(walk_inout, me, -1, 0.0, 0.0, 0.0, walk_inout.found)
    for k in range(1, walk_inout.found[0] + 1):
        loose = walk_inout.found[k] < 0
        row = -1 - walk_inout.found[k] if loose else walk_inout.found[k]
        s = walk_inout.shapes[row]
        kind = walk_inout.bodies[s.body_row].kind
        if kind == STATIC or (kind != KINEMATIC and not all_kinds) or character_of(walk_inout.characters, s.body) >= 0:
            continue
        if loose:
            depth, nx, ny = depth_in(me, row, walk_inout)
            if depth > GIVE:
                return True
        elif is_in_drawn(me, row, walk_inout):
            return True
    return False
