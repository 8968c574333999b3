"""Kernels as objects: a function, its plain twin, and its compiled forms; numba is not imported for them."""

import math
from collections.abc import Callable
from operator import attrgetter
from types import FunctionType
from typing import Any

from physics.jit.signatures import Key
from physics.jit.twins import rebound
from physics.jit.views import view_of
from physics.jit.words import Builtin, plain_math

Keys = tuple[Key, ...]  # types of the arguments of one call
Form = Callable[..., Any]

registry: "list[Kernel]" = []  # every kernel, in the order of definition; empty without numba


class Kernel:
    """A function over tables that can be compiled. Calling it calls `run`, whichever form that is now."""

    is_part = False
    __call__: Any = property(attrgetter("run"))
    run: Form

    def __init__(
        self, function: FunctionType, is_inlined: bool = False, noalias: bool = False, is_generic: bool = False
    ) -> None:
        self.py_func = function
        self.is_inlined, self.noalias, self.is_generic = is_inlined, noalias, is_generic
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__
        self.__doc__, self.__module__ = function.__doc__, function.__module__
        self.__wrapped__ = function
        self.content: str | None = None  # physics.jit.content.content_of
        self.dispatcher: Any = None  # physics.jit.compiling.dispatcher_of
        self.forms: dict[Keys, Form] = {}  # compiled, by the types of the arguments
        self.seconds = 0.0  # [s] that its plain twin has run since the last take-over
        self._plain: Form | None = None
        self.reset()
        registry.append(self)

    @property
    def name(self) -> str:
        """Module and qualified name."""
        return f"{self.__module__}.{self.__qualname__}"

    @property
    def flags_text(self) -> str:
        """The flags that its machine code depends on."""
        return f"part={self.is_part} inlined={self.is_inlined} noalias={self.noalias}"

    @property
    def signatures(self) -> list[Keys]:
        """Types that it has compiled forms for."""
        return list(self.forms)

    @property
    def plain(self) -> Form:
        """The plain twin: the same function, with the plain twins of all that it calls."""
        if self._plain is None:
            rebound(self.py_func, plain_form_of, self._note_plain)
        assert self._plain is not None
        return self._plain

    def _note_plain(self, twin):
        self._plain = twin

    def __repr__(self) -> str:
        return f"<kernel {self.name}>"

    def reset(self) -> None:
        """Forget which form runs."""
        self.run = self.call_plain

    def call_plain(self, *arguments: Any) -> Any:
        """Run the plain twin over views of the arguments."""
        return self.plain(*[view_of(each) for each in arguments])

    def install(self, keys: Keys, form: Form) -> None:
        """Keep a compiled form."""
        self.forms[keys] = form


class Part(Kernel):
    """A kernel that kernels call: it has no entry from Python, where its plain twin runs, with the same result."""

    is_part = True


def plain_form_of(value: Any) -> Any:
    """Return what stands for a global or closed-over value in a plain twin."""
    if value is math:
        return plain_math
    return value.plain if isinstance(value, (Kernel, Builtin)) else value
