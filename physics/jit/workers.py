"""Pool of worker processes that compile kernels, and sharing of the interpreter with background threads."""

import atexit
import base64
import contextlib
import os
import pickle
import site
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import sleep, thread_time
from typing import Any

from physics.jit import tiers
from physics.jit.store import store

# ---- turns -----------------------------------------------------------------------------------------------------------
# Sharing of the interpreter between a background thread and the program.

SHARE = 0.2  # share of a thread's time in which it imports while kernels run plain
TURN = 0.0005  # [s] switch interval of the threads of this process while kernels are loaded


@contextmanager
def short_turns() -> Iterator[None]:
    """Return a context manager in which the interpreter switches between threads after TURN [s].

    The main thread releases the interpreter lock in every call of NumPy, and would wait 5 ms to get it back. With the
    shorter interval, frames of the platformer take 55 ms instead of 80 ms while the compiler is imported.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(TURN)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


class _Pauses:
    """An import hook that slows down the imports of the current thread while kernels run as plain Python.

    It is a module finder that sleeps before each import and finds no module.
    """

    def __init__(self):
        self.thread, self.since = threading.get_ident(), thread_time()

    def find_spec(self, name, path=None, target=None):
        if threading.get_ident() == self.thread and tiers.wanted:
            sleep((thread_time() - self.since) * (1.0 / SHARE - 1.0))
            self.since = thread_time()


@contextmanager
def unhurried_imports() -> Iterator[None]:
    """Return a context manager in which imports take at most the fraction SHARE of this thread's time.

    The import of the compiler takes 0.7 s of processor time. Without pauses, a game with plain kernels showed only 20
    frames in that second.
    """
    pauses: Any = _Pauses()
    sys.meta_path.insert(0, pauses)
    try:
        yield
    finally:
        sys.meta_path.remove(pauses)


# ---- processes -------------------------------------------------------------------------------------------------------
# Worker processes of the program: they run a module that reads orders as lines, and answers with lines.

IMPORTED_FROM = Path(__file__).resolve().parents[__name__.count(".")]  # the folder from which this package is imported


def start_module(module: str, **environment: str) -> "subprocess.Popen[str]":
    """Start `python -m module` at low priority, with text pipes for its standard input and output. Return the process.

    The process is not interrupted by Ctrl-C in the terminal. It imports from the same folders as this program. It does
    not import from the current folder, where a file such as `numpy.py` may belong to the user. module: full name of the
    module; environment: additional environment variables. Raises OSError or ValueError if no process can be started.
    """
    # A process group, not a session: Linux divides processor time between sessions, whatever the priority of their
    # processes (autogroups, man 7 sched). A session of its own would take as much time as the program.
    options: dict[str, Any] = {"process_group": 0}
    if sys.platform == "win32":
        options = {"creationflags": subprocess.BELOW_NORMAL_PRIORITY_CLASS | subprocess.CREATE_NEW_PROCESS_GROUP}
    return subprocess.Popen(
        [sys.executable, "-P", "-m", module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, **search_path(), **environment},
        **options,
    )


def search_path() -> dict[str, str]:
    """Return {"PYTHONPATH": …}, the environment variable with which a child process imports this same package.

    The dict is empty if the child process imports the package without this variable.
    """
    if IMPORTED_FROM in {Path(each).resolve() for each in (*site.getsitepackages(), site.getusersitepackages())}:
        return {}  # if named again, site-packages would come before the standard library
    return {"PYTHONPATH": os.pathsep.join(filter(None, (str(IMPORTED_FROM), os.environ.get("PYTHONPATH"))))}


def end_all(processes: Iterable["subprocess.Popen[str]"]) -> None:
    """Kill all processes, wait for the end of each, and close their pipes."""
    processes = list(processes)
    for process in processes:
        process.kill()
    for process in processes:
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                if pipe is not None:
                    pipe.close()


# ---- workers ---------------------------------------------------------------------------------------------------------
# Worker processes that compile kernels, and the order of their tasks.
#
# A worker gets one task at a time, as a line, and answers with a line. It ends when its standard input is closed, so it
# never outlives the program. A worker that dies or hangs is replaced; a task on which this happens twice fails. If
# workers die one after the other without an answer, no more are started, and all tasks fail immediately.

MOST = 8  # processes: each takes 150 MB
HUNG = 300.0  # [s] a worker that gives no answer for this time hangs
ATTEMPTS = 2  # most attempts at a task
MARK = "hitbox "  # first word of an answer: libraries may print other lines
DEATHS = 4  # after this many deaths in a row without an answer, no more processes are started


def cores_here() -> int:
    """Return the number of processor cores that this program may use, at least 1."""
    affinity = getattr(os, "sched_getaffinity", None)
    return max(1, len(affinity(0)) if affinity else os.cpu_count() or 1)


def encoded(value: Any) -> str:
    """Convert a value to one line of text, for a pipe between processes, and return the line."""
    return MARK + base64.b64encode(pickle.dumps(value)).decode()


def decoded(line: str) -> Any:
    """Convert a line made by encoded() back to a value, and return the value.

    Use it only for lines from this program's own processes, because the line is unpickled.
    """
    return pickle.loads(base64.b64decode(line.removeprefix(MARK)))


class Task:
    """A task for a worker process. The waiting task with the largest urgency() is started first.

    order: the value that is sent to the process; urgency: function that returns the priority of the task; done:
    function that is called with the answer of the process, or with None if the task fails. `done` is called in the
    thread that communicates with the process.
    """

    def __init__(self, order: Any, urgency: Callable[[], float], done: Callable[[Any], object]) -> None:
        self.order, self.urgency, self.done = order, urgency, done
        self.attempts = 0


class Workers:
    """A pool of worker processes that all run one module.

    module: full name of the module; count: greatest number of processes, None: one for each core.
    """

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
        """The number of processes that may start tasks now. A process above the limit finishes its present task."""
        return self._limit

    @limit.setter
    def limit(self, value: int) -> None:
        with self._changed:
            self._limit = value
            self._changed.notify_all()

    @property
    def left(self) -> int:
        """The number of tasks that are not done: tasks that wait, and tasks that are being processed."""
        return len(self._tasks) + self._under_way

    @property
    def alive(self) -> bool:
        """Whether worker processes run or can be started."""
        return self.count > 0 and not self._stopped and self._deaths < DEATHS

    def add(self, tasks: list[Task]) -> None:
        """Add tasks, and start processes as needed, up to self.count processes in total."""
        with self._changed:
            self._tasks += tasks
            while len(self._threads) < min(self.count, len(self._tasks) + self._under_way):
                number = len(self._threads)
                self._threads.append(threading.Thread(target=self._serve, args=(number,), daemon=True))
                self._threads[-1].start()
            self._changed.notify_all()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until all tasks are done. Return whether all tasks are done.

        seconds: longest wait [s]; None: no limit. The wait also ends when stop() is called.
        """
        with self._changed:
            return self._changed.wait_for(lambda: not self.left or self._stopped, seconds) and not self.left

    def stop(self) -> None:
        """Kill all processes. The kernels that they have stored remain in the store."""
        with self._changed:
            self._stopped = True
            processes = list(self._processes.values())
            self._changed.notify_all()
        end_all(processes)
        atexit.unregister(self.stop)

    def _serve(self, number):
        """Send tasks one by one to process number `number` until stop() is called.

        This method runs in a separate thread for each process.
        """
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
                with contextlib.suppress(OSError, ValueError):  # no process can be started, or its pipe is broken
                    answered, answer = self._ask(number, task.order)
                self._deaths = 0 if answered else self._deaths + 1
            if not answered and not self._stopped:
                task.attempts += 1
                if self.alive and task.attempts < ATTEMPTS:
                    with self._changed:
                        self._tasks.append(task)
                        self._under_way -= 1
                    continue
            task.done(answer)  # this may add tasks, so it is called before the task counts as done
            with self._changed:
                self._under_way -= 1
                self._changed.notify_all()

    def _ask(self, number, order):
        """Send an order to process number `number`. Return (True, answer), or (False, None) if the process died.

        A process that gives no answer for HUNG [s] is killed. A dead process is replaced when the next order is sent.
        """
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
