"""Row type CHARACTER: one row for each Character, which moves in whole pixels."""

import numpy as np

CHARACTER = np.dtype(
    [  # one row for each Character
        ("body", np.int64),  # id
        ("body_row", np.int64),
        ("shape", np.int64),  # id of the shape of its body
        ("shape_row", np.int64),
        # [px] Pixel column and row of the box: the bounds of the shape, exact at feet and left side.
        ("left", np.int64),
        ("top", np.int64),
        ("width", np.int64),  # [px]
        ("height", np.int64),
        ("offset_x", np.float64),  # [px] origin of the shape relative to the top left corner of the box
        ("offset_y", np.float64),
        ("is_box", np.bool_),  # the shape is the box itself, so it is tested against other boxes on the pixel grid
        ("climb", np.float64),  # steepest walkable ground [rise per px]
        ("remainder_x", np.float64),  # [px] motion below one whole pixel, kept for the next move
        ("remainder_y", np.float64),
        ("previous_left", np.int64),  # position before the last move, for interpolated drawing
        ("previous_top", np.int64),
        ("riding", np.int64),  # id of the body under the feet, which may carry the character; -1: none
        ("riding_shape", np.int64),  # id of the shape of that body under the feet
        ("carried", np.int64),  # [px] motion by its support along the present axis
        ("grounded", np.bool_),
        ("squeezed", np.bool_),  # since its last move, a solid pushed the character, and it could not yield
        ("pushable", np.bool_),  # solid for other characters, and yields to them
        ("drop", np.bool_),  # the character falls through one-way tiles in this move
        ("wall", np.int64),  # -1 left, 1 right, 0 none
        ("slope", np.float64),  # slope of the ground under its feet [rise per px to the right]
        # The remaining fields are used in worlds that stack.
        ("mass", np.float64),  # [density px2]
        ("push", np.float64),  # [px/s2] greatest force per mass with which the character pushes bodies
        ("pressed", np.int64),  # id of the body that supported the character in the last step, -1: none
        ("foot_x", np.float64),  # [px] contact point on that body
        ("foot_y", np.float64),
        ("carry_x", np.float64),  # [px] motion of its support below one whole pixel, kept for the next step
        ("carry_y", np.float64),
        ("belt", np.float64),  # [px/s] surface speed of the ground under the feet, to the right
        ("belt_x", np.float64),  # [px] motion by the surface speed below one whole pixel, kept for the next step
        ("push_vx", np.float64),  # [px/s] velocity of the solid that pushed the character in the last step
        ("push_vy", np.float64),
        ("deep", np.float64),  # [px] overlap with a solid that moved into the character, after the last step
        ("wedged", np.bool_),  # pressed against a ceiling by a body under the feet
    ],
    align=True,
)
