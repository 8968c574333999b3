"""The shooter's pick-ups: power, bombs and lives. They differ in colour, outline and sign, and are 18 x 18 px."""

from assets.craft.fields import box, capsule, circle
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite


def powerup(frame):
    """Return the picture of a capsule with a pulsing glow and a P for power, 18 x 18 px. frame: 0..3."""
    sprite = Sprite(18, 18)
    x, y = sprite.x, sprite.y
    glow = (0.22, 0.34, 0.46, 0.34)[frame]
    sprite.part(box(x, y, 1.5, 3, 16.5, 15, 5), RAMPS["steel"], bulge=4, base=0.58)
    sprite.part(box(x, y, 4.5, 1.5, 13.5, 16.5, 3), RAMPS["gold"], bulge=3, base=0.5)
    sprite.part(circle(x, y, 9, 9, 5.2), RAMPS["red"], bulge=6, base=glow, gain=0.3, grain=0)
    sprite.stamp(
        ("####.", "##.##", "##.##", "####.", "##...", "##..."), 7, 6, {"#": WHITE}
    )  # P for power, in the glass
    sprite.rim(share=0.55).outline()
    return sprite.pixels()


def bomb_item(frame):
    """Return the picture of a bomb to pick up, 18 x 18 px: a teal ball with a gold band and a burning fuse. frame:
    0..3.
    """
    sprite = Sprite(18, 18)
    x, y = sprite.x, sprite.y
    sprite.part(capsule(x, y, (9, 5), (9, 2.4), 2.2), RAMPS["gunmetal"], bulge=2, base=0.5)
    sprite.part(circle(x, y, 9, 10, 6.4), RAMPS["teal"], bulge=7, base=(0.36, 0.44, 0.52, 0.44)[frame], gain=0.45)
    sprite.paint(box(x, y, 2, 9, 16, 12), RAMPS["gold"][4], 0.95)
    sprite.paint(box(x, y, 2, 11, 16, 12), RAMPS["gold"][2], 0.95)
    sprite.stamp(("###.", "#..#", "###.", "#..#", "###."), 7, 8, {"#": OUTLINE})
    sprite.dot(6, 6, WHITE).dot(5, 7, WHITE).dot(6, 7, mix(RAMPS["teal"][4], WHITE, 0.5))
    sprite.rim(share=0.5).outline()
    spark = (WHITE, RAMPS["gold"][5], RAMPS["orange"][4], RAMPS["gold"][4])[frame]
    sprite.dot(9, 1, spark).dot(8, 1, spark)
    return sprite.pixels()


def life_item(frame):
    """Return the picture of a life to pick up, 18 x 18 px: a green capsule with a small plane on it. frame: 0..3."""
    sprite = Sprite(18, 18)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 1.5, 3, 16.5, 15, 5), RAMPS["steel"], bulge=4, base=0.58)
    sprite.part(box(x, y, 4.5, 1.5, 13.5, 16.5, 3), RAMPS["gold"], bulge=3, base=0.5)
    sprite.part(
        circle(x, y, 9, 9, 5.4), RAMPS["green"], bulge=6, base=(0.26, 0.36, 0.46, 0.36)[frame], gain=0.3, grain=0
    )
    sprite.stamp(("...#...", "...#...", ".#.#.#.", "#######", "...#...", "..###.."), 5, 6, {"#": WHITE})
    sprite.rim(share=0.55).outline()
    return sprite.pixels()
