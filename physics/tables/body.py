"""Row types of bodies: BODY, one row per body, and BODY_DEF, the default values for the shapes of a body.

Rows are in the order of ids. A row number changes when an earlier row is removed. An id never changes, and is not
reused after its body is removed.
"""

from typing import get_args

import numpy as np

from physics.annotations import ContinuousName, KindName
from physics.tables.table import in_lines

STATIC, KINEMATIC, DYNAMIC = 0, 1, 2
KINDS: tuple[KindName, ...] = get_args(KindName)  # a kind is the index of its name
CONTINUOUS: tuple[ContinuousName, ...] = ("off", "ray", "swept", "auto", "toi")
OFF, RAY, SWEPT, AUTO, TOI = 0, 1, 2, 3, 4
BODY = in_lines(
    [  # ordered by use: the first cache line holds the fields that every pass over contacts reads
        ("x", np.float64),  # [px] origin
        ("y", np.float64),
        ("angle", np.float64),  # [rad] clockwise on the screen
        ("center_x", np.float64),  # [px] centre of mass in the world; refreshed when the body moves
        ("center_y", np.float64),
        ("vx", np.float64),  # [px/s] of the centre of mass
        ("vy", np.float64),
        ("angular_velocity", np.float64),  # [rad/s]
        ("id", np.int64),  # given once, never used again
        ("kind", np.int64),  # STATIC 0, KINEMATIC 1, DYNAMIC 2
        ("awake", np.bool_),  # it is simulated; False: its island sleeps
        ("active", np.bool_),  # a step visits the body; True for all bodies in a world without sleeping
        ("dirty", np.bool_),  # added or edited before this step, in a world with sleeping
        ("quarantined", np.bool_),  # disabled because a number was not finite or out of range
        ("bullet", np.bool_),  # also swept against moving bodies
        ("fixed_rotation", np.bool_),  # contacts and impulses leave its rotation unchanged
        ("allow_sleep", np.bool_),  # False: its island stays awake
        ("forced", np.bool_),  # a force acted on it in this step, in a world without stacking
        ("has_current_contacts", np.bool_),  # its contacts were updated to its present pose; see contacts/cache.py
        ("inverse_mass", np.float64),  # 1 / mass; 0: infinite mass
        ("inverse_inertia", np.float64),  # 1 / inertia; 0: infinite inertia
        ("extent", np.float64),  # [px] distance from the centre of mass to the furthest point of its shapes
        ("min_half_extent", np.float64),  # [px] least distance from the middle of a shape to its surface
        (
            "inradius",
            np.float64,
        ),  # [px] the same for the thinnest part of a shape; a body that moves further in a step is swept
        ("previous_x", np.float64),  # [px, rad] pose before the step, for interpolated drawing and for rollback
        ("previous_y", np.float64),
        ("previous_angle", np.float64),
        ("settled_x", np.float64),  # [px, rad] last pose within POSITION_LIMIT
        ("settled_y", np.float64),
        ("settled_angle", np.float64),
        ("fraction", np.float64),  # fraction of this step's motion before the first impact; 1 without an impact
        ("continuous", np.int64),  # OFF 0, RAY 1, SWEPT 2, AUTO 3, TOI 4
        ("force_x", np.float64),  # [mass px/s2] accumulated since the last step
        ("force_y", np.float64),
        ("torque", np.float64),  # [mass px2/s2] likewise
        ("gravity_scale", np.float64),  # factor on the gravity of the world
        ("mass", np.float64),  # [density px2] 0 for bodies without mass
        ("inertia", np.float64),  # [density px4] about the centre of mass
        ("local_center_x", np.float64),  # [px] centre of mass in body space
        ("local_center_y", np.float64),
        ("still_x", np.float64),  # [px, rad] reference pose of the sleep test
        ("still_y", np.float64),
        ("still_angle", np.float64),
        ("sleep_time", np.float64),  # [s] time spent near the reference pose
        ("rocking_x", np.float64),  # [px, rad] reference pose of the test for bodies that rock in place
        ("rocking_y", np.float64),
        ("rocking_angle", np.float64),
        ("rocking_time", np.float64),  # [s] time spent around that reference pose
        ("island", np.int64),  # lowest body id of its island; -1: none
        ("reserve", np.float64),  # energy that its contacts have removed recently; see solver/energy.py
        ("cooldown", np.float64),  # [s] > 0: time in which fewer substeps sufficed; < 0: in which the most did not
        ("substeps", np.int64),  # adaptive substeps of its island in the next step; 0: not known yet
    ]
)
BODY_DEF = np.dtype(
    [  # one row for each BODY row: values for the shapes of the body without own values
        ("density", np.float64),
        ("friction", np.float64),
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s]
        ("membership", np.int64),  # 32 bits
        ("mask", np.int64),  # 32 bits
        ("mass", np.float64),  # replaces the mass from the densities; 0: does not replace it
        ("sensor", np.bool_),
    ],
    align=True,
)
RUN = np.dtype(
    [  # one row for each BODY row: the SHAPE rows of the body
        ("first", np.int64),  # id of the first SHAPE row
        ("count", np.int64),  # number of SHAPE rows, which are consecutive; SCATTERED: they are not consecutive
    ]
)
SCATTERED = -1
