"""Processes of our own that work beside the program: modules that are told lines, and answer with lines."""

import contextlib
import os
import site
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

IMPORTED_FROM = Path(__file__).resolve().parents[__name__.count(".")]  # the folder that this module's name begins in


def start_module(module: str, **environment: str) -> "subprocess.Popen[str]":
    """Start `python -m module` with pipes for lines, of low priority, deaf to Ctrl-C in the terminal.

    module: its full name, as in f"{__package__}.worker". The child imports what this program does, and nothing from the
    current folder: a `physics.py` or `numpy.py` there is the user's own. environment: more for its own. Raises OSError,
    ValueError where none can be started.
    """
    # A group, not a session: Linux weighs sessions against each other whatever the priority of their processes
    # (autogroups, man 7 sched), so that one of its own would take as much as the program.
    options: dict[str, Any] = {"process_group": 0}
    if sys.platform == "win32":
        options = {"creationflags": subprocess.BELOW_NORMAL_PRIORITY_CLASS | subprocess.CREATE_NEW_PROCESS_GROUP}
    return subprocess.Popen(
        [sys.executable, "-P", "-m", module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, **search_path(), **environment},
        **options,
    )


def search_path() -> dict[str, str]:
    """Return PYTHONPATH for a process that is to find this program where this one does; {} where it does by itself."""
    if IMPORTED_FROM in {Path(each).resolve() for each in (*site.getsitepackages(), site.getusersitepackages())}:
        return {}  # named again, site-packages would stand before the standard library
    return {"PYTHONPATH": os.pathsep.join(filter(None, (str(IMPORTED_FROM), os.environ.get("PYTHONPATH"))))}


def end_all(processes: Iterable["subprocess.Popen[str]"]) -> None:
    """Kill them, all before the first is waited for."""
    processes = list(processes)
    for process in processes:
        process.kill()
    for process in processes:
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                if pipe is not None:
                    pipe.close()
