"""The scrolling ground below the planes, with clouds and rain. The next kind of ground enters from above.

The border between two kinds of ground is a wavy, dithered line. The new ground is above this line.
"""

from functools import cache, lru_cache

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.canvas import CANVAS_SIZE, whole
from game.drawing.sprites import load_backdrop
from scenes.shooter.cast import GROUND_SPEED, steps

# (layer of clouds, speed down [px/s], shift in px per px of the plane's offset from the middle, fixed shift [px])
LAYERS = (("cloud_shadows", 46.0, 0.06, 40), ("clouds_low", 46.0, 0.08, 0), ("clouds_high", 92.0, 0.16, 0))
BORDER = 150  # [px] height of the transition between two kinds of ground
DARKEN = steps(5.0)  # steps in which the clouds darken for a storm
SHADES = 6  # steps of brightness of darkening clouds
DARKEST = (96, 104, 138)  # factors, of 255, on clouds of a storm
STREAKS = 16  # wisps of air that show the speed
DROPS = 70  # of rain in the picture
BLUER = 20  # excess of blue over red in the colour of water; rock is grey
CONTRAST = (150, 150, 158)  # factors, of 255, on the ground for the palette with more contrast


def draw_ground(surface, scene, alpha, left, top):
    """Draw ground, scorch marks, clouds and rain on the surface.

    alpha: position (0..1) between the last two steps; left, top: offset of a shaking camera [px].
    """
    spectacle, grounds = scene.spectacle, scene.director.grounds
    scrolled = scene.scrolled_before + (scene.scrolled - scene.scrolled_before) * alpha
    _draw_stretches(surface, grounds, scrolled, left, top)
    for x, y, size in spectacle.works.scars:
        mark = scar(size)
        surface.blit(mark, (whole(x) - mark.get_width() // 2 - left, whole(y) - mark.get_height() // 2 - top))
    off = spectacle.lean_at(alpha)
    time = spectacle.time + (alpha - 1.0) / 60
    share = storm_share(grounds, scrolled)
    for name, speed, lean, shift in LAYERS:
        picture = clouds(name, round(share * SHADES))
        tile(surface, picture, shift - off * lean - left, time * speed + shift - top)
    _draw_air(surface, time, off, share)
    if scene.accessibility.palette == "contrast":
        surface.fill(CONTRAST, special_flags=pygame.BLEND_RGB_MULT)


def is_water(scene, x, y):
    """Return whether the ground at the point (x, y) [px] of the picture is water. The colour of the picture decides."""
    since, name = scene.director.grounds[-1]
    line = scene.scrolled - since - BORDER / 2
    if y > line and len(scene.director.grounds) > 1:
        name = scene.director.grounds[-2][1]
    picture = stretch(name)
    width, height = picture.get_size()
    near = [
        picture.get_at((whole(x + dx) % width, whole(y + dy - scene.scrolled) % height))
        for dx in (-2, 0, 2)
        for dy in (-2, 0, 2)
    ]
    red, green, blue = (sum(color[part] for color in near) for part in range(3))
    return blue >= green and blue > red + BLUER * len(near)


def storm_share(grounds, scrolled):
    """Return the strength of the storm, 0..1, after the ground has scrolled by `scrolled` px.

    grounds: list of (scrolled distance [px] at which a ground came into view, name of the ground), as in Director.
    """
    since, name = grounds[-1]
    grown = min(max((scrolled - since) / GROUND_SPEED * 60 / DARKEN, 0.0), 1.0)
    if name == "storm":
        return grown
    return 1.0 - grown if len(grounds) > 1 and grounds[-2][1] == "storm" else 0.0


def _draw_stretches(surface, grounds, scrolled, left, top):
    since, name = grounds[-1]
    line = whole(scrolled - since) - BORDER - top  # [canvas px] above it, the new ground covers the whole width
    if len(grounds) == 1 or line > CANVAS_SIZE[1]:
        tile(surface, stretch(name), -left, scrolled - top)
        return
    tile(surface, stretch(grounds[-2][1]), -left, scrolled - top)
    if line > 0:
        surface.set_clip((0, 0, CANVAS_SIZE[0], line))
        tile(surface, stretch(name), -left, scrolled - top)
        surface.set_clip(None)
    band = pygame.Surface((CANVAS_SIZE[0], BORDER), pygame.SRCALPHA)
    tile(band, stretch(name), -left, scrolled - top - line)
    band.blit(coast_line(), (0, 0), special_flags=pygame.BLEND_RGBA_MULT)
    surface.blit(band, (0, line))


def _draw_air(surface, time, off, storm):
    width, height = CANVAS_SIZE
    drawn = []
    for number in range(STREAKS):
        across = number * 97 % width + off * -0.3
        down = (time * (260 + 23 * (number % 5)) + number * 61) % (height + 60) - 30
        drawn.append((streak(), (int(across) % width, int(down))))
    for number in range(int(DROPS * storm)):
        down = (time * (520 + 31 * (number % 7)) + number * 83) % (height + 40) - 20
        across = number * 137 + down * 0.22 + off * -0.2
        drawn.append((drop(), (int(across) % width, int(down))))
    blit_many(surface, drawn)


@cache
def stretch(name):
    """Return the picture of the ground called `name`, a Surface."""
    return load_backdrop(name)


@cache
def clouds(name, shade):
    """Return a Surface with a layer of clouds, darkened for a storm. shade: 0 (bright) .. SHADES (darkest)."""
    picture = load_backdrop(name)
    if shade == 0:
        return picture
    dark = picture.copy()
    factors = [255 + (c - 255) * shade // SHADES for c in DARKEST]
    dark.fill((*factors, 255), special_flags=pygame.BLEND_RGBA_MULT)
    return dark


@lru_cache(maxsize=1)
def coast_line():
    """Return a Surface with the border between two grounds: white where the upper one is visible, else transparent.

    It is as wide as the canvas and BORDER px high.
    """
    width = CANVAS_SIZE[0]
    x, y = np.arange(width)[:, None], np.arange(BORDER)[None, :]
    turn = 2 * np.pi * x / width
    # Whole numbers of waves across, so that the border has no seam; the second term makes islands and bays.
    wave = 20 * np.sin(3 * turn + 0.7) + 13 * np.sin(7 * turn + 2.1) + 7 * np.sin(17 * turn)
    bays = 12 * np.sin(11 * turn + y / 9.0) * np.sin(5 * turn - y / 14.0 + 1.3)
    bayer = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])[x % 4, y % 4] / 16 - 0.5
    upper = y < BORDER / 2 + wave + bays + 7 * bayer
    mask = pygame.Surface((width, BORDER), pygame.SRCALPHA)
    pygame.surfarray.pixels3d(mask)[:] = 255
    pygame.surfarray.pixels_alpha(mask)[:] = np.where(upper, 255, 0)
    return mask


@lru_cache(maxsize=1)
def streak():
    """Return a Surface with a wisp of air, which shows the speed of the flight."""
    image = pygame.Surface((1, 14), pygame.SRCALPHA)
    for row in range(14):
        image.set_at((0, row), (220, 236, 255, 4 + 4 * row))
    return image


@lru_cache(maxsize=1)
def drop():
    """Return a Surface with a slanted drop of rain."""
    image = pygame.Surface((3, 10), pygame.SRCALPHA)
    for row in range(10):
        image.set_at((row * 3 // 10, row), (186, 208, 240, 18 + 8 * row))
    return image


@lru_cache(maxsize=8)
def scar(size):
    """Return a Surface with a scorch mark of radius `size` [px]: dark, ragged, and transparent towards its edge."""
    reach = 2 * size + 1
    x, y = np.meshgrid(np.arange(reach) - size, np.arange(reach) - size, indexing="ij")
    ragged = 1.0 + 0.16 * np.sin(5 * np.arctan2(y, x) + 1.0) + 0.1 * np.sin(9 * np.arctan2(y, x))
    far = np.hypot(x, y) / (size * 0.8 * ragged)
    image = pygame.Surface((reach, reach), pygame.SRCALPHA)
    pygame.surfarray.pixels3d(image)[:] = (18, 14, 22)
    dither = np.where((x + y) % 2 == 0, 0.16, 0.0)
    pygame.surfarray.pixels_alpha(image)[:] = np.where(far + dither < 0.72, 170, np.where(far + dither < 1.0, 96, 0))
    return image


def tile(surface, picture, x, y):
    """Fill the surface with copies of a picture, side by side.

    x, y: upper left corner of one of the copies [px].
    """
    width, height = picture.get_size()
    wide, high = surface.get_size()
    start = whole(y) % height - height
    side = whole(x) % width - width
    for down in range(start, high, height):
        for across in range(side, wide, width):
            if down + height > 0 and across + width > 0:
                surface.blit(picture, (across, down))
