"""Advice on the settings of a scene: the fastest setting whose error is within a limit.

First, settings that differ from the present one by a single change are measured at moments of a recorded run. Then the
changes that save time are measured together. Advice is given only if it is certain: over all moments, the intervals of
the two times do not overlap, and the times differ by more than 10 % (pareto_front.TIE). At last the advice is applied:
the whole run is played with the present setting and with the advised one in turns. If the measured times do not
confirm the advice, it is withdrawn.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import islice
from random import Random
from typing import NamedTuple

import numpy as np

from game.measure.errors import VISIBLE, Error, References
from game.measure.moment import STEPS, Moment
from game.measure.pareto_front import TIE, cheaper
from game.measure.recorded_run import Overview, RecordedRun, changes_to, look_over, seconds_of_steps
from game.measure.setting import Setting, settings_around
from game.measure.survey import Survey, is_sound
from game.measure.timing import RUNS

APPLIED_RUNS = 3  # repetitions of a whole run with each of two settings
WARM_STEPS = 60  # of each setting, before the first repetition
MOST_TRIED = 3  # settings tried on the whole run, if the first ones do not hold
# groups of fields of Setting that are chosen independently
PARTS = (("broadphase",), ("tier",), ("solver", "substeps"), ("narrowphase",))


class Applied(NamedTuple):
    """An advised setting, applied to a whole run. Times are shares of the time of the present setting."""

    setting: Setting
    predicted: float  # at the moments
    mean: float  # over all steps of the run
    interval: tuple[float, float]  # least and greatest mean of the repetitions
    p99: float  # of the slowest step in a hundred
    refused: str = ""  # the reason why the scene cannot play with the setting; the measured shares are then 0

    @property
    def holds(self) -> bool:
        """True if the whole run is certainly faster, and its slowest steps are no slower."""
        return not self.refused and self.interval[1] < 1.0 - TIE and self.p99 < 1.0 + TIE


class Advice(NamedTuple):
    """The result of `advise`.

    here: the present setting. best: the setting to use; equal to `here` if no setting is certainly faster; None if no
    setting is within the error.
    """

    here: Setting
    best: Setting | None
    within: tuple[Setting, ...]  # all settings within the error, the cheapest first
    applied: tuple[Applied, ...] = ()  # the advised settings that were tried on the whole run, the last one counts


Report = Callable[[int, int], object]  # called with (runs done, runs in all)


def measure_settings(
    survey: Survey, moments: Sequence[Moment], settings: Iterable[Setting], report: Report, seed: int
) -> None:
    """Measure the errors and times of these settings at every moment, and add them to the survey.

    moments: snapshots of a world. report(number of runs done, number of all runs) is called after each run.
    """
    settings, chance, done = list(settings), Random(seed), 0
    survey.planned, of = survey.planned + len(settings), len(moments) * len(settings) * (RUNS + 1)
    survey.moments = len(moments)
    for number, moment in enumerate(moments, 1):
        references = References(moment)
        survey.kinds = references.kinds
        for setting in settings:
            moment.time_run(setting, 2)  # compiles missing kernels
            survey.dot(setting).erred(number, references.errors(setting))
            survey.dot(setting).steps = STEPS
            done += 1
            report(done, of)
        for _ in range(RUNS):
            chance.shuffle(settings)
            for setting in settings:
                survey.dot(setting).took(number, moment.time_run(setting))
                done += 1
                report(done, of)


def advise(
    moments: Sequence[Moment], error: float, report: Report = lambda done, of: None, seed: int = 0
) -> tuple[Advice, Survey]:
    """Measure the settings around the present one, at some moments. Return the advice and the survey of measurements.

    error: largest error [px] of an advised setting. Raises ValueError for no moments.
    """
    if not moments:
        raise ValueError("moments must be one at least (got none)")
    here, survey = moments[0].here, Survey()
    measure_settings(survey, moments, settings_around(here, moments[0].effects), report, seed)
    together = _together(survey, here, error)
    if together not in survey.dots:
        measure_settings(survey, moments, [here, together], report, seed + 1)
    within = settings_within(survey, error)
    if not within:
        return Advice(here, None, ()), survey
    best = within[0]
    if here in within and not is_cheaper(survey, best, here):
        best = here
    return Advice(here, best, tuple(within)), survey


def advise_on_run(
    run: RecordedRun, error: float, report: Report = lambda done, of: None, seed: int = 0
) -> tuple[Advice, Survey, Overview]:
    """Return the advice on a recorded run, tried on the whole of it, the survey, and what was looked at.

    error: as in advise. An advice that does not hold is withdrawn, and the setting that was next best is tried. Raises
    ValueError for a run without steps.
    """
    overview = look_over(run)
    advice, survey = advise(overview.moments, error, report, seed)
    here, tried = advice.here, []
    count_encounters(survey, here, overview)
    within = settings_within(survey, error)
    if not within:
        return Advice(here, None, ()), survey, overview
    sure = [each for each in within if each != here and (here not in within or is_cheaper(survey, each, here))]
    best = here if here in within else None
    for setting in sure[:MOST_TRIED]:
        tried.append(apply_to_run(run, setting, share(survey, setting, here)))
        if tried[-1].holds or (here not in within and not tried[-1].refused):
            best = setting
            break
    return Advice(here, best, tuple(within), tuple(tried)), survey, overview


def count_encounters(survey: Survey, here: Setting, overview: Overview) -> None:
    """Replace the errors of tiers in a survey by those of the encounters over a whole run."""
    for setting, dot in survey.dots.items():
        found = overview.encounters.get(setting.tier or "")
        if found is not None and "verdict" in survey.kinds and setting.narrowphase:
            failures = dot.error("verdict")
            dot.errors = {0: {"verdict": Error.of(found, STEPS, {} if failures is None else failures.failures)}}
            dot.forget()


def apply_to_run(run: RecordedRun, setting: Setting, predicted: float) -> Applied:
    """Play a whole run with the present setting and with another one in turns, APPLIED_RUNS times each.

    predicted: time of the setting at the moments, as a share of the present time.
    """
    changes = changes_to(setting, run.make())
    if isinstance(changes, str):
        return Applied(setting, predicted, 0.0, (0.0, 0.0), 0.0, changes)
    for each in ((), changes):
        for _ in islice(run.play(each), WARM_STEPS):
            pass  # compiles what is missing
    now, other = [], []
    for _ in range(APPLIED_RUNS):
        now.append(seconds_of_steps(run, ()))
        other.append(seconds_of_steps(run, changes))
    ratios = sorted(b.mean() / a.mean() for a, b in zip(now, other, strict=True))
    slowest = [np.percentile(np.min(each, axis=0), 99) for each in (other, now)]
    return Applied(
        setting,
        predicted,
        float(np.median(ratios)),
        (float(ratios[0]), float(ratios[-1])),
        float(slowest[0] / slowest[1]),
    )


def advised(survey: Survey, here: Setting, error: float = VISIBLE) -> Setting | None:
    """Return the fastest measured setting whose error of every kind is at most `error` [px].

    Return None if no setting is certainly faster than the present one (`here`), or if `here` is the only one within the
    error. Only settings with enough runs at every moment are compared.
    """
    within = [each for each in settings_within(survey, error) if survey.dots[each].sure]
    if here not in survey.dots or not survey.dots[here].sure or not within or within[0] == here:
        return None
    best = within[0]
    return best if here not in within or is_cheaper(survey, best, here) else None


def share(survey: Survey, setting: Setting, here: Setting) -> float:
    """Return the time of `setting` divided by the time of `here`, both as measured in the survey.

    Raises KeyError or ValueError for a setting without times.
    """
    cost, now = survey.dots[setting].cost, survey.dots[here].cost
    if cost is None or now is None:
        raise ValueError("a share needs the times of both")
    return cost.median / now.median


def settings_within(survey: Survey, error: float) -> list[Setting]:
    """Return the settings of the survey without failures whose error of every kind is within `error`, fastest first.

    error: in pixels, and for tiers in wrong answers per 100 encounters. Another tier must be within at the upper end of
    its interval, the present tier at the lower end: few encounters neither recommend a tier nor condemn the present.
    """
    found = {}
    for setting, dot in survey.dots.items():
        errors = [dot.error(kind) for kind in survey.kinds]
        if dot.cost is not None and all(
            e is not None and is_sound(e) and e.interval[_end(survey, setting, e)] <= error for e in errors
        ):
            found[setting] = dot.cost.median
    return sorted(found, key=found.__getitem__)


def _end(survey, setting, error):
    """Return the index of the end of an error's interval that must be within the limit."""
    first = survey.first
    same = error.verdicts is not None and (setting.tier, setting.narrowphase) == (first.tier, first.narrowphase)
    return 0 if same else 1


def is_cheaper(survey: Survey, one: Setting, other: Setting) -> bool:
    """Return whether `one` is certainly faster than `other`, by the times in the survey.

    The upper quartile of the times of `one` must be below all times of `other`, and more than 10 % below the median of
    `other`.
    """
    a, b = survey.dots[one].cost, survey.dots[other].cost
    return a is not None and b is not None and cheaper((a.least, a.upper), b[:2])


def _together(survey, here, error):
    """Return `here` with several changes combined: for each group of fields in PARTS, those of the fastest setting that
    differs in this group alone.

    A group is changed only if that is certainly faster by itself, or if `here` is not within the error.
    """
    together = here
    for part in PARTS:
        alone = [
            each for each in settings_within(survey, error) if set(each.differs(here)) <= set(part) and each != here
        ]
        if alone and (is_cheaper(survey, alone[0], here) or here not in settings_within(survey, error)):
            together = together._replace(**{name: getattr(alone[0], name) for name in part})
    return together
