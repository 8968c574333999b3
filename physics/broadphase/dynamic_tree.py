"""Two dynamic bounding volume trees, one for still proxies and one for moving ones, balanced as AVL trees are.

A leaf holds a fat box: a proxy that moves within it costs one comparison. Insertion descends by surface area to a leaf
or its parent, then single rotations restore the AVL balance on the way up; children have no order, so a single rotation
always suffices, and the height stays within 1.45·log2(n) + 2. Source: Catto, Dynamic Bounding Volume Hierarchies,
GDC 2019; Adelson-Velsky and Landis 1962. O(moved · log n). Suits many still things and few moving ones.
"""

import numpy as np

from physics import checks
from physics.broadphase.proxies import find_pairs, overlaps, write_pair
from physics.jit import kernel, subkernel
from physics.profile import NODES_VISITED, REINSERTS
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, PIXELS_PER_METER

NODE = np.dtype([
    ("lower_x", np.float64), ("lower_y", np.float64), ("upper_x", np.float64), ("upper_y", np.float64),   # [px]
    ("parent", np.int64),          # of a free node: the next free one
    ("child_a", np.int64), ("child_b", np.int64),       # -1 in a leaf
    ("height", np.int64),          # 0 in a leaf, -1 in a free node
    ("slot", np.int64),            # of the proxy in a leaf, else -1
    ("still", np.bool_),
], align=True)
FREE, USED, ROOT_MOVING, ROOT_STILL = 0, 1, 2, 3           # places in the state array
STACK = 256                        # far above any height that fits in memory


@subkernel
def joined_outline(nodes, a, b):
    """Half the outline [px] of the box around two nodes: the surface area of two dimensions."""
    p = nodes[a]
    q = nodes[b]
    return (max(p.upper_x, q.upper_x) - min(p.lower_x, q.lower_x)) + (max(p.upper_y, q.upper_y) - min(p.lower_y, q.lower_y))


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
            and joined_outline(nodes_inout, other, stays) < joined_outline(nodes_inout, other, goes)):
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
def repair_upward(index, root, nodes_inout, state_inout, work_inout):
    """Balance and refit from a node up to the root. O(height)."""
    while index >= 0:
        work_inout[NODES_VISITED] += 1
        refit(index, nodes_inout)
        index = rotate(index, root, nodes_inout, state_inout)
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
def insert_leaf(leaf, nodes_inout, state_inout, work_inout):
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
        grown = here - joined_outline(nodes_inout, at, at)       # every node above the sibling grows by this
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
    repair_upward(parent, root, nodes_inout, state_inout, work_inout)


@subkernel
def remove_leaf(leaf, nodes_inout, state_inout, work_inout):
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
    repair_upward(above, root, nodes_inout, state_inout, work_inout)


@kernel
def place_changed(
    # read
    proxies, changed, margin, margin_fraction,
    # write
    leaf_of_inout, nodes_inout, state_inout, work_inout,
):
    """Insert, remove, or move the changed proxies; one that is still within its fat box stays.

    changed: slots; margin [px] and margin_fraction of the box: by the smaller a leaf outgrows it; leaf_of_inout
    (slots): leaf or -1; state_inout: free list, used nodes, two roots. O(moved out of their boxes · log n).
    """
    for i in range(len(changed)):
        slot = changed[i]
        p = proxies[slot]
        leaf = leaf_of_inout[slot]
        grow = min(margin, margin_fraction * max(p.upper_x - p.lower_x, p.upper_y - p.lower_y))
        if leaf >= 0:
            n = nodes_inout[leaf]
            fits = (p.row >= 0 and n.still == p.still and n.lower_x <= p.lower_x and n.lower_y <= p.lower_y
                    and n.upper_x >= p.upper_x and n.upper_y >= p.upper_y)
            # A box that was fast and is no more would stay huge for ever.
            if fits and ((n.upper_x - n.lower_x) + (n.upper_y - n.lower_y)
                         <= 8.0 * grow + (p.upper_x - p.lower_x) + (p.upper_y - p.lower_y)):
                continue
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
        n = nodes_inout[leaf]
        if p.still:
            grow = 0.0
        n.lower_x = p.lower_x - grow
        n.lower_y = p.lower_y - grow
        n.upper_x = p.upper_x + grow
        n.upper_y = p.upper_y + grow
        n.child_a = -1
        n.child_b = -1
        n.height = 0
        n.slot = slot
        n.still = p.still
        insert_leaf(leaf, nodes_inout, state_inout, work_inout)
        work_inout[REINSERTS] += 1


@kernel
def find_in_trees(
    # read
    proxies, changed, nodes, state,
    # write
    stack_inout, pairs_out, work_inout,
):
    """List the pairs of which a side changed, by descending both trees with each changed box.

    changed: slots; stack_inout: scratch. Returns the number of pairs. O(changed · log n + pairs).
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
            if (n.lower_x > p.upper_x or p.lower_x > n.upper_x or n.lower_y > p.upper_y or p.lower_y > n.upper_y):
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


class DynamicTree:
    """margin [px]: how far a moving leaf outgrows its box, at most; None takes the setting for 32 px per metre."""

    name = "tree"

    def __init__(self, margin=None):
        self.margin = AABB_MARGIN * PIXELS_PER_METER if margin is None else checks.number("margin", margin, low=0.0)
        self.leaf_of = np.zeros(0, np.int64)
        self.nodes = np.zeros(0, NODE)
        self.state = np.array([-1, 0, -1, -1], np.int64)
        self.stack = np.zeros(STACK, np.int64)

    def find_pairs(self, lower, upper):
        """(m, 2) int32 pairs a < b, sorted, of closed boxes (n, 2) lower, upper [px]. Raises ValueError."""
        return find_pairs(self.fresh(), lower, upper)

    def fresh(self):
        """A copy without state."""
        return DynamicTree(self.margin)

    def update(self, arena):
        """Move the leaves whose boxes left their fat ones."""
        if len(self.leaf_of) < len(arena.proxies):
            slots = max(len(arena.proxies), 2 * len(self.leaf_of))
            self.leaf_of = np.concatenate([self.leaf_of, np.full(slots - len(self.leaf_of), -1, np.int64)])
            nodes = np.zeros(2 * slots + 2, NODE)
            nodes[:len(self.nodes)] = self.nodes
            self.nodes = nodes
        place_changed(arena.proxies, arena.changed, self.margin, AABB_MARGIN_FRACTION, self.leaf_of, self.nodes,
                      self.state, arena.work)

    def query(self, arena):
        """A function (pairs, work) -> count that lists the pairs of the changed proxies."""
        return lambda pairs, work: find_in_trees(arena.proxies, arena.changed, self.nodes, self.state, self.stack,
                                                 pairs, work)

    @property
    def height(self):
        """Height of the higher of the two trees; 0 for a lone leaf, -1 when empty."""
        return max(int(self.nodes[root]["height"]) if root >= 0 else -1 for root in self.state[ROOT_MOVING:])

    def boxes(self):
        """All nodes: (m, 4) boxes [px] and (m,) depths from the root, for drawing."""
        found, depths = [], []
        for root in self.state[ROOT_MOVING:].tolist():
            todo = [(root, 0)] if root >= 0 else []
            while todo:
                at, depth = todo.pop()
                node = self.nodes[at]
                found.append(at)
                depths.append(depth)
                if node["height"] > 0:
                    todo += [(int(node["child_a"]), depth + 1), (int(node["child_b"]), depth + 1)]
        nodes = self.nodes[found]
        return np.stack([nodes[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")], axis=1), np.array(depths, int)
