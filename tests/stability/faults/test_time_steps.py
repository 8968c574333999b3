"""Steps of unintended lengths: 0, negative, NaN, one second, or a new length every time."""

import math

import numpy as np
import pytest

from physics import JIT, SOLVERS, Character, Effects, Polygon, World
from tests.stability.invariants import Watch, deepest, kinetic
from tests.stability.piles import SOLVERS as STACKING
from tests.stability.piles import needs_speed

SIZE, COUNT = 32.0, 5  # [px] boxes, and how many stand on each other
TOP = -SIZE * (COUNT - 0.5)
STEADY = np.random.default_rng(3).uniform(1 / 240, 1 / 20, 600).tolist()
CHANGING = {  # dt [s] of step k: what a pile has to stand
    "one per cent": lambda k: (1.0 + 0.01 * math.sin(k)) / 60,
    "half as long again": lambda k: 1.5 / 60 if k % 7 == 0 else 1 / 60,
    "a stall of 1 s": lambda k: 1.0 if k == 120 else 1 / 60,
    "a step of none between": lambda k: 0.0 if k % 2 else 1 / 60,
    "shorter than any": lambda k: 5e-324 if k % 3 == 0 else 1 / 60,
    "1/240 to 1/20 at random": lambda k: STEADY[k],
    "1e-9 throughout": lambda k: 1e-9,
}
ALTERNATING = {
    "1/30 and 1/240": lambda k: 1 / 30 if k % 2 else 1 / 240,
    "1/60 and 1e-5": lambda k: 1e-5 if k % 3 == 0 else 1 / 60,
    "1/60 and 1e-9": lambda k: 1e-9 if k % 3 == 0 else 1 / 60,
}


def pile(solver, **options):
    """Return (world, boxes) of a stack of five boxes on a wide floor."""
    world = World(Effects.rigid_bodies().with_(sleeping=False), solver=solver, **options)
    world.add_body(Polygon.box(2000, 40), position=(0, 20), kind="static")
    return world, [world.add_body(Polygon.box(SIZE, SIZE), position=(0, -SIZE * (k + 0.5))) for k in range(COUNT)]


def stands(world, boxes):
    """Return whether the stack is unchanged: each box is upright and within a tenth of its size of its start."""
    places = [abs(box.position.y + SIZE * (k + 0.5)) + abs(box.position.x) for k, box in enumerate(boxes)]
    return max(places) < 0.1 * SIZE and max(abs(box.angle) for box in boxes) < 0.01


@needs_speed
@pytest.mark.parametrize("dts", CHANGING)
@pytest.mark.parametrize("solver", STACKING)
def test_a_pile_stands_however_the_steps_change(solver, dts):
    world, boxes = pile(solver)
    stall = dts == "a stall of 1 s"  # it lets the boxes into each other, and they come out as slowly as others do
    watch = Watch(world, capped=stall, without=("U5", "U6") if stall else ())
    for k in range(600):
        watch.step(dt=CHANGING[dts](k))
    assert stands(world, boxes) and deepest(world) <= 2 * world.tolerances.slop
    if dts not in ("1/240 to 1/20 at random", "half as long again"):
        assert kinetic(world) < 1.0, "and rests"


@needs_speed
@pytest.mark.parametrize("dts", ALTERNATING)
@pytest.mark.parametrize("solver", STACKING)
def test_a_pile_stands_where_long_and_short_steps_alternate(solver, dts):
    world, boxes = pile(solver)
    watch = Watch(world)
    for k in range(300):
        watch.step(dt=ALTERNATING[dts](k))
    assert stands(world, boxes) and watch.fastest < 5.0


@pytest.mark.parametrize("solver", SOLVERS)
def test_steps_of_a_second_are_finite_and_stay_above_the_floor(solver):
    """In steps of one second, bodies on the floor stay on it and all numbers stay finite.

    A pile may sink into itself, which cap_hits counts. Projection also counts a box that rattles between two others,
    because it sweeps boxes against boxes.
    """
    world, boxes = pile(solver)
    watch, capped = Watch(world, capped=True, without=("U5", "U6")), 0
    for _ in range(20 if JIT else 6):
        watch.step(dt=1.0)
        capped += world.profile.counters["cap_hits"]
    if solver != "projection":
        assert (capped > 0) == (solver in STACKING), "32 substeps a second are too few for five boxes"
    # A box that lies in another may have its centre at the floor.
    assert all(box.position.y < 0.1 * SIZE for box in boxes) and all(abs(box.position.x) < 1000.0 for box in boxes)


@needs_speed
@pytest.mark.parametrize("solver", STACKING)
def test_after_steps_of_a_second_ordinary_ones_bring_it_apart(solver):
    world, boxes = pile(solver)
    Watch(world, capped=True, without=("U5", "U6")).step(5, dt=1.0)
    Watch(world, capped=True, without=("U5", "U6")).step(900)
    assert deepest(world) <= 2 * world.tolerances.slop and all(box.position.y < 0.0 for box in boxes)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_ball_falls_as_far_in_steps_of_any_length(solver):
    """A falling body follows y = g (t^2 + sum dt^2) / 2 (semi-implicit Euler) for steps of any lengths."""
    world = World(Effects.rigid_bodies(), solver=solver, gravity=(0, 100))
    ball = world.add_body(Polygon.box(4, 4))
    steps = [1 / 60, 1e-9, 0.5, 1 / 240, 1.0, 0.0, 1 / 60, 5e-324]
    for dt in steps:
        world.step(dt)
    time = sum(steps)
    least, most = 50.0 * time * time, 50.0 * (time * time + sum(dt * dt for dt in steps))
    assert ball.velocity.y == pytest.approx(100 * time) and least <= ball.position.y <= most * (1 + 1e-12)


@pytest.mark.parametrize("dt", [-1e-9, -1.0, math.nan, math.inf, -math.inf, 10**400, "1", None])
@pytest.mark.parametrize("solver", SOLVERS)
def test_what_is_no_length_is_refused_and_changes_nothing(solver, dt):
    """An invalid step length raises an error and changes nothing.

    world.step(None) uses world.dt; setting world.dt to None is an error.
    """
    world, _ = pile(solver)
    hero = Character(world, Polygon.box(8, 16), (200, -8))
    hero.move(1, 1)
    world.step()
    before, time = world.digest(), world.time
    for call in (lambda: world.step(dt), lambda: setattr(world, "dt", dt)):
        if dt is not None or call.__code__.co_names != ("step",):
            with pytest.raises((ValueError, TypeError), match="dt must be .*got"):
                call()
    assert world.digest() == before and world.time == time and world.dt == 1 / 60
