"""Hard cases of ground made of pieces (section E): level ground in pieces behaves as one level floor.

This holds for every shape, phase and speed.
"""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Effects, Material, PixelMask, Polygon, Segment, TileGrid, World
from tests.stability.piles import needs_speed

SMOOTH = Material(friction=0.0)
SLOP = 0.16  # [px] of a default world
OCTAGON = [(8.6591 * math.cos(math.pi * (k + 0.5) / 4), 8.6591 * math.sin(math.pi * (k + 0.5) / 4)) for k in range(8)]
REST = 8.6591 * math.cos(math.pi / 8)
SHAPES = {  # and the height of the middle over level ground [px]
    "box": (Polygon.box(16, 16), 8.0),
    "disc": (Circle(8.0), 8.0),
    "capsule": (Capsule((-6, 0), (6, 0), 6.0), 6.0),
    "octagon": (Polygon(OCTAGON), REST),
    "rounded": (Polygon(Polygon.box(12, 12).points, 2.0), 8.0),
    "mask": (PixelMask.from_array(np.ones((16, 16), bool)), 8.0),
}
SPEEDS = (30.0, 60.0, 120.0, 300.0)  # [px/s]
SETTINGS = ({}, {"substeps": 4})
GRID, SLAB = TileGrid(np.ones((2, 10), bool), 16), PixelMask.from_array(np.ones((32, 32), bool))
PLACES = tuple(-160 + 32 * k for k in range(10))


def in_pieces(kind):
    """Return a list of (position, shapes) of the static bodies that form a floor at y = 0 with a seam at x = 0."""
    return {
        "grids": [((-160, 0), (GRID,)), ((0, 0), (GRID,))],
        "chains": [((0, 0), (Chain([(x, 0), (x + 80, 0), (x + 160, 0)]),)) for x in (-160, 0)],
        "boxes": [((x + 16, 16), (Polygon.box(32, 32),)) for x in PLACES],
        "segments": [((0, 0), (Segment((x, 0), (x + 32, 0)),)) for x in PLACES],
        "masks": [((x + 16, 16), (SLAB,)) for x in PLACES],
        "boxes of one body": [((0, 0), tuple(Polygon.box(32, 32, (x + 16, 16)) for x in PLACES))],
        "small boxes": [((x + 3, 16), (Polygon.box(6, 32),)) for x in range(-60, 60, 6)],
        "first link": [((0, 0), (Chain([(-160, 0), (0, 0), (160, 0)]),))],
    }[kind]


GROUNDS = ("grids", "chains", "boxes", "segments", "masks", "boxes of one body")


def crossing(ground, name, speed, phase, way=1, friction=SMOOTH, spin=0.0, **settings):
    """Move a body over x = 0 and return (its forward speed after each step [px/s], greatest hop [px]).

    phase: shift of the start in steps. way: 1 to move right, -1 to move left.
    """
    shape, half = SHAPES[name]
    world = World(Effects.rigid_bodies().with_(sleeping=False), **settings)
    for place, pieces in ground:
        world.add_body(*pieces, position=place, kind="static", material=friction)
    start = -40.0 - phase * speed / 60.0
    body = world.add_body(
        shape, position=(way * start, -half), velocity=(way * speed, 0), material=friction, angular_velocity=way * spin
    )
    speeds, hop = [], 0.0
    for _ in range(int(90 / speed * 60)):
        world.step()
        speeds.append(way * body.velocity.x)
        hop = max(hop, -half - body.position.y)
    return np.array(speeds), hop


def hold(measured, found, speed):
    """Assert that the result `found` of `crossing` is within the limits of row E16. speed:
    speed at the start [px/s].
    """
    speeds, hop = found
    measured("E16", "relative speed lost", np.abs(1.0 - speeds / speed).max())
    measured("E16", "hop", hop)


@needs_speed
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("name", SHAPES)
def test_e16_level_ground_in_pieces_is_level(measured, ground, name):
    """Level ground in pieces does not slow a body or make it hop.

    Phases, directions and settings vary with the speed here; the nightly test runs every combination.
    """
    first = GROUNDS.index(ground) + 6 * list(SHAPES).index(name)
    for k, speed in enumerate(SPEEDS):
        phase = (first + k) * 0.618 % 1.0
        found = crossing(in_pieces(ground), name, speed, phase, (-1) ** (first // 2 + k), **SETTINGS[(first + k) % 2])
        hold(measured, found, speed)


@needs_speed
@pytest.mark.nightly
@pytest.mark.parametrize("settings", SETTINGS, ids=["auto", "4"])
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("name", SHAPES)
def test_e16_level_ground_in_pieces_is_level_at_every_phase(measured, ground, name, settings):
    for speed in SPEEDS:
        for phase in range(40):
            hold(measured, crossing(in_pieces(ground), name, speed, phase / 40, (-1) ** phase, **settings), speed)


@needs_speed
@pytest.mark.parametrize("name", ["disc", "octagon", "capsule"])
@pytest.mark.parametrize("ground", ["small boxes", "first link"])
def test_e16_pieces_smaller_than_the_body_and_links_are_level(measured, ground, name):
    for way in (1, -1):
        for phase in range(3):
            speed = 60.0 if phase else 300.0
            hold(measured, crossing(in_pieces(ground), name, speed, phase / 3, way), speed)


@needs_speed
@pytest.mark.parametrize("ground", GROUNDS)
def test_e16_a_ball_rolls_over_pieces_as_over_one_box(measured, ground):
    one = [((0, 16), (Polygon.box(320, 32),))]
    for speed in (60.0, 300.0):
        ways = [crossing(each, "disc", speed, 0.3, 1, Material(), speed / 8.0) for each in (one, in_pieces(ground))]
        measured("E16", "relative speed lost", np.abs(ways[1][0] - ways[0][0]).max() / speed)
        measured("E16", "hop", ways[1][1])


def raised(kind, step):
    """Return (position, shapes) of two pieces of ground; the right one is higher by `step` [px]."""
    slab = PixelMask.from_array(np.ones((32, 160), bool))
    return {
        "grids": [((-160, 0), (GRID,)), ((0, -step), (GRID,))],
        "boxes": [((-80, 16), (Polygon.box(160, 32),)), ((80, 16 - step), (Polygon.box(160, 32),))],
        "segments": [((0, 0), (Segment((-160, 0), (0, 0)),)), ((0, -step), (Segment((0, 0), (160, 0)),))],
        "chains": [
            ((0, 0), (Chain([(-160, 0), (-80, 0), (0, 0)]),)),
            ((0, -step), (Chain([(0, 20), (0, 0), (80, 0), (160, 0)]),)),
        ],
        "masks": [((-80, 16), (slab,)), ((80, 16 - step), (slab,))],
        "boxes of one body": [((0, 0), (Polygon.box(160, 32, (-80, 16)), Polygon.box(160, 32, (80, 16 - step))))],
    }[kind]


@needs_speed
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("name", SHAPES)
def test_e16_a_step_lower_than_the_slop_is_passed_and_a_step_of_two_slops_is_felt(measured, ground, name):
    for slops in (-0.9, 0.3, 0.6, 0.9):
        speeds, hop = crossing(raised(ground, slops * SLOP), name, 300.0, 0.4)
        measured("E16", "relative speed lost at a step of 0.9 slops", np.abs(1.0 - speeds / 300.0).max())
        measured("E16", "hop over a step of 0.9 slops", hop - max(0.0, slops * SLOP))
    for slops in (2.05, 3.0):
        found = [crossing(raised(ground, slops * SLOP), name, 300.0, phase / 3) for phase in range(3)]
        lost = max(np.abs(1.0 - speeds / 300.0).max() for speeds, _ in found)
        measured("E16", "relative speed lost at a step of two slops", lost)


@pytest.mark.parametrize("velocity", [(-180, -180), (-180, -90), (-90, -180), (-5, -5), (-0.5, -0.5), (-9, -3)])
@pytest.mark.parametrize("kind", ["box", "grid", "mask"])
@pytest.mark.parametrize("name", ["box", "mask"])
def test_e16_boxes_whose_corners_touch_pass_each_other(measured, kind, name, velocity):
    world = World(gravity=(0, 0))
    shape = {"box": Polygon.box(32, 32, (16, 16)), "grid": TileGrid(np.ones((2, 2), bool), 16), "mask": SLAB}[kind]
    world.add_body(shape, position=(32, 16) if kind == "mask" else (16, 0), kind="static")
    body = world.add_body(SHAPES[name][0], position=(8, 40), velocity=velocity)
    for _ in range(20 if JIT else 3):
        world.step()
    measured("E16", "change of the velocity at aligned corners", math.dist(body.velocity, velocity))
    measured("E16", "spin at aligned corners", abs(body.angular_velocity))


@pytest.mark.parametrize("gap", [1.0, 4.0])
def test_both_edges_of_a_gap_are_felt(gap):
    """A frictionless disc in a gap between two boxes rests on both corners and does not move."""
    world = World(Effects.rigid_bodies().with_(sleeping=False))
    for x in (-100.0 - 0.5 * gap, 0.5 * gap):
        world.add_body(Polygon.box(100, 32, (50, 16)), position=(x, 0), kind="static", material=SMOOTH)
    disc = world.add_body(Circle(8.0), position=(0.1, -8.0), material=SMOOTH)
    for _ in range(240 if JIT else 20):
        world.step()
        assert abs(disc.position.x) < 0.2
    assert (np.abs(world.contacts["normal_x"]) > 0.05).sum() == 2
