"""Outlines computed tile by tile form one consistent outline."""

import math

import numpy as np
import pytest
import shapely

from physics.outline.mask_parts import mask_parts
from physics.outline.tiled import HALO, tile_parts
from tests.outline.rasters import disc
from tests.outline.tiled import SIZE, check, parts_of, whole

SMOOTH = (0.0, 0.1, 0.25, 0.4, 0.5, 1.0)


def placed(solid, row, column, height=140, width=140):
    """Return a raster of height x width with some pixels placed at (row, column)."""
    found = np.zeros((height, width), bool)
    found[row : row + solid.shape[0], column : column + solid.shape[1]] = solid
    return found


def clouds(seed, size=140):
    """Return a mask of blurred noise: islands and caves of any size."""
    rng = np.random.default_rng(seed)
    field = rng.random((size + 8, size + 8))
    for _ in range(int(rng.integers(1, 7))):
        field = field[:-1, :-1] + field[1:, :-1] + field[:-1, 1:] + field[1:, 1:]
    field = field[:size, :size]
    return field > np.quantile(field, rng.uniform(0.3, 0.7))


def boxes(seed):
    """Return the exclusive-or of random boxes, which has long straight edges along and across the borders of tiles."""
    rng = np.random.default_rng(seed)
    found = np.zeros((140, 140), bool)
    for _ in range(12):
        row, column = rng.integers(30, 80, 2)
        if rng.random() < 0.4:
            row, column = rng.choice([0, 60, 63, 64, 65], 2)
        height, width = rng.integers(1, 50, 2)
        found[row : row + height, column : column + width] ^= True
    return found


def stairs(run, rise, shift=0, size=192):
    """Return the pixels of ground that rises by `rise` px for every `run` px."""
    y, x = np.mgrid[:size, :size]
    return (size - 1 - y) * run < (x + shift) * rise + 0.5


@pytest.mark.parametrize("smooth", SMOOTH)
@pytest.mark.parametrize("seed", range(6))
def test_noise_at_borders(seed, smooth):
    rng = np.random.default_rng(seed)
    noise = rng.random((24, 24)) < rng.choice([0.3, 0.5, 0.6, 0.8])
    check(placed(noise, *(64 - rng.integers(1, 24, 2))), smooth)


@pytest.mark.parametrize("smooth", SMOOTH)
@pytest.mark.parametrize("seed", range(3))
def test_clouds(seed, smooth):
    check(clouds(seed), smooth)


@pytest.mark.parametrize("smooth", (0.0, 0.25, 0.5))
@pytest.mark.parametrize("seed", range(8))
def test_boxes_along_borders(seed, smooth):
    check(boxes(seed), smooth)


def test_small_tiles_have_many_borders():
    for seed in range(4):
        check(clouds(seed, 70), 0.5, size=HALO + 1)


@pytest.mark.parametrize("run, rise", [(1, 1), (2, 1), (3, 1), (1, 3), (3, 2), (7, 1), (1, 7), (5, 2)])
@pytest.mark.parametrize("shift", range(4))
def test_stairs_are_as_straight_across_tiles_as_within_one(run, rise, shift):
    solid = stairs(run, rise, shift)
    worst = deviation(whole(check(solid)), math.atan2(-rise, run))
    assert worst <= 0.01, "no bump at a border"


def deviation(figure, angle):
    """Return the largest angle between a direction and the sides of an outline [rad].

    Only the sides in the middle tile and at its border count. figure: the outline; angle: the direction [rad].
    """
    corners = shapely.get_coordinates(figure.simplify(1e-6).boundary)
    corners = corners[((corners >= 63) & (corners <= 129)).all(axis=1)]
    along = np.diff(corners, axis=0)
    return float(np.abs((np.arctan2(along[:, 1], along[:, 0]) - angle + 1.5) % math.pi - 1.5).max(initial=0.0))


def test_full_and_empty_tiles():
    window = np.ones((SIZE + 2 * HALO,) * 2, bool)
    full = tile_parts(window, 0.5)
    assert full.corners.tolist() == [[0, 0], [64, 0], [64, 64], [0, 64]] and full.inner.all() and full.counts == [4]
    assert len(tile_parts(~window, 0.5).counts) == 0
    window[: HALO - 5] = False  # only the halo's rim differs
    assert tile_parts(window, 0.5).corners.tolist() == full.corners.tolist()
    alone = np.zeros_like(window)
    alone[HALO : HALO + SIZE, HALO : HALO + SIZE] = True
    square = tile_parts(alone, 0.5)
    assert square.corners.tolist() == full.corners.tolist() and not square.inner.any()


def test_a_rectangle_over_tiles_keeps_its_corners():
    parts = check(placed(np.ones((90, 70), bool), 5, 9))
    assert len(parts) == 4
    outer = {tuple(each) for _, _, corners, _ in parts for each in corners.tolist()}
    assert {(9.0, 5.0), (79.0, 5.0), (79.0, 95.0), (9.0, 95.0)} <= outer


def test_only_the_halo_counts():
    rng = np.random.default_rng(3)
    for seed in range(4):
        solid = clouds(seed, 200)
        other = rng.random((200, 200)) < 0.5
        other[64 - HALO : 128 + HALO, 64 - HALO : 128 + HALO] = solid[64 - HALO : 128 + HALO, 64 - HALO : 128 + HALO]
        a, b = ([part for part in parts_of(each) if part[:2] == (1, 1)] for each in (solid, other))
        assert len(a) == len(b) > 0
        assert all(np.array_equal(p, q) for x, y in zip(a, b, strict=True) for p, q in zip(x, y, strict=True))


def test_holes_are_bridged_and_islands_in_them_kept():
    solid = placed(disc(28), 2, 2, 64, 64) & ~placed(disc(18), 12, 12, 64, 64) | placed(disc(8), 22, 22, 64, 64)
    check(solid)
    check(np.ones((64, 64), bool) ^ placed(np.indices((40, 40)).sum(axis=0) % 5 == 0, 10, 10, 64, 64))


def test_few_parts():
    """Tile-wise outlines have at most 1.1 times as many parts as the optimal partition of the same outlines."""
    ours = best = 0
    for seed in range(4):
        solid = placed(clouds(seed, 62), 1, 1, 64, 64)
        ours, best = ours + len(parts_of(solid)), best + len(mask_parts(solid))
    assert ours <= 1.1 * best, (ours, best)


@pytest.mark.parametrize("shape", [(96, 90), (2 * HALO, 2 * HALO), (3 * HALO, 3 * HALO)])
def test_windows_of_another_form_are_refused(shape):
    with pytest.raises(ValueError, match="window must be square, its tile larger than 16"):
        tile_parts(np.ones(shape, bool), 0.5)
