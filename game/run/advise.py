"""`--advise SCENE`: advise on the settings of a scene.

The bot plays the scene, or a recording is played (--replay). Each setting is then measured at several moments of the
run. The recommended setting is printed after it was confirmed on the whole run.
"""

import json
import sys
from time import perf_counter

from game.errors import UsageError
from game.files.data_folder import write_atomically
from game.measure.errors import VISIBLE
from game.measure.moment import STEPS
from game.measure.setting import Setting
from game.measure.survey import LEAST_HITS, shown
from game.measure.survey_csv import csv_of
from game.measure.timing import RUNS
from game.registry import Registry
from game.run.headless import save_or_fail, start_dummy_display
from game.run.options import DEFAULT_FRAMES, Options, make_scene, scene_class_of
from game.run.proven_advice import APPLIED_RUNS, LEAST_STEPS, Applied, Proven, advise_on_run
from game.run.recorded_run import RecordedRun
from game.run.replay import Recorder
from game.run.session import Session
from game.run.sources import BotSource
from game.run.warmup import warm_up_scene
from game.startup import start_line

EVERY = 2.0  # [s] between two lines of progress


def run_advice(options: Options, registry: Registry) -> int:
    """Measure the settings of a scene, and print the advice.

    Return the exit code: 0, or 1 if nothing is advised, because no setting is within the allowed error or the run has
    too few hits. Raises UsageError for a run that is shorter than LEAST_STEPS.
    """
    frames = frames_of(options)
    if frames < LEAST_STEPS:
        named = f"--frames {frames}" if options.frames or not options.replay else f"--replay, {frames} steps"
        raise UsageError(f"{named}: too short a run to advise on; valid: {LEAST_STEPS} or more")
    start_dummy_display()
    warm_up_scene(scene_class_of(options, registry), options.broadphase, options.solver)
    error = VISIBLE if options.error is None else options.error
    run = recorded_run(options, registry, frames)
    proven = advise_on_run(run, error, Progress(), options.seed or 0)
    if options.csv:
        of = ("--replay", options.replay) if options.replay else ("--seed", f"{options.seed or 0}")
        command = start_line("--advise", options.scene or "", *of, "--frames", f"{frames}", "--json")
        text = csv_of(proven.survey, options.scene or "", command)
        save_or_fail(lambda path: write_atomically(path, text, makes_folder=False), options.csv)
    if options.json:
        print(json.dumps(as_json(options, error, proven)))
    else:
        print("\n".join(lines_of(options, error, proven)))
    return 0 if proven.advice.best is not None else 1


def frames_of(options: Options) -> int:
    """Return the number of steps of the run: --frames, but no more than a recording has."""
    if options.recording is None:
        return options.frames or DEFAULT_FRAMES
    return min(options.frames or options.recording.frames, options.recording.frames)


def recorded_run(options: Options, registry: Registry, frames: int) -> RecordedRun:
    """Return the first `frames` steps of the recording of --replay, or let the bot play that many steps."""
    scene = make_scene(options, registry)
    recorder = Recorder(scene, bot=True, every=frames)
    if options.recording is not None:
        inputs = tuple((1, frame) for frame in options.recording.inputs[:frames])
        return RecordedRun.of(scene, recorder)._replace(inputs=inputs)
    session = Session(scene, BotSource(), recorder)
    for _ in range(frames):
        session.step()
    return RecordedRun.of(scene, recorder)


class Progress:
    """Progress on standard error: number of finished runs of the measurement, and estimated remaining time."""

    def __init__(self) -> None:
        self.started = self.reported = 0.0  # [s] when the first run was finished; before it the run was played

    def __call__(self, done: int, of: int) -> None:
        now = perf_counter()
        if done <= 1:
            self.started = self.reported = now
        if now - self.reported >= EVERY and done < of:
            self.reported = now
            left = (now - self.started) * (of - done) / done
            print(f"{done} of {of} runs, about {left:.0f} s more", file=sys.stderr, flush=True)


def lines_of(options: Options, error: float, proven: Proven) -> list[str]:
    """Return the report as lines of text: the measured run, the measured settings, and the advice.

    error: the allowed error, in pixels, or in wrong answers per 100 encounters if collision tiers are measured; proven:
    the advice with its measurements.
    """
    advice, tried, survey, overview = proven
    here, best = advice.here, advice.best
    limit = f"{error:g} false and missed hits of 100" if survey.kinds == ("verdict",) else f"{error:g} px"
    whose = "the recorded" if options.recording is not None else "the bot's"
    lines = [
        f"{options.scene}: {whose} run of {frames_of(options)} steps; {len(survey.dots)} settings at {survey.moments} "
        f"moments of {STEPS} steps, {RUNS} runs each",
        f"moments from steps {', '.join(map(str, overview.at))}; the busiest second begins at {overview.busiest}",
        *_encounters(overview),
        _line("now", here, here, survey),
    ]
    if not survey.can_judge_tiers():
        return [*lines, f"no advice: {survey.hits_seen()} of {LEAST_HITS} hits seen; a longer run (--frames) has more"]
    if best is None:
        lines += [_tried(each, here, best) for each in tried]
        return [*lines, f"nothing with which the scene can play is within {limit}"]
    lines += [_line("within", each, here, survey) for each in advice.within if each not in (here, best)]
    lines += [_tried(each, here, best) for each in tried]
    if best == here:
        return [*lines, f"advice: leave it; within {limit} nothing is surely cheaper over the whole run"]
    lines.append(_line("advice", best, here, survey))
    applied = tried[-1]
    least, most = applied.interval
    return [*lines, f"advice: {best.label(here)}: {applied.mean:.2f} x the time ({least:.2f} to {most:.2f})"]


def _encounters(overview):
    boxes = overview.encounters.get("aabb")
    if boxes is None:
        return []
    wrong = boxes.wrong
    if wrong.total < LEAST_HITS:
        return []  # too few for a rate
    low, high = (round(100 * each) for each in wrong.interval)
    return [f"boxes over the run: {wrong.count} of {wrong.total} hits are false ({low} to {high} of 100)"]


def _tried(applied: Applied, here: Setting, best: Setting | None) -> str:
    """Return a line of text on a setting that was tested on the whole run.

    here: the current setting; best: the advised one. It may be no faster if the error of `here` exceeds the limit.
    """
    if applied.refused:
        return f"tried   {applied.setting.label(here)}: {applied.refused}"
    least, most = applied.interval
    measured = f"measured {applied.mean:.2f} ({least:.2f} to {most:.2f}), p99 {applied.p99:.2f}, {APPLIED_RUNS} runs"
    end = "holds" if applied.holds else "dearer, but exact enough" if applied.setting == best else "withdrawn"
    return f"tried   {applied.setting.label(here)}: predicted {applied.predicted:.2f}, {measured}: {end}"


def as_json(options: Options, error: float, proven: Proven) -> dict:
    """Return the report as a dict for JSON: the measured run, the allowed error, the advice, and the measured settings.

    error: the allowed error, as in lines_of(); proven: the advice with its measurements.
    """
    advice, tried, survey, overview = proven
    best, here = advice.best, advice.here
    applied = tried[-1] if tried and best != here else None
    return {
        "looked_at": {
            "steps": frames_of(options),
            "moments": overview.at,
            "busiest_second_from": overview.busiest,
            "encounters": {
                tier: {"wrong": found.wrong._asdict(), "missed": found.missed._asdict()}
                for tier, found in overview.encounters.items()
            },
        },
        "tried": [{**each._asdict(), "setting": each.setting._asdict(), "holds": each.holds} for each in tried],
        "scene": options.scene,
        "error": error,
        "here": here._asdict(),
        "best": None if best is None else best._asdict(),
        "changes": [] if best is None else list(best.differs(here)),
        "share": None if best is None else 1.0 if applied is None else applied.mean,
        "interval": None if best is None else (1.0, 1.0) if applied is None else applied.interval,
        "within": [setting._asdict() for setting in advice.within],
        "settings": [
            {
                **setting._asdict(),
                "cost": None if dot.cost is None else dot.cost._asdict(),
                "errors": {
                    kind: _as_dict(found) for kind in survey.kinds if (found := survey.error(setting, kind)) is not None
                },
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
    reported = ", ".join(
        f"{kind} {shown(error)}" for kind in survey.kinds if (error := survey.error(setting, kind)) is not None
    )
    cost = f"{1e6 * dot.cost.median:8.1f} us +{100 * dot.cost.noise:.0f} %" if dot.cost is not None else ""
    return f"{word:7}{cost}  {setting.label(here)}: {reported}"
