"""Characters in stacking worlds: they stand on bodies, are carried, push, load what they stand on, and are squeezed."""

import math

import numpy as np
import pytest

from physics import Capsule, Character, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World

EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, one_way=True)
BOX = Polygon.box(10, 20)
G = 640.0


def place(effects=EFFECTS, gravity=(0, G), **options):
    """Return a world with a floor whose top is y = 0."""
    world = World(effects, gravity=gravity, **options)
    world.add_body(Polygon.box(1600, 40), position=(0, 20), kind="static")
    return world


def standing(world, x, floor, **options):
    hero = Character(world, BOX, (x, floor - 10), **options)
    hero.move(0, 1)
    return hero


def play(world, steps, hero, dx=0.0, dy=2.0):
    """Move the hero by (dx, dy) and step the world, `steps` times. Return the list of results of hero.move."""
    told = []
    for _ in range(steps):
        told.append(hero.move(dx, dy))
        world.step()
    return told


SHAPES = {
    "box": (Polygon.box(32, 32), 16.0),
    "circle": (Circle(16), 16.0),
    "capsule": (Capsule((-12, 0), (12, 0), 10), 10.0),
    "rounded": (Polygon.box(20, 20, angle=0.0) if False else Polygon([(-8, -8), (8, -8), (8, 8), (-8, 8)], 6), 14.0),
    "mask": (PixelMask(np.ones((20, 30), bool)), 10.0),
}


@pytest.mark.parametrize("name", SHAPES)
def test_stands_on_a_dynamic_body_by_its_exact_shape(name):
    world = place()
    shape, half = SHAPES[name]
    body = world.add_body(shape, position=(0, -half), fixed_rotation=True)
    for _ in range(10):
        world.step()
    hero = Character(world, BOX, (0, -80))
    told = play(world, 60, hero)
    assert all(each.grounded and each.riding == body for each in told[-20:])
    assert abs(hero.position[1] + 10 + 2 * half) <= 1.0
    assert len({each.y for each in told[-20:]}) == 1, "no jitter"
    assert not any(each.squeezed for each in told)


def test_turned_and_round_bodies_block_where_they_are_and_not_where_their_boxes_are():
    world = place(gravity=(0, 0))
    world.add_body(Polygon.box(28, 28), position=(0, -60), angle=math.pi / 4)
    hero = Character(world, BOX, (-60, -60))
    hero.move(100, 0)
    tip = -14 * math.sqrt(2)
    assert tip - 1 <= hero.position[0] + 5 <= tip
    beside = Character(world, BOX, (-60, -60 - 10 - 12))  # its feet pass over the sloping flank
    beside.move(48, 0)
    assert beside.position[0] == -12


@pytest.mark.parametrize("sleeping", [False, True])
def test_stack_under_a_hero_neither_sinks_nor_jitters_and_sleeps_under_him(sleeping):
    world = place(EFFECTS.with_(sleeping=sleeping))
    boxes = [world.add_body(Polygon.box(32, 32), position=(0, -16 - 32 * k)) for k in range(3)]
    for _ in range(90):
        world.step()
    assert all(box.awake != sleeping for box in boxes)
    hero = standing(world, 3, -96)
    told = play(world, 200, hero)
    assert hero.position[1] == -106 and all(each.grounded and each.riding == boxes[2] for each in told[2:])
    assert all(each.x == each.y == 0 for each in told[2:])
    assert all(box.awake != sleeping for box in boxes), "asleep again with him on top"
    assert all(abs(box.position[0]) < 0.1 and abs(box.position[1] + 16 + 32 * k) < 0.7 for k, box in enumerate(boxes))
    hero.move(0, -30)
    world.step()
    if sleeping:
        assert all(box.awake for box in boxes), "his weight is gone"


@pytest.mark.parametrize("velocity", [(60.0, 0.0), (-45.0, 0.0), (0.0, -50.0), (0.0, 40.0), (30.0, -30.0)])
def test_lift_crate_and_hero_move_as_one(velocity):
    world = place()
    lift = world.add_body(Polygon.box(96, 16), position=(0, -200), kind="kinematic")
    crate = world.add_body(Polygon.box(32, 32), position=(0, -224), material=Material(friction=1.0))
    for _ in range(20):
        world.step()
    hero = standing(world, 0, -240)
    lift.velocity = velocity
    gaps = []
    for told in play(world, 120, hero):
        assert told.grounded and told.riding == crate and not told.squeezed
        gaps.append(hero.position[0] - crate.position[0])
        assert abs((crate.position[1] - 16) - (hero.position[1] + 10)) <= 1.0
    assert abs(crate.position[1] + 24 - lift.position[1]) < 0.7, "the crate was lifted with him on it"
    assert max(gaps) - min(gaps) <= 1.0, "with the remainder kept"
    x, y = hero.position
    assert hero.move(0, -8).y == -8 and not hero.move(0, 0).grounded, "he jumps off"


def test_carried_in_whole_pixels_with_the_remainder_by_a_slow_body():
    world = place(gravity=(0, 0))
    raft = world.add_body(Polygon.box(200, 10), position=(0, -50), velocity=(7.0, 0.0), fixed_rotation=True)
    hero = standing(world, 0, -55)
    for told in play(world, 300, hero, dy=1.0):
        assert told.grounded and abs(hero.position[0] - raft.position[0]) <= 0.5 + 1e-9
    assert raft.position[0] == pytest.approx(35.0, abs=0.2)


def test_a_turning_kinematic_plank_carries_by_the_point_under_the_feet():
    world = place(gravity=(0, 0))
    plank = world.add_body(Polygon.box(200, 10), position=(0, -100), kind="kinematic", angular_velocity=0.2)
    hero = standing(world, 60, -105)
    for _ in range(120):
        told = hero.move(0, 1.0)
        world.step()
        assert told.grounded and told.riding == plank
        x, y = hero.position
        surface = -100 + (x - plank.position[0]) * math.tan(plank.angle) - 5 / math.cos(plank.angle)
        assert abs(y + 10 - surface) <= 3.0
    assert plank.angle == pytest.approx(0.4) and hero.position[1] > -100


@pytest.mark.parametrize("speed", [30.0, 72.0])
def test_pushes_a_crate_at_the_speed_of_the_move_and_never_faster(speed):
    world = place()
    crate = world.add_body(Polygon.box(24, 24), position=(40, -12))
    hero = standing(world, 0, 0)
    fastest, start = 0.0, None
    for n in range(150):
        hero.move(speed / 60, 1.0)
        world.step()
        fastest = max(fastest, crate.velocity[0])
        assert crate.position[0] - 12 - (hero.position[0] + 5) >= -0.05
        if n == 89:
            start = crate.position[0]
    assert fastest <= speed * (1 + 1e-9)
    rubbed = 0.6 * G / 60  # what friction takes in each step, before he pushes again
    assert crate.position[0] - start == pytest.approx(speed - rubbed, abs=3.5), "a second of pushing"
    assert abs(crate.angle) < 0.01
    assert hero.position[0] + 5 > crate.position[0] - 12 - 2.5, "and he is right behind it"


def test_a_stack_too_heavy_stays_where_it_is():
    world = place()
    boxes = [world.add_body(Polygon.box(48, 48), position=(40, -24 - 48 * k)) for k in range(3)]
    for _ in range(30):
        world.step()
    hero = standing(world, 0, 0, push=500.0)
    before = [box.position[0] for box in boxes]
    told = play(world, 240, hero, dx=3.0, dy=1.0)
    assert told[-1].wall == 1 and told[-1].x == 0
    assert [box.position[0] for box in boxes] == pytest.approx(before, abs=0.02)


def test_strength_sets_how_quickly_a_crate_gets_going():
    world = place(EFFECTS.with_(friction=False))
    crate = world.add_body(Polygon.box(20, 20), position=(16, -10))
    hero = standing(world, 0, 0, mass=100.0, push=600.0)
    hero.move(4.0, 0.0)
    assert crate.velocity == (0.0, 0.0), "a force over the step, not a jolt"
    hero.move(4.0, 0.0)
    world.step()
    assert crate.velocity[0] == pytest.approx(2 * 100.0 * 600.0 / 60 / 400.0, rel=1e-9)
    still = world.add_body(Polygon.box(20, 20), position=(300, -10), kind="static")
    assert still.velocity == (0.0, 0.0)


def test_a_tall_crate_topples_when_it_is_pushed_high_up():
    world = place()
    tower = world.add_body(Polygon.box(8, 60), position=(30, -30), material=Material(friction=1.0))
    world.add_body(Polygon.box(40, 12), position=(-20, -6), kind="static")
    hero = standing(world, -5, -12, push=20000.0)
    play(world, 90, hero, dx=1.5, dy=1.0)
    assert abs(tower.angle) > 1.2


def test_a_plank_tips_under_his_weight():
    def tip(x):
        world = place()
        world.add_body(Polygon([(-6, 0), (6, 0), (0, -12)]), position=(0, 0), kind="static")
        plank = world.add_body(Polygon.box(160, 6), position=(0, -15), material=Material(friction=1.0))
        hero = Character(world, BOX, (x, -29))
        play(world, 40, hero)
        return plank.angle, hero, plank

    left, right = tip(-60)[0], tip(60)[0]
    assert left < -0.05 and right > 0.05
    assert left == pytest.approx(-right, rel=0.3)


def test_weight_is_mass_times_gravity_and_is_told_in_the_contacts():
    world = place()
    crate = world.add_body(Polygon.box(32, 32), position=(0, -16))
    hero = standing(world, 0, -32, mass=500.0)
    play(world, 60, hero)
    mine = world.contacts[
        (world.contacts["body_a"] == crate.id) & (world.contacts["body_b"] == hero.body.id)
        | (world.contacts["body_b"] == crate.id) & (world.contacts["body_a"] == hero.body.id)
    ]
    assert mine["normal_impulse"].sum() == pytest.approx(500.0 * G / 60)
    ground = world.contacts[(world.contacts["body_b"] == crate.id) & (world.contacts["body_a"] != hero.body.id)]
    per_second = (32 * 32 + 500.0) * G
    assert ground["normal_impulse"].sum() == pytest.approx(per_second / 60 * 1.0, rel=0.02) or ground[
        "normal_impulse"
    ].sum() == pytest.approx(per_second / 15, rel=0.02)


def test_landing_hands_on_his_momentum():
    world = place(gravity=(0, 0))
    raft = world.add_body(Polygon.box(100, 10), position=(0, -50), fixed_rotation=True)
    hero = Character(world, BOX, (0, -80), mass=500.0)
    hero.move(0, 20.0)
    assert raft.velocity[1] == pytest.approx(500.0 * 1200.0 / (500.0 + 1000.0)) and hero.move(0, 0).grounded
    hero.move(0, 5.0)
    assert raft.velocity[1] == pytest.approx(400.0), "only once"


def test_nothing_pins_him_to_a_wall_of_crates_and_none_holds_him_in_the_air():
    world = place()
    for k in range(3):
        world.add_body(Polygon.box(40, 40), position=(30, -20 - 40 * k))
    for _ in range(30):
        world.step()
    hero = Character(world, BOX, (4.5, -100))
    fell = sum(each.y for each in play(world, 40, hero, dx=2.0, dy=2.0))
    assert fell == 80
    rose = sum(hero.move(1.0, -4.0).y for _ in range(10))
    assert rose == -40


def test_a_crate_that_falls_on_his_head_is_stopped_by_it():
    world = place()
    hero = standing(world, 0, 0)
    crate = world.add_body(Polygon.box(40, 20), position=(0, -120))
    told = play(world, 90, hero, dy=1.0)
    assert abs(crate.position[1] + 30) < 1.0 and hero.position == (0, -10)
    assert not any(each.squeezed for each in told)
    told = play(world, 60, hero, dx=2.0, dy=1.0)
    assert hero.position[0] > 40 and crate.position[1] == pytest.approx(-10, abs=0.5), "he walks out from under it"


def test_a_lift_raises_him_and_the_crate_on_his_head_and_squeezes_him_under_a_ceiling():
    world = place()
    lift = world.add_body(Polygon.box(96, 16), position=(0, -100), kind="kinematic")
    hero = standing(world, 0, -108)
    crate = world.add_body(Polygon.box(40, 20), position=(0, -139))
    play(world, 30, hero, dy=1.0)
    lift.velocity = (0.0, -40.0)
    told = play(world, 90, hero, dy=1.0)
    assert not any(each.squeezed for each in told)
    assert crate.position[1] == pytest.approx(hero.position[1] - 20, abs=1.5) and hero.position[1] == pytest.approx(
        -178, abs=1.5
    )
    world.add_body(Polygon.box(200, 20), position=(0, crate.position[1] - 30), kind="static")
    # A third of a second to the ceiling, and as long until the crate gives way no more.
    assert any(each.squeezed for each in play(world, 50, hero, dy=1.0))


def test_a_piston_pushes_a_crate_and_the_crate_him_until_a_wall_squeezes_him():
    world = place()
    world.add_body(Polygon.box(40, 200), position=(120, -100), kind="static")
    piston = world.add_body(Polygon.box(20, 30), position=(0, -16), kind="kinematic", velocity=(40.0, 0.0))
    crate = world.add_body(Polygon.box(30, 30), position=(26, -15))
    hero = Character(world, BOX, (60, -10))
    told = []
    for _ in range(110):
        told.append(hero.move(0, 1.0).squeezed)
        world.step()
        if hero.position[0] < 95:
            assert piston.position[0] + 10 - (crate.position[0] - 15) < 2.0, "he does not hold the piston up"
            assert crate.position[0] + 15 - (hero.position[0] - 5) < 1.5
    assert hero.position[0] == 95 and any(told) and not any(told[:70])


def test_a_crate_that_is_raised_under_a_ceiling_squeezes_him():
    world = place()
    lift = world.add_body(Polygon.box(96, 16), position=(0, -100), kind="kinematic")
    world.add_body(Polygon.box(32, 32), position=(0, -124))
    hero = standing(world, 0, -140)
    world.add_body(Polygon.box(200, 20), position=(0, -190), kind="static")
    lift.velocity = (0.0, -30.0)
    told = play(world, 90, hero, dy=1.0)
    first = next(n for n, each in enumerate(told) if each.squeezed)
    assert 38 <= first <= 60 and hero.position[1] - 10 >= -181


def test_one_way_tiles_hold_a_crate_and_a_hero_alike():
    world = World(EFFECTS, gravity=(0, G))
    world.add_body(
        TileGrid(np.zeros((1, 10), bool), 16, one_way=np.ones((1, 10), bool)), position=(0, 0), kind="static"
    )
    crate = world.add_body(Polygon.box(16, 16), position=(40, 40), velocity=(0.0, -400.0), fixed_rotation=True)
    hero = Character(world, BOX, (110, 40))
    speed = -400.0
    for _ in range(100):
        speed += G / 60
        moved = hero.move(0, speed / 60)
        speed = 0.0 if moved.grounded and speed > 0 else speed
        world.step()
    assert hero.position[1] == -10 and moved.grounded
    assert crate.position[1] == pytest.approx(-8, abs=0.5)


def test_mass_and_push_need_stacking_and_are_checked():
    plain = World(Effects(response=True))
    for name in ("mass", "push"):
        with pytest.raises(ValueError, match=f"{name}.*stacking"):
            Character(plain, BOX, (0, 0), **{name: 5.0})
    world = place()
    for name, value in (("mass", 0.0), ("mass", -1.0), ("mass", math.nan), ("push", -1.0), ("push", math.inf)):
        with pytest.raises(ValueError, match=name):
            Character(world, BOX, (0, -100), **{name: value})
    with pytest.raises(TypeError, match="mass"):
        Character(world, BOX, (0, -100), mass="heavy")
    assert len(world.characters.rows) == 0 and len(world.bodies) == 1


def test_snapshot_and_digest_hold_what_a_walk_among_bodies_depends_on():
    def make():
        world = place(EFFECTS.with_(sleeping=True))
        world.add_body(Polygon.box(200, 10), position=(0, -60), kind="kinematic", velocity=(13.0, 0.0))
        for k in range(4):
            world.add_body(Polygon.box(20, 20), position=(20 * k, -75 - 3 * k))
        return world, Character(world, BOX, (-40, -75))

    def run(world, hero, steps):
        digests = []
        for n in range(steps):
            hero.move(1.3 if n % 90 < 60 else -1.1, -6.0 if n % 40 < 3 else 2.0)
            world.step()
            digests.append(world.digest())
        return digests

    first, second = make(), make()
    assert run(*first, 90) == run(*second, 90)
    taken = first[0].snapshot()
    after = run(*first, 60)
    first[0].restore(taken)
    assert run(*first, 60) == after
