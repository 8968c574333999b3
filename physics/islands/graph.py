"""The constraint graph: islands, substep classes and graph colours of constraints of any kind.

An edge names a constraint by its kind and row, and its nodes, one to four bodies. Islands are found by union-find over
the edges in their canonical order, with the lowest node as the root. They are the same whichever broad phase found the
edges (Catto, Box2D v3, Simulation Islands, 2023). Within one colour no two edges share a dynamic node. So their order,
and the number of lanes or threads that process them at once, does not change a bit of the result (Catto, SIMD Matters,
2024). Edges with a node of infinite mass get the last colours: they are solved last and prevail.
"""

from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.settings import COLORS
from physics.tables.table import join_trees, root_of

CONTACT_EDGE = 0  # kinds of constraints
MOST_NODES = 4  # bodies that one constraint acts on
NO_NODE = -1


class Edges(NamedTuple):
    """Constraints as edges of the graph."""

    kinds: np.ndarray  # (edges) int32 kind of the constraint
    rows: np.ndarray  # (edges) int32 its row in the table of its kind
    nodes: np.ndarray  # (edges, MOST_NODES) int32 its bodies, NO_NODE after the last
    impact_speeds: np.ndarray  # (edges) float64 [px/s] of an impact within the step; 0: none
    resting: np.ndarray  # (edges) bool it carries a load without impact
    keeps_awake: np.ndarray  # (edges) bool its bodies may not sleep
    overlaps: np.ndarray  # (edges) float64 [px]
    faces: np.ndarray  # (edges, 2) float64 normal out of a body of infinite mass that it overlaps; 0: none
    face_speeds: np.ndarray  # (edges) float64 [px/s] of that body at the contact


def new_edges(room: int) -> Edges:
    """Return room for that many edges."""
    return Edges(
        kinds=np.zeros(room, np.int32),
        rows=np.zeros(room, np.int32),
        nodes=np.full((room, MOST_NODES), NO_NODE, np.int32),
        impact_speeds=np.zeros(room),
        resting=np.zeros(room, np.bool_),
        keeps_awake=np.zeros(room, np.bool_),
        overlaps=np.zeros(room),
        faces=np.zeros((room, 2)),
        face_speeds=np.zeros(room),
    )


@inlined
def write_pair(edge, row, node_a, node_b, edges_out):
    """Write the edge of a contact between two nodes; NO_NODE for a side that it does not act on."""
    edges_out.kinds[edge] = CONTACT_EDGE
    edges_out.rows[edge] = row
    edges_out.nodes[edge, 0] = node_a
    edges_out.nodes[edge, 1] = node_b
    edges_out.nodes[edge, 2] = NO_NODE


@kernel
def join(
    # read
    edges,
    count,
    # write
    parents_inout,
):
    """Join the islands of the nodes of each edge. parents_inout: union-find parents. O(count)."""
    for i in range(count):
        for k in range(1, MOST_NODES):
            if edges.nodes[i, k] < 0:
                break
            join_trees(edges.nodes[i, 0], edges.nodes[i, k], parents_inout)


@subkernel
def find_roots(
    # read
    edges,
    count,
    links_islands,
    # write
    parents_out,
):
    """Write the root of its island, its lowest node, as parent of every node. O(nodes + count).

    links_islands (nodes) bool: other nodes belong to no island; parents_out (nodes) int32.
    """
    for i in range(len(parents_out)):
        parents_out[i] = i
    for i in range(count):
        first = NO_NODE
        for k in range(MOST_NODES):
            node = edges.nodes[i, k]
            if node < 0:
                break
            if links_islands[node]:
                if first >= 0:
                    join_trees(first, node, parents_out)
                else:
                    first = node
    for i in range(len(parents_out)):
        parents_out[i] = root_of(i, parents_out)


@subkernel
def share_classes(parents, classes_inout):
    """Raise the class of every node to the greatest of its island. parents, classes_inout (nodes) int32: see
    find_roots."""
    for i in range(len(parents)):
        root = parents[i]
        classes_inout[root] = max(classes_inout[root], classes_inout[i])
    for i in range(len(parents)):
        classes_inout[i] = classes_inout[parents[i]]


KINEMATIC_RANK, STATIC_RANK = 1, 2  # of bodies of infinite mass; 0: of all others, and of characters, which give way
STATIC_COLORS = 12  # colours that contacts with kinematic bodies leave to those with static ones


@subkernel
def free_color(taken, rank):
    """Return the first colour whose bit is not set, from the end with a rank; -1 when all are taken."""
    last = COLORS - 1 - (STATIC_COLORS if rank == KINEMATIC_RANK else 0)
    for k in range(COLORS):
        color = k
        if rank > 0:
            color = last - k if k <= last else COLORS - 1 - (k - last - 1)
        if (taken >> color) & 1 == 0:
            return color
    return -1


@subkernel
def color_edges(
    # read
    edges,
    count,
    has_finite_mass,
    rank,
    # write
    taken_out,
    degrees_out,
    colors_out,
):
    """Assign to every edge, in order, the first colour that none of its dynamic nodes has yet.

    Later colours are solved later, so they win where contacts oppose one another: those with kinematic bodies come
    after all others, those with static ones last. has_finite_mass (nodes) bool: an impulse changes its velocity; rank
    (nodes) int8: KINEMATIC_RANK, STATIC_RANK. taken_out (nodes) int64 bits of the colours of a node, degrees_out
    (nodes) int64 its number of edges; colors_out (count) int32, -1 where no colour was free. O(nodes + count).
    """
    for i in range(len(taken_out)):
        taken_out[i] = 0
        degrees_out[i] = 0
    for i in range(count):
        taken = 0
        greatest = 0
        for k in range(MOST_NODES):
            node = edges.nodes[i, k]
            if node < 0:
                break
            if has_finite_mass[node]:
                taken |= taken_out[node]
            elif rank[node] > greatest:
                greatest = rank[node]
            degrees_out[node] += 1
        color = free_color(taken, greatest)
        colors_out[i] = color
        if color >= 0:
            bit = 1 << color
            for k in range(MOST_NODES):
                if edges.nodes[i, k] < 0:
                    break
                taken_out[edges.nodes[i, k]] |= bit


@subkernel
def slot_of(edge, edges, colors, classes):
    """Return the slot of an edge: one for each colour of each class, edges without a colour first."""
    slot = colors[edge] + 1
    if len(classes) > 0:
        most = 0
        for k in range(MOST_NODES):
            if edges.nodes[edge, k] < 0:
                break
            most = max(most, classes[edges.nodes[edge, k]])
        slot += most * (COLORS + 1)
    return slot


@subkernel
def add_up(starts_inout, cursors_out):
    """Turn counts, each stored one slot further on, into the starts of the slots; cursors_out: a copy."""
    for i in range(1, len(starts_inout)):
        starts_inout[i] += starts_inout[i - 1]
    for i in range(len(starts_inout)):
        cursors_out[i] = starts_inout[i]


@subkernel
def order_edges(
    # read
    edges,
    count,
    colors,
    classes,
    # write
    starts_out,
    cursors_out,
    places_out,
):
    """Sort the edges by class and colour, stable within one: places_out (count) int32, the new place of each. O(count).

    classes (nodes) int32, 0 for a node in no island; empty if there is only one class. starts_out: start of each slot,
    and end of the last; cursors_out: scratch of the same length.
    """
    for i in range(len(starts_out)):
        starts_out[i] = 0
    for i in range(count):
        starts_out[slot_of(i, edges, colors, classes) + 1] += 1
    add_up(starts_out, cursors_out)
    for i in range(count):
        slot = slot_of(i, edges, colors, classes)
        places_out[i] = cursors_out[slot]
        cursors_out[slot] += 1


@subkernel
def order_nodes(
    # read
    nodes,
    classes,
    # write
    starts_out,
    cursors_out,
    ordered_out,
):
    """Sort nodes by class, stable within one: ordered_out (nodes) int32. O(nodes).

    starts_out: start of each class, and end of the last; cursors_out: scratch of the same length.
    """
    for i in range(len(starts_out)):
        starts_out[i] = 0
    for k in range(len(nodes)):
        starts_out[classes[nodes[k]] + 1] += 1
    add_up(starts_out, cursors_out)
    for k in range(len(nodes)):
        at = cursors_out[classes[nodes[k]]]
        cursors_out[classes[nodes[k]]] = at + 1
        ordered_out[at] = nodes[k]
