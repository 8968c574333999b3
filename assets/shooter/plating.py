"""Surface details of large machines: panel lines, rivets, vents, turrets, lights, scorch marks and holes.

Every function draws on a Sprite and returns nothing. Coordinates are px in the sprite's picture.
"""

from itertools import pairwise

import numpy as np

from assets.craft.fields import box, capsule, circle, length, noise, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix

STRIPE = 3  # [px] width of a warning stripe
GLOWS = {
    # name: colours from the rim of a glowing lens to its middle
    "red": (RAMPS["red"][1], RAMPS["red"][2], RAMPS["red"][3], RAMPS["orange"][4], RAMPS["gold"][5]),
    "pink": (RAMPS["pink"][1], RAMPS["pink"][2], RAMPS["pink"][3], RAMPS["pink"][4], RAMPS["pink"][5]),
    "teal": (RAMPS["teal"][1], RAMPS["teal"][2], RAMPS["teal"][3], RAMPS["teal"][4], RAMPS["teal"][5]),
}


def seam(sprite, ramp, left, top, right, bottom):
    """Draw a straight panel line, with the lit edge of the next plate beside it, into `sprite`.

    The line fills the box from (left, top) to (right, bottom), which is one pixel wide or one pixel high. ramp: name
    of the plates' colours, a key of RAMPS.
    """
    x, y = sprite.x, sprite.y
    level = right - left >= bottom - top
    sprite.paint(box(x, y, left, top, right, bottom), RAMPS[ramp][1], 0.75)
    dx, dy = (0, 1) if level else (1, 0)
    sprite.paint(box(x, y, left + dx, top + dy, right + dx, bottom + dy), RAMPS[ramp][5], 0.28)


def rivets(sprite, ramp, places):
    """Draw rivets into `sprite`: each is one dark pixel, with a light pixel at its upper left.

    ramp: name of the colours, a key of RAMPS; places: positions of the rivets, [(x, y)] in px. Rivets outside of the
    sprite's solid pixels are omitted.
    """
    for x, y in places:
        if sprite.solid[int(y), int(x)]:
            sprite.dot(int(x), int(y), RAMPS[ramp][1])
            if sprite.solid[int(y) - 1, int(x) - 1]:
                sprite.dot(int(x) - 1, int(y) - 1, RAMPS[ramp][5])


def vent(sprite, left, top, right, bottom):
    """Draw a grille with dark slits into the box from (left, top) to (right, bottom) of `sprite`."""
    x, y = sprite.x, sprite.y
    sprite.paint(box(x, y, left, top, right, bottom), RAMPS["gunmetal"][1])
    for row in range(int(top) + 1, int(bottom), 2):
        sprite.paint(box(x, y, left + 1, row, right - 1, row + 1), OUTLINE)
    sprite.paint(box(x, y, left, bottom - 1, right, bottom), RAMPS["gunmetal"][4], 0.6)


def stripes(sprite, left, top, right, bottom):
    """Draw gold and grey diagonal warning stripes into the box from (left, top) to (right, bottom) of `sprite`."""
    inside = box(sprite.x, sprite.y, left, top, right, bottom) < 0
    gold = ((sprite.x + sprite.y) // STRIPE).astype(int) % 2 == 0
    inside &= sprite.solid
    sprite.rgb[inside & gold] = RAMPS["gold"][4]
    sprite.rgb[inside & ~gold] = RAMPS["gunmetal"][1]


def turret(sprite, x, y, radius, ramp, reach):
    """Draw a round gun turret on a ring, with two barrels that point down, into `sprite`.

    x, y: centre of the turret; radius: its radius; ramp: name of its colours, a key of RAMPS; reach: distance from the
    centre to the muzzles. All lengths are in px.
    """
    px, py = sprite.x, sprite.y
    sprite.part(circle(px, py, x, y, radius + 1.5), RAMPS["gunmetal"], bulge=1.5, base=0.26, gain=0.3)
    for side in (-1, 1):
        across = x + side * radius * 0.40
        sprite.flat(box(px, py, across - 1.6, y, across + 1.6, y + reach + 0.6), OUTLINE)
        sprite.flat(box(px, py, across - 0.7, y, across + 0.7, y + reach), RAMPS["steel"][3])
        sprite.paint(box(px, py, across - 0.7, y, across - 0.05, y + reach), RAMPS["steel"][5], 0.7)
        sprite.flat(box(px, py, across - 1.1, y + reach - 2, across + 1.1, y + reach), RAMPS["steel"][2])
    sprite.part(circle(px, py, x, y, radius), RAMPS[ramp], bulge=radius, base=0.52, gain=0.55, grain=0.2)
    sprite.paint(abs(length(px - x, py - y) - radius * 0.52) - 0.45, RAMPS[ramp][1], 0.55)
    sprite.paint(circle(px, py, x - radius * 0.34, y - radius * 0.42, max(0.8, radius * 0.24)), RAMPS[ramp][5], 0.95)


def lens(sprite, x, y, radius, glow, strength):
    """Draw a glowing lens in a dark socket into `sprite`.

    x, y: centre [px]; radius: radius of the socket [px]; glow: key of GLOWS; strength: 0..1, a higher one makes the
    bright colours larger.
    """
    distance = length(sprite.x - x, sprite.y - y)
    sprite.flat(distance - radius, OUTLINE)
    tones = GLOWS[glow]
    for i, tone in enumerate(tones):
        share = (0.88, 0.72, 0.52, 0.34, 0.18)[i] * (1.0 if i == 0 else 0.62 + 0.5 * strength)
        sprite.flat(
            length(sprite.x - x + i * 0.12 * radius * 0.3, sprite.y - y + i * 0.12 * radius * 0.4)
            - radius * min(share, 0.88),
            tone,
        )
    sprite.flat(length(sprite.x - x + radius * 0.3, sprite.y - y + radius * 0.38) - max(0.6, radius * 0.14), WHITE)


def nozzle(sprite, left, right, top, bottom, hot):
    """Draw the rear end of an engine, seen from above, into the box from (left, top) to (right, bottom) of `sprite`.

    The opening is at the top. hot: brightness of the glow, 0..1.
    """
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, left, top, right, bottom, 1.5), RAMPS["gunmetal"], bulge=3, base=0.46)
    sprite.paint(box(x, y, left + 1, top, right - 1, top + 3.2), RAMPS["orange"][2 + round(hot)])
    sprite.paint(box(x, y, left + 2, top, right - 2, top + 1.6 + hot), RAMPS["gold"][4 + round(hot)])
    sprite.paint(box(x, y, left, top + 4, right, top + 5), RAMPS["gunmetal"][0], 0.8)


def scorch(sprite, x, y, radius, seed):
    """Draw a patch of soot with a ragged edge around the point (x, y) into `sprite`.

    radius: mean radius of the patch [px]; seed: seed of the random numbers.
    """
    height, width = sprite.solid.shape
    rough = (noise(width, height, max(2, width // 5), max(2, height // 5), seed) - 0.5) * radius
    field = length(sprite.x - x, sprite.y - y) - radius + rough
    sprite.paint(field, OUTLINE, 0.35)
    sprite.paint(field + radius * 0.35, OUTLINE, 0.55)


def wound(sprite, x, y, radius, seed, hot):
    """Draw a torn hole around (x, y) into the plates of `sprite`: soot, a bright ragged edge, and a glow inside.

    radius: mean radius of the hole [px]; hot: brightness of the glow, 0..1; seed: seed of the random numbers.
    """
    scorch(sprite, x, y, radius * 1.9, seed)
    height, width = sprite.solid.shape
    rough = (noise(width, height, max(2, width // 3), max(2, height // 3), seed + 1) - 0.5) * radius * 1.5
    field = length(sprite.x - x, sprite.y - y) - radius + rough
    sprite.paint(abs(field) - 0.6, RAMPS["gunmetal"][4])
    sprite.paint(field, OUTLINE)
    sprite.paint(field + radius * 0.3, RAMPS["red"][2])
    sprite.paint(field + radius * (0.62 - 0.2 * hot), RAMPS["orange"][3 + round(hot)])
    sprite.paint(field + radius * (0.9 - 0.25 * hot), RAMPS["gold"][5])


def cracks(sprite, lines, hot):
    """Draw glowing cracks one pixel wide, with a dark rim, into `sprite`.

    lines: one list of points (x, y) for each crack; hot: brightness of the glow, 0..1.
    """
    tone = mix(RAMPS["orange"][3], RAMPS["gold"][5], hot)
    for points in lines:
        for start, end in pairwise(points):
            sprite.paint(capsule(sprite.x, sprite.y, start, end, 1.5), OUTLINE, 0.6)
    for points in lines:
        for start, end in pairwise(points):
            sprite.paint(capsule(sprite.x, sprite.y, start, end, 0.62), tone)


def torn(sprite, points, seed):
    """Remove everything inside a polygon from `sprite`, and leave a ragged and charred edge.

    points: corners (x, y) of the polygon [px]; seed: seed of the random numbers.
    """
    height, width = sprite.solid.shape
    rough = (noise(width, height, max(2, width // 3), max(2, height // 3), seed) - 0.5) * 4
    field = polygon(sprite.x, sprite.y, points) + rough
    sprite.paint(field - 3.2, OUTLINE, 0.45)
    sprite.paint(np.abs(field - 0.8) - 0.7, RAMPS["orange"][3], 0.8)
    sprite.cut(field)
