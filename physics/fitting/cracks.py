"""Following cracks, the sides between solid and clear pixels, from any place on and back.

A corner (x, y) of the pixel grid has four pixels around it, its quadrants, counted clockwise on the screen from the one
right below it; a crack leaves it to the right, down, left or up, in the same order. Paths have the solid to their
right hand: of a crack that leaves in direction d, quadrant d is solid and quadrant d - 1 is clear.

        2 | 3        3
       ---+---     2 + 0
        1 | 0        1
     quadrants   directions

Source: Rosenfeld and Kak 1982, section 11.1.
"""

from typing import NamedTuple

import numpy as np

from physics.jit import subkernel

SHARP = 3  # [px] a corner between two runs of at least this length stays

RUN = np.dtype(
    [  # a straight row of cracks
        ("x", np.int64),  # where it starts
        ("y", np.int64),
        ("direction", np.int64),
        ("length", np.int64),  # [cracks]
        ("at", np.int64),  # cracks of the path before it
        ("joined", np.bool_),  # it starts at a pinch, on whose other side the path passes again
    ],
    align=True,
)


class Window(NamedTuple):
    """The pixels of a tile and of its surroundings."""

    pixels: np.ndarray  # [row, col] uint8, not 0: solid
    low: int  # row and column where the tile begins, and …
    high: int  # … where it ends
    reach: float  # [px] how far lines may leave cracks
    joins: bool  # whether a path may pass between pixels that touch diagonally


@subkernel
def right_of(direction):
    """How far a crack goes to the right: -1, 0 or 1."""
    return (1 if direction == 0 else 0) - (1 if direction == 2 else 0)


@subkernel
def down_of(direction):
    """How far a crack goes down: -1, 0 or 1."""
    return (1 if direction == 1 else 0) - (1 if direction == 3 else 0)


@subkernel
def is_solid(pixels, x, y, quadrant):
    """Whether the pixel in a quadrant of a corner is solid."""
    q = quadrant & 3
    return pixels[y - (1 if q >= 2 else 0), x - (1 if q == 1 or q == 2 else 0)] != 0


@subkernel
def is_own(window, x, y, quadrant):
    """Whether the pixel in a quadrant of a corner belongs to the tile."""
    q = quadrant & 3
    column = x - (1 if q == 1 or q == 2 else 0)
    row = y - (1 if q >= 2 else 0)
    return window.low <= column < window.high and window.low <= row < window.high


@subkernel
def length_from(pixels, x, y, direction):
    """Cracks in a straight row from a corner, counted up to SHARP; the first one is known to be there."""
    right = is_solid(pixels, x, y, direction)
    count = 1
    while count < SHARP:
        x += right_of(direction)
        y += down_of(direction)
        if is_solid(pixels, x, y, direction) != right or is_solid(pixels, x, y, direction + 3) == right:
            break
        count += 1
    return count


@subkernel
def is_joined(window, x, y):
    """Whether paths pass between the two solid pixels of a pinch: not where a corner between long runs stays, and not
    on a border of tiles, where each side would see another one."""
    if not window.joins or x == window.low or x == window.high or y == window.low or y == window.high:
        return False
    level = max(length_from(window.pixels, x, y, 0), length_from(window.pixels, x, y, 2))
    upright = max(length_from(window.pixels, x, y, 1), length_from(window.pixels, x, y, 3))
    return min(level, upright) < SHARP


@subkernel
def onward(window, x, y, direction):
    """The direction in which a path goes on that arrives at a corner in a direction."""
    if not is_solid(window.pixels, x, y, direction):
        if is_solid(window.pixels, x, y, direction + 3) and is_joined(window, x, y):
            return (direction + 3) & 3
        return (direction + 1) & 3
    return (direction + 3) & 3 if is_solid(window.pixels, x, y, direction + 3) else direction


@subkernel
def backward(window, x, y, direction):
    """The direction in which a path arrives at a corner that leaves it in a direction."""
    if not is_solid(window.pixels, x, y, direction + 1):
        if is_solid(window.pixels, x, y, direction + 2) and is_joined(window, x, y):
            return (direction + 1) & 3
        return (direction + 3) & 3
    return (direction + 1) & 3 if is_solid(window.pixels, x, y, direction + 2) else direction


@subkernel
def walked_back(window, x, y, direction, cracks):
    """(x, y, direction) of the path so many cracks before the one that leaves a corner in a direction."""
    for _ in range(cracks):
        direction = backward(window, x, y, direction)
        x -= right_of(direction)
        y -= down_of(direction)
    return x, y, direction


@subkernel
def follow(window, x, y, direction, marks_inout):
    """Cracks of the path that belong to the tile's pixels, from one on; all of a loop.

    marks_inout: [row, col] uint8: set for each whose solid pixel lies below it.
    """
    first_x = x
    first_y = y
    first = direction
    count = 0
    while is_own(window, x, y, direction):
        if direction == 0:
            marks_inout[y, x] = 1
        count += 1
        x += right_of(direction)
        y += down_of(direction)
        direction = onward(window, x, y, direction)
        if x == first_x and y == first_y and direction == first:
            break
    return count


@subkernel
def record(window, x, y, direction, cracks, runs_out):
    """Write the runs (RUN) of so many cracks of a path. Returns how many runs."""
    count = -1
    turned = True
    joined = False
    for k in range(cracks):
        if turned:
            count += 1
            run = runs_out[count]
            run.x = x
            run.y = y
            run.direction = direction
            run.length = 0
            run.at = k
            run.joined = joined
        runs_out[count].length += 1
        x += right_of(direction)
        y += down_of(direction)
        after = onward(window, x, y, direction)
        turned = after != direction
        joined = not is_solid(window.pixels, x, y, direction) and after == (direction + 3) & 3
        direction = after
    return count + 1
