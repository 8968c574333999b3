"""Nodes of a bounding volume hierarchy (BVH) with AVL balance: insert, remove, rebuild, search."""

import math

import numpy as np

from physics.broadphase.proxies import meets_box, overlaps, write_pair
from physics.jit import inlined, kernel, subkernel
from physics.tables.step_state import NODES_VISITED

# ---- tree nodes ------------------------------------------------------------------------------------------------------
# Nodes of a BVH with AVL balance: insert, remove, rotate, improve.
#
# Children have no order, so a single rotation always restores the balance. Source: Catto, Dynamic Bounding Volume
# Hierarchies, GDC 2019; Adelson-Velsky and Landis 1962.

NODE = np.dtype(
    [
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),  # [px]
        ("parent", np.int64),  # of a free node: the next free one
        ("child_a", np.int64),
        ("child_b", np.int64),  # -1 in a leaf
        ("height", np.int64),  # 0 in a leaf, -1 in a free node
        ("slot", np.int64),  # of the proxy in a leaf, else -1
        ("still", np.bool_),
        ("stale", np.bool_),  # is in the list of nodes whose BVH4 node has to be written
    ],
    align=True,
)
FREE, USED, STALE, ROOT_MOVING, ROOT_STILL = range(5)  # indices into the state array


@subkernel
def joined_outline(nodes, a, b):
    """Return half the outline [px] of the box around two nodes: the surface area heuristic in two dimensions."""
    p = nodes[a]
    q = nodes[b]
    return (max(p.upper_x, q.upper_x) - min(p.lower_x, q.lower_x)) + (
        max(p.upper_y, q.upper_y) - min(p.lower_y, q.lower_y)
    )


@subkernel
def refit(index, nodes_inout):
    """Write a node's box and height from its children."""
    n = nodes_inout[index]
    p = nodes_inout[n.child_a]
    q = nodes_inout[n.child_b]
    n.lower_x = min(p.lower_x, q.lower_x)
    n.lower_y = min(p.lower_y, q.lower_y)
    n.upper_x = max(p.upper_x, q.upper_x)
    n.upper_y = max(p.upper_y, q.upper_y)
    n.height = 1 + max(p.height, q.height)


@subkernel
def replace_child(parent, old, new, root, nodes_inout, state_inout):
    """Replace a child of a parent, or the root."""
    nodes_inout[new].parent = parent
    if parent < 0:
        state_inout[root] = new
    elif nodes_inout[parent].child_a == old:
        nodes_inout[parent].child_a = new
    else:
        nodes_inout[parent].child_b = new


@subkernel
def rotate(index, root, nodes_inout, state_inout):
    """Raise the higher child when it is two levels above the other. Return the node that is now at this place.

         A                  C
        / \\                / \\
       B   C      ->      A   F      F the higher of C's children (of equal ones, G joins B if their box is smaller)
          / \\            / \\
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
    a.child_a = other
    a.child_b = goes
    nodes_inout[goes].parent = index
    c.child_a = index
    c.child_b = stays
    a.parent = up
    refit(index, nodes_inout)
    refit(up, nodes_inout)
    return up


@subkernel
def swap_pays(upper, lower_parent, lower, nodes):
    """Return the outline [px] saved by swapping a child with a grandchild on the other side; 0 where it would
    unbalance.

    upper: child of the node; lower: child of upper's sibling lower_parent.
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
    """Swap a child with a grandchild on the other side if that shrinks the box between and keeps the AVL balance.

    Return whether nodes were swapped. Source: Catto, GDC 2019, after Kopta et al. 2012, with the balance test added.
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
        return False
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
    return True


@subkernel
def note_stale(index, nodes_inout, stale_inout, state_inout):
    """Add a node to the list of those whose BVH4 node has to be written, once."""
    n = nodes_inout[index]
    if not n.stale:
        n.stale = True
        stale_inout[state_inout[STALE]] = index
        state_inout[STALE] += 1


@subkernel
def repair_upward(index, root, nodes_inout, stale_inout, state_inout, work_inout):
    """Balance and refit from a node up to the root; list the stale BVH4 nodes, if they are in use. O(height)."""
    while index >= 0:
        work_inout[NODES_VISITED] += 1
        refit(index, nodes_inout)
        top = rotate(index, root, nodes_inout, state_inout)
        swapped = improve(top, nodes_inout)
        if len(stale_inout) > 0:
            note_stale(top, nodes_inout, stale_inout, state_inout)
            if swapped or top != index:
                # A rotation or swap here changed this node or one of its children.
                note_stale(nodes_inout[top].child_a, nodes_inout, stale_inout, state_inout)
                note_stale(nodes_inout[top].child_b, nodes_inout, stale_inout, state_inout)
        index = top
        index = nodes_inout[index].parent


@subkernel
def take_node(nodes_inout, state_inout):
    """Return the index of a free node. The caller ensures that there is one."""
    index = state_inout[FREE]
    if index >= 0:
        state_inout[FREE] = nodes_inout[index].parent
    else:
        index = state_inout[USED]
        state_inout[USED] = index + 1
    return index


@subkernel
def insert_leaf(leaf, nodes_inout, stale_inout, state_inout, work_inout):
    """Insert a leaf beside the sibling that costs the least outline. O(height)."""
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
    p.child_a = at
    p.child_b = leaf
    nodes_inout[at].parent = parent
    nodes_inout[leaf].parent = parent
    repair_upward(parent, root, nodes_inout, stale_inout, state_inout, work_inout)


@subkernel
def remove_leaf(leaf, nodes_inout, stale_inout, state_inout, work_inout):
    """Remove a leaf: its sibling takes the parent's place. O(height)."""
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
    repair_upward(above, root, nodes_inout, stale_inout, state_inout, work_inout)


# ---- tree fours ------------------------------------------------------------------------------------------------------
# BVH4 nodes: an inner node stores the boxes of its four grandchildren side by side, to be tested at once.
#
# A search skips every other level, and compares four boxes without a branch. The tree stays binary; changes update the
# BVH4 nodes on the way up. A child that is a leaf is one of the four itself. Source:
# Wald, Benthin, Boulos: Getting Rid of Packets, 2008 (four boxes for one ray); Rapier's parry does so for collisions.

WIDTH = 4
# Where the coordinates of a BVH4 node begin: lower x, lower y, upper x, upper y, four of each.
LOWER_X, LOWER_Y, UPPER_X, UPPER_Y = 0, WIDTH, 2 * WIDTH, 3 * WIDTH
SIZE = 4 * WIDTH
NONE = -1  # no node; a leaf is encoded by its slot, from FIRST_LEAF down
FIRST_LEAF = -2


@subkernel
def write_one(index, nodes, lane, at, fours_out, kin_out):
    """Write a node's box into one of the four places of the BVH4 node `at`."""
    n = nodes[index]
    base = at * SIZE + lane
    fours_out[base + LOWER_X] = n.lower_x
    fours_out[base + LOWER_Y] = n.lower_y
    fours_out[base + UPPER_X] = n.upper_x
    fours_out[base + UPPER_Y] = n.upper_y
    kin_out[at * WIDTH + lane] = index if n.height > 0 else FIRST_LEAF - n.slot


@subkernel
def write_four(index, nodes, fours_out, kin_out):
    """Write the BVH4 node of an inner node."""
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
        fours_out[base + LOWER_X] = math.nan  # NaN overlaps nothing, not even an infinite box
        fours_out[base + LOWER_Y] = math.nan
        fours_out[base + UPPER_X] = math.nan
        fours_out[base + UPPER_Y] = math.nan
        kin_out[index * WIDTH + lane] = NONE
        lane += 1


@kernel
def write_stale(nodes_inout, stale_inout, state_inout, fours_out, kin_out):
    """Write the BVH4 nodes in the stale list, and empty it. O(stale)."""
    for k in range(state_inout[STALE]):
        n = nodes_inout[stale_inout[k]]
        n.stale = False
        if n.height > 0:
            write_four(stale_inout[k], nodes_inout, fours_out, kin_out)
    state_inout[STALE] = 0


@kernel
def write_bvh4(nodes, still, fours_out, kin_out):
    """Write the BVH4 node of every inner node of the static tree (still 1) or the moving one (0). O(nodes)."""
    for index in range(len(nodes)):
        if nodes[index].height > 0 and nodes[index].still == (still == 1):
            write_four(index, nodes, fours_out, kin_out)


@inlined
def push_met(bvh4, kin, at, box, depth, stack_out):
    """Push those of a BVH4 node's children that overlap a closed box [px] on a stack. Return its new depth.

    There is no branch: the next child overwrites one that does not overlap.
    """
    lower_x, lower_y, upper_x, upper_y = box
    for lane in range(WIDTH):
        k = at * SIZE + lane
        meets = (
            (bvh4[k + LOWER_X] <= upper_x)
            & (bvh4[k + UPPER_X] >= lower_x)
            & (bvh4[k + LOWER_Y] <= upper_y)
            & (bvh4[k + UPPER_Y] >= lower_y)
        )
        stack_out[depth] = kin[at * WIDTH + lane]
        depth += int(meets)
    return depth


# ---- tree rebuild ----------------------------------------------------------------------------------------------------
# Rebuild of one of the two trees by median splits: least height, and tight boxes.


@subkernel
def select_median(along, first, last, middle, leaves_inout):
    """Reorder leaves first..last so that none before `middle` lies beyond it in `along` (quickselect, Hoare 1961)."""
    low = first
    high = last
    while low < high:
        pivot = along[leaves_inout[(low + high) // 2]]
        i = low
        j = high
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
    """Return the extent of leaves first..last in `along`."""
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
    """Rebuild the tree of the static leaves (still 1) or of the moving ones (0) by median splits.

    leaf_of (slots): leaf or -1; scratch: leaves_out (slots), spans_out (slots, 4), twice_x_out, twice_y_out (nodes):
    twice the middle of each leaf's box [px]. The inner nodes of the old tree are freed first. O(n log n).
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
    # Each span: first leaf, last leaf, its node, the parent. A node precedes its children, so that a backward refit
    # visits children first.
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
        # The larger half first; a half of one leaf is linked directly.
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
# Search of the two trees of a DynamicTree: with two boxes a node, or with four at once.


@kernel
def find_pairs_in_trees(proxies, changed, nodes, state, stack_inout, pairs_out, work_inout):
    """List the pairs with a changed side, by descending both trees with each changed box.

    changed: slots; stack_inout: scratch. Return the number of pairs. O(changed · log n + pairs).
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
    """List the slots whose leaf meets a closed box [px], from the roots down. Return their number. O(log n + found)."""
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


@kernel
def find_pairs_in_bvh4(proxies, changed, nodes, bvh4, kin, state, stack_inout, pairs_out, work_inout):
    """List the same pairs as find_pairs_in_trees, four boxes at a time. O(changed · log n + pairs)."""
    found = 0
    for i in range(len(changed)):
        a = changed[i]
        p = proxies[a]
        if p.row < 0:
            continue
        depth = 0
        for tree in range(ROOT_MOVING, ROOT_STILL + 1):
            root = state[tree]
            if root >= 0 and not (tree == ROOT_STILL and p.still):
                stack_inout[depth] = root if nodes[root].height > 0 else FIRST_LEAF - nodes[root].slot
                depth += 1
        while depth > 0:
            depth -= 1
            at = stack_inout[depth]
            if at <= FIRST_LEAF:
                b = FIRST_LEAF - at
                if b != a and not (proxies[b].changed and b < a) and overlaps(proxies, a, b, work_inout):
                    found = write_pair(a, b, found, pairs_out)
                continue
            work_inout[NODES_VISITED] += 1
            box = (p.lower_x, p.lower_y, p.upper_x, p.upper_y)
            depth = push_met(bvh4, kin, at, box, depth, stack_inout)
    return found


@kernel
def query_bvh4(nodes, bvh4, kin, roots, box, stack_inout, slots_out, work_inout):
    """List the same slots as query_trees, four boxes at a time. Return their number. O(log n + found)."""
    found = 0
    depth = 0
    for k in range(len(roots)):
        if roots[k] < 0:
            continue
        n = nodes[roots[k]]
        if n.height > 0:
            stack_inout[depth] = roots[k]
            depth += 1
        else:
            work_inout[NODES_VISITED] += 1
            if meets_box(n, box):
                slots_out[found] = n.slot
                found += 1
    while depth > 0:
        depth -= 1
        at = stack_inout[depth]
        if at <= FIRST_LEAF:
            slots_out[found] = FIRST_LEAF - at
            found += 1
            continue
        work_inout[NODES_VISITED] += 1
        depth = push_met(bvh4, kin, at, box, depth, stack_inout)
    return found
