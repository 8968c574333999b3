"""Sensors report the overlaps at the final poses of each step.

All solvers, kinds of shapes, kinds of bodies, and snapped and exact masks are tested. The reference is `collide`, which
needs no world, step or broad phase. `world.overlap` is compared with it, too. A pair that a sweep met may be reported
as well, if the shapes meet on one of the swept paths.
"""

import itertools

import numpy as np
import pytest

from physics import Bounds, Capsule, Chain, Circle, Effects, PixelMask, Polygon, Segment, TileGrid, World, collide

STEPS = 16
ROOM = 70.0  # [px] half the room that everything is thrown about in
WAY = 65  # places on a way that are looked at


def blob(seed, width=22, height=18):
    """Return the pixels of a hollow ring with a rough edge."""
    y, x = np.mgrid[:height, :width]
    round_ = ((x - width / 2) / (width / 2)) ** 2 + ((y - height / 2) / (height / 2)) ** 2
    rough = np.random.default_rng(seed).random((height, width)) < 0.2
    return (rough | (round_ < 0.8)) & ~(round_ < 0.16)


CORNERS = [(-9.0, -6.0), (10.0, -4.0), (3.0, 9.0)]
KINDS = {
    "circle": (Circle(9, (2, 1)),),
    "capsule": (Capsule((-8, 0), (8, 3), 5),),
    "polygon": (Polygon(CORNERS),),
    "rounded": (Polygon(CORNERS, radius=3.0),),
    "segment": (Segment((-11, -3), (10, 5)),),
    "chain": (Chain([(-14, 6), (0, -2), (14, 6)]),),
    "tiles": (TileGrid(np.array([[1, 0, 1], [1, 1, 0]], bool), 9),),
    "bounds": (Bounds(Polygon(CORNERS)),),
    "pixels": (PixelMask(blob(1)),),  # as drawn
    "mask": (PixelMask(blob(2), snap=False),),  # at the exact pose
}
# A body that is solid in one place and sees by another.
KINDS["eye"] = (Polygon.box(6, 6, center=(-12, 0)), KINDS["pixels"][0].with_(sensor=True))
REACH = {name: 34.0 if name == "tiles" else 18.0 for name in KINDS} | {"wall": 170.0}  # [px] from a body's origin
UNTURNED = ("tiles",)  # a grid does not turn, and
STANDING = ("tiles", "chain", "segment")  # these are never dynamic

PLAIN = Effects(response=True, gravity=True, rotation=True, friction=True, sensors=True)
WORLDS = {
    "no response": (Effects(sensors=True, gravity=True, rotation=True), None),
    "no response, swept": (Effects(sensors=True, gravity=True, rotation=True, continuous=True), None),
    "blocking": (PLAIN, "blocking"),
    "projection": (PLAIN, "projection"),
    "blocking, swept": (PLAIN.with_(continuous=True), "blocking"),
    "projection, swept": (PLAIN.with_(continuous=True), "projection"),
    "sequential_impulse": (PLAIN.with_(stacking=True), "sequential_impulse"),
    "soft_step": (PLAIN.with_(stacking=True), "soft_step"),
    "default": (Effects.rigid_bodies(), None),
    "default under sequential_impulse": (Effects.rigid_bodies(), "sequential_impulse"),
    "default under projection": (Effects.rigid_bodies(), "projection"),
    "default under blocking": (Effects.rigid_bodies(), "blocking"),
}
# One of each way to solve, and both without a sweep and with one; the others are run at night with each kind of shape.
DAILY = ("no response, swept", "blocking", "projection, swept", "soft_step", "default", "default under blocking")


def roles_of(kind):
    """Return the kinds of bodies (static, kinematic, dynamic) that may have such a shape."""
    return ("static", "kinematic") if kind in STANDING else ("static", "kinematic", "dynamic")


def crowd(effects, solver, sensors, seed):
    """Return a room with sensors and moving solid bodies of every kind of shape, kinematic and dynamic.

    sensors: list of (kind of shape, role).
    """
    rng = np.random.default_rng(seed)
    world = World(effects, solver=solver, gravity=(0.0, 300.0))

    def add(name, role, sensor):
        turns = effects.rotation and name not in UNTURNED
        moves = role != "static"
        world.add_body(
            *KINDS[name],
            kind=role,
            sensor=sensor and name != "eye",
            position=rng.uniform(-ROOM, ROOM, 2),
            velocity=rng.uniform(-120.0, 120.0, 2) if moves else (0.0, 0.0),
            angle=rng.uniform(-7.0, 7.0) if turns else 0.0,
            angular_velocity=rng.uniform(-6.0, 6.0) if turns and moves else 0.0,
            user=name,
        )

    for kind, role in sensors:
        add(kind, role, True)
    for name in KINDS:
        for role in roles_of(name)[1:]:
            add(name, role, False)
    for x, y, width, height in ((0, 100, 240, 20), (0, -100, 240, 20), (110, 0, 20, 240), (-110, 0, 20, 240)):
        world.add_body(Polygon.box(width, height), position=(x, y), kind="static", user="wall")
    return world


def senses(body, shape):
    """Return whether a shape of a body is a sensor."""
    return body.sensor if shape.sensor is None else shape.sensor


def pose(body):
    """Return (x, y, angle) of a body."""
    return (*body.position, body.angle)


def sides(world):
    """Return {shape id: (body, shape)} of all shapes of a world."""
    return {
        identity: (body, shape) for body in world for identity, shape in zip(body.shape_ids, body.shapes, strict=True)
    }


def overlapping(world):
    """Return the pairs of shape ids, one of them a sensor, that overlap now, by `collide`."""
    found = set()
    for (a, (body_a, shape_a)), (b, (body_b, shape_b)) in itertools.combinations(sides(world).items(), 2):
        if body_a == body_b or body_a.kind == body_b.kind == "static":
            continue
        if not (senses(body_a, shape_a) or senses(body_b, shape_b)):
            continue
        if (body_a.position - body_b.position).length > REACH[body_a.user] + REACH[body_b.user]:
            continue
        if len(collide(shape_a, pose(body_a), shape_b, pose(body_b))):
            found.add((a, b))
    return found


def pairs_of(events):
    """Return the set of pairs of shape ids in event rows."""
    return set(zip(events["shape_a"].tolist(), events["shape_b"].tolist(), strict=True))


def asked_of_the_world(world):
    """Return the pairs of body ids that world.overlap reports for the shapes of sensors."""
    found = set()
    for body, shape in sides(world).values():
        if senses(body, shape):
            for other in world.overlap(shape, pose(body), sensors=True):
                if other != body and not body.kind == other.kind == "static":
                    found.add((min(body.id, other.id), max(body.id, other.id)))
    return found


class Ways:
    """Paths of the bodies in the next step: to their final poses, and to the poses that free motion would reach."""

    def __init__(self, world):
        self.world = world
        dt, fall = world.dt, world.gravity * world.dt if world.effects.gravity else world.gravity * 0.0
        self.starts = {body.id: (body.center, body.angle) for body in world}
        self.free = {
            body.id: (
                body.center + (body.velocity + (fall if body.kind == "dynamic" else fall * 0.0)) * dt,
                body.angle + body.angular_velocity * dt,
            )
            for body in world
        }

    def meet(self, a, b):
        """Return whether two shapes, each given as (body, shape), meet on one of the paths, within the slop."""
        ends = {body.id: (body.center, body.angle) for body, _ in (a, b)}
        slop = self.world.tolerances.slop
        return any(
            len(collide(*self.placed(a, to, share), *self.placed(b, to, share), slop))
            for to in (ends, self.free)
            for share in np.linspace(0.0, 1.0, WAY).tolist()
        )

    def placed(self, side, ends, share):
        """Return (shape, pose) of a (body, shape) pair after a share 0..1 of its path.

        A mask is placed at the exact pose, as in sweeps. A Bounds does not rotate on its path.
        """
        body, shape = side
        (start, angle), (end, turned) = self.starts[body.id], ends[body.id]
        if isinstance(shape, PixelMask):
            shape = PixelMask(shape.solid, shape.origin, snap=False)
        if not isinstance(shape, Bounds):
            angle += share * (turned - angle)
        x, y = start + share * (end - start) - (body.center - body.position).rotated(angle - body.angle)
        return shape, (x, y, angle)


def watched(world, steps):
    """Step a world, and compare the sensor events with geometry.

    Returns (number of overlapping pairs, summed over the steps; number of pairs that only a sweep reported).
    """
    now, seen, swept = set(), 0, 0
    sweeps = world.effects.continuous
    for step in range(steps):
        ways = Ways(world)
        world.step()
        begin, end = pairs_of(world.events.sensor_begin), pairs_of(world.events.sensor_end)
        assert not begin & now and end <= now and not begin & end, step
        now = (now | begin) - end
        truth = overlapping(world)
        everything = sides(world)
        assert truth <= now, (step, [[each[0].user for each in (everything[a], everything[b])] for a, b in truth - now])
        for a, b in now - truth:
            told = f"{everything[a][0].user} and {everything[b][0].user} are told and do not meet"
            assert sweeps and ways.meet(everything[a], everything[b]), (step, told)
        bodies = {tuple(sorted((everything[a][0].id, everything[b][0].id))) for a, b in truth}
        assert bodies <= asked_of_the_world(world), step
        seen, swept = seen + len(truth), swept + len(now - truth)
    return seen, swept


@pytest.mark.parametrize("name", WORLDS)
def test_sensors_tell_what_overlaps_at_the_final_poses(name):
    sensors = [(kind, roles_of(kind)[number % len(roles_of(kind))]) for number, kind in enumerate(KINDS)]
    seen, _ = watched(crowd(*WORLDS[name], sensors, seed=5), STEPS)
    assert seen > 100


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in DAILY else pytest.mark.nightly) for name in WORLDS]
)
def test_sensors_of_each_kind_tell_what_overlaps_at_the_final_poses(name, kind, seed):
    sensors = [(kind, role) for role in roles_of(kind) for _ in range(2)]
    seen, _ = watched(crowd(*WORLDS[name], sensors, seed), STEPS)
    assert seen > 5


def test_sweeps_tell_of_what_was_passed():
    """A fast body that passes a sensor within a step is reported, and the check of its path confirms it."""
    world = World(Effects.rigid_bodies(), gravity=(0.0, 0.0))
    world.add_body(KINDS["pixels"][0], kind="static", sensor=True, user="pixels")
    world.add_body(Circle(3), position=(-100, 0), velocity=(9000.0, 0.0), user="circle")
    assert watched(world, 3) == (0, 1)


SOLVERS = ("blocking", "projection", "sequential_impulse", "soft_step")


PUSHED = Effects(response=True, sensors=True)
PUSHES = [
    *((solver, PUSHED) for solver in ("blocking", "projection")),
    *((solver, PUSHED.with_(stacking=True)) for solver in SOLVERS),
    *((solver, PUSHED.with_(stacking=True, sleeping=True)) for solver in SOLVERS[2:]),
]


@pytest.mark.parametrize("gap", [0.05, 0.5, 1.0, 1.5])
@pytest.mark.parametrize(("solver", "effects"), PUSHES, ids=lambda each: getattr(each, "names", lambda: [each])()[-1])
def test_what_is_pushed_into_a_sensor_is_told_in_that_step(solver, effects, gap):
    """A resting body that is pushed into a sensor is reported in the same step, although its swept box did not include
    it.
    """
    world = World(effects, solver=solver)
    for x in (-8.0, 8.0):  # in each other by 24 px
        world.add_body(Polygon.box(40, 40), position=(x, 0.0), user="wall")
    for x in (-28.0 - gap, 28.0 + gap):
        for k, name in enumerate(("circle", "polygon", "pixels", "mask")):
            shape = {"circle": Circle(3), "polygon": Polygon.box(6, 6)}.get(
                name, PixelMask(np.ones((6, 6), bool), snap=name == "pixels")
            )
            side = 3.0 if x > 0 else -3.0
            world.add_body(shape, position=(x + side, 9.0 * k - 13.0), kind="static", sensor=True, user=name)
    seen, _ = watched(world, 12)
    assert (seen > 20) == (solver != "blocking")  # under which nothing is pushed


@pytest.mark.parametrize("continuous", [False, True])
@pytest.mark.parametrize("speed", [300.0, 2000.0, 9000.0])
@pytest.mark.parametrize("solver", SOLVERS)
def test_what_is_struck_into_a_sensor_is_told_in_that_step(solver, speed, continuous):
    """A resting body that is hit into a sensor is reported in the same step, although its swept
    box did not include it.
    """
    world = World(Effects.rigid_bodies().with_(continuous=continuous), solver=solver, gravity=(0.0, 0.0))
    world.add_body(Circle(6), position=(-12.1, 0.0), velocity=(speed, 0.0), user="circle")
    world.add_body(Circle(6), position=(0.0, 0.0), user="circle")
    for k in range(12):
        world.add_body(KINDS["pixels"][0], position=(20.0 + 30.0 * k, 3.0), kind="static", sensor=True, user="pixels")
    seen, _ = watched(world, 12)
    assert seen > 0 or solver == "blocking" or speed > 300.0


@pytest.mark.parametrize("snap", [True, False])
def test_a_sensor_sees_what_falls_asleep_in_it_and_what_is_woken(snap):
    world = World()
    world.add_body(Polygon.box(200, 20), position=(0, 30), kind="static", user="wall")
    world.add_body(PixelMask(np.ones((40, 60), bool), snap=snap), kind="static", sensor=True, user="tiles")
    for x in (-20.0, 0.0, 20.0):
        world.add_body(Polygon.box(10, 10), position=(x, 10.0), user="circle")
    moved = world.add_body(PixelMask(blob(3), snap=snap), position=(60.0, 8.0), user="pixels")
    assert watched(world, 80)[0] == 3 * 80
    assert not any(body.awake for body in world if body.kind == "dynamic")
    before = overlapping(world)
    moved.position = (0.0, -5.0)
    world.step()
    after = overlapping(world)
    assert len(before) == 3 and len(after) == 4
    assert pairs_of(world.events.sensor_begin) == after - before
    assert pairs_of(world.events.sensor_end) == before - after


@pytest.mark.parametrize("seed", range(2))
def test_sensors_go_on_when_the_solver_changes(seed):
    """An overlap with a sensor neither ends nor begins again when the solver changes."""
    rng = np.random.default_rng(seed)
    sensors = [(kind, "static") for kind in KINDS]
    world = crowd(Effects.rigid_bodies().with_(continuous=False), None, sensors, seed)
    now = set()
    for _ in range(24):
        world.solver = rng.choice(SOLVERS).item()
        world.step()
        begin, end = pairs_of(world.events.sensor_begin), pairs_of(world.events.sensor_end)
        assert not begin & now and end <= now
        now = (now | begin) - end
        assert now == overlapping(world), world.solver
