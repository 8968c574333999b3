"""Characters on masks move as on a polygon or chain with the corners of the mask's outline.

Seams between the parts of the outline have no effect.
"""

import math

import numpy as np
import pytest

from physics import JIT, Character, Effects, PixelMask, Polygon, World
from physics.shapes.outline import outline_of
from tests.physics.slopes import SHAPES, ramp_mask

PLAIN = Effects(response=True)
STACKS = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
BOX, CAPSULE = SHAPES["box"][0], SHAPES["capsule"][0]


def hill(width=360, height=70):
    """Return a ground mask with a hump, a hollow and a ledge."""
    x = np.arange(width)
    top = 40.0 - 22.0 * np.sin(x / 40.0) + np.where(x > 300, 6.0, 0.0)
    return PixelMask(np.arange(height)[:, None] >= np.floor(top)[None, :], origin=(0, 0))


def put_down(world, shape, x, **options):
    hero = Character(world, shape, (x, -60.0), **options)
    for _ in range(200):
        if hero.move(0, 1).grounded:
            return hero
    raise AssertionError("it never arrived")


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("effects", [PLAIN, STACKS], ids=["plain", "stacking"])
def test_64_mask_tiles_are_walked_as_64_boxes_are(shape, effects):
    told = []
    for tile in (PixelMask(np.ones((16, 16), bool)), Polygon.box(16, 16)):
        world = World(effects)
        world.add_bodies(tile, [(16.0 * k + 8.0, 8.0) for k in range(64)], kind="static")
        hero = put_down(world, SHAPES[shape][0], 20.0)
        path = []
        for _ in range(330 if JIT else 60):
            moved = hero.move(3.0, 1.0)
            assert moved.grounded and moved.x == 3 and moved.y == 0 and moved.wall == 0
            path.append((hero.position, moved.slope))
            if hero.position[0] > 64 * 16 - 20:
                break
        told.append(path)
    assert told[0] == told[1]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("off", [0.0, 0.37])
def test_a_hill_of_pixels_is_walked_as_polygons_of_its_corners_are(shape, off):
    mask, paths = hill(), []
    parts = [part.shape for part in outline_of(mask)]
    assert len(parts) > 3
    for ground in ([mask], parts):
        world = World(PLAIN)
        world.add_body(*ground, position=(0.0, off), kind="static")
        hero = put_down(world, SHAPES[shape][0], 20.0, max_slope=1.2)
        path = []
        for step in range(320 if JIT else 120):
            moved = hero.move(1.0 if step < 240 else -1.0, 1.0)
            path.append((*hero.position, moved.slope))
            if ground == [mask]:
                assert moved.grounded and moved.wall == 0 and moved.x != 0, step
        paths.append(np.array(path))
    if shape == "box":
        return  # polygons that are shapes of their own have seams, at which it snags
    assert np.abs(paths[0][:, :2] - paths[1][:, :2]).max() <= 1.0
    assert (np.abs(paths[0][:, 2] - paths[1][:, 2]) < 1e-9).mean() > 0.8, "slopes differ at seams of polygons alone"


def floor_with_seams():
    """Return a mask with a flat floor over caves, which split its outline into many parts."""
    rng = np.random.default_rng(8)
    floor = np.ones((60, 400), bool)
    for _ in range(40):
        x, y = rng.integers(0, 380), rng.integers(6, 50)
        floor[y : y + rng.integers(2, 10), x : x + rng.integers(3, 20)] = False
    return PixelMask(floor, origin=(0, 0))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", ["static", "kinematic"])
def test_no_seam_of_a_floor_is_felt(shape, kind):
    mask = floor_with_seams()
    assert len(outline_of(mask)) > 30
    for off in (0.0, 0.4):
        world = World(PLAIN)
        world.add_body(mask, position=(0.0, off), kind=kind)
        hero = put_down(world, SHAPES[shape][0], 20.0)
        y = hero.position[1]
        for n in range(120 if JIT else 30):
            moved = hero.move(3.0, 1.0)
            assert (moved.x, moved.y, moved.grounded, moved.wall) == (3, 0, True, 0), n
            assert moved.slope == 0.0 and hero.position[1] == y
        for n in range(120 if JIT else 30):
            assert hero.move(-3.0, 0.0).x == -3, n


@pytest.mark.parametrize("shape", ["box", "circle", "capsule"])
@pytest.mark.parametrize("degrees", [12, -27, 38])
def test_stands_on_what_it_may_walk_and_slides_down_what_it_may_not(shape, degrees):
    slope = math.tan(math.radians(degrees))
    for limit, walks in ((abs(degrees) + 3, True), (abs(degrees) - 3, False)):
        world = World(PLAIN)
        world.add_body(ramp_mask(slope), kind="static")
        hero = put_down_on(world, SHAPES[shape][0], slope, math.radians(limit))
        start = hero.position
        for _ in range(30):
            moved = hero.move(0.0, 1.0)
            assert moved.grounded == walks and math.atan(moved.slope) == pytest.approx(math.radians(degrees), abs=0.03)
        gone = hero.position[0] - start[0]
        if walks:
            assert hero.position == start
        else:
            assert gone * slope < 0.0, "downhill"
            assert hero.position[1] - start[1] == pytest.approx(30 * math.sin(math.radians(degrees)) ** 2, abs=3.0)


def put_down_on(world, shape, slope, max_slope):
    hero = Character(world, shape, (-20.0, math.floor(20.0 * slope) - 60.0), max_slope=max_slope)
    for _ in range(200):
        before = hero.position
        if hero.move(0, 1).y == 0 or hero.position[0] != before[0]:
            return hero
    raise AssertionError("it never arrived")


@pytest.mark.parametrize("effects", [PLAIN, STACKS], ids=["plain", "stacking"])
@pytest.mark.parametrize("turns", [0.0, 0.3])
@pytest.mark.parametrize("shape", ["box", "capsule"])
def test_carried_by_a_platform_of_pixels_as_by_a_box(shape, turns, effects):
    paths = []
    for ground in (PixelMask(np.ones((12, 80), bool)), Polygon.box(80, 12)):
        world = World(effects, gravity=(0, 0) if effects.gravity else None)
        lift = world.add_body(
            ground,
            kind="kinematic",
            velocity=(31.0, -17.0),
            **({"angular_velocity": turns} if effects.rotation else {}),
        )
        hero = put_down(world, SHAPES[shape][0], 3.0)
        path = []
        for _ in range(90 if JIT else 30):
            world.step()
            moved = hero.move(0.0, 0.5)
            assert moved.grounded and moved.riding == lift and not moved.squeezed
            path.append(hero.position)
        paths.append(path)
    assert np.abs(np.array(paths[0]) - paths[1]).max() <= 1e-9


@pytest.mark.parametrize("effects", [PLAIN, STACKS], ids=["plain", "stacking"])
def test_carried_by_what_is_no_box(effects):
    """A character on the flat deck of a moving mask in the form of a boat is carried along with it."""
    at = np.arange(90) - 44.5
    boat = np.arange(24)[:, None] < 24.0 - (at / 12.0)[None, :] ** 2
    world = World(effects, gravity=(0, 0) if effects.gravity else None)
    lift = world.add_body(PixelMask(boat), kind="kinematic", velocity=(24.0, 9.0))
    hero = put_down(world, BOX, 5.0)
    start, origin = hero.position, lift.position
    for _ in range(120 if JIT else 40):
        world.step()
        moved = hero.move(0.0, 0.5)
        assert moved.grounded and moved.riding == lift and not moved.squeezed and moved.slope == 0.0
    for axis in (0, 1):
        assert hero.position[axis] - start[axis] == pytest.approx(lift.position[axis] - origin[axis], abs=1.0)


def test_deep_inside_a_mask_of_many_parts_every_way_is_blocked():
    mask = floor_with_seams()
    inside = next(
        (float(x), float(y))
        for y in range(10, 50)
        for x in range(20, 380)
        if mask.solid[y - 8 : y + 9, x - 8 : x + 9].all()
    )
    for shape in (Polygon.box(6, 6), Polygon.box(6, 6, angle=0.5)):
        world = World(PLAIN)
        world.add_body(mask, kind="static")
        hero = Character(world, shape, inside)
        assert all(hero.blocked(*way) for way in ((1, 0), (-1, 0), (0, 1), (0, -1)))


def test_no_mask_is_a_character():
    with pytest.raises(TypeError, match="PixelMask"):
        Character(World(PLAIN), PixelMask(np.ones((8, 8), bool)), (0, 0))


@pytest.mark.parametrize("shape", ["box", "capsule"])
def test_crates_of_pixels_are_pushed_as_boxes_are(shape):
    ways = []
    for crate in (PixelMask(np.ones((16, 16), bool)), Polygon.box(16, 16)):
        world = World(STACKS)
        world.add_body(Polygon.box(800, 20), position=(0, 10), kind="static")
        body = world.add_body(crate, position=(40.0, -8.0))
        hero = put_down(world, SHAPES[shape][0], 0.0)
        for _ in range(90 if JIT else 30):
            hero.move(1.0, 1.0)
            world.step()
        ways.append((hero.position, body.position))
    assert ways[0] == ways[1] and ways[0][1][0] > 41.0
