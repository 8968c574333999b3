"""Conditions under which islands fall asleep, and all events that wake them."""

import math

import numpy as np
import pytest

from physics import Character, Circle, Material, Polygon, TileGrid, debug
from tests.stability.invariants import Watch, movers
from tests.stability.piles import SLOP, SOLVERS, floor, metres, needs_speed, pile_effects

SLEEPY = pile_effects(sleeping=True, sensors=True)


def bedroom(solver="soft_step", rows=3, ground=None, **changes):
    """Build a small stack that is asleep on a floor. Return (world, floor, boxes).

    ground: function that adds the floor to the world; None for the default floor.
    """
    world = metres(solver, effects=SLEEPY.with_(**changes))
    ground = floor(world) if ground is None else ground(world)
    boxes = [world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 - k)) for k in range(rows)]
    Watch(world, passive=True).step(90)
    assert not any(box.awake for box in boxes), "half a second at rest, and asleep"
    return world, ground, boxes


def awake(boxes):
    return [box.awake for box in boxes]


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stack_falls_asleep_as_one_and_costs_nothing(solver):
    world = metres(solver, effects=SLEEPY)
    floor(world)
    boxes = [world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 - k)) for k in range(4)]
    flags = []
    for _ in range(120):
        world.step()
        flags.append(tuple(awake(boxes)))
    assert flags[0] == (True,) * 4 and flags[-1] == (False,) * 4 and set(flags) == {flags[0], flags[-1]}, "all at once"
    assert flags.index(flags[-1]) >= 29, "not before half a second"
    counters = world.profile.counters
    assert counters["solver_rows"] == counters["bodies_integrated"] == counters["narrow_tests"] == 0
    before = world.bodies[["x", "y", "angle"]].copy()
    for _ in range(60):
        world.step()
        assert len(world.events.begin) == len(world.events.end) == len(world.events.persist) == 0
    assert (world.bodies[["x", "y", "angle"]] == before).all()
    assert (movers(world)["vx"] == 0.0).all() and (movers(world)["vy"] == 0.0).all()


def test_two_piles_are_two_islands_and_sleep_apart():
    world = metres(effects=SLEEPY)
    floor(world)
    left = [world.add_body(Polygon.box(1, 1), position=(-9.0, -0.5 - k)) for k in range(3)]
    right = [world.add_body(Polygon.box(1, 1), position=(9.0, -0.5 - k)) for k in range(3)]
    for _ in range(60):
        right[0].apply_impulse((0.5 if _ % 2 else -0.5, 0.0))
        world.step()
    islands = debug.islands(world)
    rows = world.rows([body.id for body in left + right])
    assert len(set(islands[rows[3:]].tolist())) == 1 and islands[rows[0]] != islands[rows[3]]
    assert awake(left) == [False] * 3 and awake(right) == [True] * 3, "what is shaken keeps its own pile awake"


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_body_that_rolls_below_the_sleeping_speed_falls_asleep(share):
    """A rolling disc falls asleep if its fastest point is slower than 0.05 m/s, but not before half a second."""
    world = metres(effects=SLEEPY)
    floor(world)
    speed = 0.5 * 0.05 * share  # of the centre; the rim moves twice as fast
    disc = world.add_body(Circle(0.5), position=(0.0, -0.5), velocity=(speed, 0.0), angular_velocity=speed / 0.5)
    for _ in range(29):
        world.step()
    assert disc.awake
    for _ in range(61):
        world.step()
    assert disc.awake is (share > 1.0)


def kept_awake(seconds=3.0):
    """Return (world, plank, crate): both rest but stay awake, because a box slides along the frictionless plank."""
    world = metres(effects=SLEEPY)
    floor(world)
    plank = world.add_body(Polygon.box(40, 1), position=(0.0, -0.5), material=Material(friction=0.0))
    world.add_body(Polygon.box(1, 1), position=(-15.0, -1.5), velocity=(5.0, 0.0), material=Material(friction=0.0))
    crate = world.add_body(Polygon.box(1, 1), position=(18.0, -1.5))
    for _ in range(round(seconds / world.dt)):
        world.step()
    assert awake([plank, crate]) == [True, True] and math.hypot(*crate.velocity) < 0.05
    return world, plank, crate


@pytest.mark.parametrize("speed", [0.08, 1.0])
def test_who_lay_long_and_is_shoved_goes_on(speed):
    """A shoved crate restarts its sleep timer and moves on, although the rest of its island is about to sleep."""
    world, plank, crate = kept_awake()
    for body in map(world.body, movers(world)["id"].tolist()):
        body.velocity = (0.0, 0.0)
    for _ in range(28):
        world.step()
    crate.velocity = (speed, 0.0)
    for _ in range(10):
        world.step()
    assert crate.awake and crate.velocity.x == pytest.approx(speed, abs=1e-6)


def test_who_lay_long_and_loses_its_ground_falls():
    world, plank, crate = kept_awake()
    plank.remove()
    speeds = []
    for _ in range(20):
        world.step()
        speeds.append(crate.velocity.y)
    assert speeds == pytest.approx([world.gravity.y * world.dt * (k + 1) for k in range(20)], abs=1e-6)


def test_undeclared_sleeping_never_sleeps():
    world = metres()
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5))
    Watch(world).step(120)
    assert box.awake and len(world.contacts) > 0


# --- what wakes -------------------------------------------------------------------------------------------------------


def knock(world, ground, boxes):
    world.add_body(Circle(0.3), position=(-3.0, -1.5), velocity=(30.0, 0.0))
    return 10


def shoot(world, ground, boxes):
    world.add_body(
        Circle(0.1), position=(-50.0, -1.5), velocity=(400.0, 0.0), bullet=True, material=Material(density=10.0)
    )
    return 14


def lay_down(world, ground, boxes):
    world.add_body(Polygon.box(1, 1), position=(0.0, -0.49 - len(boxes)))
    return 2


def take_the_floor(world, ground, boxes):
    world.remove_body(ground)
    return 1


def move_the_floor(world, ground, boxes):
    ground.move_to((0.0, 3.0))
    return 1


def take_a_box(world, ground, boxes):
    world.remove_body(boxes.pop(0))
    return 1


def turn_gravity(world, ground, boxes):
    world.gravity = (3.0, 10.0)
    return 1


def reshape_the_floor(world, ground, boxes):
    ground.set_shapes(Polygon.box(200.0, 1.0, center=(0.0, 2.5)))
    return 1


def reshape_a_box(world, ground, boxes):
    boxes[0].set_shapes(Polygon.box(0.8, 0.8))
    return 1


def carry_off(world, ground, boxes):
    boxes[0].move_to((40.0, -0.5))
    return 1


def rise(world, ground, boxes):
    world.add_body(Polygon.box(1, 1), position=(-1.4, -0.6), kind="kinematic", velocity=(3.0, 0.0))
    return 20


WAKERS = {
    "contact": knock,
    "bullet": shoot,
    "laid on top": lay_down,
    "support removed": take_the_floor,
    "support moved": move_the_floor,
    "box removed": take_a_box,
    "gravity": turn_gravity,
    "support reshaped": reshape_the_floor,
    "reshaped": reshape_a_box,
    "moved": carry_off,
    "kinematic": rise,
    "impulse": lambda world, ground, boxes: boxes[1].apply_impulse((0.2, 0.0)) or 1,
    "force": lambda world, ground, boxes: boxes[1].apply_force((5.0, 0.0)) or 1,
    "torque": lambda world, ground, boxes: boxes[1].apply_torque(5.0) or 1,
    "velocity": lambda world, ground, boxes: setattr(boxes[1], "velocity", (1.0, 0.0)) or 1,
    "spin": lambda world, ground, boxes: setattr(boxes[1], "angular_velocity", 1.0) or 1,
    "gravity scale": lambda world, ground, boxes: setattr(boxes[1], "gravity_scale", -1.0) or 1,
    "support falls": lambda world, ground, boxes: ground.set_kind("dynamic") or 1,
    "kind": lambda world, ground, boxes: boxes[1].set_kind("kinematic") or 1,
    "wake": lambda world, ground, boxes: boxes[1].wake() or 0,
}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("wake", WAKERS)
def test_everything_that_should_wake_a_stack_wakes_all_of_it(wake, solver):
    world, ground, boxes = bedroom(solver, continuous=True)
    steps = WAKERS[wake](world, ground, boxes)
    seen = np.zeros(len(boxes), bool)
    seen |= [box.awake or box.kind != "dynamic" for box in boxes]
    watch = Watch(world)
    for _ in range(steps):
        watch.step()
        seen |= [box.awake or box.kind != "dynamic" for box in boxes]
    assert seen.all(), f"asleep: {seen}"


@pytest.mark.parametrize(
    "what", ["add far away", "ray", "overlap", "filter far away", "solver", "snapshot", "another pile"]
)
def test_what_does_not_concern_it_lets_a_stack_sleep(what):
    world, ground, boxes = bedroom()
    other = world.add_body(Circle(0.2), position=(30.0, -0.2))
    if what == "ray":
        world.ray_cast((-5, -1), (10, 0))
    elif what == "overlap":
        world.overlap(Circle(5.0), (0.0, 0.0, 0.0))
    elif what == "solver":
        world.substeps = 8
    elif what == "snapshot":
        world.restore(world.snapshot())
    elif what == "another pile":
        other.apply_impulse((0.1, 0.0))
    Watch(world).step(20)
    assert awake(boxes) == [False] * 3


def test_tiles_that_vanish_wake_what_stood_on_them():
    def ground(world):
        return world.add_body(TileGrid(np.ones((2, 8), bool), 1.0), position=(-4.0, 0.0), kind="static")

    world, tiles, boxes = bedroom(ground=ground)
    solid = np.ones((2, 8), bool)
    solid[:, 3:5] = False
    tiles.set_shapes(TileGrid(solid, 1.0))
    Watch(world).step(60)
    assert boxes[0].position[1] > 0.5, "it fell into the gap"


def test_contact_events_pair_up_over_sleep():
    world, ground, boxes = bedroom()
    open_pairs = {(0, 1), (1, 2), (2, 3)}
    boxes[2].apply_impulse((0.0, -6.0))
    for _ in range(120):
        world.step()
        for end in world.events.end:
            open_pairs.remove((end["body_a"], end["body_b"]))
        for begin in world.events.begin:
            pair = (begin["body_a"], begin["body_b"])
            assert pair not in open_pairs
            open_pairs.add(pair)
    assert open_pairs == {(0, 1), (1, 2), (2, 3)}


@needs_speed
def test_row_of_sleepers_wakes_box_by_box_as_the_bullet_comes():
    world = metres(effects=SLEEPY.with_(continuous=True))
    floor(world, width=400.0)
    boxes = [world.add_body(Polygon.box(1, 1), position=(1.5 * k, -0.5)) for k in range(8)]
    Watch(world).step(90)
    assert not any(awake(boxes))
    world.add_body(
        Circle(0.2), position=(-10.0, -0.5), velocity=(120.0, 0.0), bullet=True, material=Material(density=4.0)
    )
    watch = Watch(world)
    for _ in range(60):
        watch.step()
        moved = [abs(box.position[0] - 1.5 * k) > SLOP for k, box in enumerate(boxes)]
        assert all(box.awake for box, gone in zip(boxes, moved, strict=True) if gone)
    assert moved[0]
    watch.step(400)
    assert not any(awake(boxes))


@needs_speed
def test_character_that_stands_on_a_sleeping_stack_stands_still():
    world = metres(effects=pile_effects(sleeping=True), pixels_per_meter=32.0, gravity=(0, 320))
    world.add_body(Polygon.box(600, 32), position=(0, 16), kind="static")
    boxes = [world.add_body(Polygon.box(32, 32), position=(0, -16 - 32 * k)) for k in range(3)]
    Watch(world, passive=True).step(90)
    hero = Character(world, Polygon.box(16, 24), (0, -96 - 12))
    for _ in range(30):
        moved = hero.move(0.0, 2.0)
        world.step()
    assert moved.grounded and abs(hero.position[1] + 108) <= 1 and abs(boxes[2].position[0]) < 0.2


@needs_speed
def test_all_asleep_is_no_work():
    """A world in which all bodies sleep does no work, by its counters.

    The benchmark `python -m tests.bench solvers` measures the time.
    """
    world = metres(effects=SLEEPY)
    floor(world, width=400.0)
    world.add_bodies(Polygon.box(1, 1), [(1.5 * k - 150.0, -0.5) for k in range(200)])
    for _ in range(90):
        world.step()
    counters = world.profile.counters
    assert not movers(world)["awake"].any()
    assert {
        counters[name]
        for name in (
            "bodies_integrated",
            "narrow_tests",
            "solver_rows",
            "tangent_rows",
            "restitution_rows",
            "toi_calls",
            "islands",
        )
    } == {0}
