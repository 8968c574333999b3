"""Hard cases of the broad phase (section A): no pair is missed, whatever the boxes are."""

import itertools
import math
import tracemalloc
from fractions import Fraction

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    JIT,
    BruteForce,
    Capsule,
    Circle,
    DynamicTree,
    Effects,
    Material,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    World,
    debug,
)
from tests.oracles.boxes import touching_pairs
from tests.stability.invariants import Watch, movers
from tests.stability.piles import metres, needs_speed

STRATEGIES = {
    "brute": BruteForce,
    "sweep": SweepAndPrune,
    "both axes": lambda: SweepAndPrune(axes="both"),
    "hash": SpatialHashGrid,
    "fine hash": lambda: SpatialHashGrid(0.37),
    "coarse hash": lambda: SpatialHashGrid(500.0),
    "tree": DynamicTree,
    "all pairs": lambda: BruteForce(incremental=False),
    "tight tree": lambda: DynamicTree(margin=0.0),
}
every_strategy = pytest.mark.parametrize("strategy", STRATEGIES)


def box_sets():
    """Yield (name, lower corners, upper corners) of the box sets of case A1; the corners are (n, 2) arrays."""
    rng = np.random.default_rng(1)
    for count in (0, 1, 2, 17, 256, 2000 if JIT else 300):
        lower = rng.uniform(-20.0, 20.0, (count, 2)) * math.sqrt(count)
        yield f"{count} random", lower, lower + rng.exponential(12.0, (count, 2))
    # Borders on a lattice: much touches, and every cell's border is met, below zero too.
    for cell in (1.0, 0.37, 16.0):
        lower = rng.integers(-8, 8, (120, 2)) * cell
        yield f"cells of {cell}", lower, lower + rng.integers(0, 4, (120, 2)) * cell
    point = np.full((9, 2), -3.0)
    yield "points at one place", point, point
    nested = np.arange(1.0, 20.0)[:, None] * (1.0, 1.0)
    yield "nested", -nested, nested
    touching = np.arange(-9.0, 9.0)[:, None] * (1.0, 0.0)
    yield "in a row", touching, touching + 1.0
    yield "in a row, an ulp apart", touching, np.nextafter(touching + 1.0, -np.inf)


@every_strategy
def test_a1_pairs_are_those_of_the_double_loop(measured, strategy):
    missed = made_up = disorder = 0
    for _, lower, upper in box_sets():
        right = (lower[:, None] <= upper[None]).all(axis=2)
        right = list(map(tuple, np.argwhere(np.triu(right & right.T, 1)).tolist()))
        found = list(map(tuple, STRATEGIES[strategy]().find_pairs(lower, upper).tolist()))
        missed += len(set(right) - set(found))
        made_up += len(set(found) - set(right))
        disorder += found != sorted(set(found))
    measured("A1", "pairs missed", missed)
    measured("A1", "pairs made up", made_up)
    measured("A1", "pairs told twice or out of order", disorder)


def test_a1_the_oracle_is_the_double_loop():
    for _, lower, upper in box_sets():
        if len(lower) <= 300:
            right = (lower[:, None] <= upper[None]).all(axis=2)
            found = np.argwhere(np.triu(right & right.T, 1)).tolist()
            assert list(map(tuple, found)) == touching_pairs(lower.tolist(), upper.tolist())


@every_strategy
def test_a2_bodies_at_one_point_all_pair_and_all_meet_a_ray(measured, strategy):
    lower = np.full((128, 2), 7.5)
    measured("A2", "pairs", len(STRATEGIES[strategy]().find_pairs(lower, lower + 3.0)))
    world = World(Effects(), STRATEGIES[strategy]())
    world.add_bodies(Circle(1.5), np.full((128, 2), 7.5))
    world.step()
    measured("A2", "pairs", len(world.candidates))
    measured("A2", "bodies that a ray meets", len(world.ray_cast_all((0.0, 7.5), (15.0, 0.0))))


@needs_speed
@pytest.mark.parametrize("broadphase", BROADPHASES)
@pytest.mark.parametrize("half", [1e4, 1e6])
def test_a3_stack_stands_on_a_huge_ground(measured, half, broadphase):
    world = metres(broadphase=BROADPHASES[broadphase]())
    world.add_body(Polygon.box(2.0 * half, 2.0), position=(0.0, 1.0), kind="static")
    boxes = [world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 - k)) for k in range(3)]
    # A thousand more on the same ground: it pairs with every one, and no structure may drown in its cells.
    world.add_bodies(Polygon.box(1, 1), [(50.0 + 0.9 * half / 1000 * k, -0.5) for k in range(1000)])
    watch = Watch(world, passive=True).step(500)
    for k, box in enumerate(boxes):
        measured("A3", "error of height", abs(box.position.y + 0.5 + k))
        measured("A3", "speed at the end", box.velocity.length)
        measured("A3", "way aside", abs(box.position.x))
    measured("A3", "speed ever", watch.fastest)


def churn(broadphase, steps):
    """Return a list of the memory [bytes] that Python has allocated after each step of a world.

    The world has 60 bodies, which are constantly replaced.
    """
    world = World(Effects(response=True), BROADPHASES[broadphase]())
    rng, alive, held = np.random.default_rng(4), [], []
    for _ in range(steps):
        for _ in range(3):
            alive.append(
                world.add_body(
                    Circle(float(rng.uniform(2.0, 9.0))),
                    position=tuple(rng.uniform(-200, 200, 2)),
                    velocity=tuple(rng.uniform(-90, 90, 2)),
                )
            )
        while len(alive) > 60:
            alive.pop(int(rng.integers(len(alive)))).remove()
        world.step()
        held.append(tracemalloc.get_traced_memory()[0])
    return held


@needs_speed  # rows read in plain Python are kept by its views
@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_a4_bodies_that_come_and_go_take_no_more_memory(measured, broadphase):
    churn(broadphase, 30)  # what is made once for all worlds
    tracemalloc.start()
    held = churn(broadphase, 400)
    tracemalloc.stop()
    measured("A4", "memory against that of step 100", max(held[101:]) / held[100])


@every_strategy
def test_a5_a_box_of_nan_is_told_and_no_other_pair_changes(measured, strategy):
    rng = np.random.default_rng(5)
    count = 1000 if JIT else 150
    lower = rng.uniform(-300.0, 300.0, (count, 2))
    upper, silent = lower + 12.0, 0
    for bad, row, axis, value in itertools.product(("lower", "upper"), (0, count // 2, count - 1), (0, 1), (math.nan,)):
        arrays = {"lower": lower.copy(), "upper": upper.copy()}
        arrays[bad][row, axis] = value
        try:
            STRATEGIES[strategy]().find_pairs(arrays["lower"], arrays["upper"])
            silent += 1
        except ValueError as error:
            silent += f"{bad}[{row}]" not in str(error)
    found = []
    for broken in (False, True):
        world = World(Effects(), STRATEGIES[strategy]())
        ids = world.add_bodies(Circle(6.0), (lower + upper) / 2.0)
        world.step()
        victim = int(ids[count // 2])
        body = world.body(victim)
        for value in (math.nan, math.inf):
            for name in ("position", "velocity"):
                try:
                    setattr(body, name, (value, 0.0))
                    silent += 1
                except ValueError as error:
                    silent += name not in str(error)
        if broken:
            world.bodies["vx"][world.rows(victim)] = math.nan
        world.step()
        if broken:
            measured("A5", "NaN bodies not told", int(world.events.quarantined["body"].tolist() != [victim]))
        else:
            victim_shape = body.shape_ids[0]
        world.step()
        found.append({tuple(pair) for pair in world.candidates.tolist() if victim_shape not in pair})
    measured("A5", "refusals without its row or body", silent)
    measured("A5", "pairs of others that change", len(found[0] ^ found[1]))


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.6, -0.8), (math.sqrt(0.5), math.sqrt(0.5))])
@every_strategy
def test_a6_a_fast_body_pairs_with_all_it_sweeps(measured, strategy, way):
    """A body that moves 50 cells in a step is paired with every body in its path if the motion is continuous.

    Without continuous motion, only boxes at the end poses count, and no body between them is paired.
    """
    cell = 16.0
    far, way = 50.0 * cell, np.array(way)
    places = way * far * np.arange(1, 20)[:, None] / 20.0
    for continuous in (True, False):
        world = World(
            Effects(continuous=continuous), SpatialHashGrid(cell) if strategy == "hash" else STRATEGIES[strategy]()
        )
        posts = world.add_bodies(Circle(2.0), places, kind="static").tolist()
        rng = np.random.default_rng(6)
        world.add_bodies(Circle(2.0), rng.uniform(-far, far, (400, 2)), kind="static")
        fast = world.add_body(Circle(4.0), velocity=tuple(way * far * 60.0))
        world.step()
        pairs = {tuple(pair) for pair in world.candidates.tolist()}
        found = sum((post, fast.id) in pairs for post in posts)  # a shape each: their ids are the bodies'
        measured("A6", "swept pairs missed", len(posts) - found)
        if strategy == "hash":
            measured("A6", "cells visited per cell of its way", world.profile.counters["nodes_visited"] / 50.0)
    for at in ((0.0, 0.0), way * far):
        lower = np.vstack([places - 2.0, np.array(at) - 4.0])
        upper = np.vstack([places + 2.0, np.array(at) + 4.0])
        assert len(STRATEGIES[strategy]().find_pairs(lower, upper)) == 0, "what does not sweep misses all"


def beyond(shape, pose, box):
    """Return how far a shape extends beyond a box [px], as an exact fraction; 0 if it is inside."""
    x, y, angle = pose
    c, s, (x, y) = Fraction(math.cos(angle)), Fraction(math.sin(angle)), map(Fraction, (x, y))
    points = (shape.center,) if isinstance(shape, Circle) else shape.points
    radius = Fraction(shape.radius)
    worst = Fraction(0)
    for u, v in points:
        px, py = x + c * Fraction(u) - s * Fraction(v), y + s * Fraction(u) + c * Fraction(v)
        for gap in (
            Fraction(box[0]) - px + radius,
            Fraction(box[1]) - py + radius,
            px + radius - Fraction(box[2]),
            py + radius - Fraction(box[3]),
        ):
            worst = max(worst, gap)
    return worst


@pytest.mark.parametrize("place", [0.0, 1e5, 1e7])
def test_a7_boxes_hold_their_shapes_wherever_they_are(measured, place):
    """The boxes of moving shapes have a margin and contain their shapes, at any position.

    The boxes of static shapes are closed and rounded to nearest, not outward. Where an AABB decides the contact, boxes
    that are one rounding apart do not touch.
    """
    rng, worst = np.random.default_rng(7), {"static": Fraction(0), "dynamic": Fraction(0)}
    for kind in worst:
        world = metres(gravity=(0, 0))
        shapes = {}
        for k in range(200 if JIT else 40):
            shape = (
                Circle(float(rng.uniform(0.1, 2.0)), tuple(rng.normal(size=2).tolist())),
                Polygon.box(*rng.uniform(0.1, 3.0, 2).tolist()),
                Polygon([(-1.0, 0.3), (0.7, -0.9), (1.1, 0.8)], float(rng.uniform(0.01, 0.5))),
                Capsule((-0.7, 0.1), (0.6, 0.2), float(rng.uniform(0.05, 1.0))),
            )[k % 4]
            pose = (place * float(rng.uniform(-1, 1)), place * float(rng.uniform(-1, 1)), float(rng.uniform(-4, 4)))
            body = world.add_body(shape, position=pose[:2], angle=pose[2], kind=kind)
            shapes[body.shape_ids[0]] = (body, shape)
        world.step(0.0)
        boxes = debug.motion(world) if kind == "dynamic" else debug.bounds(world)
        for (body, shape), box in zip(shapes.values(), boxes.tolist(), strict=True):
            worst[kind] = max(worst[kind], beyond(shape, (*body.position, body.angle), box))
    measured("A7", "what moves outside its box", float(worst["dynamic"]))
    measured("A7", "what stands outside its box", float(worst["static"] / Fraction(math.ulp(max(place, 4.0)))))


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_a7_what_touches_is_a_candidate_wherever_it_is(measured, broadphase):
    """A disc that touches a rotated box is a candidate, even far from the origin; the exact overlap is at most one
    rounding.
    """
    rng, missed = np.random.default_rng(8), 0
    world = metres(gravity=(0, 0), broadphase=BROADPHASES[broadphase]())
    pairs = []
    for k in range(100 if JIT else 20):
        x, y, angle, half, r = 1e7 + 10.0 * k, -1e7, *rng.uniform((-3, 0.2, 0.1), (3, 2.0, 1.0)).tolist()
        ground = world.add_body(Polygon.box(2.0 * half, 2.0 * half), position=(x, y), angle=angle, kind="static")
        way = half + r - 2e-9
        disc = world.add_body(Circle(r), position=(x + way * math.cos(angle), y + way * math.sin(angle)))
        pairs.append((ground.id, disc.id))
    world.step()
    found = {tuple(pair) for pair in world.candidates.tolist()}
    missed = sum(pair not in found for pair in pairs)
    measured("A7", "touching pairs missed at 1e7", missed)


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_a8_slider_over_tiles_begins_and_ends(measured, broadphase):
    world = metres(broadphase=BROADPHASES[broadphase]())
    world.add_bodies(
        Polygon.box(1, 1), [(float(k), 0.5) for k in range(40)], kind="static", material=Material(friction=0.0)
    )
    slider = world.add_body(
        Polygon.box(0.8, 0.8), position=(0.0, -0.41), velocity=(8.0, 0.0), material=Material(friction=0.0)
    )
    watch, count, odd, open_pairs = Watch(world), 0, 0, set()
    for _ in range(330 if JIT else 60):
        watch.step()
        for row in world.events.end:
            odd += int(row["body_a"]) not in open_pairs
            open_pairs.discard(int(row["body_a"]))
        for row in world.events.begin:
            odd += int(row["body_a"]) in open_pairs
            open_pairs.add(int(row["body_a"]))
        count += len(world.events.begin) + len(world.events.end)
    assert movers(world)["x"][0] > (35.0 if JIT else 7.0) and slider.awake
    measured("A8", "begins and ends", count)
    measured("A8", "begins without an end, and ends without a begin", odd + (len(open_pairs) if JIT else 0))


RAYS = [  # the box from (-1, -1) to (1, 1): origin, translation, fraction or None
    ((-3, 0), (4, 0), 0.5),
    ((-3, 0), (2, 0), 1.0),
    ((-3, 0), (math.nextafter(2, 0), 0), None),
    ((-3, 0), (-4, 0), None),
    ((-3, -math.nextafter(1, 2)), (6, 0), None),
    ((-3, -1), (6, 0), 1 / 3),
    ((-3, 1), (6, 0), 1 / 3),
    ((-2, 0), (2, 2), 0.5),
    ((-2, -2), (4, 4), 0.25),
    ((0.5, 0.5), (5, 0), 0.0),
    ((0.2, 0.1), (0, 0), 0.0),
    ((1, 0), (0, 0), 0.0),
    ((math.nextafter(1, 2), 0), (0, 0), None),
    ((-3, 0), (0, 6), None),
]


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_a9_rays_at_a_box_hit_where_they_should(measured, broadphase):
    world = World(Effects(), BROADPHASES[broadphase]())
    world.add_body(Polygon.box(2, 2), kind="static")
    world.step()
    wrong, error = 0, 0.0
    for origin, translation, fraction in RAYS:
        found = world.ray_cast(origin, translation)
        wrong += (found is None) != (fraction is None)
        if found is not None and fraction is not None:
            error = max(error, abs(found.fraction - fraction))
    assert len(RAYS) == 14
    measured("A9", "hits missed or made up", wrong)
    measured("A9", "error of the fraction", error)
