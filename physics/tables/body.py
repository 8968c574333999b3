"""BODY: one row per body, and what the numbers of its kinds mean; GIVEN: what it says of its shapes.

Rows are kept in the order of ids, so the order of rows is the canonical order of everything. A row number changes
when an earlier row is removed; an id never changes and is never given twice.
"""

import numpy as np

from physics.tables.table import in_lines

STATIC, KINEMATIC, DYNAMIC = 0, 1, 2
KINDS = ("static", "kinematic", "dynamic")
CONTINUOUS = ("off", "ray", "swept", "auto", "toi")
OFF, RAY, SWEPT, AUTO, TOI = 0, 1, 2, 3, 4
BODY = in_lines(
    [  # by who asks for them: the first line of the cache is what every pass over contacts reads
        ("x", np.float64),  # [px] origin
        ("y", np.float64),
        ("angle", np.float64),  # [rad] clockwise on the screen
        ("center_x", np.float64),  # [px] centre of mass in the world; refreshed when the body moves
        ("center_y", np.float64),
        ("vx", np.float64),  # [px/s] of the centre of mass
        ("vy", np.float64),
        ("angular_velocity", np.float64),  # [rad/s]
        ("id", np.int64),
        ("kind", np.int64),  # STATIC KINEMATIC DYNAMIC
        ("awake", np.bool_),
        ("active", np.bool_),  # in the rows that a step goes over; all are in a world without sleeping
        ("stirred", np.bool_),  # within a step: added or changed by hand before it, in a world with sleeping
        ("quarantined", np.bool_),  # out of the simulation after it stopped being finite
        ("bullet", np.bool_),  # swept against moving bodies too
        ("fixed_rotation", np.bool_),
        ("followed", np.bool_),  # its contacts were carried to where it stands; see collision/cache.py
        ("inverse_mass", np.float64),  # 0 = cannot be pushed
        ("inverse_inertia", np.float64),  # 0 = cannot be turned
        ("extent", np.float64),  # [px] of the furthest point of its shapes from the centre of mass
        ("smallest_half", np.float64),  # [px] from the middle of a shape to its surface
        ("thin_half", np.float64),  # [px] the same of its thinnest part: what "fast" is measured by
        ("previous_x", np.float64),  # [px] pose before the step: for interpolated drawing and for rolling back
        ("previous_y", np.float64),
        ("previous_angle", np.float64),
        ("settled_x", np.float64),  # [px] last pose that was seen to be finite
        ("settled_y", np.float64),
        ("settled_angle", np.float64),
        ("fraction", np.float64),  # of this step's motion that was free, 1 when nothing was in the way
        ("continuous", np.int64),  # OFF RAY SWEPT AUTO TOI
        ("force_x", np.float64),  # collected since the last step
        ("force_y", np.float64),
        ("torque", np.float64),
        ("gravity_scale", np.float64),
        ("mass", np.float64),  # [density px2] 0 where it has none
        ("inertia", np.float64),  # [density px4] about the centre of mass
        ("local_center_x", np.float64),  # [px] centre of mass in body space
        ("local_center_y", np.float64),
        ("still_x", np.float64),  # [px] pose near which it has been …
        ("still_y", np.float64),
        ("still_angle", np.float64),
        ("sleep_time", np.float64),  # … for so long [s]
        ("island", np.int64),  # lowest body id of those it is piled up with, -1: none
        ("eased", np.float64),  # [s] for which fewer would have done, or, below 0, the most were too few
        ("substeps", np.int64),  # that its island takes in the next step, where they are not given; 0: not known yet
    ]
)
GIVEN = np.dtype(
    [  # beside BODY, row by row: what the body was given for those of its shapes that have no values of their own
        ("density", np.float64),
        ("friction", np.float64),
        ("restitution", np.float64),
        ("rolling_resistance", np.float64),
        ("surface_speed", np.float64),  # [px/s]
        ("membership", np.int64),  # 32 bits
        ("mask", np.int64),  # 32 bits
        ("mass", np.float64),  # in place of the densities'; 0: the densities'
        ("sensor", np.bool_),
    ],
    align=True,
)
