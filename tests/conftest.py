"""Hooks for all tests: no display, no sound, and kernels that are compiled before the workers start.

The slow tests are listed in tests/slow_tests.txt and tests/slow_without_numba.txt: see tests/slow.py.
"""

import importlib.util
import os
import sys
from pathlib import Path

import pytest

from tests import slow

# Its figures are oracles: without it what needs them is not collected.
NEEDS_SHAPELY = ("import shapely", "from shapely", "from tests.outline")
if importlib.util.find_spec("shapely") is None:
    collect_ignore = [
        str(path)
        for path in Path(__file__).parent.rglob("test_*.py")
        if any(line.startswith(NEEDS_SHAPELY) for line in path.read_text(encoding="utf-8").splitlines())
    ]

ROOT = Path(__file__).resolve().parent.parent
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
sys.path.insert(0, str(ROOT))


def pytest_sessionstart(session):
    """Compile the kernels before the workers start, because each worker would otherwise compile them."""
    workers = session.config.getoption("numprocesses", None)
    if workers and "NUMBA_DISABLE_JIT" not in os.environ and not hasattr(session.config, "workerinput"):
        from tests.warm_kernels import warm_up

        warm_up(workers)


@pytest.fixture
def nothing_is_measured(monkeypatch):
    """Prevent scenes that are played in tests from starting measuring processes."""
    monkeypatch.setattr("game.screens.parts.measuring.Measuring.beside", lambda *asked: None)


@pytest.hookimpl(tryfirst=True)  # before -m chooses
def pytest_collection_modifyitems(config, items):
    """Mark the slow tests and sort the files with the slowest tests first, so that no worker ends with a slow one."""
    names, slowest = slow.slow_here(), {}
    measured = config.pluginmanager.hasplugin("tests.slow")
    config.stash[slow.COLLECTED] = [item.nodeid for item in items]
    for item in items:
        seconds = names.get(item.nodeid, 0.0)
        if seconds:
            item.add_marker("slow" if measured else slow.mark_of(item.nodeid, seconds))
        slowest[item.path] = max(slowest.get(item.path, 0.0), seconds)
    items.sort(key=lambda item: -slowest[item.path])
