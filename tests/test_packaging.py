"""What is installed: every kind of file that the game reads, one version, a licence; hooks run tools of the extras."""

import re
import tomllib
from pathlib import Path

import pytest

from game import VERSION

ROOT = Path(__file__).resolve().parent.parent
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = ("assets", "game", "physics", "scenes")


def files_of(package):
    """Paths relative to the package of what belongs into it."""
    return [
        path.relative_to(ROOT / package)
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    ]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_file_is_installed(package):
    """A kind of file that the package data do not name is missing from a wheel, and nothing else says so."""
    patterns = SETTINGS["tool"]["setuptools"]["package-data"].get(package, [])
    for path in files_of(package):
        if path.suffix == ".py":
            assert (ROOT / package / path).with_name("__init__.py").exists(), f"{path.parent} is no package"
        else:
            assert any(path.match(pattern) for pattern in patterns), (
                f"{package}/{path} would not be installed: add *{path.suffix} to package-data in pyproject.toml"
            )


def test_no_pattern_is_left_over():
    for package, patterns in SETTINGS["tool"]["setuptools"]["package-data"].items():
        for pattern in patterns:
            assert any(path.match(pattern) for path in files_of(package)), f"{package} has no {pattern}"


def test_the_version_stands_in_one_place():
    assert "version" not in SETTINGS["project"] and SETTINGS["project"]["dynamic"] == ["version"]
    assert SETTINGS["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "game.VERSION"}
    newest = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    assert newest and newest[1] in (VERSION, "Unreleased"), "say in CHANGELOG.md what this version brings"
    for path in [ROOT / "main.py", *(ROOT / "game").rglob("*.py")]:
        if path != ROOT / "game" / "__init__.py":
            assert f'"{VERSION}"' not in path.read_text(encoding="utf-8"), f"{path.name} writes the version again"


def test_the_licence_is_there():
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert SETTINGS["project"]["license"] == "MIT" and text.startswith("MIT License")
    assert "Copyright (c) 2026 the Hitbox authors" in text


def test_each_hook_runs_a_tool_of_an_extra():
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    extras = SETTINGS["project"]["optional-dependencies"]
    offered = {re.split(r"[<>=]", each)[0] for extra in ("dev", "test") for each in extras[extra]}
    tools = re.findall(r"entry: \.venv/bin/python -m (\w+)", hooks)
    assert len(tools) == hooks.count("entry:") == 4 and set(tools) <= offered
