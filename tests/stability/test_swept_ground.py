"""Random sweeps at ground that is one-sided or partly covered: no centre of mass enters the enclosed area.

The reference is the closed area of the same outline (shapely): the union of 3 x 3 tiles, or the polygon inside a chain.
Every solver, one and four substeps, and every mode of continuous collision are tested.
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Effects, Material, Polygon, World, time_of_impact

shapely = pytest.importorskip("shapely")
from tests.oracles.enclosed import (  # noqa: E402
    EMPTY,
    FALLS,
    FULL,
    HALF_FALLS,
    HALF_RISES,
    RISES,
    area_of,
    grid_of,
    island,
    loop_of,
    pieces_of,
    room,
)

SIZE = 24.0  # [px] of a tile
STACKING = ("soft_step", "sequential_impulse")
CASES = [*itertools.product(("tiles", "island", "room"), (*STACKING, "projection", "blocking"), (1, 4))]
ROUNDS = 60 if JIT else 3  # of each case: 1,440 in all


def any_mover(rng):
    """Return (random convex shape, greatest distance of its points from the origin [px])."""
    r, other = rng.uniform(2.0, 8.0), rng.uniform(2.0, 8.0)
    turns = np.linspace(0.0, math.tau, 5, endpoint=False)
    made = (
        (Circle(r), r),
        (Polygon.box(2.0 * r, 2.0 * other), math.hypot(r, other)),
        (Capsule((-r, 0), (r, 0), other / 2.0), r + other / 2.0),
        (Polygon([(r * math.cos(a), r * math.sin(a)) for a in turns]), r),
        (Polygon([(-r, other), (0, -other), (r, other)], 1.0), math.hypot(r, other) + 1.0),
    )
    return made[rng.integers(len(made))]


def any_ground(rng, kind):
    """Return (shape, enclosed area, whether bodies start inside this area, centre of the target region)."""
    if kind == "tiles":
        cells = rng.choice([EMPTY, EMPTY, FULL, FULL, RISES, FALLS, HALF_RISES, HALF_FALLS], (3, 3))
        cells[1, 1] = cells[1, 1] or FULL
        return grid_of(cells, SIZE), area_of(pieces_of(cells, SIZE)), False, (1.5 * SIZE, 1.5 * SIZE)
    points = loop_of(rng, int(rng.integers(3, 7)), 60.0, bool(rng.integers(2)))
    shape = room(points) if kind == "room" else island(points)
    return shape, shapely.Polygon(points), kind == "room", (0.0, 0.0)


def place_for(rng, reach, area, free, middle):
    """Return a random position at which the mover does not touch the ground, or None after 200 attempts.

    reach: size of the mover [px]. free: True for a position inside the area.
    """
    for _ in range(200):
        place = np.array(middle) + rng.uniform(-90.0, 90.0, 2)
        point = shapely.Point(place)
        if (area.contains(point) if free else not area.intersects(point)) and point.distance(area.boundary) > reach:
            return place
    return None


def shoot(rng, kind, solver, substeps):
    """Simulate one random shot. Return how far [px] its centre of mass got beyond the outline; None if there was no
    start position.
    """
    stacking = solver in STACKING
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True)
    world = World(effects.with_(stacking=stacking), solver=solver, substeps=substeps)
    ground, area, free, middle = any_ground(rng, kind)
    world.add_body(ground, kind="static")
    shape, reach = any_mover(rng)
    place = place_for(rng, reach, area, free, middle)
    if place is None:
        return None
    way = np.array(middle) + rng.uniform(-30.0, 30.0, 2) - place
    speed = 10.0 ** rng.uniform(1.5, 4.0)
    body = world.add_body(
        shape,
        position=tuple(place),
        angle=float(rng.uniform(0.0, math.tau)),
        velocity=tuple(way / np.hypot(*way) * speed),
        angular_velocity=float(rng.choice([0.0, 5.0, 60.0]) * rng.uniform(-1.0, 1.0)),
        material=Material(friction=float(rng.choice([0.0, 0.6])), restitution=float(rng.choice([0.0, 0.5, 1.0]))),
        continuous=str(rng.choice(["auto", "toi", "swept"])),
    )
    deepest = 0.0
    for _ in range(40):
        world.step()
        point = shapely.Point(body.center)
        if area.contains(point) != free and point.distance(area.boundary) > 0.0:
            deepest = max(deepest, point.distance(area.boundary))
    return deepest


@pytest.mark.parametrize("kind, solver, substeps", CASES)
def test_no_centre_gets_beyond_the_outline(kind, solver, substeps):
    rng, shot = np.random.default_rng(CASES.index((kind, solver, substeps))), 0
    for number in range(ROUNDS):
        deepest = shoot(rng, kind, solver, substeps)
        shot += deepest is not None
        assert not deepest or deepest < 1e-9, (number, deepest)
    assert shot > 0.5 * ROUNDS


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(100, 110))
@pytest.mark.parametrize("kind, solver, substeps", CASES)
def test_no_centre_gets_beyond_the_outline_of_many_more(kind, solver, substeps, seed):
    rng = np.random.default_rng([seed, CASES.index((kind, solver, substeps))])
    assert max(shoot(rng, kind, solver, substeps) or 0.0 for _ in range(ROUNDS)) < 1e-9


def all_grids(kinds):
    return (np.reshape(cells, (3, 3)) for cells in itertools.product(kinds, repeat=9) if any(cells))


@pytest.mark.parametrize("part", range(8))
def test_time_of_impact_with_tiles_is_that_with_the_union_of_their_solid(part):
    """The time of impact with a tile grid equals the earliest one with its solid pieces.

    The shots are straight and start far away. All 3 x 3 grids of empty and full tiles are tested, and as many with
    slopes.
    """
    rng = np.random.default_rng(part)
    flat = itertools.islice(all_grids((EMPTY, FULL)), part, None, 8 if JIT else 128)
    mixed = (rng.integers(0, 6, (3, 3)) for _ in range(64 if JIT else 4))
    for cells in itertools.chain(flat, mixed):
        pieces = pieces_of(cells, SIZE)
        shape, _ = any_mover(rng)
        aim, angle = rng.uniform(0.0, 3.0 * SIZE, 2), float(rng.uniform(0.0, math.tau))
        turn, where = float(rng.uniform(-2.0, 2.0)), rng.uniform(0.0, math.tau)
        way = 120.0 * np.array((math.cos(where), math.sin(where)))
        start, end = (*(aim - way), angle), (*(aim + way), angle + turn)
        found = time_of_impact(shape, start, end, grid_of(cells, SIZE), (0, 0, 0), (0, 0, 0))
        wanted = [time_of_impact(shape, start, end, Polygon(each), (0, 0, 0), (0, 0, 0)) for each in pieces]
        first = min((each.fraction for each in wanted if each.hit), default=1.0)
        assert found.hit == any(each.hit for each in wanted), (cells, start, end)
        assert found.fraction == pytest.approx(first, abs=1e-7), (cells, start, end)


@pytest.mark.parametrize("links", range(3, 7))
@pytest.mark.parametrize("concave", [False, True])
def test_time_of_impact_with_a_loop_is_that_with_what_it_encloses(links, concave):
    rng = np.random.default_rng([links, concave])
    for _ in range(60 if JIT else 5):
        points = loop_of(rng, links, 60.0, concave)
        triangles = shapely.constrained_delaunay_triangles(shapely.Polygon(points)).geoms
        pieces = [Polygon(list(each.exterior.coords)[:-1]) for each in triangles]
        shape, _ = any_mover(rng)
        where, angle = rng.uniform(0.0, math.tau), float(rng.uniform(0.0, math.tau))
        way = 150.0 * np.array((math.cos(where), math.sin(where)))
        aim, turn = rng.uniform(-30.0, 30.0, 2), float(rng.uniform(-2.0, 2.0))
        start, end = (*(aim - way), angle), (*(aim + way), angle + turn)
        found = time_of_impact(shape, start, end, island(points), (0, 0, 0), (0, 0, 0))
        wanted = [time_of_impact(shape, start, end, each, (0, 0, 0), (0, 0, 0)) for each in pieces]
        first = min((each.fraction for each in wanted if each.hit), default=1.0)
        assert found.hit == any(each.hit for each in wanted), (points, start, end)
        assert found.fraction == pytest.approx(first, abs=1e-7), (points, start, end)
