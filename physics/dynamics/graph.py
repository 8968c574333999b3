"""The graph of bodies and constraints: islands, adjacency, colours.
A constraint of any kind is an edge (a, b) of two nodes.

Union-find over the edges in their canonical order, the lower node as the root, so islands are the same whatever found
the edges (Catto, Box2D v3, Simulation Islands, 2023). Within one colour no two constraints share a node that can be
pushed, so their order, and any number of lanes or threads that take them at once, gives the same bits (Catto, SIMD
Matters, 2024). Edges with what cannot be pushed get the last colours: they are solved last and win.
"""

from physics.jit import kernel, subkernel
from physics.settings import COLORS


@subkernel
def root_of(node, parents_inout):
    """The root of a node's island, halving the path to it."""
    while parents_inout[node] != node:
        parents_inout[node] = parents_inout[parents_inout[node]]
        node = parents_inout[node]
    return node


@kernel
def join(
    # read
    edges,
    count,
    # write
    parents_inout,
):
    """Join the islands of each edge's nodes. edges (count, 2) int32; parents_inout: root, or way to it. O(count)."""
    for i in range(count):
        first = root_of(edges[i, 0], parents_inout)
        second = root_of(edges[i, 1], parents_inout)
        if first < second:
            parents_inout[second] = first
        elif second < first:
            parents_inout[first] = second


@subkernel
def free_color(taken, last_first):
    """The first colour whose bit is not set, from the end with last_first 1; -1 when all are taken."""
    for k in range(COLORS):
        color = COLORS - 1 - k if last_first == 1 else k
        if (taken >> color) & 1 == 0:
            return color
    return -1


@kernel
def color_edges(
    # read
    edges,
    count,
    pushable,
    # write
    taken_out,
    degrees_out,
    colors_out,
    starts_out,
):
    """Give every edge, in order, the first colour that neither of its pushable nodes has yet.

    edges (count, 2) int32 nodes; pushable (nodes) bool; taken_out (nodes) int64 bits of the colours that a node has,
    degrees_out (nodes) int64 how many edges; colors_out (count) int32, -1 where none was free; starts_out (COLORS + 2):
    where each colour starts, the colourless first. O(nodes + count).
    """
    for i in range(len(taken_out)):
        taken_out[i] = 0
        degrees_out[i] = 0
    for i in range(len(starts_out)):
        starts_out[i] = 0
    for i in range(count):
        a = edges[i, 0]
        b = edges[i, 1]
        taken = 0
        still = 0
        if pushable[a]:
            taken |= taken_out[a]
        else:
            still = 1
        if pushable[b]:
            taken |= taken_out[b]
        else:
            still = 1
        degrees_out[a] += 1
        degrees_out[b] += 1
        color = free_color(taken, still)
        colors_out[i] = color
        if color >= 0:
            bit = 1 << color
            taken_out[a] |= bit
            taken_out[b] |= bit
        starts_out[color + 2] += 1
    for i in range(1, len(starts_out)):
        starts_out[i] += starts_out[i - 1]


@kernel
def order_edges(
    # read
    count,
    colors,
    starts,
    # write
    cursors_out,
    ordered_out,
):
    """Sort the edges by colour, keeping their order within one: ordered_out (count) int32 edge numbers.

    cursors_out: scratch as long as starts. O(count).
    """
    for i in range(len(starts)):
        cursors_out[i] = starts[i]
    for i in range(count):
        slot = colors[i] + 1
        at = cursors_out[slot]
        cursors_out[slot] = at + 1
        ordered_out[at] = i
