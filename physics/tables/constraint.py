"""What a solver works on: the motions of bodies and the constraints between them."""

import numpy as np

from physics.tables.lines import in_lines

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
