"""Worker processes that compile kernels, and the order in which they do.

A worker is told one task at a time, as a line, and answers with a line. It ends with its standard input, so that it
never outlives the program. A worker that dies or hangs is replaced; a task on which that happens twice fails. Where one
after the other dies without an answer, no more is started, and all tasks fail at once.
"""

import atexit
import base64
import contextlib
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

from physics.jit.processes import end_all, start_module
from physics.jit.store import store

MOST = 8  # processes: each takes 150 MB
HUNG = 300.0  # [s] without an answer
ATTEMPTS = 2
MARK = "hitbox "  # begins a line that is meant: libraries greet
DEATHS = 4  # processes that die one after the other without an answer, before no more is started


def cores_here() -> int:
    """Return how many cores this program may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return max(1, len(affinity(0)) if affinity else os.cpu_count() or 1)


def encoded(value: Any) -> str:
    """Return a value as one line of text."""
    return MARK + base64.b64encode(pickle.dumps(value)).decode()


def decoded(line: str) -> Any:
    """Return the value of such a line. Only for lines of our own processes."""
    return pickle.loads(base64.b64decode(line.removeprefix(MARK)))


class Task:
    """Work for one process. urgency(): the largest goes first; done(answer) is called with it in the worker's thread,
    None where it failed."""

    def __init__(self, order: Any, urgency: Callable[[], float], done: Callable[[Any], object]) -> None:
        self.order, self.urgency, self.done = order, urgency, done
        self.attempts = 0


class Workers:
    """A pool of processes of one module. `limit`: how many of them may work now."""

    def __init__(self, module: str, count: int | None = None) -> None:
        self.module = module
        self.count = 0 if getattr(sys, "frozen", False) else min(cores_here() if count is None else count, MOST)
        self._limit = self.count
        self._tasks: list[Task] = []
        self._under_way = 0
        self._processes: dict[int, subprocess.Popen[str]] = {}
        self._stopped = False
        self._deaths = 0  # since the last answer
        self._changed = threading.Condition()
        self._threads: list[threading.Thread] = []
        atexit.register(self.stop)

    @property
    def limit(self) -> int:
        """How many processes may work now; one that is at a task finishes it."""
        return self._limit

    @limit.setter
    def limit(self, value: int) -> None:
        with self._changed:
            self._limit = value
            self._changed.notify_all()

    @property
    def left(self) -> int:
        """How many tasks are waiting or under way."""
        return len(self._tasks) + self._under_way

    @property
    def alive(self) -> bool:
        """Whether there are, or can be, processes."""
        return self.count > 0 and not self._stopped and self._deaths < DEATHS

    def add(self, tasks: list[Task]) -> None:
        """Give tasks; the first ones start the processes."""
        with self._changed:
            self._tasks += tasks
            while len(self._threads) < min(self.count, len(self._tasks) + self._under_way):
                number = len(self._threads)
                self._threads.append(threading.Thread(target=self._serve, args=(number,), daemon=True))
                self._threads[-1].start()
            self._changed.notify_all()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until nothing is left to do; return whether that is so."""
        with self._changed:
            return self._changed.wait_for(lambda: not self.left or self._stopped, seconds) and not self.left

    def stop(self) -> None:
        """End all processes. What they have compiled stays."""
        with self._changed:
            self._stopped = True
            processes = list(self._processes.values())
            self._changed.notify_all()
        end_all(processes)
        atexit.unregister(self.stop)

    def _serve(self, number):
        """Hand one task after the other to process `number`, in a thread of its own."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._stopped or (self._tasks and number < self._limit))
                if self._stopped:
                    return
                task = max(self._tasks, key=lambda each: each.urgency())
                self._tasks.remove(task)
                self._under_way += 1
            answered, answer = False, None
            if self.alive:
                with contextlib.suppress(OSError, ValueError):  # no process can be started, or its pipe broke
                    answered, answer = self._ask(number, task.order)
                self._deaths = 0 if answered else self._deaths + 1
            if not answered and not self._stopped:
                task.attempts += 1
                if self.alive and task.attempts < ATTEMPTS:
                    with self._changed:
                        self._tasks.append(task)
                        self._under_way -= 1
                    continue
            task.done(answer)  # may add tasks, so before it counts as done
            with self._changed:
                self._under_way -= 1
                self._changed.notify_all()

    def _ask(self, number, order):
        """Return (whether it answered, its answer); a process that has died or hangs is ended, and the next one started
        with the next task."""
        process = self._processes.get(number)
        if process is None or process.poll() is not None:
            process = start_module(self.module, HITBOX_CACHE_DIR=str(store().folder))
            with self._changed:
                self._processes[number] = process
                if self._stopped:
                    process.kill()
        assert process.stdin is not None and process.stdout is not None
        watch = threading.Timer(HUNG, process.kill)
        watch.daemon = True
        watch.start()
        try:
            process.stdin.write(encoded(order) + "\n")
            process.stdin.flush()
            while (line := process.stdout.readline()) and not line.startswith(MARK):
                pass
        finally:
            watch.cancel()
        if not line:
            process.kill()
            with contextlib.suppress(OSError):
                process.stdin.close()
            process.wait()
            return False, None
        return True, decoded(line)
