"""`--advise SCENE`: let the bot play the scene, measure each setting at several moments of the run, and print the
recommended setting.
"""

import json
import sys
from time import perf_counter

from game.measure.advice import Advice, advise, share
from game.measure.errors import VISIBLE
from game.measure.moment import STEPS, Moment
from game.measure.setting import Setting
from game.measure.survey import Survey, shown
from game.measure.timing import RUNS
from game.registry import Registry
from game.run.headless import start_dummy_display
from game.run.options import DEFAULT_FRAMES, Options, make_scene, scene_class_of
from game.run.session import Session
from game.run.sources import BotSource
from game.run.warmup import warm_up_scene

MOMENTS = 3  # measured states of the world, evenly spaced over the bot's run, the last at the end of the run
EVERY = 2.0  # [s] between two lines of progress


def run_advice(options: Options, registry: Registry) -> int:
    """Measure the settings, and print the advice. Return the exit code: 1 if no setting is within the allowed error."""
    start_dummy_display()
    warm_up_scene(scene_class_of(options, registry), options.broadphase, options.solver)
    error = VISIBLE if options.error is None else options.error
    moments = moments_of(options, registry)
    advice, survey = advise(moments, error, Progress(), options.seed or 0)
    if options.json:
        print(json.dumps(as_json(options, error, advice, survey)))
    else:
        print("\n".join(lines_of(options, error, advice, survey)))
    return 0 if advice.best is not None else 1


def moments_of(options: Options, registry: Registry) -> list[Moment]:
    """Return MOMENTS states of the scene's first visible world, evenly spaced over the bot's run."""
    scene, frames, found = make_scene(options, registry), options.frames or DEFAULT_FRAMES, []
    session = Session(scene, BotSource())
    at = {frames * (number + 1) // MOMENTS for number in range(MOMENTS)} - {0}
    for frame in range(1, frames + 1):
        session.step()
        if frame in at:
            world = scene.views()[0][0]
            found.append(Moment(world.snapshot(), world.broadphase.name))
    return found


class Progress:
    """Progress lines on standard error: number of finished measurement runs, and estimated time left."""

    def __init__(self) -> None:
        self.started = self.reported = perf_counter()

    def __call__(self, done: int, of: int) -> None:
        now = perf_counter()
        if now - self.reported >= EVERY and done < of:
            self.reported = now
            left = (now - self.started) * (of - done) / done
            print(f"{done} of {of} runs, about {left:.0f} s more", file=sys.stderr, flush=True)


def lines_of(options: Options, error: float, advice: Advice, survey: Survey) -> list[str]:
    """Return the measured settings of the survey and the advice as lines of text.

    error: the allowed error, in pixels, or in wrong answers per 100 encounters where tiers are measured.
    """
    here, best = advice.here, advice.best
    limit = f"{error:g} wrong of 100 hits" if survey.kinds == ("verdict",) else f"{error:g} px"
    lines = [
        f"{options.scene}: {len(survey.dots)} settings at {survey.moments} moments of {STEPS} steps, {RUNS} runs each",
        _line("now", here, here, survey),
    ]
    if best is None:
        return [*lines, f"nothing that was measured is within {limit}"]
    lines += [_line("within", each, here, survey) for each in advice.within if each not in (here, best)]
    if best == here:
        return [*lines, f"advice: leave it; within {limit} nothing is surely cheaper"]
    lines.append(_line("advice", best, here, survey))
    least, most = interval(survey, best, here)
    times = f"{share(survey, best, here):.2f} x the time ({least:.2f} to {most:.2f})"
    return [*lines, f"advice: {best.label(here)}: {times}"]


def interval(survey: Survey, setting: Setting, here: Setting) -> tuple[float, float]:
    """Return (least, most) time of `setting` as a share of the time of `here`, by the survey.

    least: from the fastest run of `setting` and the upper quartile of `here`; most: from the upper quartile of
    `setting` and the fastest run of `here`.
    """
    cost, now = survey.dots[setting].cost, survey.dots[here].cost
    assert cost is not None and now is not None
    return cost.least / now.upper, cost.upper / now.least


def as_json(options: Options, error: float, advice: Advice, survey: Survey) -> dict:
    """Return the allowed error [px], the advice and the survey as a dict for JSON."""
    best, here = advice.best, advice.here
    return {
        "scene": options.scene,
        "error": error,
        "here": here._asdict(),
        "best": None if best is None else best._asdict(),
        "changes": [] if best is None else list(best.differs(here)),
        "share": None if best is None else share(survey, best, here),
        "interval": None if best is None else interval(survey, best, here),
        "within": [setting._asdict() for setting in advice.within],
        "settings": [
            {
                **setting._asdict(),
                "cost": None if dot.cost is None else dot.cost._asdict(),
                "errors": {kind: _as_dict(found) for kind in survey.kinds if (found := dot.error(kind)) is not None},
            }
            for setting, dot in survey.dots.items()
        ],
    }


def _as_dict(error):
    found = {"value": error.value, "interval": error.interval, "floor": error.floor, "steps": error.steps}
    rates = {"wrong": error.wrong, "missed": error.missed}
    return found | {"failures": error.failures} | {name: rate and rate._asdict() for name, rate in rates.items()}


def _line(word, setting, here, survey):
    dot = survey.dots[setting]
    reported = ", ".join(f"{kind} {shown(error)}" for kind in survey.kinds if (error := dot.error(kind)) is not None)
    cost = f"{1e6 * dot.cost.median:8.1f} us +{100 * dot.cost.noise:.0f} %" if dot.cost is not None else ""
    return f"{word:7}{cost}  {setting.label(here)}: {reported}"
