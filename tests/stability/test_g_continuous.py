"""Hard cases of continuous collision (section G): with it no body passes a thin wall, without it most do."""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Effects, Material, Polygon, Segment, TileGrid, World, time_of_impact
from tests.stability.invariants import Watch, movers
from tests.stability.piles import column, floor, metres, needs_speed, pile_effects
from tests.stability.settings import generator

FAST = pile_effects(continuous=True)
STILL = pile_effects(continuous=True, gravity=False)


def flying(effects=STILL, **options):
    """Return a world without gravity."""
    return metres(gravity=(0, 0), effects=effects, **options)


@pytest.mark.parametrize("offset", [0.0, 1e7])
def test_g1_ball_at_200_stops_at_a_thin_wall_wherever_it_is(measured, offset):
    world = flying()
    world.add_body(Polygon.box(0.1, 4.0), position=(offset, 0.0), kind="static")
    ball = world.add_body(Circle(0.1), position=(offset + 10.0, 0.0), velocity=(-200.0, 0.0))
    Watch(world).step(30)
    measured("G1", "distance from the wall's middle", ball.position[0] - offset)
    measured("G1", "distance at most", ball.position[0] - offset)


WALLS = {"box": Polygon.box(0.1, 8), "segment": Segment((0, -4), (0, 4)), "chain": Chain([(0, 4), (0, 0), (0, -4)])}


@pytest.mark.parametrize("angle", [0.0, 0.4])
@pytest.mark.parametrize("wall", WALLS)
@pytest.mark.parametrize(
    "shape, speed",
    [(Circle(0.2), 400.0), (Polygon.box(0.2, 0.2), 200.0), (Capsule((-0.1, 0), (0.1, 0), 0.1), 300.0)],
    ids=["ball", "box", "capsule"],
)
def test_g2_walls_of_any_shape_stop_and_let_through_when_off(measured, shape, speed, wall, angle):
    for mode in ("auto", "toi", "off"):
        world = flying()
        world.add_body(WALLS[wall], angle=angle, kind="static")
        # The normal of the chain is (-1, 0): solid from the left, where the body comes from.
        body = world.add_body(
            shape, position=(-12.3, 0.05), velocity=(speed, 0.0), continuous=mode, material=Material(friction=0.0)
        )
        Watch(world).step(12)
        along = body.position[0] * math.cos(angle) + body.position[1] * math.sin(angle)
        measured("G2", "beyond the wall, sweep off: passes" if mode == "off" else "beyond the wall, swept", along)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("bullet", [False, True])
def test_g3_the_sweep_does_not_eat_the_speed_of_the_impact(measured, restitution, bullet):
    """The hit event reports the full impact speed of 400, and the ball leaves at e times this speed."""
    world = flying()
    world.add_body(Polygon.box(2, 8), position=(1.0, 0.0), kind="static")
    ball = world.add_body(
        Circle(0.2),
        position=(-10.0, 0.0),
        velocity=(400.0, 0.0),
        bullet=bullet,
        material=Material(restitution=restitution),
    )
    speeds = []
    for _ in range(6):
        Watch(world).step()
        speeds += world.events.hits["speed"].tolist()
    (speed,) = speeds
    measured("G3", "error of the speed that the hit tells", abs(speed - 400.0))
    measured("G3", "error of the speed it leaves with", abs(ball.velocity[0] + 400.0 * restitution))
    assert ball.position[0] <= -0.2 + 1e-6


def test_g4_long_steps_stop_at_the_wall_and_not_before(measured):
    """A ball in long steps moves on until it reaches a wall, and stops there.

    It has a radius of 0.5 and moves 5 m in each step of 0.25 s, towards a wall face at x = 12.2. After the step of the
    impact 11.35 < x < 11.71; then it is at rest.
    """
    world = flying(dt=0.25)
    world.add_body(Polygon.box(2, 8), position=(13.2, 0.0), kind="static")
    ball = world.add_body(Circle(0.5), velocity=(20.0, 0.0))
    for n in (1, 2):
        world.step()
        measured("G4", "error of the free steps", abs(ball.position[0] - 5.0 * n))
        assert ball.velocity[0] == pytest.approx(20.0, abs=1e-9)
    world.step()
    measured("G4", "place of the impact", ball.position[0])
    measured("G4", "place of the impact, at most", ball.position[0])
    world.step()
    world.step()
    measured("G4", "speed afterwards", abs(ball.velocity[0]))
    assert 11.35 < ball.position[0] < 11.75


def test_g5_disc_that_lies_on_the_floor_slides_freely(measured):
    world = metres(effects=FAST)
    floor(world, friction=0.0, width=400.0)
    disc = world.add_body(Circle(0.5), position=(0.0, -0.5), velocity=(50.0, 0.0), material=Material(friction=0.0))
    Watch(world).step(30)
    measured("G5", "way", disc.position[0])
    measured("G5", "speed lost", abs(disc.velocity[0] - 50.0))
    assert disc.position[0] == pytest.approx(25.0, rel=1e-9)


def lowest_over(ground, shape, start):
    """Throw a shape down at 100 m/s at five angles; return how far [m] its centre of mass gets
    below ground at y = 0.
    """
    world = metres(effects=FAST)
    if ground == "bevelled":
        world.add_body(Chain([(-20, 0), (-1, 0), (-0.5, -0.5), (0.5, -0.5), (1, 0), (20, 0)]), kind="static")
    elif ground == "flat":
        floor(world)
    else:
        world.add_bodies(Segment((-0.125, 0), (0.125, 0)), [(0.25 * k, 0.0) for k in range(-80, 81)], kind="static")
    lowest = -math.inf
    for k, angle in enumerate((0.0, 0.05, 0.7, math.pi / 2, 2.0)):
        body = world.add_body(
            shape,
            position=(start[0] + 0.37, start[1] - 3 * k),
            angle=angle if ground != "bevelled" else 0.0,
            velocity=(0.0, 100.0),
        )
        watch = Watch(world, capped=True)
        for _ in range(90 if JIT else 30):
            watch.step()
            lowest = max(lowest, body.center[1])
        world.remove_body(body)
    return lowest


GROUNDS = pytest.mark.parametrize("ground", ["bevelled", "flat", "segments"])


@GROUNDS
@pytest.mark.parametrize("reach", [8.0, 3.0])
def test_g7_offset_rod_at_100_stays_above_ground(measured, ground, reach):
    measured("G7", "below ground", lowest_over(ground, Polygon.box(2, 0.1, center=(reach, 0)), (-reach, -20.0)))


@GROUNDS
@pytest.mark.parametrize(
    "shape",
    [Polygon([(-2, 0), (-1, 0), (2, -0.5)]), Polygon.box(1.5, 0.02), Capsule((-1, 0), (1, 0), 0.01)],
    ids=["sliver", "ruler", "needle"],
)
def test_g8_slivers_at_100_stay_above_ground(measured, ground, shape):
    measured("G8", "below ground", lowest_over(ground, shape, (0.0, -20.0)))


@pytest.mark.parametrize("phase", np.linspace(0.0, 1.0, 16, endpoint=False))
def test_g9_box_that_passes_a_corner_closely_is_not_touched(measured, phase):
    """A box that passes a corner at a distance of 0.015 is not deflected, although the speculative margin is 0.02."""
    world = flying()
    world.add_body(Polygon.box(4, 4), position=(-2.0, 2.0), kind="static")
    past = 0.015 / math.sqrt(2)
    start = -1.0 + phase * 0.125
    box = world.add_body(
        Polygon.box(0.5, 0.5), position=(start + past + 0.25, start - past - 0.25), velocity=(7.5, 7.5)
    )
    for _ in range(1, 21):
        world.step()
        measured("G9", "change of its velocity", math.dist(box.velocity, (7.5, 7.5)) + abs(box.angular_velocity))
    flown = (start + past + 0.25 + 2.5, start - past - 0.25 + 2.5)
    measured("G9", "change of its flight", math.dist(box.position, flown))


@needs_speed
def test_g10_bullets_do_not_drive_a_brick_through_the_wall(measured):
    world = metres(effects=FAST)
    floor(world, width=2000.0)
    world.add_body(Polygon.box(0.2, 40), position=(10.0, -20.0), kind="static")
    column(world, 12)
    for k in range(8):
        world.add_body(
            Circle(0.25),
            position=(-20.0 - 3 * k, -1.0 - 1.3 * k),
            velocity=(200.0 + 12 * k, 0.0),
            bullet=True,
            material=Material(density=4.0),
        )
    watch = Watch(world, capped=True)
    over = np.zeros(len(movers(world)), bool)  # of the wall: some may fly so high, and then fall behind it
    for _ in range(300):
        watch.step()
        rows = movers(world)
        over |= (rows["y"] < -40.0) & (rows["x"] > 9.0)
        measured("G10", "from the wall's middle to the nearest", 10.0 - rows["x"][~over].max())
        measured("G10", "below ground", rows["y"][~over].max())


def test_g11_body_that_was_made_static_is_hit_by_a_bullet(measured):
    world = metres(effects=FAST)
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5))
    Watch(world).step(30)
    box.set_kind("static")
    ball = world.add_body(Circle(0.3), position=(-10.0, -28.1), velocity=(104.9 * 1.0, 281.1), bullet=True)
    hits = []
    for _ in range(30):
        Watch(world).step()
        hits += [(h["body_a"], h["body_b"]) for h in world.events.hits]
    measured("G11", "hits told", hits.count((box.id, ball.id)))
    measured("G11", "bullet below ground", ball.position[1])


@pytest.mark.parametrize("bullets, through", [((False, False), True), ((True, False), False), ((True, True), False)])
@pytest.mark.parametrize(
    "shape", [Circle(0.2), Polygon.box(0.3, 0.3), Capsule((0, -0.1), (0, 0.1), 0.1)], ids=["ball", "box", "capsule"]
)
def test_g12_bodies_head_on_meet_when_one_is_a_bullet(measured, shape, bullets, through):
    """Two fast bodies that meet head-on collide if at least one is a bullet.

    Other fast bodies are swept against static bodies only; a bullet is swept against all bodies, including bullets.
    """
    world = flying()
    one, two = (
        world.add_body(shape, position=(-side * 11.5, 0.0), velocity=(side * 200.0, 0.0), bullet=bullet)
        for side, bullet in zip((1, -1), bullets, strict=True)
    )
    Watch(world).step(12)
    passed = one.position[0] > two.position[0]
    if through:
        measured("G12", "pairs without a bullet that met", not passed)
        return
    measured("G12", "bullets that passed", passed)
    left = max(abs(one.velocity[0]), abs(two.velocity[0]))
    if isinstance(shape, Circle):
        measured("G12", "speed left of balls", left)
    else:  # of two points that meet flat, four substeps leave a hundredth of the speed
        assert left <= 0.02 * 200.0


@pytest.mark.parametrize("rate", [100.0, 500.0, 5000.0])
def test_g14_fast_spin_neither_blows_up_nor_reaches_through_a_wall(measured, rate):
    world = flying()
    for x, y, width, height in ((-2.2, 0, 0.1, 9), (2.2, 0, 0.1, 9), (0, -4.4, 5, 0.1), (0, 4.4, 5, 0.1)):
        world.add_body(Polygon.box(width, height), position=(x, y), kind="static")
    rod = world.add_body(Polygon.box(0.1, 4.0), angular_velocity=rate, velocity=(3.0, 0.0))
    outside = odd = 0
    for _ in range(120 if JIT else 30):
        world.step()
        outside += not (abs(rod.position[0]) < 2.2 and abs(rod.position[1]) < 4.4)
        odd += not math.isfinite(rod.angle + rod.angular_velocity + rod.velocity.length)
    measured("G14", "steps outside", outside)
    measured("G14", "states not finite", odd + len(world.events.quarantined))


def test_g15_speed_of_ten_thousand_is_exact_in_flight_and_stopped(measured):
    world = flying()
    world.add_body(Polygon.box(0.1, 4), position=(3000.0, 0.0), kind="static")
    ball = world.add_body(Circle(0.1), velocity=(1e4, 0.0))
    Watch(world).step(12)
    measured("G15", "relative error of the flight", abs(ball.position[0] / 2000.0 - 1.0))
    Watch(world).step(12)
    measured("G15", "before the wall", 3000.0 - ball.position[0])


@pytest.mark.parametrize("sensor_moves", [False, True])
@pytest.mark.parametrize("bullet", [False, True])
def test_g16_fast_body_through_a_sensor_is_heard_once(measured, sensor_moves, bullet):
    """A fast body and a sensor that cross get exactly one begin and one end event.

    A solid body stops at the wall behind the sensor; a sensor passes through the wall.
    """
    world = flying(STILL.with_(sensors=True))
    world.add_body(Polygon.box(0.1, 4), position=(0.0, 0.0), kind="static", sensor=not sensor_moves)
    world.add_body(Polygon.box(0.1, 4), position=(8.0, 0.0), kind="static")
    ball = world.add_body(Circle(0.1), position=(-5.0, 0.0), velocity=(150.0, 0.0), sensor=sensor_moves, bullet=bullet)
    begun, ended = [], []
    for _ in range(12):
        Watch(world).step()
        begun += world.events.sensor_begin["body_a"].tolist()
        ended += world.events.sensor_end["body_a"].tolist()
    for told, name in ((begun, "begins per sensor"), (ended, "ends per sensor")):
        assert set(told) == ({0, 1} if sensor_moves else {0})
        measured("G16", name, max(told.count(each) for each in set(told)))
    if sensor_moves:
        measured("G16", "error of the sensor's flight", abs(ball.position[0] - 25.0))
    else:
        measured("G16", "solid body beyond the wall behind it", ball.position[0] - 8.0)
        assert ball.position[0] > 7.0


@pytest.mark.parametrize("restitution", [0.0, 1.0])
@pytest.mark.parametrize("asleep", [False, True])
def test_g17_box_at_two_metres_a_step_stops_at_a_box(measured, restitution, asleep):
    world = flying(STILL.with_(sleeping=True))
    target = world.add_body(Polygon.box(1, 1), position=(10.0, 0.0), material=Material(restitution=restitution))
    if asleep:
        Watch(world).step(60)
        assert not target.awake
    box = world.add_body(
        Polygon.box(1, 1), velocity=(120.0, 0.0), bullet=True, material=Material(restitution=restitution)
    )
    Watch(world, isolated=False).step(20)
    share = (1 - restitution) / 2
    for body, part in ((box, share), (target, 1.0 - share)):
        measured("G17", "error of the velocities", abs(body.velocity[0] - 120.0 * part))
    measured("G17", "overlap", 1.0 - (target.position[0] - box.position[0]))


def test_g18_ball_in_a_corner_does_not_freeze_the_step(measured):
    """A ball with e = 0.9 flies into a narrowing wedge and comes out again, with a bounded
    number of sweeps per step.
    """
    world = flying(STILL.with_(friction=False))
    world.add_body(Segment((0, -3), (20, 0)), Segment((0, 3), (20, 0)), kind="static")
    ball = world.add_body(Circle(0.2), position=(2.0, 0.3), velocity=(300.0, 5.0), material=Material(restitution=0.9))
    watch, calls, outside = Watch(world), 0, 0
    for _ in range(120):
        watch.step()
        calls = max(calls, world.profile.counters["toi_calls"])
        x, y = ball.position
        outside += not (x < 20.0 and (x < 0.0 or abs(y) < 3.0 * (1 - x / 20.0)))
    measured("G18", "sweeps in a step", calls)
    measured("G18", "steps outside the gap", outside)
    measured("G18", "speed into the gap at the end", ball.velocity[0])


def shoot_rods(mode, count, solver="soft_step"):
    """Shoot `count` rotating thin rods at walls of 1 to 4 px and return how many end behind their wall."""
    rng = generator(21)
    world = World(STILL, solver=solver, gravity=(0, 0))
    rods = []
    for k in range(count):
        y = 400.0 * k
        world.add_body(Polygon.box(rng.uniform(1.0, 4.0), 400.0), position=(0.0, y), kind="static")
        long = rng.uniform(10.0, 60.0)
        rods.append(
            world.add_body(
                Polygon.box(long, rng.uniform(0.5, 2.0)),
                position=(-long / 2 - rng.uniform(6.0, 90.0), y + rng.uniform(-60, 60)),
                angle=rng.uniform(0, math.tau),
                angular_velocity=rng.uniform(-40, 40),
                velocity=(rng.uniform(6e3, 6e4), rng.uniform(-900, 900)),
                continuous=mode,
            ).id
        )
    rows, worst = world.rows(rods), np.full(count, -np.inf)
    watch = Watch(world)
    for _ in range(20 if JIT else 8):
        watch.step()
        worst = np.maximum(worst, world.bodies["center_x"][rows])
    return int((worst > 3.0).sum())


@pytest.mark.parametrize("mode", ["auto", "toi", "off"])
def test_g13_thin_rods_pass_thin_walls_when_off_and_never_when_on(measured, mode):
    count = 1000 if JIT else 30
    through = shoot_rods(mode, count)
    if mode == "off":
        assert through > 0.5 * count
    else:
        measured("G13", "misses of what is swept", through)


@pytest.mark.parametrize("speed", [0.5, 1.0, 3.0, 10.0 / 3.0, 10.0, 100.0])
@pytest.mark.parametrize("swept", [False, True])
def test_g13_a_disc_misses_a_thin_wall_at_the_known_rate_and_never_when_swept(measured, speed, swept):
    """A disc that is not swept misses a thin wall with a probability of 1 - (w + 2 r) / (v dt); a swept one never does.

    The phases of the steps are random. The rate is 0.91 for 3.33 m a step, w = 0.1 and r = 0.1.
    """
    count, width, radius = (10_000 if JIT else 300), 0.1, 0.1
    rng = generator(13)
    world = flying() if swept else World(Effects(rotation=True), pixels_per_meter=1.0)
    world.add_body(Polygon.box(width, 2.0 * count), kind="static")
    places = np.column_stack([-radius - width - rng.uniform(0.0, speed, count), np.arange(count) - count / 2.0])
    ids = world.add_bodies(Circle(radius), places, velocities=np.tile((speed / world.dt, 0.0), (count, 1)))
    met = set()
    for _ in range(2 + math.ceil((width + 2.0 * radius) / speed)):
        world.step()
        met |= set(world.events.begin["body_b"].tolist())
    missed = len(ids) - len(met)
    if swept:
        measured("G13", "misses of what is swept", missed)
        measured("G13", "misses of what is swept", (world.bodies["x"][world.rows(ids)] > width).sum())
        return
    rate = max(0.0, 1.0 - (width + 2.0 * radius) / speed)
    sigma = max(math.sqrt(rate * (1.0 - rate) / count), 1e-12)
    measured("G13", "misses of what is not swept, off the formula", abs(missed / count - rate) / sigma)


@pytest.mark.parametrize("bullet", [True, False])
def test_g12_500_bullets_against_500(measured, bullet):
    """Of 500 head-on pairs of all shapes, sizes and speeds, no bullet passes another without a collision.

    Each pair has a lane of its own. Without the sweep most pairs never collide.
    """
    count = 500 if JIT else 20
    rng = generator(5)
    world = World(STILL, solver="soft_step", gravity=(0, 0))
    sides = [[], []]
    for k in range(count):
        for side, sign in enumerate((-1, 1)):
            size = rng.uniform(0.5, 4.0)
            shape = (Circle(size), Polygon.box(2 * size, size), Capsule((-size, 0), (size, 0), size / 2))[
                rng.integers(3)
            ]
            sides[side].append(
                world.add_body(
                    shape,
                    position=(sign * rng.uniform(20, 300), 40.0 * k + rng.uniform(-0.2, 0.2)),
                    velocity=(-sign * rng.uniform(6e3, 6e4), 0.0),
                    bullet=bullet,
                    continuous="auto" if bullet else "off",
                ).id
            )
    left, right = (world.rows(side) for side in sides)
    watch, met, passed = Watch(world, capped=True), np.zeros(count, bool), np.zeros(count, bool)
    for _ in range(12):
        watch.step()
        begun = set(zip(world.events.begin["body_a"].tolist(), world.events.begin["body_b"].tolist(), strict=True))
        now = np.array([pair in begun for pair in zip(*sides, strict=True)])
        behind = world.bodies["center_x"][left] > world.bodies["center_x"][right]
        # What has met may roll off and round: only the moment counts at which they meet.
        passed |= behind & ~met
        met |= now
    assert (passed.sum() == 0 and met.all()) if bullet else (passed.sum() > 0.5 * count)


@needs_speed
def test_g12_crowd_of_bullets_head_on_keeps_its_sides():
    """Bullets that start in the left half of a lane stay left of all bullets that start in its right half.

    All lanes are in one crowded tube.
    """
    world = flying()
    lanes = 25
    for k in range(lanes + 1):
        world.add_body(
            Segment((-60, 1.0 * k - 0.5), (60, 1.0 * k - 0.5)), kind="static", material=Material(friction=0.0)
        )
    order = np.zeros((lanes, 20), int)
    for k in range(lanes):
        for n in range(20):
            side = -1 if n < 10 else 1
            order[k, n] = world.add_body(
                Circle(0.3),
                position=((n - 9.5) * 3.0, 1.0 * k),
                velocity=(-side * (200.0 + 7 * n), 0.0),
                bullet=True,
                material=Material(restitution=0.5, friction=0.0),
            ).id
    rows, watch = world.rows(order.ravel()), Watch(world, capped=True)
    for _ in range(40):
        watch.step()
        x = world.bodies["x"][rows].reshape(order.shape)
        assert (np.diff(x, axis=1) > 0.0).all()


@needs_speed
def test_g19_what_drops_on_forty_tiles_lies_on_them(measured):
    """A disc and a ruler dropped on forty tiles come to rest on them.

    The tiles are 0.25 m wide: one grid, separate bodies or segments. The disc has half the width of a tile.
    """
    for ground in ("grid", "boxes", "segments"):
        for shape, start, speed, rest in (
            (Circle(0.125), (0.06, -8.0), 100.0, 0.125),
            (Polygon.box(1.5, 0.02), (0.06, -3.0), 0.0, 0.01),
        ):
            for turn in (0.0, 0.3):
                world = metres(effects=FAST)
                if ground == "grid":
                    world.add_body(TileGrid(np.ones((1, 40), bool), 0.25), position=(-5.0, 0.0), kind="static")
                else:
                    tile = (
                        Polygon.box(0.25, 0.25, (0, 0.125)) if ground == "boxes" else Segment((-0.125, 0), (0.125, 0))
                    )
                    world.add_bodies(tile, [(0.25 * k - 4.875, 0.0) for k in range(40)], kind="static")
                body = world.add_body(shape, position=start, angle=turn, velocity=(0.0, speed))
                Watch(world, capped=True).step(300)
                measured("G19", "height over the floor at rest, off", abs(-body.position[1] - rest))
                measured("G19", "speed at the end", body.velocity.length)


def test_g20_times_of_impact_in_closed_form(measured):
    def ask(a, start_a, move_a, b, start_b, move_b):
        poses = [(*at, 0.0) for at in (start_a, np.add(start_a, move_a), start_b, np.add(start_b, move_b))]
        found = time_of_impact(a, *poses[:2], b, *poses[2:])
        assert found.hit
        return found.fraction

    box, ball = Polygon.box(2, 2), Circle(0.5)
    half = ask(box, (0, 0), (0, 0), Segment((0, -1), (0, 1)), (2, 0), (-2, 0))
    measured("G20", "error of the fraction", abs(half - 0.5))
    # Two of radius 0.5, 10 apart, nearing at 10; and one of radius 1 from (2, 2) at a box, along its diagonal.
    measured("G20", "error of disc and disc", abs(ask(ball, (0, 0), (10, 0), ball, (10, 0), (0, 0)) - 0.9))
    diagonal = ask(Circle(1.0), (2, 2), (-1.5, -1.5), Polygon.box(1, 1), (0, 0), (0, 0))
    corner = (1.5 * math.sqrt(2.0) - 1.0) / (1.5 * math.sqrt(2.0))
    measured("G20", "error of the fraction", abs(diagonal - corner))
    # Nearing in general: the root of a square.
    rng = generator(20)
    for _ in range(300 if JIT else 30):
        r, at, way = rng.uniform(0.1, 0.8, 2), rng.uniform(-9.0, 9.0, 2), rng.uniform(-30.0, 30.0, 2)
        reach, b = float(r.sum()), float(at @ way)
        root = b * b - float(way @ way) * (float(at @ at) - reach * reach)
        if float(at @ at) <= reach * reach or b >= 0.0 or root <= 1e-6 * b * b:
            continue
        wanted = (-b - math.sqrt(root)) / float(way @ way)
        if wanted < 1.0:
            found = ask(Circle(float(r[0])), (0, 0), (0, 0), Circle(float(r[1])), at.tolist(), way.tolist())
            measured("G20", "error of disc and disc", abs(found - wanted))
