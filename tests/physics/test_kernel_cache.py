"""Compiled kernels are cached under a key that is computed from everything they depend on.

The symbols by which they are linked are made from the same key.
"""

import json
import os
import shutil
import subprocess
import sys
from itertools import permutations
from pathlib import Path

import pytest

import physics
from physics import jit

SOURCES = Path(physics.__file__).parent
ROOT = SOURCES.parent
pytestmark = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")

# A factory of parts that differ by what they close over alone, and kernels that call one or several of them.
TOY = """
from physics.jit import inlined, kernel, noalias, subkernel

SCALE = 3.0

def make_part(add):
    @subkernel
    def part(x):
        y = x
        for k in range(4):
            y = y * 0.5 + add
        return y
    return part

PARTS = [make_part(add) for add in (1.0, 2.0, 5.0)]

def make_one(part):
    @kernel
    def one(x):
        return part(x) * SCALE
    return one

def make_sum(first, second, third):
    @kernel
    def all_of_them(x):
        return first(x) + 10.0 * second(x) + 100.0 * third(x)
    return all_of_them

ONES = [make_one(part) for part in PARTS]
"""


def run(code, folder, cache, *arguments, **environment):
    """Run code in a new Python process. Return the last line that it prints, parsed as JSON.

    The process writes no bytecode: Python would take a changed source of equal length and time for the old one.
    """
    path = os.pathsep.join((str(folder), str(ROOT)))
    done = subprocess.run(
        [sys.executable, "-B", "-P", "-c", code, *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": path, "HITBOX_CACHE_DIR": str(cache), **environment},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


ONE = "import json, sys, toy; print(json.dumps(toy.ONES[int(sys.argv[1])](7.0)))"
SUM = """
import json, sys, toy
from physics.jit import kernels as totals
order = [int(each) for each in sys.argv[1]]
made = toy.make_sum(*(toy.PARTS[each] for each in order))
print(json.dumps([made(7.0), made.plain(7.0), totals.compiled, totals.parts_loaded]))
"""


@pytest.fixture
def toy(tmp_path):
    (tmp_path / "toy.py").write_text(TOY)
    return tmp_path


@pytest.mark.parametrize("order", ["012", "210", "102"])
def test_parts_of_several_processes_are_linked_to_the_right_code(toy, order):
    """Kernel parts compiled in different processes are linked to the right code.

    numba's own symbols contain a counter, so the first part of each process would have the same symbol.
    """
    cache = toy / "cache"
    for number in order:
        run(ONE, toy, cache, number)
    for each in permutations("012"):
        found, plain, compiled, loaded = run(SUM, toy, cache, "".join(each))
        assert found == plain and compiled == 1 and loaded >= 3


WORKERS = """
import json, random, sys, toy
from physics.background import compile_ahead
from physics.jit import kernels as totals, tiers
rng = random.Random(int(sys.argv[1]))
made = [*toy.ONES, *(toy.make_sum(*rng.choices(toy.PARTS, k=3)) for _ in range(9))]
rng.shuffle(made)
with tiers.collecting() as found:
    plain = [each(7.0) for each in made]
order = list(found)
rng.shuffle(order)
compile_ahead(order)
still = [each.run == each.call_plain for each in made]
print(json.dumps([[each(7.0) for each in made], plain, totals.compiled, still]))
"""


@pytest.mark.parametrize("seed", range(3))
def test_workers_in_any_order_compile_what_the_program_then_links(toy, seed):
    found, plain, compiled, still_plain = run(WORKERS, toy, toy / "cache", seed)
    assert found == plain and compiled == 0 and not any(still_plain)


NAMES = """
import json, toy
from physics.jit.compiling import name_of
from physics.jit.kernels import key_of
print(json.dumps([name_of(each, (key_of(7.0),)) for each in toy.ONES]))
"""
CHANGES = {
    "the kernel": ("return part(x) * SCALE", "return part(x) + SCALE"),
    "what it calls": ("y * 0.5 + add", "y * 0.25 + add"),
    "a constant of the module": ("SCALE = 3.0", "SCALE = 4.0"),
    "the type of a constant": ("SCALE = 3.0", "SCALE = 3"),
    "the sign of zero": ("SCALE = 3.0", "SCALE = -0.0"),
    "what is closed over": ("(1.0, 2.0, 5.0)", "(1.5, 2.5, 5.5)"),
    "inlining": ("    @subkernel", "    @inlined"),
    "aliasing": ("    @subkernel", "    @noalias"),
    "a default": ("def part(x):", "def part(x, unused=1):"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_another_source_has_another_name(toy, change):
    before = run(NAMES, toy, toy / "cache")
    (toy / "toy.py").write_text(TOY.replace(*CHANGES[change]))
    after = run(NAMES, toy, toy / "cache")
    assert len({*before, *after}) == 6


SAME = {
    "a comment": lambda text: text.replace("SCALE = 3.0", "# of all\n\nSCALE = 3.0"),
    "another function": lambda text: text + "\n@subkernel\ndef other(x):\n    return x\n",
    "the order": lambda text: text.replace("SCALE = 3.0", "") + "\nSCALE = 3.0\n",
}


@pytest.mark.parametrize("change", SAME)
def test_what_changes_no_code_changes_no_name(toy, change):
    before = run(NAMES, toy, toy / "cache")
    (toy / "toy.py").write_text(SAME[change](TOY))
    assert run(NAMES, toy, toy / "cache", PYTHONHASHSEED="7") == before


@pytest.mark.parametrize("environment", [{"NUMBA_BOUNDSCHECK": "1"}, {"NUMBA_CPU_NAME": "generic"}, {"NUMBA_OPT": "1"}])
def test_another_environment_has_another_name(toy, environment):
    assert not {*run(NAMES, toy, toy / "cache", NUMBA_BOUNDSCHECK="0")} & {
        *run(NAMES, toy, toy / "cache", **environment)
    }


def test_named_tuples_of_other_fields_are_other_constants(toy):
    text = (
        "from typing import NamedTuple\n\nclass Limits(NamedTuple):\n    low: float\n    high: float\n"
        + TOY.replace("SCALE = 3.0", "SCALE = Limits(1.0, 2.0)").replace("* SCALE", "* SCALE.low")
    )
    (toy / "toy.py").write_text(text)
    before = run(NAMES, toy, toy / "cache")
    (toy / "toy.py").write_text(text.replace("low: float\n    high: float", "high: float\n    low: float"))
    assert not {*before} & {*run(NAMES, toy, toy / "cache")}


def test_a_value_that_has_no_content_is_refused(toy):
    (toy / "toy.py").write_text(TOY.replace("SCALE = 3.0", "SCALE = object()"))
    with pytest.raises(AssertionError, match="toy.make_one.<locals>.one: builtins.object cannot be part of a kernel"):
        run(NAMES, toy, toy / "cache")


STACK = """
import json
from physics import Circle, PixelMask, Polygon, World
from physics.jit import kernels as totals
import numpy as np
world = World(solver="SOLVER")
world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
for number in range(6):
    shape = (Polygon.box(20, 20), Circle(10), PixelMask.from_array(np.ones((20, 20), bool)))[number % 3]
    world.add_body(shape, position=(0.3 * number, 80 - 21 * number))
for _ in range(240):
    world.step()
print(json.dumps([world.digest(), totals.compiled, totals.loaded]))
"""


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
def test_a_second_process_compiles_nothing(tmp_path, solver):
    code = STACK.replace("SOLVER", solver)
    cache = os.environ.get("HITBOX_CACHE_DIR") or str(physics.jit.store.cache_home())
    first, _, _ = run(code, tmp_path, cache)
    for seed in ("0", "1", "77"):
        digest, compiled, loaded = run(code, tmp_path, cache, PYTHONHASHSEED=seed)
        assert digest == first and compiled == 0 and loaded > 10


def test_a_copy_elsewhere_finds_what_was_compiled_and_other_sources_of_jit_do_not(tmp_path):
    first, second, cache = tmp_path / "first", tmp_path / "second", tmp_path / "cache"
    for folder in (first, second):
        shutil.copytree(SOURCES, folder / "physics", ignore=shutil.ignore_patterns("__pycache__"))
    for path in second.rglob("*.py"):
        os.utime(path, (1, 1))
    code = (
        "import json\nfrom physics import Circle, Effects, World\nfrom physics.jit import kernels as totals\n"
        "world = World(Effects())\nworld.add_body(Circle(4))\nworld.step()\n"
        "print(json.dumps([totals.compiled, totals.loaded]))"
    )

    def counted(folder):
        return run(code, folder, cache, PYTHONPATH=str(folder))

    compiled, loaded = counted(first)
    assert compiled > 5 and loaded == 0
    assert counted(second) == [0, compiled]
    changed = second / "physics" / "jit" / "plain.py"
    changed.write_text(changed.read_text() + "\nANOTHER = 1\n")
    assert counted(second) == [compiled, 0]


def test_every_kernel_of_the_package_has_a_content_of_its_own():
    from physics.jit.content import content_of

    found = {}
    for each in jit.registry:
        if each.__module__.startswith("physics."):
            found.setdefault(content_of(each), set()).add(each.name)
    assert len(found) > 300 and all(len(names) == 1 for names in found.values())


def test_plain_twins_call_plain_twins_alone():
    """A plain kernel calls only plain kernels: it refers to no Kernel, at any depth."""
    from physics.jit.kernels import Kernel
    from physics.jit.plain import Builtin, globals_of

    seen, todo = set(), [each.plain for each in jit.registry]
    while todo:
        twin = todo.pop()
        if id(twin) in seen:
            continue
        seen.add(id(twin))
        values = [value for _, value in globals_of(twin)]
        values += [cell.cell_contents for cell in twin.__closure__ or ()]
        assert not [each for each in values if isinstance(each, (Kernel, Builtin))], twin.__qualname__
        todo += [each for each in values if type(each) is type(twin)]
    assert len(seen) > 400
