"""Examples of docs/reference.md: a doctest for each callable, run after the lines of BEFORE.

The examples of the most used names are in their docstrings, where help() shows them; examples.txt has the others.
"""

import doctest
import re
from functools import cache
from pathlib import Path
from typing import Any

from tests.installed_names import as_in_a_checkout
from tests.reference.surface import items

PLACE = Path(__file__).with_name("examples.txt")
BEFORE = """\
>>> import math, pathlib, tempfile
>>> import numpy as np, pygame
>>> from hitbox.physics import *
>>> from hitbox.physics import debug
>>> folder = pathlib.Path(tempfile.mkdtemp())
>>> world = World(Effects.rigid_bodies().with_(joints=True, carving=True))
>>> floor = world.add_body(Polygon.box(400, 20), position=(200, 300), kind="static")
>>> ball = world.add_body(Circle(10), position=(200, 280))
>>> box = world.add_body(Polygon.box(20, 20), position=(240, 280))
>>> hinge = world.add_joint(Revolute(None, box, at=(240, 280)))
"""
OPTIONS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


@cache
def examples() -> dict[str, str]:
    """Return {name: text of its example}. Raises ValueError for a name with two examples."""
    found = {name: each.example for name, each in items().items() if each.example and not each.repeats}
    for name, text in re.findall(r"^== (\S+)\n(.*?)(?=^== |\Z)", PLACE.read_text(encoding="utf-8"), re.S | re.M):
        if name in found:
            raise ValueError(f"{name} has two examples")
        found[name] = text
    return found


def prepared() -> dict[str, Any]:
    """Return the names that the lines of BEFORE define."""
    lines = [line.removeprefix(">>> ") for line in BEFORE.splitlines()]
    names: dict[str, Any] = {"__name__": "reference"}
    exec(as_in_a_checkout("\n".join(lines)), names)
    return names


def run(name: str, text: str, names: dict[str, Any]) -> str:
    """Run an example after the lines of BEFORE, in the namespace `names`. Return doctest's report, "" if it passes."""
    test = doctest.DocTestParser().get_doctest(as_in_a_checkout(text), names, name, str(PLACE), 0)
    reported: list[str] = []
    doctest.DocTestRunner(optionflags=OPTIONS, verbose=False).run(test, out=reported.append, clear_globs=False)
    return "".join(reported)
