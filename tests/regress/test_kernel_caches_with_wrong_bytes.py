"""A kernel cache with wrong bytes, at the right length or not, only costs a new compilation."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import physics

pytestmark = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")

ROOT = Path(physics.__file__).parent.parent
# A kernel that calls another, with two versions of each: of whole numbers and of fractions.
KERNELS = """
from physics.jit import generic, subkernel

@subkernel
def twice(value):
    return value + value

@generic
def total(values):
    found = values[0] - values[0]
    for value in values:
        found += twice(value)
    return found
"""
ASK = """
import numpy as np
from kernels import total
from physics.jit import kernels as totals
print(total(np.arange(5)), total(np.arange(5) / 4.0))
print(totals.compiled)
"""


def ask(folder):
    """Run the kernels in a new process. Return (their results, number of compiled kernels, output)."""
    run = subprocess.run(
        [sys.executable, "-W", "always", "-c", ASK],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": f"{folder}:{ROOT}", "HITBOX_CACHE_DIR": str(folder / "cache")},
        timeout=300,
    )
    assert run.returncode == 0, run.stderr[-2000:]
    found, misses = run.stdout.split("\n")[:2]
    return found, int(misses), run.stderr


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kernels")
    (folder / "kernels.py").write_text(KERNELS)
    assert ask(folder)[:2] == ("20 5.0", 2)
    assert ask(folder) == ("20 5.0", 0, "")
    files = [path for path in (folder / "cache").rglob("*") if path.is_file()]
    assert len(files) == 4, "two kernels, and for each the part that it calls"
    return folder, {path: path.read_bytes() for path in files}


def flipped(content, places):
    """Return the content with one bit inverted at each position, given as a share 0..1 of the length."""
    wrong = bytearray(content)
    for share in places:
        wrong[int(share * (len(wrong) - 1))] ^= 0x10
    return bytes(wrong)


DAMAGE = {
    "one bit in front": lambda content: flipped(content, (0.0,)),
    "one bit in the middle": lambda content: flipped(content, (0.5,)),
    "one bit at the end": lambda content: flipped(content, (1.0,)),
    "a bit every twentieth": lambda content: flipped(content, [k / 20 for k in range(21)]),
    "zeros, of the same length": lambda content: bytes(len(content)),
    "cut short": lambda content: content[: len(content) // 2],
    "nothing": lambda content: b"",
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_wrong_bytes_are_compiled_anew(warm, damage):
    folder, files = warm
    for path, content in files.items():
        path.write_bytes(DAMAGE[damage](content))
    found, misses, said = ask(folder)
    assert found == "20 5.0" and misses == 2
    assert "damaged" in said and "total" in said
    assert ask(folder) == ("20 5.0", 0, ""), "and from then on it is whole again"
    for path in files:
        assert path.exists()


def test_files_that_were_swapped_are_not_run(warm):
    """Cache files whose names were exchanged are not run; the kernels are compiled again."""
    folder, files = warm
    paths = sorted(files)
    for path, other in zip(paths, paths[1:] + paths[:1], strict=True):
        path.write_bytes(files[other])
    assert ask(folder)[:2] == ("20 5.0", 2)
