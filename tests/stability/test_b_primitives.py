"""Hard cases of simple shapes and their manifolds (section B), checked against closed forms and exact arithmetic.

If the sign of the distance flickers by one rounding, contacts begin and end. If it is wrong, a needle passes through.
"""

import math
from fractions import Fraction

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Material, Polygon, Segment, collide, distance
from tests.oracles.exact_gaps import gaps_on_a_lattice, sign_of_gap
from tests.stability.invariants import Watch
from tests.stability.piles import SLOP, metres, pile_effects

STILL = (0.0, 0.0, 0.0)
HAIR = 1e-12  # of the size
BOX = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)]
KITE = [(-4.0, 0.0), (0.0, -3.0), (4.0, 0.0), (0.0, 5.0)]
SIXTEEN = [(6.0 * math.cos(k * math.pi / 8.0), 5.0 * math.sin(k * math.pi / 8.0)) for k in range(16)]
MEETINGS = {  # two outlines, where the second touches the first, and the way that parts them
    "corner at corner": (BOX, BOX, (8.0, 6.0), (1.0, 1.0)),
    "edge on edge": (BOX, BOX, (8.0, 1.25), (1.0, 0.0)),
    "edge on edge, ends alike": (BOX, BOX, (0.0, 6.0), (0.0, 1.0)),
    "corner at edge": (BOX, KITE, (8.0, 1.0), (1.0, 0.0)),
    "corner at slanted edge": (KITE, BOX, (6.0, -4.5), (3.0, -4.0)),
    "corner at corner of kites": (KITE, KITE, (8.0, 0.0), (1.0, 0.0)),
    "slanted edge on edge": (KITE, KITE[::-1], (4.0, 5.0), (5.0, 4.0)),
    "many corners at an edge": (SIXTEEN, BOX, (10.0, 0.5), (1.0, 0.0)),
    "needle at a box": (BOX, [(0.0, -2.0), (2e4, -1.0), (2e4, 3.0)], (4.0, 1.0), (1.0, 0.0)),
}


def moved(corners, way, by):
    """Return the corners of a polygon, moved by the length `by` along a direction `way` of any length."""
    along = by / math.hypot(*way)
    return [(x + along * way[0], y + along * way[1]) for x, y in corners]


def told(a, b):
    """Return (sign of the distance of two polygons, whether another call contradicts it).

    The other calls are collide() and distance() with exchanged shapes.
    """
    a, b = Polygon(a), Polygon(b)
    gap = distance(a, STILL, b, STILL).distance
    odd = (gap <= 0.0) != (len(collide(a, STILL, b, STILL)) > 0)
    odd |= (distance(b, STILL, a, STILL).distance <= 0.0) != (gap <= 0.0)
    return (gap > 0.0) - (gap < 0.0), odd


def test_b1_boxes_that_overlap_by_a_tenth(measured):
    box = Polygon.box(1, 1)
    for place, (far, error) in enumerate(((0.0, "error of the separation, here"), (1e7, None))):
        for a, b, normal in (((0.0, 0.0), (0.9, 0.0), (1, 0)), ((0.0, 0.0), (0.0, -0.9), (0, -1))):
            found = collide(box, (far + a[0], far + a[1], 0.0), box, (far + b[0], far + b[1], 0.0))
            measured("B1", "points", len(found))
            for separation, point in zip(found.separations, found.points, strict=True):
                if place == 0:
                    measured("B1", error, abs(separation + 0.1))
                off = max(abs(separation + 0.1), math.dist(found.normal, normal))
                # Midway between the surfaces, at the ends of the faces' common part.
                across = abs((point[0] - far) * normal[0] + (point[1] - far) * normal[1] - 0.45)
                along = abs(abs((point[0] - far) * normal[1] + (point[1] - far) * normal[0]) - 0.5)
                measured("B1", "error of separation, points and normal at 1e7", max(off, across, along))


def test_b2_faces_that_are_hardly_turned_keep_their_two_points(measured):
    """Two faces that are almost parallel keep two contact points with constant features in a world.

    The world assigns the impulses of the last step to points by their features.
    """
    seen = []
    for exponent in np.linspace(-12.0, -2.0, 101):
        for sign in (1.0, -1.0):
            turn = sign * 10.0**exponent
            world = metres(gravity=(0, 0))
            world.add_body(Polygon.box(1, 1), kind="static")
            world.add_body(Polygon.box(1, 1), position=(0.0, -1.0 + SLOP), angle=turn)
            world.step(0.0)
            found = world.contacts
            if abs(turn) <= SLOP:
                measured("B2", "points while the turn is below the slop", len(found))
                seen.append(tuple(found["feature"].tolist()))
            off = abs(math.atan2(found["normal_x"][0], -found["normal_y"][0]))
            measured("B2", "error of the normal over the turn", max(0.0, off - 1e-15) / abs(turn))
    for sign in (0, 1):
        measured("B2", "changes of feature while the turn is below the slop", len(set(seen[sign::2])) - 1)


DEGENERATE = [  # a disc of radius 0.5 whose centre is where no direction leads out
    ("box's centre", Polygon.box(2, 1), (0.0, 0.0), 1.0),
    ("square's centre", Polygon.box(2, 2), (0.0, 0.0), 1.5),
    ("edge", Polygon.box(2, 1), (1.0, 0.2), 0.5),
    ("corner", Polygon.box(2, 1), (1.0, 0.5), 0.5),
    ("end", Segment((-1.0, 0.0), (1.0, 0.0)), (1.0, 0.0), 0.5),
    ("segment", Segment((-1.0, 0.0), (1.0, 0.0)), (0.3, 0.0), 0.5),
    ("capsule's axis", Capsule((-1.0, 0.0), (1.0, 0.0), 0.25), (0.3, 0.0), 0.75),
    ("capsule's end", Capsule((-1.0, 0.0), (1.0, 0.0), 0.25), (1.0, 0.0), 0.75),
    ("disc's centre", Circle(0.25), (0.0, 0.0), 0.75),
]


@pytest.mark.parametrize("where, shape, at, depth", DEGENERATE, ids=[each[0] for each in DEGENERATE])
def test_b5_discs_in_the_middle_of_something_have_a_depth_and_a_normal(measured, where, shape, at, depth):
    for turn in (0.0, 0.7, -2.0):
        c, s = math.cos(turn), math.sin(turn)
        pose = (c * at[0] - s * at[1], s * at[0] + c * at[1], 0.0)
        first = collide(shape, (0.0, 0.0, turn), Circle(0.5), pose)
        gap = distance(shape, (0.0, 0.0, turn), Circle(0.5), pose)
        measured("B5", "error of the depth", abs(-first.separations.min() - depth))
        measured("B5", "error of the depth", abs(-gap.distance - depth))
        for normal in (first.normal, gap.normal):
            measured("B5", "normal's length less 1", abs(math.hypot(*normal) - 1.0))
        again = collide(shape, (0.0, 0.0, turn), Circle(0.5), pose)
        same = again.normal == first.normal and (again.points == first.points).all()
        measured("B5", "answers that differ when asked again", not same)


@pytest.mark.parametrize(
    "shape, width",
    [
        (Circle(3.0), 6.0),
        (Polygon.box(1, 1), 1.0),
        (Polygon.box(2, 6), 2.0),
        (Capsule((-5, 0), (5, 0), 2.0), 4.0),
        (Polygon([(0, 0), (4, 0), (0, 3)]), 2.4),
        (Polygon.box(2, 2), 2.0),
    ],
)
def test_b6_shapes_inside_themselves(measured, shape, width):
    for pose in (STILL, (3.0, -7.0, 0.7), (1e3, 5.0, -2.0)):
        found = collide(shape, pose, shape, pose)
        measured("B6", "error of the depth", abs(-found.separations.min() - width))
        measured("B6", "normal's length less 1", abs(math.hypot(*found.normal) - 1.0))


def long_and_short(measured, poses):
    """Check the contacts of a box that drifts and rotates on a long box, for a number of poses.

    A move along each contact's normal by its depth must end the overlap and be no longer than needed.
    """
    long, short = Polygon.box(600.0, 3.0), Polygon.box(20.0, 20.0)
    x, y, angle, missing, left, most = 0.0, 0.0, 0.0, 0, 0.0, 0.0
    for _ in range(poses):
        x, angle = x + 1e-4, angle + 0.005
        found = collide(long, STILL, short, (x, y, angle))
        missing += len(found) == 0 or abs(math.hypot(*found.normal) - 1.0) > 1e-12
        if len(found) == 0:
            continue
        depth = -float(found.separations.min())
        out = (x + depth * found.normal[0], y + depth * found.normal[1], angle)
        left = max(left, abs(distance(long, STILL, short, out).distance))
        half = 10.0 * (abs(math.cos(angle)) + abs(math.sin(angle)))
        most = max(most, depth / (1.5 + half - abs(y)) - 1e-12)
    measured("B7", "no normal, or no contact", missing)
    measured("B7", "overlap left after the push", left)
    measured("B7", "push over the least overlap of their shadows", most)


def test_b7_a_box_that_turns_on_a_long_one(measured):
    long_and_short(measured, 20_000 if JIT else 1000)


def test_b7_a_box_that_turns_on_a_long_one_two_hundred_thousand_times(measured):
    long_and_short(measured, 200_000 if JIT else 5000)


SLIVERS = {  # a shape hardly there, and how far it is from a point at (0, 8)
    "capsule of 1e-9": (lambda: Capsule((0, 0), (1e-9, 0), 1.0), 7.0),
    "capsule without length": (lambda: Capsule((0, 0), (0, 0), 1.0), 7.0),
    "triangle of area 1e-12": (lambda: Polygon([(-1, 0), (1, 0), (0, -1e-12)]), 8.0),
    "triangle of area 1e-8": (lambda: Polygon([(-1, 0), (1, 0), (0, -1e-8)]), 8.0),
    "edge of 1e-9": (lambda: Polygon([(-1, -1), (1, -1), (1, 0), (1 - 1e-9, 1e-12), (-1, 0)]), 8.0),
    "equal corners": (lambda: Polygon([(-1, -1), (1, -1), (1, -1), (0, 0)]), 8.0),
    "three in line": (lambda: Polygon([(-1, 0), (0, 0), (1, 0), (0, -1)]), 8.0),
    "all in line": (lambda: Polygon([(-1, 0), (0, 0), (1, 0)]), 8.0),
    "segment of 1e-9": (lambda: Segment((0, 0), (1e-9, 0)), 8.0),
    "box of 1e-9": (lambda: Polygon.box(1e-9, 1e-9), 8.0),
    "box of 2 by 1e-9": (lambda: Polygon.box(2.0, 1e-9), 8.0),
    "rounded sliver": (lambda: Polygon([(-1, 0), (1, 0), (0, -1e-9)], 0.5), 7.5),
}


@pytest.mark.parametrize("name", SLIVERS)
def test_b8_what_is_hardly_a_shape_is_refused_or_right(measured, name):
    make, gap = SLIVERS[name]
    try:
        shape = make()
    except ValueError as error:
        wrong = not any(word in str(error) for word in ("points", "a and b"))
        shape = None
    else:
        disc = Circle(2.0)
        found = distance(shape, STILL, disc, (0.0, 8.0, 0.0))
        wrong = abs(found.distance - (gap - 2.0)) > 1e-8 or abs(math.hypot(*found.normal) - 1.0) > 1e-12
        met = collide(shape, STILL, disc, (0.0, gap - 6.5, 0.0))
        wrong |= len(met) == 0 or abs(math.hypot(*met.normal) - 1.0) > 1e-12
        wrong |= not np.isfinite(met.separations).all()
    measured("B8", "neither refused nor right", wrong)


@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 3.7, 2.0**20])
@pytest.mark.parametrize("name", MEETINGS)
def test_b9_a_hair_apart_is_apart_and_a_hair_inside_overlaps(measured, name, scale):
    """With gaps and overlaps of 1e-12 to 1e-1 of the size, the sign of the distance equals the exact sign.

    Between gap and overlap the sign changes once.
    """
    a, b, place, way = MEETINGS[name]
    size = scale * max(math.hypot(x, y) for corners in (a, b) for x, y in corners)
    a = [(scale * x, scale * y) for x, y in a]
    b = [(scale * (x + place[0]), scale * (y + place[1])) for x, y in b]
    wrong, odd = 0, 0
    for exponent in range(1, 13):
        for sign in (1, -1):
            near = moved(b, way, sign * size * 10.0**-exponent)
            found, differs = told(a, near)
            wrong += sign_of_gap(a, near) != found or found != sign
            odd += differs
    steps = [told(a, moved(b, way, k * size * HAIR / 64.0)) for k in range(-64, 65)]
    signs = [sign for sign, _ in steps]
    odd += sum(differs for _, differs in steps)
    measured("B9", "signs that are not the rationals'", wrong)
    measured("B9", "flickers on the way through touching", int(signs != sorted(signs)))
    measured("B9", "contacts and distances that disagree", odd)


@pytest.mark.parametrize("name", ["corner at corner", "edge on edge", "edge on edge, ends alike", "corner at edge"])
def test_b9_touching_is_a_contact_of_no_depth(measured, name):
    """Touching polygons with integer corners have contacts and distance 0; the arithmetic is exact."""
    a, b, (x, y), way = MEETINGS[name]
    b = [(u + x, v + y) for u, v in b]
    measured("B9", "signs that are not the rationals'", int(sign_of_gap(a, b) != 0) + int(told(a, b)[0] != 0))
    beyond = [
        (math.nextafter(u, math.inf) if way[0] else u, math.nextafter(v, math.inf) if way[1] else v) for u, v in b
    ]
    assert sign_of_gap(a, beyond) == 1


def needles(measured, count):
    """Check `count` pairs of needles, 100 px by 0.001 px, against exact integer arithmetic of corners on a lattice.

    Every pair that crosses must be found, and no other.
    """
    rng, unit = np.random.default_rng(1), 2.0**-20
    turns = np.radians(rng.choice([-1.0, 1.0], (2, count)) * 10.0 ** rng.uniform(-4.0, -2.0, (2, count)))
    middle = np.stack([rng.uniform(-100.0, 100.0, count), rng.uniform(-4e-3, 4e-3, count)], axis=1)
    outlines = []
    for turn, place in ((turns[0], 0.0 * middle), (turns[1], middle)):
        u, v = np.array([(-50.0, -5e-4), (50.0, -5e-4), (50.0, 5e-4), (-50.0, 5e-4)]).T
        x, y = np.cos(turn)[:, None] * u - np.sin(turn)[:, None] * v, np.sin(turn)[:, None] * u + v
        outlines.append(np.rint((np.stack([x, y], axis=2) + place[:, None]) / unit).astype(np.int64))
    exact = gaps_on_a_lattice(*outlines) * unit
    assert 0.3 < (exact <= 0.0).mean() < 0.7
    a, b = ([Polygon(corners) for corners in (each * unit).tolist()] for each in outlines)
    found = np.array([distance(one, STILL, two, STILL).distance for one, two in zip(a, b, strict=True)])
    contact = np.array([len(collide(one, STILL, two, STILL)) > 0 for one, two in zip(a, b, strict=True)])
    clear = np.abs(exact) > 10.0 * HAIR  # a tenth of a hair of 100 px
    assert clear.mean() > 0.99
    overlap = exact <= 0.0
    for hit in (found <= 0.0, contact):
        measured("B10", "crossings missed", (overlap & ~hit & clear).sum())
        measured("B10", "crossings made up", (~overlap & hit & clear).sum())
    # Of an overlap the widest gap over faces is the depth.
    measured("B10", "error of the depth", np.abs(found - exact)[overlap].max())


def test_b10_needles_that_cross_at_a_thousandth_of_a_degree(measured):
    needles(measured, 10_000 if JIT else 1_000)


def test_b10_a_hundred_thousand_needles(measured):
    needles(measured, 100_000 if JIT else 2_000)


def squared_distance(a, b, c, d):
    """Return the exact squared distance of the segments a–b and c–d with integer ends, as a Fraction."""

    def to_segment(p, q, r):
        (ux, uy), (vx, vy) = (q[0] - p[0], q[1] - p[1]), (r[0] - p[0], r[1] - p[1])
        t = max(Fraction(0), min(Fraction(1), Fraction(ux * vx + uy * vy, ux * ux + uy * uy)))
        return (vx - t * ux) ** 2 + (vy - t * uy) ** 2

    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
        return Fraction(0)
    return min(to_segment(a, b, c), to_segment(a, b, d), to_segment(c, d, a), to_segment(c, d, b))


def test_b11_segments_are_as_far_apart_as_the_rationals_say(measured):
    rng = np.random.default_rng(11)
    cases = [((-1, -1), (-1, 1), (2, 0), (1, 0)), ((0, 0), (4, 0), (1, 0), (3, 0)), ((0, 0), (4, 0), (0, 1), (4, 1))]
    cases += [((0, 0), (4, 4), (0, 4), (4, 0)), ((0, 0), (4, 0), (0, 0), (0, 3)), ((0, 0), (4, 0), (4, 0), (9, 0))]
    cases += [((0, 0), (4, 0), (6, 0), (9, 0)), ((0, 0), (1000, 1), (0, 1), (1000, 2))]
    for _ in range(3000 if JIT else 300):
        a, b, c, d = map(tuple, rng.integers(-6, 7, (4, 2)).tolist())
        if a != b and c != d:
            cases.append((a, b, c, d))
    assert squared_distance(*cases[0]) == 4
    for a, b, c, d in cases:
        found, size = distance(Segment(a, b), STILL, Segment(c, d), STILL), max(map(abs, (*a, *b, *c, *d)))
        # Segments that cross overlap, by as much as parts them: a distance of 0.
        off = abs(max(found.distance, 0.0) ** 2 - float(squared_distance(a, b, c, d)))
        measured("B11", "error of the squared distance", off / size**2)
        assert abs(math.hypot(*found.normal) - 1.0) <= 1e-12


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
def test_b12_what_only_might_touch_is_not_touched(measured, solver):
    """A speculative contact that is not reached in the step gets an impulse of exactly 0.

    The gaps go up to twice the margin of 4 slops.
    """
    aside = slowed = heard = 0.0
    for gap in np.linspace(0.0, 8.0 * SLOP, 17).tolist():
        for shape, foot in ((Circle(0.5), 0.5), (Polygon.box(1, 1), 0.5), (Capsule((-0.5, 0), (0.5, 0), 0.25), 0.25)):
            effects = pile_effects(gravity=False, sensors=True, stacking=solver != "projection")
            world = metres(solver, gravity=(0, 0), effects=effects)
            world.add_body(Polygon.box(40.0, 2.0, (0.0, 1.0)), kind="static")
            world.add_body(Polygon.box(40.0, 2.0, (100.0, 1.0)), kind="static", sensor=True)
            smooth = Material(friction=0.3, restitution=0.9)
            away = world.add_body(shape, position=(0.0, -foot - gap), velocity=(1.3, -0.7), material=smooth)
            # 0.9 of the gap in this step: it does not arrive.
            slow = (0.3, 0.9 * gap / world.dt)
            near = world.add_body(shape, position=(9.0, -foot - gap), velocity=slow, material=smooth)
            above = world.add_body(shape, position=(100.0, -foot - gap), velocity=slow)
            Watch(world).step()
            aside = max(aside, math.dist(away.velocity, (1.3, -0.7)))
            if gap > 0.0:
                slowed, heard = max(slowed, math.dist(near.velocity, slow)), heard + len(world.events.sensor_begin)
            assert above.velocity == slow
    measured("B12", "change of a velocity that goes away", aside)
    measured("B12", "sensors that hear what they do not touch", heard)
    measured("B12", "change of a velocity that does not arrive", slowed)
