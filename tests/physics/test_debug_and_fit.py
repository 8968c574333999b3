"""Debug overlays, the replacement shapes of masks, and the warm-up, compared with simple loops and geometry."""

import math

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    Bounds,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    SweepAndPrune,
    TileGrid,
    World,
    debug,
    fit,
    warmup,
)
from physics.warmup import _runs


def ragged(seed, shape=(19, 27)):
    rng = np.random.default_rng(seed)
    solid = rng.random(shape) < 0.3
    solid[shape[0] // 2, shape[1] // 2] = True
    return solid


def corners_of(mask):
    rows, columns = np.nonzero(mask.solid)
    return np.concatenate([np.stack([columns + i, rows + j], axis=1) for i in (0, 1) for j in (0, 1)]) - np.array(
        mask.origin
    )


@pytest.mark.parametrize("seed", range(8))
def test_fitted_circle_and_box_hold_every_pixel_and_no_smaller_circle_does(seed):
    mask = PixelMask.from_array(ragged(seed))
    corners = corners_of(mask)
    (circle,), (box,) = fit(mask, "circle"), fit(mask, "obb")
    distance = np.hypot(*(corners - circle.center).T)
    assert distance.max() <= circle.radius * (1 + 1e-9)
    # The least circle touches two opposite points or three around: no half of it is free of touching points.
    touching = np.arctan2(*((corners - circle.center)[distance > circle.radius * (1 - 1e-9)].T[::-1]))
    gaps = np.diff(np.sort(np.unique(touching)), append=np.sort(touching)[0] + math.tau)
    assert gaps.max() <= math.pi + 1e-6
    points = np.array(box.points)
    for a, b in zip(points, np.roll(points, -1, axis=0), strict=True):
        normal = np.array([b[1] - a[1], a[0] - b[0]]) / math.dist(a, b)
        assert ((corners - a) @ normal).max() <= 1e-9
    area = math.dist(points[0], points[1]) * math.dist(points[1], points[2])
    assert area <= np.prod(np.ptp(corners, axis=0)) + 1e-9


def test_tiers_of_a_mask():
    mask = PixelMask.from_array(ragged(1))
    assert fit(mask, "pixels") == (mask,) and fit(mask, "aabb") == (Bounds(mask),)
    assert fit(mask, "circle") is fit(mask, "circle"), "fitted once"
    assert fit(PixelMask.from_array(np.zeros((4, 4), bool)), "obb") == ()
    with pytest.raises(ValueError, match="tier must be one of circle, aabb, obb, capsule, hull, parts, outline"):
        fit(mask, "hexagon")


def test_mask_hits_are_the_shared_pixels():
    world = World(Effects())
    a, b = ragged(2), ragged(3)
    world.add_body(PixelMask.from_array(a, origin=(0, 0)), position=(5, 3))
    world.add_body(PixelMask.from_array(b, origin=(0, 0)), position=(9, -2))
    world.step()
    lit = {(left + x, top + y) for left, top, shared in debug.mask_hits(world) for y, x in np.argwhere(shared).tolist()}
    wanted = {(x + 5, y + 3) for y, x in np.argwhere(a).tolist()} & {(x + 9, y - 2) for y, x in np.argwhere(b).tolist()}
    assert lit == wanted and len(wanted) > 0
    for (_, left, top, solid), (x, y, shape) in zip(debug.masks(world), ((5, 3, a), (9, -2, b)), strict=True):
        assert (left, top) == (x, y) and np.array_equal(solid, shape)


@pytest.mark.parametrize("name", BROADPHASES)
def test_structures_cover_what_they_keep(name):
    rng = np.random.default_rng(4)
    world = World(Effects(), BROADPHASES[name]())
    ids = world.add_bodies(Circle(4), rng.uniform(0, 300, (40, 2)), rng.uniform(-60, 60, (40, 2)))
    for frame in range(5):
        if frame == 3:
            world.remove_bodies(ids[::7])
        world.step()
    motion, structure = debug.motion(world), debug.structure(world)
    assert structure.kind == name and len(motion) == len(world.bodies)
    middles = (motion[:, :2] + motion[:, 2:]) / 2
    if name in ("hash", "tree"):
        held = (
            ((structure.rects[:, None, :2] <= middles) & (structure.rects[:, None, 2:] >= middles))
            .all(axis=2)
            .any(axis=0)
        )
        assert held.all() and len(structure.rects) == len(structure.depth)
    if name == "sweep":
        for axis in (0, 1):
            ends = structure.intervals[structure.intervals[:, 0] == axis][:, 1:3]
            assert sorted(map(tuple, ends)) == sorted(map(tuple, motion[:, [axis, axis + 2]]))
    boxes = debug.bounds(world)
    assert (motion[:, :2] <= boxes[:, :2] + 1e-9).all() and (motion[:, 2:] >= boxes[:, 2:] - 1e-9).all()


def test_sweeping_both_axes_shows_both_after_a_removal():
    world = World(Effects(), SweepAndPrune(axes="both"))
    bodies = [world.add_body(Circle(3), position=(7 * k, 0)) for k in range(6)]
    world.step()
    world.remove_body(bodies[2])
    assert len(debug.structure(world).intervals) == 2 * 5


def test_pairs_say_which_of_them_touch():
    world = World(Effects())
    for x in (0, 8, 100):
        world.add_body(Circle(5), position=(x, 0))
    world.add_body(Circle(5), position=(107.4, 7.4))
    world.step()
    lines = debug.pairs(world)
    assert len(lines) == len(world.candidates) == 2
    assert lines[:, 4].tolist() == [1.0, 0.0], "the second pair's boxes meet, the discs do not"


def test_outlines_of_every_kind_of_shape():
    world = World(Effects())
    for shape in (Circle(2), Polygon.box(4, 2), Bounds(Circle(3)), PixelMask.from_array(ragged(5))):
        world.add_body(shape, position=(10, 20))
    world.add_body(TileGrid(np.ones((2, 2), bool), 8), kind="static")
    assert [each[0] for each in debug.outlines(world)] == ["circle", "polygon", "polygon", "mask", "tiles"]
    assert debug.outlines(world)[2][1].tolist() == [[7, 17], [13, 17], [13, 23], [7, 23]]


@pytest.mark.parametrize("effects", [Effects(), Effects(response=True, gravity=True, sensors=True)])
def test_warm_up_reports_each_piece_and_the_end(effects):
    seen = []
    warmup(effects, "hash", progress=lambda done, total, name: seen.append((done, total, name)))
    assert [done for done, _, _ in seen] == list(range(len(seen))) and seen[-1] == (
        len(seen) - 1,
        len(seen) - 1,
        "ready",
    )
    with pytest.raises(KeyError):
        warmup(effects, "quadtree")


def test_warm_up_without_effects_is_that_of_a_world_without_arguments():
    names = [[name for name, _ in _runs(effects, "hash", None, None)] for effects in (None, World().effects)]
    assert names[0] == names[1] and "rest" in names[0]
