"""A run without window and sound, as fast as possible. Pictures are drawn only if an option needs them."""

import json
import os
import sys
from collections.abc import Callable
from time import perf_counter

import pygame

from game.errors import StrictFailure, UsageError, brief
from game.files.data_folder import write_atomically
from game.measure.synchronous import measure_requests
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.figures_csv import command_of, figures_csv
from game.run.options import DEFAULT_FRAMES, Options, make_scene, scene_class_of
from game.run.outcome import Check, RunReport, judge, not_judged
from game.run.picture import Picture, save_png
from game.run.replay import Recorder
from game.run.session import Session
from game.run.sources import BotSource, IdleSource
from game.run.warmup import warm_up_scene
from game.scene import Scene, set_loaded_aside


def start_dummy_display() -> None:
    """Set up pygame so that it can draw without a display and without a sound device."""
    os.environ["SDL_VIDEODRIVER"] = "dummy"
    os.environ["SDL_AUDIODRIVER"] = "dummy"
    os.environ["SDL_NO_SIGNAL_HANDLERS"] = "1"  # SDL would turn SIGTERM into an event, and no events are read here
    pygame.display.init()
    pygame.display.set_mode((480, 270))  # so that convert_alpha() has a format to convert to


def run_headless(options: Options, registry: Registry) -> int:
    """Run the scene for --frames steps and print the results. Return the exit code."""
    start_dummy_display()
    # Compile first, so that the times below do not include the compiler.
    warm_up_scene(scene_class_of(options, registry), options.broadphase, options.solver)
    scene = make_scene(options, registry)
    recording = options.recording
    frames = options.last_frame or DEFAULT_FRAMES
    source = recording or (BotSource() if options.bot else IdleSource())
    recorder = Recorder(scene, options.bot) if options.record else None
    session = Session(scene, source, recorder, recording, options.strict)
    overlays = Overlays(scene.overlays if options.overlay is None else options.overlay)
    picture = Picture()
    draws = bool(options.overlay) or options.profile
    broken = ""
    set_loaded_aside()
    try:
        for frame in range(frames):
            session.step()
            overlays.note(scene)
            kept = options.screenshot and frame == frames - 1
            if kept:
                measure_requests(scene)
            if draws or kept:
                started = perf_counter()
                picture.draw_scene(scene, overlays)
                session.report.note_drawing(perf_counter() - started)
    except StrictFailure as failure:
        broken = str(failure)
    finally:
        if recorder is not None and options.record:
            save_or_fail(recorder.save, options.record)
    if recording is not None and recording.outdated:
        same = f"{brief(recording.path, 150)}: {recording.outdated}, and went the same way"
        print(recording.parted or same, file=sys.stderr)
    if options.screenshot:
        save_or_fail(lambda path: save_png(picture.presenter.frame.surface, path), options.screenshot)
    if options.csv:
        measure_requests(scene)
        text = figures_csv(scene, command_of(scene, options.replay, options.bot))
        save_or_fail(lambda path: write_atomically(path, text, makes_folder=False), options.csv)
    return finish(scene, session.report, options, broken)


def save_or_fail(save: Callable[[str], object], path: str) -> None:
    """Call save(path), which writes an output file. Raises UsageError if the file cannot be written."""
    try:
        save(path)
    except OSError as error:
        raise UsageError(f"{brief(path, 200)}: cannot be written: {error.strerror or error}") from error


def finish(scene: Scene, report: RunReport, options: Options, broken: str = "") -> int:
    """Print the results that the options request, and return the exit code.

    report: RunReport of the run; broken: message about the broken invariant that ended the run, or "".
    """
    played = options.played_by_bot
    extra = [broken] if broken else report.strict_failures() if options.strict else []
    check = judge(scene, report.steps, extra) if played else not_judged(scene, extra)
    if options.profile:
        # With --json, standard output holds the one object and nothing else.
        print("\n".join(report.profile_lines()), file=sys.stderr if options.json else sys.stdout)
    if options.json:
        print(json.dumps(report.to_json(scene, check)))
    else:
        print(summary_line(scene, report, check, played))
        for failure in check["failures"]:
            print(f"  failed: {failure}")
    return 0 if check["ok"] else 1


def summary_line(scene: Scene, report: RunReport, check: Check, played: bool) -> str:
    """Return one line of text about the run.

    report: RunReport of the run; check: result of judge() or not_judged(); played: whether a bot played.
    """
    verdict = ("check ok" if check["ok"] else "check FAILED") if played else "nobody played, so nothing was checked"
    pending = f", {len(check['pending'])} goals pending" if played and check["pending"] else ""
    return f"{scene.name}: {report.steps} frames, seed {scene.seed}, {scene.broadphase}: {verdict}{pending}"
