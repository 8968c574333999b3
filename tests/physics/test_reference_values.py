"""Motion of bodies, impacts and friction, compared with closed forms and with the recurrences of the solver.

In metres: pixels_per_meter=1, y down. Tests compare first with the discrete solution, nearly to the bit, then loosely
with the continuous one.
"""

import math

import numpy as np
import pytest

from physics import Capsule, Circle, Material, Polygon
from tests.stability.invariants import Watch, kinetic
from tests.stability.piles import SLOP, SOLVERS, column, floor, metres, needs_speed, on_slope, pile_effects

G = 10.0
STACKING = ("soft_step", "sequential_impulse")


# --- flight -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "solver, substeps", [("soft_step", 1), ("soft_step", 4), ("soft_step", 7), ("sequential_impulse", 4)]
)
def test_free_fall_is_a_parabola(solver, substeps):
    """With stacking, free flight is a parabola up to rounding, for any length of substeps."""
    world = metres(solver, substeps=substeps)
    ball = world.add_body(Circle(0.1), position=(2.0, -7.0), velocity=(1.5, -3.0))
    wheel = world.add_body(Circle(0.5), position=(9.0, -90.0), angular_velocity=0.5)
    watch = Watch(world)
    for n in range(1, 61):
        wheel.apply_torque(2.0 * wheel.inertia)
        watch.step()
        t = n * world.dt
        assert ball.position == pytest.approx((2.0 + 1.5 * t, -7.0 - 3.0 * t + G * t * t / 2), rel=1e-12)
        assert ball.velocity == pytest.approx((1.5, -3.0 + G * t), rel=1e-12)
        assert wheel.angle == pytest.approx(0.5 * t + t * t, rel=1e-12)


@pytest.mark.parametrize("solver", ["projection", "blocking"])
def test_free_fall_without_stacking_is_its_own_recurrence(solver):
    """Free fall without stacking follows y_n = y0 + v0 n h + g h² n (n + 1) / 2.

    A body moves by the speed at the end of the step; after 1 s it is g h t / 2 below the parabola.
    """
    world = metres(solver)
    ball = world.add_body(Circle(0.1), position=(2.0, -7.0), velocity=(1.5, -3.0))
    h = world.dt
    watch = Watch(world)
    for n in range(1, 61):
        watch.step()
        assert ball.position[1] == pytest.approx(-7.0 - 3.0 * n * h + G * h * h * n * (n + 1) / 2, rel=1e-12)
        assert ball.position[0] == pytest.approx(2.0 + 1.5 * n * h, rel=1e-12)
        assert ball.velocity == pytest.approx((1.5, -3.0 + G * n * h), rel=1e-12)
    assert ball.position[1] - (-7.0 - 3.0 + G / 2) == pytest.approx(G * h / 2, rel=1e-9)


@pytest.mark.parametrize("rate", [0.1, 1.0, 40.0])
def test_drag_is_implicit(rate):
    """Drag divides the speed by 1 + c h in each step, which is stable for any c.

    It differs from v exp(-c t) by O(h).
    """
    for solver, parts in (("soft_step", 4), ("projection", 1)):
        world = metres(solver, effects=pile_effects(drag=True, gravity=False), gravity=(0, 0), drag=rate)
        ball = world.add_body(Circle(0.1), velocity=(8.0, -2.0), angular_velocity=3.0)
        speed, x = 8.0, 0.0
        for _ in range(30):
            world.step()
            for _ in range(parts):
                speed /= 1.0 + rate * world.dt / parts
                x += world.dt / parts * speed
        assert ball.velocity == pytest.approx((speed, -speed / 4), rel=1e-12) and ball.position[0] == pytest.approx(
            x, rel=1e-12
        )
        assert ball.angular_velocity == pytest.approx(3.0 * speed / 8.0, rel=1e-12)
        assert speed >= 8.0 * math.exp(-rate * 0.5) - 1e-12


# --- impacts ----------------------------------------------------------------------------------------------------------


def apexes(world, ball, start, count, steps=1200):
    """Return (time, height above the floor) of the first `count` apexes of a ball, at which its velocity is 0."""
    found, before = [], ball.velocity[1]
    for n in range(1, steps + 1):
        world.step()
        now = ball.velocity[1]
        if before < 0.0 <= now:
            found.append((n * world.dt, -ball.position[1] - start + now * now / (2 * G)))  # between two steps
            if len(found) == count:
                break
        before = now
    return found


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("restitution", [0.5, 0.8, 0.95])
def test_bounces_rise_by_the_square_of_restitution(solver, restitution):
    """The k-th bounce rises to h e^(2k), for a fall from the height h.

    Stacking solvers are right within 0.5 % and one slop, or two slops if a step may end in an overlap. Other solvers
    are right within g dt t, the error of one step.
    """
    world = metres(solver)
    floor(world)
    ball = world.add_body(Circle(0.1), position=(0.0, -2.1), material=Material(restitution=restitution))
    hits = []
    found = apexes(world, ball, 0.1, 3)
    assert len(found) == 3
    for k, (at, height) in enumerate(found, 1):
        right = 2.0 * restitution ** (2 * k)
        slop = SLOP if solver == "soft_step" else 2 * SLOP
        assert abs(height - right) <= (0.005 * right + slop if solver in STACKING else G * world.dt * at)
    world = metres(solver)
    floor(world)
    world.add_body(Circle(0.1), position=(0.0, -2.1), material=Material(restitution=restitution))
    while not len(hits):
        world.step()
        hits = world.events.hits["speed"].tolist()
    assert hits[0] == pytest.approx(math.sqrt(2 * G * 2.0), abs=2 * G * world.dt)


@pytest.mark.parametrize("solver", SOLVERS)
def test_bounces_end_in_the_time_of_the_series(solver):
    """Bounces end after sqrt(2 h / g) (1 + e) / (1 - e) = 5.6921 s, the sum of the durations of all bounces.

    Stacking solvers are right within 0.5 %; the error of the others shrinks with dt. pixels_per_meter=0.02 makes the
    tolerances 1/50 of the usual ones, so that low bounces count.
    """
    short = []
    for dt in (1 / 240, 1 / 960):
        world = metres(solver, pixels_per_meter=0.02, dt=dt)
        floor(world)
        world.add_body(Circle(0.1), position=(0.0, -2.1), material=Material(restitution=0.8))
        last = 0.0
        for n in range(1, round(7 / dt)):
            world.step()
            last = n * dt if len(world.events.hits) else last
        short.append(abs(5.6921 - last) / 5.6921)
    if solver in STACKING:
        assert max(short) < 0.005
    else:
        assert short[0] < 0.15 and short[1] < 0.7 * short[0]


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("density", [(1.0, 1.0), (1.0, 7.0), (1000.0, 1.0)])
def test_head_on_in_closed_form(solver, restitution, density):
    world = metres(solver, gravity=(0, 0))
    v1, v2 = 4.0, -1.5
    first, second = (
        world.add_body(
            Circle(0.5), position=(x, 0.0), velocity=(v, 0.0), material=Material(density=d, restitution=restitution)
        )
        for x, v, d in zip((-0.6, 0.6), (v1, v2), density, strict=True)
    )
    Watch(world, passive=True, isolated=True).step(20)
    m1, m2 = density
    total = m1 * v1 + m2 * v2
    assert first.velocity[0] == pytest.approx((total - m2 * restitution * (v1 - v2)) / (m1 + m2), abs=1e-12 * v1)
    assert second.velocity[0] == pytest.approx((total + m1 * restitution * (v1 - v2)) / (m1 + m2), abs=1e-12 * v1)
    assert first.velocity[1] == second.velocity[1] == 0.0


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.7])
def test_oblique_equal_discs_leave_at_right_angles(solver, offset):
    """Equal elastic discs leave an oblique impact at right angles.

    With v = 5, r = 0.5 and an impact parameter b, v1' = 5 (b², -b sqrt(1 - b²)); v2' has the rest of the momentum.
    """
    world = metres(solver, gravity=(0, 0), effects=pile_effects(friction=False))
    elastic = Material(restitution=1.0)
    a = world.add_body(
        Circle(0.5), position=(-math.sqrt(1 - offset**2), -offset), velocity=(5.0, 0.0), material=elastic
    )
    b = world.add_body(Circle(0.5), material=elastic)
    Watch(world, passive=True, isolated=True).step()
    one = (5 * offset**2, -5 * offset * math.sqrt(1 - offset**2))
    assert a.velocity == pytest.approx(one, abs=1e-9) and b.velocity == pytest.approx((5 - one[0], -one[1]), abs=1e-9)
    if offset == 0.3:
        assert a.velocity == pytest.approx((0.45, -1.4309), abs=1e-4)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("dt", [1 / 60, 1e-4])
def test_off_centre_hit_spins_in_closed_form(solver, dt):
    """A box that is hit off its centre gets the closed-form values: J 1.511125, v' -1.488875, spin 3.662723.

    The box is 2 x 0.2 at 30 degrees, with v 3, e 0.5 and m 1.
    """
    world = metres(solver, gravity=(0, 0), effects=pile_effects(friction=False), dt=dt)
    floor(world)
    angle = math.radians(30)
    corner = (math.cos(angle) - 0.1 * math.sin(angle), math.sin(angle) + 0.1 * math.cos(angle))
    bar = world.add_body(
        Polygon.box(2.0, 0.2),
        angle=angle,
        position=(0.0, -corner[1]),
        velocity=(0.0, 3.0),
        material=Material(density=2.5, restitution=0.5),
    )
    world.step()
    inertia = (2.0**2 + 0.2**2) / 12
    impulse = 1.5 * 3.0 / (1.0 + corner[0] ** 2 / inertia)
    assert impulse == pytest.approx(1.511125, abs=1e-6)
    assert bar.velocity[1] == pytest.approx(3.0 - impulse, abs=1e-9)
    assert (
        abs(bar.angular_velocity)
        == pytest.approx(impulse * corner[0] / inertia, abs=1e-9)
        == pytest.approx(3.662723, abs=1e-5)
    )
    assert world.events.hits["speed"].tolist() == pytest.approx([3.0], abs=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("gap", [0.3, 0.0])
def test_cradle_hands_on_the_velocity(solver, gap):
    """In Newton's cradle only the last ball leaves, also in a row of touching balls."""
    world = metres(solver, gravity=(0, 0))
    balls = [
        world.add_body(
            Circle(0.5),
            position=((1.0 + gap) * k, 0.0),
            velocity=(6.0 if k == 0 else 0.0, 0.0),
            material=Material(restitution=1.0),
        )
        for k in range(5)
    ]
    start, watch = kinetic(world), Watch(world, passive=True, isolated=True)
    watch.step(60)
    assert kinetic(world) <= start * (1 + 1e-9)
    assert [ball.velocity[0] for ball in balls] == pytest.approx([0, 0, 0, 0, 6.0], abs=1e-9)


# --- friction ---------------------------------------------------------------------------------------------------------


def slide_down(solver, angle, shape, height, friction, inertia=None, seconds=1.0):
    """Release a shape on a slope. Return (acceleration along the slope, spin, speed), measured after 12 steps.

    seconds: time over which the acceleration is measured. inertia: replaces the inertia of the shape.
    """
    world = metres(solver)
    floor(world, friction=friction, angle=angle)
    body = world.add_body(
        shape, position=on_slope(angle, 0.0, height), angle=angle, material=Material(friction=friction)
    )
    if inertia is not None:
        world.bodies["inverse_inertia"][body.id] = 1.0 / inertia
        world.bodies["inertia"][body.id] = inertia
    watch = Watch(world, passive=True)
    watch.step(12)
    before = body.velocity
    watch.step(round(60 * seconds))
    gain = math.hypot(*body.velocity) - math.hypot(*before)
    return gain / seconds, body.angular_velocity, math.hypot(*body.velocity)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("friction", [0.0, 0.2, 0.5])
def test_box_on_a_slope_slides_at_g_sin_less_mu_cos(solver, friction):
    angle = math.atan(friction) + 0.25
    found, _, _ = slide_down(solver, angle, Polygon.box(1.0, 0.5), 0.25, friction)
    assert found == pytest.approx(G * (math.sin(angle) - friction * math.cos(angle)), rel=0.02)


@pytest.mark.parametrize("solver", SOLVERS)
def test_box_on_a_slope_tips_beyond_width_over_height(solver):
    limit = math.atan(0.5 / 1.5)
    turned = {}
    for angle in (limit - 0.02, limit + 0.02):
        world = metres(solver)
        floor(world, friction=2.0, angle=angle)
        box = world.add_body(
            Polygon.box(0.5, 1.5), position=on_slope(angle, 0.0, 0.75), angle=angle, material=Material(friction=2.0)
        )
        Watch(world, passive=True).step(300)
        turned[angle > limit] = abs(box.angle - angle)
    assert turned[False] < 0.02 and turned[True] > 1.0


@pytest.mark.parametrize("solver", SOLVERS)
def test_box_on_a_plate_that_turns_tips_at_width_over_height(solver):
    """A box on a plate that turns by a degree a second tips at atan(width / height) = 26.57 degrees.

    It may tip up to a degree later, the time that falling takes; sticking friction must not hold it.
    """
    world = metres(solver)
    plate = world.add_body(Polygon.box(20, 1, center=(0.0, 0.5)), kind="kinematic", material=Material(friction=5.0))
    box = world.add_body(Polygon.box(1, 2), position=(0.0, -1.0), material=Material(friction=5.0))
    plate.angular_velocity = math.radians(1.0)
    while box.angle - plate.angle < 0.02 and world.time < 40.0:
        world.step()
    assert math.atan(0.5) <= plate.angle <= math.atan(0.5) + math.radians(1.0)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("hoop", [False, True])
def test_disc_and_hoop_roll_down_by_their_share_of_inertia(solver, hoop):
    """A disc rolls down a slope with a = 2/3 g sin if mu >= tan / 3; a hoop with a = 1/2 g sin if mu >= tan / 2.

    sin and tan are those of the slope. With less friction they slip.
    """
    angle, radius = 0.4, 0.5
    mass, share = math.pi * radius**2, 2.0 if hoop else 3.0
    for friction in (1.1 * math.tan(angle) / share, 0.8 * math.tan(angle) / share):
        found, turn, speed = slide_down(
            solver, angle, Circle(radius), radius, friction, mass * radius**2 * (1.0 if hoop else 0.5)
        )
        if friction > math.tan(angle) / share:
            assert found == pytest.approx(G * math.sin(angle) * (0.5 if hoop else 2 / 3), rel=0.01)
            assert turn * radius == pytest.approx(speed, rel=0.01)
        else:
            assert found == pytest.approx(G * (math.sin(angle) - friction * math.cos(angle)), rel=0.02)
            assert turn * radius < 0.97 * speed


@pytest.mark.parametrize("solver", SOLVERS)
def test_sliding_disc_rolls_after_two_thirds(solver):
    """A disc that slides at 5 m/s with mu = 0.3 begins to roll after 0.5556 s and 2.3148 m.

    It then has two thirds of its speed, 3.3333 m/s.
    """
    world = metres(solver)
    floor(world, friction=0.3)
    disc = world.add_body(Circle(0.5), position=(0.0, -0.5), velocity=(5.0, 0.0), material=Material(friction=0.3))
    watch, rolls = Watch(world, passive=True), None
    for n in range(1, 91):
        watch.step()
        if rolls is None and disc.angular_velocity * 0.5 >= disc.velocity[0] * 0.999:
            rolls = (n * world.dt, disc.position[0])
    assert rolls[0] == pytest.approx(5.0 / (3 * 0.3 * G), abs=0.01 * 0.5556 + world.dt)
    assert disc.velocity[0] == pytest.approx(10 / 3, rel=0.01)
    assert rolls[1] == pytest.approx(2.3148, abs=0.01 * 2.3148 + world.dt * 3.34)
    assert disc.position[0] == pytest.approx(2.3148 + (1.5 - 0.5556) * 10 / 3, rel=0.01)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("speed", [2.0, 5.0, -5.0])
def test_stopping_distance(solver, speed):
    """A sliding box stops after a distance of v² / (2 mu g) and a time of v / (mu g)."""
    world = metres(solver)
    floor(world, friction=0.4)
    box = world.add_body(
        Polygon.box(1.0, 0.5), position=(0.0, -0.25), velocity=(speed, 0.0), material=Material(friction=0.4)
    )
    stopped, watch = None, Watch(world, passive=True)
    for n in range(1, 121):
        watch.step()
        if stopped is None and abs(box.velocity[0]) < 1e-3:
            stopped = n * world.dt
    # Semi-implicit: velocities first, so every step falls short by half of what it loses.
    h = world.dt / (4 if solver == "soft_step" else 1)
    assert abs(box.position[0]) == pytest.approx(speed**2 / (2 * 0.4 * G) - abs(speed) * h / 2, rel=0.01)
    assert math.copysign(1.0, box.position[0]) == math.copysign(1.0, speed)
    assert stopped == pytest.approx(abs(speed) / (0.4 * G), rel=0.01, abs=world.dt)
    assert box.velocity[0] == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("solver", SOLVERS)
def test_board_drawn_from_under_discs(solver):
    """A board pulled from under discs accelerates at 3.52629, three times as much as the discs at 1.17543.

    The board has a mass of 10, each of the five discs of 1; F 100, mu 0.4, g 9.81.
    """
    g, force = 9.81, 100.0
    world = metres(solver, gravity=(0, g))
    floor(world, friction=0.4)
    board = world.add_body(
        Polygon.box(20.0, 0.2), position=(0.0, -0.1), material=Material(density=10 / 4.0, friction=0.4)
    )
    discs = [
        world.add_body(
            Circle(0.5), position=(2.0 * k - 4.0, -0.7), material=Material(density=1 / (math.pi * 0.25), friction=0.4)
        )
        for k in range(5)
    ]
    right = (force - 0.4 * (10 + 5) * g) / (3 * 10 + 5)
    assert right == pytest.approx(1.17543, abs=1e-5)

    def draw(steps):
        for _ in range(steps):
            board.apply_force((force, 0.0))
            Watch(world).step()

    draw(30)
    before = [body.velocity[0] for body in (board, *discs)]
    draw(60)
    gained = [body.velocity[0] - at for body, at in zip((board, *discs), before, strict=True)]
    assert gained[0] == pytest.approx(3 * right, rel=0.01) and gained[1:] == pytest.approx([right] * 5, rel=0.01)


# --- loads and tipping ------------------------------------------------------------------------------------------------


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("count", [1, 5, 12])
def test_contacts_of_a_column_carry_what_is_above(solver, count):
    """The contact k from the top carries k m g dt, summed over its points."""
    world = metres(solver)
    ground = floor(world)
    boxes = column(world, count)
    Watch(world, passive=True).step(300)
    contacts = world.contacts
    for k, box in enumerate(boxes):
        below = ground.id if k == 0 else boxes[k - 1].id
        carried = contacts["normal_impulse"][(contacts["body_a"] == below) & (contacts["body_b"] == box.id)].sum()
        assert carried == pytest.approx((count - k) * G * world.dt, rel=0.01)


@needs_speed
def test_leaning_cards_need_half_the_tangent():
    """Two cards that lean at 25 degrees from the vertical stand if mu is above tan(25) / 2 = 0.2332, within 10 %."""
    lean, stands = math.radians(25), {}
    limit = math.tan(lean) / 2
    for friction in (0.9 * limit, 1.1 * limit):
        world = metres("soft_step", substeps=8)
        floor(world, friction=friction)
        for side in (-1, 1):  # round at their ends, so that they meet upright on the floor and level at the top
            world.add_body(
                Capsule((0, -1), (0, 1), 0.02),
                position=(side * (math.sin(lean) + 0.02), -math.cos(lean) - 0.02),
                angle=-side * lean,
                material=Material(friction=friction),
            )
        Watch(world, passive=True).step(300)
        stands[friction > limit] = tuple(-world.bodies["y"][1:])
    assert min(stands[True]) > 0.97 * math.cos(lean) and max(stands[False]) < 0.5


@pytest.mark.parametrize("solver", SOLVERS)
def test_domino_tips_beyond_its_diagonal(solver):
    """A domino released on its edge tips if it leans beyond atan(t / h), within 1 degree.

    By energy, one that is struck tips beyond an impulse of m g (sqrt(h² + t²) - h) / 2; 0.9 and 1.1 times this impulse
    are tested.
    """
    wide, high = 0.25, 1.0
    limit, reach = math.atan(wide / high), math.hypot(wide, high) / 2
    for sign in (-1, 1):
        world = metres(solver)
        floor(world, friction=2.0)
        at = sign * (limit + math.radians(1.0))
        lean = sign * (limit - math.radians(1.0))
        ends = []
        for x, angle in ((0.0, lean), (10.0, at)):
            tilt = limit - abs(angle)
            world.add_body(
                Polygon.box(wide, high),
                position=(x - sign * reach * math.sin(tilt), -reach * math.cos(tilt)),
                angle=angle,
                material=Material(friction=2.0),
            )
        Watch(world, passive=True).step(240)
        ends = np.abs(world.bodies["angle"][1:])
        assert ends[0] < 0.02 and ends[1] == pytest.approx(math.pi / 2, abs=0.05)
    for share, falls in ((0.9, False), (1.1, True)):
        world = metres(solver)
        floor(world, friction=2.0)
        inertia = (wide**2 + high**2) / 12 + reach**2
        rate = math.sqrt(2 * share * G * (reach - high / 2) / inertia)
        box = world.add_body(
            Polygon.box(wide, high),
            position=(0.0, -high / 2),
            angular_velocity=rate,
            velocity=(rate * high / 2, -rate * wide / 2),
            material=Material(friction=2.0),
        )
        Watch(world, passive=True).step(300)
        assert (abs(box.angle) > 1.0) == falls
