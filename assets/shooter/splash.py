"""A splash in the sea, seen from above: foam that flies up, and rings that grow and break up."""

from assets.craft.fields import circle, dither, layered_noise, length
from assets.craft.palette import RAMPS, WHITE
from assets.craft.shading import Sprite
from assets.shooter.explosions import directions

FRAMES = 7
FOAM = (WHITE, RAMPS["steel"][5], RAMPS["blue"][4], RAMPS["blue"][3])


def splash(size, seed):
    """Return the pictures of a splash's FRAMES frames, a list of (size, size, 4) uint8.

    seed: seed of the random numbers.
    """
    grain = layered_noise(size, size, 6, 6, 2, seed) - 0.5
    return [_frame(number, size, grain) for number in range(FRAMES)]


def _frame(number, size, grain):
    sprite, middle, t = Sprite(size, size), size / 2, number / (FRAMES - 1)
    distance = length(sprite.x - middle, sprite.y - middle)
    ragged = dither(size, size) * 0.5 + grain
    for start, tone in ((0.0, 1 + number // 3), (0.28, 2 + number // 4)):  # two rings, the second one late
        age = t - start
        if age < 0.0:
            continue
        radius, width = size * (0.10 + 0.36 * (age * (2 - age))), size * 0.055 * (1.25 - t)
        ring = (abs(distance - radius) < width) & (ragged < 0.62 - 0.9 * age)
        sprite.rgb[ring] = FOAM[min(tone, 3)]
        sprite.solid |= ring
    if t < 0.55:  # the water that was thrown up falls back
        crown = size * (0.20 - 0.30 * (t - 0.18) * (t - 0.18) / 0.14)
        for tone, share in ((2, 1.0), (1, 0.74), (0, 0.45)):
            field = circle(sprite.x, sprite.y, middle, middle - size * 0.03, crown * share)
            sprite.flat(field + grain * 3.0, FOAM[tone])
    for i, way in enumerate(directions(16)):
        away = size * (0.14 + (0.20 + 0.05 * (i % 4)) * t * (2 - t))
        column, row = int(middle + way[0] * away), int(middle + way[1] * away - size * 0.10 * t * (1 - t))
        if (i + number) % 3 and t < 0.8 and 0 <= column < size and 0 <= row < size:
            sprite.dot(column, row, FOAM[0 if number < 3 else 1])
    return sprite.pixels()
