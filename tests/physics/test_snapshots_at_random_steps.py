"""Runs that restore snapshots at random steps give the same digests and events in every step as uninterrupted runs."""

import numpy as np
import pytest

from physics import Capsule, Character, Circle, Effects, Filter, Material, PixelMask, Polygon, Snapshot, TileGrid, World
from physics.step import SOLVERS

STEPS = 60
RIGID = Effects.rigid_bodies().with_(persist=True)
EVERYTHING = RIGID.with_(drag=True, wind=True, one_way=True, conveyor=True, carving=True)
ARCADE = Effects(response=True, gravity=True, restitution=True, sensors=True, persist=True)
WORLDS = {
    "default": (Effects.rigid_bodies(), None),
    **{f"rigid bodies, {solver}": (RIGID, solver) for solver in SOLVERS},
    "everything": (EVERYTHING, None),
    "without sleep": (RIGID.with_(sleeping=False), None),
    "arcade, projection": (ARCADE, "projection"),
    "arcade, blocking, swept": (ARCADE.with_(continuous=True), "blocking"),
    "no response, swept": (Effects(sensors=True, persist=True, continuous=True, gravity=True), None),
}
EVENTS = ("begin", "persist", "end", "hits", "sensor_begin", "sensor_end", "quarantined")
ROOM = (110.0, 80.0)  # [px] half the room
SHAPES = (
    Circle(6),
    Polygon.box(12, 10),
    Capsule((-5, 0), (5, 0), 4),
    PixelMask(np.random.default_rng(1).random((11, 13)) < 0.8),
    PixelMask(np.ones((9, 12), bool), snap=False),
)


def somewhere(rng):
    """Return a random point of the room [px]."""
    return tuple(rng.uniform(-1.0, 1.0, 2) * ROOM)


def add(world, rng):
    """Add a random body; most are dynamic, some are sensors."""
    e, kind = world.effects, rng.choice(["dynamic", "dynamic", "dynamic", "kinematic", "static"]).item()
    world.add_body(
        SHAPES[rng.integers(len(SHAPES))],
        position=somewhere(rng),
        kind=kind,
        sensor=bool(e.sensors and rng.random() < 0.3),
        angle=rng.uniform(-3.0, 3.0),
        velocity=rng.uniform(-150.0, 150.0, 2) if kind == "dynamic" else (0.0, 0.0),
        material=Material(restitution=rng.uniform(0.0, 0.5)),
    )


def start(effects, solver, seed):
    """Return a room with ground, a lift, static sensors and some bodies; with a character if the world has response."""
    world, rng = World(effects, solver=solver, seed=seed), np.random.default_rng(seed)
    if effects.drag:
        world.drag, world.wind = 0.2, (30.0, 0.0)
    world.add_body(Polygon.box(300, 20), position=(0, 110), kind="static")
    world.add_body(TileGrid(np.ones((1, 12), bool), 20), position=(-120, 90), kind="static")
    world.add_body(Polygon.box(80, 60), position=(-80, 70), kind="static", sensor=True)
    world.add_body(Polygon.box(60, 8), position=(60, 60), kind="kinematic")
    world.add_body(PixelMask(np.ones((40, 50), bool)), position=(70, 70), kind="kinematic", sensor=True)
    if effects.response:
        Character(world, Polygon.box(8, 14), (-40, 60))
    for _ in range(10):
        add(world, rng)
    return world


FIRST = 6  # ids below are the furniture


def edit(world, seed, step):
    """Edit a world at random, or leave it unchanged; the same seed and step give the same edit."""
    rng = np.random.default_rng((seed, step))
    walkers = world.characters.rows["body"].tolist()
    for identity in walkers:
        hero = object.__new__(Character)
        hero.world, hero.body = world, world.body(identity)
        hero.move(rng.uniform(-2.0, 2.0), 2.0)
    ids = [each for each in world.bodies["id"].tolist() if each not in walkers]
    one, e = world.body(ids[rng.integers(len(ids))]), world.effects
    what = rng.integers(20)
    if what == 0 or len(ids) < 10:
        add(world, rng)
    elif what == 1 and one.id >= FIRST:
        one.remove()
    elif what in (2, 3) and one.id >= FIRST:
        one.position = somewhere(rng)
    elif what in (4, 5) and one.kind == "kinematic":
        one.velocity = tuple(rng.uniform(-60.0, 60.0, 2)) if what == 4 else (0.0, 0.0)
    elif what == 6 and one.kind == "kinematic":
        one.set_target(somewhere(rng))
    elif what == 7:
        world.touch([one.id])
    elif what == 8 and one.kind == "dynamic":
        one.apply_impulse(one.mass * rng.uniform(-80.0, 80.0, 2))
    elif what == 9:
        one.sensor = not one.sensor
    elif what == 10 and one.id >= FIRST:
        one.filter = Filter(1, 0xFFFFFFFF if rng.random() < 0.6 else 2)
    elif what == 11 and one.id >= FIRST:
        one.set_kind(rng.choice(["static", "kinematic", "dynamic"]).item())
    elif what == 12 and e.gravity and rng.random() < 0.3:
        world.gravity = (0.0, rng.choice([313.6, 200.0]).item())
    elif what == 13 and e.stacking and rng.random() < 0.3:
        world.solver = rng.choice(SOLVERS).item()
    elif what == 14 and e.carving and isinstance(one.shapes[0], PixelMask):
        one.carve(Circle(4), (one.position.x + 4.0, one.position.y))
    elif what == 15 and one.kind == "dynamic" and rng.random() < 0.5:
        world.bodies["vx"][world.rows([one.id])[0]] = np.nan


def told(world):
    """Return (digest, events) of a world after its last step."""
    return world.digest(), {name: getattr(world.events, name).tolist() for name in EVENTS}


def run(effects, solver, seed, put_back=lambda world, moment: world):
    """Simulate a run and return its digest and events after every step, as a list.

    put_back(world, moment): function that returns the world with which to continue. moment: (step, "before edits" or
    "after edits").
    """
    world, found = start(effects, solver, seed), []
    for step in range(STEPS):
        world = put_back(world, (step, "before edits"))
        edit(world, seed, step)
        world = put_back(world, (step, "after edits"))
        world.step()
        found.append(told(world))
    return found


class Interruptions:
    """Interruptions of a run at random moments, each of which restores a world from its snapshot.

    The snapshot is restored after steps that are discarded, in a new world, or from a file.
    """

    def __init__(self, seed, folder=None):
        self.rng, self.path, self.count = np.random.default_rng((seed, 7)), folder and folder / "kept.npz", 0

    def __call__(self, world, moment):
        """Return the world with which the run continues."""
        if self.rng.random() > 0.25:
            return world
        self.count += 1
        taken, solver, effects = world.snapshot(), world.solver, world.effects
        if self.path:
            taken.save(self.path)
            taken = Snapshot.load(self.path)
        if self.rng.random() < 0.5:
            world = World(effects, solver=solver)
            if self.rng.random() < 0.5:
                add(world, self.rng)
                world.step()
        else:
            for number in range(self.rng.integers(4)):
                edit(world, 1000, number)
                world.step()
        world.restore(taken)
        if self.rng.random() < 0.3:
            world.restore(world.snapshot())  # of what has just been put back
        return world


@pytest.mark.parametrize("by_file", [False, True], ids=["memory", "file"])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", WORLDS)
def test_digests_and_events_of_every_step_are_those_of_the_run_that_was_left_alone(name, seed, by_file, tmp_path):
    wanted = run(*WORLDS[name], seed)
    assert sum(len(rows) for _, events in wanted for rows in events.values()) > 40
    put_back = Interruptions(seed, tmp_path if by_file else None)
    found = run(*WORLDS[name], seed, put_back)
    assert put_back.count > 15
    for step, ((digest, events), (other_digest, other_events)) in enumerate(zip(wanted, found, strict=True)):
        assert other_events == events, step
        assert other_digest == digest, step


def broken(world):
    """Make a number of a far body NaN, so that the next step disables the body."""
    world.bodies["vx"][world.rows([2])[0]] = np.nan


def copied(world, path):
    """Save a snapshot of the world to a file and restore the world from it."""
    world.snapshot().save(path / "kept.npz")
    world.restore(Snapshot.load(path / "kept.npz"))


STARTS_OVER = {
    "restore": lambda world, path: world.restore(world.snapshot()),
    "restore twice": lambda world, path: [world.restore(world.snapshot()) for _ in range(2)],
    "file": copied,
    "set_kind of another": lambda world, path: world.body(2).set_kind("kinematic"),
    "quarantine of another": lambda world, path: broken(world),
    "nothing": lambda world, path: None,
}


@pytest.mark.parametrize("after", range(4))
@pytest.mark.parametrize("sensor", [False, True])
@pytest.mark.parametrize("name", STARTS_OVER)
def test_a_pair_that_stands_goes_on_when_what_is_awake_is_looked_for_anew(name, sensor, after, tmp_path):
    """Two overlapping bodies at rest begin no second contact when the set of awake bodies is rebuilt.

    One is static, the other kinematic. The overlap begins in the first step, because both bodies are new. In later
    steps neither of them is awake.
    """
    world = World(RIGID)
    world.add_body(Polygon.box(40, 40), kind="static", sensor=sensor)
    world.add_body(Circle(10), position=(15.0, 0.0), kind="kinematic")
    world.add_body(Circle(10), position=(500.0, 0.0), kind="dynamic")
    world.step()
    assert len(world.events.sensor_begin) == sensor
    for _ in range(after):
        world.step()
    STARTS_OVER[name](world, tmp_path)
    for _ in range(3):
        world.step()
        assert not any(len(getattr(world.events, each)) for each in ("end", "sensor_end", "begin", "sensor_begin"))
    world.body(1).remove()
    world.step()
    assert len(world.events.sensor_end) == sensor
