"""The errors of a setting, measured in runs from a snapshot ("moment"), against reference runs and exact tests.

There are four kinds of error:
  `way` [px]: root mean square distance of the bodies from their positions in a reference run.
  `overlap` [px]: how deep rigid bodies overlap, which is 0 in an exact solution.
  `joints` [px]: the widest gap between the anchors of a joint, which is 0 in an exact solution. It is measured in the
  second half of the run, because gaps at the start come from the setting under which the scene ran before.
  `verdict`: wrong answers (false hits and missed hits) per 100 encounters.

An encounter is a pair of bodies that the setting or the exact test reports as touching (see exact_tier). A pair counts
once, no matter how long it touches, so that encounters are independent.

The reference run of `way` has 64 times the 4 substeps of a plain run. Its contacts have the stiffness of runs with a
fixed number of substeps. Erez, Tassa and Todorov (ICRA 2015) compare engines with themselves at smaller steps in this
way. A second run has 32 times the substeps. The reference is valid for the steps in which the two runs differ by at
most a tenth of a pixel. This excludes chaotic motion.

Errors below a floor are not significant. The floor is the larger of two numbers. The first is ten times the difference
of these two runs. The second is the difference between the reference and a third run, which has the stiffest contacts.
"""

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from game.measure.moment import STEPS, Moment, Way, failures_of
from game.measure.rates import Rate
from game.measure.setting import Setting
from physics import World

VISIBLE = 1.0  # [px] error that a player can see
AGREED = 0.1  # largest uncertainty of the reference, as a share of the error and of VISIBLE
FINE, COARSE = 64, 32  # multiples of PLAIN substeps
PLAIN = 4
LOOKS = 12  # number of steps of a run in which touching pairs are compared
Pairs = frozenset[tuple[int, int]]  # ids of two bodies, the smaller first


@dataclass(frozen=True)
class Verdicts:
    """The pairs of bodies that a setting reported as hits in a run, and the pairs that were true hits.

    The rates are computed at first use and stored, because the plot and the advice read them in every drawn picture.
    """

    reported: Pairs
    true: Pairs
    own: bool  # True if the setting decides by the exact test itself: then no other answer is possible

    @cached_property
    def wrong(self) -> Rate:
        """Rate of false hits among the reported hits."""
        return Rate(len(self.reported - self.true), len(self.reported))

    @cached_property
    def missed(self) -> Rate:
        """Rate of missed hits among the true hits."""
        return Rate(len(self.true - self.reported), len(self.true))

    @cached_property
    def either(self) -> Rate:
        """Rate of wrong answers among all encounters."""
        return Rate(len(self.reported ^ self.true), len(self.reported | self.true))


@dataclass(frozen=True)
class Error:
    """One kind of error of a setting: in pixels, or in wrong answers per 100 encounters if it has `verdicts`.

    floor: value [px] below which an error is within the uncertainty of the reference. steps: number of steps after
    which the error was read. failures: counts of failures during the run, by kind.
    """

    value: float
    floor: float = 0.0
    steps: int = 0
    failures: dict[str, int] = field(default_factory=dict)
    verdicts: Verdicts | None = None

    @classmethod
    def of(cls, verdicts: Verdicts, steps: int, failures: dict[str, int]) -> "Error":
        """Return the Error of a setting with these verdicts, in wrong answers per 100 encounters.

        steps, failures: see Error.
        """
        return cls(100.0 * verdicts.either.share, 0.0, steps, failures, verdicts)

    @property
    def above_floor(self) -> bool:
        """Whether the error is above the uncertainty of the reference."""
        return self.value > self.floor

    @property
    def interval(self) -> tuple[float, float]:
        """(low, high) ends of the 95 % confidence interval of the error.

        For an error in pixels, both are its value, or 0 if it is not above the floor.
        """
        if self.verdicts is None or self.verdicts.own:
            value = self.value if self.above_floor else 0.0
            return value, value
        low, high = self.verdicts.either.interval
        return 100.0 * low, 100.0 * high

    @property
    def wrong(self) -> Rate | None:
        """Rate of false hits among the reported hits; None for an error in pixels."""
        return self.verdicts and self.verdicts.wrong

    @property
    def missed(self) -> Rate | None:
        """Rate of missed hits among the true hits; None for an error in pixels."""
        return self.verdicts and self.verdicts.missed


class Reference(NamedTuple):
    """Reference run that the runs of other settings are compared with."""

    way: Way
    horizon: int  # number of steps for which the reference is valid
    floor: float  # [px] errors below it are not significant


class References:
    """The reference run from one snapshot of a world, and the errors of settings against it.

    The reference run is computed at its first use.
    """

    def __init__(self, moment: Moment) -> None:
        self.moment = moment
        self.truth: Setting = moment.here._replace(narrowphase=True)
        if moment.here.tier is not None:
            self.truth = self.truth._replace(tier=exact_tier(moment.here.tier))
        if moment.effects.stacking:
            self.truth = self.truth._replace(solver="soft_step", substeps=FINE * PLAIN)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of error that are measured from this snapshot, most important first."""
        if not self.moment.effects.response:
            return ("verdict",)
        return ("overlap", "way") if self.moment.here.joint_solver is None else ("overlap", "way", "joints")

    @cached_property
    def reference(self) -> Reference:
        """The reference run with the finest steps, as a Reference.

        The Reference includes the number of steps for which the run is valid, and the floor of significant errors [px].
        """
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
        """Return {kind: Error} of a setting, measured in a run from this snapshot."""
        if not self.moment.effects.response:
            return {"verdict": self._verdict(setting)}
        (fine, last, floor), way = self.reference, self.moment.way(setting)
        found = {
            "overlap": Error(float(np.median(way.overlap)), 0.0, STEPS, way.failures),
            "way": Error(float(way.apart(fine)[last - 1]), floor, last, way.failures),
            "joints": Error(float(way.gaps[len(way.gaps) // 2 :].max()), 0.0, STEPS, way.failures),
        }
        return {kind: found[kind] for kind in self.kinds}

    def _verdict(self, setting) -> Error:
        """Return the error "verdict" of a setting: wrong answers per 100 encounters.

        At LOOKS steps of the run, the touching pairs are compared with those of a world with the exact test. Bodies
        move in the same way in both worlds, because there is no collision response.
        """
        world, true = self.moment.world(setting), self.moment.world(self.truth)
        reported, hits, failures = set(), set(), Counter()
        for step in range(STEPS):
            world.step()
            true.step()
            failures += failures_of(world)
            if step % (STEPS // LOOKS) == 0:
                reported |= pairs_of(world)
                hits |= pairs_of(true)
        own = (setting.tier, setting.narrowphase) == (self.truth.tier, self.truth.narrowphase)
        return Error.of(Verdicts(frozenset(reported), frozenset(hits), own), STEPS, failures)


def exact_tier(tier: str) -> str:
    """Return the collision tier (kind of collision shape) whose answers are correct in a world with the tier `tier`.

    The correct tier is the one that tests the pixels as they are drawn. "mask" tests the pixels at their exact poses,
    and is correct for a scene that uses "mask". In other scenes sprites are drawn on whole pixels, so "pixels" is
    correct. Two sprites that overlap by less than half a pixel are then drawn side by side.
    """
    return "mask" if tier == "mask" else "pixels"


def pairs_of(world: World) -> set[tuple[int, int]]:
    """Return the touching pairs of bodies, a set of (id, id) with the smaller id first.

    This order allows the comparison of worlds with different collision shapes, because the shapes determine which body
    of a contact is body A.
    """
    contacts = world.contacts[world.contacts["separation"] <= 0.0]  # contacts include pairs about to meet
    ids = np.sort(np.stack([contacts["body_a"], contacts["body_b"]], axis=1), axis=1)
    return set(map(tuple, ids.tolist()))
