"""What the world tells of a step: contacts, one row per point; events; bodies that broke."""

import numpy as np

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
