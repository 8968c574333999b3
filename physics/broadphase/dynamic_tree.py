"""Broad phase of two dynamic bounding volume hierarchies with AVL balance: one for static proxies, one for moving ones.

A leaf contains the box of a proxy enlarged by a margin (fat box). While a proxy moves within its fat box, an update
takes one comparison.

Insertion descends by the surface area heuristic to a leaf or to the parent of a leaf. Single rotations then restore the
AVL balance from there up to the root. Children have no order, so a single rotation always suffices, and the height is
at most 1.45·log2(n) + 2. If most proxies of a tree change in one step, the tree is rebuilt by median splits.

O(moved · log n). Suitable for many static and few moving bodies. Source: Catto, Dynamic Bounding Volume Hierarchies,
GDC 2019; Adelson-Velsky and Landis 1962.
"""

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.pairs_of_boxes import find_pairs
from physics.broadphase.proxies import Arena, Box, Query, meets_box, overlaps, write_pair
from physics.jit import kernel, subkernel
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, PIXELS_PER_METER
from physics.tables.step_state import NODES_VISITED, REINSERTS

REBUILD_FROM = 64  # up to this number of changed proxies, each leaf is moved by itself
STACK = 256  # far above any height that fits in memory
WIDTH = 2  # boxes of a node. Four, tested together, made a step at most 4 % faster (5,300 bodies, most of them static)

# ---- tree nodes ------------------------------------------------------------------------------------------------------
# Nodes of a bounding volume hierarchy (BVH) with AVL balance: insert, remove, rotate, improve.

NODE = np.dtype(
    [
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),  # [px]
        ("parent", np.int64),  # in a free node: the next free node
        ("child_a", np.int64),
        ("child_b", np.int64),  # -1 in a leaf
        ("height", np.int64),  # 0 in a leaf, -1 in a free node
        ("slot", np.int64),  # slot of the proxy in a leaf, else -1
        ("still", np.bool_),  # belongs to the tree of static proxies
    ],
    align=True,
)
FREE, USED, ROOT_MOVING, ROOT_STILL = range(4)  # indices into the state array


@subkernel
def joined_outline(nodes, a, b):
    """Return half the perimeter [px] of the smallest box around the boxes of two nodes.

    In 2D this is the cost in the surface area heuristic. nodes: NODE rows; a, b: indices of the two nodes.
    """
    p, q = nodes[a], nodes[b]
    return (max(p.upper_x, q.upper_x) - min(p.lower_x, q.lower_x)) + (
        max(p.upper_y, q.upper_y) - min(p.lower_y, q.lower_y)
    )


@subkernel
def refit(index, nodes_inout):
    """Compute the box and the height of node number `index` from the boxes and heights of its two children.

    nodes_inout: NODE rows, of which row `index` is written.
    """
    n = nodes_inout[index]
    p, q = nodes_inout[n.child_a], nodes_inout[n.child_b]
    n.lower_x, n.lower_y = min(p.lower_x, q.lower_x), min(p.lower_y, q.lower_y)
    n.upper_x, n.upper_y = max(p.upper_x, q.upper_x), max(p.upper_y, q.upper_y)
    n.height = 1 + max(p.height, q.height)


@subkernel
def replace_child(parent, old, new, root, nodes_inout, state_inout):
    """Replace the node `old` by the node `new` as a child of `parent`, or as the root of the tree if `parent` is -1.

    parent, old, new: indices of nodes; root: index of the tree's root in state_inout, ROOT_MOVING or ROOT_STILL;
    nodes_inout: NODE rows; state_inout: see place_changed.
    """
    nodes_inout[new].parent = parent
    if parent < 0:
        state_inout[root] = new
    elif nodes_inout[parent].child_a == old:
        nodes_inout[parent].child_a = new
    else:
        nodes_inout[parent].child_b = new


@subkernel
def rotate(index, root, nodes_inout, state_inout):
    """Rotate node number `index` (A) if its higher child (C) is two levels higher than its other child (B).

    Return the number of the node that is then the upper one, C or A. root, nodes_inout, state_inout: see replace_child.

      A                  C
     / \\                / \\
    B   C      ->      A   F      F: the higher child of C. If both are equally high,
       / \\            / \\       G is the child whose joint box with B is smaller.
      F   G          B   G
    """
    a = nodes_inout[index]
    difference = nodes_inout[a.child_b].height - nodes_inout[a.child_a].height
    if -1 <= difference <= 1:
        return index
    up = a.child_b if difference > 1 else a.child_a
    other = a.child_a if difference > 1 else a.child_b
    c = nodes_inout[up]
    stays = c.child_a
    goes = c.child_b
    if nodes_inout[stays].height < nodes_inout[goes].height or (
        nodes_inout[stays].height == nodes_inout[goes].height
        and joined_outline(nodes_inout, other, stays) < joined_outline(nodes_inout, other, goes)
    ):
        stays, goes = goes, stays
    replace_child(a.parent, index, up, root, nodes_inout, state_inout)
    a.child_a, a.child_b = other, goes
    nodes_inout[goes].parent = index
    c.child_a, c.child_b = index, stays
    a.parent = up
    refit(index, nodes_inout)
    refit(up, nodes_inout)
    return up


@subkernel
def swap_pays(upper, lower_parent, lower, nodes):
    """Return by how much half the perimeter [px] of lower_parent's box shrinks if `upper` and `lower` are swapped.

    The result is 0 if the swap would violate the AVL balance. upper, lower_parent, lower: indices of nodes;
    lower_parent is the sibling of `upper` and the parent of `lower`. nodes: NODE rows.
    """
    q = nodes[lower_parent]
    other = q.child_b if q.child_a == lower else q.child_a
    height = nodes[upper].height
    difference = height - nodes[other].height
    new_height = 1 + max(height, nodes[other].height)
    outer = nodes[lower].height - new_height
    if difference < -1 or difference > 1 or outer < -1 or outer > 1:
        return 0.0
    return joined_outline(nodes, lower_parent, lower_parent) - joined_outline(nodes, upper, other)


@subkernel
def improve(index, nodes_inout):
    """Swap one child of node number `index` with a child of the other child, if a box shrinks and AVL balance is kept.

    Of all such swaps, the one with the greatest decrease is made. nodes_inout: NODE rows. Source: Catto, GDC 2019,
    after Kopta et al. 2012; the balance test is added here.
    """
    n = nodes_inout[index]
    best = 0.0
    best_upper = -1
    best_parent = -1
    best_lower = -1
    for side in range(2):
        upper = n.child_a if side == 0 else n.child_b
        parent = n.child_b if side == 0 else n.child_a
        if nodes_inout[parent].height == 0:
            continue
        for k in range(2):
            lower = nodes_inout[parent].child_a if k == 0 else nodes_inout[parent].child_b
            saved = swap_pays(upper, parent, lower, nodes_inout)
            if saved > best:
                best = saved
                best_upper = upper
                best_parent = parent
                best_lower = lower
    if best_upper < 0:
        return
    q = nodes_inout[best_parent]
    if q.child_a == best_lower:
        q.child_a = best_upper
    else:
        q.child_b = best_upper
    if n.child_a == best_upper:
        n.child_a = best_lower
    else:
        n.child_b = best_lower
    nodes_inout[best_upper].parent = best_parent
    nodes_inout[best_lower].parent = index
    refit(best_parent, nodes_inout)
    refit(index, nodes_inout)


@subkernel
def repair_upward(index, root, nodes_inout, state_inout, work_inout):
    """Call refit, rotate and improve for each node from number `index` up to the root. O(height).

    root: index of the root in state_inout, ROOT_MOVING or ROOT_STILL; nodes_inout: NODE rows; state_inout: see
    place_changed; work_inout: counters, see COUNTERS.
    """
    while index >= 0:
        work_inout[NODES_VISITED] += 1
        refit(index, nodes_inout)
        top = rotate(index, root, nodes_inout, state_inout)
        improve(top, nodes_inout)
        index = nodes_inout[top].parent


@subkernel
def take_node(nodes_inout, state_inout):
    """Allocate a node from the list of free nodes or, if the list is empty, the next unused node. Return its index.

    The caller ensures that a node is available. nodes_inout: NODE rows; state_inout: see place_changed.
    """
    index = state_inout[FREE]
    if index >= 0:
        state_inout[FREE] = nodes_inout[index].parent
    else:
        index = state_inout[USED]
        state_inout[USED] = index + 1
    return index


@subkernel
def insert_leaf(leaf, nodes_inout, state_inout, work_inout):
    """Insert a leaf into its tree. The sibling of the leaf is chosen by the surface area heuristic. O(height).

    leaf: index of the leaf; nodes_inout: NODE rows; state_inout: see place_changed; work_inout: counters, see COUNTERS.
    """
    root = ROOT_STILL if nodes_inout[leaf].still else ROOT_MOVING
    at = state_inout[root]
    if at < 0:
        state_inout[root] = leaf
        nodes_inout[leaf].parent = -1
        return
    while nodes_inout[at].height > 0:
        work_inout[NODES_VISITED] += 1
        n = nodes_inout[at]
        here = joined_outline(nodes_inout, at, leaf)
        grown = here - joined_outline(nodes_inout, at, at)  # growth of every node above the sibling
        cost_a = joined_outline(nodes_inout, n.child_a, leaf) + grown
        if nodes_inout[n.child_a].height > 0:
            cost_a -= joined_outline(nodes_inout, n.child_a, n.child_a)
        cost_b = joined_outline(nodes_inout, n.child_b, leaf) + grown
        if nodes_inout[n.child_b].height > 0:
            cost_b -= joined_outline(nodes_inout, n.child_b, n.child_b)
        # A stop above the parent of a leaf could need more than one rotation to balance.
        if n.height == 1 and here < cost_a and here < cost_b:
            break
        at = n.child_a if cost_a <= cost_b else n.child_b
    parent = take_node(nodes_inout, state_inout)
    p = nodes_inout[parent]
    p.slot = -1
    p.still = nodes_inout[leaf].still
    replace_child(nodes_inout[at].parent, at, parent, root, nodes_inout, state_inout)
    p.child_a, p.child_b = at, leaf
    nodes_inout[at].parent = parent
    nodes_inout[leaf].parent = parent
    repair_upward(parent, root, nodes_inout, state_inout, work_inout)


@subkernel
def remove_leaf(leaf, nodes_inout, state_inout, work_inout):
    """Remove a leaf from its tree, and replace the leaf's parent by the leaf's sibling. O(height).

    leaf: index of the leaf; nodes_inout: NODE rows; state_inout: see place_changed; work_inout: counters, see COUNTERS.
    """
    root = ROOT_STILL if nodes_inout[leaf].still else ROOT_MOVING
    parent = nodes_inout[leaf].parent
    if parent < 0:
        state_inout[root] = -1
        return
    p = nodes_inout[parent]
    sibling = p.child_b if p.child_a == leaf else p.child_a
    above = p.parent
    replace_child(above, parent, sibling, root, nodes_inout, state_inout)
    p.height = -1
    p.parent = state_inout[FREE]
    state_inout[FREE] = parent
    repair_upward(above, root, nodes_inout, state_inout, work_inout)


# ---- tree rebuild ----------------------------------------------------------------------------------------------------
# Rebuild of one of the two trees by median splits: least height, and tight boxes.


@subkernel
def select_median(along, first, last, middle, leaves_inout):
    """Partition leaves_inout[first] to leaves_inout[last] at position `middle` by the values of `along` (quickselect).

    Afterwards no leaf before this position has a greater value than the leaf at this position, and no leaf after it a
    smaller value. along: value of each leaf; leaves_inout: indices of leaves. Source: Hoare 1961.
    """
    low, high = first, last
    while low < high:
        pivot = along[leaves_inout[(low + high) // 2]]
        i, j = low, high
        while i <= j:
            while along[leaves_inout[i]] < pivot:
                i += 1
            while along[leaves_inout[j]] > pivot:
                j -= 1
            if i <= j:
                leaves_inout[i], leaves_inout[j] = leaves_inout[j], leaves_inout[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            return


@subkernel
def spread(along, leaves, first, last):
    """Return the greatest minus the least value of `along` for the leaves leaves[first] to leaves[last].

    along: value of each leaf; leaves: indices of leaves.
    """
    low = along[leaves[first]]
    high = low
    for k in range(first + 1, last + 1):
        value = along[leaves[k]]
        if value < low:
            low = value
        if value > high:
            high = value
    return high - low


@kernel
def rebuild(leaf_of, still, leaves_out, spans_out, twice_x_out, twice_y_out, nodes_inout, state_inout):
    """Rebuild the tree of the static leaves (still 1) or of the moving leaves (still 0) by median splits. O(n log n).

    The inner nodes of the old tree are freed first. leaf_of: (slots,) index of each proxy's leaf, or -1; nodes_inout:
    NODE rows; state_inout: see place_changed. Scratch arrays: leaves_out (slots,); spans_out (slots, 4); twice_x_out,
    twice_y_out (nodes,), twice the centre of each leaf's box [px].
    """
    root = ROOT_STILL if still == 1 else ROOT_MOVING
    count = 0
    for slot in range(len(leaf_of)):
        if leaf_of[slot] >= 0 and nodes_inout[leaf_of[slot]].still == (still == 1):
            leaf = leaf_of[slot]
            leaves_out[count] = leaf
            count += 1
            n = nodes_inout[leaf]
            twice_x_out[leaf] = n.lower_x + n.upper_x
            twice_y_out[leaf] = n.lower_y + n.upper_y
    for index in range(state_inout[USED]):
        n = nodes_inout[index]
        if n.height > 0 and n.still == (still == 1):
            n.height = -1
            n.parent = state_inout[FREE]
            state_inout[FREE] = index
    if count < 2:
        state_inout[root] = leaves_out[0] if count == 1 else -1
        if count == 1:
            nodes_inout[leaves_out[0]].parent = -1
        return
    # A span is the range of leaves below one node: first leaf, last leaf, node, parent of the node. A node precedes its
    # children, so a backward refit visits the children first.
    made = 1
    spans_out[0, 0] = 0
    spans_out[0, 1] = count - 1
    spans_out[0, 3] = -1
    at = 0
    while at < made:
        first = spans_out[at, 0]
        last = spans_out[at, 1]
        parent = spans_out[at, 3]
        index = take_node(nodes_inout, state_inout)
        n = nodes_inout[index]
        n.slot = -1
        n.still = still == 1
        n.parent = parent
        n.height = 1
        n.child_a = -1
        spans_out[at, 2] = index
        if parent < 0:
            state_inout[root] = index
        elif nodes_inout[parent].child_a < 0:
            nodes_inout[parent].child_a = index
        else:
            nodes_inout[parent].child_b = index
        middle = (first + last + 1) // 2
        wide = spread(twice_x_out, leaves_out, first, last) >= spread(twice_y_out, leaves_out, first, last)
        if wide:
            select_median(twice_x_out, first, last, middle, leaves_out)
        else:
            select_median(twice_y_out, first, last, middle, leaves_out)
        # The larger half comes first; a half of one leaf is linked directly.
        for half in range(2):
            start = middle if half == 0 else first
            end = last if half == 0 else middle - 1
            if start == end:
                leaf = leaves_out[start]
                nodes_inout[leaf].parent = index
                n.child_b = leaf
                if half == 0:
                    n.child_a = leaf
            else:
                spans_out[made, 0] = start
                spans_out[made, 1] = end
                spans_out[made, 3] = index
                made += 1
        at += 1
    for k in range(made):
        refit(spans_out[made - 1 - k, 2], nodes_inout)


# ---- tree search -----------------------------------------------------------------------------------------------------
# Search of the two trees of a DynamicTree.


@kernel
def find_pairs_in_trees(proxies, changed, nodes, state, stack_inout, pairs_out, work_inout):
    """Write the overlapping pairs that contain a changed proxy, and return their number. O(changed · log n + pairs).

    Both trees are searched with the box of each changed proxy; with a static proxy only the tree of moving proxies.
    proxies: PROXY table; changed: slots of the changed proxies; nodes: NODE rows; state: see place_changed;
    stack_inout: scratch; pairs_out: (capacity, 2) int32, the slots of each pair; work_inout: counters, see COUNTERS.
    """
    found = 0
    for i in range(len(changed)):
        a = changed[i]
        p = proxies[a]
        if p.row < 0:
            continue
        depth = 0
        if state[ROOT_MOVING] >= 0:
            stack_inout[depth] = state[ROOT_MOVING]
            depth += 1
        if state[ROOT_STILL] >= 0 and not p.still:
            stack_inout[depth] = state[ROOT_STILL]
            depth += 1
        while depth > 0:
            depth -= 1
            n = nodes[stack_inout[depth]]
            work_inout[NODES_VISITED] += 1
            if n.lower_x > p.upper_x or p.lower_x > n.upper_x or n.lower_y > p.upper_y or p.lower_y > n.upper_y:
                continue
            if n.height > 0:
                stack_inout[depth] = n.child_a
                stack_inout[depth + 1] = n.child_b
                depth += 2
                continue
            b = n.slot
            if b != a and not (proxies[b].changed and b < a) and overlaps(proxies, a, b, work_inout):
                found = write_pair(a, b, found, pairs_out)
    return found


@kernel
def query_trees(nodes, roots, box, stack_inout, slots_out, work_inout):
    """Write the slots of the proxies whose fat boxes overlap `box`, and return the number of slots. O(log n + found).

    nodes: NODE rows of both trees; roots: index of the root of each tree, -1 for an empty tree; box: (lower x, lower y,
    upper x, upper y) [px]; stack_inout: scratch; slots_out: the result; work_inout: counters, see COUNTERS.
    """
    found = 0
    depth = 0
    for k in range(len(roots)):
        if roots[k] >= 0:
            stack_inout[depth] = roots[k]
            depth += 1
    while depth > 0:
        depth -= 1
        n = nodes[stack_inout[depth]]
        work_inout[NODES_VISITED] += 1
        if not meets_box(n, box):
            continue
        if n.height > 0:
            stack_inout[depth] = n.child_a
            stack_inout[depth + 1] = n.child_b
            depth += 2
        else:
            slots_out[found] = n.slot
            found += 1
    return found


@subkernel
def search_trees(box, structure_inout, slots_out, work_inout):
    """Search the proxies whose fat boxes overlap a box, see query_trees. Return the number of proxies found.

    structure_inout: result of DynamicTree.structure, (nodes, roots, stack); other arguments: see query_trees.
    """
    nodes, roots, stack_inout = structure_inout
    return query_trees(nodes, roots, box, stack_inout, slots_out, work_inout)


# ---- dynamic tree ----------------------------------------------------------------------------------------------------
# The broad phase made of both trees.


@kernel
def place_changed(proxies, changed, margins, loose, leaf_of_inout, nodes_inout, state_inout, work_inout):
    """Insert, remove, or move the leaves of the changed proxies. Return the number of leaves changed. O(moved · log n).

    A leaf is not moved while its proxy is within the leaf's fat box. The margin of a fat box is the smaller of two
    lengths.

    changed: slots of the changed proxies. margins: (margin [px], margin as a share of the box's size). loose: (flag of
    the moving tree, flag of the static tree); 1 if the caller rebuilds this tree next, so that its leaves need not be
    linked here. leaf_of_inout: (slots,) index of each proxy's leaf, or -1. state_inout: (first free node, number of
    used nodes, root of the moving tree, root of the static tree). nodes_inout: NODE rows; work_inout: counters, see
    COUNTERS.
    """
    moved = 0
    for i in range(len(changed)):
        slot = changed[i]
        p = proxies[slot]
        leaf = leaf_of_inout[slot]
        grow = min(margins[0], margins[1] * max(p.upper_x - p.lower_x, p.upper_y - p.lower_y))
        if leaf >= 0:
            n = nodes_inout[leaf]
            fits = (
                p.row >= 0
                and n.still == p.still
                and n.lower_x <= p.lower_x
                and n.lower_y <= p.lower_y
                and n.upper_x >= p.upper_x
                and n.upper_y >= p.upper_y
            )
            # The box of a body that was fast would otherwise remain too large.
            if fits and (
                (n.upper_x - n.lower_x) + (n.upper_y - n.lower_y)
                <= 8.0 * grow + (p.upper_x - p.lower_x) + (p.upper_y - p.lower_y)
            ):
                continue
            moved += 1
            if (loose[1] if n.still else loose[0]) == 0:
                remove_leaf(leaf, nodes_inout, state_inout, work_inout)
            if p.row < 0:
                n.height = -1
                n.parent = state_inout[FREE]
                state_inout[FREE] = leaf
                leaf_of_inout[slot] = -1
                continue
        elif p.row < 0:
            continue
        else:
            leaf = take_node(nodes_inout, state_inout)
            leaf_of_inout[slot] = leaf
            moved += 1
        n = nodes_inout[leaf]
        if p.still:
            grow = 0.0
        n.lower_x, n.lower_y = p.lower_x - grow, p.lower_y - grow
        n.upper_x, n.upper_y = p.upper_x + grow, p.upper_y + grow
        n.child_a, n.child_b = -1, -1
        n.height = 0
        n.slot = slot
        n.still = p.still
        if (loose[1] if n.still else loose[0]) == 0:
            insert_leaf(leaf, nodes_inout, state_inout, work_inout)
        work_inout[REINSERTS] += 1
    return moved


class DynamicTree:
    """Broad phase with two dynamic bounding volume trees, one for static and one for moving proxies.

    width: number of children of an inner node; 2, or None, which means 2.
    margin: the greatest margin of a moving leaf's box [px], >= 0; None: the default for a world of 32 px per metre.

    Raises TypeError or ValueError for another width, and for a margin that is not a number >= 0.
    """

    name = "tree"
    incremental = True

    def __init__(self, width: int | None = None, margin: float | None = None) -> None:
        self.width = WIDTH if width is None else checks.whole("width", width, WIDTH, WIDTH)
        self.margin = AABB_MARGIN * PIXELS_PER_METER if margin is None else checks.number("margin", margin, low=0.0)
        self.leaf_of = np.zeros(0, np.int64)
        self.nodes = np.zeros(0, NODE)
        self.state = np.array([-1, 0, -1, -1], np.int64)
        self.stack = np.zeros(STACK, np.int64)
        self.leaves, self.spans, self.twice = np.zeros(0, np.int64), np.zeros((0, 4), np.int64), np.zeros((2, 0))

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

        lower, upper: corners of n boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        return find_pairs(self.fresh(), lower, upper)

    __copy__ = checks.independent("copy.deepcopy(…), or DynamicTree()")

    def fresh(self) -> "DynamicTree":
        """Return a new broad phase with the same settings and without proxies."""
        return DynamicTree(self.width, self.margin)

    def update(self, arena: Arena) -> None:
        """Insert leaves for new proxies, remove leaves of freed proxies, and move leaves whose proxy left its fat box.

        arena: the Arena with the proxies and the slots of the changed ones.
        """
        if len(self.leaf_of) < len(arena.proxies):
            slots = max(len(arena.proxies), 2 * len(self.leaf_of))
            self.leaf_of = np.concatenate([self.leaf_of, np.full(slots - len(self.leaf_of), -1, np.int64)])
            # Leaves, inner nodes of both trees, and inner nodes of an old tree until it is rebuilt.
            nodes = np.zeros(3 * slots + 2, NODE)
            nodes[: len(self.nodes)] = self.nodes
            self.nodes = nodes
        loose = self._rebuilds(arena) if len(arena.changed) > REBUILD_FROM else (0, 0)
        moved = place_changed(
            arena.proxies,
            arena.changed,
            (self.margin, AABB_MARGIN_FRACTION),
            loose,
            self.leaf_of,
            self.nodes,
            self.state,
            arena.work,
        )
        if len(self.spans) < len(self.leaf_of):
            self.leaves, self.spans = np.zeros(len(self.leaf_of), np.int64), np.zeros((len(self.leaf_of), 4), np.int64)
            self.twice = np.zeros((2, len(self.nodes)))
        for still in (0, 1):
            if loose[still] and moved:
                rebuild(self.leaf_of, still, self.leaves, self.spans, *self.twice, self.nodes, self.state)

    def _rebuilds(self, arena):
        """Return which trees are to be rebuilt: (flag of the moving tree, flag of the static tree), each 0 or 1.

        A tree is rebuilt if most of its proxies have changed, because this takes less time than moving each leaf, and
        gives a better tree. arena: see proxies.Arena.
        """
        still = arena.proxies["still"]
        total = np.bincount(still[self.leaf_of[: len(still)] >= 0], minlength=2)
        changed = np.bincount(still[arena.changed], minlength=2)
        return tuple(int(changed[k] > max(REBUILD_FROM, total[k] // 2)) for k in (0, 1))

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the overlapping pairs that contain a changed proxy.

        arena: the Arena with the proxies and the slots of the changed ones.

        The function writes the slots of each pair to `pairs`, (capacity, 2) int32. It returns the number of pairs, even
        if they do not fit, and increases `work`, the counters named in COUNTERS.
        """
        proxies, changed = arena.proxies, arena.changed
        return lambda pairs, work: find_pairs_in_trees(
            proxies, changed, self.nodes, self.state, self.stack, pairs, work
        )

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose fat boxes overlap a box to `slots`, and return the number of slots.

        proxies: PROXY table (unused); box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.

        Proxies whose own boxes are outside the box by less than the margin may also be found.
        """
        nodes, roots, stack = self.structure(proxies)
        return query_trees(nodes, roots, box, stack, slots, work)

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return (nodes, roots, stack), which is the argument `structure_inout` of the kernel search_trees.

        proxies: PROXY table, unused.
        """
        return self.nodes, self.state[ROOT_MOVING:], self.stack

    @property
    def height(self) -> int:
        """The greater of the heights of both trees: 0 for a single leaf, -1 if both trees are empty."""
        return max(int(self.nodes[root]["height"]) if root >= 0 else -1 for root in self.state[ROOT_MOVING:])

    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return all nodes of both trees, for drawing: (boxes (m, 4) [px], depths (m,)), sorted by depth.

        The columns of the boxes are lower x, lower y, upper x, upper y. The depth of a root is 0.
        """
        roots = self.state[ROOT_MOVING:]
        levels = [roots[roots >= 0]]  # the nodes of each depth
        while len(levels[-1]):
            inner = self.nodes[levels[-1]]
            inner = inner[inner["height"] > 0]
            levels.append(np.stack([inner["child_a"], inner["child_b"]], axis=1).ravel())
        nodes = self.nodes[np.concatenate(levels)]
        boxes = np.stack([nodes[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")], axis=1)
        return boxes, np.repeat(np.arange(len(levels)), [len(each) for each in levels])
