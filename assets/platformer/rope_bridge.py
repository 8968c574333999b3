"""A sagging rope bridge: its boards, on which the hero walks, and the ropes behind the hero."""

import numpy as np

from assets.craft.palette import OUTLINE, RAMPS

WIDTH, SAG = 128, 14  # [px] length, and depth of its middle below the ends
BOARD = 8  # [px] width of a board
THICK = 6  # [px] boards and the rope under them, outlines included
RAIL = 12  # [px] height of the ropes above the boards
POST = 3  # [px] width of a post, outlines included


def tops():
    """Return how far the bridge sags in each column: 128 distances of the boards' top below the bridge's ends [px].

    They are integers and follow a parabola.
    """
    across = (np.arange(WIDTH) + 0.5) / WIDTH
    return np.floor(4.0 * SAG * across * (1.0 - across) + 0.5).astype(int)


def boards():
    """Return the picture of the boards, 128 x 20 px, which is also their collision shape.

    Above the upper side of the boards alpha is 0; in the boards it is 255.
    """
    wood = RAMPS["wood"]
    picture = np.zeros((SAG + THICK, WIDTH, 4), np.uint8)
    for column, top in enumerate(tops().tolist()):
        seam = column % BOARD == BOARD - 1
        tones = (OUTLINE, *((wood[1],) * 4 if seam else (wood[5], wood[4], wood[3], wood[2])), OUTLINE)
        if column in (0, WIDTH - 1):
            tones = (OUTLINE,) * THICK
        for row, tone in enumerate(tones):
            picture[top + row, column] = (*tone, 255)
    return picture


def ropes():
    """Return the picture of handrails, hangers and posts, 128 x 30 px.

    The ends of the boards are 12 px below the top of the picture.
    """
    wood, rope = RAMPS["wood"], RAMPS["gold"]
    picture = np.zeros((RAIL + SAG + 4, WIDTH, 4), np.uint8)
    levels = tops().tolist()
    for column, top in enumerate(levels):
        sag = 1 + top + (2 if 24 < column < WIDTH - 24 else 0)
        if column % (2 * BOARD) == BOARD:
            for row in range(sag, top + RAIL):
                picture[row, column] = (*rope[1], 255)
                for side in (column - 1, column + 1):
                    picture[row, side] = (*OUTLINE, 255)
        for row, tone in enumerate((OUTLINE, rope[3 + column // 2 % 2], OUTLINE)):
            picture[sag - 1 + row, column] = (*tone, 255)
    for left in (0, WIDTH - POST):
        picture[: RAIL + 1, left : left + POST] = (*OUTLINE, 255)
        picture[1 : RAIL + 1, left + 1] = (*wood[3], 255)
    return picture


def add_rope_bridge(sheet):
    """Add the pictures of the boards and of the ropes to a sprite sheet."""
    sheet.add("bridge", boards())
    sheet.add("bridge_ropes", ropes())
