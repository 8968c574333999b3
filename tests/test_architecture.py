"""What the tree promises, checked from the source: who imports whom, how large files are, what nobody writes."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
OURS = {"physics", "game", "scenes", "assets", "main", "tests"}
FILMS = {"assets/filming.py"}  # plays the games to take their pictures
MAY_IMPORT = {
    "physics": {"physics"},
    "assets": {"assets"},
    "game": {"physics", "game", "assets"},
    "scenes": {"physics", "game", "scenes", "assets"},
}
# Kernel folders, each with those it may look into: never one of a later stage of the step.
MAY_LOOK_INTO = {
    "math2d": set(),
    "jit": set(),
    "broadphase": {"motion"},
    "masks": {"narrowphase"},
    "narrowphase": {"masks"},
    "solver": {"narrowphase"},
    "motion": {"masks", "narrowphase"},
    "fitting": set(),
}
LIMIT = 520
BANNED_NAMES = {"utils", "helpers", "manager", "common", "handler", "core", "base", "misc"}


def sources(folder):
    return sorted((ROOT / folder).rglob("*.py"))


def imports_of(path):
    """Full names of the modules that a file imports."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("folder", sorted(MAY_IMPORT))
def test_imports_go_one_way(folder):
    for path in sources(folder):
        for name in imports_of(path):
            top = name.split(".")[0]
            if str(path.relative_to(ROOT)) in FILMS and top in ("game", "scenes"):
                continue
            assert top not in OURS - MAY_IMPORT[folder], (
                f"{path.relative_to(ROOT)} imports {name}; {folder}/ may import only {sorted(MAY_IMPORT[folder])}"
            )


def test_kernel_folders_do_not_look_at_later_stages():
    for folder, allowed in MAY_LOOK_INTO.items():
        for path in sources(f"physics/{folder}"):
            for name in imports_of(path):
                parts = name.split(".")
                if parts[0] == "physics" and len(parts) > 1 and (ROOT / "physics" / parts[1]).is_dir():
                    assert parts[1] in allowed | {folder}, f"{path.relative_to(ROOT)} imports {name}"


def test_physics_does_not_know_pygame():
    for path in sources("physics"):
        for name in imports_of(path):
            if name.split(".")[0] == "pygame":
                assert path.name == "shapes.py", (
                    f"{path.relative_to(ROOT)} imports pygame: only PixelMask.from_surface may"
                )


def test_only_jit_imports_numba():
    for folder in MAY_IMPORT:
        for path in sources(folder):
            if any(name.split(".")[0] == "numba" for name in imports_of(path)):
                assert path == ROOT / "physics/jit.py", (
                    f"{path.relative_to(ROOT)} imports numba: go through physics/jit.py"
                )


@pytest.mark.parametrize("folder", sorted(MAY_IMPORT) + ["tests"])
def test_files_are_short_and_named_by_subject(folder):
    for path in sources(folder):
        lines = len(path.read_text().splitlines())
        assert lines <= LIMIT, f"{path.relative_to(ROOT)} has {lines} lines, limit {LIMIT}: split it by subject"
        assert path.stem not in BANNED_NAMES, f"{path.relative_to(ROOT)}: name the subject"


def test_nothing_unfinished_and_no_error_swallowed():
    for folder in list(MAY_IMPORT) + ["."]:
        for path in sources(folder) if folder != "." else [ROOT / "main.py"]:
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
