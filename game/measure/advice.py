"""Advice on the settings of a scene: the fastest setting whose error is within a limit.

First, each setting that differs from the current one by a single change is measured. Then the changes that save time
are combined, and the combination is measured.

A faster setting is advised only if it is certainly faster. For this, the intervals of the two times must not overlap,
and the times must differ by more than 10 % (pareto_front.TIE). The times are pooled over all snapshots.
"""

from collections.abc import Callable, Iterable, Sequence
from random import Random
from typing import NamedTuple

from game.measure.errors import VISIBLE, References
from game.measure.moment import STEPS, Moment
from game.measure.pareto_front import cheaper
from game.measure.setting import Setting, settings_around
from game.measure.survey import Survey, is_sound
from game.measure.timing import RUNS

# groups of fields of Setting that are chosen independently
PARTS = (("broadphase",), ("tier",), ("solver", "substeps"), ("narrowphase",))


class Advice(NamedTuple):
    """The result of `advise`. here: the current setting.

    best: the advised setting. It equals `here` if no setting is certainly faster, and is None if no setting's error is
    within the limit.
    """

    here: Setting
    best: Setting | None
    within: tuple[Setting, ...]  # all settings within the error, the cheapest first


Report = Callable[[int, int], object]  # called with (runs done, runs in all)


def measure_settings(
    survey: Survey, moments: Sequence[Moment], settings: Iterable[Setting], report: Report, seed: int
) -> None:
    """Measure the errors and times of `settings` from several snapshots of a world, and add them to `survey`.

    moments: the snapshots; seed: seed of the random order of the runs. report(number of finished runs, number of all
    runs) is called after each run.
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
    """Measure the settings near the current one, in runs from `moments`. Return (advice, survey of the measurements).

    moments: snapshots of a world; error: largest error [px] of an advised setting; report, seed: as in
    measure_settings(). Raises ValueError if there is no snapshot.
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
    sure = surely_cheaper(survey, within, here)
    return Advice(here, sure[0] if sure else here, tuple(within)), survey


def advised(survey: Survey, here: Setting, error: float = VISIBLE) -> Setting | None:
    """Return the fastest measured setting whose error of every kind is at most `error` [px].

    Return None if no setting is certainly faster than the current one (`here`), or if `here` is the only setting within
    the limit, or before boxes have reported enough hits in a scene with collision tiers.
    """
    within = settings_within(survey, error)
    if here not in survey.dots or survey.dots[here].cost is None or not survey.can_judge_tiers():
        return None
    return next(iter(surely_cheaper(survey, within, here)), None)


def surely_cheaper(survey: Survey, within: Sequence[Setting], here: Setting) -> list[Setting]:
    """Return the settings that are certainly cheaper than `here`, cheapest first; all others if `here` is not `within`.

    within: the settings within the limit of errors, cheapest first. Settings whose times cannot be told apart from that
    of the cheapest one come first in a fixed order, so that repeated measurements give the same answer: the fewest
    changes from `here`, then by name.
    """
    sure = [each for each in within if each != here and (here not in within or is_cheaper(survey, each, here))]
    if not sure:
        return []
    tied = [each for each in sure if each == sure[0] or not is_cheaper(survey, sure[0], each)]
    tied.sort(key=lambda each: (len(each.differs(here)), each.label(here)))
    return tied + [each for each in sure if each not in tied]


def share(survey: Survey, setting: Setting, here: Setting) -> float:
    """Return the ratio of two median times of a step: under `setting`, and under the current setting `here`.

    The times are taken from the survey. Raises ValueError if one of the settings has no times, and KeyError if it is
    not in the survey.
    """
    cost, now = survey.dots[setting].cost, survey.dots[here].cost
    if cost is None or now is None:
        raise ValueError("a share needs the times of both")
    return cost.median / now.median


def settings_within(survey: Survey, error: float) -> list[Setting]:
    """Return the settings of the survey whose error of every kind is at most `error`, fastest first.

    error: limit in pixels, or in wrong answers per 100 encounters for errors of collision tiers (kinds of collision
    shape of the sprites).

    A rate of wrong answers has an interval. A setting with another tier must have the upper end of its interval within
    the limit, so that it is not recommended after a few encounters. For the current tier the lower end is enough, so
    that it is not rejected after a few encounters.

    Settings whose runs had failures are omitted. Settings with another joint solver are also omitted, because no scene
    can be changed to one.
    """
    found = {}
    for setting, dot in survey.dots.items():
        if setting.joint_solver != survey.first.joint_solver:
            continue
        errors = [survey.error(setting, kind) for kind in survey.kinds]
        if dot.cost is not None and all(
            e is not None and is_sound(e) and e.interval[_end(survey, setting, e)] <= error for e in errors
        ):
            found[setting] = dot.cost.median
    return sorted(found, key=found.__getitem__)


def _end(survey, setting, error):
    """Return the end of an error's interval that is compared with a limit: 0 (lower end) or 1 (upper end).

    The result is 0 only for a rate of wrong answers of a setting with the current collision tier and narrow phase. The
    current ones are those of the setting that was measured first.
    """
    first = survey.first
    same = error.verdicts is not None and (setting.tier, setting.narrowphase) == (first.tier, first.narrowphase)
    return 0 if same else 1


def is_cheaper(survey: Survey, one: Setting, other: Setting) -> bool:
    """Return whether the setting `one` is certainly faster than `other`, by the times in the survey.

    The upper quartile of the times of `one` must be below all times of `other`, and more than 10 % below the median of
    `other`.
    """
    a, b = survey.dots[one].cost, survey.dots[other].cost
    return a is not None and b is not None and cheaper((a.least, a.upper), b[:2])


def _together(survey, here, error):
    """Return the setting `here`, changed in every group of fields (PARTS) in which a change is advisable.

    For each group, the fastest setting is found that is within the limit `error` and differs from `here` only in this
    group. Its values are used if it is certainly faster than `here`, or if `here` exceeds the limit.
    """
    together, within = here, settings_within(survey, error)
    for part in PARTS:
        alone = surely_cheaper(survey, [each for each in within if set(each.differs(here)) <= set(part)], here)
        if alone:
            together = together._replace(**{name: getattr(alone[0], name) for name in part})
    return together
