"""Several simultaneous impacts of one body, contacts that only touch, and landings on ground made of pieces."""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Material, PixelMask, Polygon, Segment, TileGrid, World
from tests.stability.piles import needs_speed

GROUNDS = {  # shapes with their surface at y = 0
    "one box": [Polygon.box(1280, 40, (0, 20))],
    "segment": [Segment((-640, 0), (640, 0))],
    "chain": [Chain([(-640, 0), (-10, 0), (10, 0), (640, 0)])],
    "short links": [Chain([(x, 0) for x in range(-640, 641, 8)])],
    "boxes": [Polygon.box(32, 40, (32 * k, 20)) for k in range(-20, 20)],
    "small boxes": [Polygon.box(8, 40, (8 * k, 20)) for k in range(-20, 20)],
    "segments": [Segment((32 * k, 0), (32 * k + 32, 0)) for k in range(-20, 20)],
    "grid": [TileGrid(np.ones((3, 80), bool), 16)],
}
BODIES = {
    "box 20": (Polygon.box(20, 20), 10.0),
    "box 60": (Polygon.box(60, 20), 10.0),
    "mask": (PixelMask.from_array(np.ones((20, 40), bool)), 10.0),
    "two parts": ([Polygon.box(20, 20, (-20, 0)), Polygon.box(20, 20, (20, 0))], 10.0),
}


def apex_after(ground, shapes, half, height, restitution, apart=False, x=0.0, **settings):
    """Drop a body and return (height of its first bounce / height of the fall, greatest spin after it [rad/s]).

    half: height of the body's centre when it lies on the ground [px]. height: height of the fall [px]. apart: True
    gives each shape of the ground a body of its own.
    """
    material = Material(restitution=restitution, friction=0.6)
    world = World(**settings)
    at = (-640, 0) if isinstance(ground[0], TileGrid) else (0, 0)
    for each in [[one] for one in ground] if apart else [ground]:
        world.add_body(*each, position=at, kind="static", material=material)
    shapes = shapes if isinstance(shapes, list) else [shapes]
    body = world.add_body(*shapes, position=(x, -half - height), material=material)
    while body.velocity.y >= 0.0:
        world.step()
    top, spin = body.position.y, abs(body.angular_velocity)
    while body.velocity.y < 0.0:
        world.step()
        top = min(top, body.position.y)
        spin = max(spin, abs(body.angular_velocity))
    return (-half - top) / height, spin


@needs_speed
@pytest.mark.parametrize("settings", [{}, {"substeps": 4}, {"solver": "sequential_impulse"}], ids=["auto", "4", "seq"])
@pytest.mark.parametrize("name", GROUNDS)
def test_a_flat_drop_bounces_on_every_ground_as_on_one_box(name, settings):
    for phase in range(16):
        shapes, half = list(BODIES.values())[phase % 4]
        height, restitution, apart = 100.0 + 13.7 * phase, (0.5, 0.9, 0.3)[phase % 3], phase // 4 % 2 == 1
        one, _ = apex_after(GROUNDS["one box"], shapes, half, height, restitution, **settings)
        found, spin = apex_after(GROUNDS[name], shapes, half, height, restitution, apart, 3.1 * phase, **settings)
        assert math.sqrt(found / one) == pytest.approx(1.0, abs=0.01) and spin <= 0.05


@needs_speed
@pytest.mark.parametrize("settings", [{}, {"substeps": 4}], ids=["auto", "4"])
@pytest.mark.parametrize("name", GROUNDS)
def test_a_body_lands_without_an_overlap_at_every_phase(name, settings):
    """A body that falls at 350 px/s (6 px a step) on ground in pieces lands without an overlap at every phase.

    Pieces of ground are met within the step, like other shapes.
    """
    bodies = {**BODIES, "disc": (Circle(10), 10.0), "capsule": (Capsule((-6, 0), (6, 0), 10), 10.0)}
    for k, (shapes, half) in enumerate(bodies.values()):
        for phase in range(k % 2, 10, 2):
            world = World(**settings)
            at = (-640, 0) if isinstance(GROUNDS[name][0], TileGrid) else (0, 0)
            world.add_body(*GROUNDS[name], position=at, kind="static")
            pieces = shapes if isinstance(shapes, list) else [shapes]
            body = world.add_body(*pieces, position=(0.3, -half - 180.0 - 0.55 * phase))
            deepest = -math.inf
            for _ in range(80):
                world.step()
                deepest = max(deepest, body.position.y + half)
            assert deepest <= world.tolerances.slop


@needs_speed
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("gap", [0.0, 1e-3, 0.5, 8.0])
def test_as_many_balls_leave_a_cradle_as_came(solver, gap):
    for strikers in (1, 2, 3):
        world = World(gravity=(0, 0), solver=solver)
        ball, pitch = Material(restitution=1.0, friction=0.0), 20.0 + gap
        row = [
            world.add_body(Circle(10), position=(pitch * k - 40, 0), velocity=(150, 0), material=ball)
            for k in range(-strikers, 0)
        ]
        row += [world.add_body(Circle(10), position=(pitch * k, 0), material=ball) for k in range(5)]
        for _ in range(60 if JIT else 30):
            world.step()
        speeds = [body.velocity.x for body in row]
        assert speeds == pytest.approx([0.0] * 5 + [150.0] * strikers, abs=1e-6)


@needs_speed
@pytest.mark.parametrize("restitution", [0.3, 0.8, 1.0])
def test_a_break_is_symmetric_and_keeps_momentum(restitution):
    """A ball that hits two touching balls sends both away symmetrically, without a gain of energy."""
    for angle in np.linspace(0, math.tau, 12, endpoint=False):
        c, s = math.cos(angle), math.sin(angle)
        world = World(gravity=(0, 0))
        material = Material(restitution=restitution, friction=0.0)
        cue = world.add_body(Circle(10), position=(-60 * c, -60 * s), velocity=(200 * c, 200 * s), material=material)
        pair = [
            world.add_body(Circle(10), position=(-10 * way * s, 10 * way * c), material=material) for way in (1, -1)
        ]
        for _ in range(30):
            world.step()
        along = [body.velocity.x * c + body.velocity.y * s for body in (cue, *pair)]
        across = [body.velocity.y * c - body.velocity.x * s for body in (cue, *pair)]
        assert sum(along) == pytest.approx(200.0, rel=1e-9) and sum(across) == pytest.approx(0.0, abs=1e-6)
        assert along[1] == pytest.approx(along[2], rel=1e-6) and across[1] == pytest.approx(-across[2], rel=1e-6)
        assert sum(v**2 for v in along + across) <= 200.0**2 * (1 + 1e-6)


@needs_speed
@pytest.mark.parametrize("settings", [{}, {"substeps": 4}], ids=["auto", "4"])
def test_a_box_that_lands_on_two_that_rest_stays_level(settings):
    """A box that lands on two resting boxes stays level and bounces with its restitution.

    The contacts below are soft, so the restitution may differ by 0.1.
    """
    for restitution in (0.3, 0.5, 0.9):
        material = Material(restitution=restitution, friction=0.6)
        world = World(**settings)
        world.add_body(Polygon.box(800, 40), position=(0, 20), kind="static", material=material)
        lower = [world.add_body(Polygon.box(30, 20), position=(x, -10), material=material) for x in (-15.5, 15.5)]
        for _ in range(60):
            world.step()
        box = world.add_body(Polygon.box(50, 20), position=(0, -130), material=material)
        while box.velocity.y >= 0.0:
            before = box.velocity.y
            world.step()
        assert abs(box.angular_velocity) < 0.2
        assert -box.velocity.y / before == pytest.approx(restitution, abs=0.1)
        assert all(abs(each.angular_velocity) < 1.0 for each in lower)
