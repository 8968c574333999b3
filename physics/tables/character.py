"""Row type CHARACTER: one row per Character, which moves in whole pixels."""

import numpy as np

CHARACTER = np.dtype(
    [  # one per Character
        ("body", np.int64),  # id
        ("body_row", np.int64),
        ("shape", np.int64),  # id of its body's shape
        ("shape_row", np.int64),
        ("left", np.int64),
        ("top", np.int64),  # [px] pixel column and row of its box: its shape's bounds, exact at feet and left side
        ("width", np.int64),
        ("height", np.int64),  # [px]
        ("offset_x", np.float64),
        ("offset_y", np.float64),  # [px] origin of its shape from the top left corner of the box
        ("is_box", np.bool_),  # its shape is the box itself, which is tested against other boxes on the pixel grid
        ("climb", np.float64),  # steepest ground that it walks [rise per px]
        ("remainder_x", np.float64),
        ("remainder_y", np.float64),  # [px] motion below one whole pixel, kept for the next move
        ("previous_left", np.int64),
        ("previous_top", np.int64),  # before the last move, for interpolated drawing
        ("riding", np.int64),  # id of the body under its feet that may carry it, -1: none
        ("riding_shape", np.int64),  # id of the shape of that body that it stands on
        ("carried", np.int64),  # [px] by which its support carried it, along the present axis
        ("grounded", np.bool_),
        ("squeezed", np.bool_),  # by a solid that pushed it and that it could not yield to, since its last move
        ("pushable", np.bool_),  # solid for other characters, and yields to them
        ("drop", np.bool_),  # falls through one-way tiles in this move
        ("wall", np.int64),  # -1 left, 1 right, 0 none
        ("slope", np.float64),  # slope of the ground under its feet [rise per px to the right]
        ("mass", np.float64),  # [density px2] this and the next fields: in worlds that stack
        ("push", np.float64),  # [px/s2] the most force with which it pushes bodies, per mass
        ("pressed", np.int64),  # id of the body that supported it in the last step, -1: none
        ("foot_x", np.float64),
        ("foot_y", np.float64),  # [px] the point that stood on that body
        ("carry_x", np.float64),
        ("carry_y", np.float64),  # [px] motion of its support below one whole pixel, kept for the next step
        ("belt", np.float64),  # [px/s] surface speed to the right of the ground under its feet
        ("belt_x", np.float64),  # [px] motion by that speed below one whole pixel, kept for the next step
        ("push_vx", np.float64),
        ("push_vy", np.float64),  # [px/s] velocity of the solid that pushed it in the last step
        ("deep", np.float64),  # [px] how deep it overlaps a solid that moved into it, after the last step
        ("wedged", np.bool_),  # pressed against a ceiling by a body under its feet
    ],
    align=True,
)
