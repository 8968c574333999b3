"""Four boxes a node: an inner node keeps those of its children's children side by side, to be tested at once.

A search passes over every other level, and compares four boxes without a branch. The tree stays one of two children;
what changes in it writes the fours anew on the way up. A child that is a leaf is one of the four itself. Source: Wald,
Benthin, Boulos: Getting Rid of Packets, 2008 (four boxes for one ray); Rapier's parry does so for collisions.
"""

import math

from physics.broadphase.tree_nodes import STALE
from physics.jit import inlined, kernel, subkernel

WIDTH = 4
# Where the numbers of a node's four begin, in units of four: lower x, lower y, upper x, upper y.
LOWER_X, LOWER_Y, UPPER_X, UPPER_Y = 0, WIDTH, 2 * WIDTH, 3 * WIDTH
SIZE = 4 * WIDTH
NONE = -1  # in place of a node; leaves are told by their slot, from FIRST_LEAF down
FIRST_LEAF = -2


@subkernel
def write_one(index, nodes, lane, at, fours_out, kin_out):
    """Write a node into a lane of the four at `at`."""
    n = nodes[index]
    base = at * SIZE + lane
    fours_out[base + LOWER_X] = n.lower_x
    fours_out[base + LOWER_Y] = n.lower_y
    fours_out[base + UPPER_X] = n.upper_x
    fours_out[base + UPPER_Y] = n.upper_y
    kin_out[at * WIDTH + lane] = index if n.height > 0 else FIRST_LEAF - n.slot


@subkernel
def write_four(index, nodes, fours_out, kin_out):
    """Write the four of an inner node."""
    lane = 0
    for side in range(2):
        child = nodes[index].child_a if side == 0 else nodes[index].child_b
        c = nodes[child]
        if c.height == 0:
            write_one(child, nodes, lane, index, fours_out, kin_out)
            lane += 1
        else:
            write_one(c.child_a, nodes, lane, index, fours_out, kin_out)
            write_one(c.child_b, nodes, lane + 1, index, fours_out, kin_out)
            lane += 2
    while lane < WIDTH:
        base = index * SIZE + lane
        fours_out[base + LOWER_X] = math.nan  # which meets nothing, not even what is infinite
        fours_out[base + LOWER_Y] = math.nan
        fours_out[base + UPPER_X] = math.nan
        fours_out[base + UPPER_Y] = math.nan
        kin_out[index * WIDTH + lane] = NONE
        lane += 1


@kernel
def write_stale(
    # write
    nodes_inout,
    stale_inout,
    state_inout,
    fours_out,
    kin_out,
):
    """Write the fours of the nodes on the list, and empty it. O(stale)."""
    for k in range(state_inout[STALE]):
        n = nodes_inout[stale_inout[k]]
        n.stale = False
        if n.height > 0:
            write_four(stale_inout[k], nodes_inout, fours_out, kin_out)
    state_inout[STALE] = 0


@kernel
def write_fours(
    # read
    nodes,
    still,
    # write
    fours_out,
    kin_out,
):
    """Write the four of every inner node of the still tree (1) or the moving one (0). O(nodes)."""
    for index in range(len(nodes)):
        if nodes[index].height > 0 and nodes[index].still == (still == 1):
            write_four(index, nodes, fours_out, kin_out)


@inlined
def push_met(fours, kin, at, lower_x, lower_y, upper_x, upper_y, depth, stack_out):
    """Put those of a node's four that meet a closed box [px] on a stack; its new depth. Without a branch: what does not
    meet is written over."""
    for lane in range(WIDTH):
        k = at * SIZE + lane
        meets = (
            (fours[k + LOWER_X] <= upper_x)
            & (fours[k + UPPER_X] >= lower_x)
            & (fours[k + LOWER_Y] <= upper_y)
            & (fours[k + UPPER_Y] >= lower_y)
        )
        stack_out[depth] = kin[at * WIDTH + lane]
        depth += int(meets)
    return depth
