"""The bomb's shock ring, the player's shot of full power, and the spark of an enemy bullet that just missed.

The ring is drawn by alpha blending, not by adding its colours: a thin bright front, and behind it a broken wake that
cools from teal to blue.
"""

import numpy as np

from assets.craft.fields import capsule, dither, layered_noise, length
from assets.craft.palette import RAMPS, WHITE
from assets.craft.shading import Sprite
from assets.shooter.explosions import directions

RING_SIZES = (48, 96, 144, 184, 216, 240)  # [px] of the square frames
WAKE = (0.95, 0.58, 0.38, 0.28, 0.21, 0.15)  # width of the wake behind the front, as a share of the radius


def bomb_ring(frame):
    """Return the picture of the shock ring of the player's bomb, (h, w, 4) uint8. frame: 0..5, an index into
    RING_SIZES.
    """
    size = RING_SIZES[frame]
    sprite = Sprite(size, size)
    radius = size / 2 - 1.5
    distance = length(sprite.x - size / 2, sprite.y - size / 2)
    grain = layered_noise(size, size, 8, 8, 3, 410 + frame) - 0.5
    behind = (radius - distance) / (radius * WAKE[frame])  # 0 at the front, 1 where the wake ends
    level = behind + grain * (0.5 + 0.12 * frame) + dither(size, size) * 0.34
    tones = (RAMPS["teal"][5], RAMPS["teal"][4], RAMPS["teal"][3], RAMPS["blue"][3], RAMPS["blue"][2])
    inside = distance < radius - 1
    for i, tone in enumerate(tones):
        share = (i + 1) / len(tones) * (1.0 - 0.07 * frame)
        band = inside & (level < share) & ~sprite.solid
        sprite.rgb[band] = tone
        sprite.solid |= band
    front = np.abs(distance - radius + 1.4) < (1.4, 1.3, 1.2, 1.0, 0.8, 0.6)[frame]
    if frame == 5:  # breaks up before it goes
        front &= dither(size, size) > -0.2
    sprite.rgb[front] = WHITE
    sprite.solid |= front
    for i, way in enumerate(directions(32)):
        if i % 2 == frame % 2 and frame < 3:  # splinters of the flash, until the front has overtaken them
            reach = radius - 2 - (i * 7 % 5)
            start = (size / 2 + way[0] * (reach - 4 - i % 3), size / 2 + way[1] * (reach - 4 - i % 3))
            end = (size / 2 + way[0] * reach, size / 2 + way[1] * reach)
            sprite.flat(capsule(sprite.x, sprite.y, start, end, 0.5, 1.1), WHITE)
    return sprite.pixels()


def heavy_shot():
    """Return the picture of the player's shot of full power, 10 x 22 px, which flies upwards."""
    sprite = Sprite(10, 22)
    x, y = sprite.x, sprite.y
    sprite.flat(capsule(x, y, (5, 5), (5, 18.6), 4.6, 1.4), RAMPS["blue"][2])
    sprite.flat(capsule(x, y, (5, 4.8), (5, 15.6), 3.5, 1.1), RAMPS["blue"][4])
    sprite.flat(capsule(x, y, (5, 4.8), (5, 13), 2.5, 0.9), RAMPS["teal"][5])
    sprite.flat(capsule(x, y, (5, 4.6), (5, 10), 1.5, 0.7), WHITE)
    for side in (-1, 1):
        sprite.flat(capsule(x, y, (5 + side * 3.4, 9), (5 + side * 4, 15), 0.7, 0.5), RAMPS["blue"][3])
    return sprite.pixels()


def graze_spark(frame):
    """Return the picture of the spark of a bullet that just missed: four short rays of light, 12 x 12 px.
    frame: 0..2.
    """
    sprite = Sprite(12, 12)
    start, end = ((0.0, 3.0), (1.6, 4.6), (3.4, 5.2))[frame]
    for dx, dy in ((0.7, -0.7), (-0.7, -0.7), (-0.7, 0.7), (0.7, 0.7)):
        sprite.flat(
            capsule(
                sprite.x,
                sprite.y,
                (6 + dx * start, 6 + dy * start),
                (6 + dx * end, 6 + dy * end),
                0.9 - 0.2 * frame,
                0.5,
            ),
            (WHITE, RAMPS["gold"][5], RAMPS["gold"][4])[frame],
        )
        if frame == 0:
            sprite.flat(capsule(sprite.x, sprite.y, (6, 6), (6 + dx * 5, 6 + dy * 5), 1.2, 0.5), WHITE)
    return sprite.pixels()


def add_blasts(sheet):
    """Add the bomb's shock ring, the shot of full power and the graze spark to a sprite sheet."""
    sheet.add_sequence("bomb_ring", [bomb_ring(i) for i in range(len(RING_SIZES))], 20)
    sheet.add("heavy_shot", heavy_shot())
    sheet.add_sequence("graze_spark", [graze_spark(i) for i in range(3)], 24)
