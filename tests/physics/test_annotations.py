"""Every public callable of physics/ annotates its parameters and its result; kernels are excepted."""

import ast
from pathlib import Path

import pytest

from physics.jit import DECORATORS

PHYSICS = Path(__file__).resolve().parents[2] / "physics"
FILES = sorted(PHYSICS.rglob("*.py"))


def is_kernel(function):
    """Return whether a function has a decorator that makes it a kernel, compiled by numba."""
    return any(isinstance(each, ast.Name) and each.id in DECORATORS for each in function.decorator_list)


def public_callables(node, owner=""):
    """Yield (name, FunctionDef) of the public functions, methods, setters and constructors that are not kernels."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef) and not child.name.startswith("_"):
            yield from public_callables(child, f"{child.name}.")
        elif isinstance(child, (ast.If, ast.Try)):
            yield from public_callables(child, owner)
        elif isinstance(child, ast.FunctionDef) and (not child.name.startswith("_") or child.name == "__init__"):
            if not is_kernel(child):
                yield owner + child.name, child


def unannotated(function):
    """Return the names of the parameters without a type, and "return" if the result has none."""
    given = function.args
    parameters = [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg]
    names = [each.arg for each in parameters if each is not None and each.annotation is None]
    return [name for name in names if name not in ("self", "cls")] + ["return"] * (function.returns is None)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PHYSICS)))
def test_public_callables_are_annotated(path):
    for name, function in public_callables(ast.parse(path.read_text(encoding="utf-8"))):
        assert not unannotated(function), f"{path.name}: {name} lacks a type for {', '.join(unannotated(function))}"


def test_what_lacks_a_type_is_seen():
    source = """
class A:
    def __init__(self, x: int, *rest, y=1) -> None: ...
    @property
    def z(self) -> int: ...
    @z.setter
    def z(self, value): ...
    def _own(self, w): ...
@kernel
def f(rows): ...
if True:
    def g(): ...
"""
    found = [(name, unannotated(function)) for name, function in public_callables(ast.parse(source))]
    assert found == [("A.__init__", ["y", "rest"]), ("A.z", []), ("A.z", ["value", "return"]), ("g", ["return"])]
