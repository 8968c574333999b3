"""The platformer's distance: a sky at dusk, three ranges of mountains and a bank of clouds, all seamless in x.

Far layers are lighter and paler, near ones dark and saturated, so that the tiles in front are easy to see.
"""

import numpy as np

from assets.craft.fields import circle, dither, grid, layered_noise, length
from assets.craft.palette import graded, mix, oklch, oklch_all
from assets.craft.shading import cut_out

WIDTH = 480  # [px] one screen; scenes repeat the layers
SKY_HEIGHT = 270
SKY = (
    (0.22, 0.075, 282),
    (0.30, 0.095, 290),
    (0.42, 0.115, 310),
    (0.56, 0.125, 350),
    (0.70, 0.125, 35),
    (0.82, 0.110, 65),
)
# Rows of firs, far to near: px below the crest, height of its tallest [px], (body, mist or light, lit edge)
FIR_ROWS = (
    (0, 30, ((0.285, 0.062, 292), (0.330, 0.072, 300), (0.400, 0.082, 318))),
    (13, 26, ((0.245, 0.054, 288), (0.280, 0.060, 293), (0.335, 0.066, 302))),
    (26, 24, ((0.205, 0.044, 286), (0.235, 0.050, 288), (0.280, 0.056, 292))),
    (38, 22, ((0.225, 0.045, 285), (0.225, 0.045, 285), (0.248, 0.048, 286))),
)
BANDS = 26  # colour bands of the sky, dithered into each other
SUN = (338, 196, 21)  # [px] x, y, radius


def sky():
    """Return the picture of the sky, (270, 480, 3) uint8: a gradient, stars, and a low sun with haze."""
    x, y = grid(WIDTH, SKY_HEIGHT)
    glow = np.clip(1 - length((x - SUN[0]) * 0.55, y - SUN[1]) / 130, 0, 1)
    level = y / SKY_HEIGHT * 0.92 + glow * glow * 0.17
    steps = np.clip(np.floor(level * BANDS + dither(SKY_HEIGHT, WIDTH) + 0.5), 0, BANDS - 1).astype(int)
    stops = oklch_all(*SKY).astype(float)
    colours = []
    for band in range(BANDS):
        place = band / (BANDS - 1) * (len(stops) - 1)
        left = min(int(place), len(stops) - 2)
        colours.append(stops[left] + (stops[left + 1] - stops[left]) * (place - left))
    picture = np.floor(np.array(colours) + 0.5).astype(np.uint8)[steps]
    _stars(picture)
    sun = circle(x, y, *SUN)
    picture[sun < 2.2] = oklch(0.86, 0.125, 70)
    picture[sun < 0] = oklch(0.94, 0.085, 88)
    return picture


def _stars(picture):
    random = np.random.default_rng(12)
    for _ in range(110):
        u, v, bright = random.random(3)
        column, row = int(u * WIDTH), int(v * v * 120)
        picture[row, column] = mix(picture[row, column], (225, 220, 255), 0.25 + 0.6 * bright * (1 - row / 130))
        if bright > 0.93 and 0 < column < WIDTH - 1 and row > 0:  # a few twinkle: a small cross
            for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                spot = picture[row + dy, column + dx]
                picture[row + dy, column + dx] = mix(spot, (225, 220, 255), 0.28)


def ridge_line(cells, octaves, seed, sharp):
    """Return the heights 0..1 of a ridge, one for each column, seamless in x.

    cells: number of cells of the noise along x; octaves: number of its layers; seed: seed of its random numbers; sharp:
    from 0 (rolling hills) to 1 (peaks).
    """
    rolling = layered_noise(WIDTH, 4, cells, 1, octaves, seed)[0]
    peaks = 1 - abs(layered_noise(WIDTH, 4, cells, 1, octaves, seed + 50)[0] * 2 - 1)
    line = rolling * (1 - sharp) + peaks * sharp
    return (line - line.min()) / (line.max() - line.min())


def mountains(height, low, high, cells, seed, tones, snow=None, haze=None):
    """Return the picture of one range of mountains, (height, 480, 4) uint8.

    low, high: height of the rock at the lowest and the highest point [px]; cells: number of cells of the ridge's noise
    along x; tones: colours (shade, body, light, edge); snow: two colours of the snow caps, or None for no snow; haze:
    colour into which the foot fades, or None for no haze; seed: seed of the random numbers.
    """
    line = ridge_line(cells, 6, seed, 0.75)
    top = height - (low + (high - low) * line)
    y, x = np.mgrid[0:height, 0:WIDTH]
    depth = y - top[None, :]
    solid = depth >= 0
    # Facets: a pixel is lit by the slope of the ridge up its diagonal, like strata that fall from a crest.
    smooth = sum(np.roll(line, k) for k in range(-3, 4)) / 7
    slope = np.roll(smooth, -2) - np.roll(smooth, 2)
    wobble = layered_noise(WIDTH, height, 30, max(2, height // 10), 3, seed + 7) - 0.5
    source = (x - np.floor(np.clip(depth, 0, 999) * 0.55 + wobble * 16).astype(int)) % WIDTH
    facing = slope[source] * 26 + wobble * 1.1
    grain = dither(height, WIDTH) * 0.5
    tone = np.where(facing + grain > 0.42, 2, np.where(facing + grain < -0.30, 0, 1))
    picture = np.asarray(tones)[tone]
    if snow is not None:
        cap = (depth < 9 + wobble * 26 + (line[None, :] - 0.62) * 46) & (line[None, :] > 0.5)
        picture = np.where(cap[..., None], np.asarray(snow)[(tone > 0).astype(int)], picture)
    if haze is not None:
        share = np.clip((y - height * 0.45) / (height * 0.55), 0, 1) + grain * 0.35
        for limit, strength in ((0.35, 0.25), (0.6, 0.5), (0.85, 0.72)):
            band = share > limit
            picture = np.where(band[..., None], mix(np.asarray(tones)[tone], haze, strength), picture)
    picture = np.where(((depth >= 0) & (depth < 1.2))[..., None], np.asarray(tones)[3], picture)
    return cut_out(picture, solid)


def pines(height, seed):
    """Return the picture of the nearest range, (height, 480, 4) uint8: wooded hills in four rows of firs.

    Each row is nearer and darker than the row before. seed: seed of the random numbers.
    """
    line = ridge_line(3, 4, seed, 0.2)
    out = np.zeros((height, WIDTH, 4), np.uint8)
    y = np.mgrid[0:height, 0:WIDTH][0]
    random = np.random.default_rng(seed)
    for row, (drop, tall, tones) in enumerate(FIR_ROWS):
        body, light, edge = oklch_all(*tones)
        # Every row's ground rolls by itself, so that the rows differ in outline.
        ground = height - (26 + 30 * np.roll(line, row * 61)) * (1 - 0.16 * row) + drop
        fog = (y - ground[None, :]) / 16 + dither(height, WIDTH) * 0.8  # mist between the rows, thinner down the hill
        hill = y >= ground[None, :]
        out[hill] = (*body, 255)
        if row < len(FIR_ROWS) - 1:
            out[hill & (fog > 0.55)] = (*light, 255)
        column = 0
        while column < WIDTH:
            gap, size, lean = random.random(3)
            _pine(
                out,
                column,
                int(ground[column % WIDTH]) + 3,
                int(tall * (0.55 + 0.75 * size * size)),
                (body, light, edge),
            )
            column += 4 + int(gap * gap * (20 - 3 * row)) + int(lean * 3)
    out[y + dither(height, WIDTH) * 8 > height - 9] = (*body, 255)  # a foot of one dark colour that scenes continue
    return out


def _pine(out, column, foot, size, tones):
    """Draw one fir into `out`: jagged tiers that widen downwards, lit along the left edge.

    column, foot: x and y of its foot [px]; size: its height [px]; tones: colours (body, light, edge).
    """
    body, light, edge = tones
    for i in range(size):
        row = foot - size + i
        if not 0 <= row < out.shape[0]:
            continue
        tier = i % 5
        half = int(i * 0.20 + tier * 0.55)
        for dx in range(-half, half + 1):
            tone = edge if dx == -half and i > 1 else light if dx < -half + 2 and tier > 1 else body
            out[row, (column + dx) % WIDTH] = (*tone, 255)


def bank(width, height, seed, base, puffs, tones):
    """Return the picture of a row of cumulus clouds with flat, fading bottoms, (height, width, 4) uint8, seamless in
    x.

    base: y of the bottoms [px]; puffs: round parts, ((x, height over the base, radius), ...) [px]; tones: four
    colours, dark to light; seed: seed of the random numbers.
    """
    y, x = np.mgrid[0:height, 0:width] + 0.5
    rough = layered_noise(width, height, max(2, width // 24), max(2, height // 24), 3, seed) - 0.5
    field = np.full((height, width), 1e9)
    for puff_x, lift, radius in puffs:
        dx = np.abs((x - puff_x + width / 2) % width - width / 2)
        dy = (y - (base - lift)) * np.where(y > base - lift, 1.5, 1.0)
        field = np.minimum(field, np.sqrt(dx * dx + dy * dy) - radius)
    field = field + rough * 7
    solid = (field < 0) & (y < base - np.abs(rough) * 14)
    height_map = np.sqrt(np.clip(-field, 0, 14)) * 3
    slope_y, slope_x = np.gradient(height_map)
    level = 1.5 + (slope_x * 0.55 + slope_y * 0.8) * 1.6 - (y - base + 20) / 22 + dither(height, width)
    return cut_out(graded(tones, level), solid)


def backdrop_layers():
    """Return {name: picture} of the layers of this module, far to near."""
    far = oklch_all((0.47, 0.085, 322), (0.53, 0.090, 335), (0.63, 0.095, 5), (0.72, 0.085, 30))
    mid = oklch_all((0.335, 0.080, 300), (0.375, 0.085, 306), (0.445, 0.095, 325), (0.53, 0.100, 345))
    snow = oklch_all((0.66, 0.060, 340), (0.83, 0.055, 40))
    tones = oklch_all((0.47, 0.090, 325), (0.58, 0.100, 350), (0.70, 0.100, 20), (0.80, 0.085, 50))
    puffs = (
        (40, 6, 15),
        (62, 12, 20),
        (86, 8, 17),
        (108, 3, 11),
        (22, 2, 9),
        (250, 4, 12),
        (268, 9, 16),
        (288, 4, 11),
        (390, 5, 13),
        (412, 12, 19),
        (436, 9, 17),
        (458, 3, 10),
    )
    return {
        "sky_dusk": sky(),
        "mountains_far": mountains(150, 34, 128, 5, 21, far, snow, oklch(0.70, 0.10, 25)),
        "mountains_mid": mountains(120, 30, 96, 4, 33, mid, None, oklch(0.50, 0.10, 340)),
        "mountains_near": pines(96, 44),
        "clouds": bank(WIDTH, 80, 5, 62, puffs, tones),
    }
