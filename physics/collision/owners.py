"""What is told of manifolds: the shapes that touch, whichever parts of them do."""

import numpy as np

SIDES = ("body_", "shape_", "owner_", "body_row_", "row_")


def by_owner(manifolds: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """(MANIFOLD rows that name the shapes whose parts touch, in the order of these; their rows before, None: the same).

    That a mask has parts is nobody's business, nor that they may have come later than what they touch: A is the shape
    with the smaller id here too.
    """
    a, b = manifolds["owner_a"], manifolds["owner_b"]
    if np.array_equal(a, manifolds["shape_a"]) and np.array_equal(b, manifolds["shape_b"]):
        return manifolds, None
    order = np.lexsort((np.maximum(a, b), np.minimum(a, b)))
    found = manifolds[order]
    found["shape_a"], found["shape_b"] = found["owner_a"], found["owner_b"]
    turned = np.flatnonzero(found["owner_a"] > found["owner_b"])
    if len(turned):
        for name in SIDES:
            found[name + "a"][turned], found[name + "b"][turned] = (
                found[name + "b"][turned],
                found[name + "a"][turned],
            )
        for name in ("normal_x", "normal_y"):
            found[name][turned] = 0.0 - found[name][turned]
    return found, order
