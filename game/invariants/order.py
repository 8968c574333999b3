"""Invariant U9: the order in which bodies were added changes results at most by the rounding errors of sums."""

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import World

NOISE = 1e-9  # of the positions of bodies, after 60 steps, before chaos sets in (U9)
COMPARED = ("x", "y", "angle", "vx", "vy", "angular_velocity")


class Order(Invariant):
    """Invariant U9: results do not depend on the order in which bodies were added, except for rounding errors.

    In a running world, bodies have only one order, so U9 cannot be checked there and is never green. Tests compare two
    worlds with `furthest_apart` (tests/game/test_invariants.py).

    U9 holds for bodies that do not press on each other. Loaded contacts are solved one after another, in an order that
    depends on the ids. The remaining error of a step depends on this order. Four columns of three boxes differ by 2e-7
    of their positions after 60 steps with substeps by load, and by 5e-5 with 4 substeps.
    """

    id, word = "U9", "order"

    def look(self, step: Step) -> Answer:
        """Return NotAsked, because the check needs a second world."""
        return NotAsked("takes a second world: tests ask it")


def furthest_apart(one: World, other: World, ids: np.ndarray) -> float:
    """Return the greatest relative difference between the bodies of two worlds, over the columns COMPARED.

    Each difference is divided by the greatest absolute value of its column in `one`, but by at least 1. ids: (n,) ids
    in `other`, in the order of the bodies of `one`.
    """
    rows, twins = one.bodies, other.bodies[other.rows(ids)]
    worst = 0.0
    for name in COMPARED:
        size = max(1.0, float(np.abs(rows[name]).max())) if len(rows) else 1.0
        worst = max(worst, float(np.abs(rows[name] - twins[name]).max()) / size if len(rows) else 0.0)
    return worst
