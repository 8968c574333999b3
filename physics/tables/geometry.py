"""Flat tables of the geometry of all shapes of a world: corners, tiles, links, pixels."""

from typing import NamedTuple

import numpy as np

GRID = np.dtype(
    [  # one row for each TileGrid
        ("offset", np.int64),  # index of the first cell in Geometry.cells
        ("rows", np.int64),
        ("columns", np.int64),
        ("tile_size", np.float64),  # [px]
    ],
    align=True,
)

EMPTY, SOLID, ONE_WAY, SLOPE = 0, 1, 2, 3  # kinds of cells
CHAIN_SPAN = np.dtype(
    [  # one row for each Chain
        ("offset", np.int64),  # index of the first link in Geometry.links
        ("count", np.int64),  # number of links
        ("first_block", np.int64),  # index in Geometry.link_blocks
        ("blocks", np.int64),  # number of blocks
    ],
    align=True,
)

LINK = np.dtype(
    [  # [px] in body space; solid from the side of (dy, -dx)
        ("ax", np.float64),
        ("ay", np.float64),
        ("bx", np.float64),
        ("by", np.float64),
        ("before_x", np.float64),  # far ends of the neighbours before a and after b
        ("before_y", np.float64),
        ("after_x", np.float64),
        ("after_y", np.float64),
        ("has_before", np.bool_),  # a neighbour or ghost vertex exists before a (after b); otherwise the end is open
        ("has_after", np.bool_),
        ("first_owned", np.bool_),  # this link reports contacts at its corner a (b)
        ("last_owned", np.bool_),
        ("friction", np.float64),  # of the link's own material; -1: use the shape's value
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s] nan: use the shape's value
    ],
    align=True,
)

LINK_BLOCK = np.dtype(
    [  # AABB [px] in body space of consecutive links, with which a query skips whole blocks of a long chain
        ("min_x", np.float64),
        ("min_y", np.float64),
        ("max_x", np.float64),
        ("max_y", np.float64),
    ],
    align=True,
)

BLOCK_LINKS = 16
RASTER = np.dtype(
    [  # one row for each mask and angle at which the mask was drawn
        ("offset", np.int64),  # index of the first word in Geometry.words
        ("width", np.int64),  # [px]
        ("height", np.int64),
        ("stride", np.int64),  # words per row
        ("origin_x", np.float64),  # [px] body's origin relative to the raster's top left corner
        ("origin_y", np.float64),
        ("set_left", np.int64),  # [px] bounds of the solid pixels; left > right for a raster without any
        ("set_top", np.int64),
        ("set_right", np.int64),  # exclusive
        ("set_bottom", np.int64),
        ("area", np.int64),  # [px2]
        ("halo", np.int64),  # index of the first word of the halo, see raster/exact.py; -1: none, only drawn
        ("halo_stride", np.int64),  # words per row of the halo
        ("hull", np.int64),  # index of the first corner of the convex hull, in body space
        ("hull_count", np.int64),  # number of corners of the hull; 0: no hull
    ],
    align=True,
)


SPAN = np.dtype([("offset", np.int64), ("count", np.int64)])
CORNER = np.dtype([("x", np.float64), ("y", np.float64)])
CELL = np.dtype(
    [("kind", np.int64), ("left", np.float64), ("right", np.float64), ("first", np.int64), ("last", np.int64)]
)  # first, last: first and last column of the sequence of equal cells that contains this cell


class Geometry(NamedTuple):
    """Geometry of all shapes of a world as flat tables for kernels."""

    polygons: np.ndarray  # SPAN of corners for each polygon; capsules and segments are hulls of two corners
    corners: np.ndarray  # CORNER [px] in body space, clockwise on the screen
    chains: np.ndarray  # CHAIN_SPAN
    links: np.ndarray  # LINK
    link_blocks: np.ndarray  # LINK_BLOCK
    grids: np.ndarray  # GRID
    cells: np.ndarray  # CELL: kind, surface heights of a slope as fractions of a tile, equal neighbours
    rasters: np.ndarray  # RASTER
    words: np.ndarray  # uint64 pixels of all rasters
    raster_of: np.ndarray  # (masks, angle buckets) RASTER row, -1 for a bucket that has not been drawn yet
