"""Compiled kernels are kept by what they depend on: another copy of the same sources finds them,
other sources do not."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import physics

SOURCES = Path(physics.__file__).parent
ASK = """
import numpy as np
from physics import Circle, Effects, World
from physics.jit import registry
world = World(Effects())
world.add_body(Circle(4))
world.step()
print(sum(sum(each.stats.cache_hits.values()) for each in registry),
      sum(sum(each.stats.cache_misses.values()) for each in registry))
"""


def hits_and_misses(folder, cache):
    run = subprocess.run(
        [sys.executable, "-c", ASK],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(folder), "HITBOX_CACHE_DIR": str(cache)},
    )
    return [int(word) for word in run.stdout.split()[-2:]]


@pytest.mark.deep
@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
def test_a_copy_elsewhere_finds_what_was_compiled(tmp_path):
    first, second, cache = tmp_path / "first", tmp_path / "second", tmp_path / "cache"
    for folder in (first, second):
        shutil.copytree(
            SOURCES, folder / "physics", ignore=shutil.ignore_patterns("__pycache__"), copy_function=shutil.copy
        )
    for path in second.rglob("*.py"):
        os.utime(path, (1, 1))
    hits, misses = hits_and_misses(first, cache)
    assert hits == 0 and misses > 5
    found, anew = hits_and_misses(second, cache)  # what a kernel calls comes with it: fewer are looked for
    assert found > 5 and anew == 0
    changed = second / "physics" / "jit" / "__init__.py"
    changed.write_text(changed.read_text() + "\n# another version\n")
    hits, again = hits_and_misses(second, cache)
    assert hits == 0 and again == misses
