"""The cheapest straight lines along a path of cracks: what fitting.outline tells, for kernels."""

import math

import numpy as np

from physics.jit import kernel, subkernel

AREA_PRICE = 0.25  # [corners / px2] what area a line adds or takes counts beside a corner

PLACE = np.dtype(
    [  # where an outline may have corners along a path
        ("x", np.float64),
        ("y", np.float64),
        ("right", np.int64),  # where the path goes on from it
        ("down", np.int64),
        ("corner", np.bool_),  # the path turns here
        ("allowed", np.bool_),  # a line may end here
        ("anchor", np.bool_),  # none may pass
        ("swept", np.float64),  # [px2] twice the area between the path so far and the origin
        ("cost", np.float64),
        ("previous", np.int64),
    ],
    align=True,
)


@subkernel
def try_lines(start, last, reach, places_inout):
    """Lower the costs of places up to a last one that a line from the start may end at (O'Rourke 1981)."""
    begin = places_inout[start]
    x = begin.x
    y = begin.y
    along_x = begin.right
    along_y = begin.down
    least = 0.0  # of dy / (dx + dy), both along the path
    most = 1.0
    bent = False
    for at in range(start, last):
        place = places_inout[at]
        if at > start and place.corner:
            if place.anchor or place.right * along_x < 0 or place.down * along_y < 0:
                return
            along_x = place.right if along_x == 0 else along_x
            along_y = place.down if along_y == 0 else along_y
            rise = along_y * (place.y - y)
            size = along_x * (place.x - x) + rise
            if size > 0.0:
                least = max(least, (rise - reach) / size)
                most = min(most, (rise + reach) / size)
            if least > most:
                return
            bent = True
        to = places_inout[at + 1]
        if not to.allowed:
            continue
        rise = along_y * (to.y - y)
        size = along_x * (to.x - x) + rise
        if not bent or (size > 0.0 and least <= rise / size <= most):
            area = to.swept - begin.swept - (x * to.y - y * to.x)
            cost = begin.cost + 1.0 + AREA_PRICE * 0.5 * abs(area)
            if cost < to.cost:
                to.cost = cost
                to.previous = start


@subkernel
def cheapest(first, last, reach, places_inout, chain_out):
    """Places (rows of PLACE, backward: last to first) that the cheapest lines from first to last have their ends at.

    reach [px]: as in fitting.outline. Returns how many; 0: no lines lead there. O(places * places of a line).
    """
    for k in range(first, last + 1):
        places_inout[k].cost = math.inf
    places_inout[first].cost = 0.0
    for start in range(first, last):
        if places_inout[start].cost < math.inf:
            try_lines(start, last, reach, places_inout)
    if places_inout[last].cost == math.inf:
        return 0
    count = 1
    chain_out[0] = last
    while chain_out[count - 1] != first:
        chain_out[count] = places_inout[chain_out[count - 1]].previous
        count += 1
    return count


@subkernel
def cheapest_loop(around, anchor, reach, places_inout, chain_out):
    """The same round a loop, whose places stand there twice: so many, and so many again, and the first one.

    anchor: the first of those that none may pass, -1: there is none. Returns (how many, where the loop starts).
    """
    begin = anchor
    if anchor < 0:
        # A best polygon may not pass through the first start, but then misses it by one corner at most; the next
        # start is a corner far from it.
        begin = 1
        for _ in range(2):
            found = cheapest(begin, begin + around, reach, places_inout, chain_out)
            begin = chain_out[found - 1 - (found - 1) // 2]
            begin -= around if begin >= around else 0
    return cheapest(begin, begin + around, reach, places_inout, chain_out), begin


@kernel
def lines_of_loop(around, anchor, reach, places_inout, chain_out):
    """cheapest_loop, for whoever makes the places (PLACE) elsewhere. Returns how many."""
    count, _ = cheapest_loop(around, anchor, reach, places_inout, chain_out)
    return count
