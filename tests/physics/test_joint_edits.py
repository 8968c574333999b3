"""The API of joints: handles, columns, many at once, removal, breaking, digests and bad input."""

import math

import pytest

import physics
from physics import (
    Angle,
    Character,
    Circle,
    Distance,
    Drive,
    Effects,
    Motor,
    NoContact,
    Polygon,
    Prismatic,
    Revolute,
    Spring,
    Target,
    Weld,
    Wheel,
    World,
    debug,
)

EFFECTS = Effects.rigid_bodies().with_(joints=True)
BOX = Polygon.box(20, 20)
G = 9.8 * 32.0


def two(**more):
    world = World(EFFECTS, **more)
    return world, world.add_body(BOX), world.add_body(BOX, position=(30.0, 0.0))


def every_kind(a, b):
    return [
        Revolute(a, b, at=(15, 0)),
        Prismatic(a, b, at=(15, 0), axis=(1, 2)),
        Wheel(a, b, at=(15, 0)),
        Distance(a, b, at_a=(0, 0), at_b=(30, 0)),
        Weld(a, b, at=(15, 0)),
        Angle(a, b, spring=Spring(2.0)),
        Motor(a, b, max_force=1e5, max_torque=1e5),
        Target(b, at=(30, 0), point=(50, 0)),
        NoContact(a, b),
    ]


def run(world, steps):
    for _ in range(steps):
        world.step()


# --- handles --------------------------------------------------------------------------------------------------------


def test_a_handle_names_its_joint_and_its_bodies():
    world, a, b = two()
    joint = world.add_joint(Revolute(a, b, at=(15, 0), user="pin", breaks=(1e6, None)))
    assert (joint.kind, joint.body_a, joint.body_b, joint.user) == ("Revolute", a, b, "pin")
    assert joint.breaks == (1e6, math.inf) and joint.limits is None and joint.motor is None and joint.spring is None
    assert a.joints == b.joints == (joint,) and world.joint(joint.id) == joint and world.joint(joint) == joint
    assert len(world.joints) == 1 and joint in world and joint.anchor_a == joint.anchor_b == (15.0, 0.0)
    assert "Revolute" in repr(joint) and "body 0" in repr(joint)
    joint.motor = Drive(2.0, max=5e6)
    joint.limits = (-1.0, None)
    joint.spring = Spring(3.0, 0.5, target=0.2)
    assert joint.motor == Drive(2.0, 5e6) and joint.limits == (-1.0, math.inf) and joint.spring == Spring(3.0, 0.5, 0.2)
    joint.remove()
    assert joint not in world and not len(world.joints) and a.joints == ()
    for use in (lambda: joint.angle, lambda: joint.remove(), lambda: setattr(joint, "enabled", True)):
        with pytest.raises(KeyError, match="joint 0 is not in this world|no joint 0"):
            use()


def test_ids_of_joints_are_not_used_again():
    world, a, b = two()
    first = world.add_joint(NoContact(a, b))
    first.remove()
    assert world.add_joint(NoContact(a, b)).id > first.id


@pytest.mark.parametrize("number", range(9))
def test_every_kind_acts_and_can_be_switched_off_and_on(number):
    world, a, b = two()
    joint = world.add_joint(every_kind(a, b)[number])
    run(world, 3)
    joint.enabled = False
    run(world, 2)
    assert not joint.awake and world.profile.counters["joints_solved"] == 0
    joint.enabled = True
    run(world, 2)
    assert world.profile.counters["joints_solved"] == (0 if joint.kind == "NoContact" else 1)


def test_many_joints_are_added_in_one_call():
    world = World(EFFECTS)
    ids = world.add_bodies(Polygon.box(28, 6), [(15.0 + 30.0 * k, 0.0) for k in range(40)])
    made = world.add_joints(Revolute, ids[:-1], ids[1:], at=[(30.0 * (k + 1), 0.0) for k in range(39)])
    ends = world.add_joints(Revolute, [None, None], ids[[0, -1]], at=[(0.0, 0.0), (1200.0, 0.0)])
    assert made.tolist() == list(range(39)) and ends.tolist() == [39, 40]
    run(world, 120)
    assert world.joints["separation"].max() < 0.1
    one_by_one = World(EFFECTS)
    ids = one_by_one.add_bodies(Polygon.box(28, 6), [(15.0 + 30.0 * k, 0.0) for k in range(40)])
    for k in range(39):
        one_by_one.add_joint(Revolute(ids[k], ids[k + 1], at=(30.0 * (k + 1), 0.0)))
    for body, x in ((ids[0], 0.0), (ids[-1], 1200.0)):
        one_by_one.add_joint(Revolute(None, body, at=(x, 0.0)))
    run(one_by_one, 120)
    assert world.digest() == one_by_one.digest()
    world.remove_joints({*made.tolist()})
    assert world.joints["id"].tolist() == [39, 40]
    rods = world.add_joints(
        Distance, ids[:2], ids[2:4], at_a=world.bodies[["x", "y"]][:2].tolist(), at_b=[(0, 0), (5, 5)]
    )
    assert len(rods) == 2


def test_columns_can_be_written_between_steps():
    world, a, _ = two(gravity=(0, 0))
    joint = world.add_joint(Revolute(None, a, at=(0, 0), motor=Drive(1.0, 1e9)))
    world.joints["motor_speed"][:] = -3.0
    run(world, 2)
    assert joint.speed == pytest.approx(-3.0) and a.angular_velocity == pytest.approx(-3.0)


def test_debug_tells_anchors_axes_limits_and_forces():
    world, a, b = two()
    world.add_joint(Revolute(None, a, at=(5, 5), limits=(-0.5, 0.5)))
    world.add_joint(Prismatic(a, b, at=(15, 0), axis=(3, 4), limits=(-2, 8)))
    world.add_joint(Distance(None, b, at_a=(60, -80), at_b=(30, 0)))
    run(world, 90)
    drawn = debug.joints(world)
    for row, joint in zip(drawn, (world.joint(k) for k in range(3)), strict=True):
        assert (row["ax"], row["ay"]) == pytest.approx(joint.anchor_a) and row["joint"] == joint.id
        assert (row["bx"], row["by"]) == pytest.approx(joint.anchor_b)
        assert math.hypot(row["axis_x"], row["axis_y"]) == pytest.approx(1.0)
        assert math.hypot(row["force_x"], row["force_y"]) == pytest.approx(joint.force)
    angle = math.atan2(0.8, 0.6) + a.angle
    assert (drawn["axis_x"][1], drawn["axis_y"][1]) == pytest.approx((math.cos(angle), math.sin(angle)))
    assert drawn["value"].tolist() == pytest.approx([a.angle, world.joint(1).translation, world.joint(2).translation])
    assert drawn["lower"][:2].tolist() == [-0.5, -2.0] and len(debug.joints(World(EFFECTS))) == 0


# --- what happens to joints -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("substeps", [4, "auto"])
@pytest.mark.parametrize("most", [1.1, 2.0, 5.0, 20.0])
def test_a_joint_breaks_at_its_force_and_is_told_once(most, substeps):
    world = World(EFFECTS, substeps=substeps)
    box = world.add_body(BOX, position=(0.0, 50.0))
    joint = world.add_joint(Distance(None, box, at_a=(0, 0), at_b=(0, 50), breaks=(most * box.mass * G, None)))
    pull, told = 1.0, []
    while not told and pull < 30.0:
        world.step()
        told += world.events.broken.tolist()
        if not told:
            pull *= 1.005
            box.apply_force((0.0, (pull - 1.0) * box.mass * G))
    (identity, body_a, body_b, force, torque, reason), *others = told
    assert not others and (identity, body_a, body_b, torque, reason) == (joint.id, -1, box.id, 0.0, "force")
    assert pull == pytest.approx(most, rel=0.02) and force >= most * box.mass * G
    world.step()
    assert not len(world.events.broken) and not len(world.joints)
    run(world, 10)
    assert box.velocity.y > 20.0, "it falls"


def test_a_torque_breaks_a_weld():
    world, a, b = two(gravity=(0, 0))
    world.add_joint(Weld(a, b, at=(15, 0), breaks=(None, 10.0)))
    a.apply_torque(1e7)
    b.apply_torque(-1e7)
    world.step()
    assert world.events.broken["reason"].tolist() == ["torque"]


@pytest.mark.parametrize("way", ["one", "many", "clear"])
def test_a_removed_body_takes_its_joints_along(way):
    world, a, b = two()
    c = world.add_body(BOX, position=(60.0, 0.0))
    first, second = world.add_joint(Revolute(a, b, at=(15, 0))), world.add_joint(Revolute(b, c, at=(45, 0)))
    world.step()
    if way == "one":
        a.remove()
    elif way == "many":
        world.remove_bodies([a])
    else:
        world.clear()
    assert first not in world and (second in world) is (way != "clear")
    world.step()
    told = world.events.broken
    assert set(told["reason"]) == {"removed"} and first.id in told["joint"]
    world.step()
    assert not len(world.events.broken)


def test_a_joint_is_idle_while_no_side_is_dynamic():
    world, a, b = two()
    joint = world.add_joint(Weld(a, b, at=(15, 0)))
    a.set_kind("static")
    b.set_kind("kinematic")
    run(world, 3)
    assert not joint.awake and joint in world
    b.set_kind("dynamic")
    run(world, 30)
    assert joint.awake and b.position.y == pytest.approx(0.0, abs=0.2)


def test_teleported_bodies_are_drawn_together_slowly():
    """Jointed bodies that were moved apart are pulled together no faster than overlaps are separated, at 3 m/s."""
    world, a, b = two(gravity=(0, 0))
    world.add_joint(Weld(a, b, at=(15, 0)))
    b.position = 400.0, 0.0
    before = b.position.x
    while world.time < 0.5:
        world.step()
        assert abs(b.position.x - before) <= 96.0 * world.dt * 1.01
        before = b.position.x
    run(world, 400)
    assert math.dist(a.position, b.position) == pytest.approx(30.0, abs=0.2)


def test_several_joints_of_a_pair_and_a_loop_hold():
    world, a, b = two()
    for y in (-8.0, 8.0):
        world.add_joint(Revolute(a, b, at=(15.0, y)))
    world.add_joint(Distance(None, a, at_a=(0, -40), at_b=(0, 0)))
    world.add_joint(Distance(None, b, at_a=(30, -40), at_b=(30, 0)))
    run(world, 240)
    assert world.joints["separation"].max() < 0.1
    assert b.angle == pytest.approx(0.0, abs=0.02)


def test_a_digest_tells_joints_apart():
    def digest(**more):
        world, a, b = two()
        world.add_joint(Revolute(a, b, at=(15, 0), **more))
        return world.digest()

    assert digest() == digest()
    assert (
        len(
            {
                digest(),
                digest(limits=(0, 1)),
                digest(motor=Drive(1, 2)),
                digest(spring=Spring(2)),
                digest(breaks=(1, 1)),
            }
        )
        == 5
    )


# --- bad input ------------------------------------------------------------------------------------------------------


def bad_joints(a, b):
    pin = dict(at=(15, 0))
    return [
        (Revolute(a, a, **pin), ValueError, "b must be another body than a"),
        (Revolute(None, None, **pin), ValueError, "the world"),
        (Revolute(a, b, at=(math.nan, 0)), ValueError, r"at\[0\] must be finite"),
        (Revolute(a, b, at=3), TypeError, "at must be a pair"),
        (Revolute(a, b, limits=(2, 1), **pin), ValueError, r"limits must be \(low, high\) with low <= high"),
        (Revolute(a, b, limits=3, **pin), TypeError, "limits must be a pair"),
        (Revolute(a, b, limits=(math.nan, 1), **pin), ValueError, r"limits\[0\]"),
        (Revolute(a, b, motor=4.0, **pin), TypeError, "motor must be a Drive"),
        (Revolute(a, b, spring=4.0, **pin), TypeError, "spring must be a Spring"),
        (Revolute(a, b, breaks=5, **pin), TypeError, "breaks must be a pair"),
        (Revolute(a, b, breaks=(0, 1), **pin), ValueError, r"breaks\[0\] must be finite and > 0"),
        (Revolute(a, b, contacts=1, **pin), TypeError, "contacts must be True or False"),
        (Revolute(a, b, local="no", **pin), TypeError, "local must be True or False"),
        (Revolute(a, 99, **pin), KeyError, "99"),
        (Revolute(a, "b", **pin), TypeError, "b must be a Body or an id"),
        (Prismatic(a, b, axis=(0, 0), **pin), ValueError, "axis must have a length"),
        (Prismatic(a, b, axis=5, **pin), TypeError, "axis must be a pair"),
        (Distance(a, b, at_a=(1, 1), at_b=(1, 1)), ValueError, "at_a and at_b must be two points"),
        (Distance(a, b, at_a=(0, 0), at_b=(30, 0), length=-1.0), ValueError, "length must be finite and > 0"),
        (Distance(a, b, at_a=(0, 0), at_b=(30, 0), limits=(-1, 5)), ValueError, r"limits\[0\] must be finite and >= 0"),
        (Motor(a, b, max_force=1.0), ValueError, "max_torque must be given"),
        (Motor(a, b, max_force=-1.0, max_torque=1.0), ValueError, "max_force must be finite and >= 0"),
        (Target(b, at=(0, 0), point=(math.inf, 0)), ValueError, r"point\[0\]"),
        ("hinge", TypeError, "joint must be one of Revolute, Prismatic"),
        (Revolute, TypeError, "joint must be one of"),
    ]


@pytest.mark.parametrize("number", range(len(bad_joints(0, 1))))
def test_a_bad_joint_is_refused_and_changes_nothing(number):
    world, a, b = two()
    world.step()
    before = world.digest()
    joint, error, message = bad_joints(a, b)[number]
    with pytest.raises(error, match=message):
        world.add_joint(joint)
    assert world.digest() == before and not len(world.joints)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: Drive(2.0), ValueError, "max must be given"),
        (lambda: Drive(math.nan, 1.0), ValueError, "speed must be finite"),
        (lambda: Drive(1.0, -1.0), ValueError, "max must be finite and >= 0"),
        (lambda: Spring(-2.0), ValueError, "hertz must be finite and > 0"),
        (lambda: Spring(2.0, -1.0), ValueError, "damping must be finite and >= 0"),
        (lambda: Spring(2.0, 1.0, "far"), TypeError, "target must be a number"),
    ],
)
def test_bad_settings_are_refused(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_a_joint_needs_its_effect_and_a_stacking_solver():
    with pytest.raises(ValueError, match="joints needs stacking"):
        Effects(response=True, joints=True)
    with pytest.raises(ValueError, match="joints needs response"):
        Effects(joints=True)
    world = World(Effects.rigid_bodies())
    a, b = world.add_body(BOX), world.add_body(BOX, position=(30, 0))
    for add in (
        lambda: world.add_joint(Revolute(a, b, at=(15, 0))),
        lambda: world.add_joints(Revolute, [a], [b], at=[(15, 0)]),
    ):
        with pytest.raises(ValueError, match="joints: declare it in Effects"):
            add()
    assert "joints" not in world.stages
    jointed, a, b = two()
    jointed.add_joint(Revolute(a, b, at=(15, 0)))
    for solver in ("projection", "blocking"):
        with pytest.raises(ValueError, match="soft_step.*sequential_impulse|sequential_impulse.*soft_step"):
            jointed.solver = solver
        other = World(EFFECTS, solver=solver)
        box = other.add_body(BOX)
        with pytest.raises(ValueError, match="soft_step, sequential_impulse"):
            other.add_joint(Revolute(None, box, at=(0, 0)))
    with pytest.raises(ValueError, match="joint_solver must be one of iterative, direct, auto"):
        jointed.joint_solver = "exact"


def test_a_character_takes_no_joint():
    world, a, _ = two()
    hero = Character(world, BOX, (100, 0))
    with pytest.raises(ValueError, match="character"):
        world.add_joint(Revolute(a, hero.body, at=(50, 0)))


def test_two_fixed_bodies_take_no_joint():
    world = World(EFFECTS)
    a, b = world.add_body(BOX, kind="static"), world.add_body(BOX, kind="kinematic", position=(30, 0))
    for sides in ((a, b), (a, None), (None, b)):
        with pytest.raises(ValueError, match="a or b must be a dynamic body"):
            world.add_joint(Weld(*sides, at=(0, 0)))


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda w: w.add_joints(Revolute, [0], [1, 0], at=[(0, 0)]), ValueError, "bodies_b must have as many"),
        (lambda w: w.add_joints(Revolute, [0], [1], at=[(0, 0), (1, 1)]), ValueError, "at must have 1 rows"),
        (lambda w: w.add_joints(Revolute, [0], [1]), TypeError, "needs at"),
        (
            lambda w: w.add_joints(Revolute, [0], [1], at=[(0, 0)], axle=3),
            TypeError,
            "unexpected keyword argument 'axle'",
        ),
        (lambda w: w.add_joints("pin", [0], [1], at=[(0, 0)]), TypeError, "kind must be one of"),
        (
            lambda w: w.add_joints(Prismatic, [0], [1], at=[(0, 0)], axis=[(0, 0)]),
            ValueError,
            "axis must have a length",
        ),
        (lambda w: w.remove_joints([5]), KeyError, "no joint 5"),
        (lambda w: w.remove_joints("all"), TypeError, "joint must be a Joint or an id"),
        (lambda w: w.joint(7), KeyError, "no joint 7"),
    ],
)
def test_bad_calls_for_many_joints_are_refused(call, error, message):
    world, *_ = two()
    with pytest.raises(error, match=message):
        call(world)
    assert not len(world.joints)


def test_nothing_changes_during_a_step():
    world, a, b = two()
    joint = world.add_joint(Revolute(a, b, at=(15, 0)))
    from physics.step import staged_step

    steps = staged_step(world)
    next(steps)
    for change in (joint.remove, lambda: setattr(joint, "motor", None), lambda: world.add_joint(NoContact(a, b))):
        with pytest.raises(RuntimeError):
            change()
    for _ in steps:
        pass


def test_names_are_public():
    for name in (
        "Angle",
        "Distance",
        "Drive",
        "Gear",
        "Joint",
        "Motor",
        "NoContact",
        "Prismatic",
        "Pulley",
        "Ratchet",
        "Revolute",
        "Spring",
        "Target",
        "Weld",
        "Wheel",
    ):
        assert name in physics.__all__
    assert Circle is physics.Circle
