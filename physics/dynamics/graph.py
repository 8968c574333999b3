"""From contact points to constraints in a canonical order: grouped by manifold, coloured, sorted by colour.

Within one colour no two constraints share a body that can be pushed, so their order, and any number of lanes or
threads that take them at once, gives the same bits. Contacts with what cannot be pushed get the last colours: they
are solved last and win. Source: Catto, SIMD Matters, 2024 (graph colouring of contacts).
"""

from physics.jit import kernel, subkernel
from physics.settings import COLORS


@kernel
def group_contacts(
    # read
    motions,
    contacts,
    # write
    groups_out,
):
    """List the manifolds (first contact, number of points): neighbouring contacts of a pair on one normal, two at most.

    motions MOTION, contacts CONTACT rows in the order of pairs; sensors, pairs of which neither side can be pushed, and
    what lies under the feet of a character are left out. groups_out (contacts, 2) int32. Returns the number of manifolds. O(contacts).
    """
    found = 0
    i = 0
    while i < len(contacts):
        c = contacts[i]
        a = motions[c.body_row_a]
        b = motions[c.body_row_b]
        if (
            c.sensor
            or a.inverse_mass + b.inverse_mass == 0.0
            or (a.walks and c.normal_y > abs(c.normal_x))
            or (b.walks and -c.normal_y > abs(c.normal_x))
        ):
            i += 1
            continue
        count = 1
        if i + 1 < len(contacts):
            d = contacts[i + 1]
            if (
                d.shape_a == c.shape_a
                and d.shape_b == c.shape_b
                and d.normal_x == c.normal_x
                and d.normal_y == c.normal_y
            ):
                count = 2
        groups_out[found, 0] = i
        groups_out[found, 1] = count
        found += 1
        i += count
    return found


@subkernel
def free_color(taken, last_first):
    """The first colour whose bit is not set, from the end with last_first 1; -1 when all are taken."""
    for k in range(COLORS):
        color = COLORS - 1 - k if last_first == 1 else k
        if (taken >> color) & 1 == 0:
            return color
    return -1


@kernel
def color_groups(
    # read
    motions,
    contacts,
    groups,
    count,
    # write
    taken_out,
    degrees_out,
    colors_out,
    starts_out,
):
    """Give every manifold, in order, the first colour that neither of its pushable bodies has yet.

    groups (count, 2) from group_contacts; taken_out (bodies) int64 bits of the colours a body has, degrees_out
    (bodies) int64 how many manifolds; colors_out (count) int32, -1 where none was free; starts_out (COLORS + 2): where each colour starts, the colourless first. O(count).
    """
    for i in range(len(taken_out)):
        taken_out[i] = 0
        degrees_out[i] = 0
    for i in range(len(starts_out)):
        starts_out[i] = 0
    for i in range(count):
        c = contacts[groups[i, 0]]
        taken = 0
        still = 0
        if motions[c.body_row_a].inverse_mass > 0.0:
            taken |= taken_out[c.body_row_a]
        else:
            still = 1
        if motions[c.body_row_b].inverse_mass > 0.0:
            taken |= taken_out[c.body_row_b]
        else:
            still = 1
        degrees_out[c.body_row_a] += 1
        degrees_out[c.body_row_b] += 1
        color = free_color(taken, still)
        colors_out[i] = color
        if color >= 0:
            bit = 1 << color
            taken_out[c.body_row_a] |= bit
            taken_out[c.body_row_b] |= bit
        starts_out[color + 2] += 1
    for i in range(1, len(starts_out)):
        starts_out[i] += starts_out[i - 1]


@kernel
def order_groups(
    # read
    groups,
    count,
    colors,
    starts,
    # write
    cursors_out,
    ordered_out,
):
    """Sort the manifolds by colour, keeping their order within one. cursors_out: scratch as long as starts. O(count)."""
    for i in range(len(starts)):
        cursors_out[i] = starts[i]
    for i in range(count):
        slot = colors[i] + 1
        at = cursors_out[slot]
        cursors_out[slot] = at + 1
        ordered_out[at, 0] = groups[i, 0]
        ordered_out[at, 1] = groups[i, 1]
        ordered_out[at, 2] = colors[i]
