"""Every table: one row per thing, one scalar field per line, with its unit.

Rows are kept in the order of ids, so the order of rows is the canonical order of everything. A row number changes
when an earlier row is removed; an id never changes and is never given twice.
"""

import numpy as np

STATIC, KINEMATIC, DYNAMIC = 0, 1, 2
KINDS = ("static", "kinematic", "dynamic")
CIRCLE, POLYGON, BOUNDS, TILES, MASK, CAPSULE, SEGMENT, CHAIN = 0, 1, 2, 3, 4, 5, 6, 7
CONTINUOUS = ("off", "ray", "swept", "auto", "toi")
OFF, RAY, SWEPT, AUTO, TOI = 0, 1, 2, 3, 4

BODY = np.dtype(
    [
        ("id", np.int64),
        ("kind", np.int64),  # STATIC KINEMATIC DYNAMIC
        ("x", np.float64),  # [px] origin
        ("y", np.float64),
        ("angle", np.float64),  # [rad] clockwise on the screen
        ("vx", np.float64),  # [px/s] of the centre of mass
        ("vy", np.float64),
        ("angular_velocity", np.float64),  # [rad/s]
        ("center_x", np.float64),  # [px] centre of mass in the world; refreshed when the body moves
        ("center_y", np.float64),
        ("mass", np.float64),  # [density px2] 0 where it has none
        ("inertia", np.float64),  # [density px4] about the centre of mass
        ("awake", np.bool_),
        ("inverse_mass", np.float64),  # 0 = cannot be pushed
        ("inverse_inertia", np.float64),  # 0 = cannot be turned
        ("local_center_x", np.float64),  # [px] centre of mass in body space
        ("local_center_y", np.float64),
        ("gravity_scale", np.float64),
        ("force_x", np.float64),  # collected since the last step
        ("force_y", np.float64),
        ("torque", np.float64),
        ("previous_x", np.float64),  # [px] pose before the step: for interpolated drawing and for rolling back
        ("previous_y", np.float64),
        ("previous_angle", np.float64),
        ("settled_x", np.float64),  # [px] last pose that was seen to be finite
        ("settled_y", np.float64),
        ("settled_angle", np.float64),
        ("smallest_half", np.float64),  # [px] smallest half extent of its shapes: what "fast" is measured by
        ("extent", np.float64),  # [px] of the furthest point of its shapes from the centre of mass
        ("continuous", np.int64),  # OFF RAY SWEPT AUTO TOI
        ("bullet", np.bool_),  # swept against moving bodies too
        ("fixed_rotation", np.bool_),
        ("sleep_time", np.float64),  # [s] it has been slow
        ("island", np.int64),  # lowest body id of those it is piled up with, -1: none
        ("quarantined", np.bool_),  # out of the simulation after it stopped being finite
        ("fraction", np.float64),  # of this step's motion that was free, 1 when nothing was in the way
    ],
    align=True,
)

SHAPE = np.dtype(
    [
        ("id", np.int64),
        ("body", np.int64),  # id
        ("body_row", np.int64),
        ("kind", np.int64),  # CIRCLE POLYGON BOUNDS TILES MASK CAPSULE SEGMENT CHAIN
        ("geometry", np.int64),  # row of the corners, grids (TILES), masks (MASK) or chains (CHAIN); -1: none
        ("local_x", np.float64),  # [px] centre of a circle, in body space
        ("local_y", np.float64),
        ("radius", np.float64),  # [px] of a circle or capsule, or of a polygon's rounding
        ("wrapped", np.int64),  # kind inside a BOUNDS
        ("membership", np.int64),  # 32 bits
        ("mask", np.int64),  # 32 bits
        ("sensor", np.bool_),
        ("density", np.float64),
        ("friction", np.float64),
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s] along the tangent, see Material
        ("proxy", np.int64),  # slot in the broad phase, -1 while it has none
        ("raster", np.int64),  # of a mask at its body's angle, and the pixel column and row it is drawn at
        ("left", np.int64),
        ("top", np.int64),
        ("min_x", np.float64),  # [px] tight AABB at the final pose of the step
        ("min_y", np.float64),
        ("max_x", np.float64),
        ("max_y", np.float64),
    ],
    align=True,
)

PROXY = np.dtype(
    [  # what a broad phase sees; slots are reused
        ("lower_x", np.float64),  # [px] bounding motion rectangle
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("row", np.int64),  # of the shape, this step; -1: the slot is free
        ("body", np.int64),  # id: two shapes of one body never pair
        ("membership", np.int64),
        ("mask", np.int64),
        ("still", np.bool_),  # static: two still proxies never pair
        ("changed", np.bool_),  # box, filter or existence changed since the last update
    ],
    align=True,
)

GRID = np.dtype(
    [  # one per TileGrid
        ("offset", np.int64),  # first cell in the flat cell arrays
        ("rows", np.int64),
        ("columns", np.int64),
        ("tile_size", np.float64),  # [px]
    ],
    align=True,
)
EMPTY, SOLID, ONE_WAY, SLOPE = 0, 1, 2, 3  # what a cell is

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
    [  # [px] body space; met from the side of (dy, -dx)
        ("ax", np.float64),
        ("ay", np.float64),
        ("bx", np.float64),
        ("by", np.float64),
        ("before_x", np.float64),
        ("before_y", np.float64),  # the far ends of its neighbours
        ("after_x", np.float64),
        ("after_y", np.float64),
        ("has_before", np.bool_),
        ("has_after", np.bool_),  # a listed neighbour or a ghost; else the end is open
        ("first_owned", np.bool_),
        ("last_owned", np.bool_),  # the corner at a (at b) is this link's to report
        ("friction", np.float64),  # of its own material, -1: the shape's
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s] nan: the shape's
    ],
    align=True,
)
LINK_BLOCK = np.dtype(
    [  # AABB [px, body space] of some links in a row: long chains are skipped by blocks
        ("min_x", np.float64),
        ("min_y", np.float64),
        ("max_x", np.float64),
        ("max_y", np.float64),
    ],
    align=True,
)
BLOCK_LINKS = 16

RASTER = np.dtype(
    [  # one per mask and angle it was drawn at
        ("offset", np.int64),  # first word in the flat word array
        ("width", np.int64),  # [px]
        ("height", np.int64),
        ("stride", np.int64),  # words per row
        ("origin_x", np.float64),  # [px] of the body's origin from the raster's top left corner
        ("origin_y", np.float64),
        ("set_left", np.int64),  # [px] bounds of the solid pixels; left > right when there is none
        ("set_top", np.int64),
        ("set_right", np.int64),  # exclusive
        ("set_bottom", np.int64),
        ("area", np.int64),  # [px2]
    ],
    align=True,
)

CHARACTER = np.dtype(
    [  # one per Character: moves in whole pixels
        ("body", np.int64),  # id
        ("body_row", np.int64),
        ("left", np.int64),
        ("top", np.int64),  # [px] pixel column and row of its box
        ("width", np.int64),
        ("height", np.int64),  # [px]
        ("remainder_x", np.float64),
        ("remainder_y", np.float64),  # [px] motion that has not made a whole pixel yet
        ("previous_left", np.int64),
        ("previous_top", np.int64),  # before the last move: for interpolated drawing
        ("riding", np.int64),  # id of the body under its feet that may carry it, -1: none
        ("carried", np.int64),  # [px] by what it rides, along the axis that is being carried
        ("grounded", np.bool_),
        ("squeezed", np.bool_),  # by a solid that it could not give way to, since its last move
        ("pushable", np.bool_),  # solid for the others, and gives way to them
        ("drop", np.bool_),  # falls through one-way tiles in this move
        ("wall", np.int64),  # -1 left, 1 right, 0 none
        ("slope", np.float64),  # rise per px to the right of the ground under its feet
        ("mass", np.float64),  # [density px2] these all: in worlds that stack
        ("push", np.float64),  # [px/s2] how hard it pushes bodies, per mass
        ("pressed", np.int64),  # id of the body that bore it in the last step, -1: none
        ("foot_x", np.float64),
        ("foot_y", np.float64),  # [px] the point that stood on it
        ("carry_x", np.float64),
        ("carry_y", np.float64),  # [px] motion of what it rides that has not made a whole pixel yet
        ("belt", np.float64),  # [px/s] at which the ground under its feet runs to the right
        ("belt_x", np.float64),  # [px] of that which has not made a whole pixel yet
        ("push_vx", np.float64),
        ("push_vy", np.float64),  # [px/s] of the solid that pushed it in the last step
        ("deep", np.float64),  # [px] it is in something that came into it, after the last step
        ("wedged", np.bool_),  # something under its feet presses it against a ceiling
    ],
    align=True,
)

CONTACT = np.dtype(
    [  # one per point
        ("body_a", np.int64),
        ("body_b", np.int64),  # ids; A is the shape with the smaller id
        ("shape_a", np.int64),
        ("shape_b", np.int64),
        ("point_x", np.float64),
        ("point_y", np.float64),  # [px] midway between the two surfaces
        ("normal_x", np.float64),
        ("normal_y", np.float64),  # unit, from A to B
        ("separation", np.float64),  # [px] negative where they overlap
        ("normal_impulse", np.float64),
        ("tangent_impulse", np.float64),  # of the whole step
        ("area", np.float64),  # [px2] that two masks share; 0 for other shapes
        ("feature", np.int64),  # which corner, edge, tile or pixel it came from
        ("body_row_a", np.int32),
        ("body_row_b", np.int32),
        ("row_a", np.int32),
        ("row_b", np.int32),
        ("candidate", np.int32),  # row of the pair it came from
        ("anchor_x", np.float64),
        ("anchor_y", np.float64),  # [px] displacement of B against A when it was detected
        ("friction", np.float64),
        ("restitution", np.float64),  # mixed
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # mixed, summed [px/s]
        ("local_ax", np.float64),
        ("local_ay", np.float64),  # [px] the point on A's core, in A's body space: of a circle
        ("local_bx", np.float64),
        ("local_by", np.float64),  # the centre, of what is rounded the corner or edge inside
        ("local_nx", np.float64),
        ("local_ny", np.float64),  # the normal in the body space of `frame`
        ("radius_a", np.float64),
        ("radius_b", np.float64),  # [px] from the core to the surface
        ("frame", np.int64),  # 0: the normal turns with A, 1: with B, 2: goes from core to core
        ("turn", np.float64),  # [rad] of B against A when it was detected
        ("base", np.float64),  # [px] separation when it was detected
        ("normal_force", np.float64),
        ("tangent_force", np.float64),  # impulse per second that the next step starts from
        ("rolling_force", np.float64),
        ("color", np.int64),  # of its constraint in the last solve, -1: none
        ("persisted", np.bool_),  # the same feature was in contact in the step before
        ("speed", np.float64),  # [px/s] approach along the normal before the response
        ("swept", np.bool_),  # met on the way, not at the end of the step
        ("sensor", np.bool_),
    ],
    align=True,
)

MOTION = np.dtype(
    [  # one per body: what a solver reads and changes in its substeps
        ("vx", np.float64),
        ("vy", np.float64),
        ("angular_velocity", np.float64),
        ("dx", np.float64),
        ("dy", np.float64),  # [px] of the centre of mass since the step began
        ("cosine", np.float64),
        ("sine", np.float64),  # of the turn since the step began
        ("inverse_mass", np.float64),
        ("inverse_inertia", np.float64),  # 0 for what this step does not push
        ("turn", np.float64),  # [rad]
        ("acceleration_x", np.float64),
        ("acceleration_y", np.float64),
        ("angular_acceleration", np.float64),
        ("moves", np.bool_),
        ("pushed", np.bool_),  # is integrated; feels drag and acceleration
        ("walks", np.bool_),  # a character: what lies under its feet bears it, and is not held down by it
    ],
    align=True,
)

CONSTRAINT = np.dtype(
    [  # one per manifold, in the order of colours: up to two points on one normal
        ("body_row_a", np.int32),
        ("body_row_b", np.int32),
        ("first", np.int32),
        ("count", np.int32),  # its rows of the contact table
        ("normal_x", np.float64),
        ("normal_y", np.float64),
        ("friction", np.float64),
        ("surface_speed", np.float64),
        ("rolling_limit", np.float64),  # [px] torque per normal impulse
        ("rolling_mass", np.float64),
        ("rolling_impulse", np.float64),
        ("radius_a", np.float64),
        ("radius_b", np.float64),  # [px] the separation is measured from core to core
        ("push_share", np.float64),  # of the push-out speed
        ("still", np.bool_),  # one side cannot be pushed: the contact is twice as stiff
        ("ax_1", np.float64),
        ("ay_1", np.float64),
        ("bx_1", np.float64),
        ("by_1", np.float64),  # [px] arms from the centres
        ("base_1", np.float64),  # [px] separation less the arms' part
        ("normal_mass_1", np.float64),
        ("tangent_mass_1", np.float64),
        ("normal_impulse_1", np.float64),
        ("tangent_impulse_1", np.float64),  # of this substep
        ("normal_total_1", np.float64),
        ("tangent_total_1", np.float64),  # of the step
        ("ax_2", np.float64),
        ("ay_2", np.float64),
        ("bx_2", np.float64),
        ("by_2", np.float64),
        ("base_2", np.float64),
        ("normal_mass_2", np.float64),
        ("tangent_mass_2", np.float64),
        ("normal_impulse_2", np.float64),
        ("tangent_impulse_2", np.float64),
        ("normal_total_2", np.float64),
        ("tangent_total_2", np.float64),
    ],
    align=True,
)

EVENT = np.dtype(
    [
        ("body_a", np.int64),
        ("body_b", np.int64),
        ("shape_a", np.int64),
        ("shape_b", np.int64),
        ("point_x", np.float64),
        ("point_y", np.float64),
        ("normal_x", np.float64),
        ("normal_y", np.float64),
    ],
    align=True,
)
HIT = np.dtype(EVENT.descr + [("speed", np.float64), ("normal_impulse", np.float64)])
QUARANTINE = np.dtype([("body", np.int64), ("reason", "U96")])


class Table:
    """A structured array that grows by doubling; `rows` is the used part."""

    def __init__(self, dtype, capacity=16):
        self.data = np.zeros(capacity, dtype)
        self.count = 0

    @property
    def rows(self):
        return self.data[: self.count]

    def reserve(self, count):
        """Make room for `count` rows, keeping what is there."""
        if count > len(self.data):
            grown = np.zeros(max(count, 2 * len(self.data)), self.data.dtype)
            grown[: self.count] = self.rows
            self.data = grown

    def append(self, count=1):
        """Room for `count` new zeroed rows at the end; returns them."""
        self.reserve(self.count + count)
        added = self.data[self.count : self.count + count]
        added[:] = np.zeros((), self.data.dtype)
        self.count += count
        return added

    def keep(self, flags):
        """Drop the rows whose flag is False; the others keep their order."""
        kept = np.flatnonzero(flags)
        first = len(kept) if len(kept) == len(flags) else int(np.argmin(flags))  # what stands before stays where it is
        whole = self.data.view(np.dtype((np.void, self.data.itemsize)))  # rows in one piece, not field by field
        whole[first : len(kept)] = whole[kept[first:]]
        self.count = len(kept)
