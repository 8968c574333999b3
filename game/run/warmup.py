"""Compiling the kernels before they are needed, with a bar that shows how far that is."""

import sys
from collections.abc import Callable
from time import perf_counter
from typing import TextIO

import physics
from game.registry import Registry
from game.scene import Scene
from physics import Effects

Progress = Callable[[int, int, str], None]  # done, total, name of the piece that is next

BAR = 32  # characters


def warm_up_scene(
    scene_class: type[Scene], broadphase: str | None = None, solver: str | None = None, progress: Progress | None = None
) -> None:
    """Compile what one scene needs at its start. progress(done, total, name) is called before each piece."""
    strategy = strategy_of(scene_class, broadphase)
    worlds = worlds_of(scene_class, solver)
    for index, (effects, name) in enumerate(worlds):
        physics.warmup(effects, strategy, name, part_of(progress, index, len(worlds)), pieces_of(scene_class))


def strategy_of(scene_class: type[Scene], chosen: str | None = None) -> str:
    """The broad phase that a scene's worlds begin with; "all" where each has its own."""
    return (chosen or scene_class.broadphase) if scene_class.switches_broadphase else "all"


def solvers_of(scene_class: type[Scene], chosen: str | None = None) -> tuple[str | None, ...]:
    """Names of all solvers that a scene's worlds may use; None is the World's own choice."""
    return tuple(dict.fromkeys((chosen or scene_class.solver, *scene_class.solvers)))


def worlds_of(scene_class: type[Scene], chosen: str | None = None) -> list[tuple[Effects, str | None]]:
    """(effects, solver) of all kinds of worlds that a scene may have; None is the World's own choice."""
    names = solvers_of(scene_class, chosen)
    others = [(each, name if each.stacking else None) for each in scene_class.other_effects for name in names]
    return list(dict.fromkeys([*((scene_class.effects, name) for name in names), *others]))


def pieces_of(scene_class: type[Scene]) -> tuple[str, ...] | None:
    """What of the physics a scene says it meets, and what dragging asks."""
    if scene_class.pieces is None:
        return None
    return (*scene_class.pieces, *("queries",) * (scene_class.draggable and "queries" not in scene_class.pieces))


def part_of(progress: Progress | None, index: int, parts: int) -> Progress | None:
    """`progress` for one of several equal parts: it counts on where the part before ended. None stays None."""
    if progress is None:
        return None
    return lambda done, total, name: progress(index * total + done, parts * total, name)


def warm_up_all(registry: Registry, out: TextIO | None = None) -> int:
    """--warmup: every scene under every broad phase. Returns the exit code."""
    stream: TextIO = sys.stdout if out is None else out
    started = perf_counter()
    classes = registry.all_classes()
    for index, scene_class in enumerate(classes):

        def show(done, total, name, index=index, stream=stream):
            draw_bar(stream, (index + done / max(total, 1)) / len(classes), name)

        worlds = worlds_of(scene_class)
        for part, (effects, name) in enumerate(worlds):
            physics.warmup(effects, "all", name, progress=part_of(show, part, len(worlds)))
    draw_bar(stream, 1.0, "ready")
    if stream.isatty():
        stream.write("\n")
    stream.write(
        f"{len(classes)} scenes, {len(physics.BROADPHASES)} broad phases: "
        f"kernels ready after {perf_counter() - started:.1f} s\n"
    )
    return 0


def draw_bar(out: TextIO, share: float, name: str) -> None:
    """One line that overwrites itself on a terminal; a file or a pipe gets none."""
    if not out.isatty():
        return
    filled = int(share * BAR)
    out.write(f"\r[{'#' * filled}{'.' * (BAR - filled)}] {share:4.0%} {name:<32.32}")
    out.flush()
