"""Compilation of the kernels of scenes before they are needed."""

import sys
from time import perf_counter
from typing import Any, TextIO

import physics
from game.registry import Registry
from game.scene import Scene
from physics import Effects
from physics.background import compile_ahead, compile_jobs
from physics.jit import tiers
from physics.warmup import run_warmup

Job = dict[str, Any]  # arguments of physics.warmup, as JSON
BAR = 32  # characters


def jobs_of(
    scene_class: type[Scene], broadphase: str | None = None, solver: str | None = None, everything: bool = False
) -> list[Job]:
    """Return the kernels that a scene's worlds need at the start, as jobs: dicts of arguments of physics.warmup().

    broadphase, solver: the user's choices, or None. everything: True includes all optional parts of physics and all
    broad phases. False includes only those that the scene declares.
    """
    return [
        {
            "effects": list(effects.names()),
            "broadphase": "all" if everything else strategy_of(scene_class, broadphase),
            "solver": name,
            "pieces": None if everything else pieces_of(scene_class),
        }
        for effects, name in worlds_of(scene_class, solver)
    ]


def warm_up_scene(scene_class: type[Scene], broadphase: str | None = None, solver: str | None = None) -> None:
    """Compile the kernels that a scene needs at its start, on all cores, and load them.

    broadphase, solver: the user's choices, or None. Progress is written to standard error.
    """
    progress = StderrProgress()
    with tiers.collecting() as found:
        for effects, name in worlds_of(scene_class, solver):
            run_warmup(effects, strategy_of(scene_class, broadphase), name, pieces_of(scene_class))
    compile_ahead(found, progress)
    progress.end()


def strategy_of(scene_class: type[Scene], chosen: str | None = None) -> str:
    """Return the name of the broad phase of a scene's worlds at the start; "all" if each world has its own.

    chosen: the user's choice, or None.
    """
    return (chosen or scene_class.broadphase) if scene_class.switches_broadphase else "all"


def solvers_of(scene_class: type[Scene], chosen: str | None = None) -> tuple[str | None, ...]:
    """Return the names of all solvers that a scene's worlds may use. None in the result means World's default.

    chosen: the user's choice, or None.
    """
    return tuple(dict.fromkeys((chosen or scene_class.solver, *scene_class.solvers)))


def worlds_of(scene_class: type[Scene], chosen: str | None = None) -> list[tuple[Effects, str | None]]:
    """Return a list of (effects, solver), one for each kind of world that a scene may build.

    A solver of None means World's default. chosen: the user's choice of solver, or None.
    """
    names = solvers_of(scene_class, chosen)
    others = [(each, name if each.stacking else None) for each in scene_class.other_effects for name in names]
    return list(dict.fromkeys([*((scene_class.effects, name) for name in names), *others]))


def pieces_of(scene_class: type[Scene]) -> tuple[str, ...] | None:
    """Return the optional parts ("pieces") of physics that a scene uses; None if the scene does not restrict them.

    These are the parts that the scene declares, and "queries" if its bodies can be dragged.
    """
    if scene_class.pieces is None:
        return None
    return (*scene_class.pieces, *("queries",) * (scene_class.draggable and "queries" not in scene_class.pieces))


def warm_up_all(registry: Registry, out: TextIO | None = None) -> int:
    """Run --warmup: compile the kernels of all scenes and broad phases, on all cores. Return the exit code.

    out: stream for the progress; None means standard output.
    """
    stream: TextIO = sys.stdout if out is None else out
    started = perf_counter()
    classes = registry.all_classes()
    jobs = [job for each in classes for job in jobs_of(each, everything=True)]
    compile_jobs(jobs, lambda done, total, name: draw_bar(stream, done / max(total, 1), f"{done} of {total} kernels"))
    draw_bar(stream, 1.0, "ready")
    if stream.isatty():
        stream.write("\n")
    stream.write(
        f"{len(classes)} scenes, {len(physics.BROADPHASES)} broad phases: "
        f"kernels ready after {perf_counter() - started:.1f} s\n"
    )
    return 0


def draw_bar(out: TextIO, share: float, name: str) -> None:
    """Write a progress line over the previous one: a bar that is filled by `share` (0..1), and a name.

    Nothing is written if `out` is not a terminal.
    """
    if not out.isatty():
        return
    filled = int(share * BAR)
    out.write(f"\r[{'#' * filled}{'.' * (BAR - filled)}] {share:4.0%} {name:<32.32}")
    out.flush()


class StderrProgress:
    """Progress of compilation on standard error. Nothing is written before compilation has taken `quiet` seconds.

    On a terminal, the progress is one line that is updated. Otherwise, a new line is written every ten seconds.
    """

    def __init__(self, quiet: float = 1.0) -> None:
        self.started = self.written = perf_counter()
        self.quiet = quiet
        self.shown = False

    def __call__(self, done: int, total: int, name: str) -> None:
        """Write the progress if it is due.

        done, total: numbers of compiled kernels and of all kernels; name: not used.
        """
        now = perf_counter()
        if sys.stderr is None or now - self.started < self.quiet:
            return
        if sys.stderr.isatty():
            sys.stderr.write(f"\rhitbox: compiling the physics, {done} of {total} ready, {now - self.started:.0f} s ")
        elif not self.shown or now - self.written >= 10.0:
            self.written = now
            sys.stderr.write(f"hitbox: compiling the physics, {done} of {total} ready\n")
        self.shown = True
        sys.stderr.flush()

    def end(self) -> None:
        """Write the total time, if any progress was written."""
        if self.shown and sys.stderr is not None:
            lead = "\r" if sys.stderr.isatty() else ""
            sys.stderr.write(f"{lead}hitbox: physics compiled in {perf_counter() - self.started:.0f} s{' ' * 24}\n")
            sys.stderr.flush()
