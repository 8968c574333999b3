"""Rules of the source tree: imports, file sizes, forbidden constructs."""

import ast
import re

import pytest

from physics.shapes.kinds import SHAPES
from tests.architecture import (
    PHYSICS,
    ROOT,
    TOPS,
    circles,
    graph,
    imports_of,
    name_of,
    part_of,
    parts_graph,
    report,
    sources,
)

# Import order: each package imports those to its left and nothing else, without exceptions.
ORDER = ("assets", "physics", "game", "scenes", "main")
APART = {"physics": set(), "assets": set(), "game": {"physics"}, "scenes": {"physics", "game", "assets"}}
# Within game/, from the inside out: input knows no screens, screens know no command line.
GAME = (
    "errors", "startup", "places", "input", "files", "drawing", "audio", "invariants", "measurement_requests", "scene",
    "overlays", "registry", "measure", "run", "report", "parts", "screens", "app", "command_line",
)  # fmt: skip
LIMIT = 800
BANNED_NAMES = {"utils", "helpers", "manager", "common", "handler", "core", "base", "misc"}


def folder_in_game(name):
    """Return the part of GAME to which a module belongs; None for the module game itself."""
    parts = name.split(".")
    if len(parts) == 1:
        return None
    return "parts" if parts[1:3] == ["screens", "parts"] else parts[1]


@pytest.mark.parametrize("top", sorted(APART))
def test_imports_go_one_way(top):
    for path in sources(top):
        for name in imports_of(path):
            other = name.split(".")[0]
            assert other not in {*ORDER, "tests"} - {top} - APART[top], (
                f"{path.relative_to(ROOT)} imports {name}; {top}/ may import only {sorted(APART[top])}"
            )


def test_physics_imports_what_stands_to_its_left():
    order = {part: place for place, part in enumerate((*PHYSICS, "root"))}
    for name, others in graph("physics").items():
        for other in others:
            assert order[part_of(other)] <= order[part_of(name)], f"{name} imports {other}, which stands to its right"
    assert set(order) == set(parts_graph()) | {part for parts in parts_graph().values() for part in parts}


def test_game_imports_what_stands_to_its_left():
    order = {part: place for place, part in enumerate(GAME)}
    for name, others in graph("game").items():
        for other in others:
            mine, theirs = folder_in_game(name), folder_in_game(other)
            if mine is not None and theirs is not None:
                assert order[theirs] <= order[mine], f"{name} imports {other}, which stands to its right"


@pytest.mark.parametrize("top", TOPS)
def test_no_circle(top):
    """No modules of a top folder import each other in a circle, and no import is hidden under TYPE_CHECKING.

    Imports within functions count.
    """
    assert circles(graph(top)) == []
    for path in sources(top):
        assert "TYPE_CHECKING" not in path.read_text(), f"{path.relative_to(ROOT)} hides imports"


def test_a_circle_is_found():
    edges = {"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": set(), "e": {"d"}}
    assert circles(edges) == [["a", "b", "c"]]


def test_the_tree_is_printed_with_its_imports():
    text = report()
    assert all(f"{top}: no circle" in text for top in TOPS)
    assert re.search(r"^physics/solver .*imports .*physics/tables", text, re.M)


def test_physics_does_not_know_pygame():
    for path in sources("physics"):
        for name in imports_of(path):
            if name.split(".")[0] == "pygame":
                assert name_of(path) == "physics.shapes.mask", (
                    f"{path.relative_to(ROOT)} imports pygame: only PixelMask may"
                )


def test_only_jit_imports_numba():
    for top in TOPS:
        for path in sources(top):
            if any(name.split(".")[0] == "numba" for name in imports_of(path)):
                assert path.parent == ROOT / "physics/jit", (
                    f"{path.relative_to(ROOT)} imports numba: go through physics/jit"
                )


@pytest.mark.parametrize("folder", [*TOPS, "tests"])
def test_files_are_short_and_named_by_subject(folder):
    for path in sources(folder):
        lines = len(path.read_text().splitlines())
        # A table of reference values or of wrong inputs reads best in one piece.
        assert lines <= LIMIT + (100 if folder == "tests" else 0), (
            f"{path.relative_to(ROOT)} has {lines} lines: split it by subject"
        )
        assert path.stem not in BANNED_NAMES, f"{path.relative_to(ROOT)}: name the subject"


def test_nothing_unfinished_and_no_error_swallowed():
    for path in [ROOT / "main.py", *(each for top in TOPS for each in sources(top))]:
        text = path.read_text()
        for word in ("TO" + "DO", "FIX" + "ME", "NotImplemented" + "Error"):
            assert word not in text, f"{path.relative_to(ROOT)} has a {word}"
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ExceptHandler):
                silent = all(isinstance(each, ast.Pass) for each in node.body)
                assert node.type is not None and not silent, (
                    f"{path.relative_to(ROOT)}:{node.lineno} swallows errors: name them and say what happens"
                )


def test_only_the_command_line_prints():
    for path in sources("physics"):
        assert not re.search(r"^\s*print\(", path.read_text(), re.M), f"{path.relative_to(ROOT)} prints"


def names_in(node):
    """Return the names in a node that denotes a type, or a tuple or union of types."""
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


@pytest.mark.parametrize("top", ["physics", "game", "scenes"])
def test_no_list_of_types_stands_in_for_what_a_shape_says(top):
    """No isinstance call lists several shape types, because a new shape would be missing.

    Code uses methods of the shape, or SHAPES of physics/shapes/kinds.py.
    """
    types = {each.__name__ for each in SHAPES}
    for path in sources(top):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and names_in(node.func) & {"isinstance", "issubclass"}:
                found = names_in(node.args[1]) & types
                assert len(found) < 2, f"{path.relative_to(ROOT)}:{node.lineno} asks for {sorted(found)}"
