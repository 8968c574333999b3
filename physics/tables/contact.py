"""CONTACT, MANIFOLD, ANCHOR and CONSTRAINT: a contact as it is reported, found, remembered and solved."""

import numpy as np

from physics.tables.table import in_lines

# ---- contact ---------------------------------------------------------------------------------------------------------
# What the world tells of a step: contacts, one row per point; events; bodies that broke.

CONTACT = np.dtype(
    [
        ("body_a", np.int64),  # ids; A is the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),
        ("shape_b", np.int64),
        ("point_x", np.float64),  # [px] midway between the two surfaces
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] negative where they overlap
        ("normal_impulse", np.float64),  # of the whole step
        ("tangent_impulse", np.float64),
        ("area", np.float64),  # [px2] that two masks share; 0 for other shapes
        ("feature", np.int64),  # which corner, edge, tile or pixel it came from
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


# ---- manifold --------------------------------------------------------------------------------------------------------
# MANIFOLD: where two shapes touch, as a collider found it; ANCHOR: what a solver remembers of it.
#
# Rows of both stand in the order of shape ids, and belong together: only worlds that stack have anchors. A manifold has
# one normal and one or two points; shapes that touch with several normals, as on tiles, have several manifolds. Fields
# stand by who asks for them: a pass over ten thousand contacts is as fast as the lines of the cache that it touches.

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
        ("lead", np.float64),  # [px] that B slides along the tangent (-ny, nx) before they touch; see hull_pairs.py
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


# ---- constraint ------------------------------------------------------------------------------------------------------
# What a solver works on: the motions of bodies and the constraints between them.

# One row per awake body, and the first for all that stands: what a solver reads and changes in its substeps. A row is
# three lines of a processor's cache: what every pass over the constraints needs is in the first of them.
MOTION = in_lines(
    [
        ("vx", np.float64),
        ("vy", np.float64),
        ("angular_velocity", np.float64),
        ("dx", np.float64),
        ("dy", np.float64),  # [px] of the centre of mass since the step began
        ("cosine", np.float64),
        ("sine", np.float64),  # of the turn since the step began
        ("moves", np.bool_),
        ("pushed", np.bool_),  # is integrated; feels drag and acceleration
        ("pressed", np.bool_),  # something acts on it in this substep, or it lies on something: it does not fly freely
        ("walks", np.bool_),  # a character: what lies under its feet bears it, and is not held down by it
        ("inverse_mass", np.float64),
        ("inverse_inertia", np.float64),  # 0 for what this step does not push
        ("free_vx", np.float64),  # the velocity in this substep before any contact acted
        ("free_vy", np.float64),
        ("free_w", np.float64),
        ("acceleration_x", np.float64),
        ("acceleration_y", np.float64),
        ("angular_acceleration", np.float64),
        ("turn", np.float64),  # [rad]
        ("push_vx", np.float64),  # that lets overlaps out: it moves a body in this substep, and is none of its velocity
        ("push_vy", np.float64),
        ("push_w", np.float64),
        ("demand", np.float64),  # square of the substeps that would keep its contacts within the accuracy
        ("eased", np.float64),  # [s] for which fewer substeps would have done, or, below 0, the most were too few
        ("substeps", np.int64),  # that its island takes, and then: is to take in the next step
        ("hits", np.int64),  # see solver/hits
        ("crowded", np.bool_),  # one of its island touches more than one thing below it and one above
        ("overloaded", np.bool_),  # more substeps than these, and than a load may ask for, would be needed
    ]
)

CONSTRAINT = np.dtype(
    [  # one per manifold, in the order of colours: up to two points on one normal
        ("motion_a", np.int32),  # rows of MOTION
        ("motion_b", np.int32),
        ("manifold", np.int32),  # its row, and the number of its points
        ("count", np.int32),
        ("block", np.int32),  # and lane that it stood in, see solver/lane_contacts
        ("lane", np.int32),
        ("before", np.int32),  # another of the same body, see solver/hits …
        ("linked", np.bool_),
        ("played", np.bool_),  # … and whether its hits were told there, …
        ("met_1", np.float64),  # [px/s] the speed that each point would meet with
        ("met_2", np.float64),
        ("gap_1", np.float64),  # [px] until then
        ("gap_2", np.float64),
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
        ("calm", np.bool_),  # nothing approached before the step
        ("loaded", np.bool_),  # it bore something in the step before
        ("meets", np.bool_),  # both sides near each other, fast enough to bounce
        ("rests", np.bool_),  # both sides touched before the step, too slow to bounce
        ("alone", np.bool_),  # its faces stick, and nothing but it bears the one side on the other
        ("still", np.bool_),  # one side cannot be pushed: the contact is twice as stiff
        ("couple_1", np.float64),  # change of the first impulse per second, and …
        ("couple_2", np.float64),  # … of the second per first, for the same speeds; 0 where there is but one
        ("split", np.float64),  # see two_points
        ("ax_1", np.float64),
        ("ay_1", np.float64),
        ("bx_1", np.float64),
        ("by_1", np.float64),  # [px] arms from the centres
        ("base_1", np.float64),  # [px] separation less the arms' part
        ("normal_mass_1", np.float64),
        ("tangent_mass_1", np.float64),
        ("normal_impulse_1", np.float64),
        ("tangent_impulse_1", np.float64),  # of this substep
        ("push_impulse_1", np.float64),
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
        ("push_impulse_2", np.float64),
        ("normal_total_2", np.float64),
        ("tangent_total_2", np.float64),
    ],
    align=True,
)

PUSH = np.dtype(
    [  # one per point, for the solvers that remember nothing, in the order of shape ids
        ("manifold", np.int32),  # its row, and which of its points
        ("second", np.bool_),
        ("swept", np.bool_),  # met on the way
        ("body_row_a", np.int32),
        ("body_row_b", np.int32),
        ("x", np.float64),  # [px] the point, where it was detected
        ("y", np.float64),
        ("normal_x", np.float64),
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] when it was detected
        ("anchor_x", np.float64),  # [px] centre of B seen from A's then
        ("anchor_y", np.float64),
        ("speed", np.float64),  # [px/s] approach before the response
        ("friction", np.float64),  # mixed
        ("restitution", np.float64),
        ("surface_speed", np.float64),
        ("rolling_limit", np.float64),  # [px] torque per normal impulse
        ("normal_impulse", np.float64),
        ("tangent_impulse", np.float64),
        ("rolling_impulse", np.float64),
    ],
    align=True,
)
