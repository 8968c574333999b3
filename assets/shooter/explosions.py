"""Explosions: hot balls fly out, merge, cool through the colours of fire, break into cinders and vanish.

A pixel's heat is the heat of the hottest ball there, plus noise. Its colour is darker at lower heat and at later times.
The balls stay inside the frame, so that the frame's border does not cut off any ball.
"""

import numpy as np

from assets.craft.fields import dither, layered_noise, length
from assets.craft.palette import FIRE
from assets.craft.shading import Sprite

BALLS = 22
DIRECTIONS = 64  # possible start directions of the balls
RING_FRAMES = range(1, 5)  # frames with the shock ring


def directions(count):
    """Return a list of `count` unit vectors (x, y) around the circle, equal on every machine. count: a multiple of 4.

    They are computed from the rational points ((1-t²)/(1+t²), 2t/(1+t²)).
    """
    quarter = []
    for i in range(count // 4):
        t = i / (count // 4)
        t = t * (0.785 + 0.215 * t * t)  # nearly even angles
        quarter.append(((1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)))
    out = []
    for _ in range(4):
        out += quarter
        quarter = [(-y, x) for x, y in quarter]
    return out


def explosion(frames, size, seed):
    """Return the pictures of an explosion's frames, a list of (size, size, 4) uint8.

    frames: number of the frames; size: width and height [px]; seed: seed of the random numbers.
    """
    random = np.random.default_rng(seed)
    compass = directions(DIRECTIONS)
    balls = [
        {
            # Every fifth direction of an even spread, so that no side stays empty; the first balls fill the middle.
            "way": compass[(i * DIRECTIONS * 5 // BALLS + int(random.integers(6))) % DIRECTIONS],
            "reach": (0.05 + 0.95 * i / (BALLS - 1)) * (0.85 + 0.3 * random.random()),
            "size": 0.60 + 0.45 * random.random(),
            "delay": 0.25 * random.random(),
        }
        for i in range(BALLS)
    ]
    grain = layered_noise(size, size, 6, 6, 3, seed + 100) - 0.5
    return [_frame(i / (frames - 1), i, size, balls, grain, compass) for i in range(frames)]


def _frame(t, index, size, balls, grain, compass):
    sprite = Sprite(size, size)
    x, y, centre = sprite.x, sprite.y, size / 2
    if index == 0:  # the first instant: a white disc
        sprite.flat(length(x - centre, y - centre) - size * 0.25, FIRE[0])
        sprite.flat(abs(length(x - centre, y - centre) - size * 0.25) - 0.6, FIRE[1])
        return sprite.pixels()
    heat = np.full((size, size), -9.0)
    for ball in balls:
        late = ball["delay"] * 0.6
        age = min(1.0, max(0.0, (t - late) / (1 - late)))
        flown = 0.30 + 0.70 * (1 - (1 - age) * (1 - age) * (1 - age))
        pulse = 4 * (age * 0.82 + 0.12) * (1 - (age * 0.82 + 0.12))  # a parabola: 0 at birth, 1 half way
        radius = size * 0.165 * ball["size"] * (0.55 + 0.75 * pulse)
        away = min(size * 0.37 * ball["reach"] * flown, centre - 2 - radius)
        rise = size * 0.06 * age  # hot gas climbs
        distance = length(x - centre - ball["way"][0] * away, y - centre + rise - ball["way"][1] * away)
        heat = np.maximum(heat, 1 - distance / radius)
    heat = heat + grain * (0.35 + 0.5 * t)
    border = np.minimum(np.minimum(x, y), np.minimum(size - x, size - y))
    alive = (heat > 0.05 + 0.85 * max(0.0, t - 0.42) / 0.58) & (border > 1)
    level = np.clip(np.floor((1 - heat) * 2.6 + t * 7.4 - 1.3 + dither(size, size) * 0.7 + 0.35), 0, 7).astype(int)
    sprite.rgb[alive] = FIRE[level[alive]]
    sprite.solid = alive
    if size >= 48 and index in RING_FRAMES:
        _ring(sprite, size * (0.24 + 0.07 * index), index)
    _sparks(sprite, t, compass)
    return sprite.pixels()


def _ring(sprite, radius, index):
    """Draw the explosion's shock ring into `sprite` behind the fire.

    radius: radius of the ring [px]; index: 1..4, number of the frame; the ring gets thinner.
    """
    centre = sprite.solid.shape[0] / 2
    distance = abs(length(sprite.x - centre, sprite.y - centre) - min(radius, centre - 1.5))
    ring = (distance < (0.9, 0.75, 0.6, 0.5)[index - 1]) & ~sprite.solid
    if index == 4:  # breaks up before it goes
        ring &= dither(*ring.shape) > 0
    sprite.rgb[ring] = FIRE[(1, 2, 3, 4)[index - 1]]
    sprite.solid |= ring


def _sparks(sprite, t, compass):
    """Draw ten glowing specks, which fly ahead of the fire, into `sprite`.

    t: time since the explosion's start as a share of its duration, 0..1; compass: unit vectors from directions().
    """
    size = sprite.solid.shape[0]
    if t > 0.62:
        return
    for i in range(10):
        way = compass[(i * 19 + 5) % DIRECTIONS]
        away = size * (0.16 + (0.26 + 0.07 * (i % 3)) * t / 0.62)
        column, row = int(size / 2 + way[0] * away), int(size / 2 + way[1] * away)
        if 1 <= column < size - 2 and 1 <= row < size - 1:
            sprite.dot(column, row, FIRE[min(6, int(t * 5) + 1)])
            if size >= 48 and t < 0.35:
                sprite.dot(column + 1, row, FIRE[min(6, int(t * 5) + 2)])
