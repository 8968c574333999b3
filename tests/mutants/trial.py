"""A copy of the sources in which one kernel is changed, and the tests that run there, uncompiled."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tests.mutants.operators import sources_in

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("physics", "tests")  # the named tests need no more
SECONDS = 300  # for tests that take less than 30 on an idle machine


def copy_sources(folder):
    """Copy the files that the physics tests need into a folder, and return the folder."""
    for name in COPIED:
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def ids_of(names):
    """Return the pytest ids of test functions, found in all test files. Raises LookupError for an unknown name."""
    found = []
    for name in names:
        definition = re.compile(rf"^def {name}\(", re.M)
        holding = [path for path, source in sources_in(ROOT / "tests") if definition.search(source)]
        holding = [path for path in holding if path.name.startswith("test_")]
        if not holding:
            raise LookupError(f"there is no test called {name}")
        found += [f"{path.relative_to(ROOT)}::{name}" for path in holding]
    return found


def run_tests(folder, names):
    """Return (exit code of pytest, its output) for the named tests in a copy; slow tests are included.

    Raises subprocess.TimeoutExpired.
    """
    options = ["-x", "-q", "-m", "not nightly", "-p", "no:cacheprovider", "-p", "no:xdist"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *ids_of(names)],
        cwd=folder,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        timeout=SECONDS,
    )
    return done.returncode, done.stdout + done.stderr
