"""The sprite sheet "effects": the player's bullets, flashes, sparks, smoke, debris and discs of light.

The player's bullets are long, in blue and white; the enemies' bullets (enemy_bullets.py) are round with a dark ring.
So both are visible on any background, and their shapes differ. Discs of light are opaque on black, because they are
drawn by adding their colours to the screen's.
"""

import numpy as np

from assets.craft.atlas import Sheet
from assets.craft.fields import capsule, circle, length, noise, polygon
from assets.craft.palette import FIRE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite, glow
from assets.shooter.blasts import add_blasts
from assets.shooter.enemy_bullets import add_enemy_bullets
from assets.shooter.explosions import explosion
from assets.shooter.splash import splash


def player_bullet(frame):
    """Return the picture of the player's bullet, a blue streak that flies upwards, 6 x 16 px. frame: 0..1."""
    sprite = Sprite(6, 16)
    x, y = sprite.x, sprite.y
    tail = (13.5, 11.5)[frame]
    sprite.flat(capsule(x, y, (3, 3.2), (3, tail), 2.6, 0.9), RAMPS["blue"][2])
    sprite.flat(capsule(x, y, (3, 3.0), (3, tail - 2), 1.7, 0.7), RAMPS["teal"][4])
    sprite.flat(capsule(x, y, (3, 2.8), (3, tail - 5), 1.0, 0.6), WHITE)
    return sprite.pixels()


def side_bullet():
    """Return the picture of the thin bullet of the player's second weapon level, 4 x 10 px."""
    sprite = Sprite(4, 10)
    x, y = sprite.x, sprite.y
    sprite.flat(capsule(x, y, (2, 2), (2, 8), 1.7, 0.8), RAMPS["blue"][3])
    sprite.flat(capsule(x, y, (2, 2), (2, 5), 0.9, 0.6), WHITE)
    return sprite.pixels()


def muzzle_flash(frame):
    """Return the picture of a gun's star-shaped flash, 14 x 14 px. frame: 0..2."""
    sprite = Sprite(14, 14)
    x, y = sprite.x, sprite.y
    reach, waist = ((5.4, 2.6), (6.6, 2.0), (4.2, 1.2))[frame]
    points = []
    for i, (step_x, step_y) in enumerate(
        ((0, -1), (0.7, -0.7), (1, 0), (0.7, 0.7), (0, 1), (-0.7, 0.7), (-1, 0), (-0.7, -0.7))
    ):
        distance = reach if i % 2 == 0 else waist
        points.append((7 + step_x * distance, 7 + step_y * distance))
    star = polygon(x, y, points)
    sprite.flat(star, RAMPS["teal"][4]).flat(star + 0.9, RAMPS["teal"][5])
    sprite.flat(circle(x, y, 7, 7, waist), WHITE)
    return sprite.pixels()


def spark(frame):
    """Return the picture of an impact's sparks, which fly apart, 16 x 16 px. frame: 0..4."""
    sprite = Sprite(16, 16)
    if frame < 2:
        sprite.flat(circle(sprite.x, sprite.y, 8, 8, (3.4, 2.2)[frame]), FIRE[frame])
    for i, (step_x, step_y) in enumerate(
        ((0.1, -1), (0.8, -0.6), (1, 0.2), (0.5, 0.9), (-0.3, 1), (-0.9, 0.5), (-1, -0.2), (-0.6, -0.8))
    ):
        start = 1.5 + frame * 1.3 * (0.8 + 0.2 * (i % 3))
        stroke = max(0.6, 2.6 - frame * 0.5)
        begin = (8 + step_x * start, 8 + step_y * start)
        end = (8 + step_x * (start + stroke), 8 + step_y * (start + stroke))
        sprite.flat(capsule(sprite.x, sprite.y, begin, end, 0.62), FIRE[min(4, frame + i % 2)])
    return sprite.pixels()


def smoke(frame):
    """Return the picture of a puff of smoke that grows, rises and dissolves, 20 x 20 px. frame: 0..5."""
    sprite = Sprite(20, 20)
    t = frame / 5
    x, y = sprite.x, sprite.y
    tones = [mix(RAMPS["gunmetal"][i], RAMPS["stone"][i], 0.5) for i in range(1, 6)]
    grain = (noise(20, 20, 5, 5, 50 + frame) - 0.5) * (0.4 + 2.6 * t)
    spread = 1.0 + 0.45 * t
    lobes = ((0, 1.4, 4.3), (-3.2, 2.0, 3.0), (3.4, 1.8, 3.0), (-2.2, -2.0, 3.2), (2.4, -1.8, 3.0), (0.2, -3.8, 2.6))
    for i, (shift, share) in enumerate(((0.0, 1.0), (0.5, 0.74), (0.9, 0.36))):  # dark, body, light: upper left
        for dx, dy, size in lobes:
            middle_x, middle_y = 10 + dx * spread, 10.6 + dy * spread - t * 1.6
            radius = size * (0.86 + 0.42 * t) - t * t * 3.3
            field = circle(x, y, middle_x - shift, middle_y - shift * 1.3, radius * share) + grain
            sprite.flat(field, tones[min(4, i + 1 + (frame < 2))])
    return sprite.pixels()


def debris(kind):
    """Return the picture of one torn piece of metal plate, 10 x 10 px. kind: 0..5, its shape and colour."""
    random = np.random.default_rng(70 + kind)
    sprite = Sprite(10, 10)
    turns = np.sort(random.random(6)) * 8
    points = []
    for turn in turns:
        side, along = int(turn) // 2, turn % 2 - 1  # around a square, without sines
        reach = 2.2 + 1.9 * random.random()
        corner = ((1, along), (-along, 1), (-1, -along), (along, -1))[side]
        points.append((5 + corner[0] * reach, 5 + corner[1] * reach))
    ramp = ("steel", "red", "olive", "purple", "gunmetal", "blue")[kind]
    sprite.part(polygon(sprite.x, sprite.y, points), RAMPS[ramp], bulge=2.2, base=0.5).outline()
    return sprite.pixels()


def hitbox_dot():
    """Return the picture of a dot, 9 x 9 px, that marks the core of the plane while the player flies slowly.

    The core is the small centre of the plane. By default only hits of the core cost a life.
    """
    sprite = Sprite(9, 9)
    distance = length(sprite.x - 4.5, sprite.y - 4.5)
    sprite.flat(distance - 4.2, RAMPS["red"][1]).flat(distance - 3.2, RAMPS["pink"][4]).flat(distance - 2.1, WHITE)
    return sprite.pixels()


def effects_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "effects"."""
    sheet = Sheet("effects")
    sheet.add_sequence("player_bullet", [player_bullet(i) for i in range(2)], 20)
    sheet.add("side_bullet", side_bullet())
    add_enemy_bullets(sheet)
    sheet.add_sequence("muzzle_flash", [muzzle_flash(i) for i in range(3)], 40)
    sheet.add_sequence("explosion_small", explosion(12, 36, 5), 26)
    sheet.add_sequence("explosion_large", explosion(16, 72, 9), 24)
    sheet.add_sequence("spark", [spark(i) for i in range(5)], 30)
    sheet.add_sequence("smoke", [smoke(i) for i in range(6)], 14)
    sheet.add_sequence("debris", [debris(i) for i in range(6)], 1)
    sheet.add("glow_small", glow(32, "orange"))
    sheet.add("glow_large", glow(96, "orange"))
    sheet.add("glow_blue", glow(32, "blue"))
    sheet.add("hitbox_dot", hitbox_dot())
    add_blasts(sheet)
    sheet.add_sequence("splash", splash(24, 440), 16)
    sheet.add_sequence("splash_large", splash(44, 441), 15)
    return sheet.files()
