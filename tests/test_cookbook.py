"""The cookbook: every recipe runs with its assertions, and docs/cookbook.md shows exactly its code."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.installed_names import as_in_a_checkout, layout_module

ROOT = Path(__file__).resolve().parent.parent
RECIPES = sorted((ROOT / "docs/cookbook").glob("*.py"))
PAGE = (ROOT / "docs/cookbook.md").read_text()
QUIET = {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy", "PYGAME_HIDE_SUPPORT_PROMPT": "1"}


@pytest.mark.parametrize("path", RECIPES, ids=lambda path: path.stem)
def test_a_recipe_runs_and_says_what_it_found(path, tmp_path):
    recipe = tmp_path / path.name
    recipe.write_text(as_in_a_checkout(path.read_text()))
    environment = {**os.environ, **QUIET, "PYTHONPATH": str(ROOT)}
    run = subprocess.run([sys.executable, recipe], env=environment, capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip() and "assert " in path.read_text()


@pytest.mark.parametrize("path", [*RECIPES, ROOT / "docs/physics_alone.py"], ids=lambda path: path.stem)
def test_a_recipe_is_written_for_the_installed_package(path):
    """A recipe imports from the installed package; converting it to a checkout and back gives the same source."""
    source = path.read_text()
    assert "from hitbox.physics import" in source
    assert layout_module().converted(as_in_a_checkout(source)) == (source, [])


def test_the_page_shows_exactly_the_code_of_each():
    assert len(RECIPES) == 25
    shown = re.findall(r"```python\n(.*?)```\n\n\[cookbook/(\w+)\.py\]\(cookbook/(\w+)\.py\)", PAGE, re.S)
    assert sorted(name for _, name, _ in shown) == [path.stem for path in RECIPES]
    for code, name, target in shown:
        assert name == target and code == (ROOT / f"docs/cookbook/{name}.py").read_text(), name


def test_each_recipe_is_listed_at_the_top():
    titles = re.findall(r"^## (.+)$", PAGE, re.M)
    anchors = [re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles]
    assert re.findall(r"^- \[(.+)\]\(#(.+)\)$", PAGE, re.M) == list(zip(titles, anchors, strict=True))
