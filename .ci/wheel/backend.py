"""Build backend of the project: setuptools, run on a staged copy in which all packages are inside `hitbox` (see
layout.py).

It is in .ci because it is no part of the program: a source distribution contains it, a wheel does not. An editable
install is made by setuptools from the unchanged checkout; its module names are `physics`, `game`, `scenes`, `assets`
and `main`.
"""

import contextlib
import shutil
import tempfile
from pathlib import Path

from layout import stage, stage_metadata
from setuptools import build_meta

ROOT = Path(__file__).resolve().parents[2]
# What a source distribution holds: all that is kept of a checkout.
KEPT = (
    ".ci", ".gitignore", ".pre-commit-config.yaml", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE",
    "README.md", "assets", "docs", "game", "main.py", "physics", "pyproject.toml", "scenes", "tests",
)  # fmt: skip
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.pyc", ".jitcache", ".hypothesis")

build_editable = build_meta.build_editable
prepare_metadata_for_build_editable = build_meta.prepare_metadata_for_build_editable


def get_requires_for_build_wheel(config_settings=None):
    """Return the requirements besides [build-system] requires: none."""
    return []


get_requires_for_build_sdist = get_requires_for_build_editable = get_requires_for_build_wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Build the wheel of hitbox.* and return its file name. Raises LayoutError if a module name of the checkout
    remains.
    """
    wheels = Path(wheel_directory).resolve()
    with _working_folder() as staged:
        stage(ROOT, staged)
        return build_meta.build_wheel(str(wheels), config_settings)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Write the wheel's metadata and return the name of its folder."""
    folder = Path(metadata_directory).resolve()
    with _working_folder() as staged:
        stage_metadata(ROOT, staged)
        return build_meta.prepare_metadata_for_build_wheel(str(folder), config_settings)


def build_sdist(sdist_directory, config_settings=None):
    """Build the source distribution and return its file name; a wheel built from it is the same."""
    folder = Path(sdist_directory).resolve()
    with _working_folder() as copy:
        for name in KEPT:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, copy / name, ignore=LEFT_OUT)
            elif (ROOT / name).exists():
                shutil.copy2(ROOT / name, copy / name)
        (copy / "MANIFEST.in").write_text("graft .\n", encoding="utf-8")
        return build_meta.build_sdist(str(folder), config_settings)


@contextlib.contextmanager
def _working_folder():
    """Make a temporary folder the current one within a with block, and return its path."""
    with tempfile.TemporaryDirectory(prefix="hitbox-build-") as folder, contextlib.chdir(folder):
        yield Path(folder)
