"""The player's plane, seen from above and flying up: one level and four banking frames, its exhaust and its core.

The core is the small centre of the plane. By default only hits of the core cost a life.
"""

from assets.craft.fields import box, capsule, circle, ellipse, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite

SIZE = 32  # [px] square frame; the plane's centre is the frame's centre
BANKS = {
    # name: (left wing's length, right wing's, shift of the spine in px, light on the left wing, on the right)
    "player_left2": (0.62, 0.74, -1.0, -0.20, 0.20),
    "player_left1": (0.84, 0.90, -0.5, -0.10, 0.10),
    "player": (1.0, 1.0, 0.0, 0.0, -0.04),
    "player_right1": (0.90, 0.84, 0.5, 0.10, -0.10),
    "player_right2": (0.74, 0.62, 1.0, 0.20, -0.20),
}


def player(bank):
    """Return the picture of the player's plane, (32, 32, 4) uint8. bank: a key of BANKS, the angle of bank."""
    left, right, spine, light_left, light_right = BANKS[bank]
    sprite = Sprite(SIZE, SIZE)
    centre = SIZE / 2
    for side, reach, light in ((-1, left, light_left), (1, right, light_right)):
        _wing(sprite, centre, side, reach, light)
    _body(sprite, centre + spine * 0.4, spine)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def _wing(sprite, centre, side, reach, light):
    """Draw one swept wing with its stripe, gun pod and tail plane into `sprite`.

    centre: x of the plane's centre; side: -1 left, 1 right; reach: drawn length of the wing as a share of its length
    in level flight; light: value added to the brightness of the wing.
    """
    x, y = sprite.x, sprite.y

    def at(offset, down):
        return centre + side * offset * reach, down

    base = 0.55 + light
    sprite.part(
        polygon(x, y, [at(2, 9), at(3.4, 9.6), at(13.8, 19.2), at(13.8, 22.4), at(8.4, 21.6), at(2, 24)]),
        RAMPS["blue"],
        bulge=2.6,
        base=base,
        grain=0.8,
    )
    sprite.paint(polygon(x, y, [at(9.6, 14.6), at(11.4, 16.2), at(11.4, 24), at(9.6, 24)]), RAMPS["steel"][5], 0.9)
    sprite.part(capsule(x, y, at(13.4, 15.4), at(13.4, 23.2), 1.05), RAMPS["steel"], bulge=1.3, base=0.55 + light)
    sprite.part(capsule(x, y, at(4.7, 14.6), at(4.7, 22.4), 1.3, 1.0), RAMPS["steel"], bulge=1.4, base=0.58 + light)
    sprite.paint(circle(x, y, *at(4.7, 13.6), 1.1), RAMPS["gunmetal"][1])
    sprite.part(
        polygon(x, y, [at(2, 23.4), at(7.4, 27.4), at(7.6, 30.2), at(5.4, 29.4), at(2, 28.6)]),
        RAMPS["red"],
        bulge=2,
        base=0.54 + light,
    )


def _body(sprite, centre, spine):
    """Draw the fuselage, nose, canopy and engine into `sprite`.

    centre: x of the plane's centre; spine: sideways shift of the canopy in a bank [px].
    """
    x, y = sprite.x, sprite.y
    sprite.part(capsule(x, y, (centre, 3.5), (centre, 23.5), 1.5, 3.5), RAMPS["steel"], bulge=3.4, base=0.6)
    sprite.part(box(x, y, centre - 2.2, 26.5, centre + 2.2, 30, 1), RAMPS["gunmetal"], bulge=2.4, base=0.45)
    sprite.paint(box(x, y, centre - 1.2, 28, centre + 1.2, 30), RAMPS["orange"][4])
    sprite.part(
        polygon(x, y, [(centre, 0.6), (centre - 1.9, 6), (centre + 1.9, 6)]),
        RAMPS["red"],
        bulge=1.9,
        base=0.6,
        shadow=1,
    )
    sprite.paint(box(x, y, centre - 4, 22, centre + 4, 23), RAMPS["steel"][1], 0.6)
    sprite.part(ellipse(x, y, centre + spine, 12, 2.05, 4.4), RAMPS["glass"], bulge=2.1, base=0.48, grain=0)
    sprite.part(
        capsule(x, y, (centre + spine * 0.4, 18), (centre, 25), 0.75),
        RAMPS["steel"],
        bulge=0.9,
        base=0.78,
        grain=0,
        shadow=0.75,
    )
    glint = int(centre + spine - 0.6)
    sprite.dot(glint, 9, WHITE)
    sprite.dot(glint, 10, mix(RAMPS["glass"][4], WHITE, 0.6))


def exhaust(frame):
    """Return the picture of the flame behind the player's engine, 8 x 12 px, drawn below the plane's tail. frame:
    0..3.
    """
    sprite = Sprite(8, 12)
    reach = (6.5, 8.5, 7.2, 9.6)[frame]
    x, y = sprite.x, sprite.y
    sprite.flat(capsule(x, y, (4, 1.2), (4, reach), 2.2, 0.7), RAMPS["blue"][2])
    sprite.flat(capsule(x, y, (4, 1.0), (4, reach - 1.6), 1.6, 0.5), RAMPS["teal"][4])
    sprite.flat(capsule(x, y, (4, 0.5), (4, reach - 4), 0.9, 0.5), WHITE)
    return sprite.pixels()


def marked_core(frame):
    """Return the picture that marks the core of the player's plane, 6 x 6 px: a jewel in a dark frame.

    frame: 0..1, 1 is brighter.
    """
    rows = (".dddd.", "drwwrd", "dwWWrd", "dwWrrd", "drrrrd", ".dddd.")
    tones = {
        "d": OUTLINE,
        "r": (RAMPS["red"][3], RAMPS["pink"][4])[frame],
        "w": (RAMPS["pink"][4], RAMPS["pink"][5])[frame],
        "W": WHITE,
    }
    return Sprite(6, 6).stamp(rows, 0, 0, tones).pixels()
