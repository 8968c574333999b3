"""`python -m tests.warm_kernels [PROCESSES]`: compile what the scenes need, so that tests find it on disk.

The workers of a test run would each compile most of the kernels, waiting for one another. With a warm cache this takes
some seconds, all of which go into listing.
"""

import importlib.util
import sys


def warm_up(processes=None):
    """Compile the kernels of every scene, under all broad phases, with all its solvers."""
    if importlib.util.find_spec("numba") is None:
        return
    from game.registry import Registry
    from game.run.warmup import StderrProgress, jobs_of
    from physics.background import compile_jobs
    from scenes import SCENES

    progress = StderrProgress(quiet=5.0)
    compile_jobs(
        [job for each in Registry(SCENES).all_classes() for job in jobs_of(each, everything=True)], progress, processes
    )
    progress.end()


if __name__ == "__main__":
    warm_up(*map(int, sys.argv[1:]))
