"""The ground of lab/carving: hills, a bridge, a rock on a thin neck, an overhang; and the wall behind them."""

import numpy as np

from assets.craft import png
from assets.craft.fields import box, capsule, circle, dither, ellipse, grid, layered_noise, polygon
from assets.craft.palette import OUTLINE, RAMPS, graded, mix
from assets.craft.shading import SIDES, cut_out, shifted
from assets.lander.ground import boulders

SIZE = (480, 240)  # [px]; the top lies 24 px below the canvas' own
SEED = 21
DEEPEST = 26  # [px] below the surface, from which earth has its darkest colour
TURF = 4  # [px] of grass under open sky
HILLS = ((0, 130), (54, 127), (92, 132), (120, 140), (134, 190), (156, 204), (214, 208), (236, 196), (252, 184))
HILLS += ((300, 184), (330, 198), (352, 196), (372, 176), (392, 118), (480, 112), (480, 250), (0, 250))


def solid():
    """Return a bool array (240, 480) that is True for the pixels of earth."""
    x, y = grid(*SIZE)
    field = polygon(x, y, HILLS)
    bridge = np.minimum(box(x, y, 112, 136, 232, 149, 3.0), box(x, y, 222, 136, 238, 204, 2.0))
    neck = np.minimum(capsule(x, y, (282, 190), (279, 118), 9.0, 6.0), ellipse(x, y, 278, 96, 44, 20))
    cliff = np.minimum(box(x, y, 346, 108, 420, 132, 8.0), polygon(x, y, ((372, 120), (420, 110), (420, 176))))
    field = np.minimum(np.minimum(field, bridge), np.minimum(neck, cliff))
    for hollow in (
        circle(x, y, 62, 182, 21),
        capsule(x, y, (62, 188), (118, 196), 12.0),
        ellipse(x, y, 446, 186, 26, 17),
    ):
        field = np.maximum(field, -hollow)
    rough = layered_noise(*SIZE, 30, 15, 3, SEED) - 0.5
    return (field + rough * 5.0) < 0.0


def depth_of(earth):
    """Return the distance of each pixel of earth from the nearest pixel without earth [px], up to DEEPEST.

    earth: bool array (h, w); the result has the same shape. Beyond the picture, the pixels of its edge are repeated.
    """
    left, found = np.pad(earth, 1, mode="edge"), np.zeros(earth.shape, int)
    for _ in range(DEEPEST):
        found += left[1:-1, 1:-1]
        grown = left.copy()
        for dx, dy in SIDES:
            grown &= np.roll(left, (dy, dx), (0, 1))
        left = np.pad(grown[1:-1, 1:-1], 1, mode="edge")
    return found


def painted():
    """Return two pictures (h, w, 4) uint8: the earth, and the wall behind it."""
    earth = solid()
    height, width = earth.shape
    edge, facing = (np.tile(each, (1, 2))[:height, :width] for each in boulders(SEED, 190))
    share = depth_of(earth) / DEEPEST
    light = 0.62 - 0.34 * share + np.clip(facing * 0.018, -0.13, 0.13)
    light -= np.where(edge < 1.3, 0.16, 0.0)
    light += (layered_noise(width, height, 60, 30, 2, SEED + 3) - 0.5) * 0.22
    level = light * 5 + 0.5 + dither(height, width) * 0.5
    rgb = graded(RAMPS["dirt"], level)
    stone = layered_noise(width, height, 12, 6, 3, SEED + 7) + 0.22 * share > 0.60
    rgb[stone] = graded(RAMPS["stone"], level * 0.9)[stone]
    _grow_turf(rgb, earth)
    dark = earth & ~(shifted(earth, 0, -1) & shifted(earth, -1, 0))
    rgb[dark] = mix(rgb[dark], OUTLINE, 0.6)
    wall = mix(graded(RAMPS["dirt"], level * 0.4 + 0.2), OUTLINE, 0.45)
    return cut_out(rgb, earth), cut_out(wall, earth)


def _grow_turf(rgb, earth):
    """Draw grass with blades of several lengths into the picture `rgb`, on earth under open sky. earth: (h, w) bool."""
    height, width = earth.shape
    open_above = np.logical_and.accumulate(~earth, axis=0)
    top = np.argmax(~open_above, axis=0)
    blades = np.random.default_rng(SEED).integers(0, 3, width)
    for column in range(width):
        for down in range(TURF + int(blades[column])):
            y = top[column] + down
            if y < height and earth[y, column]:
                rgb[y, column] = RAMPS["grass"][4 if down == 0 else 3 if down < 3 else 2]


def earth_files():
    """Return {path relative to assets/: bytes} of the pictures of the earth and of the wall behind it."""
    earth, wall = painted()
    return {"images/lab_earth.png": png.encode(earth), "images/lab_earth_wall.png": png.encode(wall)}
