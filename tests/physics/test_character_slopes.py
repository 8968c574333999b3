"""One rule holds for every kind of ground: characters walk slopes flatter than max_slope and slide down steeper ones.

The slope under a character is reported.
"""

import math

import numpy as np
import pytest

from physics import JIT, Chain, Character, Effects, Material, Polygon, TileGrid, World
from tests.oracles.ramps import resting_y, slide
from tests.physics.slopes import GROUNDS, SHAPES, add_ground

PLAIN = Effects(response=True, one_way=True)
STACKS = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, one_way=True)
VELOCITIES = [(0.0, 40.0), (0.0, -55.0), (70.0, 0.0), (-45.0, 0.0), (31.0, -22.0)]  # [px/s] of the ground
ANGLES = [-75, -60, -45, -30, -10, 0, 10, 30, 45, 60, 75]
SLOP = 0.16  # [px] of a world with 32 px per metre


def land(world, shape, slope, x=-40.0, dy=2.0, **options):
    """Return a character after it has moved down onto a slope through the origin; it starts 9 px above it."""
    form, points, radius = SHAPES[shape]
    hero = Character(world, form, (x, math.floor(resting_y(points, radius, x, slope)) - 9.0), **options)
    for _ in range(40):
        moved = hero.move(0, dy)
        if moved.y == 0 or moved.x != 0:
            return hero
    raise AssertionError("it never arrived")


def above(hero, shape, slope, ground=(0.0, 0.0)):
    """Return how far [px] a character is above its contact position on a slope, measured vertically."""
    form, points, radius = SHAPES[shape]
    x, y = hero.position
    return resting_y(points, radius, x, slope, ground) - y


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", GROUNDS)
def test_every_shape_walks_every_ground_up_and_down(shape, kind):
    for degrees in ANGLES:
        slope = math.tan(math.radians(degrees))
        depth = SLOP * math.hypot(1.0, slope)  # [px] downwards that the slop allows
        for way in (1.0, -1.0):
            world = World(PLAIN)
            add_ground(world, kind, slope)
            hero = land(world, shape, slope, max_slope=math.radians(76))
            start = hero.position[0]
            for n in range(1, 41):
                moved = hero.move(way, 0.0)
                assert moved.grounded and moved.wall == 0, (degrees, way, n)
                assert hero.position[0] == pytest.approx(start + way * n, abs=1e-9)
                assert moved.slope == pytest.approx(slope, abs=1e-9)
                assert -depth - 1e-6 <= above(hero, shape, slope) <= 1.0 - depth + 1e-6, (degrees, way, n)


@pytest.mark.parametrize("shape", SHAPES)
def test_tiles_and_masks_are_walked_like_them(shape):
    for kind, slopes in (
        ("tiles", (1.0, 0.5, 0.25, 0.0, -0.5, -1.0)),
        ("mask", (2.0, 1.0, 0.5, 0.0, -0.25, -1.0, -3.0)),
    ):
        for slope in slopes:
            world = World(PLAIN)
            add_ground(world, kind, slope)
            hero = land(world, shape, slope, max_slope=math.radians(76))
            start = hero.position[0]
            for n in range(1, 61):
                moved = hero.move(1.0, 0.0)
                assert moved.grounded and abs(hero.position[0] - start - n) < 1e-9, (kind, slope, n)
                # An outline runs within half a pixel of the staircase, from end to end of 240 px.
                assert moved.slope == pytest.approx(slope, abs=1e-9 if kind == "tiles" else 0.005), (kind, slope, n)
                rim = 1.0 + abs(slope) if kind == "mask" else 1.0  # a staircase lies beside its line
                assert -rim - 0.3 <= above(hero, shape, slope) <= rim + 0.3, (kind, slope, n)


@pytest.mark.parametrize("width", [4, 10, 14])
def test_slope_of_tiles_is_told_by_the_middle_of_the_feet_and_by_a_foot_at_their_ends(width):
    """The slope reported on two sloped tiles that form a hill is the one of a tile under the feet.

    The tile under the middle of the feet comes first, then the tiles under their two ends. The character walks over the
    hill pixel by pixel.
    """
    solid = np.zeros((3, 7), bool)
    solid[2] = solid[1, 3] = True
    world = World(PLAIN)
    slopes = np.zeros((3, 7, 2))
    slopes[1, 2], slopes[1, 4] = (0.0, 1.0), (1.0, 0.0)
    world.add_body(TileGrid(solid, 16.0, slopes=slopes), position=(300.0, -77.0), kind="static")
    hero = Character(world, Polygon.box(width, 12), (304.0 + width / 2, -77.0 + 32.0 - 6.0), max_slope=0.9)
    assert hero.move(0, 0).grounded
    told = {2: 1.0, 4: -1.0}  # by the column of the hill
    while hero.position[0] + width / 2 < 300.0 + 108.0:
        moved = hero.move(1.0, 0.0)
        left = hero.position[0] - width / 2
        columns = [int((x - 300.0) // 16) for x in (left + width / 2, left + 0.5, left + width - 0.5)]
        high = hero.position[1] + 6.0 < -77.0 + 32.0  # off the plain: a foot is on the hill
        wanted = next((told[each] for each in columns if each in told), 0.0) if high else 0.0
        assert moved.grounded and moved.slope == wanted, (left, columns)


def test_any_angle_of_a_mask_is_told_within_two_degrees():
    """The slope reported on a mask is right within two degrees, at any angle.

    On the one or two pixels where tiles of the outline meet it may be off by up to five degrees.
    """
    for degrees in range(-70, 71, 7):
        slope = math.tan(math.radians(degrees))
        world = World(PLAIN)
        add_ground(world, "mask", slope)
        hero = land(world, "box", slope, max_slope=math.radians(76))
        off = []
        for _ in range(40):
            moved = hero.move(1.0, 0.0)
            off.append(abs(math.atan(moved.slope) - math.radians(degrees)))
            assert moved.grounded
        assert sorted(off)[-3] < 0.03 and max(off) < 0.09, degrees


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", [*GROUNDS, "mask"])
def test_what_is_steeper_is_slid_down_along_the_surface(shape, kind):
    for degrees, max_slope in ((75, 0.8), (-60, 0.8), (53, 0.8), (-53, 0.8), (45, 0.7), (-20, 0.3), (5, 0.0)):
        slope = math.tan(math.radians(degrees))
        world = World(PLAIN)
        add_ground(world, kind, slope)
        hero = land(world, shape, slope, x=20.0 if slope > 0 else -20.0, dy=1.0, max_slope=max_slope)
        (x, y), low = hero.position, hero.position[1]
        for _ in range(40):
            moved = hero.move(0.0, 1.7)
            assert not moved.grounded and hero.position[1] >= low, degrees
            assert moved.slope == pytest.approx(slope, abs=0.02 * (1 + slope**2) if kind == "mask" else 1e-9), degrees
            low = hero.position[1]
            assert -2.0 - SLOP * 4 <= above(hero, shape, slope) <= 1.5 + abs(slope), degrees
        along, down = slide(slope, 40 * 1.7)
        assert hero.position[0] - x == pytest.approx(along, abs=2.5), degrees
        assert hero.position[1] - y == pytest.approx(down, abs=1.5 + abs(slope)), degrees


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", GROUNDS)
def test_steep_ground_is_never_climbed(shape, kind):
    for degrees in (47, 60, 75, -50, -75):
        slope = math.tan(math.radians(degrees))
        world = World(PLAIN)
        add_ground(world, kind, slope)
        world.add_body(Polygon.box(900, 20), position=(0, 10), kind="static")
        way = 1.0 if slope > 0 else -1.0
        hero = Character(world, SHAPES[shape][0], (-60 * way, -30))
        while not hero.move(0, 1).grounded:
            pass
        floor = hero.position[1]
        for _ in range(80):
            moved = hero.move(1.3 * way, 0.6)
            assert hero.position[1] == floor and moved.grounded, degrees
        assert (moved.x, moved.wall) == (0, int(way)) and hero.position[0] * way < 0, "it stopped at its foot"


def test_max_slope_divides_exactly():
    for degrees in (10, 30, 45, 60):
        for by, walks in ((0.01, True), (0.0, True), (-0.01, False)):
            slope = math.tan(math.radians(degrees))
            world = World(PLAIN)
            add_ground(world, "polygon", slope)
            hero = land(world, "box", slope, max_slope=math.radians(degrees) + by)
            assert hero.max_slope == pytest.approx(math.radians(degrees) + by)
            assert hero.move(0, 0).grounded == walks


@pytest.mark.parametrize("effects", [PLAIN, STACKS], ids=["plain", "stacking"])
@pytest.mark.parametrize("velocity", VELOCITIES if JIT else VELOCITIES[-1:])
@pytest.mark.parametrize("shape", ["box", "circle", "turned"] if JIT else ["box"])
def test_ground_that_moves_is_walked_like_ground_that_stands(effects, velocity, shape):
    for kind in (*GROUNDS, "tiles", "mask"):
        for degrees in (-60, -45, -25, 0, 25, 45, 60) if JIT else (-45, 25):
            slope = math.tan(math.radians(degrees))
            if kind in ("tiles", "mask"):
                slope = max(-1.0, min(1.0, round(2.0 * slope) / 2.0))
            world = World(effects, gravity=(0, 0) if effects.gravity else None)
            ground = add_ground(world, kind, slope, kind="kinematic", velocity=velocity)
            origin = ground.position
            hero = land(world, shape, slope, x=-20.0, max_slope=math.radians(70))
            start = hero.position[0]
            for n in range(1, 41):
                world.step()
                moved = hero.move(0.8, 0.0)
                x, y = ground.position[0] - origin[0], ground.position[1] - origin[1]
                at = (kind, degrees, n)
                assert moved.grounded and moved.riding == ground and not moved.squeezed, at
                assert hero.position[0] - start - x == pytest.approx(0.8 * n, abs=2.01), at
                assert moved.slope == pytest.approx(slope, abs=0.005 if kind == "mask" else 1e-9), at
                rim = 2.0 * abs(slope) + 1.5
                assert -rim <= above(hero, shape, slope, (x, y)) <= rim, at


def test_he_keeps_his_feet_on_hills_of_every_kind():
    hills = [
        (-200, 0),
        (-120, 0),
        (-80, -40),
        (-40, -40),
        (-10, -10),
        (20, -25),
        (60, -5),
        (80, -5),
        (110, -50),
        (200, -50),
    ]
    for shape in SHAPES:
        for way in (1.0, -1.0, 3.7, -7.9):
            for kind in ("chain", "polygons"):
                world = World(PLAIN)
                if kind == "chain":
                    world.add_body(Chain(hills), kind="static")
                else:
                    for a, b in zip(hills, hills[1:], strict=False):
                        world.add_body(Polygon([a, b, (b[0], 60), (a[0], 60)]), kind="static")
                hero = Character(world, SHAPES[shape][0], (-160 if way > 0 else 160, -90), max_slope=1.0)
                while not hero.move(0, 1).grounded:
                    pass
                for _ in range(int(300 / abs(way))):
                    assert hero.move(way, 0.0).grounded, (shape, way, kind, hero.position)
                assert hero.position[0] * way > 100, (shape, way, kind)


@pytest.mark.parametrize("shape", SHAPES)
def test_curbs_block(shape):
    for height in (3, 6, 12):
        world = World(PLAIN)
        solid = [[False] * 4 + [True] * 4, [True] * 8]
        world.add_body(TileGrid(solid, 16), position=(0, 100 - height), kind="static")
        world.add_body(Polygon.box(200, 20), position=(0, 110), kind="static")
        hero = Character(world, SHAPES[shape][0], (20, 60), max_slope=0.3)
        while not hero.move(0, 1).grounded:
            pass
        floor = hero.position[1]
        for _ in range(60):
            moved = hero.move(1.0, 0.0)
        assert hero.position[1] == floor and hero.position[0] < 64 and moved.x == 0, height


def test_a_gap_between_two_steep_slopes_holds_him():
    world = World(PLAIN)
    world.add_body(Chain([(-100, -200), (0, 0), (100, -200)]), kind="static")
    hero = Character(world, SHAPES["circle"][0], (30, -180))
    for _ in range(300):
        moved = hero.move(0, 2.0)
    assert moved.grounded and moved.y == 0 and abs(hero.position[0]) <= 1


def test_a_belt_carries_up_and_down_a_slope():
    effects = Effects(response=True, conveyor=True, friction=True)
    for speed in (60.0, -60.0):
        for kind in ("polygon", "chain", "tiles"):
            world = World(effects)
            add_ground(world, kind, 0.5, material=Material(surface_speed=speed))
            hero = land(world, "box", 0.5)
            start = hero.position[0]
            for _ in range(60):
                assert hero.move(0.0, 0.0).grounded, kind
                world.step()
            assert hero.position[0] - start == pytest.approx(speed, abs=1.0), kind
            assert abs(above(hero, "box", 0.5)) <= 1.6, kind
