"""A wrong command line gives the exit code 2 also if standard error is closed.

A full disk or a closed pipe as standard output causes no traceback.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from game.command_line import run
from game.registry import Registry
from tests.game.arena import LISTING

MAIN = Path(__file__).resolve().parents[2] / "main.py"


def test_no_standard_error(monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    assert run(["--scene", "bogus"], Registry(LISTING)) == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only where there is a device that is always full")
@pytest.mark.parametrize("flag", ["--version", "--list"])
def test_a_full_disk(flag):
    with open("/dev/full", "w") as full:
        ended = subprocess.run([sys.executable, MAIN, flag], stdout=full, stderr=subprocess.PIPE, text=True)
    assert ended.returncode == 2 and "Traceback" not in ended.stderr
    assert ended.stderr.splitlines()[-1].startswith("hitbox:") and "No space left" in ended.stderr.splitlines()[-1]


def test_a_reader_that_has_gone():
    program = subprocess.Popen(
        [sys.executable, MAIN, "--version"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    program.stdout.close()
    assert program.stderr.read() == "" and program.wait() == 0
    program.stderr.close()
