"""Hard cases of pixel masks (section D): overlap tests by pixels and contacts by outlines,
checked against exact sums.
"""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, PixelMask, Polygon, World, collide, debug, distance, fit, mass_of
from physics.shapes.outline import outline_of
from tests.oracles.masks import shared_pixels


def squares(*size, **options):
    return PixelMask(np.ones(size, bool), **options)


def test_d2_single_pixels_meet_where_they_share_area(measured):
    """Two single pixels at offsets in eighths of a pixel collide exactly if they overlap.

    With exact poses both offsets must be less than 1. With snapped poses both must fall on the same pixel.
    """
    exact, drawn, wrong = squares(1, 1, snap=False), squares(1, 1), 0
    for dx in np.arange(-16, 17) / 8.0:
        for dy in np.arange(-16, 17) / 8.0:
            wrong += (len(collide(exact, (0, 0), exact, (dx, dy))) > 0) != (abs(dx) < 1 and abs(dy) < 1)
            here = [math.floor(each + 0.5) for each in (dx, dy)]
            wrong += (len(collide(drawn, (0.5, 0.5), drawn, (0.5 + dx, 0.5 + dy))) > 0) != (here == [0, 0])
    measured("D2", "verdicts that are wrong", wrong)


def wrong_verdicts(turned):
    """Return how many random pairs of masks get another verdict than the union of their pixel squares.

    turned: True rotates the masks.
    """
    pytest.importorskip("shapely")
    from tests.oracles import outlines

    rng, hits, wrong = np.random.default_rng(4), 0, 0
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
        wrong += (len(collide(mask, pose_a, other, pose_b)) > 0) != (shared > 0.0)
    assert hits > 20
    return wrong


def test_d4_at_exact_poses_no_overlap_is_missed_and_as_drawn_a_known_share(measured):
    """With exact poses no overlap of two masks is missed; with snapped poses the share missed is 1 - (63/64)².

    Snapping loses overlaps of less than a whole pixel.
    """
    measured("D4", "overlaps missed or made up at exact poses", wrong_verdicts(False))
    mask, rng, hits, missed = squares(32, 32), np.random.default_rng(5), 0, 0
    for dx, dy in rng.uniform(-32.0, 32.0, (40_000 if JIT else 4_000, 2)).tolist():
        hits += 1
        missed += len(collide(mask, (0.0, 0.0), mask, (dx, dy))) == 0
    measured("D4", "misses of what is drawn off 3.10 %", abs(missed / hits - (1.0 - (63.0 / 64.0) ** 2)))


def test_d8_turned_masks_meet_where_their_squares_do(measured):
    measured("D8", "verdicts that are wrong", wrong_verdicts(True))


def test_d5_a_turned_line_keeps_its_area_and_lets_no_ball_of_a_pixel_through(measured):
    """A rotated one-pixel line keeps the area of its pixels and stops a ball one pixel wide at every angle.

    The line is rotated by its exact pose, not by resampling.
    """
    line, ball = squares(1, 32, snap=False), Circle(0.5)
    for degrees in range(0, 91, 5 if JIT else 15):
        turn = math.radians(degrees)
        world = World(Effects(continuous=True))
        world.add_body(line, angle=turn, kind="static")
        mass = mass_of(tuple(part.shape for part in outline_of(line)), 1.0).mass
        measured("D5", "error of its area", abs(mass / 32.0 - 1.0))
        for along in np.linspace(-15, 15, 13):
            x, y = along * math.cos(turn), along * math.sin(turn)
            nx, ny = -math.sin(turn), math.cos(turn)
            world.add_body(
                ball, position=(x - 25.3 * nx, y - 25.3 * ny), velocity=(3000.0 * nx, 3000.0 * ny), continuous="toi"
            )
        world.step()
        met = {int(each) for each in world.events.begin["body_b"] if each}
        measured("D5", "balls of a pixel that pass", 13 - len(met))


def test_d7_a_turned_square_has_its_area(measured):
    for degrees in range(1, 90):
        turn = math.radians(degrees)
        measured("D7", "error of the area as drawn", abs(squares(32, 32).turned(turn).solid.sum() / 1024.0 - 1.0))
    for degrees in (3, 17, 45, 80):
        found = collide(squares(32, 32, snap=False), (0, 0, math.radians(degrees)), squares(80, 80, snap=False), (0, 0))
        measured("D7", "error of the area, exact", abs(found.area / 1024.0 - 1.0))


@pytest.mark.parametrize("continuous", [False, True])
def test_d11_a_sprite_misses_a_thin_wall_at_the_known_rate_and_never_when_swept(measured, continuous):
    """Sprites that move 100 px a step miss a thin wall with a probability of 1 - (w + L) / (v dt).

    w is the thickness of the wall, L the length of the sprite; the phases of the steps are random. With continuous
    collision none misses it.
    """
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
        measured("D11", "misses when swept", len(set(ids.tolist()) - met))
        return
    rate = 1.0 - (width + size) / 100.0
    sigma = math.sqrt(rate * (1.0 - rate) / count)
    measured("D11", "misses when not, off the formula", abs(1.0 - len(met) / count - rate) / sigma)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_d13_a_frame_that_grows_into_the_floor_is_pushed_out_gently(measured, solver):
    """A sprite that grows 3 px into the floor is pushed out at 3 m/s at most, and is at rest half a second later."""
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
    measured("D13", "speed out", fastest)
    for _ in range(30):
        world.step()
    measured("D13", "kinetic energy per mass after 1 s", body.kinetic_energy / body.mass)
    assert body.position.y == pytest.approx(37.0, abs=0.2)


def sprite():
    rng = np.random.default_rng(14)
    return PixelMask(rng.random((15, 22)) < 0.6, origin=(3.0, 11.0))


def test_d14_flipped_and_scaled_sprites_keep_their_centre_and_area(measured):
    """Mirrored and scaled sprites keep their exact centre; the area grows with the square of the scale."""
    mask = sprite()
    x, y = mask.centroid
    for flip_x, flip_y in ((True, False), (False, True), (True, True)):
        mirrored = mask.flipped(flip_x, flip_y).centroid
        measured("D14", "error of the centre", math.dist(mirrored, (-x if flip_x else x, -y if flip_y else y)))
    for factor in (2, 3):
        measured("D14", "error of the area", mask.scaled(factor).area - factor**2 * mask.area)
        measured("D14", "error of the centre", math.dist(mask.scaled(factor).centroid, (factor * x, factor * y)))
    disc = squares(40, 40).scaled(0.5)
    assert disc.area == 400 and disc.centroid == pytest.approx((0.0, 0.0), abs=1e-12)


def test_d16_what_is_thin_is_kept_and_what_is_symmetric_has_a_normal(measured):
    """Thin gaps and walls are kept, and a shape deep in a symmetric wall gets a unit normal.

    A gap of two pixels is free for collide(), distance() and rays. The push-out distance is exact to half a pixel.
    """
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
            measured("D16", "normal's length less 1", abs(math.hypot(*found.normal) - 1.0))
            if aside:
                measured("D16", "error of the depth", abs(-found.separations.min() - 6.0 + abs(aside)))


def test_d17_a_spike_between_the_corners_of_a_long_edge_is_met(measured):
    """The tip of a spike collides with the middle of a long plank, at rest and in motion,
    whichever of the two moves.
    """
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
        measured("D17", "error of the depth", abs(-found.separations.min() - depth))


@pytest.mark.parametrize("radius, error", [(4, 0.028), (8, 0.011), (16, 0.0033), (32, 0.0012), (64, 0.0004)])
def test_d18_discs_of_pixels_weigh_as_discs(measured, radius, error):
    """Pixel discs with random centres have the area and the inertia of discs.

    The rms error over 200 centres is at most `error` for the area and twice that for the inertia. The random centres
    differ from those of the quoted source.
    """
    rng, size = np.random.default_rng(radius), 2 * radius + 3
    areas, inertias = [], []
    for x, y in rng.uniform(size / 2 - 0.5, size / 2 + 0.5, (200, 2)):
        rows, columns = np.indices((size, size)) + 0.5
        found = mass_of(PixelMask(np.hypot(columns - x, rows - y) <= radius), 1.0)
        areas.append(found.mass / (math.pi * radius**2) - 1.0)
        inertias.append(found.inertia / (math.pi * radius**4 / 2.0) - 1.0)
    measured("D18", "rms error of the area over that allowed", np.sqrt(np.mean(np.square(areas))) / error)
    measured("D18", "rms error of the inertia over that allowed", np.sqrt(np.mean(np.square(inertias))) / (2.0 * error))


def test_d1_empty_masks_never_meet_and_full_ones_do(measured):
    hits = missed = 0
    full = squares(5, 5)
    for size in ((0, 0), (0, 5), (5, 0), (5, 5)):
        for snap in (True, False):
            empty = PixelMask(np.zeros(size, bool), snap=snap)
            for other in (empty, full, Circle(3.0), Polygon.box(4, 4)):
                hits += len(collide(empty, (0, 0), other, (0, 0))) > 0
                hits += len(collide(other, (0, 0), empty, (0, 0))) > 0
            assert empty.area == 0
    for other in (full, Circle(3.0), Polygon.box(4, 4)):
        missed += len(collide(full, (0, 0), other, (0, 0))) == 0
    measured("D1", "hits of what is empty", hits)
    measured("D1", "hits of what is full that are missed", missed)


@pytest.mark.parametrize("width", [31, 32, 33, 63, 64, 65])
def test_d3_offsets_across_words_share_what_the_double_loop_says(measured, width):
    rng, wrong = np.random.default_rng(width), 0
    for other in (31, 33, 64, 65):
        a, b = rng.random((5, width)) < 0.5, rng.random((4, other)) < 0.5
        masks = PixelMask(a, origin=(0, 0)), PixelMask(b, origin=(0, 0))
        for left in range(-other - 2, width + 3):
            top = int(rng.integers(-4, 5))
            shared = len(shared_pixels(a.tolist(), 0, 0, b.tolist(), left, top))
            wrong += collide(masks[0], (0, 0), masks[1], (left, top)).area != shared
    measured("D3", "areas that are wrong", wrong)


def test_d6_ninety_turns_of_four_degrees_end_at_the_source(measured):
    """A sprite rotated 90 times by four degrees has its original pixels again, because each rotation starts from the
    source.

    Repeated rotation of the rotated image would lose pixels.
    """
    mask = sprite()
    world = World(Effects())
    body = world.add_body(mask)
    for k in range(1, 91):
        body.move_to((0.0, 0.0), math.radians(4.0 * k))
        world.step()
    _, left, top, solid = debug.masks(world)[0]
    still = World(Effects())
    still.add_body(mask)
    still.step()
    _, was_left, was_top, was = debug.masks(still)[0]
    measured("D6", "pixels that differ after 360°", (solid != was).sum() + (left != was_left) + (top != was_top))


@pytest.mark.parametrize("name", ["plus", "ring", "checkerboard", "square"])
def test_d9_symmetric_overlaps_have_a_normal_and_a_depth(measured, name):
    rows, columns = np.indices((16, 16)) - 7.5
    solid = {
        "plus": (abs(rows) < 3) | (abs(columns) < 3),
        "ring": (np.hypot(rows, columns) < 8) & (np.hypot(rows, columns) > 5),
        "checkerboard": (rows + columns) % 2 == 0,
        "square": np.ones((16, 16), bool),
    }[name]
    for snap in (True, False):
        mask = PixelMask(solid, snap=snap)
        found = collide(mask, (0, 0), mask, (0, 0))
        measured("D9", "normal's length less 1", abs(math.hypot(*found.normal) - 1.0))
        measured("D9", "depth over the least extent", -found.separations.min() / 16.0)


def test_d10_ball_in_the_hole_of_a_ring_meets_its_hull_alone(measured):
    rows, columns = np.indices((41, 41)) - 20.0
    far = np.hypot(rows, columns)
    for snap in (True, False):
        ring, ball = (PixelMask(each, snap=snap) for each in ((far <= 20) & (far >= 16), far <= 10))
        measured("D10", "contacts of the masks", len(collide(ring, (0, 0), ball, (2.0, -3.0))))
        measured("D10", "contacts of the masks", len(collide(ring, (0, 0), Circle(10.0), (2.0, -3.0))))
        (around,) = fit(ring, "hull")
        measured("D10", "contacts of the hulls", len(collide(around, (0, 0), ball, (2.0, -3.0))))


def test_d12_large_masks_count_and_weigh_without_overflow(measured):
    size = 4096 if JIT else 512
    large, small = squares(size, size, origin=(0, 0)), squares(64, 64, origin=(0, 0))
    for at, wanted in (
        ((0, 0), 4096),
        ((size - 1, size - 1), 1),
        ((size - 64, 7), 4096),
        ((size, 0), 0),
        ((-63, 5), 64),
    ):
        measured("D12", "error of the shared area", collide(large, (0, 0), small, at).area - wanted)
    measured("D12", "error of the shared area", collide(large, (0, 0), large, (size - 1, 0)).area - size)
    exact = size**2 * (2.0 * size**2) / 12.0
    measured("D12", "relative error of the inertia", abs(mass_of(large, 1.0).inertia / exact - 1.0))


def test_d15_what_is_solid_is_what_has_more_alpha_than_the_threshold(measured):
    pygame = pytest.importorskip("pygame")
    surface = pygame.Surface((256, 1), pygame.SRCALPHA)
    for alpha in range(256):
        surface.set_at((alpha, 0), (9, 9, 9, alpha))
    wrong = 0
    for threshold in (0, 126, 127, 128, 254, 255):
        solid = PixelMask.from_surface(surface, threshold=threshold).solid[0]
        wrong += (solid != (np.arange(256) > threshold)).sum()
    keyed = pygame.Surface((4, 4))
    keyed.fill("red")
    keyed.set_colorkey("red")
    keyed.set_at((2, 1), "white")
    solid = PixelMask.from_surface(keyed).solid
    wrong += solid.sum() != 1 or not solid[1, 2]
    wrong += PixelMask.from_surface(pygame.Surface((5, 3), pygame.SRCALPHA)).solid.any()
    measured("D15", "pixels that are wrong", wrong)
