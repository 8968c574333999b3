"""U9: the order in which bodies were added changes no more than the noise of sums."""

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import World

NOISE = 1e-9  # of where bodies are, after 60 steps, before chaos sets in (invariant U9)
COMPARED = ("x", "y", "angle", "vx", "vy", "angular_velocity")


class Order(Invariant):
    """Cannot be asked of a world that runs, which has one order only: its light is never green. `furthest_apart` asks
    it of two worlds, and tests do (tests/game/test_invariants.py).

    It holds of bodies that do not press on each other. Those that do are solved one contact after the other, in an
    order that begins with their ids, and what a step leaves unsolved depends on it: four columns of three boxes differ
    by 2e-7 of where they stand after 60 steps where substeps follow from the loads, by 5e-5 with 4 of them.
    """

    id, word = "U9", "order"

    def look(self, step: Step) -> Answer:
        """Never asked."""
        return NotAsked("takes a second world: tests ask it")


def furthest_apart(one: World, other: World, ids: np.ndarray) -> float:
    """The greatest difference of two worlds, relative to where bodies are and how fast; ids[k]: of the body in `other`
    that is the k-th of `one`."""
    rows, twins = one.bodies, other.bodies[other.rows(ids)]
    worst = 0.0
    for name in COMPARED:
        size = max(1.0, float(np.abs(rows[name]).max())) if len(rows) else 1.0
        worst = max(worst, float(np.abs(rows[name] - twins[name]).max()) / size if len(rows) else 0.0)
    return worst
