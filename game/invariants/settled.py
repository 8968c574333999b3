"""U6: what has settled overlaps by no more than a few slops."""

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step

SLOPS, HEAVY_SLOPS = 2.0, 5.0  # allowed overlap; where the masses differ by more than …
HEAVY = 100.0  # … this ratio (hard_cases U6)
CALM_TIME = 0.5  # [s] for which nothing moves faster than what falls asleep, before a world has settled


class Settled(Invariant):
    """U6: two slops at most, five where masses differ by more than 100 : 1, once all has been slow for half a second.

    Asked of worlds that stack: the other solvers push out what they meet in a step, and promise nothing of piles.
    """

    id, word = "U6", "overlap"

    def __init__(self) -> None:
        self.calm = 0.0  # [s]

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        world, now = step.world, step.now
        if not world.stacks:
            return NotAsked("nothing piles up: no stacking solver")
        if not now.dynamic.any():
            return NotAsked("nothing is dynamic")
        reach = world.bodies["extent"]
        fastest = np.maximum(now.speed, np.abs(now.turn) * reach)
        if step.edited or step.forced or (fastest > world.tolerances.sleep_speed).any():
            self.calm = 0.0
            return NotAsked("something moves")
        self.calm += world.dt
        if self.calm <= CALM_TIME:
            return NotAsked("not yet slow for half a second")
        masses = now.mass[now.mass > 0.0]
        slops = HEAVY_SLOPS if len(masses) and masses.max() > HEAVY * masses.min() else SLOPS
        if step.overlap <= slops * step.slop:
            return None
        row = step.contacts[int(np.argmin(step.contacts["separation"]))]
        bodies = (row["body_a"], row["body_b"])
        return self.broken(step, bodies, step.overlap, slops * step.slop, "settled bodies overlap [px]")
