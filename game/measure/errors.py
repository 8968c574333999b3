"""The errors of a setting at a moment, against reference runs and exact tests.

There are three kinds of error, in pixels. `way`: distance of the bodies from their positions in a reference run.
`overlap`: how deep rigid bodies overlap, which is 0 in an exact solution. `verdict`: by how much a false hit misses, or
a missed hit overlaps.

The reference run of `way` has 64 times the 4 substeps of a plain run, and the contact stiffness of runs with a fixed
number of substeps. Erez, Tassa and Todorov (ICRA 2015) compare engines with themselves at smaller steps in this way.
The reference is valid for the steps in which a second run, with 32 times the substeps, differs from it by at most a
tenth of a pixel; this excludes chaotic motion. Errors below a floor are not significant. The floor is the larger of two
numbers: ten times the difference of these two runs, and the difference between the reference and a third run, which has
the stiffest contacts.
"""

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from game.measure.moment import STEPS, Moment, Way, failures_of
from game.measure.rates import Rate
from game.measure.setting import Setting
from physics import World, distance

VISIBLE = 1.0  # [px] error that a player can see
AGREED = 0.1  # largest uncertainty of the reference, as a share of the error and of VISIBLE
FINE, COARSE = 64, 32  # multiples of PLAIN substeps
PLAIN = 4
LOOKS = 12  # number of steps of a run in which touching pairs are compared


@dataclass(frozen=True)
class Error:
    """One kind of error of a setting, in pixels.

    floor: errors below it are within the uncertainty of the reference. steps: number of steps after which the error was
    read. failures: counts of failures during the run.
    """

    value: float
    floor: float = 0.0
    steps: int = 0
    failures: dict[str, int] = field(default_factory=dict)
    wrong: Rate | None = None  # false hits, of all reported hits
    missed: Rate | None = None  # missed hits, of all true hits

    @property
    def above_floor(self) -> bool:
        """Return whether the error is above the uncertainty of the reference."""
        return self.value > self.floor


class Reference(NamedTuple):
    """Reference run, with which the runs of other settings are compared."""

    way: Way
    horizon: int  # number of steps for which the reference is valid
    floor: float  # [px] errors below it are not significant


class References:
    """Reference run of a moment, computed at first use, and the errors of settings against this run."""

    def __init__(self, moment: Moment) -> None:
        self.moment = moment
        self.truth: Setting = moment.here._replace(narrowphase=True)
        if moment.here.tier is not None:
            self.truth = self.truth._replace(tier="mask")
        if moment.effects.stacking:
            self.truth = self.truth._replace(solver="soft_step", substeps=FINE * PLAIN)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of error of this moment; the most important first."""
        return ("overlap", "way") if self.moment.effects.response else ("verdict",)

    @cached_property
    def reference(self) -> Reference:
        """Run with the finest steps, the number of steps for which it is a valid reference, and the floor [px]."""
        if self.moment.effects.stacking:
            fine = self.moment.way(self.truth)
            coarse = self.moment.way(self.truth._replace(substeps=COARSE * PLAIN))
            stiff = self.moment.way(self.truth._replace(substeps="auto"))
        else:
            fine = stiff = self.moment.way(self.truth, divided=FINE)
            coarse = self.moment.way(self.truth, divided=COARSE)
        unsure, softness = coarse.apart(fine), stiff.apart(fine)
        sure = unsure <= AGREED * VISIBLE
        last = len(sure) if sure.all() else max(1, int(np.argmin(sure)))
        return Reference(fine, last, float(max(unsure[last - 1] / AGREED, softness[last - 1])))

    def errors(self, setting: Setting) -> dict[str, Error]:
        """Return {kind: Error} of a setting."""
        if not self.moment.effects.response:
            return {"verdict": self._verdict(setting)}
        (fine, last, floor), way = self.reference, self.moment.way(setting)
        return {
            "overlap": Error(float(np.median(way.overlap)), 0.0, STEPS, way.failures),
            "way": Error(float(way.apart(fine)[last - 1]), floor, last, way.failures),
        }

    def _verdict(self, setting) -> Error:
        """Return the "verdict" error of a setting: in LOOKS of the steps, the touching pairs are compared with those of
        an exact world.

        Bodies move alike in both worlds, because there is no collision response.
        """
        world, true = self.moment.world(setting), self.moment.world(self.truth)
        wrong = missed = hits = reports = 0
        pixels, failures = 0.0, Counter()
        for step in range(STEPS):
            world.step()
            true.step()
            failures += failures_of(world)
            if step % (STEPS // LOOKS):
                continue
            reported, actual = pairs_of(world), pairs_of(true)
            wrong, missed = wrong + len(reported - actual), missed + len(actual - reported)
            reports, hits = reports + len(reported), hits + len(actual)
            pixels += sum(abs(gap(true, *pair)) for pair in reported ^ actual)
        decided = reports + missed
        value = pixels / decided if decided else 0.0
        return Error(value, 0.0, STEPS, failures, Rate(wrong, reports), Rate(missed, hits))


def pairs_of(world: World) -> set[tuple[int, int]]:
    """Return the pairs of ids of touching bodies, the smaller id first.

    With this order, pairs of worlds at different tiers can be compared: which body of a contact is A depends on the
    shapes.
    """
    contacts = world.contacts[world.contacts["separation"] <= 0.0]  # contacts include pairs about to meet
    ids = np.sort(np.stack([contacts["body_a"], contacts["body_b"]], axis=1), axis=1)
    return set(map(tuple, ids.tolist()))


def gap(world: World, first: int, second: int) -> float:
    """Return the separation [px] of the bodies with the ids `first` and `second`: the least over their shapes, negative
    if they overlap.
    """
    a, b = world.body(first), world.body(second)
    poses = [(body.position.x, body.position.y, body.angle) for body in (a, b)]
    return min(distance(s, poses[0], t, poses[1]).distance for s in a.shapes for t in b.shapes)
