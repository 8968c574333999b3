"""Moving and crumbling things of the platformer: crumbling stone, its fragments, the conveyor belt, the hidden gem."""

from itertools import pairwise

import numpy as np

from assets.craft.fields import box, capsule, circle, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite

CRUMBLE = (32, 16)  # [px]
PHASES = 4  # of the belt: it moves on by a quarter of its tread in each
GEM_WIDTHS = (5.4, 4.4, 2.8, 4.4)  # [px] half widths over a turn
CRACKS = (
    # additions of each look to the cracks of the one before: lines of points, px
    (((9, 1), (11, 5), (10, 7)),),
    (((10, 7), (13, 10), (12, 15)), ((23, 1), (21, 4), (23, 7))),
    (((23, 7), (20, 10), (21, 15)), ((11, 5), (16, 6), (18, 9), (20, 10)), ((1, 10), (5, 9), (10, 7))),
    (((23, 7), (27, 8), (31, 7)), ((5, 9), (6, 13), (5, 15)), ((16, 6), (17, 1)), ((27, 8), (27, 15))),
)
# missing parts in each look: boxes, px
GAPS = ((), ((8, 0, 11, 3),), ((0, 13, 4, 16), (21, 0, 24, 3)), ((14, 12, 18, 16), (28, 0, 32, 4), (5, 14, 7, 16)))


def crumble(look):
    """Return the picture of a crumbling stone slab, 32 x 16 px.

    look: 0..3, with increasing numbers of cracks and missing bits. The slab remains in one piece.
    """
    sprite = Sprite(*CRUMBLE)
    x, y = sprite.x, sprite.y
    stone = RAMPS["stone"]
    sprite.part(box(x, y, 1, 1, 31, 15, 1), stone, bulge=2.4, base=0.54, gain=0.35, grain=0.2)
    for seam in (10.5, 21.5):
        sprite.paint(box(x, y, seam - 0.5, 1, seam + 0.5, 15), stone[1], 0.8)
        sprite.paint(box(x, y, seam + 0.5, 2, seam + 1.5, 14), stone[4], 0.5)
    sprite.paint(box(x, y, 2, 1, 30, 2), RAMPS["gold"][4], 0.55)  # worn yellow edge, as a warning
    sprite.paint(box(x, y, 2, 13, 30, 15), stone[1], 0.5)
    for left, top, right, bottom in GAPS[look]:
        sprite.cut(box(x, y, left, top, right, bottom, 1.2))
    for lines in CRACKS[: look + 1]:
        for points in lines:
            for start, end in pairwise(points):
                sprite.paint(
                    capsule(x, y, (start[0] + 0.8, start[1] + 0.8), (end[0] + 0.8, end[1] + 0.8), 0.6), stone[5], 0.4
                )
                sprite.paint(capsule(x, y, start, end, 0.62 + 0.1 * look), OUTLINE)
    return sprite.outline().pixels()


def crumble_bit(kind):
    """Return the picture of a fragment of the crumbling stone, 8 x 8 px. kind: 0..2."""
    sprite = Sprite(8, 8)
    points = (
        ((1.4, 2), (4.4, 1.2), (6.6, 3.4), (5.6, 6.4), (2.2, 6.4)),
        ((2, 1.6), (6, 2.4), (6.4, 5), (3, 6.6)),
        ((2.4, 2.6), (5.4, 2), (6, 5.4), (2.6, 5.6)),
    )[kind]
    sprite.part(polygon(sprite.x, sprite.y, points), RAMPS["stone"], bulge=2, base=0.52, grain=0.3)
    return sprite.outline().pixels()


def belt(part, phase):
    """Return the picture of a piece of conveyor belt, 16 x 16 px.

    part: "left_end", "mid" or "right_end"; phase: 0..3, the belt's motion to the right in quarters of its tread.
    """
    sprite = Sprite(16, 16)
    x, y = sprite.x, sprite.y
    left, right = {"left_end": (1, 40), "mid": (-40, 56), "right_end": (-40, 15)}[part]
    band = box(x, y, left, 1, right, 13, 6)
    sprite.flat(band, RAMPS["gunmetal"][2])
    sprite.flat(band + 2.4, OUTLINE)
    sprite.flat(band + 3.2, RAMPS["armour"][1])  # the girder between the upper and the lower run
    sprite.paint(box(x, y, -1, 4.2, 17, 5.4), RAMPS["armour"][3], 0.8)
    shift = phase * 2
    top, bottom = (y < 3.4) & (band < 0), (y > 10.6) & (band < 0)
    tread = np.floor((x - shift) / 4).astype(int) % 2 == 0
    back = np.floor((x + shift) / 4).astype(int) % 2 == 0
    sprite.rgb[top & tread] = RAMPS["gold"][4]
    sprite.rgb[top & tread & (y > 2)] = RAMPS["gold"][3]
    sprite.rgb[top & ~tread] = RAMPS["gunmetal"][3]
    sprite.rgb[bottom & back] = RAMPS["gunmetal"][3]
    _wheel(sprite, {"left_end": 7, "mid": 8, "right_end": 9}[part], 2.6 if part == "mid" else 3.4, phase)
    sprite.outline()
    if part in ("left_end", "mid"):
        _open(sprite, 15)
    if part in ("right_end", "mid"):
        _open(sprite, 0)
    return sprite.pixels()


def _wheel(sprite, middle, radius, phase):
    """Draw a wheel of the belt around x = `middle` into a sprite. Its spoke rotates with the phase, 0..3."""
    x, y = sprite.x, sprite.y
    sprite.part(circle(x, y, middle, 7, radius), RAMPS["steel"], bulge=2.4, base=0.50, gain=0.5, grain=0)
    turn = ((1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7))[phase]
    reach = radius - 1
    sprite.paint(
        capsule(
            x, y, (middle - turn[0] * reach, 7 - turn[1] * reach), (middle + turn[0] * reach, 7 + turn[1] * reach), 0.5
        ),
        RAMPS["gunmetal"][0],
    )
    sprite.paint(circle(x, y, middle, 7, 0.8), RAMPS["gold"][4])


def _open(sprite, column):
    """Draw the side of a belt piece that is joined to the next piece: its outline is only above and below the belt.

    column: column of the picture at this side.
    """
    for row in (0, 13):
        sprite.dot(column, row, OUTLINE)


def gem(frame):
    """Return the picture of a rotating gem, 14 x 14 px. frame: 0..3; the highlight does not move."""
    sprite = Sprite(14, 14)
    x, y, half = sprite.x, sprite.y, GEM_WIDTHS[frame]
    ramp = RAMPS["teal"]
    crown, girdle, point = 2.0, 5.6, 12.6
    sprite.flat(
        polygon(
            x,
            y,
            [(7 - half * 0.62, crown), (7 + half * 0.62, crown), (7 + half, girdle), (7, point), (7 - half, girdle)],
        ),
        ramp[3],
    )
    sprite.paint(polygon(x, y, [(7 - half, girdle), (7 - half * 0.62, crown), (7 - half * 0.25, girdle)]), ramp[5])
    sprite.paint(polygon(x, y, [(7 - half, girdle), (7 - half * 0.25, girdle), (7, point)]), ramp[4])
    sprite.paint(polygon(x, y, [(7 + half * 0.3, girdle), (7 + half, girdle), (7, point)]), ramp[1])
    sprite.paint(polygon(x, y, [(7 + half * 0.3, girdle), (7 + half * 0.62, crown), (7 + half, girdle)]), ramp[2])
    sprite.paint(box(x, y, 7 - half, girdle, 7 + half, girdle + 0.9), mix(ramp[4], WHITE, 0.45), 0.8)
    sprite.dot(int(7 - half * 0.5), 3, WHITE)
    if frame % 2 == 0:
        sprite.dot(int(7 - half * 0.5), 4, WHITE)
    return sprite.outline().pixels()


def add_stonework(sheet):
    """Add the pictures of the stone, its fragments, the belt and the gem to a sprite sheet."""
    for look in range(4):
        sheet.add(f"crumble_{look}", crumble(look))
    for kind in range(3):
        sheet.add(f"crumble_bit_{kind}", crumble_bit(kind))
    sheet.add_sequence("secret_gem", [gem(i) for i in range(4)], 8)
    for part in ("left_end", "mid", "right_end"):
        sheet.add_sequence(f"belt_{part}", [belt(part, i) for i in range(PHASES)], 12)
