"""CHARACTER: one row per Character, which moves in whole pixels."""

import numpy as np

CHARACTER = np.dtype(
    [  # one per Character: moves in whole pixels
        ("body", np.int64),  # id
        ("body_row", np.int64),
        ("shape", np.int64),  # id of its body's shape
        ("shape_row", np.int64),
        ("left", np.int64),
        ("top", np.int64),  # [px] pixel column and row of its box: the bounds of its shape, feet and left side exact
        ("width", np.int64),
        ("height", np.int64),  # [px]
        ("offset_x", np.float64),
        ("offset_y", np.float64),  # [px] of its shape's origin from the box's top left corner
        ("is_box", np.bool_),  # its shape is the box itself, which meets other boxes on the pixel grid
        ("climb", np.float64),  # rise per px of the steepest ground that it walks
        ("remainder_x", np.float64),
        ("remainder_y", np.float64),  # [px] motion that has not made a whole pixel yet
        ("previous_left", np.int64),
        ("previous_top", np.int64),  # before the last move: for interpolated drawing
        ("riding", np.int64),  # id of the body under its feet that may carry it, -1: none
        ("riding_shape", np.int64),  # id of the shape of that body that it stands on
        ("carried", np.int64),  # [px] by what it rides, along the axis that is being carried
        ("grounded", np.bool_),
        ("squeezed", np.bool_),  # by a solid that it could not give way to, since its last move
        ("pushable", np.bool_),  # solid for the others, and gives way to them
        ("drop", np.bool_),  # falls through one-way tiles in this move
        ("wall", np.int64),  # -1 left, 1 right, 0 none
        ("slope", np.float64),  # rise per px to the right of the ground under its feet
        ("mass", np.float64),  # [density px2] these all: in worlds that stack
        ("push", np.float64),  # [px/s2] how hard it pushes bodies, per mass
        ("pressed", np.int64),  # id of the body that bore it in the last step, -1: none
        ("foot_x", np.float64),
        ("foot_y", np.float64),  # [px] the point that stood on it
        ("carry_x", np.float64),
        ("carry_y", np.float64),  # [px] motion of what it rides that has not made a whole pixel yet
        ("belt", np.float64),  # [px/s] at which the ground under its feet runs to the right
        ("belt_x", np.float64),  # [px] of that which has not made a whole pixel yet
        ("push_vx", np.float64),
        ("push_vy", np.float64),  # [px/s] of the solid that pushed it in the last step
        ("deep", np.float64),  # [px] it is in something that came into it, after the last step
        ("wedged", np.bool_),  # something under its feet presses it against a ceiling
    ],
    align=True,
)
