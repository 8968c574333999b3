"""Checks at the start of the program, before any slow import. Each reports its result in one line.

The module deliberately uses old syntax (see main.py). A function `*_problem` returns a line that stops the program, or
"". A function `*_note` returns a line of information, or "".
"""

import os
import sys
from collections.abc import Callable

OLDEST_PYTHON = (3, 11)
INTERRUPTED = 130  # exit code after Ctrl-C
IN_CHECKOUT = __package__ == "game"  # or an editable install; a wheel has all packages inside the package hitbox
START = ("python", "main.py") if IN_CHECKOUT else ("hitbox",)  # command that starts the program


def start_line(*arguments: str) -> str:
    """Return the shell command that starts the program with these arguments, quoted for the system's shell."""
    import shlex
    import subprocess

    command = [*START, *arguments]
    return subprocess.list2cmdline(command) if sys.platform == "win32" else shlex.join(command)


def python_problem(version: tuple, executable: str) -> str:
    """Return a line which says that this Python is too old, with its version; "" if it is new enough.

    version: as sys.version_info; executable: path of this Python.
    """
    if tuple(version[:2]) >= OLDEST_PYTHON:
        return ""
    needed, found = dotted(OLDEST_PYTHON), dotted(version[:3])
    return "Python " + needed + " or newer is needed; this is " + found + " (" + executable + ")"


def dotted(version: tuple) -> str:
    """Return a version as text, for example "3.11" for (3, 11)."""
    return ".".join(str(part) for part in version)


def package_problem() -> str:
    """Return a line with the first missing package and the command that installs it; "" if no package is missing."""
    from importlib.util import find_spec

    for module, package in (("numpy", "numpy"), ("pygame", "pygame-ce")):
        if find_spec(module) is None:
            return "the package " + package + " is not installed; run: " + install()
    return ""


def install(extra: str = "") -> str:
    """Return the command that installs the program and its dependencies. extra: pip extra to install as well, or ""."""
    if IN_CHECKOUT:
        return "python -m pip install -e " + ('".[' + extra + ']"' if extra else ".")
    return "python -m pip install " + ('"hitbox[' + extra + ']"' if extra else "hitbox")


def installed(package: str) -> bool:
    """Return whether the distribution `package` is installed in this environment."""
    from importlib import metadata

    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return False
    return True


def pygame_note(is_installed: "Callable[[str], bool]" = installed) -> str:
    """Return a warning if both pygame and pygame-ce are installed, because they overwrite each other's files."""
    if is_installed("pygame") and is_installed("pygame-ce"):
        return (
            "both pygame and pygame-ce are installed and share one import name; keep one: "
            "python -m pip uninstall -y pygame pygame-ce && python -m pip install pygame-ce"
        )
    return ""


def numba_note(jit: bool) -> str:
    """Return a note that the kernels run uncompiled; "" if they are compiled. jit: value of physics.JIT."""
    if jit:
        return ""
    return "numba is not in use: everything works, the physics runs slower (python -m pip install numba)"


def pygame_name() -> str:
    """Return the name and version of the installed pygame, for --version."""
    import pygame

    edition = "pygame-ce" if getattr(pygame, "IS_CE", 0) else "pygame"
    return edition + " " + pygame.version.ver


def prepare_environment() -> None:
    """Suppress pygame's greeting on standard output, because --json must print only its one object there."""
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")


def end_quietly_on_interrupt() -> "object":
    """Make Ctrl-C end the program at once, with exit code 130 and without a traceback.

    This lasts until take_interrupts() is called. Return the previous handler, which is the argument of
    take_interrupts(). Call this function before the imports. Imports need no cleanup, and an exception during an import
    prints many lines or is lost. A handler other than Python's default is not replaced.
    """
    import signal
    import threading

    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is threading.main_thread() and before is signal.default_int_handler:
        signal.signal(signal.SIGINT, lambda number, frame: os._exit(INTERRUPTED))
    return before


def take_interrupts(handler: "object") -> None:
    """Make Ctrl-C raise KeyboardInterrupt again. handler: result of end_quietly_on_interrupt()."""
    import signal

    if handler is signal.default_int_handler and signal.getsignal(signal.SIGINT) is not handler:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def say(line: str, whole: bool = False) -> None:
    """Print one line on standard error, shortened to errors.LONGEST characters.

    Print nothing if there is no standard error. whole: True does not shorten the line. It is used for the program's own
    texts and for texts with a list of valid names.
    """
    if line and sys.stderr is not None:  # None if closed, or started without a terminal
        if not whole:
            from game.errors import brief

            line = brief(line)
        sys.stderr.write("hitbox: " + line + "\n")
