"""The lander's moon: pads are on level ground under open air, ice closes the cave, and a ship fits through."""

from collections import deque

import numpy as np
import pytest

from assets.lander.landscape import HEADROOM, landscape, plan
from physics import PixelMask
from tests.assets.art_reading import backdrop

CELL = 8  # [px] of the coarse grid on which ways are looked for
SHIP = 2  # cells of clearance to each side: a ship and its play


@pytest.fixture(scope="module")
def moon():
    return landscape()


def test_the_picture_is_the_landscape(moon):
    assert ((backdrop("lander_ground")[..., 3] > 0) == moon.solid).all()
    assert ((backdrop("lander_wall")[..., 3] > 0) == moon.massif).all()
    assert not (moon.ice & ~moon.solid).any() and moon.ice.sum() > 3000


@pytest.mark.parametrize("pad", plan()["pads"], ids=lambda pad: pad["name"])
def test_a_pad_stands_on_level_ground_under_air(moon, pad):
    half = pad["width"] // 2
    columns = slice(pad["x"] - half, pad["x"] + half)
    assert moon.solid[pad["floor"], columns].all() and not moon.ice[pad["floor"], columns].any()
    assert not moon.solid[pad["floor"] - HEADROOM : pad["floor"], columns].any()


def reached(solid, start):
    """Return the cells that a ship can reach, a bool array. A cell is CELL px wide.

    solid: the pixels of the ground; start: (x, y) at which the ship starts [px].
    """
    height, width = (size // CELL for size in solid.shape)
    closed = solid[: height * CELL, : width * CELL].reshape(height, CELL, width, CELL).any(axis=(1, 3))
    for _ in range(SHIP):
        grown = closed.copy()
        grown[1:] |= closed[:-1]
        grown[:-1] |= closed[1:]
        grown[:, 1:] |= closed[:, :-1]
        grown[:, :-1] |= closed[:, 1:]
        closed = grown
    found, queue = np.zeros_like(closed), deque([(start[1] // CELL, start[0] // CELL)])
    while queue:
        row, column = queue.popleft()
        if 0 <= row < height and 0 <= column < width and not closed[row, column] and not found[row, column]:
            found[row, column] = True
            queue.extend(((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)))
    return found


def test_ice_closes_the_cave_and_nothing_else_does(moon):
    over = {pad["name"]: ((pad["y"] - 32) // CELL, pad["x"] // CELL) for pad in plan()["pads"]}
    base = plan()["pads"][0]
    now = reached(moon.solid, (base["x"], base["y"] - 100))
    assert now[over["canyon"]] and now[over["mesa"]] and not now[over["cave"]]
    then = reached(moon.solid & ~moon.ice, (base["x"], base["y"] - 100))
    assert then[over["cave"]]


def test_both_ways_into_the_cave_are_closed_each_by_ice_of_its_own(moon):
    columns = np.flatnonzero(moon.ice.any(axis=0))
    assert (np.diff(columns) > 300).sum() == 1


def test_nothing_floats_but_the_mountain_that_only_ice_would_hold(moon):
    """No rock is detached except the mountain that ice holds.

    Rock spikes touch their roof or floor. Cracks one pixel wide, through both ice plugs, separate the mountain.
    """
    counts = PixelMask(moon.solid).tiles.pieces.counts
    assert len(counts) == 2 and min(counts) > 100_000, sorted(counts.tolist())
    above, beside = np.roll(moon.solid, 1, axis=0), np.roll(moon.solid, 1, axis=1)
    mended = moon.solid | (above & np.roll(moon.solid, -1, axis=0)) | (beside & np.roll(moon.solid, -1, axis=1))
    assert len(PixelMask(mended).tiles.pieces.counts) == 1
    cracks = mended & ~moon.solid & ~moon.ice
    assert (cracks.any(axis=0).nonzero()[0] < 1830).any() and (cracks.any(axis=0).nonzero()[0] > 2440).any()
