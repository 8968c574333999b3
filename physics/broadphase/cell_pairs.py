"""Who meets whom in the cells of a hashed hierarchy of grids: the pairs of what changed, and what a box may meet."""

from physics.broadphase.cells import CELL_RANGE, LEVELS, bucket_at, cell_of
from physics.broadphase.proxies import may_meet, overlaps, write_pair
from physics.jit import kernel, subkernel
from physics.tables.counters import NODES_VISITED, PAIRS_TESTED

CHAINS, NEAR = 8, 64  # cells whose lists are followed side by side; entries that are noted before they are looked at


@subkernel
def follow(entries, p, level, count, chains_inout, near_out):
    """Follow the lists of some cells and note the entries whose boxes meet that of the PROXY row p, until they end or
    there is no more room.

    chains_inout (CHAINS, 3) int64: the next entry of each list, and its cell's column and row; near_out (NEAR,) int64.
    Side by side, as each step waits for its memory; without a branch, as what the tests find is what no processor
    predicts. Returns how many lists have not ended, how many entries are near, and how many were tested.
    """
    near = 0
    tested = 0
    while count > 0 and near + count <= NEAR:
        left = 0
        for i in range(count):
            k = chains_inout[i, 0]
            cell_x = chains_inout[i, 1]
            cell_y = chains_inout[i, 2]
            e = entries[k]  # its box stands in it: most tests read nothing else
            near_out[near] = k
            near += int(
                (e.lower_x <= p.upper_x)
                & (e.upper_x >= p.lower_x)
                & (e.lower_y <= p.upper_y)
                & (e.upper_y >= p.lower_y)
                & (e.cell_x == cell_x)
                & (e.cell_y == cell_y)
                & (e.level == level)
            )
            chains_inout[left, 0] = e.next
            chains_inout[left, 1] = cell_x
            chains_inout[left, 2] = cell_y
            left += int(e.next >= 0)
        tested += count
        count = left
    return count, near, tested


@kernel
def find_in_cells(
    # read
    proxies,
    changed,
    base,
    levels,
    heads,
    entries,
    lists,
    level_heads,
    level_counts,
    # write
    chains_out,
    near_out,
    pairs_out,
    work_inout,
):
    """List the pairs of which a side changed: per level through the cells its box touches, or through the level's list.

    A pair that shares several cells is reported in the one that holds the lower corner of the shared rectangle.
    Returns the number of pairs. O(cells + candidates); cells are at most in proportion to the outline of the box.
    """
    mask = len(heads) - 1
    found = 0
    tested = 0
    for i in range(len(changed)):
        a = changed[i]
        p = proxies[a]
        if p.row < 0:
            continue
        for level in range(LEVELS + 1):
            if level_counts[level] == 0:
                continue
            by_list = level == LEVELS or levels[a] == LEVELS
            first_x = 0
            first_y = 0
            last_x = -1
            last_y = -1
            inverse = 1.0
            if not by_list:
                inverse = 1.0 / (base * (1 << level))
                if (p.upper_x - p.lower_x) * inverse + (p.upper_y - p.lower_y) * inverse > level_counts[level] + 4:
                    by_list = True
                else:
                    first_x = cell_of(p.lower_x, inverse)
                    last_x = cell_of(p.upper_x, inverse)
                    first_y = cell_of(p.lower_y, inverse)
                    last_y = cell_of(p.upper_y, inverse)
                    columns = last_x - first_x + 1
                    rows = last_y - first_y + 1
                    by_list = columns * rows > 4 * (columns + rows)
            if by_list:
                b = level_heads[level]
                while b >= 0:
                    if b != a and not (proxies[b].changed and b < a) and overlaps(proxies, a, b, work_inout):
                        found = write_pair(a, b, found, pairs_out)
                    b = lists[b, 1]
                continue
            cell_x = first_x
            cell_y = first_y
            count = 0
            while cell_y <= last_y or count > 0:
                while cell_y <= last_y and count < CHAINS:
                    work_inout[NODES_VISITED] += 1
                    k = heads[bucket_at(level, cell_x, cell_y, mask)]
                    chains_out[count, 0] = k
                    chains_out[count, 1] = cell_x
                    chains_out[count, 2] = cell_y
                    count += int(k >= 0)
                    cell_x += 1
                    if cell_x > last_x:
                        cell_x = first_x
                        cell_y += 1
                count, near, met = follow(entries, p, level, count, chains_out, near_out)
                tested += met
                for i in range(near):
                    e = entries[near_out[i]]
                    b = near_out[i] // 4
                    if (
                        b != a
                        and not (b < a and proxies[b].changed)
                        and cell_of(max(p.lower_x, e.lower_x), inverse) == e.cell_x
                        and cell_of(max(p.lower_y, e.lower_y), inverse) == e.cell_y
                        and may_meet(proxies, a, b, work_inout)
                    ):
                        found = write_pair(a, b, found, pairs_out)
    work_inout[PAIRS_TESTED] += tested
    return found


@kernel
def near_in_cells(
    # read
    base,
    heads,
    entries,
    lists,
    level_heads,
    level_counts,
    proxies,
    lower_x,
    lower_y,
    upper_x,
    upper_y,
    # write
    slots_out,
    work_inout,
):
    """List the slots whose box meets a closed box [px], by the cells or the list of each level. Returns their number.

    A slot that stands in several cells is taken from the one that holds the lower corner of the shared rectangle.
    O(cells + boxes in them); cells are at most in proportion to the outline of the box.
    """
    mask = len(heads) - 1
    reach = max(max(abs(lower_x), abs(upper_x)), max(abs(lower_y), abs(upper_y)))
    found = 0
    for level in range(LEVELS + 1):
        if level_counts[level] == 0:
            continue
        inverse = 1.0
        by_list = level == LEVELS
        if not by_list:
            size = base * (1 << level)
            inverse = 1.0 / (base * (1 << level))
            by_list = (
                not reach < CELL_RANGE * size
                or (upper_x - lower_x) * inverse + (upper_y - lower_y) * inverse > level_counts[level] + 4
            )
        if not by_list:
            columns = cell_of(upper_x, inverse) - cell_of(lower_x, inverse) + 1
            rows = cell_of(upper_y, inverse) - cell_of(lower_y, inverse) + 1
            by_list = columns * rows > level_counts[level] + 4
        if by_list:
            slot = level_heads[level]
            while slot >= 0:
                p = proxies[slot]
                work_inout[PAIRS_TESTED] += 1
                if p.lower_x <= upper_x and p.upper_x >= lower_x and p.lower_y <= upper_y and p.upper_y >= lower_y:
                    slots_out[found] = slot
                    found += 1
                slot = lists[slot, 1]
            continue
        for cell_y in range(cell_of(lower_y, inverse), cell_of(upper_y, inverse) + 1):
            for cell_x in range(cell_of(lower_x, inverse), cell_of(upper_x, inverse) + 1):
                work_inout[NODES_VISITED] += 1
                k = heads[bucket_at(level, cell_x, cell_y, mask)]
                while k >= 0:
                    e = entries[k]
                    work_inout[PAIRS_TESTED] += 1
                    if (
                        e.level == level
                        and e.cell_x == cell_x
                        and e.cell_y == cell_y
                        and e.lower_x <= upper_x
                        and e.upper_x >= lower_x
                        and e.lower_y <= upper_y
                        and e.upper_y >= lower_y
                        and cell_of(max(lower_x, e.lower_x), inverse) == cell_x
                        and cell_of(max(lower_y, e.lower_y), inverse) == cell_y
                    ):
                        slots_out[found] = k // 4
                        found += 1
                    k = e.next
    return found
