"""The sprite sheet "lab": pictures of the bodies in the lab: crates, blocks, balls, dominoes, and the billiard table.

A piece fills its picture completely, outline included, so that picture and collision shape have the same size.
"""

import math

from assets.craft.atlas import Sheet
from assets.craft.fields import box, capsule, circle, layered_noise, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite

TOYS = ("red", "blue", "gold", "green", "purple", "teal")
BALLS = ("gold", "blue", "red", "purple", "orange", "green", "wood")  # of 1 to 7, and again of 9 to 15
TABLE = (384, 208)  # [px] with its wooden frame
FRAME, CUSHION = 12, 8  # [px] of wood, of cloth-covered cushion
POCKET = 9.0  # [px] radius of a hole


def crate(size, look):
    """Return the picture of a wooden crate, (size, size, 4) uint8.

    look: 0 with a diagonal brace, 1 with planks, 2 dark with a cross.
    """
    sprite = Sprite(size, size)
    x, y, edge = sprite.x, sprite.y, max(2, size // 7)
    wood = RAMPS["wood"] if look < 2 else RAMPS["dirt"]
    sprite.part(box(x, y, 1, 1, size - 1, size - 1), wood, bulge=2, base=0.4, gain=0.2, grain=0.6)
    for line in range(edge + 3, size - edge, 4):
        sprite.paint(box(x, y, edge, line, size - edge, line + 1), wood[0], 0.7)
    low, high, thick = edge, size - edge, max(1.0, edge * 0.5)
    if look != 1:
        sprite.part(capsule(x, y, (low, high), (high, low), thick), wood, bulge=2, base=0.56)
    if look == 2:
        sprite.part(capsule(x, y, (low, low), (high, high), thick), wood, bulge=2, base=0.62)
    for left, top, right, bottom in (
        (1, 1, 1 + edge, size - 1),
        (size - 1 - edge, 1, size - 1, size - 1),
        (1, 1, size - 1, 1 + edge),
        (1, size - 1 - edge, size - 1, size - 1),
    ):
        sprite.part(box(x, y, left, top, right, bottom), wood, bulge=1.8, base=0.6, grain=0.6)
    return sprite.outline().pixels()


def block(width, height, ramp):
    """Return the picture of a painted toy block with a bevelled rim, (height, width, 4) uint8. ramp: name of its
    colours.
    """
    sprite = Sprite(width, height)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 1, 1, width - 1, height - 1), RAMPS[ramp], bulge=2, base=0.5, gain=0.3, grain=0.3)
    if min(width, height) > 8:
        sprite.paint(box(x, y, 4, 4, width - 4, height - 4), RAMPS[ramp][2], 0.6)
    return sprite.outline().pixels()


def disc(radius, ramp):
    """Return the picture of a disc with a bright spoke, which shows the disc's rotation. ramp: name of its colours."""
    size = 2 * radius
    sprite = Sprite(size, size)
    x, y = sprite.x, sprite.y
    sprite.part(circle(x, y, radius, radius, radius - 0.7), RAMPS[ramp], bulge=3, base=0.48, gain=0.3, grain=0.3)
    sprite.paint(capsule(x, y, (radius, radius), (size - 3.0, radius), 0.9), RAMPS[ramp][5])
    sprite.paint(circle(x, y, radius, radius, 1.6), RAMPS[ramp][5])
    return sprite.outline().pixels()


def pill(length, radius, ramp):
    """Return the picture of a capsule along x.

    length: distance between the centres of its ends [px]; radius: in px; ramp: name of its colours.
    """
    sprite = Sprite(length + 2 * radius, 2 * radius)
    x, y, end = sprite.x, sprite.y, length + radius
    sprite.part(
        capsule(x, y, (radius, radius), (end, radius), radius - 0.7),
        RAMPS[ramp],
        bulge=3,
        base=0.5,
        gain=0.3,
        grain=0.3,
    )
    sprite.paint(box(x, y, radius + length / 2, 0, end + radius, 2 * radius), RAMPS["steel"][5], 0.75)
    return sprite.outline().pixels()


def gem(points, size, ramp):
    """Return the picture of a convex piece with the corners `points` [px], (size, size, 4) uint8.

    ramp: name of its colours.
    """
    sprite = Sprite(size, size)
    sprite.part(polygon(sprite.x, sprite.y, points) + 0.8, RAMPS[ramp], bulge=3, base=0.5, gain=0.35, grain=0.3)
    return sprite.outline().pixels()


def corners(count, size, start):
    """Return the corners (x, y) [px] of a regular polygon inscribed in the largest circle of a size x size px square.

    count: number of corners; start: angle of the first corner in degrees.
    """
    angles = [math.radians(start + i * 360 / count) for i in range(count)]
    # Rounded, as in synth.py: the last bits of sines differ between machines.
    return [(size / 2 * (1 + round(math.cos(a), 9)), size / 2 * (1 + round(math.sin(a), 9))) for a in angles]


def metal_ball(radius, ramp):
    """Return the picture of a polished ball, lit from above left, with a hard highlight. ramp: name of its colours."""
    size = 2 * radius
    sprite = Sprite(size, size)
    x, y = sprite.x, sprite.y
    sprite.part(circle(x, y, radius, radius, radius - 0.7), RAMPS[ramp], bulge=radius * 0.9, base=0.46, gain=0.75)
    sprite.flat(circle(x, y, radius * 0.66, radius * 0.58, radius * 0.16), WHITE)
    sprite.paint(circle(x, y, radius * 1.1, radius * 1.25, radius * 0.5), RAMPS[ramp][1], 0.25)
    return sprite.outline().pixels()


def iron_ball(radius):
    """Return the picture of the wrecking ball: cast iron with a band and rivets. radius: in px."""
    size = 2 * radius
    sprite = Sprite(size, size)
    x, y = sprite.x, sprite.y
    sprite.part(circle(x, y, radius, radius, radius - 0.7), RAMPS["gunmetal"], bulge=radius * 0.8, base=0.42, gain=0.6)
    sprite.paint(box(x, y, 0, radius - 3, size, radius + 3), RAMPS["gunmetal"][1], 0.6)
    for angle in range(-60, 61, 30):
        place = radius + (radius - 4) * round(math.sin(math.radians(angle)), 9)
        sprite.paint(circle(x, y, place, radius, 1.4), RAMPS["steel"][4])
    return sprite.outline().pixels()


def billiard_ball(number):
    """Return the picture of billiard ball `number`, 10 x 10 px: 0 is the cue ball, 9 to 15 have stripes."""
    sprite = Sprite(10, 10)
    x, y = sprite.x, sprite.y
    ramp = "steel" if number == 0 or number > 8 else "gunmetal" if number == 8 else BALLS[number - 1]
    base = 0.86 if ramp == "steel" else 0.25 if number == 8 else 0.56
    sprite.part(circle(x, y, 5, 5, 4.3), RAMPS[ramp], bulge=4.5, base=base, gain=0.35, grain=0.2)
    if number > 8:
        sprite.paint(box(x, y, 0, 3, 10, 7), RAMPS[BALLS[number - 9]][3], 0.9)
    if number:
        sprite.paint(box(x, y, 4, 4, 6, 6), RAMPS["steel"][5])
    sprite.paint(circle(x, y, 3.4, 2.8, 1.0), WHITE, 0.9)
    return sprite.outline().pixels()


def domino(width, height, pips):
    """Return the picture of an upright ivory domino with a line across its centre, width x height px.

    pips: numbers of pips in the upper and in the lower half.
    """
    sprite = Sprite(width, height)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 1, 1, width - 1, height - 1), RAMPS["steel"], bulge=2, base=0.82, gain=0.25, grain=0.3)
    sprite.paint(box(x, y, 1, height / 2 - 0.5, width - 1, height / 2 + 0.5), RAMPS["wood"][1], 0.8)
    for half, count in enumerate(pips):
        top = 1 + half * height / 2
        for index in range(count):
            middle = top + (index + 1) * (height / 2 - 1) / (count + 1)
            sprite.paint(box(x, y, width / 2 - 1.5, middle - 1.5, width / 2 + 1.5, middle + 1.5), RAMPS["red"][2])
    return sprite.outline().pixels()


def card(length, thickness, ramp):
    """Return the picture of a playing card seen from its edge, along x, length x thickness px. ramp: name of its
    colours.
    """
    sprite = Sprite(length, thickness)
    sprite.flat(box(sprite.x, sprite.y, 0, 0, length, thickness), RAMPS["steel"][5])
    sprite.paint(box(sprite.x, sprite.y, 0, thickness - 2, length, thickness), RAMPS[ramp][3])
    sprite.paint(box(sprite.x, sprite.y, 0, thickness - 1, length, thickness), RAMPS[ramp][1])
    for end in (0, length - 2):
        sprite.paint(box(sprite.x, sprite.y, end, 0, end + 2, thickness), RAMPS[ramp][2], 0.8)
    return sprite.pixels()


def floor(width, height):
    """Return the picture of a polished table top seen from the side, width x height px: boards with grain and a lit
    edge.
    """
    sprite = Sprite(width, height)
    x, y, wood = sprite.x, sprite.y, RAMPS["wood"]
    sprite.flat(box(x, y, 0, 0, width, height), wood[1])
    grain = layered_noise(width, height, 12, 24, 2, 5)
    sprite.rgb[grain % 0.14 < 0.05] = wood[0]
    sprite.flat(box(x, y, 0, 0, width, 6), wood[2])
    for left in range(-40, width, 96):
        sprite.paint(box(x, y, left, 1, left + 1, 6), wood[1])
    sprite.flat(box(x, y, 0, 0, width, 1), wood[4])
    sprite.flat(box(x, y, 0, 6, width, 7), OUTLINE)
    return sprite.pixels()


def table():
    """Return the picture of the billiard table from above: wooden frame, cushions, cloth, six pockets."""
    width, height = TABLE
    sprite = Sprite(width, height)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 1, 1, width - 1, height - 1, 8), RAMPS["wood"], bulge=7, base=0.42, gain=0.5)
    grain = layered_noise(width, height, 6, 60, 2, 11)
    lines = (grain % 0.16 < 0.05) & sprite.solid
    sprite.rgb[lines] = mix(sprite.rgb[lines], RAMPS["wood"][0], 0.35)
    inner = FRAME + CUSHION
    sprite.flat(box(x, y, FRAME - 1, FRAME - 1, width - FRAME + 1, height - FRAME + 1), OUTLINE)
    sprite.flat(box(x, y, FRAME, FRAME, width - FRAME, height - FRAME), RAMPS["teal"][1])
    sprite.paint(box(x, y, FRAME, FRAME, width - FRAME, FRAME + 2), RAMPS["teal"][3], 0.6)
    sprite.paint(box(x, y, FRAME, FRAME, FRAME + 2, height - FRAME), RAMPS["teal"][3], 0.6)
    cloth = box(x, y, inner, inner, width - inner, height - inner)
    sprite.part(cloth, RAMPS["teal"], bulge=40, base=0.41, gain=0.1, grain=0.55)
    sprite.paint(box(x, y, inner, inner, width - inner, inner + 3), OUTLINE, 0.35)
    sprite.paint(box(x, y, inner, inner, inner + 3, height - inner), OUTLINE, 0.35)
    head = inner + (width - 2 * inner) / 4
    sprite.paint(box(x, y, head, inner, head + 1, height - inner), RAMPS["teal"][4], 0.5)
    for part in (1, 2, 3, 5, 6, 7):
        for edge in (FRAME / 2, height - FRAME / 2):
            sprite.paint(circle(x, y, width * part / 8, edge, 1.5), RAMPS["gold"][5])
    for hole_x in (inner, width / 2, width - inner):
        for hole_y in (inner, height - inner):
            sprite.flat(circle(x, y, hole_x, hole_y, POCKET + 1.5), RAMPS["gunmetal"][2])
            sprite.flat(circle(x, y, hole_x, hole_y, POCKET), OUTLINE)
            sprite.paint(circle(x, y, hole_x + 1, hole_y + 2, POCKET - 2.5), (6, 4, 12))
    return sprite.outline().pixels()


def sword():
    """Return the picture of a broad sword along x, with its point on the right."""
    sprite = Sprite(38, 11)
    x, y = sprite.x, sprite.y
    sprite.part(polygon(x, y, ((11, 3), (31, 3.4), (37, 5.5), (31, 7.6), (11, 8))), RAMPS["steel"], bulge=2, base=0.7)
    sprite.paint(box(x, y, 11, 5, 32, 6), RAMPS["steel"][2], 0.6)
    sprite.part(capsule(x, y, (2.5, 5.5), (10, 5.5), 1.6), RAMPS["wood"], bulge=1.5, base=0.5)
    sprite.part(box(x, y, 8.6, 1, 11, 10, 1.0), RAMPS["gold"], bulge=1.5, base=0.6)
    sprite.part(circle(x, y, 2.6, 5.5, 1.9), RAMPS["red"], bulge=2, base=0.6)
    return sprite.outline().pixels()


def shot():
    """Return the picture of a brass bullet that flies to the right."""
    sprite = Sprite(9, 6)
    x, y = sprite.x, sprite.y
    sprite.part(capsule(x, y, (2.6, 3), (5.8, 3), 1.9, 1.5), RAMPS["gold"], bulge=1.8, base=0.66, gain=0.4)
    sprite.paint(box(x, y, 0, 0, 3, 6), RAMPS["orange"][2], 0.7)
    return sprite.outline().pixels()


def bracket(ramp):
    """Return the picture of an L-shaped iron bracket. ramp: name of its colours.

    It is concave, so its convex hull contains empty space.
    """
    sprite = Sprite(32, 24)
    x, y = sprite.x, sprite.y
    corner = polygon(x, y, ((1, 1), (10, 1), (10, 14), (31, 14), (31, 23), (1, 23)))
    sprite.part(corner, RAMPS[ramp], bulge=2.5, base=0.5, gain=0.32, grain=0.3)
    for place in ((5.5, 5.5), (5.5, 18.5), (26.5, 18.5)):
        sprite.paint(circle(x, y, *place, 1.7), RAMPS[ramp][1], 0.8)
        sprite.paint(circle(x, y, place[0] - 0.4, place[1] - 0.4, 0.9), RAMPS[ramp][5], 0.8)
    return sprite.outline().pixels()


def star(ramp):
    """Return the picture of a five-pointed star with blunt points. ramp: name of its colours."""
    sprite = Sprite(26, 26)
    angles = [math.radians(-90 + i * 36) for i in range(10)]
    points = [
        (13 + r * round(math.cos(a), 9), 13.5 + r * round(math.sin(a), 9))
        for a, r in zip(angles, (12.0, 6.2) * 5, strict=True)
    ]
    sprite.part(polygon(sprite.x, sprite.y, points), RAMPS[ramp], bulge=4, base=0.55, gain=0.35, grain=0.3)
    return sprite.outline().pixels()


def tray():
    """Return the picture of a stone floor with a low rim at both ends."""
    sprite = Sprite(94, 24)
    x, y = sprite.x, sprite.y
    stone = RAMPS["stone"]
    for left, top, right, bottom in ((1, 1, 8, 23), (86, 1, 93, 23), (1, 11, 93, 23)):
        sprite.part(box(x, y, left, top, right, bottom), stone, bulge=2, base=0.42, gain=0.3, grain=0.6, shadow=1)
    sprite.paint(box(x, y, 1, 17, 93, 18), stone[0], 0.7)
    for row, first in ((11, 14), (18, 24)):
        for left in range(first, 90, 20):
            sprite.paint(box(x, y, left, row, left + 1, row + 6), stone[0], 0.7)
    sprite.paint(box(x, y, 8, 11, 86, 12), stone[4], 0.8)
    return sprite.outline().pixels()


def lab_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "lab"."""
    sheet = Sheet("lab")
    for size in (11, 16, 24):
        for look in range(3):
            sheet.add(f"crate_{size}_{look}", crate(size, look))
    for ramp in TOYS:
        sheet.add(f"block_{ramp}", block(10, 10, ramp))
        sheet.add(f"brick_{ramp}", block(14, 6, ramp))
        sheet.add(f"disc_{ramp}", disc(5, ramp))
        sheet.add(f"pill_{ramp}", pill(6, 3, ramp))
        sheet.add(f"triangle_{ramp}", gem(corners(3, 14, -90), 14, ramp))
        sheet.add(f"hexagon_{ramp}", gem(corners(6, 12, 0), 12, ramp))
    sheet.add("steel_ball", metal_ball(14, "steel"))
    sheet.add("striker_ball", metal_ball(14, "gold"))
    sheet.add("iron_ball", iron_ball(20))
    for number in range(16):
        sheet.add(f"ball_{number}", billiard_ball(number))
    for index, pips in enumerate(((1, 2), (3, 1), (2, 3), (2, 2))):
        sheet.add(f"domino_{index}", domino(9, 48, pips))
    sheet.add("card_red", card(52, 4, "red"))
    sheet.add("card_blue", card(49, 4, "blue"))
    sheet.add("sword", sword())
    sheet.add("shot", shot())
    sheet.add("bracket_teal", bracket("teal"))
    sheet.add("bracket_purple", bracket("purple"))
    sheet.add("star_gold", star("gold"))
    sheet.add("tray", tray())
    sheet.add("disc_large", disc(12, "red"))
    sheet.add("floor", floor(480, 32))
    sheet.add("table", table())
    return sheet.files()
