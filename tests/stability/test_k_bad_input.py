"""Hard cases of bad input (section K): errors name the argument and leave the world unchanged; accepted input works.

tests/physics/test_bad_input.py covers every argument of every function; this file covers the cases of the catalogue.
"""

import math

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    JIT,
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    Material,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
)
from tests.stability.invariants import Watch, movers
from tests.stability.piles import SOLVERS, floor, metres, pile_effects

BOX = Polygon.box(1, 1)
MASK = PixelMask(np.ones((2, 2), bool))
FULL = pile_effects(continuous=True, sensors=True, sleeping=True, drag=True, wind=True)

SETTERS = {  # name in the refusal: a call with a number
    "position": lambda world, body, v: setattr(body, "position", (v, 0.0)),
    "angle": lambda world, body, v: setattr(body, "angle", v),
    "velocity": lambda world, body, v: setattr(body, "velocity", (0.0, v)),
    "angular_velocity": lambda world, body, v: setattr(body, "angular_velocity", v),
    "gravity_scale": lambda world, body, v: setattr(body, "gravity_scale", v),
    "force": lambda world, body, v: body.apply_force((v, 0.0)),
    "point": lambda world, body, v: body.apply_force((1.0, 0.0), (v, 0.0)),
    "impulse": lambda world, body, v: body.apply_impulse((v, 0.0)),
    "torque": lambda world, body, v: body.apply_torque(v),
    "gravity": lambda world, body, v: setattr(world, "gravity", (0.0, v)),
    "wind": lambda world, body, v: setattr(world, "wind", (v, 0.0)),
    "drag": lambda world, body, v: setattr(world, "drag", v),
    "dt": lambda world, body, v: world.step(v),
    "radius": lambda world, body, v: Circle(v),
    "center": lambda world, body, v: Circle(1.0, (v, 0.0)),
    "points": lambda world, body, v: Polygon([(0.0, 0.0), (1.0, 0.0), (v, 1.0)]),
    "origin": lambda world, body, v: PixelMask.from_array(np.ones((2, 2), bool), origin=(v, 0.0)),
    "density": lambda world, body, v: Material(density=v),
    "mass": lambda world, body, v: world.add_body(BOX, mass=v),
    "positions": lambda world, body, v: world.add_bodies(BOX, [(0.0, 0.0), (v, 0.0)]),
    "translation": lambda world, body, v: world.ray_cast((0.0, 0.0), (v, 0.0)),
}


def refusal(call):
    """Return the message of the ValueError or TypeError that a call raises, or "" if it raises none."""
    try:
        call()
    except (ValueError, TypeError) as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", SETTERS)
def test_k1_what_is_not_finite_is_refused_by_name(measured, name):
    silent = changed = 0
    for value in (math.nan, math.inf, -math.inf):
        world = metres(effects=FULL)
        floor(world)
        body = world.add_body(BOX, position=(0.0, -2.0))
        Watch(world).step(3)
        before = world.digest(), world.bodies.tobytes(), world.gravity, world.wind, world.drag, world.time
        silent += name not in refusal(lambda w=world, b=body, v=value: SETTERS[name](w, b, v))
        changed += before != (world.digest(), world.bodies.tobytes(), world.gravity, world.wind, world.drag, world.time)
        Watch(world).step(3)
    measured("K1", "accepted, or refused without the name", silent)
    measured("K1", "worlds changed by a refusal", changed)


@pytest.mark.parametrize("solver", SOLVERS)
def test_k2_steps_of_no_of_negative_and_of_odd_length(measured, solver):
    world = metres(solver, effects=pile_effects(continuous=True))
    floor(world)
    box = world.add_body(BOX, position=(0.0, -0.5))
    flying = world.add_body(BOX, position=(9.0, -30.0), velocity=(3.0, -2.0), angular_velocity=4.0)
    watch = Watch(world).step(60)
    accepted = 0
    for dt in (-1 / 60, -1e-300, -1.0):
        accepted += "dt" not in refusal(lambda dt=dt: world.step(dt))
    measured("K2", "negative steps accepted", accepted)
    before = world.bodies[["x", "y", "angle", "vx", "vy"]].copy()
    watch.step(5, dt=0.0)
    measured("K2", "poses moved by a step of 0", (world.bodies[["x", "y", "angle", "vx", "vy"]] != before).sum())
    assert len(world.contacts) > 0 and world.query_point(box.position) == [box], "queries are answered"
    start = box.position
    watch.step(200 if JIT else 20, dt=1e-9)
    measured(
        "K2",
        "way of a box at rest over time, steps of 1e-9 s",
        math.dist(box.position, start) / (200e-9 if JIT else 20e-9),
    )
    lost = 0
    for _ in range(20):
        world.step(1.0)
        rows = movers(world)
        lost += int((~np.isfinite(rows["x"]) | ~np.isfinite(rows["vy"]) | (rows["y"] > 0.5)).sum())
    measured("K2", "bodies lost or not finite in steps of 1 s", lost)
    assert flying.position.y < 0.5


SIZES = {
    "radius of a circle": lambda v: Circle(v),
    "radius of a capsule": lambda v: Capsule((0, 0), (1, 0), v),
    "width": lambda v: Polygon.box(v, 1.0),
    "height": lambda v: Polygon.box(1.0, v),
    "length of a capsule": lambda v: Capsule((2, 0), (2 + 0.0 * v, 0), 1.0),
    "length of a segment": lambda v: Segment((1, 1), (1, 1 + 0.0 * v)),
    "link of a chain": lambda v: Chain([(0, 0), (0, 0.0 * v), (1, 0)]),
    "tile": lambda v: TileGrid(np.ones((1, 1), bool), v),
    "scale": lambda v: MASK.scaled(v),
    "mass": lambda v: World().add_body(BOX, mass=v),
    "density": lambda v: Material(density=v),
    "pixels per metre": lambda v: World(pixels_per_meter=v),
    "step": lambda v: World(dt=v),
    "bounds of nothing": lambda v: Bounds(Circle(v)),
}


@pytest.mark.parametrize("size", SIZES)
def test_k3_sizes_of_nothing_are_refused(measured, size):
    assert refusal(lambda: SIZES[size](1.0)) == "" or "length" in size or "link" in size
    measured("K3", "accepted", sum(refusal(lambda v=v: SIZES[size](v)) == "" for v in (0, 0.0, -0.0, -1.0, -1e-300)))


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_k4_worlds_with_nothing_to_do(measured, broadphase):
    world = World(FULL, BROADPHASES[broadphase]())
    nothing = set()

    def idle():
        for _ in range(3):
            world.step()
            if len(world) == 0:
                nothing.update(world.profile.counters.values())
        assert world.ray_cast((0, 0), (9, 9)) is None or len(world)

    idle()
    statics = world.add_bodies(BOX, [(0.0, 0.0), (0.5, 0.0)], kind="static").tolist()
    idle()
    measured("K4", "counters above 0 in an empty world", len(nothing - {0}))
    movers_ids = world.add_bodies(BOX, [(0.0, -1.0), (0.5, -3.0)]).tolist()
    for _ in range(120):
        world.step()
    world.remove_bodies(movers_ids)
    world.step()
    world.clear()
    idle()
    again = [world.add_body(BOX).id for _ in range(3)]
    given = statics + movers_ids + again
    measured("K4", "ids given twice", len(given) - len(set(given)))
    world.step()
    with pytest.raises(KeyError):
        world.body(movers_ids[0])


def test_k5_materials_beyond_reason(measured):
    accepted = 0
    for name in ("friction", "restitution", "density", "rolling_resistance"):
        for value in (-1.0, -1e-300):
            accepted += name not in refusal(lambda name=name, value=value: Material(**{name: value}))
    measured("K5", "negative values accepted", accepted)
    for solver in SOLVERS:
        world = metres(solver)
        floor(world, friction=1e6)
        box = world.add_body(BOX, position=(0.0, -0.6), angle=0.1, velocity=(2.0, 0.0), material=Material(friction=1e6))
        Watch(world, passive=True).step(180 if JIT else 120)
        measured("K5", "speed of a box at rest, friction 1e6", box.velocity.length)
        world = metres(solver, effects=pile_effects(continuous=True))
        floor(world)
        world.add_body(Circle(0.5), position=(0.0, -3.0), material=Material(restitution=1e6))
        odd = 0
        for _ in range(300 if JIT else 90):
            world.step()
            odd += int((~np.isfinite(movers(world)["y"])).sum() + (~np.isfinite(movers(world)["vy"])).sum())
        measured("K5", "states not finite, restitution 1e6", odd)


def test_k6_arrays_of_any_make_give_the_same(measured):
    pygame = pytest.importorskip("pygame")
    positions = np.array([(0.0, 0.0), (1.5, 0.5), (8.0, -3.0), (1.0, 1.0)])
    wide = np.zeros((8, 4))
    wide[::2, ::2] = positions
    still = positions.copy()
    still.flags.writeable = False
    made = [
        positions,
        positions.tolist(),
        wide[::2, ::2],
        np.asfortranarray(positions),
        positions.astype(np.float32),
        still,
    ]
    solid = np.random.default_rng(6).random((12, 9)) < 0.5
    frozen = solid.copy()
    frozen.flags.writeable = False
    twice = np.zeros((24, 18), bool)
    twice[::2, ::2] = solid
    pixels = [solid, np.asfortranarray(solid), frozen, twice[::2, ::2]]
    surface = pygame.Surface((9, 12), pygame.SRCALPHA)
    for y, x in np.argwhere(solid).tolist():
        surface.set_at((x, y), (255, 255, 255, 255))
    masks = [PixelMask.from_array(each) for each in pixels]
    masks.append(PixelMask.from_surface(surface))
    surface.lock()
    masks.append(PixelMask.from_surface(surface))
    surface.unlock()
    whole = []
    for array in made:
        world = World(Effects(response=True))
        world.add_bodies(BOX, array, velocities=array)
        for _ in range(5):
            world.step()
        whole.append(world.digest())
    differ = sum(each != whole[0] for each in whole)
    differ += sum((each.solid != solid).any() or each.words.tobytes() != masks[0].words.tobytes() for each in masks)
    differ += int((PixelMask.from_array(solid.astype(bool)).words != masks[0].words).any())
    measured("K6", "results that differ", differ)
    with pytest.raises((TypeError, ValueError)):
        PixelMask.from_array("pixels")
