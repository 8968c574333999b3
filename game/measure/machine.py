"""Facts about the machine on which figures were measured. They do not include the machine's name."""

import os
import platform
from importlib import metadata
from typing import Any

PACKAGES = ("numpy", "numba", "pygame-ce", "pygame", "pymunk")


def machine() -> dict[str, Any]:
    """Return {fact: value} about this machine: processor, cores, system, and versions of Python and packages."""
    return {
        "cpu": cpu_model(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        **{name: version for name in PACKAGES if (version := installed(name))},
    }


def machine_line() -> str:
    """Return the facts about this machine as one line of text."""
    return ", ".join(f"{name} {value}" for name, value in machine().items())


def cpu_model() -> str:
    """Return the name of the processor, or its architecture if the system does not report a name."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def installed(package: str) -> str:
    """Return the version of a package; "" if the package is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""
