"""`world.ignored_effects` names the declared effects that the solver ignores; each effect is removed to find out.

Removing an effect that the solver uses changes its scene; removing an ignored one changes no bit of any scene.
"""

from dataclasses import fields

import numpy as np
import pytest

from physics import Character, Circle, Effects, Filter, Material, PixelMask, Polygon, Revolute, TileGrid, World
from physics.step import SOLVERS

NAMES = tuple(field.name for field in fields(Effects))
EVERYTHING = Effects(**dict.fromkeys(NAMES, True))
BASES = {"everything": EVERYTHING, "default": Effects.rigid_bodies()}
STEPS = 60
MATTERS = 0.01  # [px], [px/s]


def floor(world, **given):
    world.add_body(Polygon.box(400, 20), position=(0, 110), kind="static", **given)


def near_by_their_boxes(world, much):
    world.add_body(Circle(10))
    world.add_body(Circle(10), position=(17, 17))


def a_wall(world, much):
    world.add_body(Polygon.box(10, 400), position=(60, 0), kind="static")
    world.add_body(Circle(8), velocity=(200 * much, 0))


def a_flight(world, much):
    world.add_body(Circle(5), velocity=(50 * much, 0))


def a_blow_off_centre(world, much):
    floor(world)
    world.add_body(Polygon.box(20, 20), position=(0, 60), angle=0.3)
    world.add_body(Circle(5), position=(-60, 92), velocity=(150 * much, -100))


def a_slide(world, much):
    floor(world, material=Material(friction=0.5))
    world.add_body(Polygon.box(20, 20), position=(0, 90), velocity=(150 * much, 0), material=Material(friction=0.5))


def a_bounce(world, much):
    floor(world)
    world.add_body(Circle(8), position=(0, 40), velocity=(0, 100 * much), material=Material(restitution=0.8))


def a_column(world, much):
    floor(world)
    for k in range(6):
        world.add_body(Polygon.box(20, 20), position=(0.5 * much * k, 90 - 20 * k))


def bullets(world, much):
    for k in range(3):
        world.add_body(Polygon.box(2, 40), position=(100, 80 * k), kind="static")
        world.add_body(Circle(3), position=(-50 + 13 * k, 80 * k), velocity=(9000 * much, 0))
    world.add_body(Circle(6), position=(100, -81))
    world.add_body(Circle(3), position=(0, -80), velocity=(9000 * much, 0))


def a_crate_at_rest(world, much):
    floor(world)
    world.add_body(Polygon.box(20 * much, 20), position=(0, 90))


def an_eye(world, much):
    sees = world.effects.sensors
    world.add_body(Circle(20), kind="static", sensor=sees, filter=Filter.ALL if sees else Filter(1, 0))
    world.add_body(Circle(5), position=(-50, 0), velocity=(200 * much, 0))


def a_platform(world, much):
    open_below = np.ones((1, 10), bool)
    if world.effects.one_way:
        world.add_body(TileGrid(~open_below, 20, one_way=open_below), position=(-100, 0), kind="static")
    world.add_body(Circle(6), position=(0, 60), velocity=(0, -260 * much))
    world.add_body(Circle(6), position=(40, -30))


def a_belt(world, much):
    floor(world, material=Material(friction=0.5, surface_speed=60 * much))
    world.add_body(Polygon.box(20, 20), position=(0, 90), material=Material(friction=0.5))


def a_pendulum(world, much):
    ball = world.add_body(Circle(6 * much), position=(40, 0))
    if world.effects.joints and world.stacks:
        world.add_joint(Revolute(None, ball, at=(0, 0)))


def a_hole(world, much):
    floor(world)
    body = world.add_body(PixelMask(np.ones((20, 30), bool)), position=(0, 85))
    if world.effects.carving:
        body.carve(Circle(6 * much), (0, 85))


SCENES = {
    "narrowphase": near_by_their_boxes,
    "response": a_wall,
    "gravity": a_flight,
    "drag": a_flight,
    "wind": a_flight,
    "rotation": a_blow_off_centre,
    "friction": a_slide,
    "restitution": a_bounce,
    "stacking": a_column,
    "continuous": bullets,
    "sleeping": a_crate_at_rest,
    "sensors": an_eye,
    "persist": a_slide,
    "one_way": a_platform,
    "conveyor": a_belt,
    "joints": a_pendulum,
    "carving": a_hole,
}
EVENTS = ("begin", "persist", "end", "hits", "sensor_begin", "sensor_end")


def outcome(effects, solver, scene, much):
    """Simulate a scene and return a list of (poses and velocities, flags and events), one for every step."""
    world = World(
        effects,
        solver=solver,
        drag=0.5 if effects.drag or effects.wind else 0.0,
        wind=(40, 0) if effects.wind else (0, 0),
    )
    scene(world, much)
    numbers, facts = [], []
    for _ in range(STEPS):
        world.step()
        numbers.append([world.bodies[name].tolist() for name in ("x", "y", "angle", "vx", "vy", "angular_velocity")])
        events = [getattr(world.events, name)[["body_a", "body_b"]].tolist() for name in EVENTS]
        facts.append((world.bodies["awake"].tolist(), [body.mass for body in world], events))
    return numbers, facts


def test_every_effect_has_its_scene():
    assert tuple(SCENES) == NAMES


@pytest.mark.parametrize("much", [pytest.param(0.75, marks=pytest.mark.nightly), 1.0])
@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("effect", NAMES)
@pytest.mark.parametrize("solver", SOLVERS)
def test_an_honoured_effect_is_missed_and_an_ignored_one_is_not(solver, effect, base, much):
    effects = BASES[base]
    if not getattr(effects, effect):
        return
    ignored = effect in World(effects, solver=solver).ignored_effects
    less = effects.without(effect)
    try:
        World(less, solver=solver)
    except ValueError:
        assert not ignored and effect in ("response", "stacking"), "without it there is no such solver"
        return
    if not ignored:
        (with_it, facts), (without, other_facts) = (
            outcome(each, solver, SCENES[effect], much) for each in (effects, less)
        )
        assert facts != other_facts or np.abs(np.array(with_it) - without).max() > MATTERS
        return
    for name, scene in SCENES.items():
        if (effect, name) != ("rotation", "continuous"):  # sweeps that may turn find an impact by other digits
            assert outcome(effects, solver, scene, much) == outcome(less, solver, scene, much), name


IGNORED = {
    "blocking": ("rotation", "friction", "restitution", "stacking", "sleeping", "conveyor", "joints"),
    "projection": ("stacking", "sleeping", "joints"),
    "sequential_impulse": (),
    "soft_step": (),
}


def test_it_follows_the_solver_and_the_effects():
    world = World(EVERYTHING)
    assert world.ignored_effects == ()
    for _ in range(2):
        for solver in SOLVERS:
            world.solver = solver
            assert world.ignored_effects == IGNORED[solver]
            world.step()
    world.solver = "blocking"
    world.set_effects(Effects(response=True, friction=True, gravity=True))
    assert world.solver == "projection" and world.ignored_effects == ()
    world.solver = "blocking"
    assert world.ignored_effects == ("friction",)
    taken = world.snapshot()
    world.solver = "projection"
    world.restore(taken)
    assert world.ignored_effects == ("friction",)
    with pytest.raises(AttributeError):
        world.ignored_effects = ()


@pytest.mark.parametrize("solver", ["blocking", "projection"])
def test_where_nothing_is_pushed_no_solver_ignores_anything(solver):
    world = World(Effects(rotation=True, gravity=True), solver=solver)
    world.add_body(Circle(5), angular_velocity=1.0)
    world.step()
    assert world.ignored_effects == () and world.bodies["angle"][0] > 0.0


def test_names_that_are_ignored_are_effects():
    assert {name for names in IGNORED.values() for name in names} <= set(NAMES)


@pytest.mark.parametrize("solver", ["blocking", "projection"])
def test_what_ignored_effects_leaves_to_others(solver):
    """`ignored_effects` is about the solver only: parts of the engine outside the solver still use the effects.

    Under these solvers a body still rotates by its angular velocity, and a Character still stands on dynamic bodies.
    """
    world = World(solver=solver)
    floor(world)
    body = world.add_body(Circle(5), angular_velocity=1.0)
    world.add_body(Polygon.box(40, 20), position=(0, 90))
    hero = Character(world, Polygon.box(8, 16), (0, 60))
    for _ in range(20):
        hero.move(0, 3)
        world.step()
    assert body.angle > 0.1 and hero.move(0, 0).grounded
