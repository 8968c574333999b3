"""Settings without their effect and unknown attributes raise errors; `restitution_speed` is the
threshold of bounces.
"""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, Material, PixelMask, Polygon, Snapshot, TileGrid, World

RESPONSE = Effects(response=True)
OPEN = np.ones((2, 2), bool)


@pytest.mark.parametrize("name, value, helps", [
    ("gravity", (0, 100), ("gravity",)),
    ("gravity", (-1e-9, 0), ("gravity",)),
    ("drag", 0.5, ("drag", "wind")),  # wind acts through drag
    ("wind", (10, 0), ("wind",)),
])  # fmt: skip
def test_a_force_field_needs_its_effect(name, value, helps):
    with pytest.raises(ValueError, match=f"{name}=.* needs the effect {name}"):
        World(RESPONSE, **{name: value})
    world = World(RESPONSE)
    before = world.digest()
    with pytest.raises(ValueError, match=f"{name}=.* needs the effect {name}"):
        setattr(world, name, value)
    assert world.digest() == before
    for each in helps:
        setattr(World(RESPONSE.with_(**{each: True}), **{name: value}), name, value)


@pytest.mark.parametrize("name, value", [("gravity", (0, 0)), ("gravity", None), ("drag", 0.0), ("wind", (0, 0))])
def test_none_of_a_field_needs_no_effect(name, value):
    world = World(Effects(), **{name: value})
    if value is not None:
        setattr(world, name, value)


def test_values_of_dropped_effects_stay_and_come_back_with_snapshots():
    full = Effects(response=True, gravity=True, drag=True, wind=True)
    world = World(full, gravity=(0, 7), drag=0.5, wind=(3, 0))
    world.set_effects(RESPONSE)
    assert (world.gravity, world.drag, world.wind) == ((0, 7), 0.5, (3, 0))
    other = World(RESPONSE)
    other.restore(world.snapshot())
    assert (other.gravity, other.drag, other.wind) == ((0, 7), 0.5, (3, 0))


@pytest.mark.parametrize("shape", [
    TileGrid(~OPEN, 8, one_way=OPEN), PixelMask(OPEN, one_way=True), Circle(3),
])  # fmt: skip
def test_what_is_open_from_below_needs_one_way(shape):
    world = World(RESPONSE)
    if isinstance(shape, Circle):
        world.add_body(shape)
        return
    body = world.add_body(Circle(3), kind="static")
    for wrong in (
        lambda: world.add_body(shape, kind="static"),
        lambda: world.add_bodies(shape, [(0, 0)], kind="static"),
        lambda: body.set_shapes(shape),
        lambda: body.add_shape(shape),
    ):
        with pytest.raises(ValueError, match=f"{type(shape).__name__} with one_way needs the effect one_way"):
            wrong()
    assert len(world) == len(world.shapes) == 1
    World(RESPONSE.with_(one_way=True)).add_body(shape, kind="static")


@pytest.mark.parametrize("name, near", [
    ("gravty", "gravity"), ("restitution_spee", "restitution_speed"), ("Gravity", "gravity"), ("substep", "substeps"),
    ("broad_phase", "broadphase"), ("qqq", ""),
])  # fmt: skip
def test_an_unknown_attribute_of_a_world_is_refused(name, near):
    message = f"World has no attribute {name}" + (f": did you mean {near}\\?" if near else "$")
    with pytest.raises(AttributeError, match=message):
        setattr(World(), name, 1.0)


@pytest.mark.parametrize("name, near", [("velocty", "velocity"), ("pos", "position"), ("angel", "angle"), ("qqq", "")])
def test_an_unknown_attribute_of_a_body_is_refused(name, near):
    body = World().add_body(Circle(3))
    with pytest.raises(AttributeError, match=f"Body has no attribute {name}"):
        setattr(body, name, 1.0)
    with pytest.raises(AttributeError):
        body.mass = 3.0  # it cannot be set
    body.velocity = (1, 2)
    assert body.velocity == (1, 2)


def test_a_subclass_may_have_attributes_of_its_own():
    class Mine(World):
        def __init__(self):
            super().__init__()
            self.score = 3

    world = Mine()
    assert world.score == 3
    with pytest.raises(AttributeError, match="gravity"):
        world.gravty = (0, 1)


# ---- restitution_speed -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1.0, 32.0])
def test_restitution_speed_is_a_setting_in_pixels(scale):
    world = World(pixels_per_meter=scale)
    assert world.restitution_speed == scale == world.tolerances.restitution_speed
    world = World(pixels_per_meter=scale, restitution_speed=5)
    for value in (5.0, 0.0, 12.5):
        world.restitution_speed = value
        told = world.tolerances
        assert world.restitution_speed == told.restitution_speed == value
    world.restitution_speed = None
    assert world.restitution_speed == scale
    assert World(pixels_per_meter=scale).tolerances == world.tolerances


@pytest.mark.parametrize("value, error", [
    (-1, ValueError), (float("nan"), ValueError), (float("inf"), ValueError), ("1", TypeError), (True, TypeError),
])  # fmt: skip
def test_restitution_speed_is_finite_and_not_negative(value, error):
    world = World()
    for wrong in (lambda: World(restitution_speed=value), lambda: setattr(world, "restitution_speed", value)):
        with pytest.raises(error, match="restitution_speed must be"):
            wrong()
    assert world.restitution_speed == 32.0


def test_restitution_speed_comes_back_with_a_snapshot(tmp_path):
    world = World(restitution_speed=3.0)
    assert world.digest() != World().digest() == World(restitution_speed=32.0).digest()
    world.snapshot().save(tmp_path / "world.npz")
    for taken in (world.snapshot(), Snapshot.load(tmp_path / "world.npz")):
        other = World()
        other.restore(taken)
        assert other.restitution_speed == 3.0 and other.digest() == world.digest()


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
@pytest.mark.parametrize("speed, bounces", [(100.0, False), (5.0, True)])
def test_it_decides_which_impact_bounces_under_a_pressing_acceleration(speed, bounces, solver):
    effects = Effects(response=True, restitution=True, gravity=True, stacking=solver != "projection")
    world = World(effects, solver=solver, gravity=(60, 0), restitution_speed=speed)
    elastic = Material(restitution=1.0)
    world.add_body(Circle(10), position=(40, 0), kind="static", material=elastic)
    ball = world.add_body(Circle(5), velocity=(50, 0), material=elastic)
    slowest = 0.0
    for _ in range(60):
        world.step()
        slowest = min(slowest, ball.velocity.x)
    assert (slowest < -40) is bounces


PRESSES = {  # gravity, wind, force on the ball, whether it presses the ball to a wall at its right
    "nothing": ((0, 0), (0, 0), (0, 0), False),
    "gravity along the wall": ((0, 50), (0, 0), (0, 0), False),
    "gravity into the wall": ((5, 0), (0, 0), (0, 0), True),
    "gravity out of the wall": ((-0.01, 0), (0, 0), (0, 0), False),
    "wind": ((0, 0), (5, 0), (0, 0), True),
    "a force": ((0, 0), (0, 0), (3000, 0), True),
}


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
@pytest.mark.parametrize("name", PRESSES)
@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_a_new_contact_bounces_at_any_speed_where_no_acceleration_presses_it(solver, name, angle):
    """A new contact bounces at any speed if no acceleration presses it.

    The whole scene is rotated by an angle: a component of gravity that is only rounding does not count as pressing.
    """
    gravity, wind, force, presses = PRESSES[name]

    def turned(x, y):
        return math.cos(angle) * x - math.sin(angle) * y, math.sin(angle) * x + math.cos(angle) * y

    effects = Effects(response=True, restitution=True, gravity=True, wind=True, stacking=solver != "projection")
    for speed in (0.5, 4.0, 20.0, 31.0) if JIT else (20.0,):
        world = World(effects, solver=solver, gravity=turned(*gravity), wind=turned(*wind), drag=1.0)
        elastic = Material(restitution=1.0)
        wall = Polygon.box(20, 400).points
        world.add_body(Polygon([turned(x + 19, y) for x, y in wall]), kind="static", material=elastic)
        ball = world.add_body(Circle(8), velocity=turned(speed, 0), material=elastic)
        back = 0.0
        for _ in range(round(150 / speed)):
            if force[0]:
                ball.apply_force(turned(*force))
            world.step()
            back = min(back, ball.velocity.x * math.cos(angle) + ball.velocity.y * math.sin(angle))
        assert back == (pytest.approx(0.0, abs=0.05) if presses else pytest.approx(-speed, rel=0.1))


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_a_contact_that_touched_bounces_only_beyond_the_threshold(solver):
    """An existing contact bounces only above the threshold.

    A kinematic block that starts at 20 px/s moves its crate along; at 100 px/s it hits the crate away.
    """
    for speed, bounces in ((20.0, False), (100.0, True)):
        world = World(gravity=(0, 0), solver=solver)
        elastic = Material(restitution=1.0)
        block = world.add_body(Polygon.box(20, 20), kind="kinematic", material=elastic)
        crate = world.add_body(Polygon.box(20, 20), position=(20, 0), material=elastic)
        world.step()
        block.velocity = (speed, 0)
        for _ in range(10):
            world.step()
        assert crate.velocity.x == pytest.approx(2 * speed if bounces else speed, rel=1e-3)
