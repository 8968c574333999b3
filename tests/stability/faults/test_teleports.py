"""A body moved into another one between two steps is pushed out no faster than the push-out speed."""

import numpy as np
import pytest

from physics import Chain, Circle, Effects, PixelMask, Polygon, TileGrid, World
from tests.stability.invariants import Watch, deepest
from tests.stability.piles import SOLVERS, needs_speed

BOX, DISC = Polygon.box(32, 32), Circle(16.0)
MASK = PixelMask.from_array(np.hypot(*np.mgrid[-15:16, -15:16]) <= 15)
TILES = TileGrid(np.ones((6, 8), bool), 16.0)
CHAIN = Chain([(-100, -50), (0, -50), (100, -50)])
# What is put, [(what, where, kind)] that is there, and where it is put.
CASES = {
    "a box into a box": (BOX, [(BOX, (0, -16), "dynamic")], (0, -16)),
    "half into a box": (BOX, [(BOX, (0, -16), "dynamic")], (16, -16)),
    "a disc into a disc": (DISC, [(DISC, (0, -16), "dynamic")], (0, -16)),
    "a mask into a mask": (MASK, [(MASK, (0, -16), "dynamic")], (0, -16)),
    "half into a mask": (MASK, [(MASK, (0, -16), "dynamic")], (15, -16)),
    "a box into a wall": (BOX, [(Polygon.box(64, 400), (0, -200), "static")], (0, -200)),
    "half into a wall": (BOX, [(Polygon.box(64, 400), (0, -200), "static")], (32, -100)),
    "a box into a chain": (BOX, [(CHAIN, (0, 0), "static")], (0, -50)),
    "a box into the ground": (BOX, [], (100, 10)),
    "a box into a pile": (BOX, [(BOX, (0, -16 - 32 * k), "dynamic") for k in range(6)], (3, -80)),
    "a mask into tiles": (MASK, [(TILES, (-64, -96), "static")], (-58, -60)),
}
FALL = 330.0  # [px/s] of what falls down a wall of 200 px: sqrt(2 g h), from where it comes out
PUSH = 2 * 96.0  # [px/s] twice the speed of a push-out


def scene(solver, case):
    """Return (world after its first second, body that the test will move into another one)."""
    world = World(Effects.rigid_bodies().with_(sleeping=False), solver=solver, substeps=4)
    world.add_body(Polygon.box(2000, 40), position=(0, 20), kind="static")
    shape, there, _ = CASES[case]
    for other, place, kind in there:
        world.add_body(other, position=place, kind=kind)
    body = world.add_body(shape, position=(300, -16))
    Watch(world).step(60)
    return world, body


@needs_speed
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("solver", SOLVERS)
def test_it_comes_out_gently(solver, case):
    world, body = scene(solver, case)
    body.move_to(CASES[case][2])
    watch = Watch(world)
    watch.step(1)
    assert deepest(world) > 5.0, "it is inside"
    watch.step(599)
    assert watch.fastest <= PUSH + FALL * ("wall" in case or "pile" in case or "tiles" in case)
    assert deepest(world) <= 2 * world.tolerances.slop, "apart"
    assert body.position.y < 0.0, "and above the ground"


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_in_the_middle_of_solid_tiles_it_stays_or_leaves_and_is_finite(solver):
    """A box moved into the middle of solid tiles stays inside or gets out, at a low speed.

    Tiles push to the nearest open side; in the middle of many tiles there is none.
    """
    world, body = scene(solver, "a mask into tiles")
    box = world.add_body(BOX, position=(500, -16))
    box.move_to((0, -48))
    watch = Watch(world, without=("U6",))  # without room it stays overlapped
    watch.step(600)
    assert watch.fastest <= PUSH and abs(box.position.x) < 64.0 and -96.0 < box.position.y < 0.0


@pytest.mark.parametrize("solver", ["projection", "blocking"])
def test_without_stacking_it_is_out_or_stuck_at_once(solver):
    """Without stacking, a body moved into another one is separated after a second, or stays where it was put.

    If it is blocked, gravity alone determines its speed.
    """
    for case in ("half into a box", "half into a wall"):
        world, body = scene(solver, case)
        body.move_to(CASES[case][2])
        watch = Watch(world)
        watch.step(120)
        assert np.isfinite(world.bodies["x"]).all()
        if solver == "projection":
            assert deepest(world) <= 2 * world.tolerances.slop, case
        else:
            assert abs(body.position.x - CASES[case][2][0]) < 1.0, case


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_put_in_and_out_again_within_a_step_nothing_happened(solver):
    """A body that is moved into another one and back before the step is unaffected, because only its pose at the step
    counts.
    """
    moved, plain = (scene(solver, "a box into a pile") for _ in range(2))
    where, angle = moved[1].position, moved[1].angle
    moved[1].move_to((0, -80))
    moved[1].move_to(where, angle)
    for world, _ in (moved, plain):
        Watch(world).step(30)
    assert all(
        np.allclose(moved[0].bodies[name], plain[0].bodies[name], rtol=0, atol=1e-6) for name in ("x", "y", "angle")
    )
