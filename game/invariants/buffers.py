"""U11: what does not fit is told, never dropped."""

import numpy as np

from game.invariants.invariant import Answer, Invariant
from game.invariants.step import Step


class Caps(Invariant):
    """U11: no cap was hit in the step: no search ended early, no island asked for more substeps than there are."""

    id, word = "U11", "caps"

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        world = step.world
        hits = world.profile.counters["cap_hits"]
        if not hits:
            return None
        asking = world.bodies["cooldown"] < 0.0  # those whose island asked for more than the most substeps
        bodies = np.flatnonzero(asking)[:4]
        return self.broken(step, world.bodies["id"][bodies], hits, 0, "caps hit")
