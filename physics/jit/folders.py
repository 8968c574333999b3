"""Where compiled kernels are kept: a folder per kernel module, named by all that its code depends on."""

import ast
import hashlib
import os
import shutil
import sys
import tempfile
import warnings
from functools import cache
from pathlib import Path

import numpy as np

from physics.jit.compiler import JIT, numba

HERE = Path(__file__).resolve().parents[1]


def cache_home() -> Path:
    """The user's cache folder by the platform's rule, without creating it."""
    override = os.environ.get("HITBOX_CACHE_DIR")
    if override:
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "hitbox" / "kernels"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "hitbox" / "kernels"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "hitbox" / "kernels"


@cache
def _imports_of(path: Path) -> tuple[Path, ...]:
    """Files of this package that the file at `path` imports, from its import statements."""
    found = []
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and str(node.module).split(".")[0] == HERE.name:
            module = HERE.parent.joinpath(*str(node.module).split("."))
            names = [module] + [module / alias.name for alias in node.names]
            files = [name.with_suffix(".py") for name in names] + [name / "__init__.py" for name in names]
            found += [file for file in files if file.parent != HERE or file.name != "__init__.py"]
    return tuple(sorted({each for each in found if each.is_file()}))


def source_stamp(path: Path) -> str:
    """Hash of a kernel module and of everything it imports from this package, whatever the depth."""
    todo, seen = [Path(path).resolve()], set()
    while todo:
        at = todo.pop()
        if at not in seen:
            seen.add(at)
            todo += _imports_of(at)
    digest = hashlib.sha1()
    for each in sorted(seen):
        digest.update(each.name.encode() + each.read_bytes())
    versions = f"{sys.version_info[:3]} {np.__version__} {numba.__version__ if JIT else ''}"
    bounds = os.environ.get("NUMBA_BOUNDSCHECK", "0")
    digest.update(f"{versions} bounds={bounds} {numba.config.CPU_NAME if JIT else ''}".encode())
    return digest.hexdigest()[:16]


@cache
def _writable_home() -> Path | None:
    for home in (
        cache_home(),
        Path(tempfile.gettempdir()) / f"hitbox-kernels-{os.getuid() if hasattr(os, 'getuid') else 0}",
    ):
        try:
            home.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=home):
                return home
        except OSError:
            continue
    warnings.warn("no folder can be written for compiled kernels: they are compiled anew at every start", stacklevel=2)
    return None


@cache
def folder_for(path: Path) -> str:
    """The cache folder of one kernel module; folders of older sources of the same module are purged."""
    home = _writable_home()
    if home is None:
        return ""
    path = path.resolve()
    name = (
        ".".join(path.relative_to(HERE).with_suffix("").parts) if path.is_relative_to(HERE) else f"outside.{path.stem}"
    )
    stamp = source_stamp(path)
    old = sorted(
        (each for each in home.glob(f"{name}-*") if each.name != f"{name}-{stamp}"),
        key=lambda each: each.stat().st_mtime if each.exists() else 0.0,
    )
    for each in old[:-3]:  # a few stay: a bounds-checked run and another checkout are not enemies
        shutil.rmtree(each, ignore_errors=True)
    folder = home / f"{name}-{stamp}"
    try:
        folder.mkdir(exist_ok=True)
    except OSError:
        return ""
    return str(folder)
