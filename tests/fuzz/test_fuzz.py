"""Random programs over the whole API keep all invariants, and a failure is shown as a few lines."""

import re

import numpy as np
import pytest

from physics import JIT, World
from tests.fuzz.joint_lines import PLAIN
from tests.fuzz.running import LINES, failure_of, run_lines, script_of, write_program
from tests.fuzz.shrinking import shrink

PROGRAMS = 132 if JIT else 12  # a minute of steps; kernels of five sets of effects are compiled before
LONG = LINES if JIT else 12  # lines of each
PARTS = 12  # so that several processes share them; the first three in every run, all at night


@pytest.mark.parametrize(
    "part", [0, 1, 2, *(pytest.param(part, marks=pytest.mark.nightly) for part in range(3, PARTS))]
)
def test_random_programs_keep_the_invariants(part):
    """Random programs keep the invariants.

    A failure shows the shortest program found, as the text of a regression test.
    """
    for seed in range(part, PROGRAMS, PARTS):
        lines, failure, strategy = write_program(seed, LONG)
        if failure is not None:
            short = shrink(lines, failure, strategy, tries=400)
            pytest.fail(f"seed {seed}: {failure.kind}\n\n{script_of(short, strategy)}\n\n{failure.story}")


def test_programs_are_the_same_every_time():
    assert write_program(5, lines=20) == write_program(5, lines=20)


def test_wrong_calls_are_no_failure():
    """Calls with documented errors raise them and change nothing, and do not count as failures."""
    failure, runner = run_lines(
        [
            "world = World()",
            "b1 = world.add_body(Circle(-1.0))",
            "b2 = world.add_body(Circle(4.0))",
            "b2.velocity = 'fast'",
            "b2.remove()",
            "b2.velocity = (1.0, 2.0)",
            "world.step(-1.0)",
            "b3.velocity = (1.0, 2.0)",
        ]
    )
    assert failure is None and "b1" not in runner.space and len(runner.space["world"]) == 0


PROGRAM = [
    "world = World(Effects(response=True, gravity=True), BruteForce(), gravity=(0.0, 100.0))",
    "b1 = world.add_body(Circle(3.127, (1.5, 0.25)), position=(50.0, 3.333), material=Material(density=2.0))",
    "b2 = world.add_body(Polygon.box(20.0, 10.0), position=(-80.0, 7.0), velocity=(1.25, 0.0), fixed_rotation=True)",
    "world.step()",
    "b1.velocity = (12.75, -3.5)",
    "for _ in range(10): world.step()",
    "world.ray_cast_all((0.0, 0.0), (100.0, 3.0))",
    "b2.position = (-33.3, 4.0)",
    "world.step()",
]


def test_broken_world_is_found_and_shown_in_three_lines(monkeypatch):
    """A program whose third step writes a wrong speed fails, and is shortened to a world, a body and its steps."""
    step = World.step

    def wrong(self, dt=None):
        step(self, dt)
        if len(self) and self.time > 2.5 / 60:
            self.bodies["vx"][0] = np.nan

    assert failure_of(PROGRAM) is None
    monkeypatch.setattr(World, "step", wrong)
    failure = failure_of(PROGRAM)
    assert failure is not None and failure.kind == "invariant: numbers are finite"
    short = shrink(PROGRAM, failure)
    assert len(short) == 3 and short[2] == "for _ in range(3): world.step()"
    assert short[1] == "b1 = world.add_body(Circle(3.0, (1.5, 0.0)))"
    assert script_of(short).startswith("import numpy as np\nfrom physics import *\n\nworld = World(")


def test_error_that_nobody_raised_is_a_failure(monkeypatch):
    """A TypeError that NumPy or Python raises for a wrong argument counts as a failure."""
    monkeypatch.setattr(World, "ray_cast_all", lambda self, origin, way: len(origin) + way)
    failure = failure_of(PROGRAM)
    assert failure is not None and failure.kind.startswith("TypeError in test_fuzz.py")


def test_wrong_call_that_changes_the_world_is_a_failure(monkeypatch):
    step = World.step

    def wrong(self, dt=None):
        self.dt = 0.5
        step(self, dt)

    monkeypatch.setattr(World, "step", wrong)
    failure = failure_of(["world = World()", "world.step(-1.0)"])
    assert failure is not None and failure.kind == "invariant: a wrong call changes nothing"


# --- joints -----------------------------------------------------------------------------------------------------------

JOINTED = [
    "world = World(Effects.rigid_bodies().with_(joints=True), BruteForce(), gravity=(0.0, 100.0))",
    "b1 = world.add_body(Circle(3.127), position=(50.0, 3.333), material=Material(density=2.0))",
    "b2 = world.add_body(Circle(4.0), position=(-80.0, 7.0), velocity=(1.25, 0.0))",
    "world.ray_cast_all((0.0, 0.0), (100.0, 3.0))",
    "j1 = world.add_joint(Revolute(b1, b2, at=(0.125, 0.25), limits=(-1.0, 1.0), motor=Drive(2.0, max=1e+05)))",
    "j2 = world.add_joint(Gear(j1, b2, ratio=2.0))",
    "for _ in range(10): world.step()",
    "j1.motor = Drive(2.5, max=10.0)",
    "b1.remove()",
    "for _ in range(3): world.step()",
]


def test_programs_with_joints_have_all_kinds():
    """Programs add joints of every kind, change settings and columns, and remove joints."""
    texts = "\n".join(line for seed in range(24) for line in write_program(seed, 40, "joints")[0])
    assert all(f"({kind}(" in texts for kind in PLAIN)
    for use in ("world.add_joints(", "world.joint_solver = ", "world.joints[", ".enabled = ", "world.remove_joints("):
        assert use in texts
    assert re.search(r"\.(limits|motor|spring|breaks) = ", texts)


def no_joints_dropped(self, ids):
    """Replace World._drop_joints_of: the joints of removed bodies stay."""


def untold(monkeypatch):
    import physics.joint

    monkeypatch.setattr(physics.joint, "broken_rows", lambda rows, reason: np.zeros(0, physics.joint.BROKEN))


@pytest.mark.parametrize(
    ("harm", "kind"),
    [
        (lambda patch: patch.setattr(World, "_drop_joints_of", no_joints_dropped), "a joint has bodies that are there"),
        (untold, "broken joints are told, and are gone"),
    ],
)
def test_joints_of_removed_bodies_are_watched_and_shown_in_few_lines(harm, kind, monkeypatch):
    """A program fails if joints of a removed body stay, or are not reported; it is shortened to the lines it needs."""
    assert failure_of(JOINTED) is None
    harm(monkeypatch)
    failure = failure_of(JOINTED)
    assert failure is not None and failure.kind == f"invariant: {kind}"
    short = shrink(JOINTED, failure)
    assert len(short) <= 6 and any("add_joint" in line for line in short) and "b1.remove()" in short
    assert "limits" not in "".join(short) and "motor" not in "".join(short)
    assert script_of(short).startswith("import numpy as np\nfrom physics import *\n\nworld = World(")


def test_energy_from_joints_is_a_failure(monkeypatch):
    step = World.step

    def wrong(self, dt=None):
        step(self, dt)
        self.bodies["vx"][0] *= 3.0

    monkeypatch.setattr(World, "step", wrong)
    failure = failure_of(JOINTED[:7])
    assert failure is not None and failure.kind == "invariant: joints add no energy"
