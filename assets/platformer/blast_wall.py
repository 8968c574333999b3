"""Pictures of a wall of cracked blocks that a bomb can break, and of the bomb."""

from itertools import pairwise

from assets.craft.fields import box, capsule, circle, ellipse, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE
from assets.craft.shading import Sprite
from assets.shooter.explosions import explosion

WALL = (32, 64)  # [px]
# Blocks of the wall: left, top, right, bottom [px], and the brightness of each.
BLOCKS = (
    (0, 0, 15, 11, 0.50),
    (15, 0, 32, 13, 0.44),
    (0, 11, 11, 25, 0.46),
    (11, 13, 24, 27, 0.56),
    (24, 13, 32, 25, 0.42),
    (0, 25, 13, 38, 0.54),
    (13, 27, 32, 40, 0.48),
    (0, 38, 20, 51, 0.42),
    (20, 40, 32, 53, 0.54),
    (0, 51, 12, 64, 0.52),
    (12, 51, 20, 64, 0.44),
    (20, 53, 32, 64, 0.48),
)
CRACKS = (
    ((1, 30), (7, 28), (12, 32), (17, 29), (22, 34), (27, 31), (31, 35)),
    ((12, 32), (9, 39), (13, 45), (10, 52), (14, 58), (12, 63)),
    ((17, 29), (20, 21), (16, 15), (20, 8), (18, 1)),
    ((22, 34), (25, 42), (22, 48), (27, 55), (25, 61)),
    ((7, 28), (4, 21), (7, 14)),
)


def wall():
    """Return the picture of a wall, 32 x 64 px, opaque. Visible cracks show that it can be broken."""
    sprite = Sprite(*WALL)
    x, y = sprite.x, sprite.y
    sprite.flat(box(x, y, -1, -1, WALL[0] + 1, WALL[1] + 1), RAMPS["stone"][0])
    for left, top, right, bottom, base in BLOCKS:
        sprite.part(
            box(x, y, left + 0.6, top + 0.6, right - 0.6, bottom - 0.6, 1.6),
            RAMPS["stone"],
            bulge=2.6,
            base=base,
            gain=0.34,
            grain=0.5,
        )
    for points in CRACKS:
        for start, end in pairwise(points):
            lit = ((start[0] + 0.9, start[1] + 0.9), (end[0] + 0.9, end[1] + 0.9))
            sprite.paint(capsule(x, y, *lit, 0.7), RAMPS["stone"][5], 0.45)
            sprite.paint(capsule(x, y, start, end, 0.85), OUTLINE)
    for middle_x, middle_y, radius in ((12, 32, 2.4), (22, 34, 1.9), (17, 29, 1.6)):  # where it has crumbled most
        sprite.paint(circle(x, y, middle_x, middle_y, radius), OUTLINE)
        sprite.paint(circle(x, y, middle_x + 0.8, middle_y + 1.0, radius - 0.9), RAMPS["stone"][1])
    for column in (0, 31):
        sprite.paint(box(x, y, column, -1, column + 1, WALL[1] + 1), OUTLINE, 0.7)
    sprite.solid[:] = True
    return sprite.pixels()


def bomb(look):
    """Return the picture of a round bomb with its fuse up, 14 x 16 px. look: 0 cold, 1 about to explode."""
    sprite = Sprite(14, 16)
    x, y = sprite.x, sprite.y
    sprite.flat(capsule(x, y, (7.4, 5), (8.6, 2.6), 0.8), RAMPS["wood"][3])
    sprite.flat(capsule(x, y, (8.6, 2.6), (10.6, 2.2), 0.7), RAMPS["wood"][4])
    ramp = RAMPS["gunmetal"] if look == 0 else RAMPS["red"]
    sprite.part(circle(x, y, 7, 10, 4.9), ramp, bulge=4.4, base=0.34 if look == 0 else 0.56, gain=0.5, grain=0.2)
    sprite.part(box(x, y, 5.2, 4.4, 8.8, 6.4, 0.6), RAMPS["steel"], bulge=1.4, base=0.5, grain=0)
    sprite.flat(ellipse(x, y, 5.0, 8.0, 1.2, 0.9), WHITE)
    return sprite.outline().pixels()


def stand():
    """Return the picture of the iron ring on which a bomb waits, 16 x 5 px."""
    sprite = Sprite(16, 5)
    x, y = sprite.x, sprite.y
    sprite.part(
        polygon(x, y, [(2, 1.4), (14, 1.4), (12.4, 4.4), (3.6, 4.4)]), RAMPS["gunmetal"], bulge=1.6, base=0.5, grain=0
    )
    return sprite.rim(share=0.4).outline().pixels()


def add_blast_wall(sheet):
    """Add the pictures of the wall, the bomb, its stand and its explosion to a sprite sheet."""
    sheet.add("blast_wall", wall())
    sheet.add("bomb_0", bomb(0))
    sheet.add("bomb_1", bomb(1))
    sheet.add("bomb_stand", stand())
    sheet.add_sequence("blast", explosion(14, 88, 31), 26)
