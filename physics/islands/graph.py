"""Constraint graph: islands, substep classes and graph colours of constraints.

An edge of the graph is a constraint. Its nodes are the one to four bodies on which the constraint acts. Islands are
found by union-find over the edges in the order of shape ids, with the lowest node as the root. They therefore do not
depend on the broad phase (Catto, Box2D v3, Simulation Islands, 2023). A substep class is the index of a number of
substeps.

No two edges of one colour share a node of finite mass. The result is therefore the same to the bit for any order of the
edges within a colour. It does not depend on the number of SIMD lanes or threads either (Catto, SIMD Matters, 2024).
Edges with a static or kinematic body get the last colours. They are solved last, and prevail over other edges.
"""

from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.settings import COLORS
from physics.tables.table import join_trees, root_of

CONTACT_EDGE, JOINT_EDGE = 0, 1  # kinds of constraints
MOST_NODES = 4  # bodies that one constraint acts on
NO_NODE = -1  # value of a node without a body


class Edges(NamedTuple):
    """Constraints as edges of the graph, with one array for each property of an edge."""

    kinds: np.ndarray  # (edges) int32 CONTACT_EDGE or JOINT_EDGE
    rows: np.ndarray  # (edges) int32 CONTACT or JOINT row
    nodes: np.ndarray  # (edges, MOST_NODES) int32 bodies of the constraint, NO_NODE after the last
    impact_speeds: np.ndarray  # (edges) float64 [px/s] speed of an impact within the step; 0: no impact
    resting: np.ndarray  # (edges) bool the first point of the contact touches, and is too slow to bounce
    keeps_awake: np.ndarray  # (edges) bool bodies of the constraint may not sleep
    overlaps: np.ndarray  # (edges) float64 [px] depth of overlap
    faces: np.ndarray  # (edges, 2) float64 normal out of an overlapped body of infinite mass; (0, 0): none
    face_speeds: np.ndarray  # (edges) float64 [px/s] speed of that body at the contact
    face_kinematic: np.ndarray  # (edges) bool that body is kinematic


def new_edges(room: int) -> Edges:
    """Return Edges with room for `room` edges."""
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
        face_kinematic=np.zeros(room, np.bool_),
    )


@inlined
def write_pair(edge, kind, row, node_a, node_b, edges_out):
    """Write a constraint between two nodes as one edge of the graph.

    edge: index of the edge; kind: CONTACT_EDGE or JOINT_EDGE; row: row number in CONTACT or JOINT; node_b: NO_NODE if
    the constraint acts on node_a only. edges_out: see Edges.
    """
    edges_out.kinds[edge] = kind
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
    """Merge the islands of all nodes of each edge (union-find). O(count).

    count: number of edges; parents_inout (nodes,): parent of each node in the union-find forest.
    """
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
    """Write the root of the island of each node: the lowest node of the island. O(nodes + count).

    count: number of edges; links_islands (nodes,) bool: True if edges of the node merge islands, False if the node is
    always an island of its own; parents_out (nodes,): int32 roots.
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
    """Raise the substep class of each node to the greatest class of a node in its island.

    parents (nodes,): int32 root of the island of each node, from find_roots; classes_inout (nodes,): int32.
    """
    for i in range(len(parents)):
        root = parents[i]
        classes_inout[root] = max(classes_inout[root], classes_inout[i])
    for i in range(len(parents)):
        classes_inout[i] = classes_inout[parents[i]]


# Ranks of bodies of infinite mass: contacts with a higher rank are solved later. All other bodies, and characters that
# are not wedged, have rank 0.
KINEMATIC_RANK, STATIC_RANK = 1, 2
STATIC_COLORS = 12  # number of last colours that are preferred for contacts with static bodies


@subkernel
def free_color(taken, rank):
    """Return a free colour, whose bit in `taken` is not set, or -1 if all bits are set.

    rank 0: the first free colour. STATIC_RANK: the last free colour. KINEMATIC_RANK: the last free colour before the
    STATIC_COLORS last ones, or one of these if no other is free. taken: bit k is set if colour k is taken.
    """
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
    """Colour the edges greedily. No two edges of one colour share a node of finite mass. O(nodes + count).

    Later colours are solved later, and so prevail over opposing contacts. Edges with kinematic nodes get late colours,
    and edges with static nodes get the last colours. count: number of edges; has_finite_mass (nodes,) bool; rank
    (nodes,): int8, see KINEMATIC_RANK; taken_out (nodes,): int64, one bit for each colour at the node; degrees_out
    (nodes,): int64 number of edges at each node; colors_out (count,): int32, -1 if no colour was free.
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
    """Return the key of an edge for sorting by the greatest substep class of its nodes, then by colour.

    Edges without a colour come first in each class. edge: index of the edge; colors: colour of each edge, -1 for none;
    classes (nodes,): class of each node, empty if there is only one class.
    """
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
    """Turn counts into start indices (prefix sum for a counting sort).

    starts_inout: before the call, number of items with key k at index k + 1; afterwards, start of key k at index k.
    cursors_out: copy of the result, for the caller to advance.
    """
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
    """Sort the edges by substep class and colour (stable counting sort). O(count).

    count: number of edges; colors (count,): int32; classes (nodes,): int32, 0 for a node in no island, empty if there
    is only one class. starts_out: index of the first edge with each key of slot_of, then the number of edges;
    cursors_out: scratch of the same length; places_out (count,): int32 new index of each edge.
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
    """Sort nodes by substep class (stable counting sort). O(nodes).

    classes: int32 class of each node; starts_out: index of the first node of each class, then the number of nodes;
    cursors_out: scratch of the same length; ordered_out (nodes,): int32, the sorted nodes.
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
