"""Flat tables of the geometry of all shapes of a world: corners, tiles, links, pixels."""

from typing import NamedTuple

import numpy as np

GRID = np.dtype(
    [  # one per TileGrid
        ("offset", np.int64),  # first cell in the flat cell arrays
        ("rows", np.int64),
        ("columns", np.int64),
        ("tile_size", np.float64),  # [px]
    ],
    align=True,
)

EMPTY, SOLID, ONE_WAY, SLOPE = 0, 1, 2, 3  # kinds of cells
CHAIN_SPAN = np.dtype(
    [  # one per Chain
        ("offset", np.int64),  # first link
        ("count", np.int64),  # links
        ("first_block", np.int64),
        ("blocks", np.int64),
    ],
    align=True,
)

LINK = np.dtype(
    [  # [px] in body space; solid from the side of (dy, -dx)
        ("ax", np.float64),
        ("ay", np.float64),
        ("bx", np.float64),
        ("by", np.float64),
        ("before_x", np.float64),
        ("before_y", np.float64),  # the far ends of its neighbours
        ("after_x", np.float64),
        ("after_y", np.float64),
        ("has_before", np.bool_),
        ("has_after", np.bool_),  # whether it has a listed neighbour or a ghost there; else the end is open
        ("first_owned", np.bool_),
        ("last_owned", np.bool_),  # this link reports contacts at its corner a (b)
        ("friction", np.float64),  # of its own material, -1: the shape's
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s] nan: the shape's
    ],
    align=True,
)

LINK_BLOCK = np.dtype(
    [  # AABB [px, body space] of consecutive links; a query skips long chains block by block
        ("min_x", np.float64),
        ("min_y", np.float64),
        ("max_x", np.float64),
        ("max_y", np.float64),
    ],
    align=True,
)

BLOCK_LINKS = 16
RASTER = np.dtype(
    [  # one per mask and angle at which it was drawn
        ("offset", np.int64),  # first word in the flat word array
        ("width", np.int64),  # [px]
        ("height", np.int64),
        ("stride", np.int64),  # words per row
        ("origin_x", np.float64),  # [px] of the body's origin from the raster's top left corner
        ("origin_y", np.float64),
        ("set_left", np.int64),  # [px] bounds of the solid pixels; left > right for a raster without any
        ("set_top", np.int64),
        ("set_right", np.int64),  # exclusive
        ("set_bottom", np.int64),
        ("area", np.int64),  # [px2]
        ("halo", np.int64),  # first word of its halo, see raster/exact.py; -1: none, it is only drawn
        ("halo_stride", np.int64),  # words per row
        ("hull", np.int64),  # first of the corners of its convex hull, in body space
        ("hull_count", np.int64),  # 0: none
    ],
    align=True,
)


SPAN = np.dtype([("offset", np.int64), ("count", np.int64)])
CORNER = np.dtype([("x", np.float64), ("y", np.float64)])
CELL = np.dtype(
    [("kind", np.int64), ("left", np.float64), ("right", np.float64), ("first", np.int64), ("last", np.int64)]
)  # first, last: columns of the run of equal cells that it belongs to


class Geometry(NamedTuple):
    """The geometry of all shapes of a world as flat tables, which kernels read."""

    polygons: np.ndarray  # SPAN of corners: polygons; capsules and segments as hulls of two corners
    corners: np.ndarray  # CORNER [px] in body space, clockwise on the screen
    chains: np.ndarray  # CHAIN_SPAN
    links: np.ndarray  # LINK
    link_blocks: np.ndarray  # LINK_BLOCK
    grids: np.ndarray  # GRID
    cells: np.ndarray  # CELL: kind, surface heights of a slope as fractions, the run it belongs to
    rasters: np.ndarray  # RASTER
    words: np.ndarray  # uint64 pixels of all rasters
    raster_of: np.ndarray  # (masks, buckets) raster row, -1 for an angle bucket that is not drawn yet
