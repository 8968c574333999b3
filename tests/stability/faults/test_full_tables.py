"""Tables that grow beyond their initial size, and every fixed limit: an error names the limit,
or a counter counts it.
"""

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Chain,
    Character,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    PixelMask,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
    hull,
)
from physics.settings import COLORS, IMPACT_ROUNDS, MAX_CORNERS, POSITION_LIMIT
from tests.stability.invariants import Watch, deepest
from tests.stability.piles import floor, metres, needs_speed

TABLE, LIST = 16, 64  # rows that a Table, and the pair list, are made with
SIZES = (0, 1, TABLE, TABLE + 1, 2 * TABLE + 1, LIST, LIST + 1, 2 * LIST + 1)
WORLDS = {
    "soft_step": (Effects.rigid_bodies(), "soft_step"),
    "sequential_impulse": (Effects.rigid_bodies(), "sequential_impulse"),
    "projection": (Effects.rigid_bodies().with_(stacking=False, sleeping=False), "projection"),
}


def landed(kind, count, strategy, at_once):
    """Simulate boxes that land on a floor and discs that overlap a sensor. Return (world, begins, sensor begins).

    count: number of the boxes, with two contact points each, and of the discs. at_once: True adds the bodies in one
    call.
    """
    effects, solver = WORLDS[kind]
    world = World(effects, strategy(), solver=solver)
    world.add_body(Polygon.box(4000, 20), position=(0, 10), kind="static")
    world.add_body(Polygon.box(4000, 20), position=(0, -195), kind="static", sensor=True)
    where = [(12.0 * k - 800.0, -4.0) for k in range(count)]
    high = [(x, -200.0) for x, _ in where]
    if at_once:
        world.add_bodies(Polygon.box(8, 8), where)
        world.add_bodies(Circle(4), high, gravity_scale=0.0)
    else:
        for place in where:
            world.add_body(Polygon.box(8, 8), position=place)
        for place in high:
            world.add_body(Circle(4), position=place, gravity_scale=0.0)
    begun = sensed = 0
    for _ in range(10 if JIT else 3):
        world.step()
        begun, sensed = begun + len(world.events.begin), sensed + len(world.events.sensor_begin)
    return world, begun, sensed


@pytest.mark.parametrize("count", SIZES if JIT else (0, 1, TABLE + 1))
@pytest.mark.parametrize("kind", WORLDS)
def test_no_row_is_lost_where_a_table_grows(kind, count):
    """No row is lost when a table grows, whether bodies are added one by one or all at once.

    The tables hold bodies, shapes, slots, pairs, manifolds, cached contacts, constraints, contacts and events.
    """
    digests = set()
    for strategy in (
        (BruteForce, SpatialHashGrid) if not JIT else (BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree)
    ):
        for at_once in (False, True):
            world, begun, sensed = landed(kind, count, strategy, at_once)
            assert len(world) == len(world.shapes) == 2 * count + 2 and begun == sensed == count
            assert len(world.contacts) == 2 * count and (np.diff(world.bodies["id"]) == 1).all()
            assert set(world.contacts["shape_b"].tolist()) == set(range(2, count + 2))
            digests.add(world.digest())
    assert len(digests) == 1


@pytest.mark.parametrize("count", (0, 1, TABLE, TABLE + 1, 2 * TABLE + 1))
def test_no_character_is_lost_where_their_table_grows(count):
    world = World(Effects(response=True, gravity=True))
    world.add_body(Polygon.box(4000, 20), position=(0, 10), kind="static")
    heroes = [Character(world, Polygon.box(8, 16), (20 * k, -12)) for k in range(count)]
    for _ in range(6):
        moved = [hero.move(1, 1) for hero in heroes]
        world.step()
    assert all(each.grounded for each in moved) and [hero.position for hero in heroes] == [
        (20 * k + 6, -8) for k in range(count)
    ]


@pytest.mark.parametrize("corners", [MAX_CORNERS, MAX_CORNERS + 1])
def test_polygons_have_as_many_corners_as_their_row(corners):
    turns = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    points = np.column_stack([np.cos(turns), np.sin(turns)]) * 20.0
    if corners > MAX_CORNERS:
        with pytest.raises(ValueError, match=r"points must be .*3\.\.16|points .*16"):
            Polygon(points)
    else:
        assert len(Polygon(points).points) == corners
    assert len(hull(points).points) == MAX_CORNERS


@needs_speed
@pytest.mark.parametrize("count", [COLORS - 1, COLORS, COLORS + 1, 2 * COLORS + 1])
def test_a_plank_on_more_boxes_than_there_are_colors_lies(count):
    """A plank on more boxes than there are graph colours rests as it does on fewer.

    Contacts without a colour are solved first, in order.
    """
    world = metres(effects=Effects.rigid_bodies().with_(sleeping=False), gravity=(0, 10))
    floor(world, width=4.0 * count)
    world.add_bodies(Polygon.box(0.5, 0.5), [(1.0 * (k - count / 2), -0.25) for k in range(count)])
    plank = world.add_body(Polygon.box(1.0 * count + 2, 0.5), position=(-0.5, -0.75), mass=10.0)
    watch = Watch(world)
    watch.step(240)
    touched = len(set(plank.contacts["body_a"].tolist()))
    assert touched == count and abs(plank.position.y + 0.75) < 0.01 and abs(plank.angle) < 1e-3
    assert deepest(world) <= 2 * world.tolerances.slop


def test_positions_and_speeds_that_a_double_does_not_resolve():
    """Positions and speeds beyond double resolution raise an error as arguments; if they occur in a step, the body is
    quarantined.
    """
    world = World(gravity=(0, 0))
    with pytest.raises(ValueError, match="position must lie within 4.5036e"):
        world.add_body(Circle(5), position=(POSITION_LIMIT, 0))
    fast = world.add_body(Circle(5), velocity=(1e12, 0))
    world.step()
    assert world.events.quarantined["body"].tolist() == [fast.id]


@pytest.mark.parametrize("bits", [-1, 1 << 32])
def test_filters_of_more_than_32_bits_are_refused(bits):
    with pytest.raises(ValueError, match="membership must be"):
        Filter(bits)


@needs_speed
def test_impacts_that_go_on_and_on_are_counted():
    """Chains of impacts that need more rounds than IMPACT_ROUNDS are counted in `cap_hits`.

    The scene is a row of fast bullets in which each stops the next.
    """
    world = World(Effects.rigid_bodies(), gravity=(0, 0))
    count = 2 * IMPACT_ROUNDS
    for k in range(count):
        world.add_body(Circle(2), position=(5.0 * k, 0), velocity=(-60000.0, 0), bullet=True)
    world.add_body(Polygon.box(10, 400), position=(-20, 0), kind="static")
    caps = 0
    for _ in range(5):
        world.step()
        caps += world.profile.counters["cap_hits"]
        assert np.isfinite(world.bodies["x"]).all() and (world.bodies["x"][:count] > -20.0).all(), "none gets through"
    assert caps > 0, "they are told"


@pytest.mark.parametrize("solver", ["soft_step"])
def test_loads_that_need_more_substeps_than_there_are_are_counted(solver):
    world = World(Effects.rigid_bodies(), solver=solver, accuracy=1e-9)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    for k in range(3):
        world.add_body(Polygon.box(20, 20), position=(0, -10 - 20 * k))
    caps = 0
    for _ in range(30):  # an impact's first quarter of a second is not counted
        world.step()
        caps += world.profile.counters["cap_hits"]
    assert caps > 0


def large_shapes():
    """Return {name: (shape, point)} of shapes with more cells, links or words than their tables hold at first.

    point: a place above the last cell, link or word of the shape.
    """
    return {
        "cells": (TileGrid(np.ones((1, 300), bool), 4.0), (1198.0, -10.0)),
        "links": (Chain([(10.0 * k, 0.1 * (k % 2)) for k in range(301)]), (2995.0, -10.0)),
        "words": (PixelMask.from_array(np.ones((8, 1200), bool), origin=(0, 0)), (1198.0, -10.0)),
    }


@pytest.mark.parametrize("what", large_shapes())
@pytest.mark.parametrize("solver", ["soft_step", "projection"])
def test_the_last_row_of_a_large_shape_is_met(solver, what):
    shape, where = large_shapes()[what]
    world = World(solver=solver)
    world.add_body(Polygon.box(3, 3), position=(-500, 0), kind="static")
    ground = world.add_body(shape, kind="static")
    ball = world.add_body(Circle(4), position=where)
    met = False
    for _ in range(40):
        world.step()
        met = met or ground.id in {int(row["body_a"]) for row in ball.contacts}
    assert met and ball.position.y < 0.0
