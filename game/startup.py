"""Checks that must speak before anything heavy is imported: one clear line each.

Old syntax on purpose (see main.py). `*_problem` returns a line that stops the program or "";
`*_note` returns a line worth saying on the way in or "".
"""

import os
import sys
from collections.abc import Callable

OLDEST_PYTHON = (3, 11)
INTERRUPTED = 130  # exit code of a program that Ctrl-C has ended
IN_CHECKOUT = __package__ == "game"  # or an editable install; a wheel has all of it in the package hitbox
START = ("python", "main.py") if IN_CHECKOUT else ("hitbox",)  # what starts the program, as a person types it


def python_problem(version: tuple, executable: str) -> str:
    """Say that this Python is too old, and which one it is; "" when it is new enough."""
    if tuple(version[:2]) >= OLDEST_PYTHON:
        return ""
    needed, found = dotted(OLDEST_PYTHON), dotted(version[:3])
    return "Python " + needed + " or newer is needed; this is " + found + " (" + executable + ")"


def dotted(version: tuple) -> str:
    """A version as it is written: 3.11."""
    return ".".join(str(part) for part in version)


def package_problem() -> str:
    """Name the first package that is missing and how to install it; "" when all are there."""
    from importlib.util import find_spec

    for module, package in (("numpy", "numpy"), ("pygame", "pygame-ce")):
        if find_spec(module) is None:
            return "the package " + package + " is not installed; run: " + install()
    return ""


def install(extra: str = "") -> str:
    """Return the command that installs the program and what it needs; extra: with what an extra brings."""
    if IN_CHECKOUT:
        return "python -m pip install -e " + ('".[' + extra + ']"' if extra else ".")
    return "python -m pip install " + ('"hitbox[' + extra + ']"' if extra else "hitbox")


def installed(package: str) -> bool:
    """True when a distribution of that name is installed in this environment."""
    from importlib import metadata

    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return False
    return True


def pygame_note(is_installed: "Callable[[str], bool]" = installed) -> str:
    """Warn when pygame and pygame-ce are both there: they overwrite each other's files."""
    if is_installed("pygame") and is_installed("pygame-ce"):
        return (
            "both pygame and pygame-ce are installed and share one import name; keep one: "
            "python -m pip uninstall -y pygame pygame-ce && python -m pip install pygame-ce"
        )
    return ""


def numba_note(jit: bool) -> str:
    """Say that the kernels run uncompiled. `jit`: physics.JIT."""
    if jit:
        return ""
    return "numba is not in use: everything works, the physics runs slower (python -m pip install numba)"


def pygame_name() -> str:
    """Which pygame this is, for --version."""
    import pygame

    edition = "pygame-ce" if getattr(pygame, "IS_CE", 0) else "pygame"
    return edition + " " + pygame.version.ver


def prepare_environment() -> None:
    """Keep pygame's greeting off standard output, where --json prints its one object."""
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")


def end_quietly_on_interrupt() -> "object":
    """Until take_interrupts() Ctrl-C ends the program at once, with exit code 130 and without a traceback.

    Returns what Ctrl-C did before. What is imported meanwhile has nothing to clean up, and an exception in the middle
    of an import is told in many lines, or swallowed. Where Ctrl-C means something else already, it stays so.
    """
    import signal
    import threading

    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is threading.main_thread() and before is signal.default_int_handler:
        signal.signal(signal.SIGINT, lambda number, frame: os._exit(INTERRUPTED))
    return before


def take_interrupts(handler: "object") -> None:
    """Ctrl-C raises KeyboardInterrupt again; handler: what end_quietly_on_interrupt() returned."""
    import signal

    if handler is signal.default_int_handler and signal.getsignal(signal.SIGINT) is not handler:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def say(line: str, whole: bool = False) -> None:
    """Print one line of at most errors.LONGEST letters on standard error, where there is one.

    whole: the line is the program's own, or bounded but for a list of the program's own names, and is not cut.
    """
    if line and sys.stderr is not None:  # closed, or a start without a terminal
        if not whole:
            from game.errors import brief

            line = brief(line)
        sys.stderr.write("hitbox: " + line + "\n")
