"""Invariant U11: no step reaches a limit on iterations or substeps."""

import numpy as np

from game.invariants.invariant import Answer, Invariant
from game.invariants.step import Step


class Caps(Invariant):
    """Invariant U11: no limit (cap) was reached in the step.

    The invariant holds if no iterative search stopped at its limit and no island needed more than the greatest number
    of substeps.
    """

    id, word = "U11", "caps"

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, or None if the invariant holds."""
        world = step.world
        hits = world.profile.counters["cap_hits"]
        if not hits:
            return None
        asking = world.bodies["cooldown"] < 0.0  # islands that need more than the greatest number of substeps
        bodies = np.flatnonzero(asking)[:4]
        return self.broken(step, world.bodies["id"][bodies], hits, 0, "caps hit")
