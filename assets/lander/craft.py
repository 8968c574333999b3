"""Pictures of the lander and its parts (flame, shell, hook), and small pictures for its heads-up display (HUD)."""

from assets.craft.fields import box, capsule, circle, ellipse, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite

WIDTH, HEIGHT = 30, 32  # [px] of the ship's picture, nose up
MIDDLE = WIDTH / 2
FLAME = (12, 22)  # [px]


def ship():
    """Return the picture of the lander, (32, 30, 4) uint8: a round cabin on a tank, an engine bell, two legs with
    broad feet.
    """
    sprite = Sprite(WIDTH, HEIGHT)
    for side in (-1, 1):
        _leg(sprite, side)
    _bell(sprite)
    for side in (-1, 1):
        _tank(sprite, side)
    _cabin(sprite)
    sprite.rim(share=0.5).outline()
    return sprite.pixels()


def _leg(sprite, side):
    x, y = sprite.x, sprite.y

    def at(offset, down):
        return MIDDLE + side * offset, down

    sprite.part(capsule(x, y, at(6, 19), at(11.6, 28), 1.2), RAMPS["steel"], bulge=1.3, base=0.46, grain=0)
    sprite.part(capsule(x, y, at(3.4, 24.5), at(10.6, 27), 0.75), RAMPS["gunmetal"], bulge=1, base=0.5, grain=0)
    foot = [at(9.0, 28), at(14.0, 28), at(14.0, 31), at(9.0, 31)]
    sprite.part(polygon(x, y, foot), RAMPS["steel"], bulge=1.6, base=0.58, grain=0)


def _bell(sprite):
    x, y = sprite.x, sprite.y
    sprite.part(
        polygon(x, y, [(MIDDLE - 2.4, 22), (MIDDLE + 2.4, 22), (MIDDLE + 4.2, 28.2), (MIDDLE - 4.2, 28.2)]),
        RAMPS["gunmetal"],
        bulge=3,
        base=0.46,
    )
    sprite.paint(box(x, y, MIDDLE - 4, 27, MIDDLE + 4, 28.4), RAMPS["orange"][3], 0.8)
    sprite.paint(box(x, y, MIDDLE - 2, 27, MIDDLE + 2, 28.4), RAMPS["orange"][5], 0.8)


def _tank(sprite, side):
    x, y = sprite.x, sprite.y
    place = MIDDLE + side * 7.4
    sprite.part(capsule(x, y, (place, 15.5), (place, 21), 3.2), RAMPS["orange"], bulge=3.2, base=0.50 - 0.06 * side)
    sprite.paint(box(x, y, place - 4, 17.6, place + 4, 19), RAMPS["steel"][5], 0.85)
    sprite.paint(box(x, y, place - 4, 22, place + 4, 23), RAMPS["orange"][1], 0.8)


def _cabin(sprite):
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, MIDDLE - 5.4, 12, MIDDLE + 5.4, 23.6, 2.4), RAMPS["steel"], bulge=5, base=0.56)
    sprite.paint(box(x, y, MIDDLE - 5.4, 20.4, MIDDLE + 5.4, 21.4), RAMPS["steel"][1], 0.7)
    sprite.part(capsule(x, y, (MIDDLE, 1.8), (MIDDLE, 5), 1.1), RAMPS["gunmetal"], bulge=1.2, base=0.55, grain=0)
    sprite.part(ellipse(x, y, MIDDLE, 10.6, 7.0, 7.2), RAMPS["steel"], bulge=6, base=0.60)
    sprite.part(ellipse(x, y, MIDDLE, 10.4, 4.5, 4.3), RAMPS["gunmetal"], bulge=2, base=0.3, grain=0)
    sprite.part(ellipse(x, y, MIDDLE, 10.4, 3.6, 3.4), RAMPS["glass"], bulge=3.4, base=0.45, grain=0)
    sprite.dot(int(MIDDLE) - 2, 8, WHITE)
    sprite.dot(int(MIDDLE) - 1, 8, WHITE)
    sprite.dot(int(MIDDLE) - 2, 9, mix(RAMPS["glass"][4], WHITE, 0.6))


def flame(frame):
    """Return the picture of the engine's flame, which is drawn under the bell. frame: number of the frame, 0..3."""
    width, height = FLAME
    sprite = Sprite(width, height)
    x, y, middle = sprite.x, sprite.y, width / 2
    reach = (16.5, 19.5, 15.0, 18.5)[frame]
    sprite.flat(capsule(x, y, (middle, 2.6), (middle, reach), 3.6, 0.6), RAMPS["orange"][2])
    sprite.flat(capsule(x, y, (middle, 2.2), (middle, reach - 3), 2.9, 0.5), RAMPS["orange"][4])
    sprite.flat(capsule(x, y, (middle, 1.8), (middle, reach - 7), 2.1, 0.4), RAMPS["gold"][5])
    sprite.flat(capsule(x, y, (middle, 1.2), (middle, reach - 11), 1.3, 0.4), WHITE)
    return sprite.pixels()


def shell(frame):
    """Return the picture of a shell that the ship fires: a hot ball with a dark rim. frame: number of the
    frame, 0..1.
    """
    sprite = Sprite(7, 7)
    sprite.flat(circle(sprite.x, sprite.y, 3.5, 3.5, 2.5), RAMPS["gold"][4 - frame])
    sprite.flat(circle(sprite.x, sprite.y, 3.5, 3.5, 1.3), WHITE)
    return sprite.outline().pixels()


def hook():
    """Return the picture of the claw at the end of the ship's line."""
    rows = ("..d..", ".dsd.", "dsdsd", "s.d.s", "d...d")
    return Sprite(5, 5).stamp(rows, 0, 0, {"d": OUTLINE, "s": RAMPS["steel"][4]}).pixels()


ICONS = {
    "icon_lander": (
        "....w....",
        "...wsw...",
        "..wggsw..",
        "..sggsd..",
        "..wsssd..",
        ".ooddoo..",
        ".d.oo.d..",
        "dd....dd.",
    ),
    "icon_shell": ("..w..", ".wyo.", ".yyo.", ".yod.", ".ddd."),
    "icon_fuel": (".dd.o.", "oooo.o", "owyo.o", "oyyo.o", "oyyooo", "ooodd."),
    "icon_hull": ("sssss", "swwss", "swssd", ".ssd.", "..d.."),
    "icon_cargo": ("oooooo", "owddyo", "odwydo", "odywdo", "oyddwo", "oooooo"),
}


def icons():
    """Return {name: picture (h, w, 4) uint8} of the small pictures for the HUD."""
    tones = {
        "w": WHITE,
        "s": RAMPS["steel"][4],
        "d": RAMPS["steel"][2],
        "g": RAMPS["glass"][4],
        "o": RAMPS["orange"][3],
        "y": RAMPS["gold"][4],
    }
    return {
        name: Sprite(len(rows[0]) + 2, len(rows) + 2).stamp(rows, 1, 1, tones).outline().pixels()
        for name, rows in ICONS.items()
    }
