"""What is told of manifolds: the shapes that touch, whichever parts of them do."""

import numpy as np

from physics.jit import kernel

SIDES = ("body_", "shape_", "owner_", "body_row_", "row_")


@kernel
def are_whole(manifolds):
    """Whether no side of any manifold is a part of another shape. O(manifolds)."""
    for i in range(len(manifolds)):
        m = manifolds[i]
        if m.owner_a != m.shape_a or m.owner_b != m.shape_b:
            return False
    return True


def by_owner(manifolds: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """(MANIFOLD rows that name the shapes whose parts touch, in the order of these; their rows before, None: the same).

    That a mask has parts is nobody's business, nor that they may have come later than what they touch: A is the shape
    with the smaller id here too.
    """
    if are_whole(manifolds):
        return manifolds, None
    a, b = manifolds["owner_a"], manifolds["owner_b"]
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
