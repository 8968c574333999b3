"""The settings of a row's worlds: 4 substeps, and those of a world as `World()` makes it; the phases of its sweep.

`variants` finds the tests whose worlds have no settings of their own, `sweeps` those with a phase or a seed.
conftest.py runs the former under both settings and the latter with SWEEP phases, all but the first at night.
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
    """Make worlds with these settings, and phases of this number of a sweep, until the end of the block."""
    _present.append(name)
    _sweep.append(number)
    try:
        yield
    finally:
        _present.pop()
        _sweep.pop()


def by_default() -> bool:
    """Return whether worlds have the default settings now."""
    return _present[-1] == DEFAULTS


def alone(function: Callable[..., object]) -> Callable[..., object]:
    """Run a test under 4 substeps alone: its worlds are made in other processes."""
    _alone.add(function.__name__)
    return function


def phase(span: float) -> float:
    """Return the present phase, 0 to span without it; 0 in the first of a sweep."""
    return span * _sweep[-1] / SWEEP


def generator(seed: int) -> np.random.Generator:
    """Return random numbers of a seed, others in each of a sweep."""
    return np.random.default_rng([seed, _sweep[-1]] if _sweep[-1] else seed)


def make(effects: Effects | None, usual: Effects, options: dict[str, Any]) -> World:
    """Return a world of the present settings; effects and substeps that a caller gives stay.

    usual: effects with 4 substeps, where none are given; by default they are those of `World()`.
    """
    if _present[-1] == FOUR:
        return World(usual if effects is None else effects, **{"substeps": 4, **options})
    return World(effects, **options)


def variants(function: Callable[..., object], module: ModuleType, arguments: set[str]) -> bool:
    """Return whether the worlds of a test follow the present settings."""
    if arguments & {"substeps", "settings"} or function.__name__ in _alone:
        return False
    for call, given in _calls(function.__name__, module):
        if call in MAKERS and "substeps" not in given or call in BUILDERS:
            return True
    return False


def sweeps(function: Callable[..., object], module: ModuleType) -> bool:
    """Return whether a test has a phase or a seed."""
    return any(call in SWEEPERS for call, _ in _calls(function.__name__, module))


def _calls(start, module):
    """Yield (name, keywords) of the calls in a function of a module and in those that it names."""
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
