"""Hard cases of effects (section M): an effect that a scene does not need causes no work and changes no bit."""

import math

import numpy as np
import pytest

from game.measure.timing import clock
from physics import JIT, Character, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World, collide
from tests.stability.piles import column, floor, metres, needs_speed, pile_effects
from tests.stability.settings import generator

BASES = {"detection": Effects(), "response": Effects(response=True), "piles": Effects(response=True, stacking=True)}
UNUSED = (
    "gravity",
    "drag",
    "wind",
    "rotation",
    "continuous",
    "sensors",
    "persist",
    "friction",
    "restitution",
    "one_way",
)


def crowd(effects, steps):
    """Simulate a crowd and return its digest after each step.

    Most effects are unused: there is no friction, bounce, rotation, fast motion or gravity.
    """
    world = World(effects, gravity=(0, 0))
    rng, smooth = generator(3), Material(friction=0.0, restitution=0.0)
    for shape, count in ((Circle(6.0), 25), (PixelMask(np.ones((6, 5), bool)), 8), (Polygon.box(7, 9), 8)):
        places, speeds = rng.uniform(0, 90, (count, 2)), rng.uniform(-40, 40, (count, 2))
        world.add_bodies(shape, places, speeds, material=smooth, fixed_rotation=True, continuous="off")
    world.add_body(TileGrid(np.ones((1, 6), bool), 16), position=(0, 95), kind="static", material=smooth)
    digests = []
    for _ in range(steps):
        world.step()
        digests.append(world.digest())
    return digests


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("unused", [*UNUSED, "conveyor", "joints", "carving"])
def test_m1_an_effect_declared_and_not_used_changes_no_bit(measured, base, unused):
    effects = BASES[base]
    if unused in ("friction", "restitution", "one_way", "conveyor") and not effects.response:
        pytest.skip("needs response")
    if unused == "joints" and not effects.stacking:
        pytest.skip("needs stacking")
    plain, more = (crowd(each, 30 if JIT else 6) for each in (effects, effects.with_(**{unused: True})))
    measured("M1", "digests that differ", sum(one != two for one, two in zip(plain, more, strict=True)))


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
def test_m2_no_work_without_a_cause(measured, solver):
    """Declared effects cause no work in a scene that does not need them, and cause work in one that does."""
    causeless = ("toi_calls", "tangent_rows", "restitution_rows", "mask_tests", "sensor_tests", "carved_pixels")
    effects = pile_effects(continuous=True, sensors=True, stacking=solver != "projection")
    smooth = Material(friction=0.0, restitution=0.0)

    def work(**options):
        world = metres(solver, effects=effects)
        floor(world, friction=0.0)
        world.add_bodies(options.pop("shape", Polygon.box(1, 1)), [(2.0 * k, -0.5) for k in range(5)], **options)
        most = dict.fromkeys(causeless, 0)
        for _ in range(10):
            world.step()
            most = {name: max(count, world.profile.counters[name]) for name, count in most.items()}
        assert len(world.contacts) or options.get("sensor")
        return most

    measured(
        "M2", "sweeps, tangent, restitution, mask and sensor work without cause", sum(work(material=smooth).values())
    )
    assert work(material=smooth, sensor=True)["sensor_tests"] > 0
    if solver != "projection":
        world = metres(solver, effects=effects)
        floor(world, friction=0.5)
        column(world, 1, friction=0.5)
        world.step()
        assert world.profile.counters["tangent_rows"] > 0


def shooter(effects, gravity=(0, 0)):
    """Return a world of bullets and enemies without collision response: they overlap, and only pairs are reported."""
    world = World(effects, gravity=gravity)
    rng = generator(3)
    count = 120 if JIT else 30
    world.add_bodies(
        PixelMask(np.ones((9, 12), bool)), rng.uniform(0, 400, (count, 2)), rng.uniform(-60, 60, (count, 2))
    )
    world.add_bodies(Circle(2.0), rng.uniform(0, 400, (count, 2)), rng.uniform(-200, 200, (count, 2)))
    return world


def test_m3_a_shooter_needs_no_solver(measured):
    """A shooter without a solver reports exactly the pairs that collide() finds in a test of all pairs."""
    differ = rows = met = 0
    quick = shooter(Effects())
    for step in range(40):
        quick.step()
        rows += quick.profile.counters["solver_rows"] + quick.profile.counters["islands"]
        if step % 10:
            continue
        bodies = [(each.shapes[0], (*each.position, each.angle)) for each in quick]
        right = {
            (i, j)
            for j in range(len(bodies))
            for i in range(j)
            if math.dist(bodies[i][1][:2], bodies[j][1][:2]) < 20.0 and len(collide(*bodies[i], *bodies[j]))
        }
        told = quick.contacts[quick.contacts["separation"] <= 0.0]  # a pair ends only beyond the slop
        differ += len(right ^ set(zip(told["shape_a"].tolist(), told["shape_b"].tolist(), strict=True)))
        met += len(right)
    assert met > (100 if JIT else 5)
    measured("M3", "pairs that differ", differ)
    measured("M3", "rows solved", rows)


def test_m4_a_platformers_mover_needs_no_solver(measured):
    solid = np.zeros((8, 30), bool)
    solid[7], solid[5, 9:14], solid[6, 20] = True, True, True
    runs, work = [], 0
    for effects in (Effects(response=True), pile_effects(gravity=False)):
        world = World(effects, gravity=(0, 0))
        world.add_body(TileGrid(solid, 16.0), kind="static")
        hero = Character(world, Polygon.box(10, 14), (40.0, 60.0))
        seen = []
        for k in range(150 if JIT else 60):
            moved = hero.move(2.0 if k < 110 else -2.0, 3.0 if k % 40 > 12 else -3.0)
            world.step()
            seen.append((*hero.position, moved.grounded, moved.wall))
            if not effects.stacking:
                work += world.profile.counters["islands"] + world.profile.counters["solver_rows"]
        runs.append(seen)
    assert len(set(runs[0])) > 20
    measured("M4", "contacts that differ", sum(one != two for one, two in zip(*runs, strict=True)))
    measured("M4", "islands and rows solved", work)


@needs_speed
def test_m5_what_sleeps_costs_next_to_nothing(measured):
    worlds = {}
    for sleeping in (False, True):
        world = metres(effects=pile_effects(sleeping=sleeping))
        floor(world, width=4000.0)
        world.add_bodies(Polygon.box(1, 1), [(1.5 * (k // 2) - 800.0, -0.5 - k % 2) for k in range(2000)])
        for _ in range(120):
            world.step()
        taken = []
        for _ in range(30):
            start = clock()
            world.step()
            taken.append(clock() - start)
        worlds[sleeping] = (min(taken), world)
    counters = worlds[True][1].profile.counters
    names = (
        "narrow_tests",
        "solver_rows",
        "tangent_rows",
        "restitution_rows",
        "toi_calls",
        "islands",
        "bodies_integrated",
    )
    measured("M5", "tests, rows, sweeps, islands", sum(counters[name] for name in names))
    measured("M5", "time over that awake", worlds[True][0] / worlds[False][0])


CALLED_FOR = ("gravity", "drag", "wind", "rotation", "friction", "restitution", "stacking", "continuous", "sensors")


def play(effects):
    """Simulate a scene that uses every effect of CALLED_FOR for 2 s and return (poses, events)."""
    solver = "soft_step" if effects.stacking else None
    world = World(
        effects, solver=solver, drag=0.3 if effects.drag else 0.0, wind=(60.0, 0.0) if effects.wind else (0, 0)
    )
    world.add_body(Polygon.box(900, 20), position=(0, 110), angle=0.05, kind="static")
    world.add_body(Polygon.box(2, 120), position=(300, 40), kind="static")
    if effects.sensors:
        world.add_body(Circle(60.0), position=(0, 40), kind="static", sensor=True)
    rough = Material(friction=0.8, restitution=0.5)
    for k in range(12):
        shape = Circle(8.0) if k % 2 else Polygon.box(16, 12)
        turn = {"angular_velocity": 3.0} if effects.rotation else {}
        world.add_body(shape, position=(30.0 * (k % 4) - 60, -20.0 * (k // 4)), material=rough, angle=0.2, **turn)
    world.add_body(Circle(3.0), position=(-290, 20), velocity=(9000.0, 0.0), material=rough, gravity_scale=0.0)
    events = 0
    for _ in range(120):
        world.step()
        events += len(world.events.begin) + len(world.events.sensor_begin)
    dynamic = world.bodies[world.bodies["kind"] == 2]
    return np.column_stack([dynamic["x"], dynamic["y"], 10.0 * dynamic["angle"]]), events


@needs_speed
@pytest.mark.parametrize("effect", CALLED_FOR)
def test_m6_what_is_called_for_is_seen_when_it_is_missing(measured, effect):
    effects = Effects(response=True, **dict.fromkeys(CALLED_FOR, True))
    (poses, events), (without, fewer) = play(effects), play(effects.with_(**{effect: False}))
    change = max(float(np.abs(poses - without).max()), abs(events - fewer))
    assert math.isfinite(change)
    measured("M6", "least change of a pose or of the events", change)


def test_m7_only_bullets_are_swept_and_only_the_heavy_island_takes_more(measured):
    world = World(Effects(response=True, continuous=True), gravity=(0, 0))
    world.add_bodies(Circle(3.0), [(20.0 * k, 0.0) for k in range(200)], kind="static")
    slow = world.add_bodies(Circle(3.0), [(20.0 * k, 9.0) for k in range(200)], [(0.0, 20.0)] * 200, continuous="off")
    swept = 0
    for _ in range(10):
        world.step()
        swept += world.profile.counters["toi_calls"]
    world.add_body(Circle(1.0), position=(20.0, -300.0), velocity=(0.0, 9000.0), continuous="toi")
    calls = 0
    for _ in range(10):
        world.step()
        calls += world.profile.counters["toi_calls"]
    assert len(slow) == 200 and calls > 0
    measured("M7", "sweeps of those that are not bullets", swept)
    most = []
    for heavy in (False, True):
        piles = metres(substeps="auto")
        floor(piles)
        light = column(piles, 2)
        if heavy:
            for k in range(2):
                piles.add_body(
                    Polygon.box(1, 1), position=(30.0, -0.5 - k), material=Material(density=1.0 if k == 0 else 200.0)
                )
        for _ in range(60):  # a column's first half second takes more
            piles.step()
        rows = piles.bodies
        most.append(int(rows["substeps"][piles.rows([body.id for body in light])].max()))
        if heavy:
            assert rows["substeps"].max() > most[0]
    measured("M7", "substeps of a light island beside a heavy one, more than alone", most[1] - most[0])
