"""Kernels as numba's dispatchers, and in processes that only list what is to be compiled, as what notes its types.

Imported only where there is a compiler.
"""

import os
from collections.abc import Callable
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from numba import types
from numba.core.dispatcher import Dispatcher

from physics.jit.compiler import LISTING, numba
from physics.jit.files import KernelCache, PartCache
from physics.jit.folders import folder_for
from physics.jit.parts import PartCompiler
from physics.jit.views import view_of

# No kernel makes an array, so none counts references; and only kernels that stages call need a way in from Python.
# Measured: compiling what the platformer needs takes 145 s of processor time, with both 190, on one busy machine.
LEANER = {"_nrt": False, "no_cfunc_wrapper": True}

# Where types are looked at in each call: a kernel that is called with others than in its first call is refused.
CHECKING = os.environ.get("HITBOX_CHECK_CALLS", "") == "1"

typed = {}  # what decides the type of an argument -> that type: numba takes 0.6 ms for a table of fifty columns
listed = {}  # (kernel, types of its arguments) -> None, in the order of the calls
nesting = [0]  # calls under way


class Listed(Dispatcher):
    """A kernel that is run as it is, and notes with which types it is called; it compiles only when told to."""

    plain: Callable | None = None  # what stands for it where it is not its own source

    def __call__(self, *arguments):
        nesting[0] += 1
        try:
            if nesting[0] == 1:  # called by a stage, not by another kernel
                listed[self, tuple(type_of(self, each) for each in arguments)] = None
                arguments = [view_of(each) for each in arguments]
            return (self.plain or self.py_func)(*arguments)
        finally:
            nesting[0] -= 1


def type_of(dispatcher: Dispatcher, value: Any) -> Any:
    """numba's type of an argument; of arrays, alone or in a tuple, looked up where one like it was met before."""
    key = _key_of(value)
    if key is None:
        return dispatcher.typeof_pyval(value)
    if key not in typed:
        typed[key] = dispatcher.typeof_pyval(value)
    return typed[key]


def _key_of(value):
    """What decides its type; None where the value does."""
    if type(value) is np.ndarray:
        flags = value.flags
        return value.dtype, value.ndim, flags.c_contiguous, flags.f_contiguous, flags.writeable, flags.aligned
    if isinstance(value, tuple) and value:
        keys = tuple(_key_of(each) for each in value)
        return None if None in keys else (type(value), *keys)
    return None


class Direct(Dispatcher):
    """A kernel that is always called with the same types: after the first call they are not looked at again.

    Measured: numba takes 1.07 us to look at six tables, and 0.1 for the call; a step of 55 boxes makes 15 of them. What
    differs in size, and a fraction for a whole number, is still refused; what differs in kind, or does not lie side by
    side, under HITBOX_CHECK_CALLS=1. A kernel that is called with several types is a `generic` one.
    """

    types: tuple = ()
    whole: tuple[int, ...] = ()  # which arguments are whole numbers
    # What a call is: the compiled kernel itself, if there is nothing to look at. To hand it on in Python takes 0.15 us.
    run: Callable
    compiled: Callable
    __call__: Any = property(attrgetter("run"))

    def _first_call(self, *arguments):
        """Compile, or find what was compiled, run it, and settle on these types."""
        result = Dispatcher.__call__(self, *arguments)
        self.types = tuple(type_of(self, each) for each in arguments)
        if self.types in self.overloads:
            self.whole = tuple(
                k for k, each in enumerate(self.types) if isinstance(each, (types.Integer, types.Boolean))
            )
            self.compiled = self.overloads[self.types].entry_point
            self.run = self._checked_call if CHECKING or self.whole else self.compiled
        return result

    def _checked_call(self, *arguments):
        for place in self.whole:
            if isinstance(arguments[place], float):
                self._check(arguments)
        if CHECKING:
            self._check(arguments)
        return self.compiled(*arguments)

    def _check(self, arguments):
        found = tuple(type_of(self, each) for each in arguments)
        if found != self.types:
            name, places = self.py_func.__qualname__, zip(self.types, found, strict=True)
            wrong = [f"{k}: {was} before, {now} now" for k, (was, now) in enumerate(places) if was != now]
            raise TypeError(f"{name} must be called with the same types each time (got {'; '.join(wrong)})")


class Part(Dispatcher):
    """A kernel that kernels call: it has no way in from Python, where it is run as it is, with the same result."""

    def __call__(self, *arguments):
        return self.py_func(*[view_of(each) for each in arguments])


def dispatcher_of(function: Callable, is_part: bool = False, is_inlined: bool = False, is_generic: bool = False) -> Any:
    """A dispatcher that compiles the function on first call and keeps the result; is_part: only kernels call it;
    is_inlined: it is put in wherever it is called; is_generic: it is called with several types."""
    more = LEANER | ({"pipeline_class": PartCompiler} if is_part else {})
    made = numba.njit(
        function, error_model="numpy", fastmath=False, no_cpython_wrapper=is_part, forceinline=is_inlined, **more
    )
    _take_literals_as_values(made)
    if folder_for(Path(function.__code__.co_filename)):
        made._cache = (PartCache if is_part else KernelCache)(function)
    if LISTING or not is_generic:
        made.__class__ = Listed if LISTING else Part if is_part else Direct
    if isinstance(made, Direct):
        made.run = made._first_call
    return made


def _take_literals_as_values(dispatcher):
    """Compile one version for all calls of the same types: numba makes another for every literal among the arguments.

    Measured: compiling what the platformer needs takes 136 s of processor time with them, 80 s without.
    """
    general = dispatcher.get_call_template

    def get_call_template(args, kws):
        return general(
            tuple(types.unliteral(each) for each in args), {name: types.unliteral(each) for name, each in kws.items()}
        )

    dispatcher.get_call_template = get_call_template
