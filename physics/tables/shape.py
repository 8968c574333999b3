"""SHAPE: one row per shape of a body, in the order of ids. PROXY: its box in the broad phase."""

import math

import numpy as np

from physics.tables.table import in_lines

# ---- proxy -----------------------------------------------------------------------------------------------------------
# PROXY: what a broad phase sees of a shape.

PROXY = np.dtype(
    [  # what a broad phase sees; slots are reused
        ("lower_x", np.float64),  # [px] bounding motion rectangle
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("row", np.int64),  # of the shape, this step; -1: the slot is free
        ("awake", np.bool_),  # in the rows that a step goes over: two that are not never pair
        ("still", np.bool_),  # static: two still proxies never pair
        ("changed", np.bool_),  # box, filter or existence changed since the last update
        ("body", np.int64),  # id: two shapes of one body never pair
        ("membership", np.int64),
        ("mask", np.int64),
        ("plane", np.int64),  # one bit: what it is there for, and …
        ("avoids", np.int64),  # … what it never pairs with, whatever the filters say
    ],
    align=True,
)


# ---- shape -----------------------------------------------------------------------------------------------------------
# SHAPE: one row per shape of a body, in the order of ids; and the kinds of shapes.

CIRCLE, POLYGON, BOUNDS, TILES, MASK, CAPSULE, SEGMENT, CHAIN = 0, 1, 2, 3, 4, 5, 6, 7
# What a row is there for. Where bodies are pushed a mask has two kinds of rows: itself for who asks for its pixels, and
# the convex parts of its outline for all that is pushed, swept, cast and walked on.
WHOLE, PIXELS, PART = 0, 1, 2
SHARPEST = 0.5 * math.pi  # [rad] by how much an outline may turn at a blunt corner of one of its parts
TURNS = 32766.0 / SHARPEST  # [1/rad] that is told in 15 bits
WHOLE_MASK = -1  # the tile of what is not part of a tile
SHAPE = in_lines(
    [  # by who asks for them: first what is looked at of every candidate, in one line of a cache
        ("min_x", np.float64),  # [px] tight AABB at the final pose of the step
        ("min_y", np.float64),
        ("max_x", np.float64),
        ("max_y", np.float64),
        ("body_row", np.int64),
        ("id", np.int64),
        ("kind", np.int64),  # CIRCLE POLYGON BOUNDS TILES MASK CAPSULE SEGMENT CHAIN
        ("sensor", np.bool_),
        ("snap", np.bool_),  # a mask that is tested as drawn, on the pixel grid; else at its exact pose
        ("own_material", np.bool_),  # the shape's own, whatever its body says
        ("own_filter", np.bool_),
        ("own_sensor", np.bool_),
        ("owner", np.int64),  # id of the shape that it is a part of; else its own
        ("role", np.int64),  # WHOLE PIXELS PART
        ("geometry", np.int64),  # row of the corners, grids (TILES), masks (MASK) or chains (CHAIN); -1: none
        ("radius", np.float64),  # [px] of a circle or capsule, or of a polygon's rounding
        ("friction", np.float64),
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s] along the tangent, see Material
        ("raster", np.int64),  # of a mask at its body's angle, and the pixel column and row it is drawn at
        ("left", np.int64),
        ("top", np.int64),
        ("inner", np.int64),  # 16 bits each: the edges that lie inside its owner, as nothing may be pushed out through
        # them; the corners that other parts cover; the corners that seem sharper than the outline is there; by how much
        # it turns at them at most, see fitting.tile_seams
        ("tile", np.int64),  # number of the tile of a large mask that a PART lies in, else WHOLE_MASK
        ("body", np.int64),  # id
        ("local_x", np.float64),  # [px] centre of a circle, in body space
        ("local_y", np.float64),
        ("wrapped", np.int64),  # kind inside a BOUNDS
        ("membership", np.int64),  # 32 bits
        ("mask", np.int64),  # 32 bits
        ("density", np.float64),
        ("proxy", np.int64),  # slot in the broad phase, -1 while it has none
    ]
)
