"""Any shape as a union of rounded convex hulls: what distance and time of impact are measured between.

A hull is one part; a chain has one per link; tiles and masks have a rectangle per block of solid cells or pixels, and a
polygon per slope.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from physics.raster.rotate import bucket_of
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes.bounds import Bounds
from physics.shapes.library import Library
from physics.shapes.lines import Chain
from physics.shapes.mask import PixelMask
from physics.shapes.placement import write_hull
from physics.shapes.tiles import TileGrid


class Parts(NamedTuple):
    """Convex parts of one shape, all with the same rounding."""

    corners: np.ndarray  # (n, 16, 2) [px]
    counts: np.ndarray  # (n,) corners of each
    boxes: np.ndarray  # (n, 4) min_x min_y max_x max_y of each with its rounding
    radius: float  # [px]


def parts_of(outlines: Sequence, radius: float = 0.0) -> Parts:
    """From a list of outlines of 1 to 16 corners (n, 2), clockwise on the screen [px]."""
    corners, counts = np.zeros((len(outlines), 16, 2)), np.zeros(len(outlines), np.int64)
    boxes = np.zeros((len(outlines), 4))
    for k, outline in enumerate(outlines):
        counts[k] = len(outline)
        corners[k, : len(outline)] = outline
        boxes[k] = (
            *(corners[k, : len(outline)].min(axis=0) - radius),
            *(corners[k, : len(outline)].max(axis=0) + radius),
        )
    return Parts(corners, counts, boxes, float(radius))


def rectangle(left: float, top: float, right: float, bottom: float) -> list[tuple[float, float]]:
    """Corners of a box, clockwise on the screen."""
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


def tile_outlines(grid: TileGrid, x: float, y: float, feet: float) -> list:
    """Outlines of a TileGrid whose origin is at (x, y) [px].

    feet [px]: the lowest point of the other shape, from the grid's origin: a one-way tile counts, as its top edge, for
    what is wholly above it.
    """
    size = grid.tile_size
    solid, slopes, one_way = grid.blocks
    found = [
        rectangle(x + left * size, y + top * size, x + right * size, y + bottom * size)
        for left, top, right, bottom in solid
    ]
    for row, column in slopes:
        left, right = (y + (row + 1) * size - height * size for height in grid.slopes[row, column].tolist())
        x_left, x_right, bottom = x + column * size, x + (column + 1) * size, y + (row + 1) * size
        corners = [(x_left, left), (x_right, right), (x_right, bottom), (x_left, bottom)]
        found.append([each for k, each in enumerate(corners) if k > 1 or each[1] < bottom])
    for left, top, right, bottom in one_way:
        found += [
            [(x + left * size, y + row * size), (x + right * size, y + row * size)]
            for row in range(top, bottom)
            if feet <= row * size
        ]
    return found


def mask_outlines(mask: PixelMask, bucket: int, x: float, y: float) -> list:
    """Outlines of a mask's pixels at an angle bucket, whose raster's top left corner is at (x, y) [px]."""
    return [rectangle(x + left, y + top, x + right, y + bottom) for left, top, right, bottom in mask.blocks(bucket)]


def chain_outlines(chain: Chain) -> list:
    """Both ends of each link in body space [px]."""
    points = list(chain.points) + ([chain.points[0]] if chain.loop else [])
    return list(pairwise(points))


def placed_parts(
    library: Library, bodies: np.ndarray, shapes: np.ndarray, row: int, x: float, y: float, feet: float
) -> Parts:
    """Parts of a SHAPE row as it stands, seen from (x, y) [px].
    feet [px]: the lowest point of who asks, see tile_outlines."""
    shape, placed = library.shape_of(shapes[row]), shapes[row]
    body = bodies[placed["body_row"]]
    at_x, at_y = float(body["x"]) - x, float(body["y"]) - y
    if isinstance(shape, Bounds):
        return parts_of([rectangle(placed["min_x"] - x, placed["min_y"] - y, placed["max_x"] - x, placed["max_y"] - y)])
    if isinstance(shape, TileGrid):
        return parts_of(tile_outlines(shape, at_x, at_y, feet - float(body["y"])))
    if isinstance(shape, PixelMask):
        bucket = bucket_of(float(body["angle"]), MASK_ANGLE_BUCKETS)
        return parts_of(mask_outlines(shape, bucket, float(placed["left"]) - x, float(placed["top"]) - y))
    if isinstance(shape, Chain):
        cosine, sine = np.cos(body["angle"]), np.sin(body["angle"])
        turn = np.array([[cosine, sine], [-sine, cosine]])
        return parts_of([np.array(link) @ turn + (at_x, at_y) for link in chain_outlines(shape)])
    corners = np.zeros((16, 2))
    count, radius = write_hull(library.tables, shapes, row, at_x, at_y, float(body["angle"]), corners)
    return parts_of([corners[:count]], radius)
