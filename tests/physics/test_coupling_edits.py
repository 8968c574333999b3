"""Gears, pulleys and ratchets in the API: handles, columns, removal, breaking, sleep, snapshots, digests, bad input."""

import itertools
import math

import numpy as np
import pytest

import physics
from physics import (
    JIT,
    Angle,
    BruteForce,
    Character,
    Circle,
    Distance,
    Drive,
    DynamicTree,
    Effects,
    Gear,
    NoContact,
    Polygon,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Snapshot,
    SpatialHashGrid,
    SweepAndPrune,
    Weld,
    World,
    debug,
)

EFFECTS = Effects.rigid_bodies().with_(joints=True)
BOX = Polygon.box(20, 20)
G = 9.8 * 32.0
SOLVERS = ("soft_step", "sequential_impulse")
TIERS = ("iterative", "direct", "auto")


def run(world, steps):
    for _ in range(steps):
        world.step()


def wheel(world, x, y=0.0):
    body = world.add_body(Circle(20.0), position=(x, y))
    return body, world.add_joint(Revolute(None, body, at=(x, y)))


def geared(ratio=2.0, **more):
    """Return (world, hinges, gear) of two wheels coupled by a gear."""
    world = World(EFFECTS, **more)
    hinges = [wheel(world, 50.0 * k)[1] for k in range(2)]
    return world, hinges, world.add_joint(Gear(*hinges, ratio=ratio))


def hung(masses=(1.0, 1.0), **more):
    """Return (world, bodies, pulley) of two bodies that hang on a rope over two wheels."""
    world = World(EFFECTS)
    a, b = (world.add_body(Circle(6.0), position=(80.0 * k, 100.0), mass=mass) for k, mass in enumerate(masses))
    rope = Pulley(a, b, at_a=(0, 100), at_b=(80, 100), ground_a=(0, 0), ground_b=(80, 0), **more)
    return world, (a, b), world.add_joint(rope)


def machine(**more):
    """Return a world with gears that close a loop, a rack, a ratchet under a load, pulleys over a pile, and a chain."""
    world = World(EFFECTS, **more)
    world.add_body(Polygon.box(800, 20), position=(0, 200), kind="static")
    (_, first), (_, second), (_, third) = (wheel(world, 60.0 * k, -100.0) for k in range(3))
    for a, b, ratio in ((first, second, 2.0), (second, third, -0.5), (first, third, -1.0)):
        world.add_joint(Gear(a, b, ratio=ratio))
    first.motor = Drive(4.0, 1e7)
    rack = world.add_body(Polygon.box(8, 60), position=(200.0, -100.0))
    slide = world.add_joint(Prismatic(None, rack, at=(200.0, -100.0), axis=(0, 1)))
    world.add_joint(Gear(third, slide, ratio=0.05))
    arm = world.add_body(Polygon.box(60, 6), position=(-150.0, 0.0), angle=0.4)
    world.add_joint(Revolute(None, arm, at=(-180.0, 0.0)))
    world.add_joint(Ratchet(None, arm, phase=0.1, ratchet=0.25))
    boxes = [world.add_body(BOX, position=(-300.0 + 25.0 * k, 180.0)) for k in range(4)]
    for k, (a, b) in enumerate(itertools.pairwise(boxes)):
        x, y = a.position.x, b.position.x
        rope = Pulley(a, b, at_a=(x, 175), at_b=(y, 175), ground_a=(x, 0), ground_b=(y, 40), ratio=1.0 + k)
        world.add_joint(rope)
        a.velocity = 0.0, -60.0 * k
    before = None
    for k in range(6):
        link = world.add_body(Polygon.box(16, 4), position=(8.0 + 16.0 * k, 60.0))
        world.add_joint(Revolute(before, link, at=(16.0 * k, 60.0)))
        before = link
    world.add_joint(Gear(before, boxes[0], ratio=3.0))
    return world


# --- handles and columns ----------------------------------------------------------------------------------------------


def test_a_gear_names_its_joints_and_its_settings():
    world, (a, b), gear = geared()
    assert (gear.kind, gear.joint_a, gear.joint_b, gear.ratio, gear.phase) == ("Gear", a, b, 2.0, 0.0)
    assert gear.body_a == a.body_b and gear.body_b == b.body_b and gear in gear.body_a.joints
    assert gear.limits is None and gear.motor is None and "Gear" in repr(gear)
    a.motor = Drive(4.0, 1e7)
    run(world, 60)
    kept = a.angle, b.angle
    gear.ratio = -0.5
    assert gear.phase == pytest.approx(kept[0] - 0.5 * kept[1]), "the present poses stay"
    run(world, 120)
    assert b.speed == pytest.approx(8.0, rel=1e-3)
    a.motor = None
    gear.phase = gear.phase + 0.3
    run(world, 120)
    assert a.angle - 0.5 * b.angle == pytest.approx(gear.phase, abs=1e-3)
    for name in ("length", "ratchet"):
        with pytest.raises(AttributeError, match=f"{name} belongs to a .*; joint 2 is a Gear"):
            getattr(gear, name)
    with pytest.raises(AttributeError, match="ratio belongs to a Gear or Pulley; joint 0 is a Revolute"):
        a.ratio = 2.0
    for value, error in ((0.0, ValueError), (math.nan, ValueError), ("2", TypeError)):
        with pytest.raises(error, match="ratio must be"):
            gear.ratio = value
    with pytest.raises(ValueError, match="motor needs a joint with a coordinate; Gear has none"):
        gear.motor = Drive(1.0, 1.0)


def test_a_pulley_hauls_in_and_changes_its_ratio():
    world, (a, b), rope = hung()
    assert (rope.kind, rope.ratio, rope.length, rope.translation) == ("Pulley", 1.0, 200.0, 200.0)
    run(world, 30)
    rope.length = 150.0
    run(world, 200)
    assert rope.translation == pytest.approx(150.0, abs=0.2)
    before = a.position.y, b.position.y
    rope.ratio = 2.0
    assert rope.length == pytest.approx(rope.translation + b.position.y, abs=0.2)
    world.step()
    assert (a.position.y, b.position.y) == pytest.approx(before, abs=0.2), "it does not jump"
    for value in (0.0, -1.0, math.inf):
        with pytest.raises(ValueError, match="length must be finite and > 0"):
            rope.length = value
    with pytest.raises(ValueError, match="ratio must be finite and > 0"):
        rope.ratio = -2.0
    assert hung(rigid=True)[2].length == 200.0


def test_the_teeth_of_a_ratchet_can_be_changed():
    world = World(EFFECTS.with_(gravity=False))
    disc, _ = wheel(world, 0.0)
    joint = world.add_joint(Ratchet(None, disc, ratchet=0.5, phase=0.2))
    assert (joint.ratchet, joint.phase) == (0.5, 0.2) and joint.limits == pytest.approx((-0.3, math.inf))
    disc.angular_velocity = 1.0
    run(world, 60)
    assert joint.limits == pytest.approx((0.7, math.inf))
    joint.ratchet = -0.5
    assert joint.limits == pytest.approx((-math.inf, 1.2))
    run(world, 60)
    assert disc.angle == pytest.approx(1.2, abs=0.01)
    joint.phase = 0.0
    run(world, 30)
    assert joint.limits == pytest.approx((-math.inf, 1.5))
    for wrong, error in ((0.0, ValueError), (math.inf, ValueError), (None, TypeError)):
        with pytest.raises(error, match="ratchet must be"):
            joint.ratchet = wrong
    with pytest.raises(ValueError, match="limits of a Ratchet are its teeth"):
        joint.limits = (0.0, 1.0)
    joint.motor = Drive(-2.0, 1e7)
    run(world, 60)
    assert disc.angle < 0.0, "it winds by its own motor"


def test_many_couplings_are_added_in_one_call():
    world = World(EFFECTS)
    hinges = [wheel(world, 50.0 * k)[1] for k in range(6)]
    made = world.add_joints(Gear, hinges[:-1], [each.id for each in hinges[1:]], ratio=-1.0, user="train")
    assert made.tolist() == list(range(6, 11)) and world.joint(8).user == "train"
    balls = world.add_bodies(Circle(6.0), [(1000.0 + 20.0 * k, 100.0) for k in range(6)])
    tops = [(1000.0 + 20.0 * k, 0.0) for k in range(6)]
    ends = world.bodies[["x", "y"]][-6:].tolist()
    ropes = world.add_joints(
        Pulley, balls[:3], balls[3:], at_a=ends[:3], at_b=ends[3:], ground_a=tops[:3], ground_b=tops[3:], ratio=2.0
    )
    stops = world.add_joints(Ratchet, [None] * 6, [each.body_b for each in hinges], ratchet=0.2)
    assert len(ropes) == 3 and len(stops) == 6 and world.joints["upper"][11:14].tolist() == [300.0] * 3
    hinges[0].motor = Drive(3.0, 1e8)
    run(world, 60)
    assert world.joints["speed"][:6] == pytest.approx(3.0, rel=1e-6)
    assert world.profile.counters["joints_solved"] == 20
    with pytest.raises(ValueError, match="bodies_b must have as many entries as bodies_a"):
        world.add_joints(Gear, hinges, hinges[:2])
    with pytest.raises(TypeError, match="needs ground_b"):
        world.add_joints(Pulley, balls[:1], balls[1:2], at_a=ends[:1], at_b=ends[1:2], ground_a=tops[:1])
    with pytest.raises(TypeError, match="unexpected keyword argument 'teeth'"):
        world.add_joints(Gear, hinges[:1], hinges[1:2], teeth=3)


def test_columns_can_be_written_between_steps():
    world, (a, b), gear = geared(ratio=1.0)
    a.motor = Drive(2.0, 1e8)
    run(world, 2)
    world.joints["ratio"][2] = -4.0
    world.joints["phase"][2] = a.angle - 4.0 * b.angle
    run(world, 5)
    assert b.speed == pytest.approx(0.5, rel=1e-3) and gear.ratio == -4.0
    world, (_, b), rope = hung(masses=(1.0, 2.0))
    world.joints["upper"][0] = 120.0
    run(world, 300)
    assert rope.translation == pytest.approx(120.0, abs=0.5)


def test_debug_tells_where_couplings_act():
    world = machine()
    run(world, 30)
    drawn = debug.joints(world)
    gears = drawn[drawn["hold"] == 4]
    for row in gears[gears["joint_a"] >= 0]:
        assert (row["ax"], row["ay"]) == pytest.approx(world.joint(row["joint_a"]).anchor_b)
        assert (row["bx"], row["by"]) == pytest.approx(world.joint(row["joint_b"]).anchor_b)
    assert set(drawn["joint_a"][drawn["hold"] != 4].tolist()) == {-1}
    ropes = drawn[drawn["hold"] == 5]
    assert len(ropes) == 3 and ropes["ground_by"].tolist() == [40.0] * 3
    for row in ropes:
        way = np.array([row["bx"] - row["ground_bx"], row["by"] - row["ground_by"]])
        assert (row["axis_x"], row["axis_y"]) == pytest.approx(tuple(way / math.hypot(*way)))
        joint = world.joint(row["joint"])
        assert row["value"] == joint.translation and math.hypot(row["force_x"], row["force_y"]) == joint.force


# --- what happens to couplings ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", ["joint", "both joints", "gear too", "body", "break", "clear"])
def test_a_gear_goes_with_its_joint_and_is_told(way):
    world, (a, b), gear = geared()
    other = world.add_joint(Gear(gear.body_a, b))
    run(world, 2)
    match way:
        case "joint":
            a.remove()
        case "both joints":
            world.remove_joints([a, b])
        case "gear too":
            world.remove_joints([a, gear])
        case "body":
            a.body_b.remove()
        case "break":
            a.breaks = (1e-6, None)
        case "clear":
            world.clear()
    if way == "break":
        assert gear in world
        world.step()
    assert gear not in world
    if way != "break":
        world.step()
    told = {row["joint"].item(): row["reason"].item() for row in world.events.broken}
    expected = {
        "joint": {gear.id: "removed"},
        "both joints": {gear.id: "removed", other.id: "removed"},
        "gear too": {},
        "body": {a.id: "removed", gear.id: "removed", other.id: "removed"},
        "break": {a.id: "force", gear.id: "removed"},
        "clear": dict.fromkeys((a.id, b.id, gear.id, other.id), "removed"),
    }
    assert told == expected[way]
    world.step()
    assert not len(world.events.broken)


def test_a_gear_rests_while_a_joint_of_it_is_switched_off():
    world, (a, b), gear = geared(ratio=1.0)
    a.motor = Drive(2.0, 1e8)
    run(world, 5)
    b.enabled = False
    run(world, 5)
    assert not world.joints["awake"][2] and world.profile.counters["joints_solved"] == 1
    b.enabled = True
    run(world, 60)
    assert gear.awake and b.speed == pytest.approx(-2.0, rel=1e-3) and gear.separation < 1e-3


@pytest.mark.parametrize("kind", ["force", "torque", "rope"])
@pytest.mark.parametrize("most", [1.5, 4.0, 20.0])
def test_a_coupling_breaks_at_its_force_or_torque(most, kind):
    world = World(EFFECTS)
    if kind == "rope":
        world, (_, b), joint = hung(masses=(1e6, 1.0), breaks=(most * G, None))
        world.body(0).set_kind("kinematic")
        limit, push = most * G, lambda pull: b.apply_force((0.0, pull - G))
    else:
        _, hinge = wheel(world, 0.0)
        hinge.body_b.set_kind("static")
        body, other = wheel(world, 60.0) if kind == "torque" else (world.add_body(BOX, position=(60.0, 0.0)), None)
        other = other or world.add_joint(Prismatic(None, body, at=(60.0, 0.0), axis=(1, 0)))
        limit = most * 1e5
        breaks = (limit, None) if kind == "force" else (None, limit)
        joint = world.add_joint(Gear(hinge, other, ratio=0.5, breaks=breaks))
        push = body.apply_torque if kind == "torque" else lambda pull: body.apply_force((pull, 0.0))
    pull, told = 0.5 * limit, []
    while not told and pull < 3.0 * limit:
        push(pull)
        world.step()
        told = world.events.broken.tolist()
        pull *= 1.005
    assert pull == pytest.approx(limit, rel=0.02) and told[0][0] == joint.id
    assert told[0][-1] == ("torque" if kind == "torque" else "force") and joint not in world


def test_couplings_sleep_at_rest_and_wake_together():
    world, (a, b), rope = hung()
    run(world, 120)
    assert not a.awake and not b.awake and world.profile.counters["joints_solved"] == 0
    b.apply_impulse((0.0, 20.0))
    run(world, 2)
    assert a.awake and rope.awake
    slow = hung()[0]
    slow.body(0).velocity, slow.body(1).velocity = (0.0, 0.2), (0.0, -0.2)
    run(slow, 300)
    assert slow.body(0).position.y == pytest.approx(101.0, abs=0.02), "a balanced rope runs on, however slowly"


def test_gears_that_turn_slowly_go_on_and_balanced_arms_sleep():
    world, (a, b), _ = geared(ratio=1.0)
    a.body_b.angular_velocity, b.body_b.angular_velocity = 0.002, -0.002
    run(world, 600)
    assert a.body_b.awake and a.angle == pytest.approx(0.02, rel=0.01)
    world = World(EFFECTS.with_(drag=True), drag=1.0)
    hinges = []
    for x in (0.0, 200.0):
        arm = world.add_body(Polygon.box(60, 6), position=(x + 30.0, 0.0))
        hinges.append(world.add_joint(Revolute(None, arm, at=(x, 0.0))))
    world.add_joint(Gear(*hinges, ratio=1.0))
    run(world, 1200)
    assert not any(body.awake for body in world), "each holds the other level"
    assert [body.angle for body in world] == pytest.approx([0.0, 0.0], abs=0.01)


@pytest.mark.parametrize("solver", SOLVERS)
def test_an_arm_on_a_ratchet_sleeps(solver):
    world = World(EFFECTS.with_(drag=True), drag=0.5, solver=solver)
    arm = world.add_body(Polygon.box(60, 6), position=(30.0, 0.0))
    world.add_joint(Ratchet(None, arm, ratchet=-0.1))
    world.add_joint(Revolute(None, arm, at=(0.0, 0.0)))
    run(world, 200)
    assert arm.angle == pytest.approx(0.0, abs=0.02) and (solver != "soft_step" or not arm.awake)


def test_a_gear_links_the_islands_of_four_bodies():
    """A gear between the wheels of two flying carts links all four bodies in one island, so waking one wakes all."""
    world = World(EFFECTS.with_(gravity=False))
    carts = [world.add_body(BOX, position=(100.0 * k, 0.0)) for k in range(2)]
    wheels = [world.add_body(Circle(8.0), position=(100.0 * k, 20.0)) for k in range(2)]
    hinges = [world.add_joint(Revolute(c, w, at=w.position)) for c, w in zip(carts, wheels, strict=True)]
    world.add_joint(Gear(*hinges, ratio=1.0))
    run(world, 60)
    assert not any(body.awake for body in world)
    wheels[0].set_kind("static")
    run(world, 60)
    assert not any(body.awake for body in (*carts, wheels[1]))
    carts[0].angular_velocity = 1.0
    run(world, 10)
    assert carts[1].awake and wheels[1].awake and hinges[1].angle == pytest.approx(-hinges[0].angle, abs=0.02)


# --- the same, whatever finds and solves it ---------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
def test_four_broad_phases_give_one_digest(solver):
    digests = set()
    for strategy in (BruteForce(), SweepAndPrune(), SpatialHashGrid(), DynamicTree()):
        world = machine(broadphase=strategy, solver=solver)
        run(world, 120 if JIT else 20)
        digests.add(world.digest())
    assert len(digests) == 1 and np.isfinite(world.bodies["x"]).all()


@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_snapshot_in_mid_turn_goes_on_alike(solver, tier, tmp_path):
    world = machine(solver=solver)
    world.joint_solver = tier
    run(world, 25)
    taken = world.snapshot()
    taken.save(tmp_path / "turn.npz")
    run(world, 25)
    expected = world.digest()
    again = World(EFFECTS)
    again.restore(Snapshot.load(tmp_path / "turn.npz"))
    for other in (again, world):
        if other is world:
            other.restore(taken)
        run(other, 25)
        assert other.digest() == expected


def test_a_snapshot_without_a_coupled_joint_is_damaged():
    world, _, _ = geared()
    taken = world.snapshot()
    taken.arrays["joints"] = taken.arrays["joints"][1:]
    with pytest.raises(ValueError, match="a gear couples a joint that is not there"):
        world.restore(taken)


def test_a_snapshot_of_a_program_without_couplings_is_read(tmp_path):
    world = World(EFFECTS)
    wheel(world, 0.0)
    run(world, 5)
    taken = world.snapshot()
    names = [
        name for name in taken.arrays["joints"].dtype.names if name not in physics.snapshot.LATER_COLUMNS["joints"]
    ]
    old = np.zeros(1, [(name, taken.arrays["joints"].dtype[name]) for name in names])
    for name in names:
        old[name] = taken.arrays["joints"][name]
    expected, taken.arrays["joints"] = world.digest(), old
    taken.save(tmp_path / "old.npz")
    world.restore(Snapshot.load(tmp_path / "old.npz"))
    assert world.digest() == expected


def test_a_digest_tells_couplings_apart():
    def digest(make):
        world = World(EFFECTS)
        joints = [wheel(world, 50.0 * k)[1] for k in range(2)]
        world.add_joint(make(*joints, *(joint.body_b for joint in joints)))
        return world.digest()

    def rope(a, b, **more):
        return Pulley(a, b, at_a=(0, 0), at_b=(50, 0), ground_a=(0, -50), ground_b=(50, -50), **more)

    makes = [
        lambda p, q, a, b: Gear(p, q),
        lambda p, q, a, b: Gear(p, q, ratio=2.0),
        lambda p, q, a, b: Gear(p, q, phase=0.1),
        lambda p, q, a, b: Gear(q, p),
        lambda p, q, a, b: Gear(a, b),
        lambda p, q, a, b: Gear(a, q),
        lambda p, q, a, b: Ratchet(a, b, ratchet=0.1),
        lambda p, q, a, b: Ratchet(a, b, ratchet=0.2),
        lambda p, q, a, b: Ratchet(a, b, ratchet=0.2, phase=0.4),
        lambda p, q, a, b: rope(a, b),
        lambda p, q, a, b: rope(a, b, ratio=2.0, length=100.0),
        lambda p, q, a, b: rope(a, b, rigid=True),
    ]
    digests = [digest(make) for make in makes]
    assert len(set(digests)) == len(makes) and digests == [digest(make) for make in makes]


@pytest.mark.parametrize("scale", [1.0, 2.0**7])
def test_couplings_do_not_depend_on_the_unit_of_length(scale):
    def places(size):
        world = World(EFFECTS, pixels_per_meter=size)
        hinges = []
        for k in range(2):
            body = world.add_body(Circle(0.5 * size), position=((2.0 * k + 0.25) * size, 0.0))
            hinges.append(world.add_joint(Revolute(None, body, at=(2.0 * k * size, 0.0))))
        world.add_joint(Gear(*hinges, ratio=1.5))
        a, b = (world.add_body(Circle(0.2 * size), position=(k * size, 3.0 * size)) for k in (8.0, 10.0))
        world.add_joint(
            Pulley(a, b, *(body.position for body in (a, b)), (8.0 * size, 0.0), (10.0 * size, size), ratio=2.0)
        )
        run(world, 60)
        return [value for body in world for value in (body.position.x / size, body.position.y / size, body.angle)]

    assert places(scale) == places(32.0)


@pytest.mark.skipif(not JIT, reason="nothing is compiled")
@pytest.mark.parametrize("solver", SOLVERS)
def test_compiled_and_plain_kernels_give_the_same_bits(solver):
    from tests.both_forms import compared

    with compared() as seen:
        world = machine(solver=solver)
        run(world, 12)
        for name, value in (("ratio", math.nan), ("ratio", 1e300), ("ratchet", 1e-320), ("upper", -math.inf)):
            world.joints[name][:] = value
            run(world, 2)
    assert seen.calls > 100 and {"begin_couplings", "report_joints"} <= {name.split(".")[-1] for name in seen.kernels}


# --- bad input --------------------------------------------------------------------------------------------------------


def bad_couplings(world, hinge, slide, weld, rod, gone, a, b):
    rope = dict(at_a=(0, 0), at_b=(50, 0), ground_a=(0, -50), ground_b=(50, -50))
    fixed = world.add_body(BOX, kind="static", position=(500, 0)), world.add_body(BOX, kind="kinematic")
    hero = Character(world, BOX, (900, 0)).body
    elsewhere = World(EFFECTS)
    foreign = wheel(elsewhere, 0.0)
    return [
        (Gear(hinge, slide, ratio=0.0), ValueError, r"ratio must be finite and other than 0 \(got 0.0\)"),
        (Gear(hinge, slide, ratio=math.inf), ValueError, "ratio must be finite"),
        (Gear(hinge, slide, ratio="1"), TypeError, "ratio must be a number"),
        (Gear(hinge, slide, phase=math.nan), ValueError, "phase must be finite"),
        (Gear(hinge, weld), ValueError, r"joint_b must be a joint that turns or slides.*\(got joint \d+, a Weld\)"),
        (Gear(rod, hinge), ValueError, "joint_a must be a joint that turns or slides.*a Distance"),
        (Gear(hinge, hinge), ValueError, "joint_b must be another side than joint_a"),
        (Gear(a, a), ValueError, "joint_b must be another side than joint_a"),
        (Gear(hinge, gone), ValueError, r"joint_b must be a joint of this world \(got \d+: removed"),
        (Gear(hinge, 99), KeyError, "joint_b must be a joint of this world"),
        (Gear(hinge, -1), KeyError, "joint_b must be a joint of this world"),
        (Gear(hinge, None), TypeError, "joint_b must be a Joint, the id of one, or a Body"),
        (Gear("hinge", slide), TypeError, "joint_a must be a Joint"),
        (Gear(hinge, True), TypeError, "joint_b must be a Joint"),
        (Gear(hinge, foreign[0]), ValueError, "joint_b must be of this world"),
        (Gear(hinge, foreign[1]), ValueError, "joint_b must be of this world"),
        (Gear(*fixed), ValueError, "joint_a or joint_b must have a dynamic body"),
        (Gear(hinge, hero), ValueError, "joint_b must not be the body of a character"),
        (Gear(hinge, slide, breaks=5), TypeError, "breaks must be a pair"),
        (Pulley(a, a, **rope), ValueError, "b must be another body than a"),
        (Pulley(*fixed, **rope), ValueError, "a or b must be a dynamic body"),
        (Pulley(a, b, **rope, ratio=0.0), ValueError, "ratio must be finite and > 0"),
        (Pulley(a, b, **rope, ratio=-1.0), ValueError, "ratio must be finite and > 0"),
        (Pulley(a, b, **rope, length=0.0), ValueError, "length must be finite and > 0"),
        (Pulley(a, b, **rope, rigid=1), TypeError, "rigid must be True or False"),
        (Pulley(a, b, **{**rope, "ground_a": (math.nan, 0)}), ValueError, r"ground_a\[0\] must be finite"),
        (Pulley(a, b, **{**rope, "ground_b": 7}), TypeError, "ground_b must be a pair"),
        (Pulley(a, b, **{**rope, "ground_b": (50, 0)}), ValueError, "at_b and ground_b must be two points"),
        (Ratchet(a, b), ValueError, "ratchet must be given"),
        (Ratchet(a, b, ratchet=0.0), ValueError, "ratchet must be finite and other than 0"),
        (Ratchet(a, b, ratchet=math.nan), ValueError, "ratchet must be finite"),
        (Ratchet(a, b, ratchet=0.1, phase=math.inf), ValueError, "phase must be finite"),
        (Ratchet(a, a, ratchet=0.1), ValueError, "b must be another body than a"),
    ]


def test_a_bad_coupling_is_refused_and_changes_nothing():
    world = World(EFFECTS)
    (a, hinge), b = wheel(world, 0.0), world.add_body(BOX, position=(50.0, 0.0))
    slide = world.add_joint(Prismatic(None, b, at=(50, 0), axis=(0, 1)))
    weld, rod = world.add_joint(Weld(a, b, at=(25, 0))), world.add_joint(Distance(a, b, at_a=(0, 0), at_b=(50, 0)))
    gone = world.add_joint(Angle(a, b))
    gone.remove()
    bad = bad_couplings(world, hinge, slide, weld, rod, gone, a, b)
    world.step()
    before, number = world.digest(), len(world.joints)
    for joint, error, message in bad:
        with pytest.raises(error, match=message):
            world.add_joint(joint)
        assert world.digest() == before and len(world.joints) == number
    with pytest.raises(ValueError, match=r"bodies_b\[1\] must be a joint of this world"):
        world.add_joints(Gear, [hinge, hinge], [slide, gone])
    with pytest.raises(ValueError, match="joint_b must be a joint that turns or slides"):
        world.add_joints(Gear, [hinge, hinge], [slide, weld])
    assert world.digest() == before and len(world.joints) == number


def test_couplings_of_angles_need_rotation():
    world = World(EFFECTS.with_(rotation=False))
    a, b = world.add_body(BOX), world.add_body(BOX, position=(50.0, 0.0))
    slides = [world.add_joint(Prismatic(None, each, at=each.position, axis=(0, 1))) for each in (a, b)]
    for joint in (Gear(a, b), Gear(slides[0], b), Ratchet(a, b, ratchet=0.1)):
        with pytest.raises(ValueError, match="needs the effect rotation"):
            world.add_joint(joint)
    world.add_joint(Gear(*slides, ratio=1.0))
    run(world, 60)
    assert a.position.y == pytest.approx(0.0, abs=0.01), "two equal weights over one rack"


def test_couplings_need_a_solver_that_stacks():
    world = World(EFFECTS, solver="projection")
    a, b = world.add_body(BOX), world.add_body(BOX, position=(50.0, 0.0))
    for joint in (Gear(a, b), Ratchet(a, b, ratchet=1.0), NoContact(a, b)):
        with pytest.raises(ValueError, match="soft_step, sequential_impulse"):
            world.add_joint(joint)
