"""Effects of the solvers on velocities and poses (invariants U3, U5)."""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World

BOUNCE = Effects(response=True, restitution=True)
ALL = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True)


def overlap_depth(world, a, b):
    """Return the overlap depth of two circles [px]. a, b: body ids."""
    p, q = world.body(a), world.body(b)
    return p.shapes[0].radius + q.shapes[0].radius - math.dist(p.position, q.position)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("density", [(1.0, 1.0), (1.0, 7.0), (100.0, 1.0)])
@pytest.mark.parametrize("velocities", [(300.0, -200.0), (400.0, 100.0), (0.0, -500.0)])
def test_head_on_in_closed_form(restitution, density, velocities):
    world = World(BOUNCE, gravity=(0, 0))
    first, second = (
        world.add_body(
            Circle(5.0), position=(x, 0.0), velocity=(v, 0.0), material=Material(density=d, restitution=restitution)
        )
        for x, v, d in zip((-4.99, 4.99), velocities, density, strict=True)
    )
    world.step(1e-9)
    (m1, m2), (v1, v2), e = density, velocities, restitution
    momentum = m1 * v1 + m2 * v2
    assert first.velocity[0] == pytest.approx((momentum - m2 * e * (v1 - v2)) / (m1 + m2), abs=1e-9)
    assert second.velocity[0] == pytest.approx((momentum + m1 * e * (v1 - v2)) / (m1 + m2), abs=1e-9)
    (hit,) = world.events.hits
    assert hit["speed"] == pytest.approx(v1 - v2) and hit["normal_impulse"] == pytest.approx(
        (1 + e) * (v1 - v2) * first.mass * second.mass / (first.mass + second.mass)
    )


@pytest.mark.parametrize(
    "offset, one, two", [(0.3, (0.45, -1.4309), (4.55, 1.4309)), (0.7, (2.45, -2.4995), (2.55, 2.4995))]
)
def test_oblique_equal_discs_leave_at_right_angles(offset, one, two):
    world = World(Effects(response=True, restitution=True), gravity=(0, 0), pixels_per_meter=1.0)
    elastic = Material(restitution=1.0)
    x = -math.sqrt(1 - offset * offset)
    a = world.add_body(Circle(0.5), position=(x + 1e-12, -offset), velocity=(5.0, 0.0), material=elastic)
    b = world.add_body(Circle(0.5), material=elastic)
    world.step(1e-12)
    assert a.velocity == pytest.approx(one, abs=2e-4) and b.velocity == pytest.approx(two, abs=2e-4)
    assert a.velocity[0] * b.velocity[0] + a.velocity[1] * b.velocity[1] == pytest.approx(0.0, abs=1e-6)


def test_off_centre_hit_spins_in_closed_form():
    """A box that falls on its lower corner gets the closed-form velocities: J 1.511125, v' 1.488875, spin 3.662723.

    The box is 2 x 0.2 at 30 degrees, with v 3 and e 0.5.
    """
    world = World(ALL.with_(gravity=False, friction=False, continuous=False), gravity=(0, 0), pixels_per_meter=1.0)
    angle = math.radians(30)
    lowest = 1.0 * math.sin(angle) + 0.1 * math.cos(angle)
    bar = world.add_body(
        Polygon.box(2, 0.2),
        angle=angle,
        position=(0.0, -lowest + 1e-9),
        velocity=(0.0, 3.0),
        material=Material(density=2.5, restitution=0.5),
    )
    world.add_body(Polygon.box(20, 2), position=(0.0, 1.0), kind="static")
    world.step(1e-9)
    assert bar.velocity[1] == pytest.approx(1.488875, abs=1e-5)
    assert abs(bar.angular_velocity) == pytest.approx(3.662723, abs=1e-5)
    assert world.events.hits["normal_impulse"][0] == pytest.approx(1.511125, abs=1e-5)


@pytest.mark.parametrize("solver", ["projection", "blocking"])
def test_static_and_kinematic_are_never_pushed(solver):
    world = World(ALL, solver=solver)
    rng = np.random.default_rng(0)
    statics = world.add_bodies(Circle(9.0), rng.uniform(0, 100, (8, 2)), kind="static")
    movers = world.add_bodies(Polygon.box(9, 9), rng.uniform(0, 100, (4, 2)), np.full((4, 2), 30.0), kind="kinematic")
    world.add_bodies(Circle(5.0), rng.uniform(0, 100, (30, 2)), rng.uniform(-300, 300, (30, 2)))
    start = {i: world.body(int(i)).position for i in (*statics, *movers)}
    for n in range(1, 61):
        world.step()
        for i in statics:
            assert world.body(int(i)).position == start[i] and world.body(int(i)).velocity == (0, 0)
        for i in movers:
            assert world.body(int(i)).position == pytest.approx([start[i][0] + n / 2, start[i][1] + n / 2], abs=1e-9)
            assert world.body(int(i)).velocity == (30, 30)


def test_projection_parts_an_overlap_by_inverse_masses():
    world = World(Effects(response=True), gravity=(0, 0))
    light = world.add_body(Circle(5.0))
    heavy = world.add_body(Circle(5.0), position=(8.0, 0.0), material=Material(density=3.0))
    world.step()
    assert light.position[0] == pytest.approx(-1.5, abs=1e-6) and heavy.position[0] == pytest.approx(8.5, abs=1e-6)
    world.step()
    assert overlap_depth(world, 0, 1) == pytest.approx(0.0, abs=1e-9)


def test_crate_between_two_walls_stays_between_them():
    world = World(ALL)
    world.add_body(TileGrid(np.array([[1, 0, 0, 0, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 1]], bool), 16.0), kind="static")
    crate = world.add_body(Polygon.box(40, 20), position=(40.0, 10.0), velocity=(900.0, 0.0), fixed_rotation=True)
    for _ in range(60):
        world.step()
        assert 15.9 <= crate.position[0] - 20 and crate.position[0] + 20 <= 64.1 and crate.position[1] + 10 <= 32.2


def test_blocking_never_creates_an_overlap():
    rng = np.random.default_rng(1)
    world = World(Effects(response=True), solver="blocking", gravity=(0, 0))
    side = 12 if JIT else 6
    at = np.array([(14.0 * i, 14.0 * j) for i in range(side) for j in range(side)])
    for k, position in enumerate(at):
        shape = (Circle(6.0), Polygon.box(12, 12), PixelMask(np.ones((12, 12), bool)))[k % 3]
        world.add_body(shape, position=position, kind="static" if k % 10 == 0 else "dynamic")
    for step in range(60):
        world.bodies["vx"][world.bodies["kind"] == 2] = rng.uniform(-250, 250, int((world.bodies["kind"] == 2).sum()))
        world.step()
        for body in [world.body(int(i)) for i in world.bodies["id"]]:
            pose = (*body.position, body.angle)
            deep = [
                o
                for o in world.overlap(body.shapes[0], pose)
                if o.id != body.id and not np.isclose(worst(body, o), 0.0, atol=1e-9)
            ]
            assert not deep, f"step {step}: {body.id} overlaps {deep}"


def worst(a, b):
    """Return the least separation of two bodies [px]; 0 if they have no contact."""
    from physics import collide

    found = collide(a.shapes[0], (*a.position, a.angle), b.shapes[0], (*b.position, b.angle))
    return float(found.separations.min()) if len(found) else 0.0


def test_blocking_keeps_the_old_pose_and_takes_the_speed_towards_the_wall():
    world = World(Effects(response=True), solver="blocking", gravity=(0, 0))
    world.add_body(Polygon.box(10, 100), position=(20.0, 0.0), kind="static")
    body = world.add_body(Circle(5.0), position=(9.0, 0.0), velocity=(120.0, 60.0))
    world.step()
    assert body.position == (9.0, 0.0) and body.velocity == pytest.approx((0.0, 60.0))
    assert len(world.events.begin) == 1 and world.events.hits["speed"].tolist() == [120.0]
    world.step()
    assert body.position == pytest.approx((9.0, 1.0))


def test_blocking_stops_a_fast_body_and_takes_its_speed():
    world = World(Effects(response=True, continuous=True), solver="blocking", gravity=(0, 0))
    world.add_body(Polygon.box(2, 100), position=(30.0, 0.0), kind="static")
    body = world.add_body(Circle(2.0), velocity=(6000.0, 0.0))
    begun = 0
    for _ in range(3):
        world.step()
        begun += len(world.events.begin)
    assert body.position[0] <= 27.0 + 1e-9 and body.velocity == pytest.approx((0.0, 0.0)) and begun == 1


@pytest.mark.parametrize("mu", [0.2, 0.5])
def test_sliding_box_stops_after_v_squared_over_two_mu_g(mu):
    world = World(ALL.with_(rotation=False), gravity=(0, 1000.0))
    world.add_body(TileGrid(np.ones((1, 200), bool), 16.0), kind="static", material=Material(friction=mu))
    box = world.add_body(
        Polygon.box(16, 16), position=(50.0, -8.0), velocity=(400.0, 0.0), material=Material(friction=mu)
    )
    for _ in range(300):
        world.step()
    assert box.velocity == pytest.approx((0, 0), abs=1e-6)
    assert box.position[0] - 50.0 == pytest.approx(400.0**2 / (2 * mu * 1000.0), rel=0.05)


def test_free_fall_is_the_semi_implicit_sum():
    world = World(Effects(gravity=True), gravity=(3.0, 10.0))
    body = world.add_body(Circle(1.0), position=(1.0, 2.0), velocity=(5.0, -7.0), gravity_scale=2.0)
    h, n = 1 / 60, 240
    for _ in range(n):
        world.step()
    assert body.position == pytest.approx(
        (1 + 5 * n * h + 6 * h * h * n * (n + 1) / 2, 2 - 7 * n * h + 20 * h * h * n * (n + 1) / 2), rel=1e-12
    )


def test_drag_and_wind_follow_the_implicit_recurrence():
    world = World(Effects(drag=True, wind=True), drag=2.0, wind=(30.0, 0.0))
    body = world.add_body(Circle(1.0), velocity=(100.0, 40.0))
    vx, vy = 100.0, 40.0
    for _ in range(100):
        world.step()
        vx, vy = (vx + 2 / 60 * 30) / (1 + 2 / 60), vy / (1 + 2 / 60)
    assert body.velocity == pytest.approx((vx, vy), rel=1e-12)


def test_bouncing_ball_comes_back_by_its_restitution():
    world = World(ALL.with_(friction=False), gravity=(0, 600.0))
    world.add_body(Polygon.box(400, 20), position=(0.0, 10.0), kind="static")
    ball = world.add_body(Circle(5.0), position=(0.0, -205.0), material=Material(restitution=0.8))
    apex, heights, rising = 0.0, [], False
    for _ in range(400):
        world.step()
        height = -5.0 - ball.position[1]
        if ball.velocity[1] < 0:
            rising, apex = True, max(apex, height)
        elif rising:
            heights.append(apex)
            rising, apex = False, 0.0
    for k, height in enumerate(heights[:3], 1):
        assert height == pytest.approx(200 * 0.64**k, abs=0.05 * 200)


@pytest.mark.parametrize("effects", [BOUNCE, ALL.with_(gravity=False)], ids=["bounce", "all"])
@pytest.mark.parametrize("restitution", [0.0, 0.9, 1.0])
def test_momentum_is_kept_and_energy_never_grows(effects, restitution):
    rng = np.random.default_rng(4)
    world = World(effects, gravity=(0, 0))
    n = 60 if JIT else 25
    for k in range(n):
        world.add_body(
            Circle(6.0) if k % 2 else Polygon.box(10, 8),
            position=(20.0 * (k % 8), 20.0 * (k // 8)),
            velocity=tuple(rng.uniform(-200, 200, 2)),
            material=Material(restitution=restitution, friction=0.4),
        )
    b = world.bodies
    mass, inertia = b["mass"].copy(), b["inertia"].copy()

    def momentum():
        return np.array([(mass * world.bodies["vx"]).sum(), (mass * world.bodies["vy"]).sum()])

    def energy():
        moving = mass * (world.bodies["vx"] ** 2 + world.bodies["vy"] ** 2)
        return (moving + inertia * world.bodies["angular_velocity"] ** 2).sum() / 2

    start, before, scale = momentum(), energy(), (mass * 200).sum()
    for _ in range(60):
        world.step()
        assert np.abs(momentum() - start).max() <= 1e-10 * scale
        # Several simultaneous bounces may add a little; a passive scene never gains one per cent.
        assert energy() <= before * 1.01
    assert np.isfinite(world.bodies["x"]).all()


def test_impulses_act_on_both_sides_alike():
    world = World(ALL.with_(gravity=False), gravity=(0, 0))
    a = world.add_body(Circle(5.0), velocity=(300.0, 40.0))
    b = world.add_body(Circle(7.0), position=(11.5, 1.0), velocity=(-100.0, 0.0))
    world.step()
    (contact,) = world.contacts
    nx, ny, j, t = contact["normal_x"], contact["normal_y"], contact["normal_impulse"], contact["tangent_impulse"]
    for body, sign, v in ((a, -1, (300, 40)), (b, 1, (-100, 0))):
        assert body.velocity == pytest.approx(
            [v[0] + sign * (j * nx - t * ny) / body.mass, v[1] + sign * (j * ny + t * nx) / body.mass], abs=1e-9
        )
    assert world.events.hits["normal_impulse"].tolist() == [j] and j > 0


def test_material_values_without_their_effect_are_inert():
    plain = World(Effects(response=True), gravity=(0, 0))
    rough = World(Effects(response=True), gravity=(0, 0))
    for world, material in ((plain, Material(friction=0.0)), (rough, Material(friction=1.0, restitution=1.0))):
        world.add_body(Circle(5.0), velocity=(100.0, 20.0), material=material)
        world.add_body(Circle(5.0), position=(9.0, 3.0), material=material)
        world.step()
    assert plain.digest() == rough.digest()


def test_zero_step_moves_nothing():
    world = World(ALL)
    world.add_body(Circle(5.0), velocity=(50.0, 300.0), material=Material(restitution=1.0))
    world.add_body(Circle(5.0), position=(4.0, 3.0))
    world.add_body(Polygon.box(40, 4), position=(0.0, 6.0), kind="static")
    before = world.bodies.copy()
    world.step(0)
    for name in ("x", "y", "angle", "vx", "vy", "angular_velocity"):
        assert (world.bodies[name] == before[name]).all(), name
    assert len(world.contacts) >= 2


@pytest.mark.filterwarnings("ignore:World.step. dt is in seconds")
@pytest.mark.parametrize("dt", [1e-9, 1.0, 100.0])
def test_any_positive_step_stays_finite(dt):
    world = World(ALL)
    rng = np.random.default_rng(2)
    world.add_bodies(Polygon.box(8, 8), rng.uniform(0, 60, (20, 2)), rng.uniform(-50, 50, (20, 2)))
    world.add_body(TileGrid(np.ones((2, 8), bool), 16.0), position=(0.0, 60.0), kind="static")
    for _ in range(5):
        world.step(dt)
        assert np.isfinite(world.bodies["x"]).all() and np.isfinite(world.bodies["angular_velocity"]).all()
