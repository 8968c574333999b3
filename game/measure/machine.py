"""The machine that figures are from: facts about it, nothing that names it."""

import os
import platform
from importlib import metadata
from typing import Any

PACKAGES = ("numpy", "numba", "pygame-ce", "pygame", "pymunk")


def machine() -> dict[str, Any]:
    """Facts about where it runs; nothing that names it."""
    return {
        "cpu": cpu_model(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        **{name: version for name in PACKAGES if (version := installed(name))},
    }


def cpu_model() -> str:
    """The processor's own name, or its kind where the system does not tell."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def installed(package: str) -> str:
    """The version of a package, "" when it is not there."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""
