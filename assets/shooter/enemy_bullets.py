"""Enemy bullets: a dark ring, a saturated ring and a white centre, so that a bullet stands out on any background.

Each kind has two sets of pictures with the same silhouette: NAME, and safe_NAME in colours of the Okabe-Ito set, which
are distinct under colour blindness. The white centres of the safe set also differ in shape. A round bullet has two
frames, between which it pulses.
"""

import numpy as np

from assets.craft.fields import capsule, length
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite

FPS = 12  # frames per second of the pulse
# name: (outer radius of the dark ring in px, frame size in px, ramp)
ROUND = {
    "bullet_red": (4.9, 12, "red"),
    "bullet_purple": (3.9, 10, "purple"),
    "bullet_orange": (5.9, 14, "orange"),
    "bullet_small": (3.2, 6, "pink"),
    "bullet_big": (7.0, 14, "orange"),
    "bullet_ring": (5.1, 10, "teal"),
}
# name: (Okabe-Ito colour, shape of the core)
SAFE = {
    "bullet_red": ((213, 94, 0), "disc"),
    "bullet_purple": ((204, 121, 167), "bar"),
    "bullet_orange": ((230, 159, 0), "cross"),
    "bullet_small": ((204, 121, 167), "dot"),
    "bullet_big": ((230, 159, 0), "diamond"),
    "bullet_ring": ((0, 158, 115), "hollow"),
    "bullet_needle": ((240, 228, 66), "streak"),
}
RING_DARK = mix(OUTLINE, RAMPS["purple"][0], 0.3)


def tones_of(name, safe):
    """Return the three colours (edge, body, light) of a bullet's saturated ring, from dark to light.

    name: name of the bullet; safe: whether to use the colours that are distinct under colour blindness.
    """
    if safe:
        colour = np.array(SAFE[name][0], np.uint8)
        return mix(colour, OUTLINE, 0.20), colour, mix(colour, WHITE, 0.35)
    ramp = RAMPS["orange" if name == "bullet_needle" else ROUND[name][2]]
    return ramp[2], ramp[3], ramp[4]


def round_bullet(name, safe, frame):
    """Return the picture of one round bullet, (size, size, 4) uint8.

    name: key of ROUND; safe: whether to use the colours that are distinct under colour blindness; frame: 0..1.
    """
    radius, size, _ = ROUND[name]
    sprite = Sprite(size, size)
    dx, dy = sprite.x - size / 2, sprite.y - size / 2
    distance = length(dx, dy)
    edge, body, light = tones_of(name, safe)
    sprite.flat(distance - radius, RING_DARK)
    sprite.flat(distance - (radius - 0.95), edge)
    sprite.flat(distance - (radius - 1.35), body)
    core = max(1.0, (radius - 2.0) * (0.60 + 0.14 * frame))
    shape = SAFE[name][1] if safe else "hollow" if name == "bullet_ring" else "disc"
    if shape == "hollow":
        sprite.flat(abs(distance - (radius - 2.3)) - (0.75 + 0.15 * frame), WHITE)
        sprite.flat(distance - (radius - 3.3), body)
        return sprite.pixels()
    sprite.flat(distance - (core + 0.75), light)
    if shape == "bar":
        field = np.maximum(abs(dx) - 1.05, abs(dy) - core - 0.4)
    elif shape == "cross":
        field = np.minimum(
            np.maximum(abs(dx) - 1.05, abs(dy) - core - 0.5), np.maximum(abs(dy) - 1.05, abs(dx) - core - 0.5)
        )
    elif shape == "diamond":
        field = abs(dx) + abs(dy) - core - 0.9
    else:
        field = distance - core
    sprite.flat(field, WHITE)
    return sprite.pixels()


def needle(safe):
    """Return the picture of the bullet of aimed shots, 7 x 14 px, which points down.

    safe: whether to use the colours that are distinct under colour blindness.
    """
    sprite = Sprite(7, 14)
    x, y = sprite.x, sprite.y
    edge, body, light = tones_of("bullet_needle", safe)
    sprite.flat(capsule(x, y, (3.5, 3.4), (3.5, 10), 1.6, 3.2), RING_DARK)
    sprite.flat(capsule(x, y, (3.5, 4.2), (3.5, 10), 0.7, 2.15), body)
    sprite.flat(capsule(x, y, (3.5, 6), (3.5, 10), 0.6, 1.3), WHITE)
    if safe:  # its core is split
        sprite.dot(3, 8, body).dot(3, 9, body)
    return sprite.pixels()


def add_enemy_bullets(sheet):
    """Add every enemy bullet to a sprite sheet, in its own colours and in those that suit colour blindness."""
    for safe in (False, True):
        prefix = "safe_" if safe else ""
        for name in ROUND:
            sheet.add_sequence(prefix + name, [round_bullet(name, safe, frame) for frame in range(2)], FPS)
        sheet.add(f"{prefix}bullet_needle", needle(safe))
