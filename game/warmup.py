"""Compiling the kernels before they are needed, with a bar that shows how far that is."""

import sys
from time import perf_counter

import physics

BAR = 32       # characters


def warm_up_scene(scene_class, broadphase=None, solver=None, progress=None):
    """Compile what one scene needs at its start. progress(done, total, name) is called before each piece."""
    strategy = (broadphase or scene_class.broadphase) if scene_class.switches_broadphase else "all"
    physics.warmup(scene_class.effects, strategy, solver or scene_class.solver, progress=progress)


def warm_up_all(registry, out=None):
    """--warmup: every scene under every broad phase. Returns the exit code."""
    out = out or sys.stdout
    started = perf_counter()
    classes = registry.all_classes()
    for index, scene_class in enumerate(classes):
        def show(done, total, name, index=index):
            draw_bar(out, (index + done / max(total, 1)) / len(classes), name)

        physics.warmup(scene_class.effects, "all", scene_class.solver, progress=show)
    draw_bar(out, 1.0, "ready")
    if out.isatty():
        out.write("\n")
    out.write(f"{len(classes)} scenes, {len(physics.BROADPHASES)} broad phases: "
              f"kernels ready after {perf_counter() - started:.1f} s\n")
    return 0


def draw_bar(out, share, name):
    """One line that overwrites itself on a terminal; a file or a pipe gets none."""
    if not out.isatty():
        return
    filled = int(share * BAR)
    out.write(f"\r[{'#' * filled}{'.' * (BAR - filled)}] {share:4.0%} {name:<32.32}")
    out.flush()
