"""Every part of the warm-up runs without a compiler and reports its progress."""

import pytest

import physics
from physics import Effects
from physics.step import SOLVERS
from physics.warmup import PIECES

pytestmark = pytest.mark.skipif(physics.JIT, reason="compiles all there is: see tests/scenes/test_warm_up.py")
SOME = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)


@pytest.mark.parametrize("solver", SOLVERS)
def test_all_effects_under_all_broad_phases(solver):
    told = []
    everything = Effects.named([*Effects.__dataclass_fields__])
    physics.warmup(everything, "all", solver, lambda done, total, name: told.append((done, total, name)))
    assert [done for done, *_ in told] == list(range(told[-1][1] + 1)) and told[-1][2] == "ready"
    assert {name for *_, name in told} >= {f"broad phase {name}" for name in physics.BROADPHASES} | set(PIECES)


def test_what_is_not_met_is_left_out():
    told = []
    physics.warmup(SOME, pieces=("circles", "queries"), progress=lambda done, total, name: told.append(name))
    assert {"circles", "queries", "rest"} <= set(told) and not {"masks", "tiles", "carving", "sweeps"} & set(told)
