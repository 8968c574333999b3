"""The list of scenes contains every scene of the folder, and every scene is complete."""

import ast
from pathlib import Path

import pytest

from game.registry import Registry
from scenes import SCENES

FOLDER = Path(__file__).resolve().parents[2] / "scenes"


def scene_files():
    """Return the set of "module:Class" of every scene class in scenes/ that has a `name`."""
    found = set()
    for path in sorted(FOLDER.rglob("*.py")):
        module = ".".join(path.relative_to(FOLDER.parent).with_suffix("").parts).removesuffix(".__init__")
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and any(isinstance(b, ast.Name) and b.id == "Scene" for b in node.bases):
                found.add(f"{module}:{node.name}")
    return found


def test_every_scene_is_listed():
    missing = scene_files() - set(SCENES.values())
    assert not missing, f"add to scenes/__init__.py: {', '.join(sorted(missing))}"
    assert len(set(SCENES.values())) == len(SCENES)


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_says_what_it_is(name):
    scene = Registry(SCENES).scene_class(name)
    assert scene.name == name
    assert scene.title and scene.about.endswith((".", "?", "!")) and scene.features
    for method in ("build", "update", "draw", "check", "bot", "state"):
        assert method in vars(scene), f"{name} has no {method}"
