"""The shooter's two bosses, which face down: the heavy bomber halfway through the stage, and the fortress at the end.

The fortress has three looks: whole with its eye half shut, with torn armour, and burning with one wing tip missing.
Each look has two frames, which differ in the glow of engines and eye. The two frames have the same silhouette and
therefore share one mask.
"""

from assets.craft.fields import box, capsule, ellipse, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite
from assets.shooter.plating import cracks, lens, nozzle, rivets, scorch, seam, stripes, torn, turret, vent, wound

MIDBOSS, BOSS = (84, 56), (132, 84)  # [px] width, height of the frames
LOOKS = "abc"


def midboss(frame):
    """Return the picture of the heavy bomber, a flying wing with four engines and three turrets. frame: 0..1."""
    sprite = Sprite(*MIDBOSS)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        _midboss_side(sprite, side, frame)
    sprite.part(
        polygon(x, y, [(37, 4), (47, 4), (50, 12), (50.5, 34), (47, 48), (42, 54), (37, 48), (33.5, 34), (34, 12)]),
        RAMPS["orange"],
        bulge=6,
        base=0.46,
        gain=0.5,
        grain=0.8,
    )
    for row in (12, 22, 36):
        seam(sprite, "orange", 34, row, 50, row + 1)
    sprite.part(box(x, y, 37, 23.4, 47, 34, 1), RAMPS["armour"], bulge=2, base=0.5)
    stripes(sprite, 38, 24.6, 46, 33)
    sprite.paint(box(x, y, 41.5, 24.6, 42.5, 33), OUTLINE)
    sprite.part(box(x, y, 37.6, 5.6, 46.4, 11, 2), RAMPS["armour"], bulge=2.4, base=0.55)
    vent(sprite, 38, 14, 46, 20)
    sprite.part(ellipse(x, y, 42, 46.6, 3.3, 5), RAMPS["glass"], bulge=3.2, base=0.46, grain=0)
    sprite.paint(box(x, y, 38, 45.6, 46, 46.6), RAMPS["gunmetal"][1], 0.8)
    sprite.dot(40, 43, WHITE).dot(40, 44, WHITE).dot(41, 42, WHITE)
    turret(sprite, 42, 8, 2.6, "gold", reach=5.4)
    sprite.rim(share=0.45).outline()
    return sprite.pixels()


def _midboss_side(sprite, side, frame):
    """Draw the wing, tail fin, two engines, turret and gun of one side into `sprite`.

    side: -1 left, 1 right; frame: 0..1, brightness of the engines.
    """
    x, y = sprite.x, sprite.y
    lit = -side * 0.06

    def at(across, down):
        return 42 + side * across, down

    sprite.part(
        polygon(x, y, [at(3, 3), at(15, 1.4), at(18.6, 4.4), at(13, 10), at(3, 12)]),
        RAMPS["red"],
        bulge=3,
        base=0.42 + lit,
    )
    sprite.part(
        polygon(
            x,
            y,
            [
                at(5, 10),
                at(22, 12),
                at(38, 19),
                at(40.6, 26),
                at(39, 39),
                at(36.8, 39),
                at(35, 31),
                at(24, 35),
                at(7, 44),
            ],
        ),
        RAMPS["orange"],
        bulge=5,
        base=0.44 + lit,
        gain=0.5,
        grain=0.9,
    )
    sprite.paint(
        polygon(x, y, [at(7, 41), at(24, 32.6), at(35, 28.6), at(35, 31), at(24, 35), at(7, 44)]), RAMPS["red"][2], 0.85
    )
    sprite.paint(polygon(x, y, [at(33.6, 16), at(36, 17.4), at(36, 36), at(33.6, 32)]), RAMPS["gold"][4], 0.9)
    left, right = sorted((42 + side * 9, 42 + side * 32))
    seam(sprite, "orange", left, 23, right, 24)
    at_x = 42 + side * 31.5
    seam(sprite, "orange", at_x - 0.5, 16, at_x + 0.5, 32)
    rivets(sprite, "orange", [at(across, 20.5) for across in (9.5, 17, 20, 23, 30)])
    for across, top, bottom in ((13, 8, 40), (26.4, 13.5, 35.5)):
        middle = 42 + side * across
        sprite.part(
            capsule(x, y, (middle, top + 4), (middle, bottom - 4), 3.3, 2.6),
            RAMPS["armour"],
            bulge=3.4,
            base=0.54 + lit,
        )
        nozzle(sprite, middle - 2.8, middle + 2.8, top - 2, top + 5, frame)
        seam(sprite, "armour", middle - 3, bottom - 12, middle + 3, bottom - 11)
        sprite.part(ellipse(x, y, middle, bottom - 3.4, 3.4, 2.4), RAMPS["gold"], bulge=2, base=0.5, grain=0)
        sprite.paint(ellipse(x, y, middle, bottom - 2.8, 2.3, 1.6), OUTLINE)
    turret(sprite, *at(19.8, 25.6), 2.8, "armour", reach=7.6)
    sprite.part(capsule(x, y, at(38.3, 21), at(38.3, 40), 1.5), RAMPS["armour"], bulge=1.6, base=0.6)


def boss(look, frame):
    """Return the picture of the flying fortress, (84, 132, 4) uint8.

    look: one of LOOKS, its states from whole to burning; frame: 0..1, brightness of engines and eye.
    """
    sprite = Sprite(*BOSS)
    hurt = LOOKS.index(look)
    hot = (0.15, 0.5, 0.85)[hurt] + 0.15 * frame
    for side in (-1, 1):
        _wing(sprite, side, frame)
    for side in (-1, 1):
        _prong(sprite, side)
    _hull(sprite, frame)
    _eye(sprite, hurt, hot)
    if hurt:
        _damage(sprite, hurt, hot)
    sprite.rim(share=0.45).outline()
    return sprite.pixels()


def _wing(sprite, side, frame):
    """Draw the armoured wing of one side into `sprite`, with engines, plates, stripes and two turrets.

    side: -1 left, 1 right; frame: 0..1, brightness of engines and lens.
    """
    x, y = sprite.x, sprite.y
    lit = -side * 0.06

    def at(across, down):
        return 66 + side * across, down

    def span(first, last):
        return sorted((66 + side * first, 66 + side * last))

    for across in (20, 31):
        nozzle(sprite, 66 + side * across - 4.2, 66 + side * across + 4.2, 4.5, 16, frame)
    sprite.part(
        polygon(x, y, [at(38, 12), at(50, 7), at(56, 1.6), at(58, 9), at(55, 22), at(40, 24)]),
        RAMPS["purple"],
        bulge=4,
        base=0.36 + lit,
    )
    sprite.part(
        polygon(x, y, [at(8, 12), at(36, 10), at(58, 19), at(63, 30), at(63, 40), at(44, 46), at(30, 58), at(8, 62)]),
        RAMPS["red"],
        bulge=7,
        base=0.36 + lit,
        gain=0.46,
        grain=0.9,
    )
    # Upper armour: two overlapping plates of iron, so that the wing is layered.
    sprite.part(
        polygon(x, y, [at(12, 14), at(34, 13), at(37, 27), at(30, 33), at(12, 36)]),
        RAMPS["armour"],
        bulge=4,
        base=0.56 + lit,
        grain=0.7,
    )
    sprite.part(
        polygon(x, y, [at(38.5, 15), at(56, 21.5), at(60, 30), at(46, 33.5), at(39.5, 27)]),
        RAMPS["armour"],
        bulge=4,
        base=0.52 + lit,
        grain=0.7,
    )
    left, right = span(14, 34)
    seam(sprite, "armour", left, 24, right, 25)
    left, right = span(40, 58)
    seam(sprite, "armour", left, 25, right, 26)
    for across in (22.5, 47.5):
        middle = 66 + side * across
        seam(sprite, "armour", middle - 0.5, 14, middle + 0.5, 33)
    rivets(sprite, "armour", [at(across, 17.5) for across in (15, 19, 26, 30)])
    rivets(sprite, "armour", [at(across, 30.5) for across in (15, 19, 26)])
    left, right = span(25, 32)
    vent(sprite, left, 26.5, right, 31)
    sprite.paint(
        polygon(x, y, [at(30, 55), at(44, 44), at(63, 37.5), at(63, 40), at(45, 46.5), at(31, 57.5)]),
        RAMPS["gold"][4],
        0.9,
    )
    left, right = span(13, 27)
    seam(sprite, "red", left, 46, right, 47)
    seam(sprite, "red", 66 + side * 27 - 0.5, 38, 66 + side * 27 + 0.5, 56)
    rivets(sprite, "red", [at(across, 42.5) for across in (30, 34, 38, 42, 46, 50)])
    turret(sprite, *at(37, 36), 4.6, "gold", reach=10.5)
    turret(sprite, *at(21, 50), 3.8, "gold", reach=9.5)
    lens(sprite, *at(54, 33.6), 2.8, "pink", 0.3 + 0.5 * frame)


def _prong(sprite, side):
    """Draw the claw at the end of a wing, with its heavy gun, into `sprite`. side: -1 left, 1 right."""
    x, y = sprite.x, sprite.y
    lit = -side * 0.06

    def at(across, down):
        return 66 + side * across, down

    sprite.part(
        polygon(
            x,
            y,
            [at(55, 18), at(61, 20), at(64.6, 32), at(64.2, 52), at(61, 66), at(58.6, 66), at(57.6, 52), at(55.6, 40)],
        ),
        RAMPS["purple"],
        bulge=4,
        base=0.44 + lit,
    )
    sprite.part(capsule(x, y, at(60.4, 44), at(60.2, 68), 1.7, 1.2), RAMPS["armour"], bulge=1.8, base=0.6, grain=0)
    left, right = sorted((66 + side * 57, 66 + side * 64))
    sprite.paint(box(x, y, left, 47, right, 48.4), RAMPS["gold"][4])


def _hull(sprite, frame):
    """Draw the fortress between its wings into `sprite`: stern, bridge, armoured neck, and the large gun in the bow.

    frame: 0..1; the stern's engines are bright in frame 0.
    """
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        nozzle(sprite, 66 + side * 7 - 5, 66 + side * 7 + 5, 1.5, 14, 1 - frame)
    sprite.part(
        polygon(
            x, y, [(54, 9), (78, 9), (83, 22), (84, 46), (79, 62), (73, 74), (59, 74), (53, 62), (48, 46), (49, 22)]
        ),
        RAMPS["armour"],
        bulge=10,
        base=0.55,
        gain=0.5,
        grain=0.9,
    )
    sprite.part(polygon(x, y, [(58, 8), (74, 8), (76, 24), (56, 24)]), RAMPS["red"], bulge=4, base=0.40)
    for row in (13, 18):
        sprite.paint(box(x, y, 58, row, 74, row + 1), RAMPS["red"][1], 0.7)
    sprite.part(box(x, y, 61.5, 10, 70.5, 21, 3), RAMPS["steel"], bulge=3.4, base=0.58)
    sprite.paint(box(x, y, 63, 17.6, 69, 19.4), RAMPS["glass"][4])
    sprite.paint(box(x, y, 63, 18.6, 69, 19.4), RAMPS["glass"][2])
    for side in (-1, 1):
        edge = 66 + side * 15
        seam(sprite, "armour", edge - 0.5, 26, edge + 0.5, 60)
        rivets(sprite, "armour", [(66 + side * 13, row) for row in (29, 34, 50, 55)])
    seam(sprite, "armour", 50, 59, 82, 60)
    seam(sprite, "armour", 55, 67, 77, 68)
    stripes(sprite, 57, 61, 75, 64)
    for side in (-1, 1):
        sprite.part(
            capsule(x, y, (66 + side * 8, 64), (66 + side * 7, 77), 1.9, 1.5),
            RAMPS["armour"],
            bulge=2,
            base=0.62,
            grain=0,
        )
    sprite.part(capsule(x, y, (66, 62), (66, 78.4), 4.2, 3.2), RAMPS["armour"], bulge=4, base=0.50)
    sprite.part(box(x, y, 61.6, 69, 70.4, 72, 1), RAMPS["gold"], bulge=2, base=0.52, grain=0)
    sprite.paint(ellipse(x, y, 66, 79.4, 2.4, 1.7), OUTLINE)


def _eye(sprite, hurt, hot):
    """Draw the eye of the fortress into `sprite`: a lens behind an iris of armour.

    hurt: number of the look, 0..2; the iris is nearly shut in look 0, torn in look 1 and missing in look 2; hot:
    brightness of the glow, 0..1.
    """
    x, y = sprite.x, sprite.y
    sprite.part(ellipse(x, y, 66, 42, 14.2, 14.2), RAMPS["gold"], bulge=3, base=0.44, grain=0.4)
    sprite.part(ellipse(x, y, 66, 42, 12, 12), RAMPS["armour"], bulge=3, base=0.3)
    lens(sprite, 66, 42, (8.6, 9.8, 11.2)[hurt], ("teal", "pink", "red")[hurt], hot)
    if hurt == 0:
        for points in (
            [(54, 33), (66, 30), (78, 33), (72, 39), (66, 40.2), (60, 39)],
            [(54, 51), (66, 54), (78, 51), (72, 45), (66, 43.8), (60, 45)],
        ):
            sprite.part(polygon(x, y, points), RAMPS["steel"], bulge=3, base=0.5)
        seam(sprite, "steel", 65.5, 31, 66.5, 40)
        seam(sprite, "steel", 65.5, 45, 66.5, 53)
    elif hurt == 1:
        sprite.part(
            polygon(x, y, [(55, 34), (60, 30.4), (64, 32), (60, 37), (56, 40)]), RAMPS["steel"], bulge=2.6, base=0.5
        )
        sprite.part(
            polygon(x, y, [(77, 50), (72, 53.6), (68, 52), (72, 47), (76, 44)]), RAMPS["steel"], bulge=2.6, base=0.46
        )
    ring = (abs((x - 66) * (x - 66) + (y - 42) * (y - 42) - 169) < 14) & (((x - y) // 4).astype(int) % 2 == 0)
    sprite.rgb[ring] = mix(sprite.rgb[ring], OUTLINE, 0.45)


def _damage(sprite, hurt, hot):
    """Draw holes, soot and glowing cracks into `sprite`, and cut off parts of the wings.

    In look 2 there are more holes, and the right claw is missing. hurt: number of the look, 1 or 2; hot: brightness of
    the glow, 0..1.
    """
    wound(sprite, 34, 21, 4.6, 3, hot)
    wound(sprite, 95, 44, 4.0, 5, hot)
    scorch(sprite, 22, 30, 6, 7)
    cracks(sprite, [[(40, 25), (44, 29), (43, 33), (47, 37)], [(83, 52), (80, 56), (82, 61)]], hot)
    torn(sprite, [(0, 54), (9, 50), (14, 58), (14, 76), (0, 76)], 11)
    if hurt == 1:
        return
    wound(sprite, 109, 24, 5.4, 13, hot)
    wound(sprite, 50, 52, 4.6, 17, hot)
    wound(sprite, 62, 24, 3.2, 19, hot)
    scorch(sprite, 74, 66, 7, 23)
    cracks(
        sprite,
        [
            [(56, 33), (52, 29), (53, 25)],
            [(76, 34), (81, 30), (80, 25), (85, 21)],
            [(57, 51), (53, 56), (55, 62), (52, 66)],
            [(76, 50), (79, 55), (77, 62)],
            [(108, 30), (103, 34), (104, 38)],
        ],
        hot,
    )
    torn(sprite, [(118, 36), (126, 40), (134, 34), (134, 72), (116, 72)], 29)
    torn(sprite, [(26, 54), (33, 51), (36, 60), (26, 66)], 31)
