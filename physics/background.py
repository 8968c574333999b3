"""Compilation of kernels in worker processes, in the background of a running program or ahead of time."""

import json
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from time import sleep
from typing import Any

from physics.jit import JIT, tiers
from physics.jit.kernels import Kernel, Keys
from physics.jit.plain import compiler
from physics.jit.store import store
from physics.jit.tiers import code_of, parts_of, spec_of
from physics.jit.workers import Task, Workers, short_turns, unhurried_imports

WORKER = f"{__package__}.compile_worker"
FIRST_STEPS = 0.2  # [s] wait before the first orders: the first steps show which kernels take the most time
ALONE = 0.8  # [s] wait from the first orders to the import of numba: no worker has compiled a kernel earlier
LINK = 500  # bytes of code whose compilation takes as long as the fixed part of compiling any kernel
FEW = 2  # up to this number of kernels are compiled in this process: a worker takes about as long to start
Progress = Callable[[int, int, str], Any]  # (done, total, name of a kernel)

_running: "list[Background]" = []


def compile_in_background(workers: int | None = None) -> "Background":
    """Have worker processes compile the kernels, which run as plain Python until then. Return the Background.

    workers: number of processes, at most 8; None: one less than the number of cores, but at least one.

    A compiled kernel replaces the plain one between two steps. Both give bit-identical results; only the speed differs.
    The kernels that take the most time per byte of code are compiled first. The processes start when a kernel is first
    called. They are started by `python -m`, so a script needs no `if __name__ == "__main__"`. A frozen program has no
    workers and compiles in a thread. Without numba the call has no effect.

    Call this function before the first step. Later calls return the same object. Raises ValueError if workers is
    neither None nor a whole number of at least 0.
    """
    if workers is not None and (not isinstance(workers, int) or isinstance(workers, bool) or workers < 0):
        raise ValueError(f"workers must be None or a whole number, at least 0 (got {workers!r})")
    if not _running:
        _running.append(Background(workers))
    return _running[0]


class Background:
    """The background compilation of this program's kernels, as returned by compile_in_background().

    failed: names of the kernels that stay plain Python.
    """

    def __init__(self, workers: int | None = None) -> None:
        self.workers = Workers(WORKER, workers)
        if workers is None:
            self.workers.limit = max(1, self.workers.count - 1)
        self.failed: list[str] = []  # names of kernels that stay plain
        self._waiting: dict[str, list[tuple[Kernel, Keys]]] = {}  # file name -> kernels and types that run from it
        self._ordered: set[str] = set()
        self._seen: set[tuple[Kernel, Keys]] = set()  # ordered or loaded
        self._came: deque[tuple[Kernel, Keys]] = deque()  # compiled by workers before numba was imported here
        self._compiled: set[Kernel] = set()  # compiled kernels and their parts: they cost later kernels nothing
        self._expected: deque[tuple[int, dict[str, Any]]] = deque()
        self._jobs = 0
        self._wake, self._stopped = threading.Event(), False
        self._thread = threading.Thread(target=self._work, daemon=True)
        if JIT:
            tiers.start(self._wake.set)
            self._thread.start()

    @property
    def share(self) -> float:
        """The compiled fraction, from 0 to 1, of the kernels that have been called so far."""
        return tiers.share_taken_over()

    @property
    def idle(self) -> bool:
        """Whether no kernel waits for compilation or is being compiled."""
        return not tiers.wanted and not self._expected and not self.workers.left

    def expect(self, jobs: Iterable[Mapping[str, Any]]) -> None:
        """Announce worlds that will be made later. Their kernels are compiled when no called kernel waits.

        jobs: a dict for each world, with the arguments of physics.warmup. All values must be representable in JSON;
            `effects` is a list of names.
        """
        for job in jobs:
            self._expected.append((self._jobs, dict(job)))
            self._jobs += 1
        self._wake.set()

    def stop(self) -> None:
        """End the worker processes. Compiled kernels stay in use; each other kernel is compiled when next called."""
        self._stopped = True
        self._wake.set()
        self.workers.stop()
        if self in _running:
            _running.remove(self)
            tiers.stop()

    def _work(self):
        """Load called kernels from the store, and have workers compile missing kernels, until stop() is called.

        This method runs in its own thread.
        """
        if store().empty and self.workers.alive:  # nothing to load yet, so numba is not needed here
            self._wake.wait()
            if tiers.wanted:
                sleep(FIRST_STEPS)
            if self._stopped:
                return
            for kernel, keys in list(tiers.wanted):
                self._order_early(kernel, keys)
            sleep(ALONE)
            if self._stopped:
                return
            with unhurried_imports():
                found = self._import()
        else:
            found = self._import()
        if not found:
            tiers.stop()
            self.workers.stop()
            return
        self._take_in()
        while not self._stopped:
            self._wake.wait()
            self._wake.clear()
            with short_turns():
                for kernel, keys in list(tiers.wanted):
                    self._find(kernel, keys)
                while self._expected and not self._stopped:
                    self._list(*self._expected.popleft())

    def _import(self):
        """Import numba and initialise LLVM in this process. Return whether numba can be imported."""
        with short_turns():
            if compiler() is None:
                return False
            from physics.jit import compiling

            compiling.prepare()
        tiers.load = compiling.load
        return True

    def _order_early(self, kernel, keys):
        """Have a worker compile a kernel while numba is not yet imported in this process.

        Without numba, this process cannot compute the name of the kernel's file in the store. keys: types of the
        kernel's arguments.
        """
        each = kernel, keys
        self._seen.add(each)

        def done(answer):
            if answer is not None:
                self._came.append(each)
                if tiers.load is not None:
                    self._take_in()
            elif self.workers.alive:
                self._fail(kernel.__qualname__, [each])
            else:
                self._seen.discard(each)
                self._wake.set()

        self.workers.add([Task(("compile", spec_of(kernel), keys), lambda: self._urgency([each]), done)])

    def _take_in(self):
        """Load the kernels that workers compiled before numba was imported in this process."""
        with suppress(IndexError):  # another thread took the last one
            while self._came:
                self._load([self._came.popleft()])

    def _find(self, kernel, keys):
        """Load a called kernel from the store; if it is missing there, have a worker or this thread compile it.

        keys: types of the kernel's arguments.
        """
        from physics.jit import compiling

        if (kernel, keys) in self._seen:
            return
        self._seen.add((kernel, keys))
        name = compiling.name_of(kernel, keys)
        self._waiting.setdefault(name, []).append(
            (kernel, keys)
        )  # added before the store is read: a worker may finish the kernel during the read
        form = compiling.load(kernel, keys)
        if form is None and self.workers.alive:
            self._order(name, spec_of(kernel), keys, 0)
        else:
            form = form or compiling.load_or_compile(kernel, keys)
            for each in self._waiting.pop(name, []):
                self._take(*each, form)

    def _order(self, name, spec, keys, index):
        """Have a worker compile a kernel. Called kernels come first, then announced kernels in the order of their jobs.

        Among the called kernels, the kernel with the most run time per byte of code to compile comes first. This is
        Smith's rule (1956), which minimises the sum of the waiting times. name: name of the kernel's file in the store;
        spec, keys: reference to the kernel and types of its arguments; index: number of the announced job, 0 for a
        called kernel.
        """
        if name in self._ordered:
            return
        self._ordered.add(name)

        def urgency():
            waiting = self._waiting.get(name)
            return self._urgency(waiting) if waiting else -index - 0.5

        def done(answer):
            if answer == name:
                self._arrive(name)
            elif self.workers.alive:
                self._fail(name, self._waiting.pop(name, []))
            else:  # no workers are left: the thread compiles the kernel
                self._seen.difference_update(self._waiting.pop(name, []))
                self._wake.set()

        self.workers.add([Task(("compile", spec, keys), urgency, done)])

    def _urgency(self, waiting):
        """Return the compilation priority of kernels that all wait for the same file of the store.

        It is 1 + (seconds that the kernels have run as plain Python) / (LINK + bytes of code not yet compiled).
        waiting: pairs (kernel, types of its arguments).
        """
        code = LINK + code_of(waiting[0][0], self._compiled)
        return 1.0 + sum(kernel.seconds for kernel, _ in waiting) / code

    def _fail(self, name, waiting):
        self.failed.append(name)
        for each in waiting:
            tiers.wanted.pop(each, None)

    def _arrive(self, name):
        self._load(self._waiting.pop(name, []))

    def _load(self, waiting):
        from physics.jit import compiling

        for kernel, keys in waiting:
            form = compiling.load(kernel, keys)
            if form is None:  # it could not be stored
                self._fail(kernel.__qualname__, [(kernel, keys)])
            else:
                self._take(kernel, keys, form)

    def _take(self, kernel, keys, form):
        self._compiled.update(parts_of(kernel))
        tiers.arrived.append((kernel, keys, form))

    def _list(self, index, job):
        """Have workers compile the kernels of an announced job, unless an earlier run compiled all of them.

        index: number of the job; job: arguments of physics.warmup, see expect.
        """
        mark = _mark(json.dumps(job, sort_keys=True))
        if store().has(mark) or not self.workers.alive:
            return

        def done(answer):
            if answer == []:
                store().write(mark, b"")
            for name, spec, keys in answer or ():
                self._order(name, spec, keys, index)

        self.workers.add([Task(("list", job), lambda: -float(index), done)])


def _mark(job):
    """Return the name of the marker file of a job in the store. job: a job of Background.expect, as JSON text.

    The file exists if all kernels of the job have been compiled from the present sources of the package.
    """
    from physics.jit.content import environment

    digest = blake2b(f"{_sources()}{environment()}{job}".encode(), digest_size=20).hexdigest()
    return f"all.{digest}"


@cache
def _sources():
    digest = blake2b(digest_size=20)
    for path in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def compile_ahead(found: Iterable[tuple[Kernel, Keys]], progress: Progress | None = None) -> None:
    """Compile kernels in worker processes on all cores, and load them.

    found: pairs (kernel, types of its arguments), as yielded by tiers.collecting(). progress(done, total, name) is
    called once for each kernel; `done` is the number of kernels that were compiled before it. A kernel that no worker
    could compile is compiled in this process.
    """
    order = _spread(dict.fromkeys(found))
    if not order:
        return
    from physics.jit import compiling

    names = {compiling.name_of(kernel, keys): (kernel, keys) for kernel, keys in order}
    reported: list[str] = []

    def tell(name):
        if progress and name not in reported:
            progress(len(reported), len(names), name.partition("(")[0])
        reported.append(name)

    workers = Workers(WORKER)
    if workers.count > 1 and len(names) > FEW:
        specs = [("compile", spec_of(kernel), keys) for kernel, keys in names.values()]
        places = zip(names, specs, range(len(names)), strict=True)
        workers.add([Task(spec, lambda n=n: -n, lambda _, name=name: tell(name)) for name, spec, n in places])
        try:
            workers.wait()
        finally:
            workers.stop()
    for name, (kernel, keys) in names.items():
        if name not in reported:
            tell(name)
        kernel.install(keys, compiling.load_or_compile(kernel, keys))


def compile_jobs(
    jobs: Iterable[Mapping[str, Any]], progress: Progress | None = None, processes: int | None = None
) -> None:
    """Compile the kernels of physics.warmup(**job) for each job into the store, without loading them.

    jobs: see Background.expect. progress(done, total, name) is called after each compiled kernel and after each listed
    job; done and total count kernels, and `total` grows as workers find the kernels of each job. A job is skipped if an
    earlier call compiled all of its kernels. processes: number of workers; None: one for each core. Raises RuntimeError
    with the names of kernels that could not be compiled.
    """
    if not JIT or compiler() is None:
        return
    marks = {_mark(json.dumps(job, sort_keys=True)): job for job in jobs}
    workers = Workers(WORKER, processes)
    ordered: dict[str, None] = {}
    failed: list[str] = []
    done = 0

    def finished(name, answer):
        nonlocal done
        done += 1
        if answer != name:
            failed.append(name)
        if progress:
            progress(done, len(ordered), name)

    def listed(mark, job, answer):
        if answer is None:
            failed.append(json.dumps(job))
        fresh = [each for each in answer or () if each[0] not in ordered]
        ordered.update(dict.fromkeys(name for name, *_ in fresh))
        if progress:
            progress(done, len(ordered), "")
        tasks = [("compile", spec, keys) for _, spec, keys in fresh]
        names = [name for name, *_ in fresh]
        workers.add(
            [
                Task(order, lambda: 0.0, lambda found, name=name: finished(name, found))
                for order, name in zip(tasks, names, strict=True)
            ]
        )

    left = {mark: job for mark, job in marks.items() if not store().has(mark)}
    orders = [(("list", job), mark, job) for mark, job in left.items()]
    workers.add([Task(each, lambda: 1.0, lambda found, m=m, j=j: listed(m, j, found)) for each, m, j in orders])
    try:
        workers.wait()
    finally:
        workers.stop()
    if failed:
        raise RuntimeError(f"{len(failed)} kernels could not be compiled: {', '.join(failed[:5])}")
    for mark in left:
        store().write(mark, b"")


def _spread(found):
    """Return `found` in an order in which the workers compile different parts of the physics at the same time.

    found: pairs (kernel, types of its arguments). The next kernel is always the one that adds the most code to the code
    of the kernels before it. In this order, the workers wait for each other 1 % of the time. In the order of code size
    they wait 14 % of the time (the platformer, two cores).
    """
    left, order, covered = list(found), [], set()
    while left:
        first = max(left, key=lambda each: code_of(each[0], covered))
        left.remove(first)
        covered.update(parts_of(first[0]))
        order.append(first)
    return order
