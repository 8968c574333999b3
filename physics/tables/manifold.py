"""MANIFOLD: where two shapes touch, as a collider found it; ANCHOR: what a solver remembers of it.

Rows of both stand in the order of shape ids, and belong together: only worlds that stack have anchors. A manifold has
one normal and one or two points; shapes that touch with several normals, as on tiles, have several manifolds.
"""

import numpy as np

MANIFOLD = np.dtype(
    [
        ("body_a", np.int64),  # ids; A is the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),
        ("shape_b", np.int64),
        ("owner_a", np.int64),  # ids of the shapes that these are parts of
        ("owner_b", np.int64),
        ("body_row_a", np.int32),  # rows of BODY and SHAPE, this step
        ("body_row_b", np.int32),
        ("row_a", np.int32),
        ("row_b", np.int32),
        ("candidate", np.int32),  # row of the pair it came from
        ("previous", np.int32),  # row of the same manifold in the step before, used again as it was; -1: found anew
        ("count", np.int64),  # of its points
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("lead", np.float64),  # [px] that B slides along the tangent (-ny, nx) before they touch; see ahead.py
        ("sensor", np.bool_),
        ("swept", np.bool_),  # met on the way, not at the end of the step
        ("persisted_1", np.bool_),  # the same feature was in contact in the step before
        ("persisted_2", np.bool_),
        ("x_1", np.float64),  # [px] midway between the two surfaces
        ("y_1", np.float64),
        ("separation_1", np.float64),  # [px] negative where they overlap
        ("area_1", np.float64),  # [px2] that two masks share; 0 for other shapes
        ("feature_1", np.int64),  # which corner, edge, tile or pixel it came from: see collision/features
        ("speed_1", np.float64),  # [px/s] approach along the normal before the response
        ("normal_impulse_1", np.float64),  # of the whole step
        ("tangent_impulse_1", np.float64),
        ("normal_impulse_2", np.float64),  # here, as they are written whether there is a second point or not
        ("tangent_impulse_2", np.float64),
        ("x_2", np.float64),
        ("y_2", np.float64),
        ("separation_2", np.float64),
        ("area_2", np.float64),
        ("feature_2", np.int64),
        ("speed_2", np.float64),
    ],
    align=True,
)

WITH_A, WITH_B, CORES, UPRIGHT = 0, 1, 2, 3  # what a normal turns with: a side, from core to core, or nothing

ANCHOR = np.dtype(
    [
        ("frame", np.int64),  # WITH_A WITH_B CORES UPRIGHT
        ("local_nx", np.float64),  # the normal in the body space of `frame`
        ("local_ny", np.float64),
        ("angle_a", np.float64),  # [rad] of the bodies when it was detected
        ("angle_b", np.float64),
        ("held_nx", np.float64),  # the normal then, in the world
        ("held_ny", np.float64),
        ("apart_x", np.float64),  # [px] B's centre of mass seen from A's then
        ("apart_y", np.float64),
        ("radius_a", np.float64),  # [px] from the core to the surface
        ("radius_b", np.float64),
        ("friction", np.float64),  # mixed
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),  # [px] mixed coefficient times the greater radius
        ("surface_speed", np.float64),  # [px/s] summed
        ("rolling_force", np.float64),  # impulse per second that the next step starts from
        ("color", np.int64),  # of its constraint in the last solve, -1: none
        ("local_ax_1", np.float64),  # [px] the point on A's core, in A's body space: of a circle the centre, of what is
        ("local_ay_1", np.float64),  # rounded the corner or edge inside
        ("local_bx_1", np.float64),
        ("local_by_1", np.float64),
        ("held_ax_1", np.float64),  # [px] the point seen from A's centre of mass then, in the world
        ("held_ay_1", np.float64),
        ("share_1", np.float64),  # where along the face the point is: 0 at A's core, 1 at B's, between them 0.5
        ("base_1", np.float64),  # [px] separation when it was detected
        ("normal_force_1", np.float64),  # impulse per second that the next step starts from
        ("tangent_force_1", np.float64),
        ("local_ax_2", np.float64),
        ("local_ay_2", np.float64),
        ("local_bx_2", np.float64),
        ("local_by_2", np.float64),
        ("held_ax_2", np.float64),
        ("held_ay_2", np.float64),
        ("share_2", np.float64),
        ("base_2", np.float64),
        ("normal_force_2", np.float64),
        ("tangent_force_2", np.float64),
    ],
    align=True,
)
