"""The shooter's first three kinds of enemies, seen from above and facing down, each with its own colour and outline.

dart: a red angular plane that dives. saucer: round and violet, flies along a wave. gunship: a large olive gun platform
with rotors. The wings extend far from the bodies, so often the boxes of two sprites overlap while their masks do not.
"""

from assets.craft.fields import box, capsule, circle, ellipse, length, polygon
from assets.craft.palette import RAMPS, WHITE, mix
from assets.craft.shading import Sprite

DART, SAUCER, GUNSHIP = (24, 26), (30, 26), (44, 40)  # [px] width, height of the frames
RIM_LIGHTS = ((6, 12), (9, 17), (15, 19), (21, 17), (24, 12), (21, 7), (15, 5), (9, 7))  # on the saucer, in order


def dart(frame):
    """Return the picture of the dart, (26, 24, 4) uint8. frame: 0..1, between which its engine flickers."""
    sprite = Sprite(*DART)
    x, y = sprite.x, sprite.y
    flame = (3.4, 1.2)[frame]
    sprite.flat(capsule(x, y, (12, 5), (12, flame), 1.5, 0.6), RAMPS["orange"][4])
    sprite.flat(capsule(x, y, (12, 5), (12, flame + 1.4), 0.8, 0.5), RAMPS["gold"][5])
    for side in (-1, 1):

        def at(offset, down, side=side):
            return 12 + side * offset, down

        sprite.part(
            polygon(
                x,
                y,
                [
                    at(1, 6),
                    at(6, 4.6),
                    at(10.6, 0.8),
                    at(10.8, 5),
                    at(9.2, 9.6),
                    at(6.4, 10.4),
                    at(4.6, 14.4),
                    at(1, 15),
                ],
            ),
            RAMPS["red"],
            bulge=2.2,
            base=0.54 - side * 0.08,
        )
        sprite.paint(polygon(x, y, [at(8.4, 2), at(9.8, 1), at(9.6, 9), at(8.2, 11)]), RAMPS["gold"][4], 0.85)
        sprite.part(capsule(x, y, at(6.6, 9.5), at(6.6, 15.5), 0.9), RAMPS["gunmetal"], bulge=1.2, base=0.65)
    sprite.part(
        polygon(x, y, [(12, 24.6), (8.8, 13), (9.6, 4), (14.4, 4), (15.2, 13)]), RAMPS["steel"], bulge=3.2, base=0.55
    )
    sprite.part(polygon(x, y, [(12, 25), (10.1, 18.4), (13.9, 18.4)]), RAMPS["red"], bulge=1.6, base=0.6)
    sprite.part(ellipse(x, y, 12, 12, 1.7, 3.2), RAMPS["gold"], bulge=1.9, base=0.55, grain=0)
    sprite.dot(11, 10, WHITE)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def saucer(frame):
    """Return the picture of the saucer, (26, 30, 4) uint8. frame: 0..3, over which its lights move around the rim."""
    sprite = Sprite(*SAUCER)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):

        def at(offset, down, side=side):
            return 15 + side * offset, down

        sprite.part(
            polygon(x, y, [at(5, 12), at(9, 3.4), at(13.6, 1.2), at(13.2, 5.4), at(11, 10)]),
            RAMPS["pink"],
            bulge=2,
            base=0.5 - side * 0.06,
        )
        sprite.part(
            polygon(x, y, [at(5, 14), at(11, 15), at(13.4, 20.4), at(13.2, 24.6), at(9.4, 20.6)]),
            RAMPS["pink"],
            bulge=2,
            base=0.46 - side * 0.06,
        )
    sprite.part(capsule(x, y, (15, 18), (15, 22.4), 2.4, 1.6), RAMPS["gunmetal"], bulge=2, base=0.6)
    sprite.part(ellipse(x, y, 15, 12.2, 10.4, 8.6), RAMPS["purple"], bulge=6, base=0.52)
    ring = length((x - 15) / 7.6, (y - 12.2) / 6.2)
    sprite.paint(abs(ring - 1) - 0.085, RAMPS["purple"][1], 0.8)
    for i, (light_x, light_y) in enumerate(RIM_LIGHTS):
        lit = i % 4 in (frame, (frame + 1) % 4)
        sprite.flat(circle(x, y, light_x, light_y, 0.9), RAMPS["gold"][5] if lit else RAMPS["orange"][2])
    sprite.part(ellipse(x, y, 15, 11.4, 4.9, 4.6), RAMPS["teal"], bulge=4.6, base=0.55, grain=0.3)
    sprite.part(ellipse(x, y, 15, 12.6, 2.2, 1.9), RAMPS["gold"], bulge=2, base=0.6, grain=0)
    sprite.dot(15, 13, RAMPS["gold"][0]).dot(14, 13, RAMPS["gold"][0])
    for spot in ((12, 9), (13, 8), (12, 10)):
        sprite.dot(*spot, WHITE)
    sprite.rim(share=0.45).outline()
    return sprite.pixels()


def gunship(frame):
    """Return the picture of the gunship, (40, 44, 4) uint8.

    frame: 0..3; each frame shows the two rotors at another angle.
    """
    sprite = Sprite(*GUNSHIP)
    x, y = sprite.x, sprite.y
    for side in (-1, 1):
        _gunship_side(sprite, side, frame)
    sprite.part(
        polygon(x, y, [(18, 2.5), (26, 2.5), (28.2, 8), (27.6, 27), (25, 34.5), (19, 34.5), (16.4, 27), (15.8, 8)]),
        RAMPS["olive"],
        bulge=5,
        base=0.5,
    )
    for line in (9, 15.4, 26.6):  # panel lines
        sprite.paint(box(x, y, 15, line, 29, line + 1), RAMPS["olive"][1], 0.7)
    for side in (-1, 1):
        sprite.paint(box(x, y, 22 + side * 4 - 1, 16.4, 22 + side * 4 + 1, 26.6), RAMPS["orange"][3], 0.7)
    sprite.part(box(x, y, 19, 3.4, 25, 8, 1.5), RAMPS["gunmetal"], bulge=2, base=0.5)
    sprite.part(ellipse(x, y, 22, 30, 3.1, 3.8), RAMPS["glass"], bulge=3, base=0.45, grain=0)
    sprite.dot(20, 28, WHITE).dot(21, 27, WHITE)
    sprite.part(circle(x, y, 22, 20.6, 4.3), RAMPS["gunmetal"], bulge=3.4, base=0.6)
    sprite.part(capsule(x, y, (22, 21), (22, 26.2), 1.25), RAMPS["steel"], bulge=1.4, base=0.62)
    sprite.part(circle(x, y, 22, 20.2, 2), RAMPS["red"], bulge=2, base=(0.45, 0.6, 0.72, 0.6)[frame], grain=0)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def _gunship_side(sprite, side, frame):
    """Draw the boom, rotor, short wing and cannon of one side into `sprite`. side: -1 left, 1 right; frame: 0..3."""
    x, y = sprite.x, sprite.y

    def at(offset, down):
        return 22 + side * offset, down

    sprite.part(
        polygon(x, y, [at(4, 10), at(17, 13), at(17, 18), at(4, 20)]), RAMPS["olive"], bulge=3, base=0.5 - side * 0.06
    )
    sprite.part(
        polygon(x, y, [at(4, 27), at(11, 30), at(11.4, 33.4), at(4, 31.5)]), RAMPS["olive"], bulge=2.4, base=0.46
    )
    sprite.part(capsule(x, y, at(8.6, 18), at(8.6, 25), 1.5), RAMPS["gunmetal"], bulge=1.6, base=0.6)
    sprite.part(capsule(x, y, at(8.6, 25), at(8.6, 27.4), 0.9), RAMPS["steel"], bulge=1, base=0.6)
    hub_x, hub_y = at(14.6, 15)
    radius = length(x - hub_x, y - hub_y)
    sprite.part(radius - 6.7, RAMPS["gunmetal"], bulge=3, base=0.42)
    sprite.flat(radius - 5.4, RAMPS["gunmetal"][0])
    turns = ((1, 0), (0.924, 0.383), (0.707, 0.707), (0.383, 0.924))[frame]  # eighths of a half turn
    for along, across in (turns, (-turns[1], turns[0])):
        across_distance = abs((x - hub_x) * across * side - (y - hub_y) * along)
        blade = (across_distance < 0.8) & (radius < 5.2)
        sprite.rgb[blade] = RAMPS["steel"][4]
        wake = (across_distance < 1.9) & (radius < 5.2) & ~blade
        sprite.rgb[wake] = mix(sprite.rgb[wake], RAMPS["steel"][3], 0.35)
    sprite.part(circle(x, y, hub_x, hub_y, 1.7), RAMPS["orange"], bulge=1.6, base=0.6, grain=0)
