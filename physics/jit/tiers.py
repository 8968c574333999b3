"""Choice of the form (compiled or plain) that runs when Python calls a kernel, and references to kernels.

With a reference, another process finds the same kernel.
"""

import importlib
from collections import deque
from collections.abc import Callable, Container, Iterator
from contextlib import contextmanager
from functools import cache
from time import perf_counter
from types import CellType, CodeType, FunctionType
from typing import Any

from physics.jit.content import content_of
from physics.jit.kernels import CHECKING, Form, Kernel, Keys, Part, is_whole, key_of, registry, text_of
from physics.jit.plain import compiler, globals_of, view_of

# ---- tiers -----------------------------------------------------------------------------------------------------------
# The form of a kernel that runs if its compiled form is not loaded: compile it, run plain, or run plain and record it.
#
# By default a kernel is loaded or compiled at its first call. `collecting()` records the kernels of a run that are not
# on disk, so that several processes can compile them. `start()` opts in to tiers for the rest of the program. Kernels
# then run plain, while a thread loads the kernels on disk. It has the others compiled by worker processes (workers.py),
# in the order of their time per length of code. take_over() installs compiled forms between two steps.

background = False  # whether this program has opted in to tiers
wanted: dict[tuple[Kernel, Keys], None] = {}  # kernels that have run plain, in the order of their first calls
arrived: deque[tuple[Kernel, Keys, Form]] = deque()  # compiled forms to be installed after the step
asked: Callable[[], object] | None = None  # called when a kernel is added to `wanted`
load: Callable[[Kernel, Keys], Form | None] | None = None  # compiling.load, once the compiler is imported
_collected: dict[tuple[Kernel, Keys], None] | None = None
_recording = False


def form_of(kernel: "Kernel", keys: "Keys") -> Form | None:
    """Return the form that runs at the first call of a kernel with arguments of the types `keys`.

    None: run its plain twin in this call, because it is not compiled now.
    """
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
    """Return a context manager in which kernels that are not on disk run as plain Python, and nothing is compiled.

    It yields a dict whose keys are the pairs (kernel, types of its arguments) of these kernels, in the order of first
    calls. all_calls: True: also run and record kernels that are on disk but not yet loaded.
    """
    global _collected, _recording
    before = _collected, _recording
    _collected, _recording = {}, all_calls
    try:
        yield _collected
    finally:
        _collected, _recording = before


def start(when_asked: Callable[[], object]) -> None:
    """Have kernels without a compiled form run as plain Python from now on. Call when_asked() once for each of them."""
    global background, asked
    background, asked = True, when_asked


def stop() -> None:
    """End the effect of start(): each kernel without a compiled form is compiled at its next call."""
    global background, asked, load
    background, asked, load = False, None, None
    take_over()
    for kernel, _ in wanted:
        kernel.reset()
    wanted.clear()


def take_over() -> None:
    """Install the compiled forms in `arrived`, so that later calls run them. World.step calls this function first."""
    while arrived:
        kernel, keys, form = arrived.popleft()
        wanted.pop((kernel, keys), None)
        kernel.install(keys, form)
        kernel.seconds = 0.0


def share_taken_over() -> float:
    """Return the compiled fraction, from 0 to 1, of the kernels that have been called; 1 if none was called."""
    if not wanted:
        return 1.0
    compiled = sum(len(each.forms) for each in registry)
    return compiled / (compiled + len(wanted))


def forget() -> None:
    """Delete the compiled forms of all kernels from memory, for tests."""
    wanted.clear()
    arrived.clear()
    for each in registry:
        each.forms.clear()
        each.reset()


# ---- calls -----------------------------------------------------------------------------------------------------------
# Kernels that Python calls, and the form that runs at a call.
#
# At its first call a kernel is loaded from disk or compiled. In a program that opted in to tiers it runs as its plain
# twin and is queued, and its compiled form takes over between two steps. While kernels are collected, a kernel that is
# not on disk also runs plain, and is recorded.


class StageKernel(Kernel):
    """A kernel that a stage calls. Once it is compiled, Python calls the compiled form directly.

    A direct call does not inspect the types of the arguments. The inspection would take 1.07 us for six tables; the
    call takes 0.1 us, and a step of 55 boxes makes 15 calls. A kernel that is not `generic` must be called with the
    same types each time. A float instead of an int raises TypeError, and the compiled form raises an error for an array
    with another element size. Other wrong types are detected only if the environment variable HITBOX_CHECK_CALLS is 1.
    """

    def reset(self) -> None:
        """Have the next call look for a compiled form again."""
        self.run = self._generic_call if self.is_generic else self._first_call

    def install(self, keys: Keys, form: Form) -> None:
        """Store a compiled form, which runs from now on in calls with arguments of the types `keys`."""
        self.forms[keys] = form
        if self.is_generic:
            return
        whole = tuple(place for place, key in enumerate(keys) if is_whole(key))
        self.run = _checked(self, keys, whole, form) if CHECKING or whole else form

    def _first_call(self, *arguments):
        keys = tuple(map(key_of, arguments))
        form = form_of(self, keys)
        if form is not None:
            self.install(keys, form)
            return form(*arguments)
        if (self, keys) in wanted:  # its types are known, and a worker compiles it
            self.run = self._timed_plain_call
        return self._timed_plain_call(*arguments)

    def _generic_call(self, *arguments):
        keys = tuple(map(key_of, arguments))
        form = self.forms.get(keys)
        if form is None:
            form = form_of(self, keys)
            if form is None:
                return self._timed_plain_call(*arguments)
            self.install(keys, form)
        return form(*arguments)

    def _timed_plain_call(self, *arguments):
        started = perf_counter()
        try:
            return self.plain(*[view_of(each) for each in arguments])
        finally:
            self.seconds += perf_counter() - started


def _checked(kernel, keys, whole, form):
    """Return a wrapper of a compiled form that raises TypeError if an argument that must be an int is a float.

    If CHECKING is True, it raises TypeError for any argument of another type. keys: types of the arguments; whole:
    indices of the arguments that must be ints.
    """

    def call(*arguments):
        for place in whole:
            if isinstance(arguments[place], float):
                _refuse_other_types(kernel, keys, arguments)
        if CHECKING:
            _refuse_other_types(kernel, keys, arguments)
        return form(*arguments)

    return call


def _refuse_other_types(kernel, keys, arguments):
    found = tuple(map(key_of, arguments))
    if found != keys:
        places = enumerate(zip(keys, found, strict=True))
        wrong = [f"{k}: {text_of(was)} before, {text_of(now)} now" for k, (was, now) in places if was != now]
        raise TypeError(f"{kernel.name} must be called with the same types each time (got {'; '.join(wrong)})")


# ---- specs -----------------------------------------------------------------------------------------------------------
# References to kernels by which another process finds or makes the same kernels: the module and name of the code, its
# closure, and the hash of the content that must result.

Spec = tuple[str, str, str, tuple[tuple[bool, Any], ...], dict[str, bool]]


def spec_of(kernel: Kernel) -> Spec:
    """Return a reference to a kernel, which can be pickled. Another process gets the same kernel by kernel_of(spec)."""
    function = kernel.py_func
    closed = tuple(
        (True, spec_of(cell.cell_contents)) if isinstance(cell.cell_contents, Kernel) else (False, cell.cell_contents)
        for cell in function.__closure__ or ()
    )
    flags = {"is_part": kernel.is_part, "is_inlined": kernel.is_inlined, "noalias": kernel.noalias}
    return (
        function.__module__,
        function.__qualname__,
        content_of(kernel),
        closed,
        {**flags, "is_generic": kernel.is_generic},
    )


def kernel_of(spec: Spec) -> Kernel:
    """Return the kernel to which a spec refers; make it if this process does not have it.

    Raises LookupError if the sources in this process differ from those of the kernel.
    """
    module, qualname, content, closed, flags = spec
    importlib.import_module(module)
    for each in registry:
        if each.__qualname__ == qualname and each.__module__ == module and content_of(each) == content:
            return each
    for code in _codes_of(module, qualname):
        cells = tuple(CellType(kernel_of(value) if is_kernel else value) for is_kernel, value in closed)
        if len(cells) == len(code.co_freevars):
            made = _make(module, code, cells, flags)
            if content_of(made) == content:
                return made
    raise LookupError(f"{module}.{qualname} is another here: its sources have changed")


def _make(module, code, cells, flags):
    function = FunctionType(code, vars(importlib.import_module(module)), code.co_name, None, cells)
    function.__qualname__ = code.co_qualname
    kind = Part if flags["is_part"] else StageKernel
    return kind(function, **{name: value for name, value in flags.items() if name != "is_part"})


def _codes_of(module, qualname):
    """Yield the code objects in a module that have a qualified name, those of outer functions first."""
    outer: Any = getattr(importlib.import_module(module), qualname.partition(".")[0], None)
    while hasattr(outer, "__wrapped__"):
        outer = outer.__wrapped__
    todo = [outer.__code__] if isinstance(outer, FunctionType) else []
    while todo:
        code = todo.pop()
        if code.co_qualname == qualname:
            yield code
        todo += [each for each in code.co_consts if isinstance(each, CodeType)]


def code_of(kernel: Kernel, known: Container[Kernel]) -> int:
    """Return the size [bytes] of the byte code of a kernel and the kernels that it calls, without those in `known`."""
    return sum(size for part, size in parts_of(kernel).items() if part not in known)


@cache
def parts_of(kernel: Kernel) -> dict[Kernel, int]:
    """Return {kernel: size of its byte code [bytes]} for a kernel and for all kernels that it calls, at any depth."""
    found: dict[Any, int] = {}
    todo = [kernel]
    while todo:
        each = todo.pop()
        if each not in found:
            function = each.py_func
            found[each] = len(function.__code__.co_code)
            values = [value for _, value in globals_of(function)]
            values += [cell.cell_contents for cell in function.__closure__ or ()]
            todo += [value for value in values if isinstance(value, Kernel)]
    return found
