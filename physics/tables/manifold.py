"""MANIFOLD: where two shapes touch, as a collider found it; ANCHOR: what a solver remembers of it.

Rows of both stand in the order of shape ids, and belong together: only worlds that stack have anchors. A manifold has
one normal and one or two points; shapes that touch with several normals, as on tiles, have several manifolds. Fields
stand by who asks for them: a pass over ten thousand contacts is as fast as the lines of the cache that it touches.
"""

import numpy as np

from physics.tables.lines import in_lines

MANIFOLD = in_lines(
    [
        ("shape_a", np.int64),  # ids; A is the shape with the smaller id
        ("shape_b", np.int64),
        ("body_row_a", np.int32),  # rows of BODY and SHAPE, this step
        ("body_row_b", np.int32),
        ("row_a", np.int32),
        ("row_b", np.int32),
        ("candidate", np.int32),  # row of the pair it came from
        ("previous", np.int32),  # row of the same manifold in the step before, used again as it was; -1: found anew
        ("count", np.int64),  # of its points
        ("lead", np.float64),  # [px] that B slides along the tangent (-ny, nx) before they touch; see ahead.py
        ("sensor", np.bool_),
        ("swept", np.bool_),  # met on the way, not at the end of the step
        ("persisted_1", np.bool_),  # the same feature was in contact in the step before
        ("persisted_2", np.bool_),
        ("again", np.bool_),  # as it is it will do for the next step, while both bodies stand as this one left them
        # Where it is.
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("x_1", np.float64),  # [px] midway between the two surfaces
        ("y_1", np.float64),
        ("separation_1", np.float64),  # [px] negative where they overlap
        ("x_2", np.float64),
        ("y_2", np.float64),
        ("separation_2", np.float64),
        # What came of it.
        ("speed_1", np.float64),  # [px/s] approach along the normal before the response
        ("speed_2", np.float64),
        ("normal_impulse_1", np.float64),  # of the whole step
        ("tangent_impulse_1", np.float64),
        ("normal_impulse_2", np.float64),
        ("tangent_impulse_2", np.float64),
        ("feature_1", np.int64),  # which corner, edge, tile or pixel it came from: see collision/features
        ("feature_2", np.int64),
        # What is told.
        ("body_a", np.int64),  # ids
        ("body_b", np.int64),
        ("owner_a", np.int64),  # ids of the shapes that these are parts of
        ("owner_b", np.int64),
        ("area_1", np.float64),  # [px2] that two masks share; 0 for other shapes
        ("area_2", np.float64),
    ]
)

WITH_A, WITH_B, CORES, UPRIGHT = 0, 1, 2, 3  # what a normal turns with: a side, from core to core, or nothing

ANCHOR = in_lines(
    [
        # What the solver starts from, and stores.
        ("normal_force_1", np.float64),  # impulse per second that the next step starts from
        ("tangent_force_1", np.float64),
        ("normal_force_2", np.float64),
        ("tangent_force_2", np.float64),
        ("rolling_force", np.float64),
        ("restitution", np.float64),  # mixed, as friction, surface speed and rolling resistance
        ("friction", np.float64),
        ("color", np.int64),  # of its constraint in the last solve, -1: none
        ("surface_speed", np.float64),  # [px/s] summed
        ("rolling_resistance", np.float64),  # [px] mixed coefficient times the greater radius
        # What both sides are, and were when it was detected.
        ("radius_a", np.float64),  # [px] from the core to the surface
        ("radius_b", np.float64),
        ("angle_a", np.float64),  # [rad] of the bodies
        ("angle_b", np.float64),
        ("frame", np.int64),  # WITH_A WITH_B CORES UPRIGHT
        ("local_nx", np.float64),  # the normal in the body space of `frame`
        ("local_ny", np.float64),
        # Each point in the body spaces.
        ("local_ax_1", np.float64),  # [px] the point on A's core, in A's body space: of a circle the centre, of what is
        ("local_ay_1", np.float64),  # rounded the corner or edge inside
        ("local_bx_1", np.float64),
        ("local_by_1", np.float64),
        ("share_1", np.float64),  # where along the face the point is: 0 at A's core, 1 at B's, between them 0.5
        ("base_1", np.float64),  # [px] separation when it was detected
        ("share_2", np.float64),
        ("base_2", np.float64),
        ("local_ax_2", np.float64),
        ("local_ay_2", np.float64),
        ("local_bx_2", np.float64),
        ("local_by_2", np.float64),
        # Where it was in the world then, while it sticks.
        ("apart_x", np.float64),  # [px] B's centre of mass seen from A's
        ("apart_y", np.float64),
        ("held_nx", np.float64),  # the normal
        ("held_ny", np.float64),
        ("held_ax_1", np.float64),  # [px] the point seen from A's centre of mass
        ("held_ay_1", np.float64),
        ("held_ax_2", np.float64),
        ("held_ay_2", np.float64),
    ]
)
