"""The shooter's later kinds of enemies: the small fast hornet, and the gun platform on the ground.

Like the kinds in enemies.py they face down, and each kind has its own colour and outline.
"""

import numpy as np

from assets.craft.fields import box, capsule, circle, ellipse, polygon
from assets.craft.palette import RAMPS, WHITE
from assets.craft.shading import Sprite
from assets.shooter.plating import rivets, stripes, turret, vent

HORNET, TURRET = (22, 22), (36, 36)  # [px] width, height of the frames


def hornet(frame):
    """Return the picture of the hornet, with bands of black and gold and with wings swept forward, (22, 22, 4) uint8.

    frame: 0..1, between which its jets flicker.
    """
    sprite = Sprite(*HORNET)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):

        def at(across, down, side=side):
            return 11 + side * across, down

        sprite.flat(capsule(x, y, at(3, 5), at(3, 1.8), 1.1, 0.6), RAMPS["teal"][(4, 3)[frame]])
        sprite.flat(capsule(x, y, at(3, 5), at(3, (2.4, 4.0)[frame]), 0.6, 0.5), WHITE)
        sprite.part(
            polygon(x, y, [at(1, 7), at(5, 6), at(9.4, 9.6), at(9.6, 18.6), at(7.6, 15), at(5.4, 12.4), at(1, 13)]),
            RAMPS["gold"],
            bulge=2,
            base=0.54 - side * 0.08,
        )
        sprite.paint(polygon(x, y, [at(6.2, 7), at(8, 8.4), at(8, 16), at(6.2, 14)]), RAMPS["gunmetal"][0], 0.85)
        sprite.part(capsule(x, y, at(3, 4.6), at(3, 8), 1.2), RAMPS["gunmetal"], bulge=1.4, base=0.55)
    sprite.part(
        polygon(x, y, [(11, 20.6), (8.6, 15), (8.2, 8), (9.4, 3.6), (12.6, 3.6), (13.8, 8), (13.4, 15)]),
        RAMPS["gold"],
        bulge=3,
        base=0.58,
    )
    for row in (5, 8.4, 15.6):
        sprite.paint(box(x, y, 7, row, 15, row + 1.8), RAMPS["gunmetal"][0], 0.9)
    sprite.part(ellipse(x, y, 11, 12.4, 1.7, 2.3), RAMPS["glass"], bulge=1.9, base=0.5, grain=0)
    sprite.dot(10, 11, WHITE)
    sprite.part(capsule(x, y, (11, 18), (11, 20.4), 0.8), RAMPS["steel"], bulge=1, base=0.7, grain=0)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def gun_platform(frame):
    """Return the picture of the gun platform, a round armoured fort with a twin gun, (36, 36, 4) uint8.

    frame: 0..1; another of its two lamps is lit in each frame.
    """
    sprite = Sprite(*TURRET)
    x, y = sprite.x, sprite.y
    for dx, dy in ((-1, -1), (1, -1), (-1, 1), (1, 1)):  # four feet with bollards
        sprite.part(
            capsule(x, y, (18 + dx * 8, 17 + dy * 8), (18 + dx * 12.4, 17 + dy * 12.4), 3.4, 3.0),
            RAMPS["gunmetal"],
            bulge=3,
            base=0.42,
        )
        sprite.part(circle(x, y, 18 + dx * 12.6, 17 + dy * 12.6, 1.9), RAMPS["teal"], bulge=2, base=0.5, grain=0)
    sprite.part(_octagon(sprite, 13.6), RAMPS["teal"], bulge=4, base=0.40, gain=0.5)
    sprite.paint(abs(_octagon(sprite, 10.9)) - 0.5, RAMPS["teal"][1], 0.8)
    stripes(sprite, 6, 15.6, 9, 18.4)
    stripes(sprite, 27, 15.6, 30, 18.4)
    vent(sprite, 14, 4.4, 22, 7.6)
    rivets(sprite, "teal", [(9, 10), (27, 10), (9, 25), (27, 25), (13, 28), (23, 28)])
    for side in (-1, 1):
        sprite.part(
            circle(x, y, 18 + side * 9.4, 12.4, 1.5),
            RAMPS["red"],
            bulge=2,
            base=0.85 if (side > 0) == bool(frame) else 0.36,
            grain=0,
        )
    turret(sprite, 18, 17, 6.2, "steel", reach=12.6)
    sprite.part(circle(x, y, 18, 16.4, 2.3), RAMPS["orange"], bulge=2.2, base=0.55, grain=0)
    sprite.dot(17, 15, WHITE)
    sprite.rim(share=0.4).outline()
    return sprite.pixels()


def _octagon(sprite, radius):
    """Return the distance field (h, w) [px] of a regular octagon around the platform's centre; it is negative inside.

    radius: distance from the centre to the octagon's sides [px].
    """
    dx, dy = abs(sprite.x - 18), abs(sprite.y - 17)
    return np.maximum(np.maximum(dx, dy), (dx + dy) * 0.7071) - radius
