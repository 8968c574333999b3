"""Two dynamic bounding volume hierarchies with AVL balance, one for static proxies and one for moving ones.

A leaf holds a fat box: a proxy that moves within it costs one comparison. Insertion descends by surface area to a leaf
or its parent, then single rotations restore the AVL balance on the way up. Children have no order, so a single rotation
always suffices, and the height stays within 1.45·log2(n) + 2. When most proxies of a tree change at once, it is rebuilt
by median splits. Source: Catto, Dynamic Bounding Volume Hierarchies, GDC 2019; Adelson-Velsky and Landis 1962.
O(moved · log n). Suits many static bodies and few moving ones.
"""

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.proxies import Arena, Box, Query, find_pairs
from physics.broadphase.tree_nodes import (
    FREE,
    NODE,
    NONE,
    ROOT_MOVING,
    SIZE,
    WIDTH,
    find_pairs_in_bvh4,
    find_pairs_in_trees,
    insert_leaf,
    query_bvh4,
    query_trees,
    rebuild,
    remove_leaf,
    take_node,
    write_bvh4,
    write_stale,
)
from physics.jit import kernel
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, PIXELS_PER_METER
from physics.tables.step_state import REINSERTS

REBUILD_FROM = 64  # up to this many changed proxies, each leaf is moved by itself
STACK = 256  # far above any height that fits in memory: BVH4 nodes push three more for every other level
WIDTHS = (2, WIDTH)
BEST_WIDTH = 2  # BVH4 search is 1.2 to 1.8 times as fast, but moving leaves must update the BVH4 nodes (README)


@kernel
def place_changed(
    # read
    proxies,
    changed,
    margin,
    margin_fraction,
    loose,
    loose_still,
    # write
    leaf_of_inout,
    nodes_inout,
    stale_inout,
    state_inout,
    work_inout,
):
    """Insert, remove, or move the changed proxies; one that is still within its fat box stays. O(moved · log n).

    changed: slots; margin [px] and margin_fraction of the box: the smaller is the margin of a leaf; leaf_of_inout
    (slots): leaf or -1; stale_inout (nodes): nodes whose BVH4 node has to be written, empty without these; state_inout:
    free list, used nodes, stale ones, two roots. loose, loose_still 1: leaves of the moving or the static tree are
    neither linked nor unlinked, because that tree is rebuilt next. Return the number of leaves that were moved.
    """
    moved = 0
    for i in range(len(changed)):
        slot = changed[i]
        p = proxies[slot]
        leaf = leaf_of_inout[slot]
        grow = min(margin, margin_fraction * max(p.upper_x - p.lower_x, p.upper_y - p.lower_y))
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
            # The box of a body that was fast would otherwise stay too large.
            if fits and (
                (n.upper_x - n.lower_x) + (n.upper_y - n.lower_y)
                <= 8.0 * grow + (p.upper_x - p.lower_x) + (p.upper_y - p.lower_y)
            ):
                continue
            moved += 1
            if (loose_still if n.still else loose) == 0:
                remove_leaf(leaf, nodes_inout, stale_inout, state_inout, work_inout)
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
        n.lower_x = p.lower_x - grow
        n.lower_y = p.lower_y - grow
        n.upper_x = p.upper_x + grow
        n.upper_y = p.upper_y + grow
        n.child_a = -1
        n.child_b = -1
        n.height = 0
        n.slot = slot
        n.still = p.still
        if (loose_still if n.still else loose) == 0:
            insert_leaf(leaf, nodes_inout, stale_inout, state_inout, work_inout)
        work_inout[REINSERTS] += 1
    return moved


class DynamicTree:
    """Broad phase with two dynamic bounding volume trees.

    width: boxes a node, 2 or 4, with the same result; None takes the faster one. margin [px]: the largest margin of a
    moving leaf; None takes the setting for 32 px per metre. Raises TypeError, ValueError.
    """

    name = "tree"
    incremental = True

    def __init__(self, width: int | None = None, margin: float | None = None) -> None:
        self.width = BEST_WIDTH if width is None else _checked_width(width)
        self.margin = AABB_MARGIN * PIXELS_PER_METER if margin is None else checks.number("margin", margin, low=0.0)
        self.leaf_of = np.zeros(0, np.int64)
        self.nodes = np.zeros(0, NODE)
        # BVH4 nodes, see tree_nodes.py; empty where nodes have two boxes.
        self.bvh4, self.kin, self.stale = np.zeros(0), np.zeros(0, np.int64), np.zeros(0, np.int64)
        self.state = np.array([-1, 0, 0, -1, -1], np.int64)
        self.stack = np.zeros(STACK, np.int64)
        self.leaves, self.spans, self.twice = np.zeros(0, np.int64), np.zeros((0, 4), np.int64), np.zeros((2, 0))

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return (m, 2) int32 pairs a < b, sorted, of closed boxes (n, 2) lower, upper [px]. Raises ValueError."""
        return find_pairs(self.fresh(), lower, upper)

    def fresh(self) -> "DynamicTree":
        """Return a copy without state."""
        return DynamicTree(self.width, self.margin)

    def update(self, arena: Arena) -> None:
        """Move the leaves whose boxes left their fat boxes."""
        if len(self.leaf_of) < len(arena.proxies):
            slots = max(len(arena.proxies), 2 * len(self.leaf_of))
            self.leaf_of = np.concatenate([self.leaf_of, np.full(slots - len(self.leaf_of), -1, np.int64)])
            # Leaves, inner nodes of both trees, and those of an old tree until it is rebuilt.
            nodes = np.zeros(3 * slots + 2, NODE)
            nodes[: len(self.nodes)] = self.nodes
            self.nodes = nodes
            if self.width == WIDTH:
                self.bvh4 = np.concatenate([self.bvh4, np.zeros(len(nodes) * SIZE - len(self.bvh4))])
                self.stale = np.zeros(len(nodes), np.int64)
                self.kin = np.concatenate([self.kin, np.full(len(nodes) * WIDTH - len(self.kin), NONE)])
        loose, loose_still = self._rebuilds(arena) if len(arena.changed) > REBUILD_FROM else (False, False)
        moved = place_changed(
            arena.proxies,
            arena.changed,
            self.margin,
            AABB_MARGIN_FRACTION,
            int(loose),
            int(loose_still),
            self.leaf_of,
            self.nodes,
            self.stale,
            self.state,
            arena.work,
        )
        if self.width == WIDTH:
            write_stale(self.nodes, self.stale, self.state, self.bvh4, self.kin)
        if len(self.spans) < len(self.leaf_of):
            self.leaves, self.spans = np.zeros(len(self.leaf_of), np.int64), np.zeros((len(self.leaf_of), 4), np.int64)
            self.twice = np.zeros((2, len(self.nodes)))
        for still, wanted in ((0, loose), (1, loose_still)):
            if wanted and moved:
                rebuild(self.leaf_of, still, self.leaves, self.spans, *self.twice, self.nodes, self.state)
                if self.width == WIDTH:
                    write_bvh4(self.nodes, still, self.bvh4, self.kin)

    def _rebuilds(self, arena):
        """Return for the moving and the static tree whether to rebuild it: most of its proxies have changed.

        A rebuild then costs less than moving each leaf, and gives the better tree.
        """
        still = arena.proxies["still"]
        total = np.bincount(still[self.leaf_of[: len(still)] >= 0], minlength=2)
        changed = np.bincount(still[arena.changed], minlength=2)
        return tuple(bool(changed[k] > max(REBUILD_FROM, total[k] // 2)) for k in (0, 1))

    def query(self, arena: Arena) -> Query:
        """Return the function (pairs, work) -> count that lists the pairs of the changed proxies."""
        proxies, changed = arena.proxies, arena.changed
        if self.width == WIDTH:
            return lambda pairs, work: find_pairs_in_bvh4(
                proxies, changed, self.nodes, self.bvh4, self.kin, self.state, self.stack, pairs, work
            )
        return lambda pairs, work: find_pairs_in_trees(
            proxies, changed, self.nodes, self.state, self.stack, pairs, work
        )

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots whose box meets box (lower x, y, upper x, y) [px] to `slots`. Return their number."""
        roots = self.state[ROOT_MOVING:]
        if self.width == WIDTH:
            return query_bvh4(self.nodes, self.bvh4, self.kin, roots, box, self.stack, slots, work)
        return query_trees(self.nodes, roots, box, self.stack, slots, work)

    @property
    def height(self) -> int:
        """Height of the higher of the two trees; 0 for a single leaf, -1 when empty."""
        return max(int(self.nodes[root]["height"]) if root >= 0 else -1 for root in self.state[ROOT_MOVING:])

    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return all nodes: (m, 4) boxes [px] and (m,) depths from the root, for drawing."""
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
        return np.stack([nodes[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")], axis=1), np.array(
            depths, int
        )


def _checked_width(value):
    """Return the width if it is 2 or 4. Raises TypeError, ValueError."""
    width = checks.whole("width", value, *WIDTHS)
    if width not in WIDTHS:
        raise ValueError(f"width must be 2 or 4 (got {width})")
    return width
