"""Nodes of a bounding volume tree that stays balanced as AVL trees do: insert, remove, rotate, improve.

Children have no order, so a single rotation always restores the balance. Source: Catto, Dynamic Bounding Volume
Hierarchies, GDC 2019; Adelson-Velsky and Landis 1962.
"""

import numpy as np

from physics.jit import subkernel
from physics.tables.counters import NODES_VISITED

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
        ("stale", np.bool_),  # is on the list of those whose four is to be written
    ],
    align=True,
)
FREE, USED, STALE, ROOT_MOVING, ROOT_STILL = range(5)  # places in the state array


@subkernel
def joined_outline(nodes, a, b):
    """Half the outline [px] of the box around two nodes: the surface area of two dimensions."""
    p = nodes[a]
    q = nodes[b]
    return (max(p.upper_x, q.upper_x) - min(p.lower_x, q.lower_x)) + (
        max(p.upper_y, q.upper_y) - min(p.lower_y, q.lower_y)
    )


@subkernel
def refit(index, nodes_inout):
    """Set a node's box and height from its children."""
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
    """Let a parent, or the root, point to another node."""
    nodes_inout[new].parent = parent
    if parent < 0:
        state_inout[root] = new
    elif nodes_inout[parent].child_a == old:
        nodes_inout[parent].child_a = new
    else:
        nodes_inout[parent].child_b = new


@subkernel
def rotate(index, root, nodes_inout, state_inout):
    """Lift the higher child when it is two levels above the other. Returns the node that now stands here.

         A                  C
        / \\                / \\
       B   C      ->      A   F      F the higher of C's children (of equal ones, the pair that stays smaller)
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
    """Outline [px] that swapping a child with a grandchild on the other side saves; 0 where it would unbalance.

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
    """Swap a child with a grandchild on the other side where that shrinks the box between and keeps the balance.
    Returns whether it did.

    Source: Catto, GDC 2019, after Kopta et al. 2012; the balance test is what keeps the tree an AVL tree.
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
    """Put a node on the list of those whose four is to be written, once."""
    n = nodes_inout[index]
    if not n.stale:
        n.stale = True
        stale_inout[state_inout[STALE]] = index
        state_inout[STALE] += 1


@subkernel
def repair_upward(index, root, nodes_inout, stale_inout, state_inout, work_inout):
    """Balance and refit from a node up to the root; note whose fours are stale, where there are any. O(height)."""
    while index >= 0:
        work_inout[NODES_VISITED] += 1
        refit(index, nodes_inout)
        top = rotate(index, root, nodes_inout, state_inout)
        swapped = improve(top, nodes_inout)
        if len(stale_inout) > 0:
            note_stale(top, nodes_inout, stale_inout, state_inout)
            if swapped or top != index:
                # Whatever was turned or swapped here was this node or a child of it.
                note_stale(nodes_inout[top].child_a, nodes_inout, stale_inout, state_inout)
                note_stale(nodes_inout[top].child_b, nodes_inout, stale_inout, state_inout)
        index = top
        index = nodes_inout[index].parent


@subkernel
def take_node(nodes_inout, state_inout):
    """A free node's index; the caller has made sure that there is one."""
    index = state_inout[FREE]
    if index >= 0:
        state_inout[FREE] = nodes_inout[index].parent
    else:
        index = state_inout[USED]
        state_inout[USED] = index + 1
    return index


@subkernel
def insert_leaf(leaf, nodes_inout, stale_inout, state_inout, work_inout):
    """Hang a leaf beside the sibling that costs the least outline. O(height)."""
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
        grown = here - joined_outline(nodes_inout, at, at)  # every node above the sibling grows by this
        cost_a = joined_outline(nodes_inout, n.child_a, leaf) + grown
        if nodes_inout[n.child_a].height > 0:
            cost_a -= joined_outline(nodes_inout, n.child_a, n.child_a)
        cost_b = joined_outline(nodes_inout, n.child_b, leaf) + grown
        if nodes_inout[n.child_b].height > 0:
            cost_b -= joined_outline(nodes_inout, n.child_b, n.child_b)
        # Stopping higher than a leaf's parent could unbalance by more than one rotation mends.
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
    """Unhang a leaf: its sibling takes the parent's place. O(height)."""
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
