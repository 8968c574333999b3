"""Plain kernels are replaced by compiled ones at random steps: the digests equal those of the compiled scene."""

import math

import pytest

pytest.importorskip("numba")  # what compares the two forms imports the compiler

import physics
from physics.dynamics import integrate
from physics.jit import tiers
from physics.jit.kernels import Kernel
from physics.jit.plain import TableView
from scenes import SCENES
from tests.game.arena import Arena
from tests.lockstep import Diverged
from tests.takeover import compare_take_overs

pytestmark = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")

SOME = ("shooter", "platformer", "lander", "lab/one_way", "lab/stacks", "lab/mask_sweep")
FRAMES = 60
LONG_FRAMES = 240
SEEDS = (1, 2, 3)


@pytest.mark.parametrize("name", SOME)
def test_it_does_not_matter_when_compiled_forms_take_over(name):
    overs = compare_take_overs(name, FRAMES)
    assert len(set(overs.frames.values())) > 5, "at several frames, or nothing was tried"


@pytest.mark.nightly
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", SCENES)
def test_nor_in_any_scene(name, seed):
    compare_take_overs(name, LONG_FRAMES, seed)


def arena(name):
    return Arena(seed=1)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_plain_twin_that_differs_is_seen(seed, monkeypatch):
    """A plain kernel whose velocity is wrong by one unit in the last place is detected, until its compiled form
    replaces it.
    """
    twin = Kernel.plain.fget
    wrong = {id(each) for each in integrate.POSITIONS.values()}

    def plain(kernel):
        found = twin(kernel)
        if id(kernel) not in wrong:
            return found

        def differs(rows, *rest):
            found(rows, *rest)
            bodies = next(each for each in rest if isinstance(each, TableView))
            for k in range(len(rows)):
                bodies[rows[k]].vx = math.nextafter(bodies[rows[k]].vx, math.inf)

        return differs

    compare_take_overs("arena", 20, seed, arena)
    monkeypatch.setattr(Kernel, "plain", property(plain))
    with pytest.raises(Diverged, match=r"differs since frame 1 in worlds \[0\].*Still plain: .*integrate"):
        compare_take_overs("arena", 20, seed, arena)


def test_afterwards_every_kernel_is_as_before():
    compare_take_overs("arena", 3, make=arena)
    forms = {each.name: dict(each.forms) for each in physics.jit.registry}
    compare_take_overs("arena", 3, make=arena)
    assert forms == {each.name: dict(each.forms) for each in physics.jit.registry}
    assert not tiers.background and not tiers.wanted and not tiers.arrived
