"""The shooter's first background: a sea with islands, seen from above, 480 x 540 px, seamless in both directions.

Everything has at most 60 % lightness and low chroma, so that bullets, planes and explosions stand out from it.
"""

import numpy as np

from assets.craft.fields import dither, layered_noise, length, noise
from assets.craft.palette import graded, oklch, oklch_all
from assets.craft.shading import shifted

WIDTH, HEIGHT = 480, 540  # [px]
SEA = oklch_all(
    (0.245, 0.046, 262),
    (0.268, 0.050, 258),
    (0.292, 0.054, 252),
    (0.325, 0.057, 243),
    (0.37, 0.058, 230),
    (0.43, 0.056, 212),
)  # deep to shallow
FOAM, WET_SAND = oklch(0.56, 0.030, 215), oklch(0.45, 0.040, 80)
SAND = oklch_all((0.49, 0.045, 75), (0.54, 0.050, 82), (0.58, 0.052, 86))
MEADOW = oklch_all(
    (0.305, 0.045, 160), (0.350, 0.055, 148), (0.395, 0.062, 138), (0.440, 0.066, 128), (0.485, 0.066, 118)
)
ROCK = oklch_all((0.29, 0.025, 285), (0.36, 0.026, 282), (0.43, 0.026, 275), (0.50, 0.024, 262), (0.57, 0.020, 240))
TREES = oklch_all((0.205, 0.032, 190), (0.265, 0.044, 165), (0.315, 0.052, 152), (0.375, 0.060, 140))

SHORE, BEACH, WOODS, CRAGS = 0.565, 0.592, 0.66, 0.765  # heights of the transitions between kinds of ground
GLINT_CUT = 0.80  # share of the water without glints


def height_map(seed=2024, ridge_seed=77):
    """Return the heights of a seamless landscape, (HEIGHT, WIDTH) of 0..1; about a quarter of them is above SHORE.

    seed, ridge_seed: seeds of the random numbers for the land and for its ridges.
    """
    rough = layered_noise(WIDTH, HEIGHT, 4, 4, 6, seed, 0.52)
    ridges = 1 - abs(layered_noise(WIDTH, HEIGHT, 3, 4, 4, ridge_seed) * 2 - 1)
    height = rough * 0.78 + ridges * 0.22
    low, high = height.min(), height.max()
    return (height - low) / (high - low)


def hill_light(height):
    """Return how directly each pixel of a landscape faces the light from the top left, (h, w) of -1..1.

    height: heights of the landscape, (h, w) of 0..1, as from height_map().
    """
    slope_x = np.roll(height, -1, 1) - np.roll(height, 1, 1)
    slope_y = np.roll(height, -1, 0) - np.roll(height, 1, 0)
    return np.clip((slope_x * 0.55 + slope_y * 0.8) * 28, -1, 1)


def border(land):
    """Return the pixels outside of the area `land` that touch it, (h, w) bool. The picture is periodic.

    land: pixels of the area, (h, w) bool.
    """
    around = np.zeros_like(land)
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        around |= np.roll(land, (dy, dx), (0, 1))
    return around & ~land


def pick(ramp, level, grain=0.8):
    """Return the dithered colour of each pixel, (h, w, 3) uint8, from its level.

    ramp: colours; level: position on the ramp, (h, w) of 0..1; grain: strength of the dither.
    """
    return graded(ramp, level * (len(ramp) - 1) + 0.5 + dither(*level.shape) * grain)


def ground():
    """Return the picture of the sea with islands, (HEIGHT, WIDTH, 3) uint8."""
    height = height_map()
    light = hill_light(height)
    picture = pick(SEA, np.clip((height - 0.12) / (SHORE - 0.12), 0, 1) ** 2)
    glints(picture, height < SHORE - 0.03)
    land = height > SHORE
    picture[border(land)] = FOAM
    surf = (height > SHORE - 0.022) & (height < SHORE - 0.016) & (noise(WIDTH, HEIGHT, 60, 68, 9) > 0.42)
    picture[surf] = FOAM
    sand = pick(SAND, 0.5 + light * 0.6)
    picture[land] = sand[land]
    picture[land & (height < SHORE + 0.006)] = WET_SAND
    meadow = pick(MEADOW, 0.62 + light * 0.55 - (height - BEACH) * 0.9)
    green = height > BEACH + (noise(WIDTH, HEIGHT, 60, 68, 5) - 0.5) * 0.02
    picture[green] = meadow[green]
    rock = pick(ROCK, 0.42 + light * 0.7)
    crags = height > CRAGS + (noise(WIDTH, HEIGHT, 60, 68, 6) - 0.5) * 0.05
    picture[crags] = rock[crags]
    thick = layered_noise(WIDTH, HEIGHT, 10, 11, 3, 61)
    plant(picture, (height >= WOODS - 0.06) & ~crags & (thick >= 0.46), 515)
    return picture


def glints(picture, water, seed=31, cut=GLINT_CUT):
    """Draw short horizontal wave crests in patches of the water into `picture`.

    water: pixels of the water, (h, w) bool; seed: seed of the random numbers; cut: level of noise 0..1 above which a
    crest is drawn.
    """
    crest = noise(WIDTH, HEIGHT, 40, 270, seed)
    group = layered_noise(WIDTH, HEIGHT, 8, 9, 2, seed + 10)
    glint = (crest > cut) & (group > 0.5) & water
    picture[glint] = np.minimum(picture[glint].astype(int) + (14, 17, 18), 255).astype(np.uint8)
    trough = np.roll(glint, 1, 0) & ~glint
    picture[trough] = (picture[trough] * 0.88).astype(np.uint8)


def plant(picture, where, seed, spacing=(5, 4)):
    """Draw tree crowns with their shadows into `picture`, back to front, one in each cell of a grid.

    Each crown has a random position in its cell. It is drawn if `where`, (h, w) bool, is True at this position.
    spacing: size of a cell along x and along y [px]; seed: seed of the random numbers.
    """
    random = np.random.default_rng(seed)
    across, down = spacing
    for row in range(0, HEIGHT, down):
        for column in range(0, WIDTH, across):
            jitter_x, jitter_y, size, lean = random.random(4)
            x = (column + int(jitter_x * across)) % WIDTH
            y = (row + int(jitter_y * down)) % HEIGHT
            if where[y, x]:
                _crown(picture, x, y, 1.7 + size * 1.5, lean)


def _crown(picture, x, y, radius, lean):
    """Draw one tree into `picture`: a lit disc with a shadow, which continues at the opposite edge of the picture.

    x, y: centre [px]; radius: radius of the crown [px]; lean: brightness of the crown, 0..1.
    """
    reach = int(radius) + 2
    columns = np.arange(x - reach, x + reach + 1)
    rows = np.arange(y - reach, y + reach + 1)
    dx, dy = np.meshgrid(columns - x, rows - y)
    disc = length(dx, dy) < radius
    shade = shifted(disc, 1, 2) & ~disc
    column_index, row_index = np.meshgrid(columns % WIDTH, rows % HEIGHT)
    picture[row_index[shade], column_index[shade]] = TREES[0]
    tone = np.clip(np.floor((-(dx * 0.5 + dy * 0.8) / radius) * 1.3 + 1.7 + lean * 0.8), 0, 3).astype(int)
    picture[row_index[disc], column_index[disc]] = TREES[tone[disc]]
