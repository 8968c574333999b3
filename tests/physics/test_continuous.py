"""Fast bodies: time of impact in closed form, tunnelling with and without sweeps, and no loss of speed."""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Circle, Effects, PixelMask, Polygon, TileGrid, World

FAST = Effects(response=True, continuous=True)


def still_world(effects=FAST, **options):
    return World(effects, gravity=(0, 0), **options)


def test_disc_meets_disc_at_the_closed_form_time():
    """A disc hits another at the closed-form time and keeps its tangential velocity.

    It starts at (-3, 0.3) from the other with a velocity of (200, 0). The radii add up to 0.6, so they meet after
    0.012401923788647 s.
    """
    world = still_world(pixels_per_meter=1.0)
    world.add_body(Circle(0.5), kind="static")
    mover = world.add_body(Circle(0.1), position=(-3.0, 0.3), velocity=(200.0, 0.0), continuous="swept")
    world.step(1.0)
    assert mover.position[0] == pytest.approx(-3.0 + 200 * 0.012401923788647, abs=1e-12 * 200)
    assert math.hypot(*mover.position) == pytest.approx(0.6, abs=1e-12)
    assert mover.velocity[0] == pytest.approx(200 - 200 * (0.6**2 - 0.3**2) / 0.36, abs=1e-9), "the tangent is kept"


def test_two_discs_meet_at_nine_tenths():
    world = still_world(pixels_per_meter=1.0)
    one = world.add_body(Circle(0.5), velocity=(10.0, 0.0), continuous="swept")
    world.add_body(Circle(0.5), position=(10.0, 0.0), kind="static")
    world.step(1.0)
    assert one.position == pytest.approx((9.0, 0.0), abs=1e-12)


def test_disc_meets_box_corner_at_the_closed_form_time():
    world = still_world(pixels_per_meter=1.0)
    disc = world.add_body(Circle(1.0), position=(4.0, 4.0), velocity=(-3.0, -3.0), continuous="swept")
    world.add_body(Polygon.box(2, 2), kind="static")
    world.step(1.0)
    at = 1 + 1 / math.sqrt(2)
    assert disc.position == pytest.approx((at, at), abs=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.3, math.pi / 4, 2.0])
@pytest.mark.parametrize("wall", ["box", "tiles", "bounds"])
def test_box_stops_at_a_wall_where_it_touches(angle, wall):
    world = still_world()
    shape = {
        "box": Polygon.box(2, 200),
        "bounds": Bounds(Polygon.box(2, 200)),
        "tiles": TileGrid(np.ones((25, 1), bool), 8.0),
    }[wall]
    face = 50.0 if wall == "tiles" else 49.0
    world.add_body(shape, position=(50.0, -100.0 if wall == "tiles" else 0.0), kind="static")
    box = world.add_body(Polygon.box(6, 4), angle=angle, velocity=(60 * 300.0, 0.0), continuous="swept")
    world.step()
    reach = 3 * abs(math.cos(angle)) + 2 * abs(math.sin(angle))
    assert box.position == pytest.approx((face - reach, 0.0), abs=1e-9)
    assert len(world.events.begin) == 1 and world.events.begin["normal_x"][0] == pytest.approx(
        1.0 * (1 if world.events.begin["body_a"][0] == box.id else -1)
    )
    assert world.events.hits["speed"].tolist() == pytest.approx([60 * 300.0])


def random_shots(mode, seed, kind, effects=FAST, count=1000):
    """Shoot `count` fast bodies at a thin wall and return how many pass it without a contact. mode: value of
    `continuous`.
    """
    rng = np.random.default_rng(seed)
    world = still_world(effects)
    if kind == "tiles":
        world.add_body(TileGrid(np.ones((count, 1), bool), 8.0), position=(0.0, -4.0), kind="static")
    behind = []
    for k in range(count):
        y = 8.0 * k
        if kind == "box":
            world.add_body(Polygon.box(rng.uniform(0.05, 2), 7.5), position=(0.0, y), kind="static")
        elif kind == "circle":
            world.add_body(Circle(3.0), position=(0.0, y), kind="static")
        shape = Circle(float(rng.uniform(0.1, 2))) if rng.random() < 0.5 else Polygon.box(*rng.uniform(0.2, 2.5, 2))
        speed = rng.uniform(30, 3000) * 60
        behind.append(
            world.add_body(
                shape,
                position=(-20.0 - rng.uniform(0, 30), y + rng.uniform(-0.5, 0.5)),
                angle=rng.uniform(0, 7),
                velocity=(speed, 0.0),
                continuous=mode,
            ).id
        )
    met = set()
    for _ in range(4):
        world.step()
        met |= set(world.events.begin["body_a"].tolist()) | set(world.events.begin["body_b"].tolist())
    assert (world.bodies["x"][world.rows(sorted(set(behind) & met))] < 9.0).all() or kind == "circle" or mode == "off"
    return len(set(behind) - met)


@pytest.mark.parametrize("kind", ["box", "tiles", "circle"])
@pytest.mark.parametrize("mode", ["off", "ray", "swept", "auto"])
def test_fast_bodies_tunnel_when_off_and_never_when_on(mode, kind):
    count = 1000 if JIT else 60
    through = random_shots(mode, 3, kind, count=count)
    if mode == "off":
        assert through > 0.5 * count, "the test has teeth: without it they fly through"
    else:
        assert through == 0


def test_undeclared_continuous_lets_all_through_as_off_does():
    count = 200 if JIT else 40
    plain = Effects(response=True)
    assert random_shots("auto", 3, "box", plain, count) == random_shots("off", 3, "box", plain, count) > 0.5 * count


def test_discrete_miss_rate_is_one_minus_reach_over_step():
    """Discs of radius r that are not swept miss a wall of width w with a probability of 1 - (w + 2 r) / (v dt).

    The phases of the steps are random. Swept discs never miss.
    """
    count = 4000 if JIT else 300
    rng = np.random.default_rng(8)
    for mode in ("off", "swept"):
        world = still_world(Effects(continuous=True))
        world.add_bodies(Polygon.box(1.0, 9.0), [(0.0, 10.0 * k) for k in range(count)], kind="static")
        starts = [(-50.0 - 40.0 * phase, 10.0 * k) for k, phase in enumerate(rng.random(count))]
        world.add_bodies(Circle(1.0), starts, np.full((count, 2), (40.0 * 60, 0.0)), continuous=mode)
        met = set()
        for _ in range(4):
            world.step()
            met |= set(world.events.begin["body_b"].tolist())
        expected = 1 - (1 + 2) / 40 if mode == "off" else 0.0
        missed = 1 - len(met) / count
        assert missed == pytest.approx(expected, abs=3.5 * math.sqrt(0.075 * 0.925 / count) if mode == "off" else 0.0)


@pytest.mark.parametrize("speed", [300.0, 3000.0, 30000.0])
@pytest.mark.parametrize("shape", [Circle(6.0), Polygon.box(12, 12)], ids=["circle", "box"])
def test_slide_along_a_tile_floor_loses_no_speed(speed, shape):
    world = World(FAST.with_(gravity=True))
    length = 3000 if JIT else 800
    world.add_body(TileGrid(np.ones((1, length), bool), 16.0), kind="static")
    body = world.add_body(shape, position=(20.0, -6.0), velocity=(speed, 0.0), fixed_rotation=True)
    steps = min(60, int((16 * length - 100) / (speed / 60)))
    for _ in range(steps):
        world.step()
        assert body.velocity[0] == pytest.approx(speed, rel=1e-9) and abs(body.position[1] + 6.0) < 0.5
    assert body.position[0] == pytest.approx(20 + steps * speed / 60, rel=1e-9)


@pytest.mark.parametrize("speed", [500.0, 5000.0])
def test_landing_at_an_angle_keeps_the_speed_along_the_floor(speed):
    world = still_world()
    world.add_body(TileGrid(np.ones((2, 2000), bool), 16.0), kind="static")
    ball = world.add_body(Circle(4.0), position=(100.0, -60.0), velocity=(speed, speed))
    for _ in range(30):
        world.step()
    assert ball.velocity == pytest.approx((speed, 0.0), abs=1e-6 * speed) and ball.position[1] == pytest.approx(
        -4, abs=0.2
    )


def test_fast_body_that_starts_in_contact_moves_away_freely():
    for direction in ((1, 0), (0.7, 0.7), (0, 1)):
        world = still_world()
        world.add_body(Polygon.box(10, 200), position=(-5.0, 0.0), kind="static")
        ball = world.add_body(Circle(4.0), position=(4.0, 0.0), velocity=tuple(6000.0 * d for d in direction))
        world.step()
        assert ball.position == pytest.approx((4 + 100 * direction[0], 100 * direction[1]), abs=1e-9)


def test_two_fast_bodies_meet_head_on():
    world = still_world()
    one = world.add_body(Circle(2.0), position=(-60.0, 0.0), velocity=(6000.0, 0.0))
    two = world.add_body(Circle(2.0), position=(60.0, 0.0), velocity=(-6000.0, 0.0))
    for _ in range(3):
        world.step()
    assert one.position[0] < two.position[0], "they did not pass through each other"
    assert one.velocity[0] == pytest.approx(0.0, abs=1e-6) and len(world.contacts) == 1


def test_fast_body_stops_at_the_first_of_several_walls_in_any_order():
    for order in ([100, 60, 140], [140, 100, 60], [60, 100, 140]):
        world = still_world()
        for x in order:
            world.add_body(Polygon.box(1, 50), position=(float(x), 0.0), kind="static")
        ball = world.add_body(Circle(2.0), velocity=(60 * 200.0, 0.0))
        world.step()
        assert ball.position[0] == pytest.approx(57.5, abs=1e-9) and len(world.events.begin) == 1


def test_fast_body_passes_a_sensor_and_the_sensor_hears_it_once():
    world = World(FAST.with_(sensors=True), gravity=(0, 0))
    world.add_body(Polygon.box(2, 50), position=(60.0, 0.0), kind="static", sensor=True)
    world.add_body(Polygon.box(2, 50), position=(150.0, 0.0), kind="static")
    ball = world.add_body(Circle(2.0), velocity=(60 * 100.0, 0.0))
    begun = ended = 0
    for _ in range(6):
        world.step()
        begun += len(world.events.sensor_begin)
        ended += len(world.events.sensor_end)
    assert (begun, ended) == (1, 1) and ball.position[0] == pytest.approx(147.0, abs=1e-6)


def test_sensor_behind_the_wall_hears_nothing():
    world = World(FAST.with_(sensors=True), gravity=(0, 0))
    world.add_body(Polygon.box(2, 50), position=(60.0, 0.0), kind="static", sensor=True)
    world.add_body(Polygon.box(2, 50), position=(30.0, 0.0), kind="static")
    world.add_body(Circle(2.0), velocity=(60 * 100.0, 0.0))
    for _ in range(3):
        world.step()
        assert len(world.events.sensor_begin) == 0


def test_moving_wall_and_fast_body_meet_relative_to_each_other():
    world = still_world()
    wall = world.add_body(Polygon.box(2, 50), position=(60.0, 0.0), kind="kinematic", velocity=(-1200.0, 0.0))
    ball = world.add_body(Circle(2.0), velocity=(4800.0, 0.0))
    world.step()
    assert ball.position[0] + 2.0 <= wall.position[0] - 1.0 + 1e-6
    assert ball.velocity[0] == pytest.approx(-1200.0, abs=1e-6)


def test_fast_kinematic_paddle_takes_a_resting_ball_along():
    world = still_world()
    paddle = world.add_body(Polygon.box(2, 40), kind="kinematic", velocity=(1200.0, 0.0))
    ball = world.add_body(Circle(2.0), position=(25.0, 0.0))
    for _ in range(5):
        world.step()
        assert ball.position[0] >= paddle.position[0]


def test_no_fast_body_means_no_sweep():
    world = still_world()
    world.add_body(Polygon.box(10, 10), kind="static")
    world.add_body(Circle(5.0), position=(9.0, 0.0), velocity=(10.0, 0.0))
    world.step()
    assert world.profile.counters["toi_calls"] == 0 and len(world.contacts) == 1


def test_masks_are_not_swept_silently():
    """A fast mask with continuous collision stops at a thin wall, or adding it raises an error; it never passes
    unnoticed.
    """
    world = still_world()
    world.add_body(Polygon.box(2, 40), position=(30.0, 0.0), kind="static")
    try:
        body = world.add_body(PixelMask(np.ones((4, 4), bool)), velocity=(3000.0, 0.0), continuous="swept")
    except ValueError as refused:
        assert "continuous" in str(refused)
        return
    for _ in range(3):
        world.step()
    assert body.position[0] < 30.0
