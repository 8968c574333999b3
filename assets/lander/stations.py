"""Pictures of things on the lander's moon: landing pads and their masts, cargo, loose rocks, fuel cans."""

import numpy as np

from assets.craft.fields import box, capsule, circle, layered_noise, length, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite
from assets.lander.ground import ROCK, SNOW

DECK = 14  # [px] height of a pad's picture: its deck, and struts that stand in the ground
STRUT = 16  # [px] between two struts
MAST = (18, 44)  # [px]


def pad(width):
    """Return the picture of a landing deck, `width` px wide: plates, a lit stripe, hazard marks at its ends, struts."""
    sprite = Sprite(width, DECK)
    x, y = sprite.x, sprite.y
    for foot in range(STRUT // 2, width, STRUT):
        sprite.part(
            polygon(x, y, [(foot - 2.5, 6), (foot + 2.5, 6), (foot + 3.6, DECK - 1), (foot - 3.6, DECK - 1)]),
            RAMPS["gunmetal"],
            bulge=2.4,
            base=0.42,
        )
        sprite.part(
            capsule(x, y, (foot + 3, 11.5), (foot + STRUT - 3, 7.5), 0.7), RAMPS["steel"], bulge=1, base=0.35, grain=0
        )
    sprite.part(box(x, y, 1, 1, width - 1, 7.4, 1), RAMPS["steel"], bulge=3, base=0.52)
    for seam in range(14, width - 8, 12):
        sprite.paint(box(x, y, seam, 3, seam + 1, 7), RAMPS["steel"][1], 0.7)
    sprite.paint(box(x, y, 1, 5, width - 1, 6), RAMPS["gunmetal"][1], 0.6)
    for side in (0, 1):
        for stripe in range(3):
            start = 2 + 4 * stripe if side == 0 else width - 12 + 4 * stripe
            sprite.paint(box(x, y, start, 3, start + 2, 6.4), RAMPS["gold"][4], 0.9)
            sprite.paint(box(x, y, start + 2, 3, start + 4, 6.4), RAMPS["gunmetal"][0], 0.8)
    sprite.rim(share=0.7).outline()
    return sprite.pixels()


def mast(lit):
    """Return the picture of a mast that stands beside a pad, with a dish half way up. lit: whether its lamp is on.

    The foot of the mast is at the lower edge of the picture.
    """
    sprite = Sprite(*MAST)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        sprite.part(
            capsule(x, y, (9 + side * 4.4, MAST[1] - 1), (9 + side * 0.9, 8), 0.8),
            RAMPS["gunmetal"],
            bulge=1,
            base=0.52,
            grain=0,
        )
    for rung in range(12, MAST[1] - 3, 6):
        half = 1 + 3.4 * (rung - 8) / (MAST[1] - 9)
        sprite.part(
            capsule(x, y, (9 - half, rung), (9 + half, rung + 4), 0.5), RAMPS["steel"], bulge=1, base=0.4, grain=0
        )
    sprite.part(polygon(x, y, [(2, 17), (6.6, 14.6), (6.6, 24), (2, 21.4)]), RAMPS["steel"], bulge=3, base=0.55)
    sprite.part(
        circle(x, y, 9, 5, 3), RAMPS["red" if lit else "gunmetal"], bulge=2.6, base=0.66 if lit else 0.3, grain=0
    )
    if lit:
        sprite.dot(8, 4, WHITE)
    return sprite.outline().pixels()


def crate():
    """Return the picture of cargo in a steel box with orange corners, 18 x 18 px.

    The box fills the square, so that its pixel mask slides and tips like a box.
    """
    sprite = Sprite(18, 18)
    x, y = sprite.x, sprite.y
    sprite.flat(box(x, y, 0, 0, 18, 18), OUTLINE)
    sprite.part(box(x, y, 1, 1, 17, 17), RAMPS["steel"], bulge=4, base=0.50)
    for corner_x in (1, 12):
        for corner_y in (1, 12):
            sprite.part(
                box(x, y, corner_x, corner_y, corner_x + 5, corner_y + 5), RAMPS["orange"], bulge=2.4, base=0.52
            )
    sprite.part(box(x, y, 6, 6, 12, 12), RAMPS["gunmetal"], bulge=2, base=0.35)
    sprite.paint(polygon(x, y, [(9, 6.6), (11.4, 11), (6.6, 11)]), RAMPS["gold"][4])
    sprite.rgb[[0, -1]] = sprite.rgb[:, [0, -1]] = OUTLINE
    return sprite.pixels()


def drum():
    """Return the picture of cargo in a round drum, seen from its end, 18 x 18 px."""
    sprite = Sprite(18, 18)
    x, y = sprite.x, sprite.y
    sprite.part(circle(x, y, 9, 9, 8), RAMPS["orange"], bulge=4, base=0.50)
    sprite.part(circle(x, y, 9, 9, 5.4), RAMPS["steel"], bulge=2, base=0.52)
    for dx, dy in ((0, -1), (1, 0), (0, 1), (-1, 0)):
        sprite.paint(circle(x, y, 9 + 6.7 * dx, 9 + 6.7 * dy, 1.1), RAMPS["orange"][1])
    sprite.paint(box(x, y, 8, 4.6, 10, 13.4), RAMPS["gold"][4], 0.85)
    sprite.paint(box(x, y, 4.6, 8, 13.4, 10), RAMPS["gold"][3], 0.85)
    return sprite.outline().pixels()


def rock(seed, size):
    """Return the picture of a loose boulder with a little snow on it, size x size px. seed: seed of the random
    numbers.
    """
    sprite = Sprite(size, size)
    x, y = sprite.x, sprite.y
    random = np.random.default_rng(700 + seed)
    middle = size / 2
    rough = layered_noise(size, size, 4, 4, 2, 720 + seed) - 0.5
    field = length((x - middle) / (1.0 + 0.12 * random.random()), (y - middle) * 1.12) - size * 0.38 + rough * 6
    sprite.part(field, ROCK[1:], bulge=size * 0.3, base=0.45, gain=0.5)
    for _ in range(3):
        crack, lean = 0.2 + 0.6 * random.random(), random.random() * 4 - 2
        sprite.paint(capsule(x, y, (size * crack, size * 0.3), (size * crack + lean, size * 0.75), 0.5), ROCK[1], 0.6)
    sprite.rim(SNOW[3], 0.55)
    return sprite.outline().pixels()


def can(frame):
    """Return the picture of a can of fuel with a moving light. frame: number of the frame, 0..3."""
    sprite = Sprite(14, 16)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 5, 1, 9, 4, 1), RAMPS["gunmetal"], bulge=2, base=0.5)
    sprite.part(box(x, y, 1.4, 3, 12.6, 15, 2.6), RAMPS["red"], bulge=4, base=0.52)
    sprite.paint(box(x, y, 1, 7, 13, 11), RAMPS["steel"][5], 0.9)
    sprite.paint(
        polygon(x, y, [(7.6, 6.6), (4.6, 9.4), (6.6, 9.4), (5.8, 11.6), (9.4, 8.4), (7.2, 8.4)]), RAMPS["orange"][3]
    )
    sprite.paint(box(x, y, 2 + 3 * frame, 12.4, 4 + 3 * frame, 13.6), mix(RAMPS["gold"][5], WHITE, 0.5))
    return sprite.rim(share=0.5).outline().pixels()
