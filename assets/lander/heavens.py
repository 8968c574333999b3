"""Background of the lander's moon: a polar night with aurora and a ringed planet, and ranges of ice. Seamless in x."""

import numpy as np

from assets.craft import png
from assets.craft.fields import BAYER, circle, dither, grid, layered_noise, length
from assets.craft.palette import graded, mix, oklch, oklch_all
from assets.craft.shading import opaque
from assets.platformer.skyline import BANDS, bank, mountains

WIDTH, HEIGHT = 480, 270  # [px]
SKY = (
    (0.150, 0.048, 278),
    (0.195, 0.068, 270),
    (0.265, 0.085, 258),
    (0.360, 0.090, 240),
    (0.480, 0.088, 215),
    (0.620, 0.085, 188),
    (0.760, 0.075, 160),
)
AURORA = oklch_all((0.44, 0.095, 200), (0.60, 0.125, 170), (0.80, 0.125, 155))
PLANET, RADIUS = (372, 62), 30  # [px] middle and size
RINGS = ((1.34, 1.62), (1.70, 1.86))  # of the planet's radius
FLAT, LEAN = 3.6, 0.26  # flattening of the rings, and their lean
DISC = oklch_all(
    (0.215, 0.060, 285),
    (0.29, 0.075, 300),
    (0.40, 0.095, 325),
    (0.53, 0.110, 350),
    (0.68, 0.105, 25),
    (0.83, 0.080, 65),
)
# A bank of cloud: puffs (along, above its foot, radius); banks: middle and size.
BANK = (
    (-44, 3, 8),
    (-32, 8, 12),
    (-17, 15, 16),
    (2, 19, 18),
    (19, 12, 15),
    (33, 7, 11),
    (46, 3, 8),
    (-4, 5, 12),
    (10, 4, 12),
)
BANKS = ((70, 1.25), (178, 0.8), (290, 1.4), (408, 1.0))
STARS = 170


def sky():
    """Return the picture of the night sky, (270, 480, 4) uint8."""
    x, y = grid(WIDTH, HEIGHT)
    level = y / HEIGHT
    steps = np.clip(np.floor(level * level**0.5 * BANDS + dither(HEIGHT, WIDTH) + 0.5), 0, BANDS - 1).astype(int)
    stops = oklch_all(*SKY).astype(float)
    place = np.arange(BANDS) / (BANDS - 1) * (len(stops) - 1)
    left = np.minimum(place.astype(int), len(stops) - 2)
    colours = stops[left] + (stops[left + 1] - stops[left]) * (place - left)[:, None]
    picture = np.floor(colours + 0.5).astype(np.uint8)[steps]
    _stars(picture)
    _aurora(picture)
    _planet(picture, x, y)
    return opaque(picture)


def _stars(picture):
    random = np.random.default_rng(5)
    for _ in range(STARS):
        u, v, bright = random.random(3)
        column, row = int(u * WIDTH), int(v * v * 170)
        share = 0.2 + 0.7 * bright * (1 - row / 180)
        picture[row, column] = mix(picture[row, column], (214, 236, 255), share)
        if bright > 0.94 and 0 < column < WIDTH - 1 and 0 < row < HEIGHT - 1:
            for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                picture[row + dy, column + dx] = mix(picture[row + dy, column + dx], (214, 236, 255), 0.3)


def _aurora(picture):
    """Draw the aurora into `picture`: two curtains of light, bright along the lower edge, with streaks that fade
    upwards.
    """
    y = np.mgrid[0:HEIGHT, 0:WIDTH][0] + 0.5
    grain = np.tile(BAYER, (HEIGHT // 4 + 1, WIDTH // 4 + 1))[:HEIGHT, :WIDTH]
    for hem, sway, tall, seed, strength in ((150, 60, 96, 61, 1.0), (108, 44, 66, 64, 0.7)):
        line = hem + sway * (layered_noise(WIDTH, 4, 3, 1, 2, seed)[0] - 0.5) * 2
        folds = layered_noise(WIDTH, 4, 40, 1, 2, seed + 1)[0]
        veil = layered_noise(WIDTH, 4, 6, 1, 2, seed + 2)[0]
        up = (line[None, :] - y) / (tall * (0.45 + 0.8 * folds[None, :]))
        light = np.clip(1 - up, 0, 1) * np.clip((line[None, :] - y) / 5 + 0.3, 0, 1)
        light = light * light * (0.25 + 0.95 * folds[None, :]) * np.clip(veil[None, :] * 2.6 - 0.75, 0, 1) * strength
        for limit, tone, share in ((0.10, 0, 0.22), (0.26, 0, 0.30), (0.42, 1, 0.32), (0.60, 1, 0.40), (0.80, 2, 0.45)):
            here = light + (grain - 0.5) * 0.16 > limit
            picture[here] = mix(picture[here], AURORA[tone], share)


def _planet(picture, x, y):
    """Draw the planet into `picture`: banded, lit from the left, with rings in front of it and behind it.

    x, y: positions of the pixel centres, as of fields.grid().
    """
    dx, dy = x - PLANET[0], y - PLANET[1]
    across, down = dx + LEAN * dy, (dy - LEAN * dx) * FLAT
    ring = length(across, down) / RADIUS
    disc = circle(x, y, *PLANET, RADIUS)
    grain = dither(HEIGHT, WIDTH)
    lit = -(dx * 0.75 + dy * 0.45) / RADIUS
    bands = layered_noise(WIDTH, HEIGHT, 5, 30, 2, 71)
    wave = np.floor((dy - LEAN * dx) / 5 + bands * 2.2) % 2
    level = 2.4 + lit * 3.1 + wave * 0.6 + grain * 0.9
    behind = (dy - LEAN * dx) < 0
    for front in (False, True):
        for inner, outer in RINGS:
            here = (ring > inner) & (ring < outer) & (behind != front) & ((disc > 0) | front)
            dark = (disc > -99) & (dx > 0) & (disc < 14) & ~front
            tone = np.where(dark[..., None], oklch(0.24, 0.05, 290), graded(DISC, 3.6 - dx / 34 + grain)[...])
            picture[here] = mix(picture[here], tone[here], 0.75)
        if not front:
            picture[disc < 0] = graded(DISC, level)[disc < 0]
            edge = (disc < 0) & (disc > -1.2) & (lit > 0.25)
            picture[edge] = oklch(0.93, 0.05, 80)


def heavens_files():
    """Return {path relative to assets/: bytes} of the pictures of all layers."""
    far = oklch_all((0.40, 0.070, 235), (0.455, 0.075, 225), (0.54, 0.078, 210), (0.64, 0.070, 190))
    far_snow = oklch_all((0.52, 0.072, 222), (0.66, 0.060, 200))
    mid = oklch_all((0.275, 0.066, 262), (0.325, 0.072, 254), (0.40, 0.078, 240), (0.50, 0.075, 222))
    mid_snow = oklch_all((0.47, 0.070, 245), (0.66, 0.055, 222))
    near = oklch_all((0.180, 0.050, 278), (0.212, 0.056, 274), (0.262, 0.062, 266), (0.335, 0.066, 256))
    storm = oklch_all((0.235, 0.046, 266), (0.290, 0.052, 258), (0.360, 0.055, 248), (0.450, 0.055, 236))
    puffs = [(x + dx * size, lift * size, radius * size) for x, size in BANKS for dx, lift, radius in BANK]
    return {
        "images/lander_clouds.png": png.encode(bank(WIDTH, 96, 155, 84, puffs, storm)),
        "images/lander_sky.png": png.encode(sky()),
        "images/lander_far.png": png.encode(mountains(150, 40, 132, 5, 121, far, far_snow, oklch(0.58, 0.080, 195))),
        "images/lander_mid.png": png.encode(mountains(130, 30, 112, 4, 133, mid, mid_snow, oklch(0.40, 0.080, 232))),
        "images/lander_near.png": png.encode(mountains(110, 24, 92, 6, 147, near, None, None)),
    }
