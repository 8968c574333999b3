"""Row types of contacts: CONTACT, as they are found, kept and solved; CONTACT_POINT and EVENT, as they are reported."""

import numpy as np

from physics.tables.table import in_lines

# ---- report ----------------------------------------------------------------------------------------------------------
# Reports of a step: contact points, events, and bodies that were disabled.

CONTACT_POINT = np.dtype(
    [
        ("body_a", np.int64),  # ids; A is the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),
        ("shape_b", np.int64),
        ("point_x", np.float64),  # [px] midway between the two surfaces
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] negative for an overlap
        ("normal_impulse", np.float64),  # over the whole step
        ("tangent_impulse", np.float64),
        ("area", np.float64),  # [px2] area shared by two masks; 0 for other shapes
        ("feature", np.int64),  # feature id of the corner, edge, tile or pixel of the contact
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

# ---- contact ---------------------------------------------------------------------------------------------------------
# CONTACT: two shapes that touch or may touch in this step. A row holds the manifold that a collider found, and beside
# it the contact cache, which worlds with a stacking solver keep from step to step.
#
# Rows are in the order of shape ids. A manifold has one normal and one or two points. Shapes that touch with several
# normals, as on tiles, have several rows. Fields are ordered by use, because a pass over ten thousand contacts costs
# the cache lines that it touches.

WITH_A, WITH_B, CORES, UPRIGHT = 0, 1, 2, 3  # frame of a normal: body A, body B, core to core, the world

CONTACT = in_lines(
    [
        ("shape_a", np.int64),  # ids; A is the shape with the smaller id
        ("shape_b", np.int64),
        ("body_a", np.int64),
        ("body_b", np.int64),
        ("body_row_a", np.int32),  # rows of BODY and SHAPE in this step
        ("body_row_b", np.int32),
        ("row_a", np.int32),
        ("row_b", np.int32),
        ("candidate", np.int32),  # row of the candidate pair
        ("previous", np.int32),  # recycled: row of this contact in the step before; -1: detected anew
        ("count", np.int32),  # number of points
        ("sensor", np.bool_),
        ("swept", np.bool_),  # found by the sweep, not at the final poses
        ("of_child", np.bool_),  # a side is a part of another shape
        # Geometry.
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("x_1", np.float64),  # [px] midway between the two surfaces
        ("y_1", np.float64),
        ("separation_1", np.float64),  # [px] negative for an overlap
        ("x_2", np.float64),
        ("y_2", np.float64),
        ("separation_2", np.float64),
        # Response.
        ("speed_1", np.float64),  # [px/s] approach speed along the normal before the response
        ("speed_2", np.float64),
        ("normal_impulse_1", np.float64),  # over the whole step
        ("tangent_impulse_1", np.float64),
        ("normal_impulse_2", np.float64),
        ("tangent_impulse_2", np.float64),
        ("tangential_offset", np.float64),  # [px] B slides by it along (-ny, nx) before contact; see hull_pairs.py
        ("persisted_1", np.bool_),  # the same feature was in contact in the step before
        ("persisted_2", np.bool_),
        ("of_new_pair", np.bool_),  # its pair had no contact in the step before …
        ("touched", np.bool_),  # … or one that touched or pushed
        ("slips", np.bool_),  # friction was at its limit in the step before the last one
        ("can_recycle", np.bool_),  # in the next step, while both bodies keep the poses at the end of this one
        # Report.
        ("feature_1", np.int64),  # feature id of the corner, edge, tile or pixel; see collision/hulls.py
        ("feature_2", np.int64),
        ("parent_a", np.int64),  # parent ids: the shapes that these are parts of
        ("parent_b", np.int64),
        ("area_1", np.float64),  # [px2] area shared by two masks; 0 for other shapes
        ("area_2", np.float64),
        # Contact cache. Warm start: read and stored by the solver.
        ("normal_force_1", np.float64),  # impulse per second, from which the next step starts
        ("tangent_force_1", np.float64),
        ("normal_force_2", np.float64),
        ("tangent_force_2", np.float64),
        ("rolling_force", np.float64),
        ("restitution", np.float64),  # mixed, as are friction, surface speed and rolling resistance
        ("friction", np.float64),
        ("color", np.int64),  # of its constraint in the last solve, -1: none
        ("surface_speed", np.float64),  # [px/s] sum of both sides
        ("rolling_resistance", np.float64),  # [px] mixed coefficient times the larger radius
        # Both sides at the time of detection.
        ("radius_a", np.float64),  # [px] from the core to the surface
        ("radius_b", np.float64),
        ("angle_a", np.float64),  # [rad] of the bodies
        ("angle_b", np.float64),
        ("frame", np.int64),  # WITH_A WITH_B CORES UPRIGHT
        ("local_nx", np.float64),  # the normal in the space of `frame`
        ("local_ny", np.float64),
        # Each point in the body spaces.
        ("local_ax_1", np.float64),  # [px] the point on A's core, in A's body space: the centre of a circle, else …
        ("local_ay_1", np.float64),  # … the corner or edge inside the rounding
        ("local_bx_1", np.float64),
        ("local_by_1", np.float64),
        ("share_1", np.float64),  # position of the point between the cores: 0 at A's, 1 at B's, 0.5 midway
        ("base_1", np.float64),  # [px] separation at detection
        ("share_2", np.float64),
        ("base_2", np.float64),
        ("local_ax_2", np.float64),
        ("local_ay_2", np.float64),
        ("local_bx_2", np.float64),
        ("local_by_2", np.float64),
        # World-frame reference of the contact at detection, valid while it sticks.
        ("apart_x", np.float64),  # [px] B's centre of mass relative to A's
        ("apart_y", np.float64),
        ("held_nx", np.float64),  # the normal
        ("held_ny", np.float64),
        ("held_ax_1", np.float64),  # [px] the point relative to A's centre of mass
        ("held_ay_1", np.float64),
        ("slipped", np.float64),  # [px] drift of B along (-ny, nx) when it had slipped last
        ("held_ax_2", np.float64),
        ("held_ay_2", np.float64),
    ]
)
MANIFOLD_BYTES: int = CONTACT.fields["normal_force_1"][1]  # type: ignore[index]  # size of the manifold in a row


# ---- solver rows -----------------------------------------------------------------------------------------------------
# Solver rows: the motions of bodies, and the contacts of solvers without a contact cache.

# One row per awake body, preceded by one row for all static bodies. Solvers read and write it in their substeps. A row
# is three cache lines; the first holds the fields that every pass over the constraints needs.
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
        ("is_dynamic", np.bool_),  # integrated, with drag and acceleration
        ("in_contact", np.bool_),  # a contact acts on it in this substep, or supports it: it is not in free flight
        ("is_character", np.bool_),  # the ground supports it, and it does not hold the ground down
        ("jointed", np.bool_),  # a joint acts on it …
        ("driven", np.bool_),  # a joint with a motor, a spring or a kinematic body acts on it
        ("halves", np.bool_),  # … that is rigid, and no contact: half of its acceleration acts after it has moved
        ("inverse_mass", np.float64),
        ("inverse_inertia", np.float64),  # 0: infinite in this step
        ("own_inverse_inertia", np.float64),  # the same without the inertia that tension adds, …
        ("tension", np.float64),  # … which is this; see joint_direct.add_inertia
        ("free_vx", np.float64),  # the velocity in this substep before any contact acted
        ("free_vy", np.float64),
        ("free_w", np.float64),
        ("start_vx", np.float64),  # the velocity before the step
        ("start_vy", np.float64),
        ("start_w", np.float64),
        ("acceleration_x", np.float64),
        ("acceleration_y", np.float64),
        ("angular_acceleration", np.float64),
        ("turn", np.float64),  # [rad]
        ("pseudo_vx", np.float64),  # pseudo-velocity of push-out: moves the body in this substep only
        ("pseudo_vy", np.float64),
        ("pseudo_w", np.float64),
        ("estimate", np.float64),  # square of the substeps that would keep its contacts within the accuracy
        ("cooldown", np.float64),  # [s] > 0 while fewer substeps would do, < 0 while the most were too few
        ("substeps", np.int64),  # of its island: in this step, then in the next one
        ("last_impact", np.int64),  # see solver/restitution.py
        ("branching", np.bool_),  # a body of its island has more than two contacts
        ("capped", np.bool_),  # a load needs more substeps than it may have
    ]
)

# Beside each MOTION row: its balance of energy and, at the root of bodies that exchanged impulses, theirs; see
# solver/energy.py.
BALANCE = in_lines(
    [
        ("before", np.float64),  # kinetic energy before the step, then plus the size of the work done …
        ("now", np.float64),  # … and after it
        ("excess", np.float64),  # energy that it gained beyond that work
        ("surfaces", np.float64),  # work of surfaces that move
        ("reserve", np.float64),  # energy that it has lost and may take back …
        ("lift", np.float64),  # … in this step, because contacts that sagged rise again
        ("mass", np.float64),
        ("load", np.float64),  # mass times acceleration
        ("x", np.float64),  # [px] centre of mass before the step
        ("y", np.float64),
        ("vx", np.float64),  # of the common motion: velocity, centre, spin
        ("vy", np.float64),
        ("middle_x", np.float64),
        ("middle_y", np.float64),
        ("spin", np.float64),
        ("inertia", np.float64),
        ("along", np.float64),  # kinetic energy along the only direction in which contacts act, …
        ("normal_x", np.float64),  # … which it is, …
        ("normal_y", np.float64),
        ("in_all", np.bool_),  # … or they act in all
        ("anchored", np.bool_),  # a contact acts on a body of infinite mass
        ("suspect", np.bool_),  # its energy is compared with that of the bodies that it exchanged impulses with
        ("jointed", np.bool_),  # joints act on these bodies, …
        ("driven", np.bool_),  # … with motors, springs or kinematic bodies, which may give them energy
        ("face_x", np.float64),  # the first normal; …
        ("face_y", np.float64),
        ("oblique", np.bool_),  # … others are neither parallel nor perpendicular to it, or bounce
        ("pushed", np.bool_),  # a contact acts on a kinematic body that moves
        ("fastest", np.float64),  # [px/s] speed of bodies before the step and of kinematic ones
        ("along_scale", np.float64),  # factors on velocities
        ("scale", np.float64),
    ]
)
# Beside each MOTION row of an island without room: bounds of the impulses in it; see solver/energy.py.
SQUEEZE = np.dtype(
    [
        ("depth", np.float64),  # [px] greatest overlap of all, …
        ("face_depth", np.float64),  # … and with bodies of infinite mass
        ("face_x", np.float64),  # normal out of the first of these
        ("face_y", np.float64),
        ("push_x", np.float64),  # normal out of the first one that moves
        ("push_y", np.float64),
        ("caught", np.bool_),  # faces point in different directions
        ("pressed", np.bool_),  # a face is opposite to one that moves
        ("face_speed", np.float64),  # [px/s] greatest speed of a face
        ("most", np.float64),  # [px/s] greatest speed of a body; 0: no bound
        ("speed", np.float64),  # [px/s] bound of an impulse per effective mass; 0: none …
        ("static_speed", np.float64),  # … and what is added to it against what does not move
        ("force", np.float64),  # impulse per second that is added to it
    ],
    align=True,
)

PUSH = np.dtype(
    [  # one per point, in the order of shape ids, for the solvers without a contact cache
        ("manifold", np.int32),  # row of the manifold, and which of its points
        ("second", np.bool_),
        ("swept", np.bool_),  # found by the sweep
        ("body_row_a", np.int32),
        ("body_row_b", np.int32),
        ("x", np.float64),  # [px] the point at detection
        ("y", np.float64),
        ("normal_x", np.float64),
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] at detection
        ("anchor_x", np.float64),  # [px] centre of B relative to A's at detection
        ("anchor_y", np.float64),
        ("speed", np.float64),  # [px/s] approach speed before the response
        ("threshold", np.float64),  # [px/s] slower approaches do not bounce
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
