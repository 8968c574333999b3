"""Row type of joints: JOINT, one row per joint, with its settings, its state and its solver fields."""

import numpy as np

from physics.tables.table import Record, in_lines

WORLD = -1  # value of a body id or row for a joint to the world
NO_JOINT = -1  # value of a joint id or row for a side of a gear that is a body
# How a joint holds its two anchors together: not at all, in both directions, or only across its axis. Or how it holds
# its two bodies: by the teeth of a ratchet, by a gear, or by a rope over two pulleys.
FREE, PINNED, ON_AXIS, TOOTHED, GEARED, SLUNG = 0, 1, 2, 3, 4, 5
# The coordinate on which limits, motor and spring of a joint act: none, the angle of B relative to A [rad], the
# translation of B's anchor along the axis [px], or the distance of the anchors [px].
NO_COORDINATE, ANGLE, TRANSLATION, LENGTH = 0, 1, 2, 3

STATE = (  # fields on which the next step depends
    ("id", np.int64),  # given once, never used again
    ("kind", np.int64),  # index in joints.kinds.KINDS
    ("body_a", np.int64),  # ids of the bodies; -1: the world
    ("body_b", np.int64),
    ("enabled", np.bool_),  # the joint acts
    ("contacts", np.bool_),  # the two bodies may touch each other
    ("locks_angle", np.bool_),  # the angle of B relative to A is held
    ("follows_point", np.bool_),  # anchors are held together; False: only their relative velocity is controlled
    ("follows_angle", np.bool_),  # likewise for the angle
    ("turns_motor", np.bool_),  # the motor acts on the angle instead of the coordinate
    ("awake", np.bool_),  # the joint was solved in the last step, and has not fallen asleep in it
    ("direct", np.bool_),  # the joint is solved exactly: in a tree, or beside one, see solver/joint_direct.py
    ("broken", np.bool_),  # a breaking force or torque was exceeded in the last step
    ("exact_limits", np.bool_),  # the limits are solved with the tree of the joint, see solver/joint_schur.py …
    ("exact_motor", np.bool_),  # … and the motor
    ("in_open_tree", np.bool_),  # the tree of the joint has no loops, and at most one joint to bodies of infinite mass
    ("hold", np.int64),  # FREE 0, PINNED 1, ON_AXIS 2, TOOTHED 3, GEARED 4, SLUNG 5
    ("coordinate", np.int64),  # NO_COORDINATE 0, ANGLE 1, TRANSLATION 2, LENGTH 3
    # Geometry.
    ("local_ax", np.float64),  # [px] anchors in the spaces of A and B, in the world for a joint to the world
    ("local_ay", np.float64),
    ("local_bx", np.float64),
    ("local_by", np.float64),
    ("axis_x", np.float64),  # unit, in the space of A
    ("axis_y", np.float64),
    ("reference", np.float64),  # [rad] angle of B relative to A at which `angle` is 0
    # Settings. A coordinate is in px or rad; forces are torques where it is an angle.
    ("lower", np.float64),  # least coordinate; -inf: no limit
    ("upper", np.float64),  # greatest coordinate; inf: no limit; equal limits hold the coordinate
    ("motor_speed", np.float64),  # target speed of the coordinate [px/s or rad/s]
    ("motor_max", np.float64),  # greatest force [mass px/s2] or torque [mass px2/s2] of the motor; 0: no motor
    ("spring_hertz", np.float64),  # [1/s] 0: no spring
    ("spring_damping", np.float64),  # damping ratio
    ("spring_target", np.float64),  # coordinate at which it rests [px or rad]
    ("point_hertz", np.float64),  # [1/s] frequency of a soft hold of the anchors; 0: rigid
    ("point_damping", np.float64),  # damping ratio of that hold
    ("point_max", np.float64),  # [mass px/s2] greatest force that holds the anchors
    ("angle_hertz", np.float64),  # [1/s] frequency of a soft hold of the angle; 0: rigid
    ("angle_damping", np.float64),  # damping ratio of that hold
    ("angle_max", np.float64),  # [mass px2/s2] greatest torque that holds the angle
    ("target_vx", np.float64),  # [px/s] controlled velocity of B's anchor relative to A, in the space of A
    ("target_vy", np.float64),
    ("target_spin", np.float64),  # [rad/s] controlled angular velocity of B relative to A
    ("break_force", np.float64),  # [mass px/s2] force above which it breaks; inf: never
    ("break_torque", np.float64),  # [mass px2/s2] likewise a torque
    # State after the last step.
    ("angle", np.float64),  # [rad] angle of B relative to A, 0 when the joint was made
    ("translation", np.float64),  # [px] translation along the axis, distance of the anchors, or sum of a gear or pulley
    ("speed", np.float64),  # rate of change of the coordinate [px/s or rad/s], or of the angle if there is none
    ("separation", np.float64),  # [px] error: distance of held anchors, distance from the axis, or excess over limits
    ("force_x", np.float64),  # [mass px/s2] force on B at its anchor: impulse of the step per second
    ("force_y", np.float64),
    ("torque", np.float64),  # [mass px2/s2] torque on B, in addition to the force at its anchor
    ("strain", np.float64),  # [mass px/s2] greatest recent force that held the anchors, see joint_direct.add_inertia
    # Impulses per second with which the next step starts.
    ("point_force_x", np.float64),  # impulse per second that holds the anchors
    ("point_force_y", np.float64),  # likewise; ON_AXIS: across the axis; SLUNG: forces that stop A, B at their pulleys
    ("hold_torque", np.float64),  # impulse per second that holds the angle
    ("spring_force", np.float64),  # impulse per second of the spring
    ("motor_force", np.float64),  # impulse per second of the motor
    ("lower_force", np.float64),  # impulse per second of the lower limit
    ("upper_force", np.float64),  # impulse per second of the upper limit
)
SCRATCH = (  # rows in this step, and solver fields, which the solver writes before it reads them
    ("motion_a", np.int32),  # rows of MOTION
    ("motion_b", np.int32),
    ("is_pin", np.bool_),  # solved by joint_rows.solve_pin, which reads the fields up to total_y
    ("arm_ax", np.float64),  # [px] anchor relative to the centre of mass, at the start of the step
    ("arm_ay", np.float64),
    ("arm_bx", np.float64),
    ("arm_by", np.float64),
    ("base_x", np.float64),  # [px] vector from A's anchor to B's anchor at the start of the step
    ("base_y", np.float64),
    ("ax", np.float64),  # [px] moment arms in the present substep, see joint_rows.place_joint
    ("ay", np.float64),
    ("bx", np.float64),
    ("by", np.float64),
    ("apart_x", np.float64),  # [px] vector from A's anchor to B's anchor in the present substep
    ("apart_y", np.float64),
    ("point_x", np.float64),  # impulses in the present substep
    ("point_y", np.float64),
    ("total_x", np.float64),  # impulses of the step on B
    ("total_y", np.float64),
    ("total_torque", np.float64),  # angular impulse of the step on B
    ("body_row_a", np.int32),  # rows of BODY; -1: the world
    ("body_row_b", np.int32),
    ("start_nx", np.float64),  # axis at the start of the step
    ("start_ny", np.float64),
    ("start_angle", np.float64),  # [rad] angle of the joint at the start of the step
    ("nx", np.float64),  # axis in the present substep
    ("ny", np.float64),  # likewise
    ("turn", np.float64),  # [rad] angle of the joint in the present substep
    ("hold_impulse", np.float64),  # impulse that holds the angle
    ("spring", np.float64),  # impulse of the spring
    ("spring_aim", np.float64),  # [px/s or rad/s] velocity for which the spring aims in the substep, see aim_springs
    ("motor", np.float64),  # impulse of the motor
    ("low", np.float64),  # impulse of the lower limit
    ("high", np.float64),  # impulse of the upper limit
)
COUPLED_STATE = (  # fields of gears, pulleys and ratchets on which the next step depends; 0 for other kinds
    ("joint_a", np.int64),  # ids of the joints that a gear couples; NO_JOINT: it couples body_a, body_b itself
    ("joint_b", np.int64),
    ("ratio", np.float64),  # gear or pulley: factor on the coordinate, or length of rope, of side B
    ("phase", np.float64),  # gear: the sum that it holds; ratchet: angle of a tooth [rad]
    ("ratchet", np.float64),  # [rad] angle from tooth to tooth, in the direction in which B may turn
    ("ground_ax", np.float64),  # [px] the two pulleys, in the world
    ("ground_ay", np.float64),
    ("ground_bx", np.float64),
    ("ground_by", np.float64),
)
# The fields of coupled joints come last, so that the other kinds use as many cache lines as without them. A row is
# longer by one line, which costs the others 1 % of their time (760 pins); with the fields of COUPLING it would be 2 %.
COUPLED_SCRATCH = (("rate", np.float64),)  # [px/s] greatest speed of a side of a gear or pulley after the last step
JOINT = in_lines([*STATE, *SCRATCH, *COUPLED_STATE, *COUPLED_SCRATCH])

# Solver fields of a gear, pulley or ratchet in a step.
COUPLING = in_lines(
    [
        ("joint", np.int32),  # JOINT row
        ("row_a", np.int32),  # JOINT rows of the joints that a gear couples; NO_JOINT: none
        ("row_b", np.int32),
        ("start_a", np.float64),  # [rad] angle of a body at the start of the step, for a gear of bodies
        ("start_b", np.float64),
        ("rope_ax", np.float64),  # [px] vector from the pulley to the anchor at the start of the step
        ("rope_ay", np.float64),
        ("rope_bx", np.float64),
        ("rope_by", np.float64),
        ("pull_ax", np.float64),  # unit vector from the pulley to the anchor in the present substep
        ("pull_ay", np.float64),
        ("pull_bx", np.float64),
        ("pull_by", np.float64),
        ("length_a", np.float64),  # [px] length of rope from the pulley to the anchor
        ("length_b", np.float64),
        ("inverse_a", np.float64),  # inverse effective mass of that length
        ("inverse_b", np.float64),
        ("sum", np.float64),  # coordinate of A plus ratio times coordinate of B in the present substep
        ("inverse_mass", np.float64),  # inverse effective mass of that sum
        ("total", np.float64),  # impulse of the step on that sum
    ]
)


class Broken(Record):
    """A row of world.events.broken: a joint that broke or was removed."""


BROKEN = np.dtype(
    (
        Broken,
        [
            ("joint", np.int64),  # id
            ("body_a", np.int64),  # ids of its bodies; -1: the world
            ("body_b", np.int64),
            ("force", np.float64),  # [mass px/s2] magnitude of its force in the last step
            ("torque", np.float64),  # [mass px2/s2] its torque in the last step
            ("reason", "U8"),  # "force" or "torque" that broke it; "removed": lost with a body or joint
        ],
    )
)
