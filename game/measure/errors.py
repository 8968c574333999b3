"""How wrong a setting is at a moment, against references that cannot be argued with.

Three errors, in pixels each: `way`, how far bodies go astray from a reference run; `overlap`, how deep rigid bodies are
in each other, which they never should be; `verdict`, by how much a hit that is none was missed, or a miss hit.

The reference of a way has 64 times the substeps of four, at the stiffness of a given number of them (Erez, Tassa and
Todorov, ICRA 2015, compare engines with themselves at smaller steps). It is asked only as long as 32 times agrees with
it to a tenth of a pixel, and tells nothing below what both, or a third with the stiffest contacts there are, differ by:
chaos has no reference.
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

VISIBLE = 1.0  # [px] what a player can see
AGREED = 0.1  # of an error, and of VISIBLE: what the reference may be uncertain by
FINE, COARSE = 64, 32  # times the substeps of …
PLAIN = 4
LOOKS = 12  # steps of a run in which verdicts are compared


@dataclass(frozen=True)
class Error:
    """In pixels. floor: below it the reference cannot tell; steps: after how many it was read; failures: what went
    wrong on the way, counted apart."""

    value: float
    floor: float = 0.0
    steps: int = 0
    failures: dict[str, int] = field(default_factory=dict)
    wrong: Rate | None = None  # hits that are none, of all hits told
    missed: Rate | None = None  # hits not told, of all true hits

    @property
    def told(self) -> bool:
        """Whether the reference is certain enough to tell this error from none."""
        return self.value > self.floor


class Reference(NamedTuple):
    """A way that others are compared with."""

    way: Way
    horizon: int  # steps that it can be asked for
    floor: float  # [px] below it nothing can be told


class References:
    """What the settings of a moment are compared with; made when it is first needed."""

    def __init__(self, moment: Moment) -> None:
        self.moment = moment
        self.truth: Setting = moment.here._replace(narrowphase=True)
        if moment.here.tier is not None:
            self.truth = self.truth._replace(tier="mask")
        if moment.effects.stacking:
            self.truth = self.truth._replace(solver="soft_step", substeps=FINE * PLAIN)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The errors that this moment has; the first is the one to look at first."""
        return ("overlap", "way") if self.moment.effects.response else ("verdict",)

    @cached_property
    def reference(self) -> Reference:
        """The finest run, and what can be asked of it."""
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
        """{kind: Error} of a setting."""
        if not self.moment.effects.response:
            return {"verdict": self._verdict(setting)}
        (fine, last, floor), way = self.reference, self.moment.way(setting)
        return {
            "overlap": Error(float(np.median(way.overlap)), 0.0, STEPS, way.failures),
            "way": Error(float(way.apart(fine)[last - 1]), floor, last, way.failures),
        }

    def _verdict(self, setting) -> Error:
        """Both worlds go the same way, as nobody is pushed; in some steps it is asked who meets whom."""
        told, true = self.moment.world(setting), self.moment.world(self.truth)
        wrong = missed = hits = said = 0
        pixels, failures = 0.0, Counter()
        for step in range(STEPS):
            told.step()
            true.step()
            failures += failures_of(told)
            if step % (STEPS // LOOKS):
                continue
            says, is_so = pairs_of(told), pairs_of(true)
            wrong, missed = wrong + len(says - is_so), missed + len(is_so - says)
            said, hits = said + len(says), hits + len(is_so)
            pixels += sum(abs(gap(true, *pair)) for pair in says ^ is_so)
        decided = said + missed
        value = pixels / decided if decided else 0.0
        return Error(value, 0.0, STEPS, failures, Rate(wrong, said), Rate(missed, hits))


def pairs_of(world: World) -> set[tuple[int, int]]:
    """Ids of the bodies that meet, the smaller first: which of two is A goes by their shapes, which a tier replaces."""
    contacts = world.contacts[world.contacts["separation"] <= 0.0]  # those that are about to meet are told too
    ids = np.sort(np.stack([contacts["body_a"], contacts["body_b"]], axis=1), axis=1)
    return set(map(tuple, ids.tolist()))


def gap(world: World, first: int, second: int) -> float:
    """[px] between two bodies, negative where they overlap: the least over their shapes."""
    a, b = world.body(first), world.body(second)
    poses = [(body.position.x, body.position.y, body.angle) for body in (a, b)]
    return min(distance(s, poses[0], t, poses[1]).distance for s in a.shapes for t in b.shapes)
