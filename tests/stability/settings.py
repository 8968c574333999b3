"""Settings of the worlds that tests create: 4 substeps or the defaults of `World()`, and the phases of a sweep.

`variants` finds the tests whose worlds follow the present settings; conftest.py runs them under both settings. `sweeps`
finds the tests with a phase or a seed; conftest.py runs them SWEEP times, all but the first run marked nightly.
"""

import ast
import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from physics import Effects, World

FOUR, DEFAULTS = "4 substeps", "defaults"
SETTINGS = (FOUR, DEFAULTS)
MAKERS = {"metres", "pixels", "jointed"}  # functions that make a world of the present settings, …
BUILDERS = {"heap"}  # … and those of other modules that call them

SWEEP = 10
SWEEPERS = {"phase", "generator"}  # functions whose results depend on the number of the sweep

_present = [FOUR]
_sweep = [0]
_alone = set[str]()


@contextmanager
def using(name: str, number: int) -> Iterator[None]:
    """Use the named settings for new worlds, and the phase of this sweep number, until the end of the with block."""
    _present.append(name)
    _sweep.append(number)
    try:
        yield
    finally:
        _present.pop()
        _sweep.pop()


def by_default() -> bool:
    """Return whether new worlds get the default settings at present."""
    return _present[-1] == DEFAULTS


def alone(function: Callable[..., object]) -> Callable[..., object]:
    """Mark a test to run with 4 substeps only, because its worlds are created in other processes. Decorator."""
    _alone.add(function.__name__)
    return function


def phase(span: float) -> float:
    """Return the present phase of the sweep, from 0 up to but not including `span`; 0 outside a sweep."""
    return span * _sweep[-1] / SWEEP


def generator(seed: int) -> np.random.Generator:
    """Return a random generator for a seed; each number of a sweep gives another sequence."""
    return np.random.default_rng([seed, _sweep[-1]] if _sweep[-1] else seed)


def make(effects: Effects | None, usual: Effects, options: dict[str, Any]) -> World:
    """Return a world with the present settings; `effects` and `options` of the caller have priority.

    usual: effects if `effects` is None and the settings are those with 4 substeps. Under the default settings World()
    chooses the effects.
    """
    if _present[-1] == FOUR:
        return World(usual if effects is None else effects, **{"substeps": 4, **options})
    return World(effects, **options)


def variants(function: Callable[..., object], module: ModuleType, arguments: set[str]) -> bool:
    """Return whether the worlds of a test follow the present settings.

    module: module of the test. arguments: names of its parameters and fixtures.
    """
    if arguments & {"substeps", "settings"} or function.__name__ in _alone:
        return False
    for call, given in _calls(function.__name__, module):
        if call in MAKERS and "substeps" not in given or call in BUILDERS:
            return True
    return False


def sweeps(function: Callable[..., object], module: ModuleType) -> bool:
    """Return whether a test uses a phase or a seed of the sweep."""
    return any(call in SWEEPERS for call, _ in _calls(function.__name__, module))


def _calls(start, module):
    """Yield (name of the called function, set of its keywords) of each call in a test function.

    The functions of the module that the test refers to are searched too.
    """
    functions, todo, seen = _functions(module), [start], set[str]()
    while todo:
        name = todo.pop()
        if name in seen or name not in functions:
            continue
        seen.add(name)
        for node in ast.walk(functions[name]):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                yield node.func.id, {each.arg for each in node.keywords}
            if isinstance(node, ast.Name):
                todo.append(node.id)


@cache
def _functions(module):
    tree = ast.parse(inspect.getsource(module))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
