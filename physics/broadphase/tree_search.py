"""What meets a box in the two trees of a DynamicTree: by two boxes a node, or by four at once."""

from physics.broadphase.proxies import overlaps, write_pair
from physics.broadphase.tree_fours import FIRST_LEAF, push_met
from physics.broadphase.tree_nodes import ROOT_MOVING, ROOT_STILL
from physics.jit import kernel
from physics.tables.counters import NODES_VISITED


@kernel
def find_in_trees(
    # read
    proxies,
    changed,
    nodes,
    state,
    # write
    stack_inout,
    pairs_out,
    work_inout,
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
def near_in_trees(
    # read
    nodes,
    roots,
    lower_x,
    lower_y,
    upper_x,
    upper_y,
    # write
    stack_inout,
    slots_out,
    work_inout,
):
    """List the slots whose leaf meets a closed box [px], from the roots down; their number. O(log n + found)."""
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
        if n.lower_x > upper_x or n.upper_x < lower_x or n.lower_y > upper_y or n.upper_y < lower_y:
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
def find_in_fours(
    # read
    proxies,
    changed,
    nodes,
    fours,
    kin,
    state,
    # write
    stack_inout,
    pairs_out,
    work_inout,
):
    """List the same pairs as find_in_trees, four boxes at a time. O(changed · log n + pairs)."""
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
            depth = push_met(fours, kin, at, p.lower_x, p.lower_y, p.upper_x, p.upper_y, depth, stack_inout)
    return found


@kernel
def near_in_fours(
    # read
    nodes,
    fours,
    kin,
    roots,
    lower_x,
    lower_y,
    upper_x,
    upper_y,
    # write
    stack_inout,
    slots_out,
    work_inout,
):
    """List the same slots as near_in_trees, four boxes at a time; their number. O(log n + found)."""
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
            if n.lower_x <= upper_x and n.upper_x >= lower_x and n.lower_y <= upper_y and n.upper_y >= lower_y:
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
        depth = push_met(fours, kin, at, lower_x, lower_y, upper_x, upper_y, depth, stack_inout)
    return found
