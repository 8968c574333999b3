"""Test masks for outlines, and reference functions by simple loops and shapely."""

import numpy as np
import shapely
from shapely import Polygon, box

from tests.assets.art_reading import load

HARD = {
    "pixel": ["#"],
    "row": ["#####"],
    "column": ["#", "#", "#"],
    "pinch": ["#.", ".#"],
    "pinched hole": ["###.", "#.##", "##.#", ".###"],
    "pinched ring": [".###", "#..#", "#..#", "####"],
    "cross": [".#.", "###", ".#."],
    "big pinch": ["####....", "####....", "####....", "####....", "....####", "....####", "....####", "....####"],
    "spiral": ["#######", "#.....#", "#.###.#", "#.#.#.#", "#.#...#", "#.#####", "#......"],
    "ring in a ring": ["#######", "#.....#", "#.###.#", "#.#.#.#", "#.###.#", "#.....#", "#######"],
    "stairs": ["#....", "##...", "###..", "####.", "#####"],
    "comb": ["#.#.#.#", "#######"],
}


def raster(rows):
    """Return the pixels solid[row, col] of lines of text, in which # is solid."""
    return np.array([[each == "#" for each in row] for row in rows])


def hard():
    """Return a list of (name, solid) of the difficult masks."""
    found = {name: raster(rows) for name, rows in HARD.items()}
    found["checkerboard"] = np.indices((7, 6)).sum(axis=0) % 2 == 0
    found["diagonal"] = np.eye(9, dtype=bool)
    return found


def noise(seed, count, largest=15):
    """Yield `count` random masks of all sizes and densities."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        height, width = rng.integers(1, largest, 2)
        yield rng.random((height, width)) < rng.choice([0.3, 0.5, 0.6, 0.8, 0.95])


def disc(radius, around=(0.0, 0.0)):
    """Return the pixels whose centre lies in a disc. around: offset of its centre from the middle of the raster."""
    size = int(2 * radius + 4)
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2.0
    return (x - around[0]) ** 2 + (y - around[1]) ** 2 <= radius * radius


def sprites():
    """Yield (name, solid) of some of the game's sprites."""
    for sheet, step in (("planes", 9), ("hero", 11), ("things", 7)):
        frames, _ = load(sheet)
        for name in sorted(frames)[::step]:
            solid = frames[name][:, :, 3] > 127
            if solid.any():
                yield f"{sheet}/{name}", solid


def pixels(solid):
    """Return the union of the squares of the solid pixels."""
    return shapely.union_all([box(i, j, i + 1, j + 1) for j, i in np.argwhere(solid).tolist()])


def polygons(pieces):
    """Return the shapely polygons of pieces (outer, holes)."""
    return [Polygon(outer, holes) for outer, holes in pieces]


def connected(solid, diagonal):
    """Return the number of connected pieces, by flood fill. diagonal: True connects pixels that share only a corner."""
    left, count = {tuple(place) for place in np.argwhere(solid).tolist()}, 0
    while left:
        edge, count = [left.pop()], count + 1
        while edge:
            row, column = edge.pop()
            for down, right in ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)):
                place = (row + down, column + right)
                if place in left and (diagonal or down * right == 0):
                    left.discard(place)
                    edge.append(place)
    return count


def lies_on_the_right_side(figure, solid, spare=0.0):
    """Return whether a figure contains the centres of all solid pixels and of no others.

    spare: distance [px] by which the centre of another pixel may lie inside nevertheless.
    """
    rows, columns = np.mgrid[-1 : solid.shape[0] + 1, -1 : solid.shape[1] + 1] + 0.5
    shapely.prepare(figure)
    inside = shapely.contains_xy(figure, columns, rows)
    deep = inside if spare == 0.0 else shapely.contains_xy(figure.buffer(-spare), columns, rows)
    solid = np.pad(solid, 1)
    return bool((inside | ~solid).all() and not (deep & ~solid).any())


def gaps(figure, solid):
    """Return how far a figure deviates from the pixels, as two distances [px].

    The first is the greatest distance of its boundary from the pixel edges. The second is the greatest distance of the
    pixel edges from its boundary. Boundary and edges are sampled every 0.05 px.
    """
    mine, edges = shapely.boundary(figure), pixels(solid).boundary
    return tuple(
        float(shapely.distance(shapely.points(shapely.get_coordinates(shapely.segmentize(a, 0.05))), b).max())
        for a, b in ((mine, edges), (edges, mine))
    )
