"""Substeps that follow the load of each island ("auto"): no contact sinks by more than the accuracy.

The result of an island does not depend on other islands.
"""

import math

import numpy as np
import pytest

from physics import Circle, Material, Polygon, World
from tests.stability.invariants import Watch, deepest
from tests.stability.piles import SOLVERS as STACKING
from tests.stability.piles import floor, metres, needs_speed, pile_effects, pyramid

MILLIMETRE = 0.001


def heap(world, boxes, x=0.0, density=1.0, top=None):
    """Add a column of unit boxes on the floor at x and return the bodies. top: density of the highest box (None: as the
    others).
    """
    return [
        world.add_body(
            Polygon.box(1, 1),
            position=(x, -0.5 - k),
            material=Material(density=top if top and k == boxes - 1 else density, friction=0.6),
        )
        for k in range(boxes)
    ]


def asked(world, *bodies):
    """Return the greatest number of substeps among some bodies."""
    return max(int(world.bodies["substeps"][world.rows(each.id)]) for each in bodies)


@pytest.mark.parametrize("boxes", [1, 5, 12])
def test_no_contact_of_a_column_sinks_further_than_a_millimetre(boxes):
    """No contact of a column sinks by more than a millimetre; with a fixed number of three substeps contacts do."""
    world = metres(substeps="auto")
    floor(world)
    heap(world, boxes)
    for _ in range(120):
        world.step()
        assert deepest(world) <= MILLIMETRE
    soft = metres(substeps=3)
    floor(soft)
    heap(soft, boxes)
    Watch(soft).step(120)
    assert boxes == 1 or deepest(soft) > MILLIMETRE


@needs_speed
def test_a_pyramid_of_twenty_rows_and_the_accuracy_that_is_asked_for():
    found = {}
    for accuracy in (None, 0.01):
        world = metres(substeps="auto", accuracy=accuracy)
        floor(world)
        pyramid(world, 20)
        Watch(world).step(120)
        found[accuracy] = int(world.bodies["substeps"][1:].max())
        assert deepest(world) <= world.accuracy
    assert found[0.01] < found[None]


def test_who_bears_little_takes_few_once_that_is_known():
    """A lightly loaded box starts with 32 substeps and halves the number every quarter of a second, down to four.

    Within a quarter of a second the load of an impact decays.
    """
    world = metres(substeps="auto")
    floor(world)
    box = heap(world, 1)[0]
    taken = []
    assert asked(world, box) == 0, "nobody knows"
    for _ in range(60):
        world.step()
        taken.append(asked(world, box))
    assert [taken[k] for k in (0, 13, 16, 30, 33, 45, 49, 58)] == [32, 32, 16, 16, 8, 8, 4, 4]
    ball = world.add_body(Circle(0.5), position=(5.0, -8.0))
    world.step(0.1)
    assert asked(world, ball) == 4, "what nothing touches takes the fewest"


@needs_speed
def test_a_column_takes_the_most_until_its_load_has_come_down():
    """A column takes the most substeps (128) until its load has reached the ground, then as few as the load needs.

    Bodies beside it are not affected.
    """
    world = metres(substeps="auto")
    floor(world)
    column, box = heap(world, 8), heap(world, 1, x=10.0)
    wall = [
        world.add_body(Polygon.box(1, 1), position=(x + 0.5 * (row % 2), -0.5 - row), material=Material(friction=0.6))
        for row in range(3)
        for x in range(30, 36)
    ]
    world.step()
    assert (asked(world, *column), asked(world, *box), asked(world, *wall)) == (128, 32, 32)
    for _ in range(120):
        world.step()
    assert asked(world, *column) <= 16 and asked(world, *box) == 4


@needs_speed
@pytest.mark.parametrize("share", [0.5, 0.95])
def test_what_leans_near_its_edge_takes_more_than_a_load_may(share):
    world = metres(substeps="auto")
    floor(world)
    places = [share / 20 * k for k in range(20)]
    column = [
        world.add_body(Polygon.box(1, 1), position=(x, -0.5 - k), material=Material(friction=0.6))
        for k, x in enumerate(places)
    ]
    for _ in range(240):
        world.step()
    assert (asked(world, *column) > 32) == (share == 0.95)
    assert max(abs(body.angle) for body in column) < 0.01 and world.profile.counters["cap_hits"] == 0


def test_what_lands_on_something_light_is_expected():
    """A heavy box that lands on a light sleeping one raises the substeps in the first step of the impact.

    The estimate includes the momentum of the heavy box.
    """
    world = metres(substeps="auto")
    floor(world)
    light = heap(world, 1)[0]
    Watch(world).step(60)
    assert asked(world, light) == 4
    world.add_body(Polygon.box(1, 1), position=(0.0, -1.6), velocity=(0.0, 12.0), material=Material(density=100.0))
    world.step()
    assert asked(world, light) == 32
    for _ in range(20):  # it rebounds, and lands again later
        world.step()
        assert deepest(world) <= 0.005


@pytest.mark.parametrize("first", ["column", "box"])
def test_no_island_feels_another(first):
    """The motion of an island does not depend on other islands, to the bit, in either order of creation."""

    def alone(which):
        world = metres(substeps="auto")
        floor(world)
        return world, build[which](world)

    def poses(world, bodies):
        rows = world.bodies[world.rows(np.array([each.id for each in bodies]))]
        return [rows[name].tolist() for name in ("x", "y", "angle", "vx", "vy", "angular_velocity")]

    build = {
        "column": lambda world: heap(world, 8),
        "box": lambda world: [world.add_body(Polygon.box(1, 1), position=(20.0, -1.5), angle=0.2, velocity=(1.0, 0.0))],
    }
    second = "box" if first == "column" else "column"
    world = metres(substeps="auto")
    floor(world)
    both = {which: build[which](world) for which in (first, second)}
    apart = {which: alone(which) for which in both}
    classes = set()
    for _ in range(90):
        world.step()
        classes.add((asked(world, *both["column"]), asked(world, *both["box"])))
        for which, (own, bodies) in apart.items():
            own.step()
            assert poses(world, both[which]) == poses(own, bodies)
    assert any(column != box for column, box in classes), "the test has teeth"


def test_islands_share_what_moves_by_hand():
    """A rotating kinematic plate that supports two islands moves as a function of time only.

    It carries a column and, metres away, a light box.
    """
    world = metres(substeps="auto")
    plate = world.add_body(
        Polygon.box(40, 1), position=(0.0, 0.5), kind="kinematic", velocity=(0.5, 0.0), angular_velocity=0.05
    )
    column = heap(world, 6, x=-2.0)
    light = world.add_body(Polygon.box(1, 0.2), position=(15.0, -0.1))
    for n in range(1, 61):
        world.step()
        assert plate.position.x == pytest.approx(0.5 * n / 60, rel=1e-12)
        assert plate.angle == pytest.approx(0.05 * n / 60, rel=1e-12)
        assert deepest(world) <= 2 * MILLIMETRE
    assert asked(world, *column) > asked(world, light) or asked(world, light) == 4


@needs_speed
def test_what_32_cannot_reach_is_counted():
    """A resting load of a thousand to one, too much for 32 substeps, is counted in `cap_hits`;
    a ball's impact is not.
    """
    world = metres(substeps="auto")
    floor(world)
    heap(world, 2, top=1000.0)
    world.add_body(Circle(0.5), position=(20.0, -3.0), velocity=(0.0, 9.0))
    counted = []
    for _ in range(90):
        world.step()
        counted.append(world.profile.counters["cap_hits"])
    assert counted[:15] == [0] * 15 and counted[-30:] == [1] * 30
    assert deepest(world) <= 0.006


@needs_speed
@pytest.mark.parametrize("solver", STACKING)
@pytest.mark.parametrize("top, least, most", [(0.01, 4, 4), (1.0, 4, 4), (100.0, 16, 64), (1000.0, 32, 64)])
def test_substeps_and_passes_follow_the_load(top, least, most, solver):
    """The substeps of bodies in a column follow the load; for sequential impulses they are solver passes instead."""
    world = metres(solver, substeps="auto")
    floor(world)
    heap(world, 3, top=top)
    for _ in range(120):
        world.step()
    assert all(least <= found <= most for found in world.bodies["substeps"][1:].tolist())


@needs_speed
def test_snapshots_go_on_to_the_bit():
    """A restored snapshot repeats 600 steps to the bit, with face contacts and with islands at 32 substeps."""

    def made():
        world = World(pile_effects(sleeping=True), gravity=(0, 10), pixels_per_meter=1.0)
        floor(world)
        heap(world, 12)
        heap(world, 3, x=8.0, top=500.0)
        pyramid(world, 6, x=-20.0)
        for k in range(6):
            world.add_body(Circle(0.4), position=(20.0 + 0.3 * k, -1.0 - k), velocity=(-3.0, 0.0))
        return world

    world = made()
    Watch(world, capped=True).step(40)
    assert 32 in world.bodies["substeps"][1:]
    taken, digests = world.snapshot(), []
    for _ in range(2):
        for n in range(600):
            world.step()
            if n % 100 == 99:
                digests.append(world.digest())
        world.restore(taken)
    assert digests[:6] == digests[6:]
    other = made()
    other.restore(taken)
    for _ in range(100):
        other.step()
    assert other.digest() == digests[0]


@pytest.mark.parametrize("value", ["many", "", 0, -1, 1.5, None, True, math.nan])
def test_substeps_that_are_none(value):
    with pytest.raises((TypeError, ValueError), match="substeps"):
        World(substeps=value)
    world = World()
    with pytest.raises((TypeError, ValueError), match="substeps"):
        world.substeps = value
    assert world.substeps == "auto"


@pytest.mark.parametrize("value", [0, -1.0, math.nan, math.inf, "fine", True])
def test_accuracies_that_are_none(value):
    with pytest.raises((TypeError, ValueError), match="accuracy"):
        World(accuracy=value)
    world = World(accuracy=0.5)
    with pytest.raises((TypeError, ValueError), match="accuracy"):
        world.accuracy = value
    assert world.accuracy == 0.5


def test_the_accuracy_is_a_millimetre_of_the_world_unless_it_is_given():
    world = World(pixels_per_meter=50.0)
    assert (world.substeps, world.accuracy) == ("auto", pytest.approx(0.05))
    before = world.digest()
    world.accuracy = 0.2
    assert world.accuracy == 0.2 and world.digest() != before
    world.accuracy = None
    assert world.accuracy == pytest.approx(0.05) and world.digest() == before
    world.substeps = 7
    assert world.substeps == 7 and World(substeps=7).substeps == 7
