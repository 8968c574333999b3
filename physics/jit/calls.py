"""Kernels that Python calls: which form runs at a call.

At its first call a kernel is loaded from disk or compiled. In a program that opted in to tiers it runs as its plain
twin, is queued, and its compiled form takes over between two steps; while kernels are collected it runs plain too, and
what is not on disk is noted (tiers.py).
"""

from time import perf_counter

from physics.jit import tiers
from physics.jit.kernels import Form, Kernel, Keys
from physics.jit.signatures import CHECKING, is_whole, key_of, text_of
from physics.jit.views import view_of


class StageKernel(Kernel):
    """A kernel that a stage calls. Once its compiled form is there, calling it calls that, with nothing between.

    Measured: numba takes 1.07 us to look at the types of six tables, and 0.1 for the call; a step of 55 boxes makes 15.
    A kernel that is not `generic` is called with the same types each time: a fraction for a whole number is refused,
    another element size too (by the compiled form), other types under HITBOX_CHECK_CALLS=1.
    """

    def reset(self) -> None:
        """Forget which form runs: the next call looks for one."""
        self.run = self._generic_call if self.is_generic else self._first_call

    def install(self, keys: Keys, form: Form) -> None:
        """Let a compiled form run from the next call with these types on."""
        self.forms[keys] = form
        if self.is_generic:
            return
        whole = tuple(place for place, key in enumerate(keys) if is_whole(key))
        self.run = _checked(self, keys, whole, form) if CHECKING or whole else form

    def _first_call(self, *arguments):
        keys = tuple(map(key_of, arguments))
        form = tiers.form_of(self, keys)
        if form is not None:
            self.install(keys, form)
            return form(*arguments)
        if (self, keys) in tiers.wanted:  # its types are known, and somebody is at it
            self.run = self._timed_plain_call
        return self._timed_plain_call(*arguments)

    def _generic_call(self, *arguments):
        keys = tuple(map(key_of, arguments))
        form = self.forms.get(keys)
        if form is None:
            form = tiers.form_of(self, keys)
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
    """Return a call of a compiled form that refuses a fraction for a whole number; other types too, if asked for."""

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
