"""Hard cases of queries, sensors and events (section H)."""

import math

import numpy as np
import pytest

from physics import BROADPHASES, JIT, Capsule, Circle, Effects, Filter, PixelMask, Polygon, Segment, TileGrid, World
from tests.stability.invariants import Watch
from tests.stability.piles import floor, metres, pile_effects

every_broadphase = pytest.mark.parametrize("broadphase", BROADPHASES)
BOX = Polygon.box(1, 1)


@every_broadphase
def test_h2_rays_along_a_segment(measured, broadphase):
    """A ray along a segment hits it, because touching counts as a hit; a ray of length 0 is a point query."""
    world = World(Effects(), BROADPHASES[broadphase]())
    world.add_body(Segment((0, 0), (4, 0)), kind="static")
    world.step()
    wrong = 0
    for origin, way, fraction in (
        ((1, 0), (2, 0), 0.0),  # on it
        ((-2, 0), (2, 0), 1.0),  # ends at its end
        ((-2, 0), (4, 0), 0.5),
        ((6, 0), (-4, 0), 0.5),
        ((-2, 0), (-3, 0), None),  # away
        ((-2, -1e-9), (9, 0), None),  # beside it
        ((-2, 1e-9), (9, 0), None),
        ((2, -1), (0, 1), 1.0),
        ((2, -1), (0, math.nextafter(1, 0)), None),
        ((2, 0), (0, 0), 0.0),
        ((2, 1), (0, 0), None),
        ((5, 0), (0, 0), None),
    ):
        found = world.ray_cast(origin, way)
        wrong += (found is None) != (fraction is None)
        if found is not None and fraction is not None:
            wrong += abs(found.fraction - fraction) > 1e-15 or abs(math.hypot(*found.normal) - 1.0) > 1e-15
    measured("H2", "answers that are not the documented ones", wrong)


@every_broadphase
def test_h3_points_on_borders(measured, broadphase):
    """A point on the border between two shapes belongs to both, because shapes are closed.

    The tiles of one grid are one shape. Pixels are half-open.
    """
    missed = twice = beyond = 0
    world = World(Effects(), BROADPHASES[broadphase]())
    left = world.add_body(Polygon.box(2, 2), position=(1, 1), kind="static")
    right = world.add_body(Polygon.box(2, 2), position=(3, 1), kind="static")
    grid = world.add_body(TileGrid(np.ones((3, 3), bool), 2.0), position=(10, 0), kind="static")
    mask = world.add_body(PixelMask(np.ones((2, 2), bool), origin=(0, 0), snap=False), position=(20, 0), kind="static")
    world.step()
    for point, owners in (
        ((0.0, 0.0), {left}),
        ((0.0, 1.0), {left}),
        ((2.0, 1.0), {left, right}),
        ((2.0, 0.0), {left, right}),
        ((4.0, 2.0), {right}),
        ((math.nextafter(4, 5), 2.0), set()),
    ):
        found = world.query_point(point)
        missed += set(found) != owners
        twice += len(found) != len(set(found))
    for x in np.arange(10.0, 16.5, 1.0):
        for y in np.arange(0.0, 6.5, 1.0):
            found = world.query_point((float(x), float(y)))
            missed += grid not in found
            twice += found.count(grid) > 1
    for x in (20.0, 21.0, 22.0):
        for y in (0.0, 1.0, 2.0):
            found = mask in world.query_point((x, y))
            beyond += found and (x == 22.0 or y == 22.0)
            missed += not found and x < 22.0 and y < 2.0 and x > 20.0 and y > 0.0
    measured("H3", "closed shapes missed at a point of their border", missed)
    measured("H3", "tiles of one grid told more than once", twice)
    measured("H3", "pixels of a mask told at its far border", beyond)


@every_broadphase
def test_h4_questions_from_far_away(measured, broadphase):
    answers = []
    rng = np.random.default_rng(4)
    places = rng.integers(-64, 64, (120, 2)) / 4.0
    rays = rng.integers(-128, 128, (60, 4)) / 8.0
    for far in (0.0, 1e7):
        world = World(Effects(), BROADPHASES[broadphase]())
        for k, (x, y) in enumerate(places.tolist()):
            shape = (Circle(0.5), BOX, Capsule((-0.5, 0), (0.5, 0), 0.25))[k % 3]
            world.add_body(shape, position=(far + x, far + y), kind="static")
        world.step()
        found = []
        for x, y, dx, dy in rays.tolist():
            at = (far + x, far + y)
            hits = world.ray_cast_all(at, (dx, dy))
            cast = world.shape_cast(Circle(0.25), (*at, 0.0), (dx, dy))
            near = world.closest(at)
            assert near is not None
            found.append(
                (
                    (len(hits), len(world.overlap(Circle(2.0), (*at, 0.0))), cast is None, len(world.query_point(at))),
                    [each.fraction for each in hits] + ([cast.fraction] if cast else []),
                    [(p[0] - far, p[1] - far) for p in [each.point for each in hits] + [near[1]]],
                )
            )
        answers.append(found)
    differ = sum(one[0] != two[0] for one, two in zip(*answers, strict=True))
    measured("H4", "counts that differ from those at the origin", differ)
    for one, two in zip(*answers, strict=True):
        measured("H4", "error of fractions", np.abs(np.subtract(one[1], two[1])).max(initial=0.0))
        measured("H4", "error of points", np.abs(np.subtract(one[2], two[2])).max(initial=0.0))


@every_broadphase
@pytest.mark.parametrize("seed", range(3))
def test_h5_every_begin_has_one_end_whatever_becomes_of_the_bodies(measured, broadphase, seed):
    rng = np.random.default_rng(seed)
    world = metres(effects=pile_effects(sleeping=True, sensors=True), broadphase=BROADPHASES[broadphase]())
    floor(world)
    world.add_body(Polygon.box(8, 2), position=(0.0, -2.0), kind="static", sensor=True)
    alive, gone, odd = [], [], 0
    touching, sensed = set(), set()
    for tick in range(200 if JIT else 40):
        if len(alive) < 14:
            alive.append(world.add_body(BOX, position=(float(rng.uniform(-4, 4)), float(rng.uniform(-6, -1)))))
        body = alive[int(rng.integers(len(alive)))]
        edit = rng.integers(8)
        if edit == 0:
            alive.remove(body)
            gone.append(body)
            body.remove()
        elif edit == 1:
            body.set_shapes(Circle(0.4) if tick % 2 else BOX)
        elif edit == 2:
            body.filter = Filter(1, int(rng.integers(0, 2)))
        elif edit == 3:
            body.move_to((float(rng.uniform(-4, 4)), -5.0))
        elif edit == 4 and body.kind == "dynamic":
            body.apply_impulse((0.0, -4.0))
        world.step()
        events = world.events
        for pairs, ends, begins in (
            (touching, events.end, events.begin),
            (sensed, events.sensor_end, events.sensor_begin),
        ):
            for row in ends:
                pair = (int(row["shape_a"]), int(row["shape_b"]))
                odd += pair not in pairs
                pairs.discard(pair)
            for row in begins:
                pair = (int(row["shape_a"]), int(row["shape_b"]))
                odd += pair in pairs
                pairs.add(pair)
    for body in alive:
        body.remove()
    gone += alive
    world.step()
    for pairs, ends in ((touching, world.events.end), (sensed, world.events.sensor_end)):
        for row in ends:
            pairs.discard((int(row["shape_a"]), int(row["shape_b"])))
    measured("H5", "begins without an end, and ends without a begin", odd + len(touching) + len(sensed))
    accepted = 0
    for body in gone:
        for ask in (lambda b=body: b.position, lambda b=body: b.remove(), lambda b=body: world.body(b.id)):
            try:
                ask()
                accepted += 1
            except KeyError:
                pass
    measured("H5", "ids of what is gone that are accepted", accepted)


@pytest.mark.parametrize("kind", ["static", "kinematic"])
def test_h6_sleeper_over_a_sensor_is_heard_once_and_once_when_it_leaves(measured, kind):
    world = metres(effects=pile_effects(sleeping=True, sensors=True))
    floor(world)
    pad = world.add_body(Polygon.box(4, 1), position=(0.0, -0.5), kind=kind, sensor=True)
    box = world.add_body(BOX, position=(0.0, -3.0))
    begun, ended = [], []

    def listen():
        for heard, rows in ((begun, world.events.sensor_begin), (ended, world.events.sensor_end)):
            sides = zip(rows["body_a"].tolist(), rows["body_b"].tolist(), strict=True)
            heard.extend(b for a, b in sides if (a, b) == (pad.id, box.id))

    Watch(world).step(180, each=listen)
    assert not box.awake
    measured("H6", "begins", len(begun))
    Watch(world).step(60, each=listen)
    measured("H6", "events while it sleeps", len(begun) - 1 + len(ended))
    box.velocity = (20.0, -2.0)
    Watch(world).step(60, each=listen)
    measured("H6", "begins", len(begun))
    measured("H6", "ends when it leaves", len(ended))


@every_broadphase
def test_h7_questions_after_a_removal_and_of_nan(measured, broadphase):
    world = World(Effects(), BROADPHASES[broadphase]())
    ids = world.add_bodies(Circle(0.6), [(float(k), 0.0) for k in range(10)], kind="static")
    world.step()
    stale = 0
    for step in (False, True):
        gone = ids[int(step) :: 3].tolist()
        world.remove_bodies([each for each in gone if each in world])
        if step:
            world.step()
        left = set(ids.tolist()) - {each for each in ids.tolist() if each not in world}
        found = {hit.body.id for hit in world.ray_cast_all((-5.0, 0.0), (20.0, 0.0))}
        found |= {each.id for each in world.query_aabb((-5.0, -1.0), (20.0, 1.0))}
        found |= {each.id for each in world.overlap(Polygon.box(30, 1), (5.0, 0.0, 0.0))}
        stale += len(found ^ left)
        for k in range(10):
            stale += sum(each.id not in left for each in world.query_point((float(k), 0.0)))
            near = world.closest((float(k), 0.0))
            stale += near is None or near[0].id not in left
    measured("H7", "hits of what is gone", stale)
    answered, nan = 0, math.nan
    for ask in (
        lambda: world.ray_cast((nan, 0), (1, 0)),
        lambda: world.ray_cast((0, 0), (nan, 0)),
        lambda: world.ray_cast_all((0, 0), (math.inf, 0)),
        lambda: world.shape_cast(BOX, (0, nan, 0), (1, 0)),
        lambda: world.overlap(BOX, (0, 0, nan)),
        lambda: world.query_point((nan, 0)),
        lambda: world.query_aabb((0, 0), (nan, 1)),
        lambda: world.closest((0, nan)),
    ):
        try:
            ask()
            answered += 1
        except ValueError:
            pass
    measured("H7", "questions of NaN answered", answered)


@every_broadphase
def test_h8_ties_go_to_the_least_id_in_any_order(measured, broadphase):
    wrong, rng = 0, np.random.default_rng(8)
    for count in (2, 5, 20):
        for _ in range(6):
            world = World(Effects(), BROADPHASES[broadphase]())
            # All faces at x = 3: boxes above one another, discs, and the same box many times.
            order = rng.permutation(count)
            shapes = [Polygon.box(2, 20, (1.0, 0.0)), Circle(1.0, (1.0, 0.0)), Polygon.box(4, 2, (2.0, 0.0))]
            for k in order.tolist():
                world.add_body(shapes[k % 3], position=(3.0, 0.0), kind="static")
            world.step()
            least = min(world.shapes["id"])
            hit, cast = (
                world.ray_cast((0.0, 0.0), (6.0, 0.0)),
                world.shape_cast(Circle(0.5), (0.0, 0.0, 0.0), (6.0, 0.0)),
            )
            all_ids = [each.shape for each in world.ray_cast_all((0.0, 0.0), (6.0, 0.0))]
            wrong += hit is None or hit.shape != least
            wrong += cast is None or cast.shape != least
            wrong += all_ids != sorted(all_ids)
            near = world.closest((2.0, 0.0))
            wrong += near is None or near[0].id != 0
    measured("H8", "answers that are not the least id", wrong)
