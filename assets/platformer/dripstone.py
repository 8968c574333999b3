"""The background of the platformer's cave: a far wall with faint crystals, and near pillars of dripstone.

Both are 480 x 270 px and seamless in x. The far wall is opaque; the near layer is clear between its pillars.
"""

import numpy as np

from assets.craft.fields import dither, layered_noise, length, noise
from assets.craft.palette import graded, mix, oklch_all
from assets.craft.shading import cut_out

WIDTH, HEIGHT = 480, 270  # [px]
FAR = oklch_all((0.215, 0.040, 292), (0.250, 0.048, 286), (0.290, 0.056, 276), (0.335, 0.060, 262), (0.385, 0.060, 245))
HAZE = oklch_all((0.335, 0.062, 250), (0.40, 0.068, 225), (0.47, 0.068, 205))
NEAR = oklch_all((0.130, 0.030, 292), (0.165, 0.034, 288), (0.210, 0.040, 280), (0.290, 0.048, 262))
CRYSTAL = oklch_all((0.42, 0.080, 215), (0.56, 0.095, 200), (0.72, 0.085, 190))
# Crystal clusters on the far wall: x, y, size, all px
CLUSTERS = ((70, 206, 15), (212, 70, 11), (330, 190, 18), (436, 96, 12), (146, 150, 8))
# Hanging and standing stone of the near layer: x, half width at the root, length, whether it hangs; px
SPIKES = (
    (18, 16, 86, True),
    (52, 9, 44, True),
    (84, 7, 30, True),
    (132, 20, 118, True),
    (170, 8, 38, True),
    (222, 12, 66, True),
    (262, 7, 26, True),
    (304, 17, 98, True),
    (346, 9, 48, True),
    (398, 13, 72, True),
    (446, 8, 34, True),
    (36, 18, 60, False),
    (96, 10, 34, False),
    (138, 24, 74, False),
    (206, 12, 40, False),
    (250, 20, 56, False),
    (318, 11, 36, False),
    (366, 22, 68, False),
    (424, 13, 44, False),
    (466, 9, 26, False),
)


def far_wall():
    """Return the picture of the cave's far wall, (270, 480, 3) uint8: layers of rock, hollows with blue haze, dim
    crystals.
    """
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    rough = layered_noise(WIDTH, HEIGHT, 6, 4, 5, 810, 0.55)
    slope_y = np.roll(rough, -2, 0) - np.roll(rough, 2, 0)
    slope_x = np.roll(rough, -2, 1) - np.roll(rough, 2, 1)
    light = np.clip((slope_x * 0.55 + slope_y * 0.8) * 11, -1, 1)
    strata = np.floor((y + rough * 60) / 13) % 3 == 0
    level = 1.7 + light * 1.7 - strata * 0.5 + dither(HEIGHT, WIDTH) * 0.8
    picture = graded(FAR, level)
    hollow = layered_noise(WIDTH, HEIGHT, 4, 3, 3, 860) - abs(y - HEIGHT * 0.52) / HEIGHT * 0.55
    deep = (hollow - 0.42) * 12 + dither(HEIGHT, WIDTH) * 0.9
    for i, tone in enumerate(HAZE):
        picture[deep > i * 0.9 + 0.3] = tone
    edge = (deep > 0.3) & (np.roll(deep, 2, 0) <= 0.3)
    picture[edge] = FAR[0]
    for cluster_x, cluster_y, size in CLUSTERS:
        _cluster(picture, cluster_x, cluster_y, size)
    return picture


def _cluster(picture, middle_x, middle_y, size):
    """Draw a few crystals in a fan around (middle_x, middle_y) into `picture`, and their light on the wall.

    size: length of the crystals [px].
    """
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    dx = (x - middle_x + WIDTH / 2) % WIDTH - WIDTH / 2
    dy = y - middle_y
    glow = 1 - length(dx, dy + size * 0.3) / (size * 2.2) + dither(HEIGHT, WIDTH) * 0.22
    for limit, share in ((0.15, 0.16), (0.45, 0.18), (0.7, 0.2)):
        picture[glow > limit] = mix(picture[glow > limit], CRYSTAL[0], share)
    for lean, reach, thick in (
        (-0.9, 0.62, 0.20),
        (0.85, 0.70, 0.20),
        (-0.42, 0.9, 0.22),
        (0.4, 0.82, 0.22),
        (0, 1.1, 0.26),
    ):
        along = -dy / (size * reach)  # 0 at the foot, 1 at the tip
        across = dx - lean * size * reach * np.clip(along, 0, 1)
        half = size * thick * np.minimum(1, (1 - along) * 3.2)
        body = (along > -0.05) & (along < 1) & (abs(across) < half)
        picture[body] = CRYSTAL[1]
        picture[body & (across < -half * 0.25)] = CRYSTAL[2]
        picture[body & (across > half * 0.45)] = CRYSTAL[0]


def near_pillars():
    """Return the picture of pillars of dripstone in front of the far wall, (270, 480, 4) uint8.

    The picture also has a ceiling and a floor of rock.
    """
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    wobble = (noise(WIDTH, HEIGHT, 60, 68, 870) - 0.5) * 3.4
    roof = 15 + (layered_noise(WIDTH, 4, 8, 1, 3, 880)[0] - 0.5) * 24
    floor = HEIGHT - 17 - (layered_noise(WIDTH, 4, 7, 1, 3, 890)[0] - 0.5) * 26
    solid = (y < roof[None, :] + wobble) | (y > floor[None, :] + wobble)
    facing = np.zeros(x.shape)
    for spike_x, half, reach, hangs in SPIKES:
        dx = (x - spike_x + WIDTH / 2) % WIDTH - WIDTH / 2
        root = roof[spike_x] - 6 if hangs else floor[spike_x] + 6
        along = (y - root) / reach if hangs else (root - y) / reach
        taper = np.clip(1 - along, 0, 1)
        width = half * (0.30 * taper + 0.70 * taper * taper * taper) + 0.9 * taper + wobble * 0.3 * (taper > 0.05)
        body = (along > -0.3) & (along < 1) & (abs(dx) < width)
        solid |= body
        facing = np.where(body, -dx / np.maximum(width, 1), facing)
    level = 1.15 + facing * 1.05 + (noise(WIDTH, HEIGHT, 40, 90, 895) - 0.5) * 0.9 + dither(HEIGHT, WIDTH) * 0.6
    picture = graded(NEAR[:3], level)
    rim = solid & ~(np.roll(solid, 1, 1) & np.roll(solid, (1, 1), (0, 1)))
    rim[0] = False
    picture[rim] = NEAR[3]
    return cut_out(picture, solid)


def cave_layers():
    """Return {name: picture} of the two background layers of the cave: the far wall and the near pillars."""
    return {"cave_far": far_wall(), "cave_near": near_pillars()}
