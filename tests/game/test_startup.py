"""Lines that must be printed before slow modules are imported."""

import ast
from pathlib import Path

from game import startup

ROOT = Path(__file__).resolve().parents[2]


def test_an_old_python_is_named():
    line = startup.python_problem((3, 8, 10, "final", 0), "/usr/bin/python3")
    assert line == "Python 3.11 or newer is needed; this is 3.8.10 (/usr/bin/python3)"
    assert startup.python_problem((3, 11, 0), "x") == ""


def test_old_pythons_can_parse_what_prints_it():
    for name in ("main.py", "game/startup.py", "game/__init__.py"):
        ast.parse((ROOT / name).read_text(), feature_version=(3, 4))


def test_both_pygames_are_named():
    assert "uninstall -y pygame pygame-ce" in startup.pygame_note(lambda name: True)
    assert startup.pygame_note(lambda name: name == "pygame-ce") == ""


def test_a_missing_numba_is_said_once():
    assert "numba" in startup.numba_note(False) and startup.numba_note(True) == ""


def test_a_missing_package_names_the_install(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "pygame" else object())
    assert startup.package_problem() == "the package pygame-ce is not installed; run: python -m pip install -e ."
