"""`python -m game.run.compile_worker`: compiles kernels ahead, while a window shows menus or somebody plays.

Several of these share the work: a kernel that one is at, or has finished, no other compiles (game/run/kernel_work.py).
One line of JSON on standard input is an order; standard output says how far each job is. It ends with its standard
input, so that it never outlives the program that started it.
"""

import contextlib
import json
import os
import sys
import threading
import time
from collections import deque
from typing import Any

import physics
from game.run.kernel_work import Version, claim, listing
from physics.jit import claims

NICE = 10  # of the system's 0 to 19: whoever plays goes first
POLL = 0.02  # [s]


class Work:
    """The jobs that are waiting, and whether to rest. `changed` is told of every order."""

    def __init__(self) -> None:
        self.jobs: deque[str] = deque()  # each a line of JSON
        self.resting = False
        self.changed = threading.Condition()

    def listen(self) -> None:
        """Take orders until there is nobody left to give them; then end the process, whatever it is at."""
        for line in sys.stdin:
            order = json.loads(line)
            with self.changed:
                if "rest" in order:
                    self.resting = order["rest"]
                else:
                    job = json.dumps(order["job"], sort_keys=True)
                    if job in self.jobs:
                        self.jobs.remove(job)
                    if order["first"]:
                        self.jobs.appendleft(job)
                    else:
                        self.jobs.append(job)
                self.changed.notify_all()
        os._exit(0)

    def next(self) -> str:
        """The job to do now; waits for one."""
        with self.changed:
            self.changed.wait_for(lambda: self.jobs and not self.resting)
            return self.jobs[0]

    def goes_on(self, job: str) -> bool:
        """True while it is still the first; waits while there is to be rest."""
        with self.changed:
            self.changed.wait_for(lambda: not self.resting)
            return bool(self.jobs) and self.jobs[0] == job

    def done(self, job: str) -> None:
        """It is behind us."""
        with self.changed:
            if job in self.jobs:
                self.jobs.remove(job)


def versions_of(job: dict[str, Any]) -> list[Version]:
    """The kernels of a job, by running its warm-up uncompiled."""
    effects = physics.Effects.named(job["effects"])
    return listing(lambda: physics.warmup(effects, job["broadphase"], job["solver"], pieces=job["pieces"]))


def do(work: Work, job: str, versions: list[Version]) -> bool:
    """Compile what is not kept yet; False if another job has become the first before it was done."""
    left = [each for each in versions if not each.kept]
    tell(job, len(versions) - len(left), len(versions))
    while left:
        for each in left:
            if not work.goes_on(job):
                return False
            if not each.kept and each.compile():
                tell(job, sum(each.kept for each in versions), len(versions))
        before, left = left, [each for each in left if not each.kept]
        if len(left) == len(before):
            time.sleep(POLL)  # another process is at the last ones
    tell(job, len(versions), len(versions))
    return True


def tell(job: str, done: int, of: int) -> None:
    """One line about a job."""
    print(json.dumps([job, done, of]), flush=True)


def main() -> None:
    """Work for as long as there is somebody to work for."""
    with contextlib.suppress(OSError, AttributeError):
        os.nice(NICE)
    work, known = Work(), {}
    claims.claim = claim
    threading.Thread(target=work.listen, daemon=True).start()
    while True:
        job = work.next()
        if job not in known:
            known[job] = versions_of(json.loads(job))
        if do(work, job, known[job]):
            work.done(job)


if __name__ == "__main__":
    main()
