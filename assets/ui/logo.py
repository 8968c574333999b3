"""The title's logo, which shows the subject of the game: collisions.

The letters O and X have bounding boxes. The two boxes overlap, and the pixels of this overlap are marked as a hit.
"""

import numpy as np

from assets.craft.fields import box, capsule, dither
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix, oklch
from assets.craft.shading import Sprite, shifted

LOGO = (244, 72)  # [px]
TOP, BOTTOM, STROKE = 14, 58, 10  # [px] of the letters
LETTER_X = {"H": 10, "I": 53, "T": 72, "B": 115, "O": 158, "X": 194}  # left edges, px
LETTER_WIDTH = {"H": 36, "I": 12, "T": 36, "B": 35, "O": 37, "X": 39}
BOX_COLOUR, HIT_COLOUR = oklch(0.86, 0.14, 195), oklch(0.72, 0.20, 20)


def letter_field(letter, x, y):
    """Return the distance field of one letter in the logo, (h, w) [px]; it is negative inside the letter.

    letter: a key of LETTER_X; x, y: coordinates of the pixel centres [px], (h, w) each.
    """
    left = LETTER_X[letter]
    right, middle = left + LETTER_WIDTH[letter], (TOP + BOTTOM) / 2
    if letter == "H":
        return np.minimum(
            np.minimum(
                box(x, y, left, TOP, left + STROKE + 2, BOTTOM, 2), box(x, y, right - STROKE - 2, TOP, right, BOTTOM, 2)
            ),
            box(x, y, left + 3, middle - 5, right - 3, middle + 5),
        )
    if letter == "I":
        return box(x, y, left, TOP, right, BOTTOM, 2)
    if letter == "T":
        return np.minimum(
            box(x, y, left, TOP, right, TOP + STROKE + 1, 2),
            box(x, y, (left + right) / 2 - 6, TOP, (left + right) / 2 + 6, BOTTOM, 2),
        )
    if letter == "B":
        shape = np.minimum(
            box(x, y, left, TOP, right - 2, middle + 4, 9), box(x, y, left, middle - 4, right, BOTTOM, 10)
        )
        shape = np.minimum(shape, box(x, y, left, TOP, left + 12, BOTTOM, 2))
        holes = np.minimum(
            box(x, y, left + 12, TOP + 9, right - 12, middle - 4.5, 3),
            box(x, y, left + 12, middle + 4.5, right - 11, BOTTOM - 9, 3),
        )
        return np.maximum(shape, -holes)
    if letter == "O":
        return np.maximum(
            box(x, y, left, TOP, right, BOTTOM, 13),
            -box(x, y, left + STROKE + 1, TOP + STROKE, right - STROKE - 1, BOTTOM - STROKE, 6),
        )
    return np.minimum(
        capsule(x, y, (left + 6, TOP + 6), (right - 6, BOTTOM - 6), 6.4),
        capsule(x, y, (right - 6, TOP + 6), (left + 6, BOTTOM - 6), 6.4),
    )


def logo():
    """Return the picture of the logo, (72, 244, 4) uint8."""
    width, height = LOGO
    sprite = Sprite(width, height)
    x, y = sprite.x, sprite.y
    for letter in LETTER_X:
        field = letter_field(letter, x, y)
        layers = []
        for name in ("gold", "orange", "red"):  # from top to bottom, dithered into each other
            tone = Sprite(width, height)
            tone.part(field, RAMPS[name], bulge=3.5, base=0.74, gain=0.40, grain=0)
            layers.append(tone.rgb)
        share = (y - TOP) / (BOTTOM - TOP) * 2.6 - 0.3 + dither(height, width) * 0.9
        band = np.clip(np.floor(share), 0, 2).astype(int)
        inside = field < 0
        for i, rgb in enumerate(layers):
            chosen = inside & (band == i)
            sprite.rgb[chosen] = rgb[chosen]
        sprite.solid |= inside
    face = sprite.solid.copy()
    sprite.rim(WHITE, 0.55)
    sprite.outline().outline()
    body = sprite.solid.copy()
    for drop in range(1, 5):  # an extruded lower edge
        below = shifted(body, 0, drop) & ~sprite.solid
        sprite.rgb[below] = mix(RAMPS["purple"][1], OUTLINE, 0.25 + drop * 0.12)
        sprite.solid |= below
    _boxes(sprite, face)
    return sprite.pixels()


def _boxes(sprite, face):
    """Draw the bounding boxes of the letters O and X into `sprite`, and mark the pixels where both boxes overlap.

    face: the pixels of the letters, (h, w) bool.
    """
    for letter, colour in (("O", BOX_COLOUR), ("X", BOX_COLOUR)):
        left, right = LETTER_X[letter] - 4, LETTER_X[letter] + LETTER_WIDTH[letter] + 3
        top, bottom = TOP - 5, BOTTOM + 4
        for row in (top, bottom):
            sprite.rgb[row, left : right + 1] = colour
            sprite.solid[row, left : right + 1] = True
        for column in (left, right):
            sprite.rgb[top : bottom + 1, column] = colour
            sprite.solid[top : bottom + 1, column] = True
        for row in (top, bottom):
            for column in (left, right):
                sprite.rgb[row - 1 : row + 2, column - 1 : column + 2] = WHITE
                sprite.solid[row - 1 : row + 2, column - 1 : column + 2] = True
    o_right, x_left = LETTER_X["O"] + LETTER_WIDTH["O"] + 3, LETTER_X["X"] - 4
    overlap = np.zeros_like(face)
    overlap[TOP - 4 : BOTTOM + 4, x_left + 1 : o_right] = True
    lit = overlap & ((sprite.x + sprite.y).astype(int) % 3 == 0)
    sprite.rgb[lit] = HIT_COLOUR
    sprite.solid |= lit
