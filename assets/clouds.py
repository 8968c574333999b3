"""Clouds: thresholded seamless noise in a few tones, for the sky of the platformer and above the sea of the shooter."""

import numpy as np

from assets.fields import dither, layered_noise
from assets.palette import graded, oklch_all
from assets.shading import cut_out

# Colours of a cloud from its shade to its light.
HIGH = oklch_all((0.52, 0.040, 262), (0.60, 0.034, 255), (0.68, 0.026, 245), (0.75, 0.018, 235))
STORM = oklch_all((0.20, 0.030, 285), (0.26, 0.032, 280), (0.32, 0.030, 272), (0.39, 0.026, 262))


def cover(width, height, cells_x, cells_y, seed, threshold):
    """Return (thickness 0.., solid) of a seamless cloud field; the denser the lower the threshold."""
    field = layered_noise(width, height, cells_x, cells_y, 5, seed, 0.55)
    low, high = field.min(), field.max()
    thickness = (field - low) / (high - low) - threshold
    return thickness, thickness > 0


def from_above(seed, threshold, alpha, cells_x, cells_y, tones=HIGH):
    """Clouds over the ground, (540, 480, 4) uint8, seamless in both directions. alpha: 0..255 of a thick part."""
    thickness, solid = cover(480, 540, cells_x, cells_y, seed, threshold)
    lit = np.roll(thickness, (3, 2), (0, 1)) - thickness  # thicker towards the bottom right: faces the light
    level = 1.6 - lit * 26 + thickness * 3 + dither(540, 480) * 0.9
    out = np.zeros((540, 480, 4), np.uint8)
    out[..., :3] = graded(tones, level)
    # Thin edges are half clear and dithered away, so that no hard contour is taken for an island's.
    edge = thickness / 0.05 + dither(540, 480) * 0.9
    out[..., 3] = np.where(solid & (edge > 0.45), np.where(edge > 1.5, alpha, alpha // 2), 0)
    out[out[..., 3] == 0] = 0
    return out


def shadow_of(clouds, alpha):
    """The shadow a cloud layer casts: the same shape in transparent dark."""
    out = np.zeros_like(clouds)
    solid = clouds[..., 3] > 0
    out[solid] = (12, 10, 30, alpha)
    return out


def bank(width, height, seed, base, puffs, tones):
    """A row of cumulus puffs with flat, fading bottoms, (height, width, 4), seamless in x.

    base: y of the bottoms in px; puffs: ((x, lift, radius), ...) in px; tones: four colours, dark to light.
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
