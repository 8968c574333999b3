"""Row types of contacts: CONTACT for detection and solver, CONTACT_POINT and EVENT for reports, and solver rows."""

import numpy as np

from physics.jit import kernel
from physics.tables.table import Record, in_lines, joined, row_of

# ---- report ----------------------------------------------------------------------------------------------------------
# Reports of a step: contact points, events, and bodies that were disabled.


class Contact(Record):
    """A row of world.contacts or world.sleeping_contacts: one contact point of two shapes."""


class Event(Record):
    """A row of world.events: a pair of shapes that starts, continues or ceases to touch."""


class Hit(Record):
    """A row of world.events.hits: a contact with a high approach speed."""


class Quarantined(Record):
    """A row of world.events.quarantined: a body that was disabled, with the reason."""


CONTACT_FIELDS = np.dtype(
    [
        ("body_a", np.int64),  # ids of the bodies; A has the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),  # ids of the shapes
        ("shape_b", np.int64),
        ("point_x", np.float64),  # [px] midway between the two surfaces
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit vector from A to B
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] negative for an overlap
        ("normal_impulse", np.float64),  # [mass px/s] along the normal, over the whole step
        ("tangent_impulse", np.float64),  # [mass px/s] friction, along (-normal_y, normal_x)
        ("area", np.float64),  # [px2] area shared by two masks; 0 for other shapes
        ("feature", np.int64),  # feature id of the corner, edge, tile or pixel of the contact
    ],
    align=True,
)
EVENT_FIELDS = np.dtype(
    [
        ("body_a", np.int64),  # ids of the bodies; A has the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),  # ids of the shapes
        ("shape_b", np.int64),
        ("point_x", np.float64),  # [px] midway between the two surfaces
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit vector from A to B
        ("normal_y", np.float64),
    ],
    align=True,
)
HIT_FIELDS = np.dtype(
    [
        *EVENT_FIELDS.descr,
        ("speed", np.float64),  # [px/s] approach speed along the normal, before the response
        ("normal_impulse", np.float64),  # [mass px/s] along the normal, over the whole step
    ]
)
CONTACT_POINT, EVENT, HIT = (
    np.dtype(each) for each in ((Contact, CONTACT_FIELDS), (Event, EVENT_FIELDS), (Hit, HIT_FIELDS))
)
QUARANTINE = np.dtype(
    (
        Quarantined,
        [
            ("body", np.int64),  # id
            ("reason", "U96"),  # the rule that is broken by a number of the body, of its shapes or of its character
        ],
    )
)

# ---- contact ---------------------------------------------------------------------------------------------------------
# CONTACT: two shapes that touch or may touch in this step. A row holds the manifold of the narrow phase, and the
# contact cache, which worlds with a stacking solver keep from step to step.
#
# Rows are in the order of shape ids. A manifold has one normal and one or two points. Shapes that touch with several
# normals, as on tiles, have several rows. Fields are ordered by use: the cost of a pass over ten thousand contacts is
# the number of cache lines that it reads.

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
        ("previous", np.int32),  # recycled: row of this contact in the last step; -1: detected anew
        ("count", np.int32),  # number of points
        ("sensor", np.bool_),
        ("swept", np.bool_),  # found by the sweep, not at the final poses
        ("of_child", np.bool_),  # at least one side is a part of another shape
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
        ("tangential_offset", np.float64),  # [px] motion of B along (-ny, nx) before contact; see hull_pairs.py
        ("persisted_1", np.bool_),  # the same feature was in contact in the last step
        ("persisted_2", np.bool_),
        ("of_new_pair", np.bool_),  # the pair of shapes had no contact in the last step
        ("touched", np.bool_),  # the pair had a contact in the last step that touched or had an impulse
        ("slips", np.bool_),  # the contact slipped when the solver last prepared it
        ("can_recycle", np.bool_),  # recyclable in the next step if both bodies keep their poses until then
        # Report.
        ("feature_1", np.int64),  # feature id of the corner, edge, tile or pixel; see collision/hulls.py
        ("feature_2", np.int64),
        ("parent_a", np.int64),  # SHAPE.parent of A and of B
        ("parent_b", np.int64),
        ("area_1", np.float64),  # [px2] area shared by two masks; 0 for other shapes
        ("area_2", np.float64),
        # Contact cache. Warm start: read and stored by the solver.
        ("normal_force_1", np.float64),  # cached force, impulse per second, with which the next step starts
        ("tangent_force_1", np.float64),
        ("normal_force_2", np.float64),
        ("tangent_force_2", np.float64),
        ("rolling_force", np.float64),
        ("restitution", np.float64),  # mixed, as are friction, surface speed and rolling resistance
        ("friction", np.float64),
        ("color", np.int64),  # graph colour in the last solve, -1: none
        ("surface_speed", np.float64),  # [px/s] sum of both sides
        ("rolling_resistance", np.float64),  # [px] mixed coefficient times the larger radius
        # Both sides at the time of detection.
        ("radius_a", np.float64),  # [px] distance from the core to the surface
        ("radius_b", np.float64),
        ("angle_a", np.float64),  # [rad] angles of the bodies
        ("angle_b", np.float64),
        ("frame", np.int64),  # WITH_A WITH_B CORES UPRIGHT
        ("local_nx", np.float64),  # the normal in the space of `frame`
        ("local_ny", np.float64),
        # Each point in the body spaces.
        # [px] The point on the core of each shape: the centre of a circle, or a point of the hull inside the rounding.
        ("local_ax_1", np.float64),
        ("local_ay_1", np.float64),
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
        ("slipped", np.float64),  # [px] drift of B along (-ny, nx) at its last slip
        ("held_ax_2", np.float64),
        ("held_ay_2", np.float64),
    ]
)
MANIFOLD_BYTES: int = CONTACT.fields["normal_force_1"][1]  # type: ignore[index]  # size of the fields before the cache


# ---- solver rows -----------------------------------------------------------------------------------------------------
# Solver rows: the motions of bodies, and the contacts of solvers without a contact cache.

# One row for each body that the step visits, preceded by one row for all bodies that do not move. Solvers read and
# write these rows in their substeps. A row is four cache lines; the first holds the fields for every pass over
# constraints.
MOTION = in_lines(
    [
        ("vx", np.float64),
        ("vy", np.float64),
        ("angular_velocity", np.float64),
        ("dx", np.float64),  # [px] displacement of the centre of mass since the start of the step
        ("dy", np.float64),
        ("cosine", np.float64),  # of the rotation since the start of the step
        ("sine", np.float64),
        ("moves", np.bool_),
        ("is_dynamic", np.bool_),  # integrated, with drag and acceleration
        ("in_contact", np.bool_),  # a contact acts on it in this substep, or supports it: it is not in free flight
        ("is_character", np.bool_),  # the ground supports it, and it does not hold the ground down
        ("jointed", np.bool_),  # a joint acts on it
        ("driven", np.bool_),  # a joint with a motor, a spring or a kinematic body acts on it
        ("has_wide_gap", np.bool_),  # the anchors of a joint are far apart, see joint_rows.has_wide_gap
        ("halves", np.bool_),  # it has rigid joints and no contact: half of its acceleration acts after it has moved
        ("inverse_mass", np.float64),
        ("inverse_inertia", np.float64),  # 0: infinite in this step
        ("own_inverse_inertia", np.float64),  # inverse inertia without the inertia that tension adds
        ("tension", np.float64),  # least inertia by tension, see joint_direct.add_inertia
        ("free_vx", np.float64),  # velocity in this substep without the impulses of contacts
        ("free_vy", np.float64),
        ("free_w", np.float64),
        ("start_vx", np.float64),  # velocity before the step
        ("start_vy", np.float64),
        ("start_w", np.float64),
        ("acceleration_x", np.float64),
        ("acceleration_y", np.float64),
        ("angular_acceleration", np.float64),
        ("turn", np.float64),  # [rad] rotation since the start of the step
        ("pseudo_vx", np.float64),  # pseudo-velocity of push-out, which moves the body in this substep only
        ("pseudo_vy", np.float64),
        ("pseudo_w", np.float64),
        ("estimate", np.float64),  # square of the number of substeps that keeps contacts within the accuracy
        ("cooldown", np.float64),  # [s] > 0: time in which fewer substeps sufficed; < 0: in which the most did not
        ("substeps", np.int64),  # number of substeps of this step; the solver writes the number of the next step
        ("last_impact", np.int64),  # see restitution.link_impacts
        ("branching", np.bool_),  # the body, or at the root a body of the island, has more than two contacts
        ("capped", np.bool_),  # a load needs more substeps than allowed
    ]
)

# One row for each MOTION row: the energy balance of the body. At the root of a set of bodies that exchanged impulses,
# it receives the balance of the set. See solver/energy.py.
BALANCE = in_lines(
    [
        ("before", np.float64),  # kinetic energy before the step; then the absolute work of forces is added
        ("now", np.float64),  # kinetic energy after the step
        ("excess", np.float64),  # gain of energy beyond the work of forces
        ("surfaces", np.float64),  # work of moving surfaces
        ("reserve", np.float64),  # energy that was lost and may be taken back
        ("lift", np.float64),  # energy that may be taken back in this step, because sagged contacts rise again
        ("mass", np.float64),
        ("load", np.float64),  # sum of mass times acceleration
        ("x", np.float64),  # [px] centre of mass before the step
        ("y", np.float64),
        ("vx", np.float64),  # common motion of the set: velocity, centre of mass, angular velocity
        ("vy", np.float64),
        ("middle_x", np.float64),
        ("middle_y", np.float64),
        ("spin", np.float64),
        ("inertia", np.float64),
        ("along", np.float64),  # kinetic energy along the only normal of the contacts
        ("normal_x", np.float64),  # the first normal of the contacts of the body
        ("normal_y", np.float64),
        ("in_all", np.bool_),  # the contacts of the body act in all directions
        ("anchored", np.bool_),  # a contact acts on a body of infinite mass
        ("suspect", np.bool_),  # its energy is compared with that of the bodies that it exchanged impulses with
        ("jointed", np.bool_),  # joints act on these bodies, …
        ("driven", np.bool_),  # … with motors, springs or kinematic bodies, which may give them energy
        ("has_wide_gap", np.bool_),  # the anchors of a joint are far apart
        ("face_x", np.float64),  # the first normal of a contact of the set, see energy.note_face
        ("face_y", np.float64),
        ("oblique", np.bool_),  # see energy.note_face
        ("pushed", np.bool_),  # a contact of the set is with a moving kinematic body
        ("fastest", np.float64),  # [px/s] greatest speed of the set before the step, and of its kinematic bodies
        ("along_scale", np.float64),  # factors on velocities, see energy.scale_motion
        ("scale", np.float64),
    ]
)
# One row for each MOTION row: bounds of the impulses in islands without room, see solver/energy.py. The fields from
# depth to face_speed are values of a whole island, at its root.
SQUEEZE = np.dtype(
    [
        ("depth", np.float64),  # [px] greatest overlap
        ("face_depth", np.float64),  # [px] greatest overlap with a body of infinite mass
        ("face_x", np.float64),  # normal of the first overlapped face
        ("face_y", np.float64),
        ("push_x", np.float64),  # normal of the first moving face
        ("push_y", np.float64),
        ("caught", np.bool_),  # overlapped faces point in different directions
        ("pressed", np.bool_),  # a face is opposite to a moving face
        ("has_kinematic", np.bool_),  # a face of the island belongs to a kinematic body
        ("face_speed", np.float64),  # [px/s] greatest speed of a face
        ("most", np.float64),  # [px/s] greatest speed of a body; 0: no bound
        ("speed", np.float64),  # [px/s] bound of an impulse divided by the effective mass; 0: no bound
        ("static_speed", np.float64),  # [px/s] added to `speed` for contacts with bodies that do not move
        ("force", np.float64),  # impulse per second that is added to the bound
    ],
    align=True,
)

PUSH = np.dtype(
    [  # one row for each contact point, in the order of shape ids, for the solvers without a contact cache
        ("manifold", np.int32),  # CONTACT row
        ("second", np.bool_),  # whether this is the second point of the contact
        ("swept", np.bool_),  # found by the sweep
        ("body_row_a", np.int32),
        ("body_row_b", np.int32),
        ("x", np.float64),  # [px] the point at detection
        ("y", np.float64),
        ("normal_x", np.float64),
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] at detection
        ("anchor_x", np.float64),  # [px] centre of B relative to the centre of A at detection
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


# ---- row numbers -----------------------------------------------------------------------------------------------------
# The row numbers in contacts, after bodies or shapes were removed.


@kernel
def refresh_rows(bodies, shapes, manifolds_inout, there_out):
    """Write the present body and shape row numbers to each CONTACT row.

    there_out (contacts,) bool: whether both bodies and both shapes of the contact still exist. O(contacts · log
    shapes).
    """
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        m.body_row_a = row_of(bodies, m.body_a)
        m.body_row_b = row_of(bodies, m.body_b)
        m.row_a = row_of(shapes, m.shape_a)
        m.row_b = row_of(shapes, m.shape_b)
        there_out[i] = min(m.body_row_a, m.body_row_b, m.row_a, m.row_b) >= 0


def with_rows(bodies: np.ndarray, shapes: np.ndarray, contacts: np.ndarray) -> np.ndarray:
    """Write the present body and shape row numbers to contacts. Return the contacts that still exist.

    A contact still exists if both bodies and both shapes do. bodies: BODY rows; shapes: SHAPE rows; contacts: CONTACT
    rows, updated in place.
    """
    there = np.empty(len(contacts), bool)
    refresh_rows(bodies, shapes, contacts, there)
    return contacts if there.all() else contacts[there]


def without_removed(bodies: np.ndarray, shapes: np.ndarray, contacts: np.ndarray) -> np.ndarray:
    """Return a copy of the contacts whose bodies and shapes still exist, with present row numbers.

    bodies: BODY rows; shapes: SHAPE rows; contacts: CONTACT rows, not changed.
    """
    return with_rows(bodies, shapes, joined([contacts])) if len(contacts) else contacts
