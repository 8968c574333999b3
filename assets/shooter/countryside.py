"""The shooter's second background: a coast with woods, fields, a river, roads and villages, 480 x 540 px.

It is seamless. Like the sea (terrain.py) it has at most 60 % lightness and muted colours, so that bullets stand out
from it.
"""

import numpy as np

from assets.craft.fields import layered_noise, noise
from assets.craft.palette import mix, oklch, oklch_all
from assets.shooter.terrain import (
    FOAM,
    HEIGHT,
    MEADOW,
    ROCK,
    SAND,
    SEA,
    WET_SAND,
    WIDTH,
    border,
    glints,
    height_map,
    hill_light,
    pick,
    plant,
)

SHORE, BEACH, CRAGS = 0.36, 0.385, 0.80  # heights of the transitions between kinds of ground: mostly land
CROPS = oklch_all(
    (0.46, 0.058, 112), (0.50, 0.056, 98), (0.42, 0.062, 132), (0.47, 0.050, 86), (0.38, 0.055, 142), (0.44, 0.040, 70)
)
EARTH = oklch(0.45, 0.036, 72)
HEDGE = oklch(0.29, 0.046, 155)
RIVER = oklch_all((0.33, 0.055, 238), (0.38, 0.056, 230))
ROOF_LIT = oklch_all((0.54, 0.070, 42), (0.50, 0.030, 60), (0.50, 0.055, 30))
ROOF_DARK = oklch_all((0.38, 0.060, 32), (0.36, 0.026, 50), (0.35, 0.050, 20))
SHADOW = oklch(0.20, 0.03, 170)
LAND_CELLS = 70  # fields on the whole picture
VILLAGES = ((96, 150), (352, 64), (238, 402), (420, 300))  # [px] middles; those in water are omitted


def patchwork(count, seed):
    """Return (number, edge) of a seamless patchwork of `count` fields, two arrays (HEIGHT, WIDTH).

    number: index of the field at each pixel; edge: a measure of the distance from the nearest other field [px], 0 at
    the border; seed: seed of the random numbers.
    """
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    bend = (layered_noise(WIDTH, HEIGHT, 8, 9, 2, seed + 1) - 0.5) * 12
    nearest, second = np.full(x.shape, 1e9), np.full(x.shape, 1e9)
    number = np.zeros(x.shape, int)
    for i in range(count):
        middle_x, middle_y = random.random(2) * (WIDTH, HEIGHT)
        dx = abs((x + bend - middle_x + WIDTH / 2) % WIDTH - WIDTH / 2)
        dy = abs((y + bend - middle_y + HEIGHT / 2) % HEIGHT - HEIGHT / 2)
        distance = np.maximum(dx, dy) * 0.62 + (dx + dy) * 0.38  # nearly rectangles
        closer = distance < nearest
        second = np.where(closer, nearest, np.minimum(second, distance))
        number = np.where(closer, i, number)
        nearest = np.minimum(nearest, distance)
    return number, second - nearest


def countryside():
    """Return the picture of the coast, (HEIGHT, WIDTH, 3) uint8."""
    height = height_map(4100, 4200)
    light = hill_light(height)
    picture = pick(SEA, np.clip((height - 0.06) / (SHORE - 0.06), 0, 1) ** 2)
    glints(picture, height < SHORE - 0.03)
    land = height > SHORE
    meadow = pick(MEADOW, 0.60 + light * 0.5 - (height - BEACH) * 0.45)
    picture[land] = pick(SAND, 0.5 + light * 0.6)[land]
    green = height > BEACH + (noise(WIDTH, HEIGHT, 60, 68, 5) - 0.5) * 0.02
    picture[green] = meadow[green]
    picture[land & (height < SHORE + 0.006)] = WET_SAND
    rock = height > CRAGS + (noise(WIDTH, HEIGHT, 60, 68, 6) - 0.5) * 0.05
    flat = (height > BEACH + 0.025) & (height < 0.60) & (layered_noise(WIDTH, HEIGHT, 4, 5, 2, 88) > 0.47)
    _fields(picture, flat & ~rock, light)
    picture[rock] = pick(ROCK, 0.42 + light * 0.7)[rock]
    stream = abs(layered_noise(WIDTH, HEIGHT, 2, 3, 4, 93) - 0.5)
    river = land & (stream < 0.012) & ~rock
    road = land & green & (abs(layered_noise(WIDTH, HEIGHT, 3, 3, 2, 57) - 0.48) < 0.0042) & ~rock
    thick = layered_noise(WIDTH, HEIGHT, 9, 10, 3, 61)
    woods = green & ~rock & (thick > 0.47) & ~flat & (stream > 0.022)
    bank = land & (stream < 0.018)
    picture[road] = EARTH
    picture[bank & ~rock & ~flat] = mix(MEADOW[1], SEA[3], 0.3)
    picture[river] = RIVER[(noise(WIDTH, HEIGHT, 60, 135, 8) > 0.62).astype(int)][river]
    picture[np.roll(river, 1, 0) & ~river & land] = mix(SAND[0], MEADOW[2], 0.5)
    picture[road & river] = ROOF_DARK[1]  # bridges
    plant(picture, woods & ~road, 616)
    hedges = flat & (layered_noise(WIDTH, HEIGHT, 20, 22, 2, 71) > 0.60) & ~road & ~river
    plant(picture, hedges, 617, spacing=(8, 7))
    picture[border(land)] = FOAM
    surf = (height > SHORE - 0.022) & (height < SHORE - 0.016) & (noise(WIDTH, HEIGHT, 60, 68, 9) > 0.42)
    picture[surf] = FOAM
    _villages(picture, green & ~rock & ~river, road)
    return picture


def _fields(picture, where, light):
    """Draw fields into `picture` where `where`, (h, w) bool, is True.

    Each field has its own colour and furrows, and hedges separate the fields. light: result of hill_light(), which
    darkens fields on slopes that face away from the light.
    """
    number, edge = patchwork(LAND_CELLS, 301)
    random = np.random.default_rng(302)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    for i in range(LAND_CELLS):
        kind, way, width = (int(value) for value in random.integers(0, (len(CROPS), 4, 2)))
        mine = where & (number == i)
        along = (x, y, x + y, x - y)[way]
        furrow = along // (1 + width) % 3 == 0
        picture[mine] = CROPS[kind]
        picture[mine & furrow] = mix(CROPS[kind], EARTH, 0.22 if kind % 2 else 0.10)
        shade = mine & (light < -0.25)
        picture[shade] = mix(picture[shade], SHADOW, 0.16)
    inner = where & (edge < 2.4)
    picture[inner] = HEDGE
    lit = np.roll(inner, 1, 0) & where & ~inner
    picture[lit] = mix(picture[lit], SHADOW, 0.35)


def _villages(picture, where, road):
    """Draw groups of small houses into `picture`, each with a shadow and with a lit and a dark half of its roof.

    where: pixels on which houses may be drawn, (h, w) bool; pixels with a house become False. road: pixels of roads,
    (h, w) bool, where no house is drawn.
    """
    random = np.random.default_rng(731)
    for middle_x, middle_y in VILLAGES:
        for _ in range(16):
            dx, dy = random.normal(0, 20), random.normal(0, 17)
            x, y = int(middle_x + dx) % (WIDTH - 16) + 6, int(middle_y + dy) % (HEIGHT - 16) + 6
            wide, deep, kind = (int(value) for value in random.integers((5, 4, 0), (9, 7, 3)))
            spot = (slice(y - 2, y + deep + 3), slice(x - 2, x + wide + 3))
            if not where[spot].all() or road[spot].any():
                continue
            picture[y + 1 : y + deep + 2, x + 1 : x + wide + 2] = SHADOW
            picture[y : y + deep, x : x + wide] = ROOF_DARK[kind]
            if wide > deep:  # the ridge runs across
                picture[y : y + (deep + 1) // 2, x : x + wide] = ROOF_LIT[kind]
            else:
                picture[y : y + deep, x : x + (wide + 1) // 2] = ROOF_LIT[kind]
            picture[y, x + 1] = mix(ROOF_LIT[kind], SAND[2], 0.5)
            where[spot] = False
