"""Every table: one row per thing, one scalar field per line, with its unit.

Rows are kept in the order of ids, so the order of rows is the canonical order of everything. A row number changes
when an earlier row is removed; an id never changes and is never given twice.
"""

import numpy as np

STATIC, KINEMATIC, DYNAMIC = 0, 1, 2
KINDS = ("static", "kinematic", "dynamic")
CIRCLE, POLYGON, BOUNDS, TILES, MASK = 0, 1, 2, 3, 4
CONTINUOUS = ("off", "ray", "swept", "auto")
OFF, RAY, SWEPT, AUTO = 0, 1, 2, 3

BODY = np.dtype([
    ("id", np.int64),
    ("kind", np.int64),                # STATIC KINEMATIC DYNAMIC
    ("x", np.float64),                 # [px] origin
    ("y", np.float64),
    ("angle", np.float64),             # [rad] clockwise on the screen
    ("vx", np.float64),                # [px/s] of the centre of mass
    ("vy", np.float64),
    ("angular_velocity", np.float64),  # [rad/s]
    ("center_x", np.float64),          # [px] centre of mass in the world; refreshed when the body moves
    ("center_y", np.float64),
    ("mass", np.float64),              # [density px2] 0 where it has none
    ("inertia", np.float64),           # [density px4] about the centre of mass
    ("awake", np.bool_),
    ("inverse_mass", np.float64),      # 0 = cannot be pushed
    ("inverse_inertia", np.float64),   # 0 = cannot be turned
    ("local_center_x", np.float64),    # [px] centre of mass in body space
    ("local_center_y", np.float64),
    ("gravity_scale", np.float64),
    ("force_x", np.float64),           # collected since the last step
    ("force_y", np.float64),
    ("torque", np.float64),
    ("previous_x", np.float64),        # [px] pose before the step: for interpolated drawing and for rolling back
    ("previous_y", np.float64),
    ("previous_angle", np.float64),
    ("settled_x", np.float64),         # [px] last pose that was seen to be finite
    ("settled_y", np.float64),
    ("settled_angle", np.float64),
    ("smallest_half", np.float64),     # [px] smallest half extent of its shapes: what "fast" is measured by
    ("continuous", np.int64),          # OFF RAY SWEPT AUTO
    ("fixed_rotation", np.bool_),
    ("sleep_time", np.float64),        # [s]
    ("quarantined", np.bool_),         # out of the simulation after it stopped being finite
    ("fraction", np.float64),          # of this step's motion that was free, 1 when nothing was in the way
], align=True)

SHAPE = np.dtype([
    ("id", np.int64),
    ("body", np.int64),                # id
    ("body_row", np.int64),
    ("kind", np.int64),                # CIRCLE POLYGON BOUNDS TILES MASK
    ("geometry", np.int64),            # row of the corners (POLYGON), grids (TILES) or masks (MASK); -1: none
    ("local_x", np.float64),           # [px] centre of a circle, in body space
    ("local_y", np.float64),
    ("radius", np.float64),            # [px] of a circle
    ("wrapped", np.int64),             # kind inside a BOUNDS
    ("membership", np.int64),          # 32 bits
    ("mask", np.int64),                # 32 bits
    ("sensor", np.bool_),
    ("density", np.float64),
    ("friction", np.float64),
    ("restitution", np.float64),
    ("proxy", np.int64),               # slot in the broad phase, -1 while it has none
    ("raster", np.int64),              # of a mask at its body's angle, and the pixel column and row it is drawn at
    ("left", np.int64),
    ("top", np.int64),
    ("min_x", np.float64),             # [px] tight AABB at the final pose of the step
    ("min_y", np.float64),
    ("max_x", np.float64),
    ("max_y", np.float64),
], align=True)

PROXY = np.dtype([                     # what a broad phase sees; slots are reused
    ("lower_x", np.float64),           # [px] bounding motion rectangle
    ("lower_y", np.float64),
    ("upper_x", np.float64),
    ("upper_y", np.float64),
    ("row", np.int64),                 # of the shape, this step; -1: the slot is free
    ("body", np.int64),                # id: two shapes of one body never pair
    ("membership", np.int64),
    ("mask", np.int64),
    ("still", np.bool_),               # static: two still proxies never pair
    ("changed", np.bool_),             # box, filter or existence changed since the last update
], align=True)

GRID = np.dtype([                      # one per TileGrid
    ("offset", np.int64),              # first cell in the flat cell arrays
    ("rows", np.int64),
    ("columns", np.int64),
    ("tile_size", np.float64),         # [px]
], align=True)
EMPTY, SOLID, ONE_WAY, SLOPE = 0, 1, 2, 3          # what a cell is

RASTER = np.dtype([                    # one per mask and angle it was drawn at
    ("offset", np.int64),              # first word in the flat word array
    ("width", np.int64),               # [px]
    ("height", np.int64),
    ("stride", np.int64),              # words per row
    ("origin_x", np.float64),          # [px] of the body's origin from the raster's top left corner
    ("origin_y", np.float64),
    ("set_left", np.int64),            # [px] bounds of the solid pixels; left > right when there is none
    ("set_top", np.int64),
    ("set_right", np.int64),           # exclusive
    ("set_bottom", np.int64),
    ("area", np.int64),                # [px2]
], align=True)

CHARACTER = np.dtype([                 # one per Character: moves in whole pixels
    ("body", np.int64),                # id
    ("body_row", np.int64),
    ("left", np.int64), ("top", np.int64),            # [px] pixel column and row of its box
    ("width", np.int64), ("height", np.int64),        # [px]
    ("remainder_x", np.float64), ("remainder_y", np.float64),   # [px] motion that has not made a whole pixel yet
    ("previous_left", np.int64), ("previous_top", np.int64),    # before the last move: for interpolated drawing
    ("riding", np.int64),              # id of the body under its feet that may carry it, -1: none
    ("carried", np.int64),             # [px] by what it rides, along the axis that is being carried
    ("grounded", np.bool_),
    ("squeezed", np.bool_),            # by a solid that it could not give way to, since its last move
    ("pushable", np.bool_),            # solid for the others, and gives way to them
    ("drop", np.bool_),                # falls through one-way tiles in this move
    ("wall", np.int64),                # -1 left, 1 right, 0 none
    ("slope", np.float64),             # rise per px to the right of the ground under its feet
], align=True)

CONTACT = np.dtype([                   # one per point
    ("body_a", np.int64), ("body_b", np.int64),        # ids; A is the shape with the smaller id
    ("shape_a", np.int64), ("shape_b", np.int64),
    ("point_x", np.float64), ("point_y", np.float64),  # [px] midway between the two surfaces
    ("normal_x", np.float64), ("normal_y", np.float64),  # unit, from A to B
    ("separation", np.float64),        # [px] negative where they overlap
    ("normal_impulse", np.float64), ("tangent_impulse", np.float64),
    ("area", np.float64),              # [px2] that two masks share; 0 for other shapes
    ("feature", np.int64),             # which corner, edge, tile or pixel it came from
    ("body_row_a", np.int32), ("body_row_b", np.int32), ("row_a", np.int32), ("row_b", np.int32),
    ("candidate", np.int32),           # row of the pair it came from
    ("anchor_x", np.float64), ("anchor_y", np.float64),  # [px] displacement of B against A when it was detected
    ("friction", np.float64), ("restitution", np.float64),   # mixed
    ("speed", np.float64),             # [px/s] approach along the normal before the response
    ("swept", np.bool_),               # met on the way, not at the end of the step
    ("sensor", np.bool_),
], align=True)

EVENT = np.dtype([("body_a", np.int64), ("body_b", np.int64), ("shape_a", np.int64), ("shape_b", np.int64),
                  ("point_x", np.float64), ("point_y", np.float64),
                  ("normal_x", np.float64), ("normal_y", np.float64)], align=True)
HIT = np.dtype(EVENT.descr + [("speed", np.float64), ("normal_impulse", np.float64)])
QUARANTINE = np.dtype([("body", np.int64), ("reason", "U96")])


class Table:
    """A structured array that grows by doubling; `rows` is the used part."""

    def __init__(self, dtype, capacity=16):
        self.data = np.zeros(capacity, dtype)
        self.count = 0

    @property
    def rows(self):
        return self.data[:self.count]

    def reserve(self, count):
        """Make room for `count` rows, keeping what is there."""
        if count > len(self.data):
            grown = np.zeros(max(count, 2 * len(self.data)), self.data.dtype)
            grown[:self.count] = self.rows
            self.data = grown

    def append(self, count=1):
        """Room for `count` new zeroed rows at the end; returns them."""
        self.reserve(self.count + count)
        added = self.data[self.count:self.count + count]
        added[:] = np.zeros((), self.data.dtype)
        self.count += count
        return added

    def keep(self, flags):
        """Drop the rows whose flag is False; the others keep their order."""
        kept = self.rows[flags]
        self.data[:len(kept)] = kept
        self.count = len(kept)
