"""Hard cases of pixel masks (hard_cases D2, D4, D5, D7, D8, D11, D13, D14, D16 to D18, I4), with their tolerances.

What else there is of them: D1, D3, D9, D10, D12 in test_masks_and.py, D6 in test_masks_turned.py, D15 in
test_mask_surface.py, G16 in test_mask_throws.py.
"""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, PixelMask, Polygon, World, collide, distance, mass_of
from physics.shapes.outline import outline_of


def squares(*size, **options):
    return PixelMask(np.ones(size, bool), **options)


def test_single_pixels_meet_where_they_share_area():
    """D2: offsets in eighths; exactly when both are nearer than 1, as drawn when they fall on one pixel."""
    exact, drawn = squares(1, 1, snap=False), squares(1, 1)
    for dx in np.arange(-16, 17) / 8.0:
        for dy in np.arange(-16, 17) / 8.0:
            assert (len(collide(exact, (0, 0), exact, (dx, dy))) > 0) == (abs(dx) < 1 and abs(dy) < 1), (dx, dy)
            here = [math.floor(each + 0.5) for each in (dx, dy)]
            assert (len(collide(drawn, (0.5, 0.5), drawn, (0.5 + dx, 0.5 + dy))) > 0) == (here == [0, 0]), (dx, dy)


@pytest.mark.parametrize("turned", [False, True])
def test_at_exact_poses_no_overlap_is_missed_and_none_is_made_up(turned):
    """D4 and D8: 0.2 % and 0.5 % of the hits may be wrong; none is. Both turned independently."""
    pytest.importorskip("shapely")
    from tests.oracles import outlines

    rng, hits = np.random.default_rng(4), 0
    mask = squares(32, 32, snap=False)
    plus = np.zeros((24, 24), bool)
    plus[9:15] = plus[:, 9:15] = True
    other = PixelMask(plus, snap=False) if turned else mask
    union = outlines.pixels(other.solid.tolist(), -other.origin[0], -other.origin[1])
    for _ in range(1000 if JIT else 60):
        angles = rng.uniform(0, math.tau, 2) if turned else (0.0, 0.0)
        pose_a, pose_b = (0.0, 0.0, float(angles[0])), (*rng.uniform(-34, 34, 2).tolist(), float(angles[1]))
        shared = outlines.rectangle(32, 32, pose_a).intersection(outlines.moved(union, pose_b)).area
        if 0.0 < shared < 1e-9:
            continue
        hits += shared > 0.0
        assert (len(collide(mask, pose_a, other, pose_b)) > 0) == (shared > 0.0), (pose_a, pose_b)
    assert hits > 20


def test_a_turned_line_keeps_its_area_and_lets_no_ball_of_a_pixel_through():
    """D5: by the exact pose, not by resampling: the area is that of its pixels, the ball is met at every angle."""
    line, ball = squares(1, 32, snap=False), Circle(0.5)
    for degrees in range(0, 91, 5 if JIT else 15):
        turn = math.radians(degrees)
        world = World(Effects(continuous=True))
        world.add_body(line, angle=turn, kind="static")
        assert mass_of(tuple(part.shape for part in outline_of(line)), 1.0).mass == pytest.approx(32.0, rel=0.05)
        for along in np.linspace(-15, 15, 13):
            x, y = along * math.cos(turn), along * math.sin(turn)
            nx, ny = -math.sin(turn), math.cos(turn)
            world.add_body(
                ball, position=(x - 25.3 * nx, y - 25.3 * ny), velocity=(3000.0 * nx, 3000.0 * ny), continuous="toi"
            )
        world.step()
        met = {int(each) for each in world.events.begin["body_b"] if each}
        assert len(met) == 13, degrees


def test_a_turned_square_has_its_area():
    """D7: 1.5 % as drawn, 0.1 % exactly."""
    for degrees in range(1, 90):
        turn = math.radians(degrees)
        assert squares(32, 32).turned(turn).solid.sum() == pytest.approx(1024, rel=0.015)
    for degrees in (3, 17, 45, 80):
        found = collide(squares(32, 32, snap=False), (0, 0, math.radians(degrees)), squares(80, 80, snap=False), (0, 0))
        assert found.area == pytest.approx(1024, rel=0.001)


@pytest.mark.parametrize("continuous", [False, True])
def test_a_sprite_misses_a_thin_wall_at_the_known_rate_and_never_when_swept(continuous):
    """D11: 100 px a step, random phases: 1 - (w + L) / (v dt) pass unseen; with the sweep none."""
    count, size, width = (10_000 if JIT else 300), 8, 1
    rng = np.random.default_rng(11)
    world = World(Effects(continuous=continuous))
    wall = world.add_body(squares(20 * count, width, snap=False, origin=(0, 0)), kind="static")
    places = np.stack([-150.0 - rng.uniform(0, 100, count), 10.0 + 20.0 * np.arange(count)], axis=1)
    ids = world.add_bodies(squares(size, size, snap=False), places, velocities=np.tile((6000.0, 0.0), (count, 1)))
    met = set()
    for _ in range(4):
        world.step()
        met |= set(world.events.begin["body_b"].tolist()) | set(world.events.begin["body_a"].tolist())
    met -= {wall.id}
    if continuous:
        assert met == set(ids.tolist())
        return
    rate = 1.0 - (width + size) / 100.0
    assert 1.0 - len(met) / count == pytest.approx(rate, abs=3.0 * math.sqrt(rate * (1.0 - rate) / count))


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_a_frame_that_grows_into_the_floor_is_pushed_out_gently(solver):
    """D13: 3 px in at once: out at 3 m/s at most, and no energy after half a second."""
    world = World(solver=solver)
    world.add_body(squares(20, 400), position=(0.0, 60.0), kind="static")
    body = world.add_body(squares(20, 20), position=(0.0, 40.0))
    for _ in range(90):
        world.step()
    body.set_shapes(PixelMask(np.ones((26, 20), bool), origin=(10, 13)))
    fastest = 0.0
    for _ in range(30):
        world.step()
        fastest = max(fastest, -body.velocity.y)
    assert fastest <= 3.0 * 32.0 * 1.01
    for _ in range(30):
        world.step()
    assert body.kinetic_energy < 0.5 * body.mass * 0.5**2 and body.position.y == pytest.approx(37.0, abs=0.2)


def sprite():
    rng = np.random.default_rng(14)
    return PixelMask(rng.random((15, 22)) < 0.6, origin=(3.0, 11.0))


def test_flipped_and_scaled_sprites_keep_their_centre_and_area():
    """D14: the centre mirrors exactly; the area goes with the square of the scale, up to a pixel of the border."""
    mask = sprite()
    x, y = mask.centroid
    for flip_x, flip_y in ((True, False), (False, True), (True, True)):
        assert mask.flipped(flip_x, flip_y).centroid == pytest.approx(
            (-x if flip_x else x, -y if flip_y else y), abs=1e-12
        )
    for factor in (2, 3):
        assert mask.scaled(factor).area == factor**2 * mask.area
        assert mask.scaled(factor).centroid == pytest.approx((factor * x, factor * y), abs=1e-9)
    disc = squares(40, 40).scaled(0.5)
    assert disc.area == 400 and disc.centroid == pytest.approx((0.0, 0.0), abs=1e-12)


def test_what_is_thin_is_kept_and_what_is_symmetric_has_a_normal():
    """D16: gaps and walls of two pixels are there for who asks the outline; deep in the middle a unit normal, and the
    way out is right to half a pixel."""
    bits = np.ones((20, 30), bool)
    bits[:, 14:16] = False  # a gap
    comb = PixelMask(bits, snap=False)
    needle = Polygon.box(1.0, 40.0)
    assert len(collide(needle, (0, 0), comb, (0, 0))) == 0 and distance(needle, (0, 0), comb, (0, 0)).distance == 0.5
    world = World(Effects(response=True, stacking=True))
    world.add_body(comb, kind="static")
    assert world.ray_cast((0.0, -30.0), (0.0, 60.0)) is None
    assert world.ray_cast((0.0, 0.0), (30.0, 0.0)).point.x == pytest.approx(1.0)
    wall = squares(40, 2, snap=False)
    for shape in (Circle(5.0), Polygon.box(10, 10), squares(10, 10, snap=False)):
        for aside in (0.0, 0.3, -2.0):
            found = collide(wall, (0, 0), shape, (aside, 0))
            assert math.hypot(*found.normal) == pytest.approx(1.0)
            if aside:
                assert -found.separations.min() == pytest.approx(6.0 - abs(aside), abs=0.5)


def test_a_spike_between_the_corners_of_a_long_edge_is_met():
    """D17: the tip of a spike against the middle of a long plank, both ways round, at rest and on its way."""
    spike = np.tril(np.ones((12, 12), bool))
    spike = PixelMask(np.concatenate([spike, spike[:, ::-1]], axis=1), snap=False)  # wide at its foot
    plank = squares(3, 120, snap=False)
    tip = min(y for part in outline_of(spike) for _, y in part.shape.points)
    for effects in (Effects(), Effects(response=True, rotation=True, stacking=True, continuous=True)):
        world = World(effects)
        world.add_body(plank, position=(0.0, -1.5), kind="static")
        body = world.add_body(spike, position=(3.7, -tip - 0.5))
        world.step()
        assert len(world.events.begin) == 1
        if effects.response:
            hit = world.shape_cast(plank, (0.0, 20.0), (0.0, -30.0))
            assert hit.body == body or hit is not None
    for depth in (0.1, 0.5, 2.0):
        found = collide(plank, (0, -1.5), spike, (3.7, spike.origin[1] - depth))
        assert -found.separations.min() == pytest.approx(depth, abs=0.5)


@pytest.mark.parametrize("radius, error", [(4, 0.028), (8, 0.011), (16, 0.0033), (32, 0.0012), (64, 0.0004)])
def test_discs_of_pixels_weigh_as_discs(radius, error):
    """D18: rms of 200 random centres; the inertia to twice that."""
    rng, size = np.random.default_rng(radius), 2 * radius + 3
    areas, inertias = [], []
    for x, y in rng.uniform(size / 2 - 0.5, size / 2 + 0.5, (200, 2)):
        rows, columns = np.indices((size, size)) + 0.5
        found = mass_of(PixelMask(np.hypot(columns - x, rows - y) <= radius), 1.0)
        areas.append(found.mass / (math.pi * radius**2) - 1.0)
        inertias.append(found.inertia / (math.pi * radius**4 / 2.0) - 1.0)
    assert np.sqrt(np.mean(np.square(areas))) <= error * 1.15  # of another 200 centres
    assert np.sqrt(np.mean(np.square(inertias))) <= 2.0 * error * 1.15


def test_a_mask_weighs_as_the_polygon_along_its_pixels_edges():
    """I4: mask, traced polygon, rectangles, to 1e-12; the smoothed outline by less than its own half pixel of edge."""
    pytest.importorskip("shapely")
    from tests.oracles import outlines

    mask = sprite()
    exact = mass_of(mask, 1.0)
    blocks = [(left, top, right, bottom) for left, top, right, bottom in mask.blocks(0)]
    boxes = [
        Polygon.box(right - left, bottom - top, ((left + right) / 2 - 3.0, (top + bottom) / 2 - 11.0))
        for left, top, right, bottom in blocks
    ]
    together = mass_of(tuple(boxes), 1.0)
    traced = outlines.pixels(mask.solid.tolist(), -3.0, -11.0)
    assert exact.mass == pytest.approx(traced.area, rel=1e-12) == pytest.approx(together.mass, rel=1e-12)
    assert exact.center == pytest.approx((traced.centroid.x, traced.centroid.y), abs=1e-12)
    assert exact.center == pytest.approx(together.center, abs=1e-12)
    assert exact.inertia == pytest.approx(together.inertia, rel=1e-12)
    parts = outlines.rounded_union([(part.shape.points, 0.0) for part in outline_of(mask)], (0, 0, 0))
    assert parts.symmetric_difference(traced).area <= 0.5 * traced.length
