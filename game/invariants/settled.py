"""Invariant U6: settled bodies overlap by no more than a few slops."""

import math

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import STATIC
from physics.settings import CONTACT_HERTZ, HERTZ_SHARE

SLOPS, HEAVY_SLOPS = 2.0, 5.0  # allowed overlap; with masses that differ by more than …
HEAVY = 100.0  # … this ratio (U6)
CALM_TIME = 0.5  # [s] time below the sleeping speeds after which a pile has settled


class Settled(Invariant):
    """Invariant U6: bodies at rest overlap by at most two slops.

    A body is at rest if it and all bodies connected to it by contacts or joints have been slow for half a second. Five
    slops are allowed if masses differ by more than 100 : 1.

    With a fixed number of substeps, contacts are springs of 60 Hz, which are softer than their loads require. The
    overlap that this causes (`sag`) is also allowed. After the ball has hit the twelve rows of lab/pyramid, they settle
    at an overlap of 0.328 px with 4 substeps. Two slops are 0.320 px, and the sag of one contact is a tenth of a pixel.

    U6 is checked only in worlds with the effect `stacking`. The other solvers separate only the overlaps of one step,
    and guarantee nothing for piles.
    """

    id, word = "U6", "overlap"

    def __init__(self) -> None:
        self.ids = np.zeros(0, np.int64)
        self.calm = np.zeros(0)  # [s] for which each body has been slow

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, a NotAsked, or None if the invariant holds."""
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
    """Return the (n,) overlaps [px] that the contacts have because each contact is a spring under a normal force.

    a, b: (n,) rows of the two bodies of each contact. The overlap is F / (m ω²), with m the effective mass of the
    contact. It is 0 if the number of substeps is chosen by load.
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
