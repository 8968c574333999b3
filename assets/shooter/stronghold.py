"""The shooter's last background: a fortress of concrete and steel on black rocks in a night sea, 480 x 540 px.

It is seamless, and darker than the other backgrounds, so that the boss's bullets are more visible. Landing pads,
buildings and tanks are placed at random on the paving, with a fixed seed.
"""

import numpy as np

from assets.craft.fields import layered_noise, length, noise
from assets.craft.palette import mix, oklch, oklch_all
from assets.shooter.terrain import HEIGHT, WIDTH, border, glints, height_map, hill_light, pick

NIGHT = oklch_all(
    (0.165, 0.036, 285), (0.188, 0.040, 280), (0.212, 0.044, 275), (0.245, 0.046, 268), (0.29, 0.046, 258)
)
FOAM = oklch(0.44, 0.030, 255)
CLIFF = oklch_all((0.175, 0.020, 292), (0.225, 0.022, 290), (0.28, 0.024, 285), (0.34, 0.026, 278), (0.41, 0.026, 268))
PAVING = oklch_all((0.265, 0.026, 288), (0.305, 0.026, 284), (0.33, 0.026, 280))
WALL_TOP = oklch(0.43, 0.018, 272)
WALL_LIT = oklch(0.52, 0.018, 265)
WALL_SIDE = oklch(0.22, 0.018, 288)
ROOF = oklch_all((0.36, 0.022, 275), (0.33, 0.040, 25), (0.34, 0.030, 200))
SHADOW = oklch(0.14, 0.025, 290)
LAMP = oklch(0.58, 0.080, 75)
GLOW = oklch(0.46, 0.075, 60)
PAINT = oklch(0.50, 0.060, 85)
SHORE = 0.545  # height at which the rocks rise from the water
YARD = 0.035  # height of the paving above the shore
GRID = 24  # [px] grid of the yard's corners; its slabs lie on half of it
PADS, TANKS, BLOCKS = 9, 26, 90  # number of attempts for each; those without free paving are omitted


def stronghold():
    """Return the picture of the fortress on its rocks, (HEIGHT, WIDTH, 3) uint8."""
    height = height_map(6150, 6250)
    light = hill_light(height)
    picture = pick(NIGHT, np.clip((height - 0.10) / (SHORE - 0.10), 0, 1) ** 1.5)
    glints(picture, height < SHORE - 0.02, 61, 0.74)
    land = height > SHORE
    picture[land] = pick(CLIFF, 0.40 + light * 0.75)[land]
    picture[border(land)] = FOAM
    surf = (height > SHORE - 0.034) & (height < SHORE - 0.026) & (noise(WIDTH, HEIGHT, 60, 68, 19) > 0.46)
    picture[surf] = mix(FOAM, NIGHT[3], 0.45)
    paved = _paving(picture, height)
    for half in range(2):  # twice, shifted by half a picture between, so that buildings cross the seams, too
        _build(picture, paved, np.random.default_rng(640 + half))
        picture = np.roll(picture, (HEIGHT // 2, WIDTH // 2), (0, 1))
        paved = np.roll(paved, (HEIGHT // 2, WIDTH // 2), (0, 1))
    return picture


def _build(picture, paved, random):
    """Draw landing pads, buildings and tanks into `picture` at random positions on a grid of 6 px.

    paved: the paved pixels without a building, (h, w) bool; drawn buildings are removed from it. random: generator of
    random numbers.
    """

    def place(margin):
        x, y = random.integers(0, ((WIDTH - margin) // 6, (HEIGHT - margin) // 6))
        return int(x) * 6, int(y) * 6

    for _ in range(PADS):
        x, y = place(60)
        _pad(picture, paved, x + 28, y + 28, 18 + int(random.integers(2)) * 4)
    for _ in range(BLOCKS):
        left, top = place(64)
        wide, deep, high, roof = (int(value) for value in random.integers((4, 3, 5, 0), (9, 7, 9, 4)))
        _block(picture, paved, left, top, wide * 6 - 2, deep * 6 - 4, high, roof % 3)
    for _ in range(TANKS):
        x, y = place(40)
        _tank(picture, paved, x + 15, y + 15, 8 + int(random.integers(4)))


def _paving(picture, height):
    """Draw paving on the higher land, and around it a wall with lamps, into `picture`. Return the paved pixels, (h, w)
    bool.

    height: heights of the land, as from height_map().
    """
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    # The yard's edge follows a grid, like a real building's.
    coarse = height[(y // GRID * GRID + GRID // 2) % HEIGHT, (x // GRID * GRID + GRID // 2) % WIDTH]
    paved = coarse > SHORE + YARD
    wear = layered_noise(WIDTH, HEIGHT, 8, 9, 3, 6160) - 0.5
    slabs = pick(PAVING, 0.5 + wear * 1.3)
    picture[paved] = slabs[paved]
    slab = GRID // 2
    picture[paved & ((x % slab == 0) | (y % slab == 0))] = mix(PAVING[0], SHADOW, 0.35)
    picture[paved & ((x % slab == 1) & (y % slab == 1))] = PAVING[2]
    stained = paved & (layered_noise(WIDTH, HEIGHT, 20, 22, 2, 6170) > 0.66)
    picture[stained] = mix(picture[stained], SHADOW, 0.28)
    grown = paved.copy()
    for _ in range(4):
        grown |= border(grown)
    rampart = grown & ~paved
    picture[rampart] = WALL_TOP
    picture[border(paved)] = WALL_LIT
    merlon = border(np.roll(grown, (1, 1), (0, 1)) & grown) & grown & ((x + y) // 4 % 2 == 0)
    picture[merlon & rampart] = WALL_SIDE
    fall = (np.roll(grown, 4, 0) | np.roll(grown, 2, 0)) & ~grown
    picture[fall] = WALL_SIDE
    picture[np.roll(grown, 1, 0) & ~grown] = mix(WALL_SIDE, WALL_TOP, 0.4)
    cast = np.roll(grown, (8, 4), (0, 1)) & ~grown & ~fall
    picture[cast] = mix(picture[cast], SHADOW, 0.5)
    lamps = rampart & (x % (2 * GRID) == GRID // 2) & (y % GRID == GRID // 2)
    lamps |= border(paved) & (x % (2 * GRID) == GRID // 2)
    for row, column in zip(*np.nonzero(lamps), strict=True):
        _lamp(picture, column, row)
    return paved


def _lamp(picture, x, y):
    """Draw a small lamp at the pixel (x, y), and the light around it, into `picture`."""
    rows, columns = np.mgrid[y - 4 : y + 5, x - 4 : x + 5]
    near = length(columns - x, rows - y)
    for reach, share in ((4.2, 0.16), (2.4, 0.34)):
        lit = near < reach
        spot = (rows[lit] % HEIGHT, columns[lit] % WIDTH)
        picture[spot] = mix(picture[spot], GLOW, share)
    picture[y % HEIGHT, x % WIDTH] = LAMP


def _free(paved, left, top, width, depth):
    """Return whether all pixels of a rectangle are paved. The picture is periodic in both directions.

    paved: the paved pixels, (h, w) bool; left, top, width, depth: the rectangle [px].
    """
    rows = np.arange(top, top + depth) % HEIGHT
    columns = np.arange(left, left + width) % WIDTH
    return bool(paved[np.ix_(rows, columns)].all())


def _block(picture, paved, left, top, width, depth, high, roof):
    """Draw a building, seen from above and slightly from the south: roof, lit rim, side with lit windows, shadow.

    If a pixel in its area is not `paved`, nothing is drawn. Otherwise the building's pixels in `paved` become False.
    left, top, width, depth: rectangle of the roof [px]; high: height of the visible side [px]; roof: index into ROOF.
    """
    if not _free(paved, left - 1, top - 1, width + 4, depth + high + 3):
        return
    shade = (slice(top + 5, top + depth + high + 3), slice(left + 3, left + width + 4))
    picture[shade] = mix(picture[shade], SHADOW, 0.6)
    picture[top + depth : top + depth + high, left : left + width] = WALL_SIDE
    picture[top : top + depth, left : left + width] = ROOF[roof]
    picture[top, left : left + width] = WALL_LIT
    picture[top : top + depth, left] = WALL_LIT
    picture[top + depth - 1, left : left + width] = mix(ROOF[roof], WALL_LIT, 0.4)
    picture[top : top + depth, left + width - 1] = mix(ROOF[roof], SHADOW, 0.5)
    for column in range(left + 3, left + width - 3, 5):  # windows, most of them dark
        lit = (column // 5 * 7 + top * 3) % 11 < 5
        picture[top + depth + 2 : top + depth + 4, column : column + 2] = GLOW if lit else SHADOW
    for row in range(top + 4, top + depth - 6, 8):  # hatches on roofs, with their shadows
        for column in range(left + 4, left + width - 6, 10):
            picture[row + 1 : row + 5, column + 1 : column + 6] = mix(ROOF[roof], SHADOW, 0.55)
            picture[row : row + 4, column : column + 5] = mix(ROOF[roof], WALL_TOP, 0.7)
            picture[row, column : column + 5] = WALL_LIT
    paved[top : top + depth + high, left : left + width] = False


def _tank(picture, paved, x, y, radius):
    """Draw a round fuel tank with a lit cap around (x, y) if all pixels in its area are `paved`.

    The tank's pixels in `paved` then become False. radius: radius of the tank [px].
    """
    if not _free(paved, x - radius - 1, y - radius - 1, 2 * radius + 5, 2 * radius + 7):
        return
    rows, columns = np.mgrid[y - radius - 1 : y + radius + 8, x - radius - 1 : x + radius + 6]
    for dx, dy, size, tone in (
        (3, 5, radius, None),
        (0, 3, radius, WALL_SIDE),
        (0, 0, radius, WALL_TOP),
        (0.6, 0.6, radius - 1.2, ROOF[0]),
        (0.2, 0.2, radius * 0.45, WALL_TOP),
        (0.6, 0.8, radius * 0.38, ROOF[2]),
    ):
        disc = length(columns - x - dx, rows - y - dy) < size
        spot = (rows[disc], columns[disc])
        picture[spot] = mix(picture[spot], SHADOW, 0.6) if tone is None else tone
    rim = (abs(length(columns - x, rows - y) - radius + 0.6) < 0.7) & (columns + rows < x + y)
    picture[rows[rim], columns[rim]] = WALL_LIT
    paved[y - radius : y + radius + 4, x - radius : x + radius + 2] = False


def _pad(picture, paved, x, y, radius):
    """Draw a landing pad with a painted ring, an H, and lamps at its rim if all pixels in its area are `paved`.

    The pad's pixels in `paved` then become False. x, y: centre [px]; radius: half of the pad's width [px].
    """
    if not _free(paved, x - radius, y - radius, 2 * radius, 2 * radius):
        return
    rows, columns = np.mgrid[y - radius : y + radius, x - radius : x + radius]
    distance = length(columns - x + 0.5, rows - y + 0.5)
    disc = distance < radius - 0.5
    picture[rows[disc], columns[disc]] = mix(PAVING[0], SHADOW, 0.25)
    ring = abs(distance - radius + 3.4) < 1.0
    picture[rows[ring], columns[ring]] = mix(PAINT, PAVING[0], 0.35)
    arm = (abs(abs(columns - x + 0.5) - radius * 0.26) < 1.4) & (abs(rows - y + 0.5) < radius * 0.42)
    arm |= (abs(rows - y + 0.5) < 1.4) & (abs(columns - x + 0.5) < radius * 0.26)
    picture[rows[arm], columns[arm]] = mix(PAINT, PAVING[0], 0.35)
    for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        _lamp(picture, x + dx * (radius - 2), y + dy * (radius - 2))
    paved[y - radius : y + radius, x - radius : x + radius] = False
