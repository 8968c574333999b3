"""Hard cases of distance, depth and casts (section C): closed forms, exact sums and certificates."""

import math
from itertools import pairwise

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Effects, Polygon, Segment, World, collide, distance, time_of_impact
from tests.oracles import rounded_hulls
from tests.oracles.rounded_hulls import Hulls
from tests.stability.certificates import AT_ONCE, ULPS, chunks, contact_excess, disagreements, distance_excess, room_for
from tests.stability.random_pairs import any_shape, hulls_of

STILL = (0.0, 0.0, 0.0)


def off_unit(*vectors):
    """Return the greatest deviation of the vectors' lengths from 1."""
    return max(abs(math.hypot(*each) - 1.0) for each in vectors)


@pytest.mark.parametrize("half", [1.6e-3, 2e-4, 1e-5])
def test_c1_point_beyond_the_short_edge_of_a_plank(measured, half):
    plank, tiny = Polygon.box(1.0, 2.0 * half), 2.0**-40
    for turn in (0.0, 0.3, 2.0):
        at = (0.505 * math.cos(turn), 0.505 * math.sin(turn))
        found = distance(plank, (0.0, 0.0, turn), Circle(tiny), (*at, 0.0))
        measured("C1", "error of the distance", abs(found.distance + tiny - 0.005))
        measured("C1", "normal's length less 1", off_unit(found.normal))
        world = World(Effects())
        world.add_body(plank, angle=turn, kind="static")
        world.step()
        _, _, gap = world.closest(at)
        measured("C1", "error of the distance", abs(gap - 0.005))


@pytest.mark.parametrize("half", [1.6e-3, 2e-4, 1e-5])
def test_c2_what_is_cast_past_a_short_edge_misses_or_has_a_normal(measured, half):
    world = World(Effects())
    world.add_body(Polygon.box(1.0, 2.0 * half), kind="static")
    world.step()
    start, odd, wrong = (0.506, 0.0035), 0, 0
    for dx in np.linspace(-0.02, 0.002, 45).tolist():
        way = (dx, -0.5)
        # Where it is as low as the plank's top, and as its bottom.
        high, low = (start[0] + dx * (start[1] - y) / 0.5 for y in (half, -half))
        clear = min(abs(high - 0.5), abs(low - 0.5)) > 1e-8
        for hit in (world.ray_cast(start, way), world.shape_cast(Circle(1e-9), (*start, 0.0), way)):
            odd += hit is not None and off_unit(hit.normal) > 1e-12
            wrong += clear and (hit is not None) != (min(high, low) < 0.5)
    measured("C2", "hits without a unit normal", odd)
    measured("C2", "hits of what is missed, misses of what is hit", wrong)


def test_c3_what_slides_a_hair_above_the_ground_has_a_normal(measured):
    ground, odd = Polygon.box(40.0, 2.0, (0.0, 1.0)), 0
    for shape, foot in (
        (Polygon.box(1, 1), 0.5),
        (Circle(0.5), 0.5),
        (Capsule((-0.5, 0), (0.5, 0), 0.25), 0.25),
        (Polygon([(-0.5, 0.25), (0.5, 0.25), (0.0, -0.5)]), 0.25),
    ):
        for x in np.linspace(-19.0, 19.0, 400 if JIT else 40).tolist():
            for gap in (5.96e-8, 1e-12, 1e-15):
                found = distance(ground, STILL, shape, (x, -foot - gap, 0.0))
                odd += found.distance > 0.0 and (off_unit(found.normal) > 1e-12 or abs(found.normal[1] + 1.0) > 1e-9)
                measured("C3", "error of the distance", abs(found.distance - ((foot + gap) - foot)))
    measured("C3", "distances above 0 without a unit normal", odd)


def test_c4_squares_overlap_alike_from_every_start(measured):
    """Two overlapping squares have the same depth and normal whichever corner the search starts from.

    Rotation and another first corner change the start of the search.
    """
    corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    for k in range(64):
        turn = math.tau * k / 64.0
        a, b = (Polygon(corners[i:] + corners[:i]) for i in (k % 4, k // 4 % 4))
        c, s = math.cos(turn), math.sin(turn)
        found = distance(a, (0.0, 0.0, turn), b, (-1.9 * s, 1.9 * c, turn))
        measured("C4", "error of the depth", abs(found.distance + 0.1))
        measured("C4", "error of the normal", math.dist(found.normal, (-s, c)))
        assert len(collide(a, (0.0, 0.0, turn), b, (-1.9 * s, 1.9 * c, turn))) == 2


WIDTHS = [
    (Polygon.box(2, 6), 2.0),
    (Polygon.box(1, 1), 1.0),
    (Circle(3.0), 6.0),
    (Capsule((-5, 0), (5, 0), 2.0), 4.0),
    (Polygon([(0, 0), (4, 0), (0, 3)]), 2.4),
    (Segment((-5, 0), (5, 1)), 0.0),
    (Polygon([(-1, -3), (1, -3), (1, 3), (-1, 3)], 0.5), 3.0),
]


@pytest.mark.parametrize("shape, width", WIDTHS)
def test_c7_identical_shapes_at_one_place_leave_by_their_width(measured, shape, width):
    for pose in (STILL, (3.0, -7.0, 0.7), (0.0, 0.0, math.pi / 2)):
        found = distance(shape, pose, shape, pose)
        measured("C7", "depth less the least width", abs(found.distance + width))
        measured("C7", "rounds", found.iterations)
        assert off_unit(found.normal) <= 1e-12


def test_c8_boxes_that_share_an_edge(measured):
    found = distance(Polygon.box(1, 1, (0.5, 0.5)), STILL, Polygon.box(1, 1, (1.5, 0.5)), STILL)
    measured("C8", "distance", abs(found.distance))
    measured("C8", "error of the normal", math.dist(found.normal, (1.0, 0.0)))
    for x, y in (found.point_a, found.point_b):
        measured("C8", "points off the edge", max(abs(x - 1.0), -y, y - 1.0))


def test_c9_small_gaps_and_overlaps_keep_sign_and_size(measured):
    box, disc = Polygon.box(2, 2), Circle(1.0)
    hexagon = Polygon([(math.cos(k), math.sin(k)) for k in np.arange(6) * math.pi / 3])
    gaps = sorted([0.0] + [sign * 10.0**-k for k in range(1, 16) for sign in (-1, 1)])
    for a, b, (x, y), reach in (
        (box, box, (1, 0), 2.0),
        (box, disc, (0, 1), 2.0),
        (disc, disc, (1, 0), 2.0),
        (box, box, (0, -1), 2.0),
        (hexagon, box, (1, 0), 2.0),
        (hexagon, hexagon, (0, 1), math.sqrt(3.0)),
        (Capsule((0, -1), (0, 1), 1.0), box, (1, 0), 2.0),
    ):
        found = []
        for gap in gaps:
            pose = (x * (reach + gap), y * (reach + gap), 0.0)
            found.append(distance(a, STILL, b, pose).distance)
            measured("C9", "error of the signed distance", abs(found[-1] - gap) / 2.0)
            assert (found[-1] <= 0.0) == (len(collide(a, STILL, b, pose)) > 0)
        falls = sum(one > two for one, two in pairwise(found))
        measured("C9", "steps at which the distance does not follow the gap", falls)
        measured("C9", "gaps told as touching", sum(each == 0.0 for each in found))


@pytest.mark.parametrize("length, depth", [(84.0, 0.05), (1e4, 1.0), (1e4, 1e-3)])
def test_c10_points_of_long_edges_stay_on_them(measured, length, depth):
    floor, rng = Polygon.box(length, 1.0), np.random.default_rng(10)
    for _ in range(200 if JIT else 40):
        turn, x = float(rng.uniform(0.0, 6.0)), float(rng.uniform(-0.5, 0.5) * length)
        c, s = math.cos(turn), math.sin(turn)
        pose = (c * x + s * (1.0 - depth), s * x - c * (1.0 - depth), turn)
        box = Polygon.box(2.0, 1.0)
        found, met = distance(floor, (0.0, 0.0, turn), box, pose), collide(floor, (0.0, 0.0, turn), box, pose)
        measured("C10", "error of the depth", abs(found.distance + depth))
        for px, py in (found.point_a, found.point_b, *met.points):
            u, v = c * px + s * py, c * py - s * px
            off = max(abs(u) - length / 2.0, abs(u - x) - 1.0, abs(v) - 0.5, abs(v + 1.0 - depth) - 0.5, 0.0)
            measured("C10", "points outside their own box", off)


def test_c12_near_parallel_planes_end_soon(measured):
    rounds = []
    for k in range(2000 if JIT else 200):
        tilt = 10.0 ** -(k % 17) * (1 if k % 2 else -1)
        a, b = Polygon.box(20.0, 2.0), Polygon.box(20.0, 2.0)
        gap = abs(10.0 * math.sin(tilt)) + 10.0 ** -(k % 14) * (1 if k % 3 else -1)
        rounds.append(distance(a, STILL, b, (0.017 * k, 2.0 + gap, tilt)).iterations)
    measured("C12", "rounds", max(rounds))
    measured("C12", "rounds of 99 in 100", np.percentile(rounds, 99))


def certify(measured, seed, count):
    """Measure `count` random pairs of one seed against the limits of row C13."""
    hits = 0
    for found in chunks(seed, count):
        measured("C13", "outside the bounds", distance_excess(found))
        excess, odd = contact_excess(found)
        measured("C13", "outside the bounds", excess)
        assert odd < 1e-3
        measured("C13", "overlaps missed or made up", disagreements(found))
        hits += int(found.touching.sum())
    measured("C13", "share that overlaps", hits / count)
    measured("C13", "share that overlaps, at most", hits / count)


def test_c13_random_pairs_keep_their_certificates(measured):
    certify(measured, 1, 20_000 if JIT else 2_000)


@pytest.mark.parametrize("seed", range(2, 5))
def test_c13_more_random_pairs_keep_their_certificates(measured, seed):
    certify(measured, seed, 100_000 if JIT else 2_000)


@pytest.mark.parametrize("place", [0.0, 1e7])
def test_c13_a_crowd_has_the_contacts_that_its_shapes_have(measured, place):
    """A crowd of shapes in one world has exactly the contacts that its pairs have: none is missing, none is extra."""
    rng, count = np.random.default_rng(3), 300 if JIT else 60
    world = World(Effects(rotation=True))
    shapes = [any_shape(rng) for _ in range(count)]
    reach = 60.0 * count**0.5  # [px] about every one overlaps another
    poses = np.column_stack([place + rng.uniform(-reach, reach, (count, 2)), rng.uniform(-7.0, 7.0, count)])
    for shape, (x, y, angle) in zip(shapes, poses.tolist(), strict=True):
        world.add_body(shape, position=(x, y), angle=angle, kind="kinematic")
    world.step(0.0)
    told = {}
    for row in world.contacts:
        pair = int(row["shape_a"]), int(row["shape_b"])
        told[pair] = min(float(row["separation"]), told.get(pair, np.inf))
    hulls, hits, steps = hulls_of(shapes), 0, np.array(np.triu_indices(count, 1))
    for start in range(0, steps.shape[1], AT_ONCE):
        one, two = steps[:, start : start + AT_ONCE]
        a, b = (
            Hulls(hulls.corners[k], hulls.radii[k]).placed(*(poses[k, :2] - poses[one, :2]).T, poses[k, 2])
            for k in (one, two)
        )
        lower = rounded_hulls.bounds(a, b).lower
        room = room_for(a, b) + ULPS * np.spacing(place)
        found = np.array([told.get((int(i), int(j)), np.nan) for i, j in zip(one, two, strict=True)])
        hits += int((lower < -room).sum())
        wrong = (np.isnan(found) & (lower < -room)) | (~np.isnan(found) & (lower > room))
        measured("C13", "overlaps missed or made up", wrong.sum())
        measured("C13", "outside the bounds", np.nanmax(np.abs(found - lower) / room, initial=0.0))
    assert hits > count / 2, "a crowd"


def test_c14_disc_and_box_in_closed_form(measured):
    box, disc, radius = Polygon.box(6.0, 4.0), Circle(1.5), 1.5
    for angle in np.random.default_rng(14).uniform(-4.0, 4.0, 10).tolist() + [0.0, math.pi / 2]:
        c, s = math.cos(angle), math.sin(angle)
        for u, v, gap, (nx, ny) in (
            (5.0, 0.5, 0.5, (1, 0)),
            (4.51, 0.0, 0.01, (1, 0)),
            (4.49, 0.0, -0.01, (1, 0)),
            (2.0, 0.1, -2.5, (1, 0)),
            (0.0, -1.0, -2.5, (0, -1)),
            (4.0, 3.0, math.sqrt(2) - 1.5, (0.5**0.5, 0.5**0.5)),
            (-3.0, -5.0, 1.5, (0, -1)),
            (-6.0, -6.0, 5.0 - radius, (-0.6, -0.8)),
        ):
            x, y = 3.0 + c * u - s * v, -4.0 + s * u + c * v
            found = distance(box, (3.0, -4.0, angle), disc, (x, y, 1.0))
            normal = (c * nx - s * ny, s * nx + c * ny)
            on_disc = (x - radius * normal[0], y - radius * normal[1])
            measured("C14", "error of depth and points", abs(found.distance - gap))
            measured("C14", "error of depth and points", math.dist(found.point_b, on_disc))
            on_box = (on_disc[0] - gap * normal[0], on_disc[1] - gap * normal[1])
            measured("C14", "error of depth and points", math.dist(found.point_a, on_box))
            measured("C14", "error of the normal", math.dist(found.normal, normal))


def test_c15_a_box_inside_a_big_one_leaves_by_the_least_translation(measured):
    big, small = Polygon.box(100, 100), Polygon.box(1, 1)
    places = [(0.0, 0.0), *map(tuple, np.random.default_rng(4).uniform(-49, 49, (400 if JIT else 40, 2)).tolist())]
    for x, y in places:
        for quarter in range(4):
            found = distance(big, STILL, small, (x, y, quarter * math.pi / 2))
            measured("C15", "depth less the least translation", abs(found.distance + 50.5 - max(abs(x), abs(y))))
            met = collide(big, STILL, small, (x, y, quarter * math.pi / 2))
            measured("C15", "depth less the least translation", abs(met.separations.min() - found.distance))


def test_c16_casts_that_start_in_contact(measured):
    """A cast that starts in contact hits at fraction 0 if the shapes approach, and misses if they separate, slide or
    rest.

    A grazing path that touches counts as a hit.
    """
    box, ball, wrong = Polygon.box(2, 2), Circle(1.0), 0
    for a, b in ((box, box), (ball, ball), (box, ball), (Capsule((0, -1), (0, 1), 1.0), box)):
        for gap in (0.0, -0.5):
            for move, hit in (((1, 0), True), ((-1, 0), False), ((0, 5), False), ((0, 0), False), ((1e-9, 3), True)):
                if a is ball and b is ball and gap < 0.0 and move == (0, 5):
                    continue  # overlapping discs that pass each other part at once
                for swap in (False, True):
                    moves = [(a, STILL, (*move, 0.0)), (b, (2.0 + gap, 0.0, 0.0), (2.0 + gap, 0.0, 0.0))]
                    found = time_of_impact(*(each for part in (moves[::-1] if swap else moves) for each in part))
                    wrong += found.hit != hit or found.fraction != (0.0 if hit else 1.0)
                    wrong += found.hit and off_unit(found.normal) > 1e-12
    for shape, y, fraction in ((ball, 2.0, 0.5), (ball, 2.0 + 1e-9, None), (box, 2.0 + 1e-9, None), (box, 2.0, 0.3)):
        found = time_of_impact(shape, (-5.0, y, 0.0), (5.0, y, 0.0), shape, STILL, STILL)
        wrong += found.hit != (fraction is not None) or (found.hit and abs(found.fraction - fraction) > 1e-9)
    measured("C16", "answers that are not the documented ones", wrong)


def test_c17_disc_cast_at_a_segment_turned_by_a_quarter(measured):
    upright = (1.0, 0.0, -math.pi / 2)
    for angle in (upright[2], math.nextafter(upright[2], 0.0), math.nextafter(upright[2], -2.0), math.pi / 2):
        upright = (1.0, 0.0, angle)
        disc, wall = (Circle(0.5), STILL, (1.0, 0.0, 0.0)), (Segment((-1, 0), (1, 0)), upright, upright)
        for swap in (False, True):
            found = time_of_impact(*(wall + disc if swap else disc + wall))
            measured("C17", "misses", not found.hit)
            measured("C17", "error of the fraction", abs(found.fraction - 0.5))
