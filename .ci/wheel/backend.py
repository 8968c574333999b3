"""How the project is built: setuptools, on a staged copy in which all packages lie in `hitbox` (see layout.py).

It lies here because it is no part of the program: a wheel does not have it, a source distribution does. An editable
install is setuptools' own, of the checkout as it is: its names are `physics`, `game`, `scenes`, `assets` and `main`.
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
    """Return what is needed besides [build-system] requires: nothing."""
    return []


get_requires_for_build_sdist = get_requires_for_build_editable = get_requires_for_build_wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Build the wheel of hitbox.*; return its file name. Raises LayoutError where a name of the checkout is left."""
    wheels = Path(wheel_directory).resolve()
    with _working_folder() as staged:
        stage(ROOT, staged)
        return build_meta.build_wheel(str(wheels), config_settings)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Write the wheel's metadata; return the name of their folder."""
    folder = Path(metadata_directory).resolve()
    with _working_folder() as staged:
        stage_metadata(ROOT, staged)
        return build_meta.prepare_metadata_for_build_wheel(str(folder), config_settings)


def build_sdist(sdist_directory, config_settings=None):
    """Build the source distribution, from which the same wheel is built; return its file name."""
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
    """A new folder that is the current one as long as the context lasts."""
    with tempfile.TemporaryDirectory(prefix="hitbox-build-") as folder, contextlib.chdir(folder):
        yield Path(folder)
