"""The palette: ramps of six colours from shadow to light, made in OKLCH with the hue shifted along the ramp.

Shadows tend to violet and lights to warm yellow, so that the colours of different ramps match. A ramp is an array (6,
3) of uint8; index 0 is the darkest. The outline is a dark violet, never pure black.
"""

import math

import numpy as np

STEPS = 6
DARKEST, LIGHTEST = 0.18, 0.97  # OKLab lightness of the two ends of a full ramp
SHADOW_HUE, LIGHT_HUE = 275.0, 95.0  # [deg] hues of shadows and lights
SHADOW_LEAN, LIGHT_LEAN = 0.45, 0.35  # share of the shift to those hues at the ends


def oklch(lightness, chroma, hue):
    """Return a colour, (3,) uint8. lightness: OKLab lightness 0..1; chroma: about 0..0.3; hue: in degrees.

    Matrices from Ottosson, "A perceptual color space for image processing" (2020). Colours outside sRGB are clipped.
    """
    a = chroma * math.cos(math.radians(hue))
    b = chroma * math.sin(math.radians(hue))
    long = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3
    medium = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3
    short = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3
    linear = (
        4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short,
        -1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short,
        -0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short,
    )
    return np.array([_encode(channel) for channel in linear], np.uint8)


def oklch_all(*values):
    """Return several colours, (n, 3) uint8. values: their OKLCH coordinates, (lightness, chroma, hue) each."""
    return np.array([oklch(*value) for value in values])


def _encode(linear):
    """Return a linear light value 0..1 as an integer 0..255, by the sRGB transfer curve."""
    linear = min(1.0, max(0.0, linear))
    if linear <= 0.0031308:
        return round(255 * 12.92 * linear)
    return round(255 * (1.055 * linear ** (1 / 2.4) - 0.055))


def ramp(hue, chroma, low=DARKEST, high=LIGHTEST):
    """Return a ramp of colours from shadow to light around a base hue, an array (STEPS, 3) uint8.

    hue: in degrees; chroma: greatest chroma, about 0..0.3; low, high: lightness of the first and the last colour, 0..1.
    """
    colours = []
    for i in range(STEPS):
        t = i / (STEPS - 1)
        lightness = low + (high - low) * t**0.9
        to_shadow = (SHADOW_HUE - hue + 180) % 360 - 180
        to_light = (LIGHT_HUE - hue + 180) % 360 - 180
        turned = hue + to_shadow * SHADOW_LEAN * max(0.0, 1 - 2 * t) + to_light * LIGHT_LEAN * max(0.0, 2 * t - 1)
        # Colour is richest just under the middle and fades at both ends.
        colours.append(oklch(lightness, chroma * (1 - abs(2 * t - 0.95) ** 2.2 * 0.75), turned))
    return np.array(colours)


RAMPS = {
    "steel": ramp(250, 0.04),
    "blue": ramp(255, 0.15),
    "red": ramp(25, 0.19),
    "orange": ramp(50, 0.17),
    "gold": ramp(80, 0.15),
    "green": ramp(145, 0.15),
    "olive": ramp(118, 0.10),
    "purple": ramp(310, 0.16),
    "pink": ramp(350, 0.17),
    "teal": ramp(195, 0.11),
    "wood": ramp(58, 0.09, 0.20, 0.86),
    "dirt": ramp(45, 0.060, 0.17, 0.70),
    "stone": ramp(285, 0.042, 0.20, 0.86),
    "grass": ramp(138, 0.135, 0.24, 0.90),
    "glass": ramp(205, 0.10, 0.30, 0.98),
    "gunmetal": ramp(265, 0.030, 0.15, 0.72),
    "rock": ramp(232, 0.054, 0.20, 0.82),
    "armour": ramp(262, 0.062, 0.16, 0.84),
}
OUTLINE = oklch(0.16, 0.03, 285)
WHITE = np.array((255, 255, 255), np.uint8)
FIRE = np.array(
    [
        (255, 255, 255),
        (255, 250, 190),
        (255, 214, 90),
        (255, 148, 40),
        (224, 78, 36),
        (140, 40, 52),
        (74, 38, 60),
        (44, 34, 52),
    ],
    np.uint8,
)  # an explosion from its first moment to its last cinder


def mix(first, second, share):
    """Return a mix of two colours or arrays of colours as uint8.

    share: weight of `second`, 0..1; the weight of `first` is 1 - share.
    """
    first, second = np.asarray(first, float), np.asarray(second, float)
    return np.floor(first + (second - first) * share + 0.5).astype(np.uint8)


def graded(ramp, level):
    """Return the colour of each pixel, an array (..., 3), for its level on a ramp of colours.

    Levels from 0 to 1 have the first colour of the ramp, levels from 1 to 2 the second, and so on. Levels outside the
    ramp have its first or last colour.
    """
    # Rounded first: at a whole level, the last bit of a sum must not decide the colour.
    return ramp[np.clip(np.floor(np.round(level, 6)), 0, len(ramp) - 1).astype(int)]
