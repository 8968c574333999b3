"""Advice on a scene from a recorded run. The advised setting is tested on the whole run before it is recommended.

The run is played alternately with the current setting and with the advised one, with the scene's rules. If the measured
times do not confirm the advice, it is withdrawn, and the next best setting is tested.
"""

from itertools import islice
from typing import NamedTuple

import numpy as np

from game.measure.advice import Advice, Report, advise, settings_within, share, surely_cheaper
from game.measure.pareto_front import TIE
from game.measure.setting import Setting
from game.measure.survey import Survey
from game.measurement_requests import STEPS
from game.run.recorded_run import STRATA, Overview, RecordedRun, changes_to, look_over, seconds_of_steps

APPLIED_RUNS = 3  # repetitions of a whole run with each of two settings
WARM_STEPS = 60  # of each setting, before the first repetition
LEAST_STEPS = (STRATA + 1) * STEPS  # of a run: room for the moments of its parts, and for its busiest second
MOST_TRIED = 3  # settings tried on the whole run, if the first ones do not hold


class Applied(NamedTuple):
    """An advised setting that was tested on a whole run. Times are shares of the time with the current setting."""

    setting: Setting
    predicted: float  # at the moments
    mean: float  # over all steps of the run
    interval: tuple[float, float]  # least and greatest mean of the repetitions
    p99: float  # of the slowest step in a hundred
    refused: str = ""  # the reason why the scene cannot play with the setting; the measured shares are then 0

    @classmethod
    def from_json(cls, values: list) -> "Applied":
        """Return the Applied whose JSON form is `values`, a list of its fields."""
        setting, predicted, mean, interval, p99, refused = values
        return cls(Setting(*setting), predicted, mean, (interval[0], interval[1]), p99, refused)

    @property
    def holds(self) -> bool:
        """Whether the whole run is certainly faster than with the current setting, and its slowest steps are no slower.

        The slowest steps are compared by their 99th percentile.
        """
        return not self.refused and self.interval[1] < 1.0 - TIE and self.p99 < 1.0 + TIE

    def is_advisable(self, here_is_within: bool) -> bool:
        """Return whether the setting is advised. here_is_within: whether the current setting is within the limit.

        If it is not, a setting that the scene can play with is advised for its exactness, whatever its time.
        """
        return self.holds if here_is_within else not self.refused


class Proven(NamedTuple):
    """Advice that was tested on a whole run, with the measurements that it is based on."""

    advice: Advice
    applied: tuple[Applied, ...]  # the settings that were tried on the whole run; the last one counts
    survey: Survey
    overview: Overview


def advise_on_run(run: RecordedRun, error: float, report: Report = lambda done, of: None, seed: int = 0) -> Proven:
    """Measure the settings of a recorded run, and return advice that was tested on the whole run.

    error: largest error of an advised setting, as in advise(); report, seed: as in measure_settings(). If the whole run
    shows no gain from the advised setting, the next best setting is tested. If the run has too few hits by boxes to
    judge collision tiers (Survey.can_judge_tiers), nothing is tried, and no setting is advised.

    Raises ValueError for a run that is shorter than LEAST_STEPS.
    """
    if run.steps < LEAST_STEPS:
        raise ValueError(f"a run to advise on must have {LEAST_STEPS} steps or more (got {run.steps})")
    overview = look_over(run)
    advice, survey = advise(overview.moments, error, report, seed)
    here, tried = advice.here, []
    survey.encounters = overview.encounters
    within = settings_within(survey, error)
    if not within or not survey.can_judge_tiers():
        return Proven(Advice(here, None, tuple(within)), (), survey, overview)
    best = here if here in within else None
    for setting in surely_cheaper(survey, within, here)[:MOST_TRIED]:
        tried.append(apply_to_run(run, setting, share(survey, setting, here)))
        if tried[-1].is_advisable(here in within):
            best = setting
            break
    return Proven(Advice(here, best, tuple(within)), tuple(tried), survey, overview)


def apply_to_run(run: RecordedRun, setting: Setting, predicted: float) -> Applied:
    """Play a whole run alternately with the current setting and with `setting`, APPLIED_RUNS times each.

    Return the times with `setting`, as an Applied. predicted: time with `setting` in runs from snapshots, as a share of
    the time with the current setting.
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
