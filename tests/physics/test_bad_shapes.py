"""Shapes, materials and worlds with invalid, or just valid, arguments.

An error names the argument and the value and leaves the world unchanged; accepted values work, however thin or large.
"""

import math

import numpy as np
import pytest

from physics import (
    BruteForce,
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
    collide,
    distance,
    mass_of,
    time_of_impact,
)
from tests.physics.test_bad_input import NO_NUMBER, NOT_FINITE, NUMBER, VECTOR, refused, state
from tests.stability.invariants import Watch
from tests.stability.piles import floor, metres

NAN, INF = math.nan, math.inf
BOX, BALL = Polygon.box(4, 4), Circle(3.0)
STILL = (0.0, 0.0, 0.0)


def ring(count, radius=5.0):
    return [(radius * math.cos(math.tau * k / count), radius * math.sin(math.tau * k / count)) for k in range(count)]


CONSTRUCTORS = {
    "polygon of 0": ("points", lambda: Polygon([])),
    "polygon of 2": ("points", lambda: Polygon([(0, 0), (1, 0)])),
    "polygon of 17": ("points", lambda: Polygon(ring(17))),
    "polygon of 1000": ("points", lambda: Polygon(ring(1000))),
    "equal corners": ("points", lambda: Polygon([(0, 0), (4, 0), (4, 0), (0, 4)])),
    "last is first": ("points", lambda: Polygon([(0, 0), (4, 0), (0, 4), (0, 0)])),
    "all equal": ("points", lambda: Polygon([(2, 2)] * 4)),
    "all in line": ("points", lambda: Polygon([(0, 0), (1, 1), (2, 2), (3, 3)])),
    "three in line": ("points", lambda: Polygon([(0, 0), (2, 0), (4, 0), (0, 4)])),
    "area of 1e-12": ("points", lambda: Polygon([(0, 0), (1, 0), (0.5, 1e-13)])),
    "edge of 1e-12": ("points", lambda: Polygon([(0, 0), (4, 0), (4, 4), (4 - 1e-12, 4 + 1e-12)])),
    "concave": ("points", lambda: Polygon([(0, 0), (4, 0), (1, 1), (0, 4)])),
    "bowtie": ("points", lambda: Polygon([(0, 0), (4, 4), (4, 0), (0, 4)])),
    "star": ("points", lambda: Polygon([ring(5)[2 * k % 5] for k in range(5)])),
    "corner of nan": ("points", lambda: Polygon([(0, 0), (1, 0), (NAN, 1)])),
    "corner of inf": ("points", lambda: Polygon([(0, 0), (1, 0), (INF, 1)])),
    "capsule without length": ("a and b", lambda: Capsule((1, 1), (1, 1), 2.0)),
    "capsule of length 1e-12": ("a and b", lambda: Capsule((1, 1), (1 + 1e-12, 1), 2.0)),
    "segment without length": ("a and b", lambda: Segment((3, 3), (3, 3))),
    "chain of 0": ("points", lambda: Chain([])),
    "chain of 1": ("points", lambda: Chain([(0, 0)])),
    "loop of 2": ("points", lambda: Chain([(0, 0), (1, 0)], loop=True)),
    "chain that stops": ("points", lambda: Chain([(0, 0), (4, 0), (4, 0), (8, 0)])),
    "loop that closes itself": ("points", lambda: Chain([(0, 0), (4, 0), (4, 4), (0, 0)], loop=True)),
    "chain of nan": ("points", lambda: Chain([(0, 0), (NAN, 0)])),
    "ghosts of a loop": ("ghosts", lambda: Chain(ring(5), True, ((0, 0), (1, 1)))),
    "one ghost": ("ghosts", lambda: Chain(ring(5), ghosts=((0, 0),))),
    "ghost at the end": ("ghosts", lambda: Chain([(0, 0), (1, 0)], ghosts=((0, 0), None))),
    "ghost of nan": ("ghosts", lambda: Chain([(0, 0), (1, 0)], ghosts=((NAN, 0), None))),
    "materials of 1": ("materials", lambda: Chain(ring(5), materials=(Material(),))),
    "materials of 5 numbers": ("materials", lambda: Chain(ring(6), materials=(0.5,) * 5)),
    "materials of a text": ("materials", lambda: Chain(ring(5), materials="ice!")),
}


@pytest.mark.parametrize("case", CONSTRUCTORS)
def test_shape_that_is_none_is_refused(case):
    name, call = CONSTRUCTORS[case]
    refused(name, None, lambda _: call())


@pytest.mark.parametrize(
    "name, call, values",
    [
        ("radius", lambda v: Capsule((0, 0), (1, 0), v), NUMBER + [0, -1]),
        ("a", lambda v: Capsule(v, (1, 0), 1.0), VECTOR),
        ("b", lambda v: Capsule((1, 0), v, 1.0), VECTOR),
        ("radius", lambda v: Polygon(BOX.points, v), NUMBER + [-1]),
        ("a", lambda v: Segment(v, (9, 9)), VECTOR),
        ("b", lambda v: Segment((9, 9), v), VECTOR),
        ("loop", lambda v: Chain(ring(5), v), [1, None, "x"]),
        ("rolling_resistance", lambda v: Material(rolling_resistance=v), NUMBER + [-1]),
        ("surface_speed", lambda v: Material(surface_speed=v), NUMBER),
        ("substeps", lambda v: World(substeps=v), [0, -1, 1.5, "4", None, NAN, True]),
        ("solver", lambda v: World(solver=v), ["soft", "", 5]),
        ("shape_a", lambda v: distance(v, STILL, BALL, STILL), [None, 5, "x"]),
        ("shape_b", lambda v: distance(BALL, STILL, v, STILL), [None, 5]),
        ("pose_a", lambda v: distance(BALL, v, BALL, STILL), [None, 5, (0,), (0, NAN), (0, 0, NAN)]),
        ("start_a", lambda v: time_of_impact(BALL, v, STILL, BALL, STILL, STILL), [None, (0,), (0, NAN), (0, NAN, 0)]),
        ("end_b", lambda v: time_of_impact(BALL, STILL, STILL, BALL, STILL, v), [None, (0,), (INF, 0), (0, INF, 0)]),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_wrong_arguments_are_named(name, call, values):
    for value in values:
        refused(name, value, call)


def test_the_hint_for_a_concave_outline_says_what_to_do():
    with pytest.raises(ValueError, match="convex.*parts"):
        Polygon([(0, 0), (4, 0), (1, 1), (0, 4)])


def world_of_two(**options):
    world = World(**options)
    world.add_body(Polygon.box(90, 10), position=(0, 40), kind="static")
    world.add_body(BALL, velocity=(5.0, 3.0))
    world.step()
    return world


CHANGES = {
    "static with a velocity": ("velocity", lambda w: w.add_body(BOX, kind="static", velocity=(1, 0))),
    "static with a spin": ("angular_velocity", lambda w: w.add_body(BOX, kind="static", angular_velocity=1.0)),
    "static given a velocity": ("velocity", lambda w: setattr(w.body(0), "velocity", (0, 1e-300))),
    "static given a spin": ("angular_velocity", lambda w: setattr(w.body(0), "angular_velocity", -1.0)),
    "statics with velocities": (
        "velocit",
        lambda w: w.add_bodies(BOX, [(0, 0), (9, 9)], [(0, 0), (0, 1)], kind="static"),
    ),
    "static pushed": ("dynamic", lambda w: w.body(0).apply_impulse((1, 0))),
    "static forced": ("dynamic", lambda w: w.body(0).apply_force((1, 0))),
    "dynamic chain": ("Chain", lambda w: w.add_body(Chain([(0, 0), (9, 0)]))),
    "dynamic tiles": ("TileGrid", lambda w: w.add_body(TileGrid(np.ones((1, 1), bool), 8))),
    "chain that becomes dynamic": ("Chain", lambda w: w.body(1).set_shapes(Chain([(0, 0), (9, 0)]))),
    "bullet that is no bool": ("bullet", lambda w: w.add_body(BALL, bullet=1)),
    "static bullet": ("bullet", lambda w: w.add_body(BALL, bullet=None)),
    "continuous of nothing": ("continuous", lambda w: w.add_body(BALL, continuous="always")),
    "substeps of 0": ("substeps", lambda w: setattr(w, "substeps", 0)),
    "solver of nothing": ("solver", lambda w: setattr(w, "solver", "soft")),
    "cast of nothing": ("shape", lambda w: w.shape_cast(None, STILL, (1, 0))),
    "cast along nan": ("translation", lambda w: w.shape_cast(BALL, STILL, (NAN, 0))),
    "cast from inf": ("pose", lambda w: w.shape_cast(BALL, (INF, 0, 0), (1, 0))),
    "closest to nan": ("point", lambda w: w.closest((NAN, 0))),
    "closest with no filter": ("filter", lambda w: w.closest((0, 0), filter=3)),
}


@pytest.mark.parametrize("case", CHANGES)
def test_refused_change_leaves_the_world_as_it_was(case):
    name, call = CHANGES[case]
    world = world_of_two()
    before = state(world)
    with pytest.raises((ValueError, TypeError), match=name):
        call(world)
    assert state(world) == before


@pytest.mark.parametrize(
    "effect, call",
    [
        ("continuous", lambda w: w.add_body(BALL, bullet=True)),
        ("continuous", lambda w: w.add_body(BALL, continuous="toi")),
        ("stacking", lambda w: World(w.effects, solver="soft_step")),
        ("stacking", lambda w: World(w.effects, solver="sequential_impulse")),
        ("stacking", lambda w: setattr(w, "solver", "soft_step")),
        ("stacking", lambda w: Effects(response=True, sleeping=True)),
        ("response", lambda w: Effects(stacking=True)),
        ("response", lambda w: Effects(conveyor=True)),
    ],
)
def test_what_was_not_declared_is_refused_naming_the_effect(effect, call):
    world = World(Effects(response=True))
    with pytest.raises(ValueError, match=effect):
        call(world)


def test_undeclared_material_values_are_inert():
    """Material values have no effect if the world does not declare the effect that uses them.

    Rolling resistance needs friction; a surface speed needs conveyor.
    """
    digests = []
    for material in (Material(), Material(rolling_resistance=0.5, surface_speed=90.0, friction=0.9, restitution=0.9)):
        world = World(Effects(response=True, gravity=True, rotation=True, stacking=True))
        world.add_body(Polygon.box(90, 10), position=(0, 40), kind="static", material=material)
        world.add_body(BALL, position=(0, 30), velocity=(20, 0), material=material)
        for _ in range(60):
            world.step()
        digests.append(world.digest())
    assert digests[0] == digests[1]


def test_removing_twice_says_so_and_spoils_nothing():
    world = world_of_two()
    body = world.body(1)
    world.remove_body(body)
    before = state(world)
    for call in (
        lambda: world.remove_body(body),
        lambda: world.remove_body(1),
        lambda: world.remove_bodies([0, 1]),
        lambda: world.remove_bodies([0, 1, 1]),
        lambda: body.wake(),
        lambda: body.velocity,
        lambda: setattr(body, "velocity", (1, 0)),
    ):
        with pytest.raises((KeyError, ValueError)):
            call()
        assert state(world) == before
    world.step()
    assert world.add_body(BALL).id == 2


def test_world_is_closed_while_it_steps():
    world = world_of_two()
    body, raised = world.body(1), []
    calls = [
        lambda: body.wake(),
        lambda: setattr(world, "substeps", 2),
        lambda: setattr(world, "solver", "sequential_impulse"),
        lambda: world.add_body(Capsule((0, 0), (1, 0), 1.0)),
        lambda: body.set_shapes(Polygon(BOX.points, 1.0)),
        lambda: world.remove_body(body),
    ]

    class Meddler(BruteForce):
        def update(self, arena):
            before = state(world)
            for call in calls:
                with pytest.raises(RuntimeError, match="during its step"):
                    call()
                raised.append(call)
            assert state(world) == before
            return super().update(arena)

        def fresh(self):
            return self

    world.broadphase = Meddler()
    world.step()
    assert len(raised) >= len(calls)


# --- barely right -----------------------------------------------------------------------------------------------------

THIN = {
    "needle": Polygon([(-50, 0), (50, 0), (50, 0.001), (-50, 0.001)]),
    "sliver": Polygon([(-2, 0), (-1, 0), (2, -0.001)]),
    "short capsule": Capsule((0, 0), (1e-6, 0), 1.0),
    "thin capsule": Capsule((-9, 0), (9, 0), 1e-4),
    "round box": Polygon(BOX.points, 40.0),
    "sixteen": Polygon(ring(16)),
    "nearly in line": Polygon([(0, 0), (4, -1e-4), (8, 0), (4, 4)]),
    "tiny": Polygon.box(1e-5, 1e-5),
    "huge": Polygon.box(1e7, 1e7),
    "far": Polygon.box(2, 2, center=(1e5, -1e5)),
}


@pytest.mark.parametrize("name", THIN)
def test_extreme_shapes_are_weighed_met_and_dropped(name):
    """Extreme shapes have positive finite masses, collide without an error, fall on a floor and stay above it."""
    shape = THIN[name]
    mass = mass_of(shape, 1.0)
    assert mass.mass > 0 and mass.inertia > 0 and all(map(math.isfinite, (*mass.center, mass.inertia)))
    met = collide(shape, STILL, shape, STILL)
    assert (
        len(met) > 0
        and math.hypot(*met.normal) == pytest.approx(1.0)
        and max(met.separations) <= 0 > min(met.separations)
    )
    gap = distance(shape, STILL, Circle(1.0), (3e7, 0.0, 0.3))
    assert gap.distance > 1e7 and math.hypot(*gap.normal) == pytest.approx(1.0)
    size = max(abs(v) for corner in getattr(shape, "points", ((1, 1),)) for v in corner) + getattr(shape, "radius", 0.0)
    world = metres(pixels_per_meter=min(1.0, size) if size < 1e6 else 1e6)
    floor(world, width=8 * size + 1000)
    body = world.add_body(
        shape, position=(-mass.center[0], -2 * size - mass.center[1]), angle=0.1 if name != "far" else 0.0
    )
    watch = Watch(world, capped=True)
    for _ in range(60):
        watch.step()
    assert body.center[1] < 0.1 * size + 0.1


def test_coincident_and_touching_shapes_have_a_unit_normal():
    """Concentric and touching shapes have a unit normal and the analytic depth (docs/stability.md, B5, B6)."""
    for shape, depth in (
        (Circle(2.0), 4.0),
        (Capsule((-3, 0), (3, 0), 1.0), 2.0),
        (Polygon.box(4, 6), 4.0),
        (Polygon.box(5, 5), 5.0),
    ):
        met = collide(shape, STILL, shape, STILL)
        assert math.hypot(*met.normal) == pytest.approx(1.0, abs=1e-12) and min(met.separations) == pytest.approx(
            -depth, abs=1e-9
        )
        assert distance(shape, STILL, shape, STILL).distance == pytest.approx(-depth, abs=1e-9)
    box = Polygon.box(4, 4)
    for at, depth in (((0.0, 0.0), 3.0), ((2.0, 0.0), 1.0), ((2.0, 2.0), 1.0), ((0.0, -2.0), 1.0)):
        met = collide(box, STILL, Circle(1.0), (*at, 0.0))
        assert min(met.separations) == pytest.approx(-depth, abs=1e-12) and math.hypot(*met.normal) == pytest.approx(
            1.0, abs=1e-12
        )


def test_no_contact_is_dropped_where_there_are_many():
    """128 discs at one point get all 8,128 contacts, more than the initial size of any table."""
    world = World(Effects(response=True, stacking=True), gravity=(0, 0))
    world.add_bodies(Circle(4.0), np.zeros((128, 2)))
    world.step(0.0)
    assert len(world.candidates) == len(world.contacts) == 128 * 127 // 2 and world.profile.counters["cap_hits"] == 0
    before = len(world.bodies)
    world.add_bodies(Circle(1.0), [(100.0 + 3 * k, 0.0) for k in range(3000)])
    world.step()
    assert len(world.bodies) == before + 3000 and np.isfinite(world.bodies["x"]).all()


def test_values_that_are_not_finite_never_get_in():
    world = world_of_two()
    before = state(world)
    for value in NOT_FINITE + NO_NUMBER:
        for call in (
            lambda bad: setattr(world.body(1), "velocity", (bad, 0)),
            lambda bad: world.body(1).apply_impulse((0, bad)),
            lambda bad: world.body(1).move_to((bad, 0)),
            lambda bad: world.add_body(BALL, angle=bad),
            lambda bad: setattr(world, "gravity", (0, bad)),
        ):
            with pytest.raises((ValueError, TypeError)):
                call(value)
            assert state(world) == before


def test_mask_without_pixels_is_inert():
    world = World()
    empty = world.add_body(PixelMask(np.zeros((4, 4), bool)), position=(0, -20), kind="kinematic", velocity=(0, 60))
    world.add_body(Polygon.box(90, 10), kind="static")
    for _ in range(30):
        world.step()
    assert np.isfinite(empty.position).all() and len(world.contacts) == 0
