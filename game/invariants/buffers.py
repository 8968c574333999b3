"""U11: every overflow of a cap is reported."""

import numpy as np

from game.invariants.invariant import Answer, Invariant
from game.invariants.step import Step


class Caps(Invariant):
    """U11: no cap was hit in the step: no search ended early, no island asked for more substeps than there are."""

    id, word = "U11", "caps"

    def look(self, step: Step) -> Answer:
        """Check it for the last step."""
        world = step.world
        hits = world.profile.counters["cap_hits"]
        if not hits:
            return None
        asking = world.bodies["cooldown"] < 0.0  # islands that need more than the greatest number of substeps
        bodies = np.flatnonzero(asking)[:4]
        return self.broken(step, world.bodies["id"][bodies], hits, 0, "caps hit")
