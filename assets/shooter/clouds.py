"""Clouds above the shooter's backgrounds, and their shadows: seamless noise above a threshold, in four tones."""

import numpy as np

from assets.craft.fields import dither, layered_noise
from assets.craft.palette import graded, oklch_all

# Colours of a cloud from its shade to its light.
HIGH = oklch_all((0.52, 0.040, 262), (0.60, 0.034, 255), (0.68, 0.026, 245), (0.75, 0.018, 235))
STORM = oklch_all((0.20, 0.030, 285), (0.26, 0.032, 280), (0.32, 0.030, 272), (0.39, 0.026, 262))


def cover(width, height, cells_x, cells_y, seed, threshold):
    """Return (thickness, solid) of a seamless field of clouds, two arrays (height, width) of float and bool.

    solid is True at pixels with clouds, where the thickness is above 0. cells_x, cells_y: numbers of cells of the
    noise; threshold: 0..1, a lower one gives more clouds; seed: seed of the random numbers.
    """
    field = layered_noise(width, height, cells_x, cells_y, 5, seed, 0.55)
    low, high = field.min(), field.max()
    thickness = (field - low) / (high - low) - threshold
    return thickness, thickness > 0


def from_above(seed, threshold, alpha, cells_x, cells_y, tones=HIGH):
    """Return a picture of clouds seen from above, (540, 480, 4) uint8, seamless in both directions.

    threshold: 0..1, a lower one gives more clouds; cells_x, cells_y: numbers of cells of the noise; alpha: opacity
    0..255 of thick parts; tones: colours from dark to light; seed: seed of the random numbers.
    """
    thickness, solid = cover(480, 540, cells_x, cells_y, seed, threshold)
    lit = np.roll(thickness, (3, 2), (0, 1)) - thickness  # thicker towards the bottom right: faces the light
    level = 1.6 - lit * 26 + thickness * 3 + dither(540, 480) * 0.9
    out = np.zeros((540, 480, 4), np.uint8)
    out[..., :3] = graded(tones, level)
    # Thin edges are half clear and dithered, so that they do not look like an island's hard contour.
    edge = thickness / 0.05 + dither(540, 480) * 0.9
    out[..., 3] = np.where(solid & (edge > 0.45), np.where(edge > 1.5, alpha, alpha // 2), 0)
    out[out[..., 3] == 0] = 0
    return out


def shadow_of(clouds, alpha):
    """Return the picture of a cloud layer's shadow: the same shape in a dark colour, (h, w, 4) uint8.

    clouds: picture of the layer, (h, w, 4) uint8; alpha: opacity of the shadow, 0..255.
    """
    out = np.zeros_like(clouds)
    solid = clouds[..., 3] > 0
    out[solid] = (12, 10, 30, alpha)
    return out
