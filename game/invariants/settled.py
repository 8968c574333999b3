"""U6: what has settled overlaps by no more than a few slops."""

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import STATIC

SLOPS, HEAVY_SLOPS = 2.0, 5.0  # allowed overlap; where the masses differ by more than …
HEAVY = 100.0  # … this ratio (hard_cases U6)
CALM_TIME = 0.5  # [s] for which nothing of a heap moves faster than what falls asleep, before it has settled


class Settled(Invariant):
    """U6: two slops at most, five where masses differ by more than 100 : 1, of what has been slow for half a second,
    together with all it touches.

    Asked of worlds that stack: the other solvers push out what they meet in a step, and promise nothing of piles.
    """

    id, word = "U6", "overlap"

    def __init__(self) -> None:
        self.ids = np.zeros(0, np.int64)
        self.calm = np.zeros(0)  # [s] for which each has been slow

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        world, now = step.world, step.now
        self._count_calm(step)
        if not world.stacks:
            return NotAsked("nothing piles up: no stacking solver")
        restless = step.spread(self.calm <= CALM_TIME, now.kind != STATIC)
        a, b = step.sides
        settled = ~restless[a] & ~restless[b]
        if not settled.any():
            return NotAsked("nothing that is touched has been slow for half a second")
        masses = now.mass[now.mass > 0.0]
        slops = HEAVY_SLOPS if masses.max() > HEAVY * masses.min() else SLOPS
        depths = np.where(settled, -step.contacts["separation"], 0.0)
        deepest = int(np.argmax(depths))
        if depths[deepest] <= slops * step.slop:
            return None
        row = step.contacts[deepest]
        bodies = (row["body_a"], row["body_b"])
        return self.broken(step, bodies, depths[deepest], slops * step.slop, "settled bodies overlap [px]")

    def _count_calm(self, step):
        now, limit = step.now, step.world.tolerances.sleep_speed
        if not np.array_equal(now.ids, self.ids):
            kept = dict(zip(self.ids.tolist(), self.calm.tolist(), strict=True))
            self.calm = np.array([kept.get(identity, 0.0) for identity in now.ids.tolist()])
            self.ids = now.ids
        slow = np.maximum(now.speed, np.abs(now.turn) * step.world.bodies["extent"]) <= limit
        slow &= ~step.changed & ~step.forced
        slow |= now.kind == STATIC
        self.calm = np.where(slow, self.calm + step.dt, 0.0)
        self.calm[now.kind == STATIC] = np.inf
