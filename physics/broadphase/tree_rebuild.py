"""Builds one of the two trees anew by median splits: the least height there is, and tight boxes."""

from physics.broadphase.tree_nodes import FREE, ROOT_MOVING, ROOT_STILL, USED, refit, take_node
from physics.jit import kernel, subkernel


@subkernel
def select_median(along, first, last, middle, leaves_inout):
    """Reorder leaves first..last so that none before `middle` lies beyond it in `along`. Source: Hoare 1961."""
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
    """How far leaves first..last lie apart in `along`."""
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
def rebuild(
    # read
    leaf_of,
    still,
    # write
    leaves_out,
    spans_out,
    twice_x_out,
    twice_y_out,
    nodes_inout,
    state_inout,
):
    """Build the tree of the still leaves (still 1) or of the moving ones (0) anew by median splits.

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
    # Each span: first leaf, last leaf, its node, the parent. A node stands before its children, so that refitting
    # backwards meets children first.
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
        # The larger half first; a half of one leaf hangs here itself.
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
