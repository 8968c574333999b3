"""What the world tells of a step: contacts, events, bodies that broke."""

import numpy as np

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
