"""Comparison of all collision tiers (kinds of collision shape) of sprites with the exact pixels, in a running world.

ask() tests one tier per call, which keeps each call short. After all tiers are tested at one snapshot, a new snapshot
is taken. The tests run in a separate world, so that they do not affect the scene.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from game.measure.errors import Verdicts, pairs_of
from game.measure.moment import Moment
from game.measure.rates import Rate
from physics import TIERS, World, debug

REFERENCE = "mask"
Pairs = set[tuple[int, int]]  # ids of bodies


class ReferenceTier:
    """Comparison of all collision tiers of sprites (circle, box, ... pixels) with the tier "mask", the exact pixels.

    Call ask(world) once per step. The results are stored in these attributes:

    wrong: {tier: rate of false hits among the reported hits}. missed: {tier: rate of missed hits among the true hits}.
    Both include all snapshots at which every tier was tested. A pair of bodies counts once, even if it is found at
    several snapshots.

    lit: name of the tier whose errors are drawn. seen: errors of this tier at the last snapshot, a list of (is a false
    hit, outlines of both bodies). An error that is no false hit is a missed hit.
    """

    def __init__(self, lit: str, tiers: Sequence[str] = TIERS) -> None:
        self.lit, self.seen = lit, list[tuple[bool, list[Any]]]()
        self.tiers = tuple(tier for tier in tiers if tier != REFERENCE)
        self.wrong = dict.fromkeys(self.tiers, Rate(0, 0))
        self.missed = dict.fromkeys(self.tiers, Rate(0, 0))
        self._met: dict[str, set[tuple[int, int]]] = {tier: set() for tier in (*self.tiers, REFERENCE)}
        self.moments = 0
        self._moment: Moment | None = None
        self._hits: dict[str, Pairs] = {}

    def ask(self, world: World) -> bool:
        """Find the touching pairs of bodies with the next collision tier (kind of collision shape).

        Return whether it was the last tier. The call for the first tier takes a snapshot of the world, at which all
        tiers are then tested.
        """
        if self._moment is None:
            self._moment, self._hits = Moment(world.snapshot(), world.broadphase.name), {}
        waiting = [tier for tier in (REFERENCE, *self.tiers) if tier not in self._hits]
        self._hits[waiting[0]] = self._verdict(self._moment, waiting[0])
        if len(waiting) > 1:
            return False
        for tier, hits in self._hits.items():
            self._met[tier] |= hits
        true = frozenset(self._met[REFERENCE])
        for tier in self.tiers:
            found = Verdicts(frozenset(self._met[tier]), true, own=False)
            self.wrong[tier], self.missed[tier] = found.wrong, found.missed
        self.moments, self._moment = self.moments + 1, None
        return True

    def _verdict(self, moment, tier):
        world = moment.world(moment.here._replace(tier=tier, narrowphase=True))
        world.step(0.0)
        hits = pairs_of(world)
        if tier == self.lit:
            true = self._hits[REFERENCE]
            self.seen = [(True, _outlines(world, pair)) for pair in sorted(hits - true)]
            self.seen += [(False, _outlines(world, pair)) for pair in sorted(true - hits)]
        return hits

    def state(self) -> tuple[int, ...]:
        """Return the counts so far, which are part of the scene's state for the digest."""
        rates = [*self.wrong.values(), *self.missed.values()]
        return self.moments, len(self._hits), *(number for rate in rates for number in rate)


def _outlines(world, pair):
    return debug.outlines(world, np.flatnonzero(np.isin(world.shapes["body"], pair)))
