"""NaN, infinity or 1e308 written into any float of any table that a step reads, between two steps.

The fields are derived from the dtypes. A new field must be covered or listed in poison.WRITTEN_ANEW.
"""

import copy

import numpy as np
import pytest

from game.invariants.bodies import BODY_NUMBERS
from game.invariants.numbers import CONTACT_NUMBERS
from physics import JIT, Circle, Effects, Material, Polygon, World
from tests.stability.faults.poison import (
    KINDS,
    QUIETLY,
    TABLES,
    VALUES,
    WRITTEN_ANEW,
    Scene,
    columns_of,
    fields_of,
    same,
    table_of,
)
from tests.stability.piles import needs_speed

STEPS = 4
FEW = {  # without a compiler: one of each way in
    "bodies": ("angle", "force_x", "inverse_mass", "center_x"),
    "shapes": ("radius",),
    "proxies": ("lower_x",),
    "characters": ("climb",),
    "contact_rows": ("normal_x", "normal_force_1"),
}


@pytest.fixture(scope="module")
def scenes():
    """Return a function scenes(kind) -> (scene, expected bodies).

    The scene is a copy that has made its first steps. The expected bodies are those of the same scene without a fault,
    after STEPS more steps.
    """
    made = {}

    def find(kind):
        if kind not in made:
            scene = Scene(kind)
            later = copy.deepcopy(scene)
            later.steps(STEPS)
            made[kind] = scene, later.world.bodies
        return copy.deepcopy(made[kind][0]), made[kind][1]

    return find


def poisoned(scene, field, value):
    """Write a value into a field and step. Return the ids of the bodies reported as quarantined.

    After every step, all numbers of the other bodies and of the contacts must be finite.
    """
    scene.poison(field, value)
    told = []
    for _ in range(STEPS):
        scene.steps(1)
        world = scene.world
        told += world.events.quarantined["body"].tolist()
        others = ~np.isin(world.bodies["id"], scene.target(field))
        for name in BODY_NUMBERS:
            assert np.isfinite(world.bodies[name][others]).all(), f"{field}: {name} of a neighbour"
        for name in CONTACT_NUMBERS:
            assert np.isfinite(world.contacts[name]).all(), f"{field}: {name} of a contact"
    return told


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("kind", KINDS)
def test_the_poisoned_body_alone_is_put_aside(scenes, kind, table):
    """Only the body with the wrong value is quarantined, and reported once; the other heaps
    move unchanged, to the bit.
    """
    for field in fields_of(scenes(kind)[0].world, table):
        if not JIT and (field.name not in FEW[table] or kind != "soft_step"):
            continue
        for name, value in VALUES.items() if JIT else [("nan", VALUES["nan"]), ("+inf", VALUES["+inf"])]:
            scene, untouched = scenes(kind)
            told = poisoned(scene, field, value)
            anew = field.name in WRITTEN_ANEW[table] or (table, field.name, name) in QUIETLY
            assert told == ([] if anew else scene.target(field)), f"{field} = {name}: {told}"
            assert same(scene.world.bodies, untouched, scene.others()), f"{field} = {name}: another heap"


@needs_speed
@pytest.mark.parametrize("kind", KINDS)
def test_neighbours_of_the_poisoned_go_on_as_if_it_had_been_removed(scenes, kind):
    """The neighbours of a quarantined body move as if it had been removed.

    Every wrong number disables its body before it affects any other.
    """
    removed, _ = scenes(kind)
    removed.world.remove_body(removed.sick)
    removed.steps(STEPS)
    for field in fields_of(scenes(kind)[0].world, "bodies") + fields_of(scenes(kind)[0].world, "shapes"):
        if field.name not in WRITTEN_ANEW[field.table]:
            scene, _ = scenes(kind)
            poisoned(scene, field, np.nan)
            found = scene.world.bodies[scene.world.bodies["id"] != scene.sick]
            assert same(found, removed.world.bodies, slice(None)), field


@needs_speed
@pytest.mark.parametrize("steps", [10, pytest.param(60, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("target", ["ground", "chain", "disc", "mask", "lift"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_body_can_be_poisoned(scenes, kind, target, steps):
    """Wrong values in every kind of body quarantine only this body, also if others stand on it.

    The others fall, and no number that is not finite is reported.
    """
    for table in ("bodies", "shapes"):
        for field in fields_of(scenes(kind)[0].world, table):
            for value in VALUES.values():
                scene, untouched = scenes(kind)
                scene.sick = scene.named[target]
                told = poisoned(scene, field, value)
                assert set(told) <= {scene.sick}, f"{field}: {told}"
                scene.steps(steps)
                assert len(scene.world.events.quarantined) == 0
                assert np.isfinite(scene.world.bodies["x"][scene.world.bodies["id"] != scene.sick]).all()


@pytest.mark.parametrize("kind", KINDS if JIT else ["projection"])
def test_what_stages_share_is_written_before_it_is_read(scenes, kind):
    """NaN written into the workspace between two steps changes nothing.

    The stages of a step share the workspace, and each number in it is written before it is read.
    """
    scene, _ = scenes(kind)
    plain, _ = scenes(kind)
    for _ in range(3):
        assert columns_of(scene.world.workspace, np.nan) > 5
        scene.steps(1), plain.steps(1)
    assert scene.world.digest() == plain.world.digest()


@pytest.mark.parametrize("kind", KINDS if JIT else ["projection"])
def test_questions_before_the_next_step_pass_over_it(scenes, kind):
    """Between the wrong value and the step that reports it, queries skip the bodies without a finite pose."""
    for name in ("x", "y", "angle"):
        for value in (np.nan, np.inf):
            scene, _ = scenes(kind)
            world, body = scene.world, scene.world.body(scene.sick)
            x, y = body.position
            table_of(world, "bodies")[name][world.rows([scene.sick])] = value
            assert scene.sick not in [each.id for each in world.query_aabb((x - 1, y - 1), (x + 1, y + 1))]
            assert scene.sick not in [hit.body.id for hit in world.ray_cast_all((x, y - 40), (0, 80))]
            assert scene.sick not in [each.id for each in world.overlap(Circle(3), (x, y))]
            assert world.closest((x, y))[0].id != scene.sick
            scene.steps(1)
            assert world.events.quarantined["body"].tolist() == [scene.sick]


@pytest.mark.parametrize(
    "given",
    [
        {"mass": 1e308},
        {"mass": 1e-308},
        {"material": Material(friction=1e308)},
        {"material": Material(restitution=1e308)},
        {"material": Material(rolling_resistance=1e308)},
        {"material": Material(density=1e305)},
    ],
    ids=str,
)
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"] if JIT else ["soft_step"])
def test_numbers_that_are_finite_and_of_no_use_reach_nobody(solver, given):
    """A body with an accepted value that overflows in a product is disabled; the body below it stays in place."""
    world = World(Effects.rigid_bodies(), solver=solver)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    below = world.add_body(Polygon.box(10, 10), position=(0, -5))
    sick = world.add_body(Circle(5), position=(0, -15), velocity=(40, 90), **given)
    told = []
    for _ in range(30):
        world.step()
        told += world.events.quarantined["body"].tolist()
        assert np.isfinite(world.bodies["x"]).all() and np.isfinite(world.bodies["angle"]).all()
    assert told == [sick.id] and abs(below.position.x) < 1 and abs(below.position.y + 5) < 1
