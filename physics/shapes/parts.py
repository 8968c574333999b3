"""Convex decomposition of any shape into rounded hulls, between which distance and time of impact are measured.

A hull is one part. A chain has one part per link. Tiles have a rectangle per block of solid cells, and a polygon per
slope. A mask has two decompositions: a rectangle per block of solid pixels, for measurements by pixels, and the parts
of its outline, for sweeps and casts.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from physics.raster.bits import bucket_of
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes.library import Library
from physics.shapes.mask import Bounds, PixelMask
from physics.shapes.outline import outline_of
from physics.shapes.placement import turn_of_mask, write_hull
from physics.shapes.values import Chain, Circle, TileGrid

NEAR = 1e-9  # relative to the coordinates: margin of a query box, since casts round as well


class Parts(NamedTuple):
    """Convex parts of one shape."""

    corners: np.ndarray  # (n, 16, 2) [px]
    counts: np.ndarray  # (n,) corners of each
    boxes: np.ndarray  # min_x min_y max_x max_y of each part, rounding included
    radii: np.ndarray  # (n,) rounding of each [px]


def parts_of(outlines: Sequence, radius: float = 0.0) -> Parts:
    """Return the Parts of outlines of 1 to 16 corners (n, 2), clockwise on the screen [px], with one rounding [px]."""
    corners, counts = np.zeros((len(outlines), 16, 2)), np.zeros(len(outlines), np.int64)
    for k, outline in enumerate(outlines):
        counts[k] = len(outline)
        corners[k, : len(outline)] = outline
    return with_boxes(corners, counts, np.full(len(outlines), float(radius)))


def with_boxes(corners: np.ndarray, counts: np.ndarray, radii: np.ndarray) -> Parts:
    """Return Parts of corners (n, 16, 2), counts and roundings, with their bounding boxes."""
    used = (np.arange(16)[None, :] < counts[:, None])[:, :, None]
    low, high = np.where(used, corners, np.inf).min(axis=1), np.where(used, corners, -np.inf).max(axis=1)
    return Parts(corners, counts, np.concatenate([low - radii[:, None], high + radii[:, None]], axis=1), radii)


def turned_parts(parts: Parts, x: float, y: float, cosine: float, sine: float) -> Parts:
    """Return parts in body space moved to the pose of their body: (x, y) [px], cosine and sine of its angle."""
    corners = parts.corners @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y)
    return with_boxes(corners, parts.counts, parts.radii)


def outline_parts(mask: PixelMask) -> Parts:
    """Return the parts of a mask's outline in body space, cached with the mask."""
    mask = mask.bare
    if "outline parts" not in mask.fitted:
        shapes = [part.shape for part in outline_of(mask)]
        points = [(shape.center,) if isinstance(shape, Circle) else shape.points for shape in shapes]
        radii = np.array([shape.radius for shape in shapes], np.float64)
        bare = parts_of(points)
        mask.fitted["outline parts"] = with_boxes(bare.corners, bare.counts, radii)
    return mask.fitted["outline parts"]


def parts_near(parts: Parts, left: float, top: float, right: float, bottom: float) -> Parts:
    """Return the parts whose boxes meet a closed box [px], enlarged by a rounding margin."""
    reach = NEAR * max(map(abs, (left, top, right, bottom)))
    low, high = parts.boxes[:, :2], parts.boxes[:, 2:]
    keep = (low <= (right + reach, bottom + reach)).all(axis=1) & (high >= (left - reach, top - reach)).all(axis=1)
    return Parts(*(column[keep] for column in parts))


def rectangle(left: float, top: float, right: float, bottom: float) -> list[tuple[float, float]]:
    """Return the corners of a box, clockwise on the screen."""
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


def tile_outlines(grid: TileGrid, x: float, y: float, feet: float) -> list:
    """Return the outlines of a TileGrid whose origin is at (x, y) [px].

    feet [px]: the lowest point of the other shape, relative to the grid's origin. A one-way tile is present, as its top
    edge, only for shapes wholly above it.
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
    """Return the outlines of a mask's pixels at an angle bucket, with the raster's top left corner at (x, y) [px]."""
    return [rectangle(x + left, y + top, x + right, y + bottom) for left, top, right, bottom in mask.blocks(bucket)]


def exact_outlines(mask: PixelMask, x: float, y: float, angle: float) -> list:
    """Return the outlines of the pixels of a mask that is not snapped, with its body at a pose."""
    cosine, sine = turn_of_mask(angle)
    turn = np.array([[cosine, sine], [-sine, cosine]])
    blocks = mask_outlines(mask, 0, -mask.origin[0], -mask.origin[1])
    return [np.array(block) @ turn + (x, y) for block in blocks]


def chain_outlines(chain: Chain) -> list:
    """Return both ends of each link in body space [px]."""
    points = list(chain.points) + ([chain.points[0]] if chain.loop else [])
    return list(pairwise(points))


def placed_parts(
    library: Library, bodies: np.ndarray, shapes: np.ndarray, row: int, x: float, y: float, feet: float
) -> Parts:
    """Return the parts of a SHAPE row at its present pose, relative to (x, y) [px].

    A mask is represented by its pixels, as drawn if it is snapped. feet [px]: the lowest point of the other shape, see
    tile_outlines.
    """
    shape, placed = library.shape_of(shapes[row]), shapes[row]
    body = bodies[placed["body_row"]]
    at_x, at_y = float(body["x"]) - x, float(body["y"]) - y
    if isinstance(shape, Bounds):
        return parts_of([rectangle(placed["min_x"] - x, placed["min_y"] - y, placed["max_x"] - x, placed["max_y"] - y)])
    if isinstance(shape, TileGrid):
        return parts_of(tile_outlines(shape, at_x, at_y, feet - float(body["y"])))
    if isinstance(shape, PixelMask) and not shape.snap:
        return parts_of(exact_outlines(shape, at_x, at_y, float(body["angle"])))
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


def swept_parts(
    library: Library, bodies: np.ndarray, shapes: np.ndarray, row: int, x: float, y: float, feet: float
) -> Parts:
    """Return the same as placed_parts for sweeps and casts: a mask is represented by its outline at the exact pose."""
    shape = library.shape_of(shapes[row])
    if not isinstance(shape, PixelMask):
        return placed_parts(library, bodies, shapes, row, x, y, feet)
    body = bodies[shapes[row]["body_row"]]
    cosine, sine = turn_of_mask(float(body["angle"]))
    return turned_parts(outline_parts(shape), float(body["x"]) - x, float(body["y"]) - y, cosine, sine)
