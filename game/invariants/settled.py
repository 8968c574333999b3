"""Invariant U6: settled bodies overlap by no more than a few slops."""

import math

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import STATIC
from physics.settings import CONTACT_HERTZ, HERTZ_SHARE

SLOPS, HEAVY_SLOPS = 2.0, 5.0  # allowed overlap; with masses that differ by more than …
HEAVY = 100.0  # … this ratio (U6)
CALM_TIME = 0.5  # [s] a pile has settled once all of it has been slower than the sleeping speeds for so long


class Settled(Invariant):
    """Invariant U6: bodies at rest hardly overlap.

    A body is at rest if it and all bodies that it touches have been slow for half a second. Two slops are allowed, five
    where masses differ by more than 100 : 1.

    With a fixed number of substeps, contacts are springs of 60 Hz, less stiff than their loads need: the overlap by
    which they yield (`sag`) is allowed in addition. After the ball has hit the twelve rows of lab/pyramid, they settle
    at an overlap of 0.328 px with 4 substeps; two slops are 0.320 px, and the sag of one contact is a tenth of a pixel.

    U6 is checked in worlds with the effect `stacking`: the other solvers separate the overlaps of one step and
    guarantee nothing for piles.
    """

    id, word = "U6", "overlap"

    def __init__(self) -> None:
        self.ids = np.zeros(0, np.int64)
        self.calm = np.zeros(0)  # [s] for which each body has been slow

    def look(self, step: Step) -> Answer:
        """Check the invariant for the last step. Return a Broken, a NotAsked, or None if it holds."""
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
        allowed = slops * step.slop + sag(step, a, b)
        depths = np.where(settled, -step.contacts["separation"], 0.0)
        row = int(np.argmax(depths - allowed))
        if depths[row] <= allowed[row]:
            return None
        bodies = now.ids[[a[row], b[row]]]
        return self.broken(step, bodies, depths[row], allowed[row], "settled bodies overlap [px]")

    def _count_calm(self, step):
        now, limit = step.now, step.world.tolerances.sleep_speed
        if not np.array_equal(now.ids, self.ids):
            kept = dict(zip(self.ids.tolist(), self.calm.tolist(), strict=True))
            self.calm = np.array([kept.get(identity, 0.0) for identity in now.ids.tolist()])
            self.ids = now.ids
        slow = np.maximum(step.max_speed, np.abs(now.turn) * step.world.bodies["extent"]) <= limit
        slow &= ~step.changed & ~step.forced
        slow |= now.kind == STATIC
        self.calm = np.where(slow, self.calm + step.dt, 0.0)
        self.calm[now.kind == STATIC] = np.inf


def sag(step: Step, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return (n,) overlap [px] of each contact that its normal force in the step causes, because a contact is a spring.

    a, b: (n,) body rows of the contacts. The overlap is F / (m ω²), with m the effective mass of the contact; 0 if the
    number of substeps follows from the loads.
    """
    world, rows, now = step.world, step.contacts, step.now
    substeps = world.substeps
    if isinstance(substeps, str) or step.dt == 0.0 or not len(rows):  # "auto"
        return np.zeros(len(rows))
    inverse = np.zeros(len(rows))
    for side in (a, b):
        arm = (rows["point_x"] - now.cx[side]) * rows["normal_y"] - (rows["point_y"] - now.cy[side]) * rows["normal_x"]
        inverse += world.bodies["inverse_mass"][side] + arm * arm * world.bodies["inverse_inertia"][side]
    hertz = min(CONTACT_HERTZ, HERTZ_SHARE * substeps / step.dt)
    return rows["normal_impulse"] / step.dt * inverse / (2.0 * math.pi * hertz) ** 2
