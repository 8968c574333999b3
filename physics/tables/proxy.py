"""PROXY: what a broad phase sees of a shape."""

import numpy as np

PROXY = np.dtype(
    [  # what a broad phase sees; slots are reused
        ("lower_x", np.float64),  # [px] bounding motion rectangle
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("row", np.int64),  # of the shape, this step; -1: the slot is free
        ("awake", np.bool_),  # in the rows that a step goes over: two that are not never pair
        ("still", np.bool_),  # static: two still proxies never pair
        ("changed", np.bool_),  # box, filter or existence changed since the last update
        ("body", np.int64),  # id: two shapes of one body never pair
        ("membership", np.int64),
        ("mask", np.int64),
        ("plane", np.int64),  # one bit: what it is there for, and …
        ("avoids", np.int64),  # … what it never pairs with, whatever the filters say
    ],
    align=True,
)
