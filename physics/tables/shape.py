"""Row types of shapes: SHAPE, one row per shape of a body, and PROXY, the AABB of a shape in the broad phase."""

import math

import numpy as np

from physics.tables.table import in_lines

# ---- proxy -----------------------------------------------------------------------------------------------------------

PROXY = np.dtype(
    [  # one slot for each shape in the broad phase; slots are reused
        ("lower_x", np.float64),  # [px] swept AABB
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("row", np.int64),  # SHAPE row in this step; -1: the slot is free
        ("awake", np.bool_),  # a step visits the body: two proxies that are not awake never pair
        ("still", np.bool_),  # static: two still proxies never pair
        ("changed", np.bool_),  # box, filter or existence changed since the last update
        ("idle", np.int8),  # steps without motion for which the swept AABB was kept, see STEPS_AHEAD
        ("body", np.int64),  # id: two shapes of one body never pair
        ("membership", np.int64),
        ("mask", np.int64),
        ("plane", np.int64),  # one bit: role of the shape in the broad phase
        ("avoids", np.int64),  # bits of the planes with which the shape never pairs, regardless of filters
    ],
    align=True,
)


# ---- shape -----------------------------------------------------------------------------------------------------------
# Rows of SHAPE are in the order of ids.

CIRCLE, POLYGON, BOUNDS, TILES, MASK, CAPSULE, SEGMENT, CHAIN = 0, 1, 2, 3, 4, 5, 6, 7
# Roles of a row. In worlds with collision response a mask has two kinds of rows. PIXELS is the mask itself, for tests
# by pixels. PARTs are the convex parts of its outline, for response, sweeps, casts and characters.
WHOLE, PIXELS, PART = 0, 1, 2
SHARPEST = 0.5 * math.pi  # [rad] greatest turn of an outline at a blunt corner of a part
TURNS = 32766.0 / SHARPEST  # [1/rad] scale of a turn stored in 15 bits
WHOLE_MASK = -1  # tile number of a row that belongs to no tile
SHAPE = in_lines(
    [  # ordered by use: the first cache line holds the fields that every candidate needs
        ("min_x", np.float64),  # [px] least corner of the tight AABB at the final pose of the step
        ("min_y", np.float64),
        ("max_x", np.float64),  # [px] its greatest corner
        ("max_y", np.float64),
        ("body_row", np.int64),  # row in world.bodies
        ("id", np.int64),  # given once, never used again
        ("kind", np.int64),  # CIRCLE 0, POLYGON 1, BOUNDS 2, TILES 3, MASK 4, CAPSULE 5, SEGMENT 6, CHAIN 7
        ("sensor", np.bool_),  # it reports overlaps and does not push
        ("snap", np.bool_),  # a mask that is tested as drawn, on the pixel grid; otherwise at its exact pose
        ("own_material", np.bool_),  # the material is set on the shape, not on the body
        ("own_filter", np.bool_),  # likewise the filter
        ("own_sensor", np.bool_),  # likewise the sensor flag
        ("parent", np.int64),  # id of the mask of which this shape is a part; otherwise the id of the shape
        ("role", np.int64),  # WHOLE 0, PIXELS 1, PART 2
        ("geometry", np.int64),  # row of the corners, grids (TILES), masks (MASK) or chains (CHAIN); -1: none
        ("radius", np.float64),  # [px] radius of a circle or capsule, rounding of a polygon
        ("friction", np.float64),  # see Material
        ("restitution", np.float64),  # see Material
        ("rolling_resistance", np.float64),  # see Material
        ("surface_speed", np.float64),  # [px/s] along the tangent, see Material
        ("raster", np.int64),  # raster of a mask at its body's angle
        ("left", np.int64),  # [px] pixel column of the drawing of a mask
        ("top", np.int64),  # [px] pixel row of the drawing of a mask
        # Four 16-bit fields: polygon edges inside the parent shape, which push nothing out; corners that other parts
        # cover; corners that are blunter in the outline than in this part; the greatest turn of the outline at these
        # blunter corners. See outline/tile_seams.py.
        ("inner", np.int64),  # edges and corners of a part that lie inside its mask, as bits
        ("tile", np.int64),  # tile of a large mask that contains a PART; otherwise WHOLE_MASK
        ("body", np.int64),  # id
        ("local_x", np.float64),  # [px] centre of a circle, in body space
        ("local_y", np.float64),
        ("wrapped", np.int64),  # kind of the shape that a BOUNDS encloses
        ("membership", np.int64),  # 32 bits
        ("mask", np.int64),  # 32 bits
        ("density", np.float64),  # [mass per px2]
        ("proxy", np.int64),  # slot in the broad phase, -1: none
    ]
)
