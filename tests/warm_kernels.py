"""`python -m tests.warm_kernels PART OF`: compile what the scenes need, in one of several processes side by side.

Two workers of a test run would each compile most of the kernels: 240 s of processor time where the cache is empty. Two
of these share the work: 160 s, and nothing is left for the workers. With a warm cache each takes two seconds.
"""

import importlib.util
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def warm_up_part(part, of):
    """Compile the kernels of every `of`-th scene, under all broad phases, with all its solvers."""
    import physics
    from game.registry import Registry
    from game.run.warmup import worlds_of
    from scenes import SCENES

    for scene_class in Registry(SCENES).all_classes()[part::of]:
        for effects, solver in worlds_of(scene_class):
            physics.warmup(effects, "all", solver)


def warm_up_side_by_side(processes):
    """Compile everything, in so many processes; returns when all are done. Raises CalledProcessError if one failed."""
    if importlib.util.find_spec("numba") is None:
        return
    commands = [[sys.executable, "-m", __name__, str(part), str(processes)] for part in range(processes)]
    running = [subprocess.Popen(command, cwd=ROOT) for command in commands]
    for process, command in zip(running, commands, strict=True):
        if process.wait():
            raise subprocess.CalledProcessError(process.returncode, command)


if __name__ == "__main__":
    warm_up_part(int(sys.argv[1]), int(sys.argv[2]))
