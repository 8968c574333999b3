"""Command-line options: definitions and checks. Exit codes: 0 for success, 1 for failure, 2 for wrong use."""

import argparse
import json
import math
import os
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from stat import S_ISDIR
from typing import NoReturn

from game import VERSION, startup
from game.errors import ReplayDiverged, StrictFailure, UsageError, brief, unknown_name
from game.files.data_folder import is_there
from game.files.own_levels import level_digest
from game.overlays.stack import layer_names
from game.registry import Registry
from game.run.options import DEFAULT_FRAMES, Options
from game.run.replay import LARGEST_SEED
from game.run.replay_check import load_replay_for


class Parser(argparse.ArgumentParser):
    """Argument parser that reports a usage error as a UsageError of one line, with exit code 2."""

    def error(self, message: str) -> NoReturn:
        """Raise UsageError with the message. argparse calls this method for every error that it finds."""
        if message.startswith("unrecognized arguments: "):
            given = message.split(": ", 1)[1].split()[0]
            flags = sorted(flag for flag in self._option_string_actions if flag.startswith("--"))
            raise unknown_name("flag", given, flags)
        raise UsageError(message)


def run(arguments: Sequence[str], registry: Registry) -> int:
    """Run the program with these command-line arguments, and return the exit code."""
    try:
        code = _dispatch(read_options(arguments, registry), registry)
        if sys.stdout is not None:
            sys.stdout.flush()  # a write error can still be reported here
        return code
    except UsageError as error:
        startup.say(str(error), whole=True)
        return error.exit_code
    except (ReplayDiverged, StrictFailure) as error:
        startup.say(str(error))
        return error.exit_code
    except Warning as warning:  # --strict makes every warning an error
        startup.say(f"--strict: {type(warning).__name__}: {warning}")
        return StrictFailure.exit_code
    except BrokenPipeError:  # the reader of the output has closed it (| head)
        _give_up_output()
        return 0
    except OSError as error:  # the output is on a full disk
        startup.say(str(error))
        _give_up_output()
        return UsageError.exit_code
    except KeyboardInterrupt:
        return startup.INTERRUPTED


def _give_up_output():
    """Redirect standard output to the null device, so that the interpreter does not flush it to a closed pipe."""
    if sys.stdout is not None and sys.stdout is sys.__stdout__:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def make_parser() -> Parser:
    """Return the argument parser of the program."""
    parser = Parser(prog="hitbox", description="2D collision you can feel, trust and see.", allow_abbrev=False)
    add = parser.add_argument
    add("--list", action="store_true", help="every scene: name, title, effects, features")
    add("--scene", metavar="NAME", help="straight into a scene")
    add("--headless", action="store_true", help="no window, no sound, no waiting")
    add("--frames", metavar="N", type=int, help=f"stop after N steps of 1/60 s (headless: {DEFAULT_FRAMES})")
    add("--seed", metavar="S", type=int, help="seed of all random numbers (0)")
    add("--json", action="store_true", help="print one JSON object at the end (or the list)")
    add("--bot", action="store_true", help="the scene's own player plays; its goals are checked at the end")
    add("--record", metavar="FILE", help="write inputs, seed and digests")
    add("--replay", metavar="FILE", help="play a recording; a divergence names the frame")
    add("--overlay", metavar="LAYERS", help=f"comma-separated: {', '.join(layer_names())}, all, none")
    add("--broadphase", metavar="NAME", help="brute, sweep, hash or tree")
    add("--solver", metavar="NAME", help="how overlaps are resolved")
    add("--tier", metavar="NAME", help="the shape that sprites are tested with")
    add("--level", metavar="FILE", help="a level of your own, for a scene that takes one")
    add("--screenshot", metavar="FILE", help="save the presented picture after the last frame (PNG)")
    add("--csv", metavar="FILE", help="save the numbers that the scene or --advise finds, each with its command")
    add("--profile", action="store_true", help="print a table of times at the end")
    add("--warmup", action="store_true", help="compile every kernel now")
    add(
        "--strict",
        action="store_true",
        help="warnings are failures, and the first broken invariant ends the run: U1 to U11, after every step",
    )
    add("--advise", metavar="SCENE", help="measure every setting of a scene, and report which takes the least time")
    add("--error", metavar="PX", type=float, help="that the advice may cost (1 px: what can be seen)")
    add("--report", metavar="DIR", help="measure what accuracy costs, and write it as a page; goes on where it ended")
    add("--quick", action="store_true", help="of the report: smaller and fewer, about a minute")
    add("--workers", metavar="N", type=int, help="of the report: in so many processes")
    add("--dask", metavar="ADDRESS", help="of the report: on the workers of a Dask cluster")
    add("--only", metavar="JOBS", help="of the report: measure these again, as broadphases or pyramid/*")
    add("--version", action="store_true", help="versions of the game and what it runs on")
    return parser


def read_options(arguments: Sequence[str], registry: Registry) -> Options:
    """Parse and check the command-line arguments, and return them as Options.

    Raises UsageError with one line of text, which names the valid values.
    """
    given = vars(make_parser().parse_args(arguments))
    from physics import BROADPHASES, SOLVERS

    _known(given["broadphase"], "broad phase", tuple(BROADPHASES))
    _known(given["solver"], "solver", tuple(SOLVERS))
    _known(given["scene"], "scene", registry.names)
    _known(given["advise"], "scene", registry.names)
    layers, level = read_layers(given.pop("overlay")), given.pop("level")
    options = Options(**given, overlay=layers, level=None if level is None else Path(level))
    _check_advice(options)
    _check_report(options)
    if options.frames is not None and options.frames < 1:
        raise UsageError(f"--frames must be at least 1 (got {options.frames})")
    if options.seed is not None and not 0 <= options.seed <= LARGEST_SEED:
        raise UsageError(f"--seed must be 0 to {LARGEST_SEED} (got {options.seed})")
    for flag in ("record", "screenshot", "csv"):
        _check_output(flag, getattr(options, flag))
    if options.csv is not None and not (options.headless or options.advise):
        raise UsageError("--csv needs --headless or --advise; during a game, F9 saves the same")
    if options.replay and (options.bot or options.record):
        raise UsageError("--replay brings its own input: leave out --bot and --record")
    options.recording = load_replay_for(options.replay, registry)[0] if options.replay else None
    _take_from_recording(options)
    _needs_scene(options, registry)
    if options.level is not None:
        _check_level(options, registry)
    if options.tier is not None:
        _check_tier(options, registry)
    if options.solver is not None and options.scene is not None:
        scene = registry.scene_class(options.scene)
        valid = scene.valid_solvers()
        if options.solver not in valid:
            why = "does not solve joints" if scene.effects.joints else "needs the effect stacking"
            raise UsageError(
                f"--solver: {options.scene} cannot use {options.solver}, which {why}; valid: {', '.join(valid)}"
            )
    return options


def _check_output(flag, name):
    """Raise UsageError if the path `name` is a folder or invalid. `name` is the value of the option --`flag`.

    The check is made before the run starts, so that no finished run is lost.
    """
    try:
        is_folder = name and is_there(Path(name)) and S_ISDIR(Path(name).stat().st_mode)
    except (OSError, ValueError) as error:  # ValueError: a name that is invalid on every system
        reason = getattr(error, "strerror", None) or error
        raise UsageError(f"--{flag}: {brief(name, 150)} cannot be written: {reason}") from error
    if is_folder:
        raise UsageError(f"--{flag}: {brief(name, 150)} is a folder; it takes the name of a file")


def _check_advice(options):
    """Raise UsageError if another option conflicts with --advise.

    Set the scene of the run to the scene that --advise names.
    """
    if options.error is not None and options.advise is None:
        raise UsageError("--error needs --advise")
    if options.error is not None and not 0.0 < options.error < math.inf:
        raise UsageError(f"--error must be more than 0 px, and finite (got {options.error})")
    if options.advise is None:
        return
    others = [flag for flag in ("scene", "record", "screenshot", "profile") if getattr(options, flag)]
    if others:
        raise UsageError(f"--advise brings its own scene and run: leave out --{others[0]}")
    options.scene = options.advise


def _check_report(options):
    """Raise UsageError if another option conflicts with --report.

    Also raise it if --quick, --workers, --dask or --only is given without --report, or if --workers is invalid.
    """
    if options.report is None:
        for flag in ("quick", "workers", "dask", "only"):
            if getattr(options, flag) is not None and getattr(options, flag) is not False:
                raise UsageError(f"--{flag} needs --report")
        return
    others = (
        "scene",
        "advise",
        "record",
        "replay",
        "screenshot",
        "csv",
        "profile",
        "json",
        "headless",
        "bot",
        "frames",
    )
    for flag in others:
        if getattr(options, flag):
            raise UsageError(f"--report brings its own scenes and runs: leave out --{flag}")
    if options.workers is not None and options.workers < 1:
        raise UsageError(f"--workers must be at least 1 (got {options.workers})")
    if options.workers is not None and options.dask is not None:
        raise UsageError("--dask brings its own workers: leave out --workers")


def _known(name, what, valid):
    if name is not None and name not in valid:
        raise unknown_name(what, name, valid)


def read_layers(text: str | None) -> tuple[str, ...] | None:
    """Return the names of the overlay layers that the option --overlay selects, or None without that option.

    text: value of the option, or None. "bounds,pairs" gives ("bounds", "pairs"), "all" gives every layer, and "none"
    gives (). A result of None means the scene's own layers.
    """
    if text is None:
        return None
    names = [name.strip() for name in text.split(",") if name.strip()]
    if names == ["all"]:
        return layer_names()
    if names == ["none"]:
        return ()
    for name in names:
        _known(name, "overlay", (*layer_names(), "all", "none"))
        if name in ("all", "none"):
            raise UsageError(f"--overlay: {name} stands alone (got {text})")
    return tuple(names)


def _take_from_recording(options):
    """Set the scene, seed and switches to those of the recording to replay.

    Other command-line options take precedence.
    """
    recording = options.recording
    if recording is None:
        return
    if options.scene not in (None, recording.scene):
        raise UsageError(f"{brief(options.replay, 150)} is a recording of {recording.scene}, not of {options.scene}")
    options.scene = recording.scene
    options.seed = recording.seed if options.seed is None else options.seed
    options.broadphase = options.broadphase or recording.broadphase
    options.solver = options.solver or recording.solver
    options.tier = options.tier or recording.tier
    if options.level is None:
        options.level = recording.level_path()


def _needs_scene(options, registry):
    needing = [flag for flag in ("headless", "bot", "record", "screenshot", "profile") if getattr(options, flag)]
    if needing and options.scene is None:
        raise UsageError(f"--{needing[0]} needs --scene", registry.names)
    if options.json and not (options.scene or options.list):
        raise UsageError("--json needs --list or --scene", registry.names)


def _check_tier(options, registry):
    from physics import TIERS

    _known(options.tier, "tier", TIERS)
    if options.scene is None:
        raise UsageError("--tier needs --scene", registry.names)
    valid = registry.scene_class(options.scene).tiers
    if not valid:
        raise UsageError(f"--tier: {options.scene} has no sprite bodies to test at another tier")
    if options.tier not in valid:
        raise UsageError(f"--tier: {options.scene} cannot use {options.tier}; valid: {', '.join(valid)}")


def _check_level(options, registry):
    takers = ", ".join(c.name for c in registry.all_classes() if c.takes_level) or "none here"
    if options.scene is None:
        raise UsageError(f"--level needs --scene; scenes that take one: {takers}")
    if not registry.scene_class(options.scene).takes_level:
        raise UsageError(f"--level: {options.scene} takes none; scenes that take one: {takers}")
    level_digest(options.level)  # a missing file is reported before anything is compiled


def _dispatch(options, registry):
    import physics

    if options.strict:
        warnings.simplefilter("error")
    if options.version:
        return _print_version()
    startup.say(startup.pygame_note())
    startup.say(startup.numba_note(physics.JIT))
    if options.list:
        return _print_list(options, registry)
    if options.warmup:
        from game.run.warmup import warm_up_all

        return warm_up_all(registry)
    if options.report is not None:
        from game.report.run import run_report

        return run_report(options, registry)
    if options.advise:
        from game.run.advise import run_advice

        return run_advice(options, registry)
    if options.headless:
        from game.run.headless import run_headless

        return run_headless(options, registry)
    from game.app import run_app

    return run_app(options, registry)


def _print_version():
    import numpy
    import pygame

    import physics

    sdl = ".".join(str(part) for part in pygame.get_sdl_version())
    compiled = "compiled kernels" if physics.JIT else "plain kernels"
    print(
        f"Hitbox {VERSION} ({startup.pygame_name()}, SDL {sdl}, numpy {numpy.__version__}, {compiled}, "
        f"Python {sys.version.split()[0]})"
    )
    return 0


def _print_list(options, registry):
    classes = registry.all_classes()
    if options.json:
        print(
            json.dumps(
                [
                    {"name": c.name, "title": c.title, "effects": c.effects.names(), "features": list(c.features)}
                    for c in classes
                ]
            )
        )
        return 0
    for c in classes:
        print(f"{c.name:18} {c.title}")
        print(f"{'':18} effects: {', '.join(c.effects.names()) or 'none'}")
        print(f"{'':18} {', '.join(c.features)}")
    return 0
