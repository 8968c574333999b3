"""Ctrl-C while the program is importing ends it without output, not with a traceback of some library."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# Ctrl-C comes when the named module is first looked for.
WATCHED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where what started this one ignores it
class Interrupts:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Interrupts())
import main
sys.exit(main.main(["--list"]))
"""
MODULES = (
    "game.command_line",
    "argparse",
    "numpy",
    "numpy.linalg",
    "pygame",
    "physics",
    "physics.world",
    "physics.jit",
)
LATER = ("game.registry", "game.scene", "scenes", "scenes.shooter.scene", "scenes.lab.shapes")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize("module", (*MODULES, *LATER))
def test_it_ends_without_a_word(module):
    run = subprocess.run(
        [sys.executable, "-c", WATCHED.format(module=module)], cwd=ROOT, capture_output=True, text=True
    )
    assert run.returncode == 130 and "Traceback" not in run.stderr and "Interrupt" not in run.stderr, run.stderr[-500:]


def test_afterwards_it_is_an_exception_again(monkeypatch):
    """After the import Ctrl-C raises KeyboardInterrupt again, during a run and for a program that called main()."""
    import game.command_line
    import main

    seen = []
    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr(game.command_line, "run", lambda *_: seen.append(signal.getsignal(signal.SIGINT)) or 0)
    assert main.main([]) == 0
    assert seen == [before] and signal.getsignal(signal.SIGINT) is before
