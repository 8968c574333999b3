"""The stages of a step read and write only the declared fields, and their order respects their dependencies."""

import itertools
from dataclasses import fields

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Effects,
    Material,
    PixelMask,
    Polygon,
    TileGrid,
    World,
)
from physics.step import SOLVERS, STACKING, Plan, begin, finish, plan
from physics.tables.step_state import STAGE_FIELDS, StepState, stage

ATOMS = (int, float, bool, str, bytes, type(None))
SCALARS = {"effects", "tolerances", "gravity", "drag", "wind", "dt", "substeps"}


def frozen(value, seen=()):
    """Return a comparable copy of a value: the bytes of all arrays reachable from it, and its plain parts."""
    if isinstance(value, ATOMS):
        return value
    if id(value) in seen:
        return "again"
    seen = (*seen, id(value))
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.shape, value.tobytes())
    if isinstance(value, dict):
        return tuple((repr(key), frozen(each, seen)) for key, each in value.items())
    if isinstance(value, (list, tuple)):
        return tuple(frozen(each, seen) for each in value)
    if isinstance(value, set):
        return tuple(sorted(map(repr, value)))
    if hasattr(value, "__dict__"):
        return tuple((name, frozen(each, seen)) for name, each in sorted(vars(value).items()))
    return repr(value)


def photographed(state) -> dict:
    """Return {field, or table.column: its comparable copy} of the whole state, except the workspace."""
    found = {}
    for name in STAGE_FIELDS:
        value = getattr(state, name)
        if name == "workspace":
            continue
        if name == "queries":  # which tables it has seen is a name for them, not a copy
            value = {each: part for each, part in vars(value).items() if each != "seen"}
        if name in ("bodies", "shapes"):
            for column in value.dtype.names:
                found[f"{name}.{column}"] = value[column].tobytes()
        elif name == "broadphase":
            found[name] = None  # what a strategy keeps is its own, and is reached by the pairs alone
        else:
            found[name] = frozen(value)
    return found


class Guard:
    """A proxy of the state that raises an error if a stage reads or writes a field that it does not declare."""

    def __init__(self, state, stage):
        object.__setattr__(self, "_state", state)
        object.__setattr__(self, "_stage", stage)

    def __getattribute__(self, name):
        state, stage = object.__getattribute__(self, "_state"), object.__getattribute__(self, "_stage")
        named = {each.split(".")[0] for each in (*stage.reads, *stage.writes)}
        assert name in named, f"stage {stage.stage} reads {name}, and does not say so"
        return getattr(state, name)

    def __setattr__(self, name, value):
        state, stage = object.__getattribute__(self, "_state"), object.__getattribute__(self, "_stage")
        assert name in stage.writes, f"stage {stage.stage} writes {name}, and does not say so"
        setattr(state, name, value)


def step_watched(world, dt=None):
    """Step a world, and assert that each stage reads and writes only what it declares."""
    state = begin(world, world.dt if dt is None else dt)
    for run in plan(world.effects, world.solver).stages:
        before = photographed(state)
        run(Guard(state, run))
        after = photographed(state)
        changed = {name for name in before if before[name] != after[name]}
        assert changed <= set(run.writes), (
            f"stage {run.stage} changed {sorted(changed - set(run.writes))}, and does not say so"
        )
    finish(world, state)


def busy(effects, solver=None, **arguments):
    """Return a world and two of its parts, with every kind of body and shape that its effects allow."""
    world = World(effects, solver=solver, **arguments)
    e = effects
    moving = Material(friction=0.5, restitution=0.4, rolling_resistance=0.1, surface_speed=30.0)
    world.add_body(TileGrid(np.ones((2, 40), bool), 16.0), position=(-320, 64), kind="static", material=moving)
    world.add_body(Chain([(200.0, 40.0), (300.0, 20.0), (400.0, 60.0)]), kind="static")
    lift = world.add_body(Polygon.box(60, 8), position=(-100, 30), kind="kinematic", velocity=(0.0, -20.0))
    for k in range(4):
        world.add_body(Polygon.box(16, 16), position=(0, 56 - 16.2 * k), material=moving)
    world.add_body(Circle(6), position=(-40, 40), velocity=(200.0, 0.0), angular_velocity=3.0 if e.rotation else 0.0)
    world.add_body(Capsule((-6, 0), (6, 0), 4), position=(60, 30))
    world.add_body(
        Polygon.box(12, 12).with_radius(2.0) if hasattr(Polygon, "with_radius") else Polygon.box(12, 12),
        position=(90, 30),
    )
    world.add_body(Bounds(Circle(5)), position=(120, 30))
    world.add_body(PixelMask(np.ones((9, 13), bool)), position=(150, 30), angle=0.4, velocity=(-60.0, 0.0))
    world.add_body(PixelMask(np.ones((9, 13), bool)), position=(140, 30))
    if e.continuous:
        for number, way in enumerate(("ray", "swept", "toi")):
            place = (-300, -40 - 30 * number)
            world.add_body(Circle(2), position=place, velocity=(9000.0, 0.0), continuous=way, bullet=way == "toi")
            world.add_body(Polygon.box(3, 20), position=(-250, place[1]), kind="static")
    if e.sensors:
        world.add_body(Circle(30), position=(0, 30), kind="static", sensor=True)
    hero = Character(world, Polygon.box(8, 12), (-100, 20)) if e.response else None
    return world, lift, hero


WORLDS = {
    "detection": (Effects.detection(), None),
    "boxes only": (Effects(narrowphase=False), None),
    "shooter": (Effects(continuous=True, sensors=True, persist=True), None),
    "projection": (
        Effects.rigid_bodies().with_(stacking=False, sleeping=False, drag=True, wind=True, conveyor=True),
        None,
    ),
    "blocking": (Effects(response=True, gravity=True), "blocking"),
    "one way": (Effects(response=True, gravity=True, one_way=True, continuous=True), None),
    "default": (Effects.rigid_bodies(), None),
    "everything": (Effects.rigid_bodies().with_(drag=True, wind=True, persist=True, one_way=True, conveyor=True), None),
    "impulses": (Effects.rigid_bodies().with_(sleeping=False), "sequential_impulse"),
    "piles pushed": (Effects.rigid_bodies(), "projection"),
}


@pytest.mark.parametrize("name", WORLDS)
def test_a_stage_touches_what_it_says(name):
    world, lift, hero = busy(*WORLDS[name])
    for number in range(45):
        step_watched(world)
        if hero is not None and number % 3 == 0:
            hero.move(1.5, 2.0)
        if number == 20:
            lift.velocity = (0.0, 0.0)
        if number == 30:
            world.remove_body(int(world.bodies["id"][5]))
            world.add_body(Circle(5), position=(3, -60), velocity=(0.0, 100.0))
    assert np.isfinite(world.bodies["x"]).all()


def test_what_falls_asleep_wakes_and_breaks_is_told_by_its_stages():
    world, lift, hero = busy(Effects.rigid_bodies())
    for _ in range(90):
        world.step()
    for number in range(50):
        step_watched(world)
        if number == 10:
            lift.velocity = (0.0, 15.0)
        if number == 20:
            world.bodies["x"][int(np.flatnonzero(world.bodies["kind"] == 2)[0])] = np.nan
            world.touch(int(world.bodies["id"][world.bodies["kind"] == 2][0]))
    assert world.bodies["quarantined"].sum() == 1


def test_watched_steps_are_steps():
    ours, theirs = busy(Effects.rigid_bodies())[0], busy(Effects.rigid_bodies())[0]
    for _ in range(30):
        step_watched(ours)
        theirs.step()
    assert ours.digest() == theirs.digest()


# --- the tests can fail ---------------------------------------------------------------------------------------------


@stage("liar", reads=("bodies",), writes=("bodies.vx",))
def writes_another_column(state):
    state.bodies["vy"] += 1.0


@stage("liar", reads=("bodies",), writes=("work",))
def writes_into_what_it_may_only_read(state):
    state.bodies["x"][0] = 5.0


@stage("liar", reads=("bodies",), writes=("work",))
def reads_what_it_did_not_name(state):
    len(state.shapes)


@stage("liar", reads=("pairs",), writes=("work",))
def leaves_a_message(state):
    state.pairs.note = "see you in the narrow phase"


@pytest.mark.parametrize(
    "liar", [writes_another_column, writes_into_what_it_may_only_read, reads_what_it_did_not_name, leaves_a_message]
)
def test_a_stage_that_does_more_than_it_says_is_found(liar, monkeypatch):
    world, _, _ = busy(Effects.rigid_bodies())
    monkeypatch.setattr("tests.physics.test_stages.plan", lambda effects, solver: Plan((liar,), (liar.stage,)))
    with pytest.raises(AssertionError, match="does not say so"):
        step_watched(world)


def test_a_stage_names_fields_that_there_are():
    with pytest.raises(ValueError, match="velocities"):
        stage("odd", reads=("velocities",))


# --- order ----------------------------------------------------------------------------------------------------------

BEFORE = (
    ("awake", "motion_rectangles"),
    ("integrate_velocities", "motion_rectangles"),
    ("weigh", "motion_rectangles"),
    ("motion_rectangles", "broad_phase"),
    ("broad_phase", "narrow_phase"),
    ("narrow_phase", "wake"),
    ("wake", "soft_step"),
    ("narrow_phase", "soft_step"),
    ("narrow_phase", "sequential_impulse"),
    ("narrow_phase", "projection"),
    ("narrow_phase", "blocking"),
    ("integrate_positions", "narrow_phase"),
    ("integrate_positions", "projection"),
    ("soft_step", "carry"),
    ("carry", "sensors"),
    ("sensors", "events"),
    ("islands", "events"),
    ("soft_step", "islands"),
)
PRODUCTS = ("changed_count", "impacts", "parked", "swept_sensors")  # made and used within one step


def mistakes(stages) -> list[str]:
    """Return descriptions of the errors in the order of some stages."""
    names = [each.stage for each in stages]
    found = [f"{b} before {a}" for a, b in BEFORE if a in names and b in names and names.index(a) > names.index(b)]
    for product in PRODUCTS:
        writers = [k for k, each in enumerate(stages) if product in each.writes]
        readers = [k for k, each in enumerate(stages) if product in each.reads]
        if writers and readers and min(readers) < min(writers):
            found.append(f"{names[min(readers)]} reads {product} before anybody writes it")
    return found


def declared():
    """Yield every combination of effects that changes the plan, with every solver that it allows."""
    switches = ("response", "gravity", "stacking", "continuous", "sleeping", "sensors")
    for values in itertools.product((False, True), repeat=len(switches)):
        chosen = dict(zip(switches, values, strict=True))
        if (chosen["stacking"] and not chosen["response"]) or (chosen["sleeping"] and not chosen["stacking"]):
            continue
        effects = Effects(**chosen)
        for solver in SOLVERS:
            if effects.stacking or solver not in STACKING:
                yield effects, solver


def test_the_order_of_the_stages():
    seen = 0
    for effects, solver in declared():
        assert mistakes(plan(effects, solver).stages) == [], (effects.names(), solver)
        seen += 1
    assert seen > 60


def test_a_wrong_order_is_found():
    for effects, solver in (
        (Effects.rigid_bodies(), "soft_step"),
        (Effects(response=True, continuous=True), "projection"),
    ):
        right = plan(effects, solver).stages
        wrong = sum(
            bool(mistakes((*right[:k], right[k + 1], right[k], *right[k + 2 :]))) for k in range(len(right) - 1)
        )
        assert wrong >= 3 and mistakes(tuple(reversed(right)))


def test_no_world_hands_messages_between_stages():
    """After a step, a world has no new attributes and none that is a function: stages pass no messages through it."""
    world, _, _ = busy(Effects.rigid_bodies())
    before = set(vars(world))
    world.step()
    assert set(vars(world)) == before
    assert not [name for name, value in vars(world).items() if callable(value) and not isinstance(value, type)]


def test_a_state_has_the_fields_and_no_others():
    state = StepState()
    with pytest.raises(AttributeError):
        state.message = "for another stage"
    assert {each.name for each in fields(Effects)} and SCALARS < set(STAGE_FIELDS)
    assert set(BROADPHASES) == {"brute", "sweep", "hash", "tree"}
