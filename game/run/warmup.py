"""Compiling the kernels before they are needed, with a bar that shows how far that is."""

import sys
from time import perf_counter

import physics

BAR = 32  # characters


def warm_up_scene(scene_class, broadphase=None, solver=None, progress=None):
    """Compile what one scene needs at its start. progress(done, total, name) is called before each piece."""
    strategy = (broadphase or scene_class.broadphase) if scene_class.switches_broadphase else "all"
    names = solvers_of(scene_class, solver)
    for index, name in enumerate(names):
        physics.warmup(
            scene_class.effects, strategy, name, part_of(progress, index, len(names)), pieces_of(scene_class)
        )


def solvers_of(scene_class, chosen=None):
    """Names of all solvers that a scene's worlds may use; None is the World's own choice."""
    return tuple(dict.fromkeys((chosen or scene_class.solver, *scene_class.solvers)))


def pieces_of(scene_class):
    """What of the physics a scene says it meets, and what dragging asks."""
    if scene_class.pieces is None:
        return None
    return (*scene_class.pieces, *("queries",) * (scene_class.draggable and "queries" not in scene_class.pieces))


def part_of(progress, index, parts):
    """`progress` for one of several equal parts: it counts on where the part before ended. None stays None."""
    if progress is None:
        return None
    return lambda done, total, name: progress(index * total + done, parts * total, name)


def warm_up_all(registry, out=None):
    """--warmup: every scene under every broad phase. Returns the exit code."""
    out = out or sys.stdout
    started = perf_counter()
    classes = registry.all_classes()
    for index, scene_class in enumerate(classes):

        def show(done, total, name, index=index):
            draw_bar(out, (index + done / max(total, 1)) / len(classes), name)

        names = solvers_of(scene_class)
        for part, name in enumerate(names):
            physics.warmup(scene_class.effects, "all", name, progress=part_of(show, part, len(names)))
    draw_bar(out, 1.0, "ready")
    if out.isatty():
        out.write("\n")
    out.write(
        f"{len(classes)} scenes, {len(physics.BROADPHASES)} broad phases: "
        f"kernels ready after {perf_counter() - started:.1f} s\n"
    )
    return 0


def draw_bar(out, share, name):
    """One line that overwrites itself on a terminal; a file or a pipe gets none."""
    if not out.isatty():
        return
    filled = int(share * BAR)
    out.write(f"\r[{'#' * filled}{'.' * (BAR - filled)}] {share:4.0%} {name:<32.32}")
    out.flush()
