"""One-way masks: bodies stand on their upper side and pass from all other sides; pixel queries are unchanged."""

import math

import numpy as np
import pytest

from physics import Capsule, Chain, Circle, Effects, PixelMask, Polygon, Snapshot, World, collide, fit
from physics.shapes.outline import surfaces_of
from physics.tables.shape import CHAIN, PART

FULL = Effects.rigid_bodies().with_(one_way=True)
SMOOTH = Effects(response=True, gravity=True, stacking=True, one_way=True)  # nothing rubs, nothing turns
PUSHES = Effects(response=True, gravity=True, one_way=True)
G = 9.8 * 32.0
TOP = 100.0  # [px] y of the plank
FALLERS = {
    "circle": (Circle(6), 6.0),
    "box": (Polygon.box(12, 12), 6.0),
    "rounded": (Polygon.box(6, 6).__class__([(-3, -3), (3, -3), (3, 3), (-3, 3)], 3.0), 6.0),
    "capsule": (Capsule((0, -3), (0, 3), 3), 6.0),
    "mask": (PixelMask(np.ones((12, 12), bool)), 6.0),
}


def plank(width=64, height=8, **values):
    return PixelMask(np.ones((height, width), bool), origin=(0, 0), **{"one_way": True, **values})


def arched(width=160, height=40, **values):
    """Return a one-way mask of a sagging bridge, 6 px thick, from the left edge of the mask to its right edge."""
    x = np.arange(width)
    top = np.round(4.0 + 14.0 * np.sin(np.pi * (x + 0.5) / width)).astype(int)
    rows = np.arange(height)[:, None]
    return PixelMask((rows >= top) & (rows < top + 6), origin=(0, 0), **{"one_way": True, **values})


def surface_y(mask, x):
    """Return the y of a mask's upper surface at x, both in the mask's own space.

    The upper surface must be one connected line.
    """
    (stretch,) = surfaces_of(mask)
    points = np.array(stretch.shape.points)
    return float(np.interp(x, points[:, 0], points[:, 1]))


def world_with(shape, effects=FULL, kind="static", **values):
    world = World(effects)
    body = world.add_body(shape, position=(0, TOP), kind=kind, **values)
    return world, body


def steps(world, count):
    for _ in range(count):
        world.step()


# --- the shape ---------------------------------------------------------------------------------------------------


def test_upper_side_is_what_leads_to_the_right():
    solid = np.zeros((30, 40), bool)
    solid[10:30, :] = True
    solid[4:10, 20:30] = True  # a block on it: its sides are no part, and part the runs
    solid[16:22, 5:15] = False  # a hole: its floor is one
    found = {tuple(map(tuple, each.shape.points)) for each in surfaces_of(PixelMask(solid, origin=(0, 0)))}
    assert found == {((0, 10), (20, 10)), ((20, 4), (30, 4)), ((30, 10), (40, 10)), ((5, 22), (15, 22))}
    assert surfaces_of(PixelMask(np.zeros((4, 4), bool))) == ()


def test_upper_side_of_a_curve_is_one_run_near_its_pixels():
    mask = arched()
    (stretch,) = surfaces_of(mask)
    points = np.array(stretch.shape.points)
    assert (np.diff(points[:, 0]) > 0).all()
    assert points[0, 0] == 0 and points[-1, 0] == 160
    for x in range(160):
        assert abs(surface_y(mask, x + 0.5) - np.flatnonzero(mask.solid[:, x])[0]) <= 1.0


def test_what_is_made_of_it_is_open_too():
    mask = arched()
    assert mask.one_way and not PixelMask(mask.solid).one_way
    for each in (
        mask.flipped(x=True),
        mask.scaled(2),
        mask.with_(sensor=True),
        *fit(mask, "mask"),
        *fit(mask, "pixels"),
    ):
        assert each.one_way
    assert mask.with_(sensor=False).with_().one_way
    shut = mask.with_(one_way=False)
    assert not shut.one_way and shut.with_(one_way=True) is mask and "one_way" in repr(mask) + repr(shut) != repr(shut)
    assert fit(shut, "mask")[0].one_way is False


@pytest.mark.parametrize("value", [1, None, "yes", np.ones((2, 2), bool)])
def test_one_way_is_a_bool(value):
    pygame = pytest.importorskip("pygame")
    solid, surface = np.ones((4, 4), bool), pygame.Surface((4, 4), pygame.SRCALPHA)
    for make in (
        lambda: PixelMask(solid, one_way=value),
        lambda: PixelMask.from_array(solid, one_way=value),
        lambda: PixelMask.from_surface(surface, one_way=value),
        lambda: PixelMask.from_mask(pygame.Mask((4, 4)), one_way=value),
        *([] if value is None else [lambda: PixelMask(solid).with_(one_way=value)]),
    ):
        with pytest.raises(TypeError, match="one_way"):
            make()


def test_what_falls_cannot_be_open():
    world = World(FULL)
    with pytest.raises(ValueError, match="one_way.*static or kinematic"):
        world.add_body(plank())
    assert len(world) == 0
    body = world.add_body(plank(), kind="kinematic")
    with pytest.raises(ValueError, match="one_way"):
        body.set_kind("dynamic")
    assert body.kind == "kinematic"


# --- bodies ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("effects", [FULL, PUSHES], ids=["solver", "projection"])
@pytest.mark.parametrize("name", FALLERS)
def test_what_falls_rests(name, effects):
    shape, half = FALLERS[name]
    world, _ = world_with(plank(), effects)
    body = world.add_body(shape, position=(32, 60))
    steps(world, 120)
    assert body.position.y == pytest.approx(TOP - half, abs=0.16)
    assert abs(body.velocity.y) < 1e-6 + (G / 60.0 if effects is PUSHES else 0.0)
    assert effects is PUSHES or not body.awake


@pytest.mark.parametrize("name", FALLERS)
@pytest.mark.parametrize("apex", [-8.0, 3.0])
def test_a_jump_from_below_ends_on_it_or_falls_back(name, apex):
    """A body that jumps up through the plank lands on it if it gets through completely.

    If it gets only half through, it falls as in an empty world. apex: greatest height of its feet above the plank.
    """
    shape, half = FALLERS[name]
    world, _ = world_with(plank(), FULL.with_(sleeping=False))
    start, low = 140.0, TOP - apex - half
    speed = math.sqrt(2.0 * G * (start - low))
    body = world.add_body(shape, position=(32, start), velocity=(0, -speed))
    free = World(FULL)
    other = free.add_body(shape, position=(32, start), velocity=(0, -speed))
    rising, lands = True, apex > 0.0
    for _ in range(180):
        world.step()
        free.step()
        rising = rising and body.velocity.y < 0.0
        if rising or (apex < -4.0):
            assert body.position == other.position and body.velocity == other.velocity
    if lands:
        assert body.position.y == pytest.approx(TOP - half, abs=0.16)
    elif apex < -4.0:
        assert body.position.y > 1000.0


@pytest.mark.parametrize("name", FALLERS)
def test_from_a_side_it_is_not_there(name):
    """A body that flies into the end of a one-way plank passes: its centre is above the surface, its feet are below."""
    shape, _ = FALLERS[name]
    world, _ = world_with(plank(), FULL.with_(gravity=False))
    body = world.add_body(shape, position=(-30, TOP - 3.0), velocity=(120, 0))
    steps(world, 120)
    assert body.velocity == (120, 0) and body.position.y == TOP - 3.0
    assert body.position.x == pytest.approx(-30 + 240)
    assert not len(world.contacts)


def test_who_stands_inside_passes():
    world, _ = world_with(plank(height=30), FULL.with_(gravity=False))
    body = world.add_body(Circle(6), position=(32, TOP + 3), velocity=(0, 30))
    other = world.add_body(Circle(6), position=(12, TOP - 3), velocity=(0, 30))
    steps(world, 60)
    assert body.velocity == (0, 30) and other.velocity == (0, 30)


def test_a_peak_is_landed_on():
    """A body that falls on the tip of a steep ridge lands on it, and stays above both flanks."""
    height = np.abs(np.arange(80) - 39.5).astype(int)
    world, _ = world_with(PixelMask(np.arange(60)[:, None] >= height, origin=(40, 0), one_way=True))
    for x, shape in ((0.0, Circle(8)), (0.0, Polygon([(-2, -2), (2, -2), (2, 2), (-2, 2)], 6.0))):
        body = world.add_body(shape, position=(x, 70))
        lowest = 0.0
        for _ in range(60):
            world.step()
            lowest = max(lowest, body.position.y - abs(body.position.x))
        # The flanks are y = 100 + |x|; it comes by 2 px a step.
        assert lowest <= TOP - 8.0 + 2.0 and abs(body.position.x) + TOP - 8.0 > body.position.y - 2.0
        body.remove()


def test_it_slides_by_the_slope_of_the_outline():
    """A body slides on a 2:1 staircase of pixels with a = g sin(angle), as on a straight line.

    A chain of the same points gives the same motion.
    """
    rows, columns = np.mgrid[:100, :200]
    mask = PixelMask(rows >= columns // 2, origin=(0, 0), one_way=True)
    (stretch,) = surfaces_of(mask)
    (x0, y0), (x1, y1) = stretch.shape.points[1], stretch.shape.points[-2]
    slope = math.atan2(y1 - y0, x1 - x0)
    assert slope == pytest.approx(math.atan(0.5), abs=0.02)
    paths = []
    for ground in (mask, Chain(stretch.shape.points)):
        world, _ = world_with(ground, SMOOTH)
        x = 30.0
        y = TOP + y0 + (x - x0) * math.tan(slope)
        body = world.add_body(Circle(6), position=(x + 6 * math.sin(slope), y - 6 * math.cos(slope)))
        steps(world, 10)
        before = body.velocity.length
        steps(world, 30)
        paths.append((body.position, body.velocity))
        assert body.velocity.length - before == pytest.approx(G * math.sin(slope) * 0.5, rel=0.01)
        assert math.atan2(body.velocity.y, body.velocity.x) == pytest.approx(slope, abs=1e-3)
    assert np.abs(np.array(paths[0]) - np.array(paths[1])).max() < 1e-9


def test_it_rolls_through_a_sag_and_stays_on_it():
    mask = arched()
    world, _ = world_with(mask)
    ball = world.add_body(Circle(7), position=(16, TOP - 8), material=ball_material())
    worst = 0.0
    for k in range(400):
        world.step()
        if k > 40:
            x, y = ball.position
            worst = max(worst, y + 7.0 - (TOP + surface_y(mask, x)))
    assert worst < 0.5 and abs(ball.position.x - 80.0) < 70.0


def ball_material():
    from physics import Material

    return Material(friction=0.6, rolling_resistance=0.02)


@pytest.mark.parametrize(
    "shape", [Circle(2), Polygon.box(4, 4), PixelMask(np.ones((4, 4), bool))], ids=["ball", "box", "mask"]
)
def test_what_is_fast_is_stopped_from_above_alone(shape):
    world, _ = world_with(plank(height=2), FULL.with_(gravity=False))
    down = world.add_body(shape, position=(20, 13), velocity=(0, 3000))
    up = world.add_body(shape, position=(44, 190), velocity=(0, -3000))
    steps(world, 6)
    assert down.position.y <= TOP - 2.0 + 0.5
    assert up.velocity == (0, -3000) and up.position.y == pytest.approx(190 - 300)
    without, _ = world_with(plank(height=2), FULL.with_(gravity=False, continuous=False))
    down = without.add_body(shape, position=(20, 13), velocity=(0, 3000))
    steps(without, 6)
    assert down.position.y > TOP


@pytest.mark.parametrize("name", FALLERS)
def test_what_is_fast_passes_from_where_it_lies_across_or_without_the_effect(name):
    shape, _ = FALLERS[name]
    for effects, start in ((FULL, TOP - 3.0), (FULL.with_(one_way=False), TOP - 30.0)):
        world, _ = world_with(plank(height=2), FULL.with_(gravity=False))
        world.set_effects(effects.with_(gravity=False))  # what is open from below needs the effect when it is added
        body = world.add_body(shape, position=(32, start), velocity=(0, 3000))
        steps(world, 3)
        assert body.velocity == (0, 3000) and body.position.y == pytest.approx(start + 150)


def test_a_lift_of_it_carries_and_lets_in_from_below():
    world, lift = world_with(plank(), kind="kinematic", velocity=(0, -60))
    body = world.add_body(Polygon.box(12, 12), position=(32, TOP - 6))
    below = world.add_body(Circle(5), position=(12, TOP + 40), gravity_scale=0.0)
    steps(world, 60)
    assert lift.position.y == pytest.approx(TOP - 60)
    assert body.position.y == pytest.approx(TOP - 66, abs=0.3)
    assert below.position == (12, TOP + 40)
    lift.velocity = (0, 60)
    steps(world, 120)  # down past the ball
    assert below.position == (12, TOP + 40) and below.velocity == (0, 0)
    assert body.position.y == pytest.approx(lift.position.y - 6, abs=0.3)
    lift.velocity = (0, -60)
    steps(world, 70)  # and up again: now the ball has been above it
    assert below.position.y == pytest.approx(lift.position.y - 5, abs=0.3)


def test_a_turned_one_is_open_from_its_own_back():
    world = World(FULL.with_(gravity=False))
    world.add_body(PixelMask(np.ones((8, 64), bool), one_way=True), angle=math.pi / 2, kind="static")  # faces right
    left = world.add_body(Circle(6), position=(-40, 0), velocity=(60, 0))
    right = world.add_body(Circle(6), position=(60, 20), velocity=(-60, 0))
    steps(world, 60)
    assert left.velocity == (60, 0) and left.position.x == pytest.approx(20)
    assert right.position.x == pytest.approx(4 + 6, abs=0.3)


# --- without the effect, and by pixels ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", FALLERS)
def test_without_the_effect_nobody_is_pushed(name):
    shape, _ = FALLERS[name]
    world, _ = world_with(plank(), FULL)
    world.set_effects(FULL.with_(one_way=False))
    free = World(FULL.with_(one_way=False))
    bodies = [each.add_body(shape, position=(32, 60), velocity=(0, 100)) for each in (world, free)]
    for _ in range(60):
        world.step()
        free.step()
        assert not len(world.contacts) and not len(world.events.begin)
    assert bodies[0].position == bodies[1].position and bodies[0].position.y > TOP + 100


@pytest.mark.parametrize("snap", [True, False])
def test_pixels_answer_as_ever(snap):
    rng, ball = np.random.default_rng(4), Circle(5)
    one, other = arched(snap=snap), arched(snap=snap, one_way=False)
    sprite = PixelMask(np.ones((9, 9), bool), snap=snap)
    for shape in (ball, sprite):
        for x, y in rng.uniform((-10, -10), (170, 50), (60, 2)).tolist():
            a, b = (collide(mask, (0, 0), shape, (x, y)) for mask in (one, other))
            assert all(np.array_equal(u, v) for u, v in zip(vars(a).values(), vars(b).values(), strict=True))
    worlds = [World(FULL) for _ in range(4)]
    for k, world in enumerate(worlds):
        world.add_body((one, other)[k % 2], kind="static")
        if k < 2:
            world.set_effects(Effects.detection())
            world.add_bodies(ball, rng_places())
            world.step()
    found = [
        world.contacts[[name for name in world.contacts.dtype.names if "shape" not in name]] for world in worlds[:2]
    ]
    assert (found[0] == found[1]).all() and len(found[0]), "but for the ids of shapes, which set_effects gave anew"
    for point in ((80.5, 20.5), (80.5, 30), (3, 7), (80.5, 10)):
        assert len({len(world.query_point(point)) for world in worlds[2:]}) == 1
    assert [len(world.overlap(ball, (80, 21))) for world in worlds[2:]] == [1, 1]


def rng_places():
    return np.random.default_rng(8).uniform((-10, -10), (170, 50), (40, 2))


def test_a_sensor_feels_its_pixels():
    world, body = world_with(plank(height=30))
    world.add_body(Circle(4), position=(32, TOP + 20), kind="static", sensor=True)
    feeler = world.add_body(Circle(4), position=(12, TOP + 20), sensor=True, gravity_scale=0.0)
    world.step()
    begun = world.events.sensor_begin
    assert {(row["body_a"], row["body_b"]) for row in begun} == {(body.id, feeler.id)}


@pytest.mark.parametrize("effects", [FULL, FULL.with_(one_way=False)], ids=["on", "off"])
def test_rays_and_casts_meet_it_from_above(effects):
    """Rays and casts hit a one-way mask from above only, whether the effect is declared or not."""
    world, body = world_with(arched(), FULL)
    world.set_effects(effects)
    y = TOP + surface_y(arched(), 60.0)
    hit = world.ray_cast((60, 0), (0, 200))
    assert hit.body == body and hit.shape == body.shape_ids[0] and hit.point.y == pytest.approx(y)
    assert world.ray_cast((60, 250), (0, -200)) is None
    cast = world.shape_cast(Circle(1e-3), (60, 0), (0, 200))
    assert cast.body == body and cast.point.y == pytest.approx(y, abs=0.01)
    assert world.shape_cast(Circle(5), (60, 250), (0, -200)) is None
    assert world.shape_cast(Circle(5), (60, y - 2), (0, 50)) is None  # half through
    assert world.shape_cast(Polygon.box(8, 8), (-20, TOP + 3), (30, 0)) is None  # from a side
    assert world.shape_cast(Polygon.box(8, 8), (60, 60), (0, 100)).body == body


# --- changes -----------------------------------------------------------------------------------------------------


def test_carving_cuts_it():
    world, body = world_with(plank(width=128), FULL.with_(carving=True))
    left = world.add_body(Circle(6), position=(16, TOP - 6))
    middle = world.add_body(Circle(6), position=(64, TOP - 6))
    steps(world, 60)
    assert not left.awake and not middle.awake
    before = body.shape_ids
    done = body.carve(Circle(16), (64, TOP + 4))
    assert done.removed > 200 and body.shape_ids == before and body.shapes[0].one_way
    steps(world, 40)
    assert left.position.y == pytest.approx(TOP - 6, abs=0.16)
    assert middle.position.y > TOP + 30
    rows = world.shapes[(world.shapes["role"] == PART) & (world.shapes["body"] == body.id)]
    assert len(rows) >= 1 and (rows["kind"] == CHAIN).all() and (rows["parent"] == before[0]).all()


def test_what_breaks_off_lies_as_any_other():
    world, body = world_with(plank(width=128), FULL.with_(carving=True))
    world.add_body(Polygon.box(400, 20), position=(64, TOP + 100), kind="static")
    steps(world, 2)
    (piece,) = body.carve(Polygon.box(8, 40), (50, TOP + 4)).fragments
    assert piece.kind == "dynamic" and not piece.shapes[0].one_way and body.shapes[0].one_way
    steps(world, 120)
    assert piece.position.y == pytest.approx(TOP + 86, abs=0.3)  # on the floor, flat
    below = world.add_body(Circle(4), position=(20, TOP + 88 - 60), velocity=(0, 50))
    steps(world, 60)
    assert below.position.y < TOP + 82 + 0.3  # and met from all sides


def test_another_frame_keeps_ids_and_who_stands_on_it():
    """A one-way mask that is replaced keeps the bodies that stand on it and the shape id of an unchanged surface.

    The mask has two separate surfaces, and one of them is raised by 2 px. This is more than a body that touches a
    one-way mask may overlap it.
    """
    solid = np.zeros((40, 120), bool)
    solid[10:20, :50] = True
    solid[10:20, 70:] = True
    raised = solid.copy()
    raised[8:10, 70:] = True
    world, body = world_with(PixelMask(solid, origin=(0, 0), one_way=True))
    balls = [world.add_body(Polygon.box(10, 10), position=(x, TOP + 5)) for x in (25, 95)]
    steps(world, 40)
    parts = world.shapes["role"] == PART
    before = {int(row["id"]): row["geometry"] for row in world.shapes[parts & (world.shapes["body"] == body.id)]}
    body.set_shapes(PixelMask(raised, origin=(0, 0), one_way=True))
    parts = (world.shapes["role"] == PART) & (world.shapes["body"] == body.id)
    after = set(world.shapes["id"][parts].tolist())
    assert len(after) == 2 and len(after & before.keys()) == 1
    fastest = 0.0
    for _ in range(90):
        world.step()
        fastest = max(fastest, balls[1].velocity.length)
    assert balls[0].position.y == pytest.approx(TOP + 5, abs=0.16)
    assert balls[1].position.y == pytest.approx(TOP + 3, abs=0.16)
    assert fastest < 150.0
    body.set_shapes(PixelMask(raised, origin=(0, 0)))  # and shut: the same surface from all sides
    steps(world, 30)
    assert not (world.shapes["kind"] == CHAIN).any()
    assert balls[1].position.y == pytest.approx(TOP + 3, abs=0.16)


def test_snapshots_keep_it(tmp_path):
    world, body = world_with(arched())
    world.add_body(Circle(6), position=(40, 60))
    up = world.add_body(Circle(6), position=(90, TOP + 45), velocity=(0, -170))
    while up.velocity.y < 0.0 and up.position.y + 6 > TOP + 20:
        world.step()
    steps(world, 3)  # it lies across
    world.snapshot().save(tmp_path / "s.npz")
    other = World(FULL)
    other.restore(Snapshot.load(tmp_path / "s.npz"))
    assert other.digest() == world.digest() and other.body(body.id).shapes[0].one_way
    for _ in range(120):
        world.step()
        other.step()
        assert world.digest() == other.digest()


def test_digests_tell_it_from_others():
    found = {world_with(plank(one_way=each), FULL)[0].digest() for each in (True, False)}  # one part either way
    assert len(found) == 2
