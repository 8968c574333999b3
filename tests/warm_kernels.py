"""`python -m tests.warm_kernels [PROCESSES]`: compile the kernels of all scenes, so that tests load them from disk.

Otherwise each worker of a test run would compile most of the kernels, waiting for the others. With a full cache the
command takes some seconds, all for listing the kernels.
"""

import importlib.util
import sys


def warm_up(processes=None):
    """Compile the kernels of every scene with all broad phases and all its solvers; do nothing without numba.

    processes: number of compiling processes, None for the default.
    """
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
