"""Processes of our own that work beside the program: modules that are told lines, and tell lines."""

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]


def start_module(module: str, **environment: str) -> "subprocess.Popen[str]":
    """`python -m module` with pipes for lines, of low priority where the system starts it so, deaf to Ctrl-C in the
    terminal; environment: more for its own. Raises OSError, ValueError where none can be started."""
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    options: dict[str, Any] = {"start_new_session": True}
    if sys.platform == "win32":
        options = {"creationflags": subprocess.BELOW_NORMAL_PRIORITY_CLASS | subprocess.CREATE_NEW_PROCESS_GROUP}
    return subprocess.Popen(
        [sys.executable, "-m", module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, **environment, "PYTHONPATH": path},
        **options,
    )


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
