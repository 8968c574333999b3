"""Bounds collide by the boxes in the table of shapes, with the same results as boxes given as polygons."""

import numpy as np
import pytest

from physics import Bounds, Capsule, Chain, Circle, Effects, PixelMask, Polygon, TileGrid, World, collide

SHAPES = (
    Circle(7.0, center=(3.0, 1.0)),
    Capsule((-5, 2), (6, -3), 2.5),
    Polygon([(-6, -5), (7, -4), (0, 6)], radius=1.5),
    PixelMask.from_array([[1, 0, 1, 1], [0, 1, 1, 0], [1, 1, 0, 0]]),
)


def box_of(shape, pose):
    """Return (polygon, pose) of the AABB of a shape at a pose, as it is in the table of shapes of a world."""
    world = World(Effects())
    world.add_body(Bounds(shape), position=pose[:2], angle=pose[2])
    world.step()
    left, top, right, bottom = (float(world.shapes[name][0]) for name in ("min_x", "min_y", "max_x", "max_y"))
    return Polygon.box(right - left, bottom - top), (0.5 * (left + right), 0.5 * (top + bottom), 0.0)


def same(ours, theirs):
    assert len(ours) == len(theirs)
    if len(ours):
        assert np.allclose(ours.normal, theirs.normal, atol=1e-9)
        order, other = np.lexsort(ours.points.T.round(6)), np.lexsort(theirs.points.T.round(6))
        assert np.allclose(ours.points[order], theirs.points[other], atol=1e-9)
        assert np.allclose(ours.separations[order], theirs.separations[other], atol=1e-9)


@pytest.mark.parametrize("wrapped", range(len(SHAPES)))
def test_two_bounds_answer_as_two_boxes(wrapped):
    rng = np.random.default_rng(wrapped)
    seen = set()
    for _ in range(150):
        one, two = SHAPES[wrapped], SHAPES[int(rng.integers(len(SHAPES)))]
        a, b = ((*rng.uniform(-14, 14, 2), rng.uniform(0, 6)) for _ in range(2))
        (box_a, at_a), (box_b, at_b) = box_of(one, a), box_of(two, b)
        for margin in (0.0, 3.0):
            ours = collide(Bounds(one), a, Bounds(two), b, margin)
            same(ours, collide(box_a, at_a, box_b, at_b, margin))
            seen.add(len(ours))
    assert seen >= {0, 2}


@pytest.mark.parametrize("wrapped", range(len(SHAPES)))
@pytest.mark.parametrize(
    "other",
    [
        Circle(5.0),
        Polygon([(-6, -5), (7, -4), (0, 6)]),
        Capsule((-5, 0), (5, 0), 3.0),
        TileGrid([[1, 0, 1], [1, 1, 1]], 8.0),
        Chain([(-20, 3), (0, 6), (20, 3)]),
    ],
)
def test_bounds_answer_as_a_box_to_anything(wrapped, other):
    rng = np.random.default_rng(wrapped)
    for _ in range(25):
        a, b = ((*rng.uniform(-10, 10, 2), rng.uniform(0, 6)) for _ in range(2))
        b = (*b[:2], 0.0) if isinstance(other, TileGrid) else b
        box, at = box_of(SHAPES[wrapped], a)
        same(collide(Bounds(SHAPES[wrapped]), a, other, b, 1.0), collide(box, at, other, b, 1.0))


@pytest.mark.parametrize("touching", [0.0, 5.0])
def test_they_are_closed(touching):
    """Boxes are closed: two that touch along a side or at a corner have a contact with separation 0."""
    box = Bounds(Polygon.box(10, 10))
    for x, y in ((10.0, touching), (-10.0, touching), (touching, 10.0), (touching, -10.0), (10.0, 10.0)):
        found = collide(box, (0, 0, 0), box, (x, y, 0))
        assert len(found) and found.separations[0] == 0.0
        assert not len(collide(box, (0, 0, 0), box, (np.nextafter(x, 99 * x), np.nextafter(y, 99 * y), 0)))


@pytest.mark.parametrize("solver", ["blocking", "projection", "sequential_impulse", "soft_step"])
@pytest.mark.parametrize("sensors", [False, True])
def test_the_boxes_in_the_table_are_those_of_the_final_poses(solver, sensors):
    """The boxes in the table are those of the final poses, for all kinds of motion.

    They include bodies that fall asleep, platforms of characters, bodies stopped by a sweep, and static bodies.
    """
    stacking = solver in ("sequential_impulse", "soft_step")
    effects = Effects.rigid_bodies().with_(stacking=stacking, sleeping=stacking, sensors=sensors)
    world = World(effects, solver=solver)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    world.add_body(Polygon.box(40, 6), position=(-80, -40), kind="kinematic", velocity=(30, 5), angular_velocity=1.0)
    rng = np.random.default_rng(1)
    for k in range(12):
        shape = (Circle(6), Polygon.box(12, 9), Bounds(Circle(5)), SHAPES[3])[k % 4]
        world.add_body(shape, position=(rng.uniform(-40, 40), -20 - 14 * k), velocity=(rng.uniform(-90, 90), 0))
    world.add_body(Circle(3), position=(-150, -6), velocity=(6000, 0), continuous="toi")
    for _ in range(90):
        world.step()
        told = [world.shapes[name].copy() for name in ("min_x", "min_y", "max_x", "max_y", "left", "top")]
        world.queries.begin(world)  # writes them anew
        world.query_aabb((-1e4, -1e4), (1e4, 1e4))
        again = World(effects, solver=solver)
        for row in world.bodies:
            body = world.body(int(row["id"]))
            again.add_body(*body.shapes, position=body.position, angle=body.angle, kind="kinematic")
        again.queries.begin(again)
        for name, values in zip(("min_x", "min_y", "max_x", "max_y", "left", "top"), told, strict=True):
            assert (again.shapes[name] == values).all(), name
