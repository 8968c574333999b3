"""Tiles of a raster and the connected pixels in each, against a flood fill of the pixels."""

import numpy as np
import pytest

from physics.raster.pixel_tiles import TILE, PixelTiles


def figures_of(solid):
    """Return the expected rows of type NODE, found by a flood fill: one for each connected set of pixels within a tile.

    Pixels that share only a corner are connected.
    """
    found = []
    height, width = solid.shape
    columns = -(-width // TILE)
    for tile in range(columns * -(-height // TILE)):
        row, column = divmod(tile, columns)
        left, top = column * TILE, row * TILE
        part = {(x, y) for y, x in np.argwhere(solid[top : top + TILE, left : left + TILE]).tolist()}
        while part:
            first = min(part, key=lambda pixel: (pixel[1], pixel[0]))
            reached, todo = {first}, [first]
            part.discard(first)
            while todo:
                x, y = todo.pop()
                near = {(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)} & part
                part -= near
                reached |= near
                todo += near
            xs, ys = [left + x for x, _ in reached], [top + y for _, y in reached]
            sides = [
                sum(1 << x for x, y in reached if y == 0),
                sum(1 << x for x, y in reached if y == TILE - 1),
                sum(1 << y for x, y in reached if x == 0),
                sum(1 << y for x, y in reached if x == TILE - 1),
            ]
            squares = sum(x * x for x in xs) + sum(y * y for y in ys)
            first = first[1] * TILE + first[0]
            bounds = (min(xs), min(ys), max(xs) + 1, max(ys) + 1)
            found.append((tile, len(reached), sum(xs), sum(ys), squares, first, *bounds, *sides))
    return found


def rasters(random):
    """Yield (name, pixels) of test masks: full, empty and mixed tiles, and sizes that end within a tile."""
    for height, width in ((64, 64), (128, 192), (65, 63), (130, 200)):
        yield "full", np.ones((height, width), bool)
        yield "empty", np.zeros((height, width), bool)
        holed = np.ones((height, width), bool)
        holed[random.integers(height), random.integers(width)] = False
        yield "one hole", holed
        yield "one pixel", ~holed
        blocks = random.random((-(-height // TILE), -(-width // TILE))) < 0.5
        yield "blocks", np.kron(blocks, np.ones((TILE, TILE), bool))[:height, :width] > 0
        yield "noise", random.random((height, width)) < 0.45


@pytest.mark.parametrize("seed", range(3))
def test_nodes_are_those_of_a_flood_fill(seed):
    for name, solid in rasters(np.random.default_rng(seed)):
        tiles = PixelTiles.of(solid)
        assert [tuple(each) for each in tiles.nodes.tolist()] == figures_of(solid), (name, solid.shape)
        assert (tiles.window(0, 0, max(solid.shape))[: solid.shape[0], : solid.shape[1]] == solid).all()


@pytest.mark.parametrize("seed", range(3))
def test_changed_tiles_come_to_the_same(seed):
    random = np.random.default_rng(seed)
    for _, solid in rasters(random):
        for _, other in rasters(random):
            if other.shape == solid.shape:
                before, after = PixelTiles.of(solid), PixelTiles.of(other)
                changed = {
                    tile: after.words[tile].copy()
                    for tile in range(len(before.words))
                    if (before.words[tile] != after.words[tile]).any()
                }
                assert (before.replaced(changed).nodes == after.nodes).all()
