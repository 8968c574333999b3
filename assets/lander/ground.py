"""Picture of the lander's moon: rock made of boulders, snow under open sky, ice, and the wall behind holes."""

import numpy as np

from assets.craft import png
from assets.craft.fields import dither, layered_noise
from assets.craft.palette import graded, mix, oklch_all
from assets.craft.shading import SIDES, cut_out, shifted
from assets.lander.landscape import landscape

CELL = 256  # [px] period of the boulders' pattern
BOULDERS = 150
DEEPEST = 30  # [px] below the surface, from which rock has its darkest colour
LIGHT = (-0.50, -0.86)  # towards the light
ROCK = oklch_all(
    (0.178, 0.038, 284),
    (0.212, 0.045, 282),
    (0.256, 0.052, 279),
    (0.312, 0.057, 275),
    (0.372, 0.060, 268),
    (0.435, 0.056, 258),
    (0.540, 0.050, 245),
    (0.660, 0.042, 225),
)
ICE = oklch_all(
    (0.330, 0.070, 250),
    (0.400, 0.085, 242),
    (0.480, 0.095, 232),
    (0.570, 0.098, 222),
    (0.670, 0.092, 212),
    (0.770, 0.078, 205),
    (0.870, 0.052, 200),
    (0.950, 0.025, 195),
)
SNOW = oklch_all((0.58, 0.062, 268), (0.70, 0.055, 258), (0.82, 0.040, 248), (0.91, 0.025, 235), (0.97, 0.012, 220))
WALL = oklch_all(
    (0.112, 0.030, 286), (0.138, 0.037, 284), (0.166, 0.045, 279), (0.200, 0.054, 270), (0.244, 0.062, 254)
)
GEM = oklch_all((0.42, 0.080, 215), (0.60, 0.100, 200), (0.78, 0.090, 188), (0.93, 0.050, 185))
GEMS, CLUSTER = 62, 9  # clusters of crystals, and the extent of each [px]


def boulders(seed, count):
    """Return (edge, facing), two arrays (CELL, CELL), of a seamless pattern of `count` boulders.

    edge: distance from the nearest crack between boulders [px]; facing: how far the boulder's side at a pixel faces
    the light [px], negative for sides that face away; seed: seed of the random numbers.
    """
    random = np.random.default_rng(seed)
    middles = random.random((count, 2)) * CELL
    y, x = np.mgrid[0:CELL, 0:CELL] + 0.5
    nearest, second, facing = np.full(x.shape, 1e6), np.full(x.shape, 1e6), np.zeros(x.shape)
    for middle_x, middle_y in middles:
        dx = (x - middle_x + CELL / 2) % CELL - CELL / 2
        dy = ((y - middle_y + CELL / 2) % CELL - CELL / 2) * 1.35  # wider than high, like strata
        distance = np.sqrt(dx * dx + dy * dy)
        closer = distance < nearest
        second = np.where(closer, nearest, np.minimum(second, distance))
        facing = np.where(closer, dx * LIGHT[0] + dy * LIGHT[1], facing)
        nearest = np.minimum(nearest, distance)
    return second - nearest, facing


def tiled(pattern, height, width):
    """Return a pattern (CELL, CELL), repeated to an array (height, width)."""
    return np.tile(pattern, (height // CELL + 1, width // CELL + 1))[:height, :width]


def depths(solid):
    """Return the depth [px] of each solid pixel below the surface, up to DEEPEST; 0 for pixels that are not solid.

    solid: bool array (h, w); the result has the same shape.
    """
    depth, left = np.zeros(solid.shape, np.int16), solid.copy()
    for layer in range(DEEPEST):
        depth += left
        peeled = left.copy()
        for dx, dy in SIDES if layer % 3 else (*SIDES, (1, 1), (-1, 1)):
            moved = shifted(left, dx, dy)
            # Beyond the picture's edge the pixels of the edge are repeated.
            moved[:, 0 if dx > 0 else -1 if dx < 0 else slice(0, 0)] = True
            moved[0 if dy > 0 else -1 if dy < 0 else slice(0, 0)] = True
            peeled &= moved
        left = peeled
    return depth


def facings(solid, reach=4):
    """Return (light, up), two arrays -1..1: how directly the ground at each pixel faces the light, and faces upwards.

    They are computed from the slope of `solid` (h, w) bool, blurred by `reach` px.
    """
    total = np.zeros(solid.shape, np.int32)
    for axis in (1, 0):
        source = solid.astype(np.int32) if axis else total
        padded = np.pad(source, [(reach, reach) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        sums = np.cumsum(padded, axis=axis)
        sums = np.concatenate([np.zeros_like(np.take(sums, [0], axis)), sums], axis=axis)
        size, span = solid.shape[axis], 2 * reach + 1
        total = np.take(sums, np.arange(span, span + size), axis) - np.take(sums, np.arange(size), axis)
    slope_y, slope_x = np.gradient(total.astype(float))
    size = np.sqrt(slope_x * slope_x + slope_y * slope_y) + 1e-6
    return -(slope_x * LIGHT[0] + slope_y * LIGHT[1]) / size, slope_y / size


def painted(moon):
    """Return the picture of the moon's ground, (height, width, 4) uint8. moon: Landscape."""
    solid = moon.solid
    height, width = solid.shape
    depth = depths(solid)
    light, up = facings(solid)
    edge, boulder = (tiled(pattern, height, width) for pattern in boulders(31, BOULDERS))
    rough = layered_noise(width, height, 96, 24, 3, 320) - 0.5
    grain = dither(height, width)
    near = np.clip(1 - (depth - 1) / 18, 0, 1)  # 1 at the surface
    level = 1.7 + 2.2 * near + 2.2 * near * near * light + rough * 2.4 + grain * 0.8
    level += np.clip(boulder * 0.075, -0.8, 0.8) * (0.45 + 0.55 * near)
    level -= (edge < 1.4) * (0.9 + 0.9 * near)
    level += ((edge >= 1.4) & (edge < 2.6) & (boulder > 2)) * 0.75 * (0.3 + near)
    picture = graded(ROCK, level)
    frozen = 2.6 + 1.6 * near + 1.8 * near * light + rough * 2.0 + grain * 0.7
    frozen += np.abs(((edge * 0.9 + boulder * 0.35) % 9) - 4.5) * 0.36 - (edge < 1.2) * 1.6
    picture[moon.ice] = graded(ICE, frozen)[moon.ice]
    _gems(picture, moon, depth)
    _edges(picture, moon, depth, light)
    _snow(picture, moon, up, light)
    return cut_out(picture, solid)


def _edges(picture, moon, depth, light):
    """Draw the outermost pixels of the moon's ground into `picture`: bright towards the light, dark on the other side.

    moon: Landscape; depth: result of depths(); light: first result of facings().
    """
    rim = moon.solid & (depth == 1)
    ramp = np.where(moon.ice[..., None], ICE[7], ROCK[6])
    picture[rim & (light > 0.15)] = ramp[rim & (light > 0.15)]
    dark = rim & (light < -0.35)
    picture[dark] = ROCK[1]
    second = moon.solid & (depth == 2) & (light > 0.35) & ~moon.ice
    picture[second] = mix(picture[second], ROCK[5], 0.6)


def _snow(picture, moon, up, light):
    """Draw snow into `picture` on all ground under open sky that is not too steep.

    moon: Landscape; up, light: results of facings().
    """
    height, width = moon.solid.shape
    top = np.argmax(moon.solid, axis=0)  # first solid row of each column
    y = np.mgrid[0:height, 0:width][0]
    drift = layered_noise(width, 4, 260, 1, 3, 410)[0]
    deep = (1.5 + 8.5 * drift * drift) * np.clip((up - 0.42) / 0.4, 0, 1)
    below = y - top[None, :]
    snow = moon.solid & (below >= 0) & (below < deep)
    share = below / np.maximum(deep, 1)
    level = 4.6 - 3.4 * share + light * 0.9 + dither(height, width) * 0.9
    picture[snow] = graded(SNOW, level)[snow]
    # Its shadow on the rock below.
    shade = moon.solid & ~snow & shifted(snow, 0, 1)
    picture[shade] = ROCK[1]


def _gems(picture, moon, depth):
    """Draw crystals into `picture`, in the walls of the moon's caves. moon: Landscape; depth: result of depths()."""
    random = np.random.default_rng(77)
    cave = moon.massif & ~moon.solid
    near = cave.copy()
    for _ in range(3):
        for dx, dy in ((6, 0), (-6, 0), (0, 6), (0, -6)):
            near |= shifted(near, dx, dy)
    places = np.argwhere(near & moon.solid & ~moon.ice & (depth > 3) & (depth < 12))
    for row, column in places[np.sort(random.choice(len(places), GEMS, replace=False))]:
        for size in range(int(random.integers(1, 5)), 0, -1):
            _gem(
                picture,
                moon.solid,
                row + random.integers(-CLUSTER, CLUSTER),
                column + random.integers(-CLUSTER, CLUSTER),
                size,
            )


def _gem(picture, solid, row, column, size):
    """Draw one cut crystal around (column, row) into `picture`, lit from the upper left, only where `solid` is True.

    size: extent of the crystal from its centre [px].
    """
    height, width = solid.shape
    for dy in range(-size - 1, size + 2):
        half = size - abs(dy) * size // (size + 1) - (abs(dy) == size + 1)
        for dx in range(-half, half + 1):
            if 0 <= row + dy < height and 0 <= column + dx < width and solid[row + dy, column + dx]:
                tone = 3 if (dx < 0 and dy == -1) else 2 if dx <= 0 and dy <= 0 else 1 if dy <= 0 or dx < 0 else 0
                picture[row + dy, column + dx] = GEM[tone]


def wall(moon):
    """Return the picture of the rock face that is visible where ground was removed, (height, width, 4) uint8.

    It has similar boulders as the ground, but darker. moon: Landscape.
    """
    height, width = moon.solid.shape
    edge, boulder = (tiled(pattern, height, width) for pattern in boulders(57, 60))
    rough = layered_noise(width, height, 32, 8, 3, 520) - 0.5
    hollow = moon.massif & ~moon.solid
    open_ = depths(hollow) / DEEPEST  # farther from the rock there is mist
    level = 1.0 + np.clip(boulder * 0.05, -0.8, 0.8) - (edge < 2.2) * 0.8 + rough * 2.2 + dither(height, width) * 0.7
    level += 2.0 * open_ * (0.75 + rough)
    return cut_out(graded(WALL, level), moon.massif)


def ground_files():
    """Return {path relative to assets/: bytes} of the pictures of the ground and of the wall behind it."""
    moon = landscape()
    return {"images/lander_ground.png": png.encode(painted(moon)), "images/lander_wall.png": png.encode(wall(moon))}
