"""Two large planes for the lab, where the user drags and rotates them over each other.

They show how collision tiers differ: a jet with deep notches between wings, fins and body, and a bomber with long thin
wings. For both planes, box, hull and pixels cover very different areas.
"""

from assets.craft.fields import box, capsule, circle, ellipse, length, polygon
from assets.craft.palette import RAMPS, WHITE, mix
from assets.craft.shading import Sprite

JET, BOMBER = (112, 112), (128, 104)  # [px] width, height


def jet():
    """Return the picture of a jet with two fins and swept wings, flying up, (112, 112, 4) uint8."""
    sprite = Sprite(*JET)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        _jet_side(sprite, side)
    sprite.part(
        polygon(x, y, [(56, 3), (52, 14), (49, 30), (47, 50), (47, 92), (65, 92), (65, 50), (63, 30), (60, 14)]),
        RAMPS["steel"],
        bulge=8,
        base=0.55,
        grain=0.9,
    )
    for line in (24, 46, 60, 78):
        sprite.paint(box(x, y, 46, line, 66, line + 1), RAMPS["steel"][1], 0.45)
    sprite.part(polygon(x, y, [(56, 2), (52.6, 13), (59.4, 13)]), RAMPS["gunmetal"], bulge=3, base=0.6)
    sprite.part(capsule(x, y, (56, 26), (56, 39), 4.4, 4.0), RAMPS["glass"], bulge=4.4, base=0.46, grain=0.4)
    sprite.paint(box(x, y, 51, 32, 61, 33), RAMPS["steel"][1], 0.8)
    for spot in ((54, 24), (54, 25), (53, 26), (53, 27), (53, 28), (54, 35)):
        sprite.dot(*spot, WHITE)
    sprite.part(capsule(x, y, (56, 44), (56, 84), 1.5), RAMPS["steel"], bulge=1.6, base=0.76, grain=0, shadow=0.7)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def _jet_side(sprite, side):
    """Draw the wing, intake, engine, tail plane and fin of one side of the jet into `sprite`. side: -1
    left, 1 right.
    """
    x, y = sprite.x, sprite.y
    lit = -side * 0.06

    def at(offset, down):
        return 56 + side * offset, down

    sprite.part(
        polygon(x, y, [at(6, 38), at(14, 46), at(53, 70), at(53.5, 79), at(40, 77), at(12, 78)]),
        RAMPS["blue"],
        bulge=6,
        base=0.50 + lit,
        grain=1.0,
    )
    sprite.paint(polygon(x, y, [at(12, 45), at(16, 47), at(54, 70), at(54, 73)]), RAMPS["blue"][4], 0.55)
    sprite.paint(polygon(x, y, [at(14, 71.5), at(44, 73.6), at(44, 74.6), at(14, 72.7)]), RAMPS["blue"][1], 0.7)
    sprite.paint(_strip(sprite, at(45, 60), at(49, 82)), RAMPS["gold"][4], 0.9)
    star_x, star_y = at(29, 66)
    sprite.paint(circle(x, y, star_x, star_y, 5.2), RAMPS["steel"][5], 0.95)
    sprite.paint(circle(x, y, star_x, star_y, 3.6), RAMPS["red"][3], 1.0)
    sprite.paint(circle(x, y, star_x, star_y, 1.4), RAMPS["steel"][5], 1.0)
    sprite.part(capsule(x, y, at(53, 60), at(53, 80), 1.6), RAMPS["steel"], bulge=1.8, base=0.55)
    sprite.part(
        polygon(x, y, [at(8, 86), at(12, 84), at(31, 97), at(31, 104), at(12, 101)]),
        RAMPS["blue"],
        bulge=4,
        base=0.46 + lit,
        grain=0.8,
    )
    sprite.part(_strip(sprite, at(6, 40), at(17, 100), 4), RAMPS["steel"], bulge=6, base=0.48 + lit, grain=0.8)
    sprite.paint(_strip(sprite, at(7, 40), at(16, 43)), RAMPS["gunmetal"][0], 0.85)
    sprite.part(_strip(sprite, at(7, 98), at(16, 107), 2), RAMPS["gunmetal"], bulge=4, base=0.45)
    sprite.paint(_strip(sprite, at(8.6, 104), at(14.4, 107)), RAMPS["orange"][4])
    for line in (54, 68, 82):
        sprite.paint(_strip(sprite, at(6, line), at(17, line + 1)), RAMPS["steel"][1], 0.4)
    sprite.part(
        polygon(x, y, [at(13.5, 78), at(16.5, 76), at(19.5, 95), at(19, 100), at(16, 98)]),
        RAMPS["red"],
        bulge=2,
        base=0.55 + lit,
    )


def _strip(sprite, first, second, corner=0.0):
    """Return the distance field (h, w) [px] of the box between two corners (x, y); it is negative inside.

    first: the upper corner, left or right; second: the lower corner, left or right; corner: rounding radius [px].
    """
    left, right = min(first[0], second[0]), max(first[0], second[0])
    return box(sprite.x, sprite.y, left, first[1], right, second[1], corner)


def bomber():
    """Return the picture of a four-engined propeller bomber with long straight wings, flying up, (104,
    128, 4) uint8.
    """
    sprite = Sprite(*BOMBER)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        _bomber_side(sprite, side)
    sprite.part(capsule(x, y, (64, 12), (64, 96), 6.5, 2.6), RAMPS["olive"], bulge=7, base=0.54, grain=0.9)
    for line in (22, 52, 66, 80):
        sprite.paint(box(x, y, 56, line, 72, line + 1), RAMPS["olive"][1], 0.5)
    sprite.part(ellipse(x, y, 64, 8.6, 4.6, 4.4), RAMPS["glass"], bulge=4, base=0.5, grain=0.3)
    sprite.paint(abs(x - 64) - 0.5 + (y > 12) * 9, RAMPS["gunmetal"][1], 0.8)
    sprite.part(box(x, y, 60, 17, 68, 25, 2), RAMPS["glass"], bulge=3, base=0.46, grain=0)
    sprite.paint(box(x, y, 63.5, 17, 64.5, 25), RAMPS["olive"][1], 0.9)
    sprite.paint(box(x, y, 60, 20, 68, 21), RAMPS["olive"][1], 0.9)
    sprite.part(circle(x, y, 64, 58, 3.8), RAMPS["gunmetal"], bulge=3.4, base=0.55)
    for side in (-1, 1):
        sprite.part(
            capsule(x, y, (64 + side * 1.4, 60), (64 + side * 1.4, 65.5), 0.7),
            RAMPS["steel"],
            bulge=1,
            base=0.6,
            grain=0,
        )
    sprite.part(capsule(x, y, (64, 84), (64, 100), 1.5, 1.2), RAMPS["red"], bulge=1.6, base=0.6)
    for spot in ((61, 6), (62, 5), (61, 18), (61, 19)):
        sprite.dot(*spot, WHITE)
    sprite.rim(share=0.45).outline()
    return sprite.pixels()


def _bomber_side(sprite, side):
    """Draw the wing with two engines, and the tail plane, of one side of the bomber into `sprite`.

    side: -1 left, 1 right.
    """
    x, y = sprite.x, sprite.y
    lit = -side * 0.05

    def at(offset, down):
        return 64 + side * offset, down

    sprite.part(
        polygon(x, y, [at(3, 27), at(30, 29), at(60, 35), at(62, 39), at(58, 43), at(30, 46), at(3, 51)]),
        RAMPS["olive"],
        bulge=6,
        base=0.52 + lit,
        grain=1.0,
    )
    sprite.paint(polygon(x, y, [at(14, 44.5), at(56, 40), at(56, 41), at(14, 45.7)]), RAMPS["olive"][1], 0.7)
    sprite.paint(polygon(x, y, [at(52, 30), at(55.5, 30), at(55.5, 46), at(52, 46)]), RAMPS["gold"][4], 0.85)
    sprite.part(
        polygon(x, y, [at(1, 82), at(20, 86), at(21, 90), at(18, 93), at(1, 94)]),
        RAMPS["olive"],
        bulge=4,
        base=0.48 + lit,
        grain=0.8,
    )
    for offset, nose in ((17, 22), (36, 25.5)):
        hub_x, hub_y = at(offset, nose)
        sprite.part(
            capsule(x, y, (hub_x, nose + 3), (hub_x, nose + 17), 3.8, 2.6), RAMPS["olive"], bulge=4, base=0.58 + lit
        )
        sprite.part(box(x, y, hub_x - 3.5, nose + 1, hub_x + 3.5, nose + 4, 1), RAMPS["gunmetal"], bulge=2, base=0.5)
        blade = (abs(y - hub_y) < 0.8 + abs(x - hub_x) * 0.03) & (abs(x - hub_x) < 8)
        sprite.rgb[blade] = mix(RAMPS["steel"][3], RAMPS["steel"][4], 0.5)
        sprite.solid |= blade
        sprite.part(ellipse(x, y, hub_x, nose - 0.2, 1.6, 2.2), RAMPS["red"], bulge=1.6, base=0.6, grain=0)
    mark_x, mark_y = at(46, 38.5)
    ring = length(x - mark_x, y - mark_y)
    sprite.paint(ring - 3.6, RAMPS["steel"][5], 0.95)
    sprite.paint(ring - 2.3, RAMPS["blue"][3], 1.0)
