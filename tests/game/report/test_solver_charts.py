"""Charts 4 and 9: solvers with other combinations of methods, piles to compare them, and rounded poses."""

import json
from pathlib import Path

import numpy as np
import pytest

from game.measure import studied_solvers as studied
from game.report.charts.broadphases import growth
from game.report.charts.far import round_poses
from game.report.charts.solver_parts import SEQUENTIAL, SOFT, WAYS, Parts, Studied, at_equal_time, claims
from game.report.claim import FAILS, HOLDS, TIE
from game.report.piles import PILES, energy, overlap, pyramid, stack, sunk, world_of
from game.report.standing import Watch
from physics import Circle, Material, Polygon, World


def run(parts, pile, steps=30):
    world = world_of(pile, parts.solver, parts.substeps)
    way = Studied(parts, world)
    for _ in range(steps):
        way.step()
    return world


@pytest.mark.parametrize(
    "parts, substeps", [(Parts(SOFT, 4, 1), 4), (Parts(SEQUENTIAL, 1, 10), 4)], ids=lambda each: str(each)
)
def test_put_together_as_usual_it_is_the_solver(parts, substeps):
    made = pyramid(4)
    usual = world_of(made, parts.solver, substeps)
    for _ in range(30):
        usual.step()
    assert np.array_equal(run(parts, made).bodies["y"], usual.bodies["y"])
    assert np.array_equal(run(parts, made).contact_rows["normal_impulse_1"], usual.contact_rows["normal_impulse_1"])


@pytest.mark.parametrize(
    "better, worse",
    [
        (Parts(SOFT, 8, 1), Parts(SOFT, 2, 1)),
        (Parts(SEQUENTIAL, 1, 16), Parts(SEQUENTIAL, 1, 4)),
        (Parts(SEQUENTIAL, 4, 4), Parts(SEQUENTIAL, 1, 4)),
        (Parts(SOFT, 4, 1), Parts(SOFT, 4, 1, warm=False)),
        (Parts(SEQUENTIAL, 1, 8), Parts(SEQUENTIAL, 1, 8, warm=False)),
    ],
)
def test_each_part_is_worth_something(better, worse):
    made = stack(6)
    errors = [max(overlap(world), sunk(world, made)) for world in (run(better, made), run(worse, made))]
    assert 0.0 < 1.5 * errors[0] < errors[1]


def test_one_that_does_not_relax_rubs_all_the_same():
    def slid(stage, friction):
        world = World(world_of(stack(1), SOFT, 4).effects, gravity=(100.0, 300.0), solver=SOFT, substeps=4)
        material = Material(friction=friction)
        made = stack(1)
        world.add_body(Polygon.box(400.0, 200.0), position=(0.0, 100.0), kind="static", material=material)
        world.add_body(made.shapes[0], position=(0.0, -16.0), material=material)
        way = Studied(Parts(SOFT, 4, 1, relaxed=stage), world)
        for _ in range(30):
            way.step()
        return float(world.bodies["x"][1])

    assert abs(slid(False, 0.6)) < 0.5 < 5.0 < slid(False, 0.0)
    with pytest.raises(ValueError, match="counted once"):
        studied.soft_step(2, relaxed=False)


def test_all_ways_are_named_apart():
    labels = [(way.series, way.substeps, way.iterations) for way in WAYS]
    assert len(set(labels)) == len(labels)
    assert {way.iterations for way in WAYS if way.solver == SOFT} == {1, 2, 4, 8}
    assert {way.substeps for way in WAYS if way.solver == SOFT} == {1, 2, 4, 8, 16, 32}


def family(*points):
    """Return rows of a family of settings. points: (time [us], error [px])."""
    return [{"error": error, "cost": {"seconds": [1e-6 * us] * 3}} for us, error in points]


EIGHT_STEPS = family((39, 1.74), (289, 0.0894))  # 1 x 1 and 8 x 1 of a stack of 10, sequential_impulse
ITERATIONS = family((39, 1.74), (40, 0.459), (45, 0.14), (60, 0.09))


@pytest.mark.parametrize(
    "small, many, verdict, figure",
    [
        (EIGHT_STEPS, ITERATIONS, FAILS, "more at 40 to 60 us"),
        (ITERATIONS, EIGHT_STEPS, HOLDS, "less at 40 to 60 us"),
        (family((40, 1.0), (80, 0.1)), family((40, 1.0), (80, 0.105)), TIE, "cannot be told apart"),
        (family((40, 1.0), (80, 0.001)), family((40, 1.0), (80, 0.009)), TIE, "cannot be told apart"),
        (family((40, 1.0), (80, 0.5)), family((40, 1.0), (83, 0.5)), TIE, "cannot be told apart"),
        (family((40, 0.1)), family((50, 1.0), (200, 0.01)), TIE, "less at 50"),
        (family((40, 90.0), (50, 0.2)), family((40, 80.0), (60, 60.0)), HOLDS, "(0.2 px against fallen)"),
    ],
)
def test_families_are_compared_in_equal_time_over_all_their_points(small, many, verdict, figure):
    claim = at_equal_time("", small, many, "")
    assert claim.verdict == verdict and figure in claim.figure, claim.figure


@pytest.mark.parametrize("pile", [pile for pile in PILES if pile != "ten in each other"])
def test_divided_steps_of_sequential_impulses_are_not_praised_for_seven_times_the_time(pile):
    """On the kept rows, many iterations reach in a fraction of the time the error that eight divided steps have."""
    rows = json.loads((Path(__file__).resolve().parents[3] / "docs/accuracy.json").read_text("utf-8"))["rows"][
        "solvers"
    ]
    (claim,) = [each for each in claims(rows) if each.text.startswith(f"{pile}, {SEQUENTIAL}: in equal time small")]
    assert claim.verdict == FAILS and claim.figure.startswith("more at "), claim


@pytest.mark.parametrize("name", ["10:1", "card house", "ten in each other"])
def test_piles_are_what_they_are_called(name):
    made = PILES[name]()
    world = world_of(made, SOFT, "auto")
    assert len(world.bodies) == 1 + len(made.places) and sunk(world, made) == pytest.approx(0.0)
    watch = Watch(world, made)
    world.step()
    watch.look()
    assert (overlap(world) > 5.0) == (name == "ten in each other")
    for _ in range(29):
        world.step()
        watch.look()
    found = watch.found()
    assert found["stands_s"] is None and sunk(world, made) < 2.0
    assert (found["off"] is None) == (name == "ten in each other")


def test_who_jumps_does_not_stand():
    made = stack(2)
    world = world_of(made, SOFT, 4)
    watch = Watch(world, made)
    world.bodies["vy"][2] = -60.0
    for _ in range(20):
        world.step()
        watch.look()
    found = watch.found()
    assert found["error"] == found["off"] > 4.0 and found["overlap"] < 1.0 and found["won"] > 0.0


def test_who_is_let_fall_wins_no_energy_and_is_seen_to_fall():
    made = stack(1)
    world = world_of(made, SOFT, 4)
    world.bodies["y"][1] = -200.0
    world.touch(world.bodies["id"])
    start = energy(world)
    assert start == pytest.approx(200.0 * 320.0 * world.bodies["mass"][1])
    watch = Watch(world, made)
    made.places[0] = (0.0, -200.0)
    for _ in range(60):
        world.step()
        watch.look()
    found = watch.found()
    assert found["won"] < 1e-3 and 0.2 < found["stands_s"] < 0.4 and found["off"] == pytest.approx(0.5 * 320.0)


def test_rounded_poses_are_those_of_a_float32():
    world = World()
    body = world.add_body(Circle(3.0), position=(1e6 + 0.3, 2.1))
    round_poses(world)
    assert body.position == (float(np.float32(1e6 + 0.3)), float(np.float32(2.1)))
    assert world.bodies["center_x"][0] == world.bodies["x"][0]


def test_a_line_through_two_sizes_is_no_fit():
    def rows(sizes):
        return [{"series": "s", "panel": "p", "n": n, "cost": {"seconds": [n, n**2.0, n]}} for n in sizes]

    assert growth(rows((10, 100, 1000)), "s", "p") is None
    found = growth(rows((10, 100, 300, 1000)), "s", "p")
    assert found is not None
    power, unsure = found
    assert power == pytest.approx(2.0) and unsure < 1e-9
