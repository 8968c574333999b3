"""Surfaces that move bodies: kinematic platforms, conveyors and rolling resistance, and the events of such pairs."""

import math

import numpy as np
import pytest

from physics import Capsule, Chain, Circle, Material, Polygon, TileGrid
from tests.stability.invariants import Watch
from tests.stability.piles import SOLVERS, floor, metres, needs_speed, on_slope, pile_effects

G = 10.0
BELT = pile_effects(conveyor=True)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("velocity", [(1.0, 0.0), (-0.7, 0.0), (0.0, 0.5), (0.0, -0.5), (0.6, -0.4)])
def test_platform_carries_what_stands_on_it(solver, velocity):
    world = metres(solver)
    platform = world.add_body(Polygon.box(6, 0.5), position=(0, 0.25), kind="kinematic", velocity=velocity)
    box = world.add_body(Polygon.box(1, 1), position=(0, -0.5), material=Material(friction=0.8))
    top = world.add_body(Polygon.box(0.5, 0.5), position=(0, -1.25), material=Material(friction=0.8))
    Watch(world).step(40)
    lag = [body.position[0] - platform.position[0] for body in (box, top)]
    Watch(world).step(60)
    for body, before in zip((box, top), lag, strict=True):
        assert body.velocity == pytest.approx(velocity, abs=1e-2)
        assert body.position[0] - platform.position[0] == pytest.approx(before, abs=1e-2)
    assert box.position[1] - platform.position[1] == pytest.approx(-0.75, abs=0.01)


@pytest.mark.parametrize("solver", SOLVERS)
def test_turning_platform_takes_its_load_round(solver):
    """A rotating kinematic disc drags a disc on top of it to the right if it turns clockwise on the screen."""
    world = metres(solver)
    world.add_body(
        Circle(2.0), position=(0, 2.0), kind="kinematic", angular_velocity=1.5, material=Material(friction=1.0)
    )
    disc = world.add_body(Circle(0.5), position=(0, -0.5), fixed_rotation=True, material=Material(friction=1.0))
    Watch(world).step(6)
    assert disc.velocity[0] > 0.2, "clockwise on the screen drags what lies on top to the right"


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("ground", ["box", "tiles", "chain"])
def test_belt_brings_a_crate_to_its_speed_at_mu_g(solver, ground):
    world = metres(solver, effects=BELT)
    belt = Material(friction=0.5, surface_speed=2.0)
    shape = {
        "box": Polygon.box(40, 2, (0, 1)),
        "tiles": TileGrid(np.ones((1, 40), bool), 1.0),
        "chain": Chain([(x - 20.0, 0.0) for x in range(41)]),
    }[ground]
    world.add_body(shape, position=(-20.0 if ground == "tiles" else 0.0, 0.0), kind="static", material=belt)
    crate = world.add_body(Polygon.box(1, 1), position=(0, -0.5), material=Material(friction=0.5))
    Watch(world).step(12)
    assert abs(crate.velocity[0]) == pytest.approx(0.5 * G * 0.2, rel=0.03)
    Watch(world).step(60)
    assert abs(crate.velocity[0]) == pytest.approx(2.0, rel=1e-3)
    back = metres(solver, effects=BELT)
    back.add_body(
        shape,
        position=(-20.0 if ground == "tiles" else 0.0, 0.0),
        kind="static",
        material=Material(friction=0.5, surface_speed=-2.0),
    )
    other = back.add_body(Polygon.box(1, 1), position=(0, -0.5), material=Material(friction=0.5))
    Watch(back).step(72)
    assert other.velocity[0] == pytest.approx(-crate.velocity[0], abs=1e-3)


def test_belt_links_have_their_own_speed():
    world = metres(effects=BELT)
    world.add_body(
        Chain([(-20, 0), (0, 0), (20, 0)], materials=(Material(surface_speed=3.0), Material(surface_speed=-3.0))),
        kind="static",
    )
    crates = [
        world.add_body(Polygon.box(1, 1), position=(x, -0.5), material=Material(friction=0.9)) for x in (-15.0, 15.0)
    ]
    Watch(world).step(60)
    left, right = (crate.velocity[0] for crate in crates)
    assert left == pytest.approx(-right, abs=1e-3) and abs(left) == pytest.approx(3.0, rel=0.01)


@pytest.mark.parametrize("solver", [*SOLVERS, "projection"])
def test_rolling_ball_goes_on_for_ever_and_stops_with_resistance(solver):
    for resistance in (0.0, 0.02):
        world = metres(solver, effects=pile_effects(stacking=solver != "projection"))
        floor(world, friction=0.8)
        ball = world.add_body(
            Circle(0.5),
            position=(-30, -0.5),
            velocity=(2.0, 0.0),
            angular_velocity=4.0,
            material=Material(friction=0.8, rolling_resistance=resistance),
        )
        Watch(world, passive=True).step(300)
        if resistance:
            # The torque c r N works against (m r2 / 2) + m r2 about the point of contact: a = c g 2 / 3.
            assert ball.velocity[0] == pytest.approx(2.0 - 5.0 * resistance * G * 2 / 3, rel=0.02)
        else:
            # What remembers nothing rubs a little where it sinks in, in every step.
            assert ball.velocity[0] == pytest.approx(2.0, rel=2e-3 if solver == "projection" else 1e-4)


def test_ball_with_resistance_holds_on_a_gentle_slope():
    """A ball with rolling resistance c rolls on a slope with tan th > c, and stays where tan th < c."""
    moved = {}
    for angle in (0.02, 0.08):
        world = metres()
        floor(world, friction=1.0, angle=angle)
        ball = world.add_body(
            Circle(0.5), position=on_slope(angle, 0.0, 0.5), material=Material(friction=1.0, rolling_resistance=0.05)
        )
        Watch(world, passive=True).step(180)
        moved[angle] = math.dist(ball.position, on_slope(angle, 0.0, 0.5))
    assert moved[0.02] < 0.02 and moved[0.08] > 0.5


# --- events -----------------------------------------------------------------------------------------------------------


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_every_begin_has_exactly_one_end_whatever_is_removed_or_changed(solver):
    """Every begin event has exactly one end event while bodies are added, removed and changed in piles."""
    world = metres(solver, effects=pile_effects(sleeping=True, continuous=True, sensors=True, persist=True))
    floor(world)
    world.add_body(Polygon.box(3, 3), position=(0, -1.5), kind="static", sensor=True)
    rng, open_pairs, sensed, live = np.random.default_rng(6), set(), set(), []
    shapes = (Circle(0.3), Polygon.box(0.6, 0.6), Capsule((-0.3, 0), (0.3, 0), 0.2))
    for step in range(400):
        if step % 4 == 0:
            live.append(world.add_body(shapes[rng.integers(3)], position=tuple(rng.uniform((-4, -6), (4, -4)))))
        choice = rng.integers(0, 30)
        if live and choice == 0:
            world.remove_body(live.pop(rng.integers(len(live))))
        elif live and choice == 1:
            live[rng.integers(len(live))].set_shapes(shapes[rng.integers(3)])
        elif live and choice == 2:
            body = live[rng.integers(len(live))]
            body.set_kind("static" if body.kind == "dynamic" else "dynamic")
        elif live and choice == 3:
            live[rng.integers(len(live))].move_to(tuple(rng.uniform((-4, -6), (4, -1))))
        world.step()
        for pairs, begins, ends in (
            (open_pairs, world.events.begin, world.events.end),
            (sensed, world.events.sensor_begin, world.events.sensor_end),
        ):
            for row in ends:
                pairs.remove((int(row["shape_a"]), int(row["shape_b"])))
            for row in begins:
                key = (int(row["shape_a"]), int(row["shape_b"]))
                assert key not in pairs, f"step {step}: {key} begins twice"
                pairs.add(key)
        known = set(world.shapes["id"].tolist())
        assert all(a in known and b in known for a, b in open_pairs | sensed), (
            f"step {step}: a pair of a shape that is gone is open"
        )
        persisting = {(int(row["shape_a"]), int(row["shape_b"])) for row in world.events.persist}
        assert persisting <= open_pairs
    assert len(open_pairs) > 30
    world.clear()
    world.step()
    for row in world.events.end:
        open_pairs.discard((int(row["shape_a"]), int(row["shape_b"])))
    assert not open_pairs, "clearing ends them all"


@pytest.mark.parametrize("solver", SOLVERS)
def test_hits_tell_the_speed_before_the_solver_and_the_impulse(solver):
    """A box that lands flat causes one hit event with its falling speed and the impulse that stops it."""
    world = metres(solver)
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0, -3.0))
    hits = []
    for _ in range(60):
        world.step()
        hits += [(float(h["speed"]), float(h["normal_impulse"])) for h in world.events.hits]
    assert len(hits) == 1 and hits[0][0] == pytest.approx(math.sqrt(2 * G * 2.5), abs=2 * G / 60)
    assert hits[0][1] == pytest.approx(box.mass * hits[0][0], rel=0.1)
