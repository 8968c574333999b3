"""Which form of a kernel runs where its compiled form is not at hand: compile now, run plain, or run plain and note it.

Left alone, a kernel is loaded or compiled at its first call. `collecting()` notes what a run calls that is not on disk,
so that several processes can compile it. `start()` opts in to tiers for the rest of the program: kernels run plain, a
thread loads what is on disk and has the rest compiled by worker processes (workers.py), the kernels with the largest
share of the time for their length first; take_over() lets what has arrived run from the next step on.
"""

from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from physics.jit.compiler import compiler
from physics.jit.kernels import Form, Kernel, Keys, registry

background = False  # this program has opted in to tiers
wanted: dict[tuple[Kernel, Keys], None] = {}  # what has run plain, in the order of the first calls
arrived: deque[tuple[Kernel, Keys, Form]] = deque()  # compiled forms that wait for the end of a step
asked: Callable[[], object] | None = None  # called when something is wanted
load: Callable[[Kernel, Keys], Form | None] | None = None  # compiling.load, once the compiler is imported
_collected: dict[tuple[Kernel, Keys], None] | None = None
_recording = False


def form_of(kernel: "Kernel", keys: "Keys") -> Form | None:
    """Return the compiled form that a first call with these types runs; None where its plain twin runs instead."""
    if _collected is not None:
        return _note(kernel, keys, _collected)
    if background:
        form = load(kernel, keys) if load is not None else None
        if form is None and (kernel, keys) not in wanted:
            wanted[kernel, keys] = None
            if asked is not None:
                asked()
        return form
    if compiler() is None:
        return kernel.call_plain
    from physics.jit import compiling

    return compiling.load_or_compile(kernel, keys)


def _note(kernel, keys, collected):
    form = None
    if not _recording and compiler() is not None:
        from physics.jit import compiling

        form = compiling.load(kernel, keys)
    if form is None:
        collected[kernel, keys] = None
    return form


@contextmanager
def collecting(all_calls: bool = False) -> Iterator[dict[tuple[Kernel, Keys], None]]:
    """Run plain what is not on disk, compile nothing, and give its (kernel, types) in the order of the calls.

    all_calls: of every kernel that has not run here yet, on disk or not.
    """
    global _collected, _recording
    before = _collected, _recording
    _collected, _recording = {}, all_calls
    try:
        yield _collected
    finally:
        _collected, _recording = before


def start(when_asked: Callable[[], object]) -> None:
    """Run kernels plain from now on where their compiled form is not at hand; when_asked() is called for each."""
    global background, asked
    background, asked = True, when_asked


def stop() -> None:
    """Compile kernels at their first call again, those too that have run plain."""
    global background, asked, load
    background, asked, load = False, None, None
    take_over()
    for kernel, _ in wanted:
        kernel.reset()
    wanted.clear()


def take_over() -> None:
    """Let compiled forms that have arrived run from now on. World.step calls it before it begins."""
    while arrived:
        kernel, keys, form = arrived.popleft()
        wanted.pop((kernel, keys), None)
        kernel.install(keys, form)
        kernel.seconds = 0.0


def share_taken_over() -> float:
    """Return how many of the kernels that were called run compiled, 0..1; 1 before any was called."""
    if not wanted:
        return 1.0
    compiled = sum(len(each.forms) for each in registry)
    return compiled / (compiled + len(wanted))


def forget() -> None:
    """Let every kernel begin anew, plain or not: for tests."""
    wanted.clear()
    arrived.clear()
    for each in registry:
        each.forms.clear()
        each.reset()
