"""Hard cases of stacks, mass ratios, arches and cards (section F): they stand, sink by less than a slop and come to
rest.
"""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Material, Polygon
from tests.stability.invariants import Watch, deepest, movers, rms_speed
from tests.stability.piles import (
    SLOP,
    SOLVERS,
    column,
    floor,
    metres,
    needs_speed,
    pile_effects,
    pyramid,
    pyramid_and_load,
    tops,
)
from tests.stability.study.structures import CARD_FRICTION, card_house

G = 10.0


def stiffness(substeps):
    """Return the stiffness of a soft contact divided by the mass of the lighter body [1/s²].

    The contact frequency is 60 Hz, or an eighth of the substeps per second if that is less.
    """
    return (math.tau * min(60.0, 60.0 * substeps / 8.0)) ** 2


@pytest.mark.parametrize("solver", SOLVERS)
def test_f1_box_that_falls_on_the_floor_lies_flat(measured, solver):
    world = metres(solver)
    floor(world)
    box = world.add_body(Polygon.box(2, 2), position=(0.0, -4.0))
    Watch(world, passive=True).step(90)
    measured("F1", "way aside", abs(box.position[0]))
    measured("F1", "error of height", abs(box.position[1] + 1.0))
    measured("F1", "turn", abs(box.angle))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [1, 2, 4, 8])
@pytest.mark.parametrize("shape", [Polygon.box(1, 1), Circle(1 / math.sqrt(math.pi))], ids=["box", "ball"])
def test_f2_impulses_of_a_resting_body_carry_its_weight(measured, solver, substeps, shape):
    """The normal impulses of a resting body add up to m g dt for any number of substeps."""
    world = metres(solver, substeps=substeps)
    floor(world)
    world.add_body(shape, position=(0.0, -0.6))
    Watch(world, passive=True).step(120)
    carried = world.contacts["normal_impulse"].sum()
    measured("F2", "relative error of their impulses", abs(carried / (G * world.dt) - 1.0))


@pytest.mark.parametrize("solver", SOLVERS)
def test_f3_boxes_exactly_above_one_another_stay_upright(solver):
    """Boxes stacked exactly above one another stay upright, because both points of a face get equal impulses.

    If the points were solved one after the other, the boxes would turn by 0.0014 rad in a second.
    """
    world = metres(solver)
    floor(world)
    column(world, 10)
    for _ in range(300 if JIT else 30):
        world.step()
        assert np.abs(movers(world)["angle"]).max() < 1e-9 and np.abs(movers(world)["x"]).max() < 1e-9


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_f3_column_of_fifteen_stands_and_falls_asleep(measured, solver):
    world = metres(solver, effects=pile_effects(sleeping=True))
    floor(world, friction=0.3)
    boxes = column(world, 15, gap=0.1, shift=0.01, friction=0.3)
    top = boxes[-1]
    watch = Watch(world, passive=True).step(600)
    measured("F3", "way of the top aside", abs(top.position[0] - 0.01 * (1 if len(boxes) % 2 == 0 else -1)))
    measured("F3", "error of height, 15", abs(-top.position[1] - 14.5))
    measured("F3", "boxes of 15 awake after 10 s", sum(box.awake for box in boxes))
    assert deepest(world) <= 2 * SLOP
    assert watch.fastest < 10.0


@needs_speed
def test_f3_without_friction_in_the_joints_the_shifted_column_slides_apart():
    """Without friction a shifted column slides apart after a small push."""
    world = metres(effects=pile_effects(friction=False))
    floor(world)
    boxes = column(world, 15, gap=0.1, shift=0.01)
    boxes[7].apply_impulse((0.3, 0.0))
    Watch(world).step(600)
    assert abs(boxes[7].position[0]) > 0.5


@needs_speed
def test_f3_column_of_eighty_stands(measured):
    """A column of eighty boxes stands for 10 s if the substeps follow the load.

    With eight substeps the contacts act as soft springs, and the top sinks by 0.56 m.
    """
    world = metres(substeps="auto")
    floor(world)
    boxes = column(world, 80, friction=0.6)
    Watch(world, passive=True, capped=True).step(600)
    measured("F3", "way of the top aside", abs(boxes[-1].position[0]))
    measured("F3", "error of height, 80, substeps by load", abs(79.5 + boxes[-1].position[1]))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_f4_pyramid_of_twenty_rows(measured, solver):
    world = metres(solver)
    floor(world)
    rows = pyramid(world, 20)
    Watch(world, passive=True).step(180)
    measured("F4", "overlap", deepest(world))
    measured("F4", "error of the top's height, per row", abs(tops(world, rows[-1])[0] - 19.5) / 20.0)
    assert rms_speed(world) < 0.05, "slow enough to fall asleep"


@needs_speed
def test_f4_tiny_pyramid_keeps_its_boxes(measured):
    """A pyramid of 5 cm boxes keeps all its boxes, although the contact margin is nearly half a box."""
    world = metres()
    floor(world)
    rows = pyramid(world, 12, size=0.05)
    before = movers(world)[["x", "y"]].copy()
    Watch(world, passive=True).step(180)
    after = movers(world)
    moved = np.hypot(after["x"] - before["x"], after["y"] - before["y"])
    measured("F4", "tiny boxes thrown out", (moved > 0.05).sum())
    measured("F4", "error of the top's height, per row", abs(tops(world, rows[-1])[0] - 11.5 * 0.05) / 12.0)


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("base, size, steps", [(100, 1.0, 600), (30, 0.05, 600)])
def test_f4_large_and_tiny_pyramids(measured, base, size, steps):
    """Pyramids of up to 5,050 boxes, large or tiny, stand if the substeps follow the load."""
    world = metres(substeps="auto")
    floor(world, width=1000.0)
    rows = pyramid(world, base, size=size)
    before = movers(world)[["x", "y"]].copy()
    Watch(world, passive=True, capped=True).step(steps)
    after = movers(world)
    measured("F4", "overlap", deepest(world))
    error = abs(tops(world, rows[-1])[0] - (base - 0.5) * size)
    measured("F4", "error of the top's height, per row", error / base)
    assert np.hypot(after["x"] - before["x"], after["y"] - before["y"]).max() < 2 * size and rms_speed(world) < 0.05


@needs_speed
@pytest.mark.parametrize("substeps", [4, "auto"])
@pytest.mark.parametrize("density", [100, 200, 300])
def test_f5_heavy_box_dropped_on_a_pyramid(measured, density, substeps):
    """A pyramid of ten rows stands for 10 s after a box 100 to 300 times as heavy drops 2 m onto it.

    A soft contact under a load F sinks by F / (m w²), where m is the mass of the lighter body. With four substeps (30
    Hz) a load of 300 m g gives 0.08 m.
    """
    world = metres(substeps=substeps)
    rows, heavy = pyramid_and_load(world, density, 2.0)
    watch = Watch(world, passive=True, capped=True).step(600)
    stands = -heavy.position[1] > 9.0 and tops(world, rows[8]).min() > 8.0 and watch.fastest < 30.0
    if substeps == 4:
        measured("F5", "pyramids that fell, 4 substeps", not stands)
        assert deepest(world) <= density * G / stiffness(4) + 2 * SLOP
    else:
        assert stands
        measured("F5", "overlap at the end, substeps by load", deepest(world))


@needs_speed
@pytest.mark.parametrize("props, substeps", [("boxes", 8), ("triangles", 8), ("triangles", "auto")])
def test_f6_big_box_falls_on_two_small_props(measured, props, substeps):
    """Two small props stay under a big box that falls on them.

    A box of 20 x 20 falls 15 m on two unit boxes (400 : 1), or 2.5 m on two triangles of area 0.5 (800 : 1). It sinks
    by no more than twice the deflection of soft contacts that carry half its weight each.
    """
    world = metres(substeps=substeps)
    floor(world, width=400.0)
    if props == "boxes":
        small = [world.add_body(Polygon.box(1, 1), position=(x, -0.5)) for x in (-9.0, 9.0)]
        drop = 15.0
    else:
        small = [
            world.add_body(Polygon([(-0.5, 0.0), (0.5, 0.0), (0.0, -1.0)]), position=(x, 0.0)) for x in (-9.0, 9.0)
        ]
        drop = 2.5
    big = world.add_body(Polygon.box(20, 20), position=(0.0, -11.0 - drop))
    Watch(world, passive=True, capped=substeps == "auto").step(600)
    sunk = 200.0 * G / ((1.0 if props == "boxes" else 0.5) * stiffness(8))
    assert -big.position[1] > 11.0 - 2 * sunk
    for prop, x in zip(small, (-9.0, 9.0), strict=True):
        measured("F6", "way of a prop aside", abs(prop.position[0] - x))
    measured("F6", "overlap at the end", deepest(world))


@needs_speed
def test_f7_inverted_pyramid_does_not_explode(measured):
    """An inverted pyramid of six boxes, each twice as wide as the one below (mass ratio 1024 : 1), never accelerates by
    itself.

    It may fall. With the four substeps used here it overlaps by 0.93, far more than the springs should give; this is
    not checked.
    """
    world = metres()
    floor(world, width=400.0)
    y, size = 0.0, 1.0
    for _ in range(6):
        world.add_body(Polygon.box(size, size), position=(0.0, y - size / 2))
        y, size = y - size, 2 * size
    watch = Watch(world, passive=True, without=("U6",)).step(300)
    measured("F7", "speed", watch.fastest)


def arch(world, blocks, inner, thickness, friction):
    """Add a half ring of wedges that stands on the floor, and return the keystone."""
    outer, key = inner + thickness, None
    for k in range(blocks):
        ends = [math.pi * k / blocks, math.pi * (k + 1) / blocks]
        points = [
            (-r * math.cos(a), -r * math.sin(a))
            for r, a in ((inner, ends[0]), (outer, ends[0]), (outer, ends[1]), (inner, ends[1]))
        ]
        x, y = np.mean(points, axis=0)
        body = world.add_body(
            Polygon([(px - x, py - y) for px, py in points]), position=(x, y), material=Material(friction=friction)
        )
        key = body if k == blocks // 2 else key
    return key


@needs_speed
def test_f16_arch_stands_when_thick_and_falls_when_thin(measured):
    """A half-ring arch stands if it is thicker than 10.7 % of its radius (Milankovitch 1907) and falls if it is
    thinner.

    The friction is high enough that no joint slides.
    """
    sinks = {}
    for share in (0.25, 0.06):
        world = metres(substeps=8)
        floor(world, friction=0.9)
        inner = 4.0 * (1 - share / 2)
        key = arch(world, 17, inner, 4.0 * share, 0.9)
        start = key.position[1]
        if share == 0.25:
            for k in range(4):
                world.add_body(
                    Polygon.box(1.2, 0.2),
                    position=(0.0, -(inner + 1.0) - 0.1 - 0.2 * k + 0.02),
                    material=Material(friction=0.6, density=0.3),
                )
        watch = Watch(world, passive=share == 0.25).step(300)
        sinks[share] = key.position[1] - start
        watch.step(300)
        if share == 0.25:
            measured("F16", "overlap", deepest(world))
            assert rms_speed(world) < 1e-6
            assert key.position[1] - start == pytest.approx(sinks[share], abs=1e-4), "it settles and then stays"
    measured("F16", "keystone's drop", sinks[0.25])
    measured("F16", "drop of the thin one", sinks[0.06])


@needs_speed
@pytest.mark.parametrize("half_thickness, half_height", [(0.02, 1.0), (0.001, 0.2)])
def test_f17_house_of_cards_stands(measured, half_thickness, half_height):
    """A house of cards stands, with cards of 2 m by 4 cm and of 40 cm by 2 mm, the latter thinner than the slop."""
    levels, scale = 5, half_height
    world = metres(substeps="auto", pixels_per_meter=min(1.0, half_thickness / 0.005))
    floor(world, friction=CARD_FRICTION)
    for solid in card_house(levels, half_thickness / scale, 1.0).solids:
        if solid.kind != "dynamic":
            continue
        world.add_body(
            Polygon([(scale * x, scale * y) for x, y in solid.parts[0].points]),
            position=(solid.x * scale, solid.y * scale),
            angle=solid.angle,
            material=Material(friction=CARD_FRICTION),
        )
    start = movers(world)[["x", "y"]].copy()
    Watch(world, capped=True).step(600)
    now = movers(world)
    measured("F17", "height kept", now["y"].min() / start["y"].min())
    measured("F17", "lean", np.abs(now["x"] - start["x"]).max() / scale)


@pytest.mark.parametrize("solver", SOLVERS)
def test_f25_discs_exactly_above_one_another_stay_so(measured, solver):
    """Discs exactly above one another get no sideways motion by rounding: all x coordinates are 0."""
    world = metres(solver)
    floor(world)
    for k in range(10):
        world.add_body(Circle(0.5), position=(0.0, -0.5 - 1.05 * k), material=Material(friction=0.0))
    Watch(world, passive=True).step(600 if JIT else 60)
    measured("F25", "way and speed aside", np.abs([movers(world)["x"], movers(world)["vx"]]).max())
    measured("F25", "error of the height", abs(-movers(world)["y"][-1] - 9.5))
