"""Invariant U11: no limit on iterations or substeps was hit."""

import numpy as np

from game.invariants.invariant import Answer, Invariant
from game.invariants.step import Step


class Caps(Invariant):
    """Invariant U11: no limit (cap) was hit in the step.

    No search ended early, and no island needed more than the greatest number of substeps.
    """

    id, word = "U11", "caps"

    def look(self, step: Step) -> Answer:
        """Check the invariant for the last step. Return a Broken, or None if it holds."""
        world = step.world
        hits = world.profile.counters["cap_hits"]
        if not hits:
            return None
        asking = world.bodies["cooldown"] < 0.0  # islands that need more than the greatest number of substeps
        bodies = np.flatnonzero(asking)[:4]
        return self.broken(step, world.bodies["id"][bodies], hits, 0, "caps hit")
