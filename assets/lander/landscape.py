"""The shape of the lander's moon: the pixels of rock, of ice that a shell can break, and of the wall behind holes.

The plan in assets/levels/lander.json has straight lines. Noise bends these lines, so that edges look natural.
"""

import json
from dataclasses import dataclass

import numpy as np
import pygame

from assets import FOLDER
from assets.craft.fields import capsule, grid, layered_noise, polygon
from assets.craft.shading import shifted

BENT = 13.0  # [px] displacement of a line of the plan, to both sides
ROUGH = 3.4  # [px] the same, by the fine noise
MARGIN = 24  # [px] around a part's box that is examined: more than the displacement
FROZEN_IN = 6  # [px] extent of ice into the rock beside it
SHOULDER = 5  # [px] extent of level ground beyond a pad, to both sides
HEADROOM = 34  # [px] over a pad that are free
ACROSS, DOWN = ((1, 0), (-1, 0)), ((0, 1), (0, -1))


@dataclass
class Landscape:
    """The moon as three bool arrays (height, width).

    solid: rock and ice; ice: ice alone; massif: rock before caves were hollowed out.
    """

    solid: np.ndarray
    ice: np.ndarray
    massif: np.ndarray


def plan():
    """Return the contents of assets/levels/lander.json, the plan of the moon, as a dict."""
    return json.loads((FOLDER / "levels" / "lander.json").read_text(encoding="utf-8"))


def landscape():
    """Return the Landscape of the moon before the first landing."""
    drawn = plan()
    width, height = drawn["size"]
    x, y = grid(width, height)
    x = x + _bend(width, height, 900)
    y = y + _bend(width, height, 950)
    massif = np.zeros((height, width), bool)
    for points in drawn["rock"]:
        massif |= _inside(x, y, points)
    solid = massif.copy()
    for part in drawn["hollow"]:
        _near(solid, x, y, [part["from"], part["to"]], max(part["radius"]), _hollow(part))
    for part in drawn["spike"]:
        (foot_x, foot_y), half = part["at"], part["half"]
        points = [(foot_x - half, foot_y), part["tip"], (foot_x + half, foot_y)]
        _near(solid, x, y, points, 4, _filled(points))
    ice = np.zeros_like(solid)
    for points in drawn["plug"]:
        _near(ice, x, y, points, 4, _filled(points))
    ice &= _around(massif & ~solid, FROZEN_IN)
    ice &= ~_crack(solid, ice)
    solid |= ice
    for pad in drawn["pads"]:
        _level(solid, ice, massif, pad)
    return Landscape(solid, ice, massif)


def _bend(width, height, seed):
    wide = layered_noise(width, height, 48, 12, 2, seed) - 0.5
    fine = layered_noise(width, height, 400, 100, 2, seed + 1) - 0.5
    return 2 * BENT * wide + 2 * ROUGH * fine


def _inside(x, y, points):
    """Return a bool array that is True for the pixels inside the polygon `points`, by the crossing rule.

    x, y: positions of the pixels, arrays (h, w). Each edge is applied only to the rows that it can reach.
    """
    inside = np.zeros(x.shape, bool)
    for i, (ax, ay) in enumerate(points):
        bx, by = points[i - 1]
        if ay == by:
            continue
        low, high = max(0, int(min(ay, by)) - MARGIN), max(0, int(max(ay, by)) + MARGIN)
        px, py = x[low:high], y[low:high]
        inside[low:high] ^= ((ay > py) != (by > py)) & (px < ax + (py - ay) * ((bx - ax) / (by - ay)))
    return inside


def _near(solid, x, y, points, reach, change):
    """Call change(solid, x, y) with the part of these three arrays that is near some points.

    solid (h, w) bool: a mask; x, y (h, w): positions of its pixels; points: list of (x, y) [px]; change: function that
    changes a mask in place. The part is the bounding box of the points, enlarged by `reach` [px] on each side.
    """
    reach += MARGIN
    left, right = (max(0, int(f(p[0] for p in points) + s * reach)) for f, s in ((min, -1), (max, 1)))
    top, bottom = (max(0, int(f(p[1] for p in points) + s * reach)) for f, s in ((min, -1), (max, 1)))
    part = np.s_[top:bottom, left:right]
    change(solid[part], x[part], y[part])


def _hollow(part):
    def change(solid, x, y):
        solid &= capsule(x, y, part["from"], part["to"], *part["radius"]) >= 0

    return change


def _filled(points):
    def change(solid, x, y):
        solid |= polygon(x, y, points) < 0

    return change


def _around(pixels, far=1, ways=(*ACROSS, *DOWN)):
    """Return the union of a mask and its copies that are shifted by `far` px in each direction (dx, dy) of `ways`.

    pixels: mask (h, w) bool; the result has the same shape.
    """
    out = pixels.copy()
    for dx, dy in ways:
        out |= shifted(pixels, far * dx, far * dy)
    return out


def _crack(rock, ice):
    """Return a mask of a crack in the ice, one pixel wide, between a hanging mountain and the ground below it.

    A hanging mountain touches the ground only through ice. Because of the crack it is a separate piece from the start,
    so it stays in place when all the ice is shot away. rock, ice: masks (h, w) bool.
    """
    hanging = _hanging(rock)
    open_ice = ice & ~rock
    near_mountain, near_ground = hanging, rock & ~hanging
    while True:
        further = _around(near_mountain) & open_ice & ~near_mountain & ~near_ground
        near_mountain = near_mountain | further
        beside = _around(near_ground) & open_ice & ~near_mountain & ~near_ground
        near_ground = near_ground | beside
        if not (further.any() or beside.any()):
            return near_mountain & open_ice & _around(_around(near_ground, ways=ACROSS), ways=DOWN)


def _hanging(rock):
    """Return a mask of the rock that hangs: it is not connected through rock with the lower edge of the picture."""
    surface = pygame.Surface(rock.T.shape, pygame.SRCALPHA)
    pygame.surfarray.pixels_alpha(surface)[:] = rock.T * np.uint8(255)
    found = np.zeros_like(rock)
    for part in pygame.mask.from_surface(surface).connected_components():
        pixels = pygame.surfarray.array_red(part.to_surface()).T > 0
        if not pixels[-1].any():
            found |= pixels
    return found


def _level(solid, ice, massif, pad):
    """Make level ground for the feet of a landing pad, and remove rock and ice from the space above it.

    pad: its entry in the plan. If the pad is under open sky, this space is also removed from `massif`.
    """
    left, right = pad["x"] - pad["width"] // 2 - SHOULDER, pad["x"] + pad["width"] // 2 + SHOULDER
    floor = pad["floor"]
    solid[floor : floor + 40, left:right] = True
    solid[floor - HEADROOM : floor, left:right] = False
    ice[floor - HEADROOM : floor + 40, left:right] = False
    if not massif[floor - HEADROOM - 6, pad["x"]]:
        massif[floor - HEADROOM : floor, left:right] = False
