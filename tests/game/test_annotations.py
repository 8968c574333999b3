"""Every public callable of game/ annotates its parameters and its result, and no code tests the class of a screen."""

import ast
from pathlib import Path

import pytest

GAME = Path(__file__).resolve().parents[2] / "game"
FILES = sorted(GAME.rglob("*.py"))


def public_callables(node, owner=""):
    """Yield (name, FunctionDef) of the public functions, methods and constructors."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef) and not child.name.startswith("_"):
            yield from public_callables(child, f"{child.name}.")
        elif isinstance(child, ast.FunctionDef) and (not child.name.startswith("_") or child.name == "__init__"):
            yield owner + child.name, child


def unannotated(function):
    """Return the names of the parameters without a type, and "return" if the result has none."""
    given = function.args
    parameters = [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg]
    names = [each.arg for each in parameters if each is not None and each.annotation is None]
    return [name for name in names if name not in ("self", "cls")] + ["return"] * (function.returns is None)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(GAME)))
def test_public_callables_are_annotated(path):
    for name, function in public_callables(ast.parse(path.read_text(encoding="utf-8"))):
        assert not unannotated(function), f"{path.name}: {name} lacks a type for {', '.join(unannotated(function))}"


def test_what_lacks_a_type_is_seen():
    source = (
        "class A:\n    def __init__(self, x: int, *rest, y=1) -> None: ...\n    def _own(self, z): ...\ndef f(): ...\n"
    )
    found = {name: unannotated(function) for name, function in public_callables(ast.parse(source))}
    assert found == {"A.__init__": ["y", "rest"], "f": ["return"]}


def class_questions(source, classes):
    """Yield the line numbers of isinstance calls with one of the class names."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
            asked = {each.id for each in ast.walk(node.args[1]) if isinstance(each, ast.Name)}
            if asked & classes:
                yield node.lineno


def test_no_screen_is_asked_for_its_class():
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in GAME.glob("screens/*.py")]
    classes = {node.name for tree in trees for node in tree.body if isinstance(node, ast.ClassDef)}
    assert {"Play", "PauseMenu", "CanvasScreen"} <= classes
    for path in FILES:
        lines = list(class_questions(path.read_text(encoding="utf-8"), classes))
        assert not lines, f"{path.relative_to(GAME)}:{lines[0]} asks which screen it is: let the screen answer"
    assert list(class_questions("isinstance(top, (Play, int))", classes)) == [1]
