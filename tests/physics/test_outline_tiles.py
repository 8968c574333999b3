"""Outlines of large masks, computed tile by tile: carved ones equal new ones, and seams between tiles are covered."""

import math

import numpy as np
import pytest

from physics import PixelMask, Polygon
from physics.outline.mask_parts import Part
from physics.outline.tile_seams import COVERED, NOBODY, movings
from physics.settings import MASK_TILE
from physics.shapes.outline import corner_turns, is_tiled, keep_tiles, outline_of, tile_outlines, tiles_of
from physics.tables.shape import SHARPEST, TURNS
from tests.outline.tiled import parts_of


def ground(width=300, height=200):
    """Return the pixels of hills with caves."""
    x, y = np.arange(width), np.arange(height)[:, None]
    solid = y > 70 + 30 * np.sin(x / 40) + 9 * np.sin(x / 11 + 1)
    for column, row, radius in ((60, 140, 22), (150, 150, 30), (230, 120, 17)):
        solid &= (x - column) ** 2 + 1.5 * (y - row) ** 2 > radius**2
    return solid


def carved(solid, column, row, radius):
    y, x = np.mgrid[: solid.shape[0], : solid.shape[1]]
    return solid & ((x + 0.5 - column) ** 2 + (y + 0.5 - row) ** 2 > radius**2)


def outlines(mask):
    rows, columns = tiles_of(mask)
    return dict(zip(np.ndindex(rows, columns), tile_outlines(mask, range(rows * columns)), strict=True))


def test_an_outline_is_that_of_its_tiles_row_by_row():
    mask = PixelMask.from_array(ground(), origin=(10.5, 3.25))
    tiles = outlines(mask)
    assert is_tiled(mask) and outline_of(mask) == tuple(part for tile in tiles.values() for part in tile)
    assert mask.outline == tuple(part.shape for part in outline_of(mask))
    for (row, column), parts in tiles.items():
        for part in parts:
            assert part.shape == Polygon(part.shape.points), "as it would be checked and kept"
            corners = np.array(part.shape.points) + (10.5, 3.25)
            assert (corners >= np.array([column, row]) * MASK_TILE).all()
            assert (corners <= np.array([column + 1, row + 1]) * MASK_TILE).all()


@pytest.mark.parametrize("seed", range(3))
def test_seams_are_covered_as_if_all_parts_were_of_one_piece(seed):
    """The corners at seams between tiles are marked as covered exactly where corner_turns() marks them.

    corner_turns() processes all parts of the outline at once, without tiles.
    """
    solid = carved(ground(), *np.random.default_rng(seed).uniform((60, 60), (240, 140)), 20.0)
    mask = PixelMask.from_array(solid, origin=(0, 0))
    parts = [Part(corners, inner, 0.0) for _, _, corners, inner in parts_of(solid)]
    found = outline_of(mask)
    assert len(parts) == len(found)
    for part, turns, one in zip(parts, corner_turns(parts), found, strict=True):
        wanted = {tuple(point): turn for point, turn in zip(part.corners.tolist(), turns, strict=True)}
        found_turns = [wanted[point] for point in one.shape.points]
        for k, turn in enumerate(found_turns):
            assert (one.inner >> 16 + k & 1, one.inner >> 32 + k & 1) == (turn == COVERED, 0.0 < turn <= SHARPEST)
        most = max((turn for turn in found_turns if turn <= SHARPEST), default=0.0)
        assert most < (one.inner >> 48) / TURNS <= most + 2.0 / TURNS


@pytest.mark.parametrize("seed", range(6))
def test_carving_gives_what_would_be_made_anew(seed):
    rng = np.random.default_rng(seed)
    solid = ground()
    mask = PixelMask.from_array(solid)
    before = outlines(mask)
    for _ in range(4):
        column, row, radius = rng.uniform(0, 300), rng.uniform(40, 200), rng.uniform(1, 26)
        solid = carved(mask.solid, column, row, radius)
        box = (column - radius, row - radius, column + radius, row + radius)
        left, top, right, bottom = math.floor(box[0]), math.floor(box[1]), math.ceil(box[2]), math.ceil(box[3])
        new = PixelMask.from_array(solid)
        changed = keep_tiles(new, mask, [(left, top, right, bottom)])
        after, fresh = outlines(new), outlines(PixelMask.from_array(solid))
        assert after == fresh
        columns = tiles_of(new)[1]
        assert {r * columns + c for r, c in fresh if fresh[r, c] != before[r, c]} <= set(changed)
        assert len(changed) <= 16
        mask, before = new, after


def test_small_masks_and_full_ones_are_no_tiles():
    assert not is_tiled(PixelMask.from_array(np.tri(128, dtype=bool)))
    assert is_tiled(PixelMask.from_array(np.tri(129, dtype=bool)))
    assert not is_tiled(PixelMask.from_array(np.ones((300, 20), bool)))


def test_corners_that_move_belong_to_all_tiles_at_whose_borders_they_lie():
    side, corner = np.array([[64.0, 80.0, 1.0, 1.0, 5.0]]), np.array([[128.0, 128.0, 1.0, 0.0, 5.0]])
    for meeting, tiles in ((side, [(1, 0), (1, 1)]), (corner, [(1, 1), (1, 2), (2, 1), (2, 2)])):
        assert movings(meeting, NOBODY, 1, 1, 64) == movings(NOBODY, meeting, 1, 1, 64) == tiles
    both = np.concatenate([side, corner])
    assert movings(both, both[::-1].copy(), 1, 1, 64) == []
    sharper = both * (1.0, 1.0, 1.5, 1.0, 1.0)
    assert movings(both, sharper, 1, 1, 64) == [(1, 0), (1, 1), (1, 2), (2, 1), (2, 2)]
