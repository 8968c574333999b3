"""debug.visited returns as many boxes as the query counted, including those that contain its results."""

import numpy as np
import pytest

from physics import BROADPHASES, Circle, Effects, Filter, Polygon, World, debug

COUNTED = {"tree": "nodes_visited", "sweep": "pairs_tested", "brute": "pairs_tested"}
QUESTIONS = {
    "ray": lambda world: world.ray_cast((-40.0, 130.0), (470.0, 90.0)),
    "long ray": lambda world: world.ray_cast_all((-40.0, -40.0), (900.0, 700.0)),
    "cast": lambda world: world.shape_cast(Circle(6.0), (-40.0, 60.0, 0.0), (500.0, 40.0)),
    "overlap": lambda world: world.overlap(Polygon.box(60.0, 40.0), (200.0, 150.0, 0.3)),
    "closest": lambda world: world.closest((-300.0, 150.0)),
    "point": lambda world: world.query_point((200.0, 150.0)),
}


def crowd(name, large=False):
    """Return a world of two hundred discs, half of them moving, after some steps.

    large: True adds a disc that covers all others.
    """
    rng = np.random.default_rng(4)
    world = World(Effects(), BROADPHASES[name]())
    world.add_bodies(Circle(5.0), rng.uniform(0.0, 400.0, (100, 2)), kind="static")
    world.add_bodies(Circle(7.0), rng.uniform(0.0, 400.0, (100, 2)), rng.uniform(-60.0, 60.0, (100, 2)))
    if large:
        world.add_body(Circle(900.0), kind="static")
    for _ in range(5):
        world.step()
    return world


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("name", BROADPHASES)
def test_what_was_visited_is_what_was_counted(name, question):
    world = crowd(name)
    QUESTIONS[question](world)
    found, counters = debug.visited(world), world.queries.counters
    assert found.kind == name and len(found.asked) >= 1 and len(found.met) == len(found.rects)
    rects, loose = found.rects, world.queries.loose_count * len(found.asked)
    if name == "hash":  # of a level with few bodies these are looked at, not the cells
        levels = np.log2((rects[:, 2] - rects[:, 0]) / world.broadphase.base)
        cells = np.abs(levels - np.round(levels)) < 1e-9
        assert np.count_nonzero(cells) == counters["nodes_visited"]
        assert len(rects) - np.count_nonzero(cells) <= counters["pairs_tested"] - loose
    else:
        assert len(rects) == counters[COUNTED[name]] - (loose if name != "tree" else 0) > 0
    if name == "brute":
        assert len(found.rects) == 200 * len(found.asked)


@pytest.mark.parametrize("name", BROADPHASES)
def test_what_is_met_holds_every_answer(name):
    world = crowd(name)
    hits = world.ray_cast_all((-40.0, 130.0), (470.0, 90.0))
    found = debug.visited(world)
    met = found.rects[found.met]
    assert len(hits) > 3
    for hit in hits:
        x, y = hit.point
        holds = (met[:, 0] <= x) & (met[:, 2] >= x) & (met[:, 1] <= y) & (met[:, 3] >= y)
        assert holds.any(), (name, hit)
    if name == "tree":
        assert len(found.rects) < 200 and not found.met.all(), "whole branches were left out"


def test_a_hash_with_one_giant_looks_at_it_alone_in_its_level():
    world = crowd("hash", large=True)
    world.query_point((200.0, 150.0))
    rects = debug.visited(world).rects
    widths = rects[:, 2] - rects[:, 0]
    assert widths.max() >= 1800.0 and widths.min() < 100.0


def test_nothing_was_visited_before_the_first_query_nor_in_an_empty_world():
    world = World(Effects(), BROADPHASES["tree"]())
    assert len(debug.visited(world).rects) == len(debug.visited(world).asked) == 0
    world.ray_cast((0, 0), (9, 9))
    assert len(debug.visited(world).rects) == 0
    world.add_body(Circle(3.0))
    world.overlap(Circle(1.0), (0.0, 0.0), Filter.ALL)  # never stepped: the structure is empty
    assert len(debug.visited(world).asked) == 1 and len(debug.visited(world).rects) == 0
