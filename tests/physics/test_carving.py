"""Carving: which pixels are removed, which fragments form, and the effect on bodies, contacts,
snapshots and digests.
"""

import math

import numpy as np
import pytest
from shapely import LineString, Point, intersects_xy, prepare
from shapely import Polygon as Area

from physics import Capsule, Circle, Effects, Filter, Material, PixelMask, Polygon, Segment, Snapshot, TileGrid, World

CARVING = Effects.rigid_bodies().with_(carving=True)
FLAT = Effects(carving=True)


def world_of(solid, pose=(0.0, 0.0, 0.0), kind="static", effects=CARVING, origin=(0, 0), **more):
    world = World(effects)
    body = world.add_body(PixelMask(solid, origin), position=pose[:2], angle=pose[2], kind=kind, **more)
    return world, body


def pixels_of(body):
    return body.shapes[0].solid


def centers(mask, pose):
    """Return the world positions of the centres of all pixels of a mask, an array (rows, columns, 2)."""
    rows, columns = np.indices(mask.solid.shape)
    u, v = columns + 0.5 - mask.origin[0], rows + 0.5 - mask.origin[1]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return np.stack([pose[0] + c * u - s * v, pose[1] + s * u + c * v], axis=-1)


def pieces(solid):
    """Return the 8-connected pieces of solid pixels by flood fill: sets of (row, column), ordered by first pixel."""
    left, found = set(zip(*(each.tolist() for each in np.nonzero(solid)), strict=True)), []
    for start in sorted(left):
        if start not in left:
            continue
        piece, edge = set(), [start]
        left.discard(start)
        while edge:
            row, column = edge.pop()
            piece.add((row, column))
            near = {(row + j, column + i) for j in (-1, 0, 1) for i in (-1, 0, 1)} & left
            left -= near
            edge += near
        found.append(piece)
    return found


def as_solid(piece, shape):
    solid = np.zeros(shape, bool)
    solid[tuple(np.array(sorted(piece)).T)] = True
    return solid


# --- which pixels ---------------------------------------------------------------------------------------------------


def test_a_pixel_goes_when_its_centre_is_inside_closed():
    world, body = world_of(np.ones((20, 20), bool))
    # The disc's rim passes exactly through the centres at (2.5, 5.5) and (8.5, 5.5).
    found = body.carve(Circle(3), (5.5, 5.5))
    expected = np.array([[(x - 5) ** 2 + (y - 5) ** 2 > 9 for x in range(20)] for y in range(20)])
    assert found.removed == int((~expected).sum()) == 29
    assert np.array_equal(pixels_of(body), expected)


@pytest.mark.parametrize("seed", range(12))
def test_tools_at_any_pose_against_areas_of_shapely(seed):
    rng = np.random.default_rng(seed)
    solid = rng.random(rng.integers(20, 150, 2)) < 0.7
    pose = (*rng.uniform(-50, 50, 2).tolist(), float(rng.uniform(-3, 3)))
    world, body = world_of(solid, pose, effects=FLAT, origin=tuple(rng.uniform(0, 40, 2).tolist()))
    mask = body.shapes[0]
    at = (*centers(mask, pose)[tuple(each // 2 for each in solid.shape)].tolist(), float(rng.uniform(-3, 3)))
    corners = [(-9.0, -4.0), (8.0, -7.0), (13.0, 5.0), (-2.0, 9.0)]
    tools = (
        (Circle(11.3, (2.0, 1.0)), Point(2.0, 1.0).buffer(11.3, quad_segs=400)),
        (Capsule((-9, 2), (12, 5), 4.7), LineString([(-9, 2), (12, 5)]).buffer(4.7, quad_segs=400)),
        (Polygon(corners), Area(corners)),
        (Polygon(corners, radius=3.2), Area(corners).buffer(3.2, quad_segs=400)),
    )
    shape, area = tools[seed % 4]
    c, s = math.cos(at[2]), math.sin(at[2])
    seen = centers(mask, pose) - at[:2]
    local = np.stack([c * seen[..., 0] + s * seen[..., 1], c * seen[..., 1] - s * seen[..., 0]], axis=-1)
    prepare(area)
    found = body.carve(shape, at, crumb=10**6)
    inside = intersects_xy(area, local[..., 0], local[..., 1]) & solid
    assert found.removed == inside.sum() > 50
    rest = solid & ~inside
    # Of what split the largest stays: everything else is crumbs.
    kept = np.zeros_like(rest)
    for before in pieces(solid):
        parts = pieces(as_solid(before, solid.shape) & rest)
        if parts:
            kept |= as_solid(max(parts, key=len), solid.shape)
    assert np.array_equal(pixels_of(body), kept)
    assert found.crumbs == rest.sum() - kept.sum()
    assert found.fragments == ()


@pytest.mark.parametrize("snap", (True, False))
@pytest.mark.parametrize("angle", (0.0, 0.7))
def test_a_mask_as_tool_takes_the_centres_in_its_squares(snap, angle):
    rng = np.random.default_rng(3)
    tool = PixelMask(rng.random((15, 21)) < 0.5, snap=snap)
    pose = (10.25, -4.5, 0.3)
    world, body = world_of(np.ones((90, 110), bool), pose)
    at = (30.0, 20.0, angle)
    seen = centers(body.shapes[0], pose) - at[:2]
    c, s = math.cos(angle), math.sin(angle)
    u = c * seen[..., 0] + s * seen[..., 1] + tool.origin[0]
    v = c * seen[..., 1] - s * seen[..., 0] + tool.origin[1]
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    there = (i >= 0) & (i < 21) & (j >= 0) & (j < 15)
    hit = there & tool.solid[j.clip(0, 14), i.clip(0, 20)]
    assert body.carve(tool, at, crumb=10**6).removed == hit.sum()


def test_on_its_own_grid_a_mask_takes_what_its_closed_squares_hold():
    tool = PixelMask(np.ones((4, 6), bool), (0.5, 0.5))
    world, body = world_of(np.ones((20, 20), bool))
    found = body.carve(tool, (5.0, 5.0))
    # Its squares reach from (4.5, 4.5) to (10.5, 8.5): centres on all four sides are in.
    assert found.removed == 7 * 5


def test_across_tiles():
    solid = np.ones((130, 200), bool)
    world, body = world_of(solid)
    found = body.carve(Circle(20), (64, 64))
    y, x = np.indices(solid.shape)
    inside = (x + 0.5 - 64) ** 2 + (y + 0.5 - 64) ** 2 <= 400
    assert found.removed == inside.sum()
    assert np.array_equal(pixels_of(body), ~inside)
    assert body.shapes[0].area == (~inside).sum()
    assert np.array_equal(body.shapes[0].words, PixelMask(~inside).words)


# --- what comes loose -------------------------------------------------------------------------------------------------


def test_a_static_body_keeps_what_was_apart_and_the_largest_of_what_splits():
    solid = np.zeros((40, 60), bool)
    solid[5:8, 0:30] = True  # a bar that will split into 9 and 15
    solid[20:22, 10:14] = True  # an island that nothing touches
    world, body = world_of(solid, (100.0, 50.0, 0.0))
    found = body.carve(Polygon.box(6, 10), (112, 56))
    assert found.removed == 18 and found.crumbs == 0
    (piece,) = found.fragments
    assert piece.kind == "dynamic" and body.kind == "static"
    assert pixels_of(piece).shape == (3, 9) and pixels_of(piece).all()
    assert piece.bounds == (100.0, 55.0, 109.0, 58.0)
    kept = np.zeros_like(solid)
    kept[5:8, 15:30] = kept[20:22, 10:14] = True
    assert np.array_equal(pixels_of(body), kept)


def test_a_dynamic_body_keeps_its_largest_piece_alone():
    solid = np.zeros((40, 60), bool)
    solid[5:8, 0:30] = solid[20:22, 10:14] = True
    world, body = world_of(solid, kind="dynamic")
    found = body.carve(Circle(0.6), (29.5, 6.5))
    assert found.removed == 1
    (piece,) = found.fragments
    assert piece.shapes[0].area == 8 and body.shapes[0].area == 89


def test_of_two_pieces_of_one_size_the_first_stays():
    world, body = world_of(np.ones((3, 21), bool), kind="dynamic")
    found = body.carve(Polygon.box(1.2, 9), (10.5, 1.5))
    (piece,) = found.fragments
    assert body.bounds[0] == 0.0 and body.bounds[2] == 10.0
    assert piece.bounds[0] == 11.0


def test_crumbs_are_told_and_gone():
    solid = np.zeros((9, 40), bool)
    solid[4, 0:40] = True
    world, body = world_of(solid)
    assert body.carve(Circle(0.2), (3.5, 4.5), crumb=4) == (1, (), 3)
    found = body.carve(Circle(0.2), (8.5, 4.5), crumb=4)
    assert found.removed == 1 and found.crumbs == 0 and len(found.fragments) == 1
    assert len(body.carve(Circle(0.2), (10.5, 4.5), crumb=0).fragments) == 1
    assert len(world) == 3


def test_diagonal_pixels_hang_together():
    solid = np.eye(12, dtype=bool)
    world, body = world_of(solid)
    assert body.carve(Circle(0.1), (5.5, 5.5), crumb=0).fragments[0].shapes[0].area == 5


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ("static", "kinematic", "dynamic"))
def test_nothing_is_lost_against_flooding(seed, kind):
    """After carving, every pixel is in a fragment at its old position, in a dropped crumb, or under the tool.

    A crumb is a piece too small to become a fragment.
    """
    rng = np.random.default_rng(seed)
    solid = rng.random((70, 90)) < (0.55, 0.45)[seed % 2]
    if kind == "dynamic":
        solid = as_solid(max(pieces(solid), key=len), solid.shape)
    pose = (7.0, -3.0, 0.0)
    world, body = world_of(solid, pose, kind, FLAT)
    hit = body.carve(Polygon.box(5, 200), (50, 30, float(rng.uniform(-1, 1))), crumb=6)
    rest = [pixels_of(body)]
    for piece in hit.fragments:
        mask = piece.shapes[0]
        left, top = (round(piece.position[k] - mask.origin[k] - pose[k]) for k in (0, 1))
        whole = np.zeros_like(solid)
        whole[top : top + mask.size[1], left : left + mask.size[0]] = mask.solid
        assert len(pieces(mask.solid)) == 1 and mask.area >= 6
        rest.append(whole)
    together = sum(each.astype(int) for each in rest)
    assert together.max() == 1
    assert together.sum() + hit.removed + hit.crumbs == solid.sum()
    assert not (together.astype(bool) & ~solid).any()
    firsts = [min(zip(*np.nonzero(each), strict=True)) for each in rest[1:]]
    assert firsts == sorted(firsts)


# --- what bodies become ---------------------------------------------------------------------------------------------


def test_momentum_and_spin_go_on():
    effects = CARVING.with_(gravity=False)
    world = World(effects)
    body = world.add_body(
        PixelMask(np.ones((12, 50), bool)), position=(40, 60), angle=0.4, velocity=(30, -20), angular_velocity=5.0
    )
    density, place = body.mass / (12 * 50), {}
    before_center, before = body.center, body.velocity
    found = body.carve(Polygon.box(4, 60), (47, 62))
    (piece,) = found.fragments
    for each in (body, piece):
        dx, dy = each.center - before_center
        place[each.id] = (dx, dy)
        assert each.velocity == pytest.approx((before[0] - 5.0 * dy, before[1] + 5.0 * dx), abs=1e-12)
        assert each.angular_velocity == 5.0
        assert each.mass == pytest.approx(density * each.shapes[0].area, rel=1e-15)
        rows, columns = np.nonzero(each.shapes[0].solid)
        second = ((columns - columns.mean()) ** 2 + (rows - rows.mean()) ** 2).sum() + len(rows) / 6
        assert each.inertia == pytest.approx(density * second, rel=1e-12)
    assert piece.angle == body.angle == 0.4
    # Where the pixels were they are: a point of the piece is solid at the same place of the world.
    assert world.query_point(piece.center) == [piece]


def test_a_piece_takes_after_its_body():
    world = World(CARVING)
    material, filter = Material(density=3.0, friction=0.1), Filter(4, 7)
    body = world.add_body(
        PixelMask(np.ones((4, 40), bool)),
        kind="static",
        material=material,
        filter=filter,
        continuous="toi",
        gravity_scale=0.5,
    )
    (piece,) = body.carve(Polygon.box(2, 9), (5, 0)).fragments
    assert (piece.material, piece.filter, piece.continuous, piece.gravity_scale) == (material, filter, "toi", 0.5)
    assert piece.mass == 3.0 * piece.shapes[0].area
    assert piece.user is None


def test_a_mass_of_its_own_is_shared_out_by_pixels():
    world = World(CARVING)
    body = world.add_body(PixelMask(np.ones((4, 40), bool)), mass=8.0)
    (piece,) = body.carve(Polygon.box(8, 9), (-10, 0)).fragments
    assert piece.mass + body.mass == pytest.approx(8.0 * (160 - 32) / 160)


def test_other_shapes_stay():
    world = World(CARVING)
    body = world.add_body(PixelMask(np.ones((10, 10), bool)), Circle(5, (20, 0)))
    found = body.carve(Circle(30), (0, 0))
    assert found.removed == 100 and body.shapes == (Circle(5, (20, 0)),)
    assert body.mass == pytest.approx(math.pi * 25)


def test_everything_gone_removes_the_body_and_nothing_without_mass_is_left():
    world = World(CARVING)
    body = world.add_body(PixelMask(np.ones((10, 10), bool)))
    bones = world.add_body(PixelMask(np.ones((10, 10), bool)), Segment((0, 0), (9, 0)), position=(50, 0))
    assert body.carve(Circle(20), (0, 0)) == (100, (), 0)
    assert body not in world
    assert bones.carve(Circle(20), (50, 0)).removed == 100
    assert len(world) == 0
    world.step()


def test_a_carve_beside_the_body_does_nothing():
    world, body = world_of(np.ones((10, 10), bool))
    mask = body.shapes[0]
    assert body.carve(Circle(5), (1000, -1e9)) == (0, (), 0)
    assert body.shapes[0] is mask
    world.step()
    assert world.profile.counters["carved_pixels"] == 0


def test_carved_pixels_are_counted_in_the_next_step():
    world, body = world_of(np.ones((10, 10), bool))
    body.carve(Circle(2), (5, 5))
    body.carve(Circle(2), (5, 5))
    gone = 100 - body.shapes[0].area
    world.step()
    assert world.profile.counters["carved_pixels"] == gone > 0
    world.step()
    assert world.profile.counters["carved_pixels"] == 0


# --- what touches it -------------------------------------------------------------------------------------------------


def resting(solver, sleeping=True):
    world = World(CARVING.with_(sleeping=sleeping), solver=solver)
    floor = world.add_body(PixelMask(np.ones((40, 200), bool)), position=(100, 120), kind="static")
    crates = [world.add_body(PixelMask(np.ones((16, 16), bool)), position=(100, 92 - 16 * k)) for k in range(4)]
    for _ in range(120):
        world.step()
    return world, floor, crates


@pytest.mark.parametrize("solver", ("soft_step", "sequential_impulse"))
def test_contacts_on_what_stays_keep_their_forces(solver):
    world, floor, crates = resting(solver, sleeping=False)
    told = 0
    for k in range(30):
        floor.carve(Circle(6), (20 + k, 104 + k % 3))
        world.step()
        told += len(world.events.begin) + len(world.events.end)
        # A face that is found anew sticks from the next step on, and grips less firmly until then.
        assert max(each.velocity.length for each in crates) < 0.02
    assert told == 0
    assert {*zip(world.contacts["body_a"].tolist(), world.contacts["body_b"].tolist(), strict=True)} == {
        (k, k + 1) for k in range(4)
    }
    assert (world.contacts["shape_a"] < world.contacts["shape_b"]).all()


def test_what_slept_on_it_wakes_and_falls():
    world, floor, crates = resting("soft_step")
    assert not any(each.awake for each in crates)
    floor.carve(Circle(14), (100, 106))
    assert all(each.awake for each in crates)
    low = crates[0].position.y
    for _ in range(40):
        world.step()
    assert crates[0].position.y > low + 4.0


def test_a_crater_is_felt_where_it_was_dug():
    """A disc rolls into a carved crater, and passes where pixels are gone."""
    world = World(CARVING)
    floor = world.add_body(PixelMask(np.ones((40, 200), bool)), position=(100, 120), kind="static")
    floor.carve(Circle(12), (100, 100))
    ball = world.add_body(Circle(4), position=(100, 90))
    for _ in range(120):
        world.step()
    assert 107.0 < ball.position.y < 108.5
    assert world.ray_cast((100, 60), (0, 200), filter=Filter(1, 1)).body in (ball, floor)


def test_queries_see_the_hole_at_once():
    world, body = world_of(np.ones((64, 64), bool))
    assert world.query_point((30, 30)) == [body]
    body.carve(Circle(8), (30, 30))
    assert world.query_point((30, 30)) == []
    assert world.query_point((10, 10)) == [body]
    hit = world.ray_cast((30, 30), (100, 0))
    assert hit.body == body and 37.4 < hit.point.x < 38.6


def test_sensors_see_the_pixels_that_are_left():
    world = World(CARVING)
    floor = world.add_body(PixelMask(np.ones((40, 40), bool), (0, 0)), kind="static")
    world.add_body(Circle(4), position=(20, 20), kind="static", sensor=True)
    probe = world.add_body(Circle(3), position=(20, 20), sensor=True, gravity_scale=0.0)
    world.step()
    begun = world.events.sensor_begin
    assert floor.id in {*begun["body_a"]} | {*begun["body_b"]}
    floor.carve(Circle(9), (20, 20))
    world.step()
    ended = world.events.sensor_end
    assert {floor.id, probe.id} in [{row["body_a"], row["body_b"]} for row in ended]


# --- worlds, snapshots, digests --------------------------------------------------------------------------------


def test_in_worlds_without_response_verdicts_follow():
    world = World(FLAT)
    wall = world.add_body(PixelMask(np.ones((40, 40), bool), (0, 0)), kind="static")
    world.add_body(PixelMask(np.ones((4, 4), bool)), position=(20, 20))
    world.step()
    assert len(world.contacts) > 0
    wall.carve(Circle(6), (20, 20))
    world.step()
    assert len(world.contacts) == 0 and len(world.events.end) == 1


def test_masks_shared_by_several_bodies_are_carved_one_by_one():
    world = World(CARVING)
    mask = PixelMask(np.ones((20, 20), bool), (0, 0))
    one, two = (world.add_body(mask, position=(x, 0), kind="static") for x in (0, 100))
    one.carve(Circle(5), (10, 10))
    assert two.shapes[0] is mask and mask.area == 400 and one.shapes[0].area < 400
    assert world.query_point((110, 10)) == [two] and world.query_point((10, 10)) == []


@pytest.mark.parametrize("file", (False, True))
def test_snapshots_bring_pixels_back(file, tmp_path):
    world, floor, crates = resting("soft_step")
    floor.carve(Circle(10), (40, 104))
    world.step()
    taken, digest = world.snapshot(), world.digest()
    if file:
        taken.save(tmp_path / "carved.npz")
        taken = Snapshot.load(tmp_path / "carved.npz")
    pixels = pixels_of(floor).copy()
    (piece,) = crates[2].carve(Polygon.box(3, 40), crates[2].position).fragments
    floor.carve(Circle(20), (100, 104))
    assert world.digest() != digest
    for _ in range(10):
        world.step()
    after = world.digest()
    world.restore(taken)
    assert world.digest() == digest and piece not in world
    assert np.array_equal(pixels_of(floor), pixels)
    crates[2].carve(Polygon.box(3, 40), crates[2].position)
    floor.carve(Circle(20), (100, 104))
    for _ in range(10):
        world.step()
    assert world.digest() == after


def test_the_digest_holds_the_pixels():
    digests = set()
    for x in (10, 11):
        world, body = world_of(np.ones((40, 40), bool), effects=FLAT)
        body.carve(Circle(0.2), (x + 0.5, 20.5))
        digests.add(world.digest())
    assert len(digests) == 2


def test_snapshots_share_the_tiles_that_no_carve_touched():
    world, body = world_of(np.ones((256, 512), bool))
    first = world.snapshot()
    body.carve(Circle(6), (100, 100))
    second = world.snapshot()
    before, after = (each.geometry.masks[-1].tiles.words for each in (first, second))
    assert [k for k in range(32) if before[k] is not after[k]] == [9]


# --- bad input --------------------------------------------------------------------------------------------------


def test_bad_input():
    world, body = world_of(np.ones((10, 10), bool))
    with pytest.raises(TypeError, match="shape must be one of Circle, Capsule, Polygon, PixelMask"):
        body.carve(Segment((0, 0), (1, 0)), (0, 0))
    with pytest.raises(TypeError, match="shape must be one of"):
        body.carve(TileGrid([[True]], 8), (0, 0))
    with pytest.raises(TypeError, match="pose must be"):
        body.carve(Circle(2), 3)
    with pytest.raises(ValueError, match="pose"):
        body.carve(Circle(2), (math.nan, 0))
    with pytest.raises((TypeError, ValueError), match="crumb"):
        body.carve(Circle(2), (0, 0), crumb=-1)
    with pytest.raises((TypeError, ValueError), match="crumb"):
        body.carve(Circle(2), (0, 0), crumb=2.5)
    round_one = world.add_body(Circle(3))
    with pytest.raises(ValueError, match="must have a PixelMask to be carved"):
        round_one.carve(Circle(2), (0, 0))
    assert body.shapes[0].area == 100
    body.remove()
    with pytest.raises(KeyError):
        body.carve(Circle(2), (0, 0))
    plain = World(Effects.rigid_bodies())
    with pytest.raises(ValueError, match="needs the effect carving"):
        plain.add_body(PixelMask(np.ones((4, 4), bool))).carve(Circle(2), (0, 0))
