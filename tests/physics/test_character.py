"""Characters move by whole pixels, are never inside the ground, are carried and squeezed, walk
slopes and push bodies.
"""

import math

import numpy as np
import pytest

from physics import (
    JIT,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
)
from tests.oracles.walks import inside_ground

EFFECTS = Effects(response=True, one_way=True)
BOX = Polygon.box(10, 20)


def ground(rows, size=16, legend=None):
    """Return (world with a tile grid, solid cells, slopes of the cells) for a map of characters.

    rows: strings in which # is a solid and = a one-way cell. / and \\ are slopes of 45 degrees. 1 and 2 are the two
    halves of a 1:2 slope that rises to the right, 3 and 4 those of one that falls.
    """
    heights = {"/": (0, 1), "\\": (1, 0), "1": (0, 0.5), "2": (0.5, 1), "3": (1, 0.5), "4": (0.5, 0)}
    grid = np.array([list(row) for row in rows])
    slopes = np.zeros((*grid.shape, 2))
    for mark, value in heights.items():
        slopes[grid == mark] = value
    world = World(EFFECTS)
    world.add_body(TileGrid(grid == "#", size, one_way=grid == "=", slopes=slopes), kind="static")
    return world, (grid == "#").tolist(), slopes.tolist()


def standing(world, x, floor, **options):
    """Return a character at x whose feet are at the height `floor`."""
    hero = Character(world, BOX, (x, floor - 10), **options)
    hero.move(0, 0)
    return hero


@pytest.mark.parametrize("seed", range(3))
def test_never_inside_a_solid_and_the_sum_of_moves_is_the_way(seed):
    rng = np.random.default_rng(seed)
    rows, marks = 14, "########/\\1234"
    grid = ["".join(rng.choice(list(marks)) if rng.random() < 0.35 else "." for _ in range(20)) for _ in range(rows)]
    grid[5] = "." * 20
    grid[4] = "." * 20
    world, solid, slopes = ground(grid)
    hero = Character(world, BOX, (100, 85))
    x, y, moves = 95, 75, 0
    for _ in range(2000 if JIT else 250):
        dx, dy = rng.normal(0, 4, 2) * (rng.random() < 0.9)
        moved = hero.move(float(dx), float(dy), drop=bool(rng.random() < 0.2))
        x, y, moves = x + moved.x, y + moved.y, moves + (moved.x != 0 or moved.y != 0)
        assert hero.position == (x + 5, y + 10)
        assert not inside_ground(solid, slopes, 16, x, y, 10, 20), (x, y)
        assert moved.grounded == (inside_ground(solid, slopes, 16, x, y + 1, 10, 20)), (x, y)
    assert moves > 100


def test_remainder_is_carried_exactly():
    world, _, _ = ground(["....."])
    hero = Character(world, BOX, (500, 500))
    total_x = total_y = 0
    for step in range(400):
        moved = hero.move(0.3, -0.7)
        total_x, total_y = total_x + moved.x, total_y + moved.y
        assert abs(total_x - 0.3 * (step + 1)) <= 0.5 + 1e-9 and abs(total_y + 0.7 * (step + 1)) <= 0.5 + 1e-9
    assert (total_x, total_y) == (120, -280)
    assert hero.move(0.5, 0).x in (0, 1) and isinstance(hero.move(1, 0).x, int)


def test_stopped_motion_is_forgotten_and_not_saved_up():
    world, _, _ = ground(["..#", "..#", "..#"])
    hero = Character(world, BOX, (27, 10))
    for _ in range(50):
        assert hero.move(0.4, 0).x == 0 and hero.position[0] == 27
    assert hero.move(-1.0, 0).x == -1


@pytest.mark.parametrize("floor", ["tiles", "box", "static mask", "kinematic", "crate"])
def test_lands_on_every_kind_of_floor_exactly(floor):
    world = World(EFFECTS)
    if floor == "tiles":
        world.add_body(TileGrid(np.ones((1, 4), bool), 16), position=(0, 64), kind="static")
    elif floor == "static mask":
        world.add_body(PixelMask(np.ones((16, 64), bool)), position=(32, 72), kind="static")
    elif floor == "crate":
        Character(world, Polygon.box(64, 16), (32, 72), pushable=True)
    else:
        world.add_body(Polygon.box(64, 16), position=(32, 72), kind="static" if floor == "box" else "kinematic")
    hero = Character(world, BOX, (32, 20))
    fell = 0
    while not (moved := hero.move(0, 3.3)).grounded:
        fell += moved.y
        assert fell < 100
    assert hero.position == (32, 54) and hero.move(0, 5).y == 0
    assert (hero.move(0, 0).riding is not None) == (floor in ("kinematic", "crate"))


def test_walls_are_felt_on_their_side():
    world, _, _ = ground(["#...#", "#...#", "#...#", "#####"])
    hero = standing(world, 40, 48)
    assert hero.move(0, 0).wall == 0
    right = hero.move(30, 0)
    assert (right.wall, right.x, hero.position[0]) == (1, 19, 59)
    left = hero.move(-60, 0)
    assert (left.wall, left.x, hero.position[0]) == (-1, -38, 21) and left.grounded


@pytest.mark.parametrize(
    "velocity", [(90.0, 0.0), (-77.0, 0.0), (0.0, 55.0), (0.0, -60.0), (50.0, -33.0), (-41.0, 29.0)]
)
def test_platform_carries_its_rider_exactly(velocity):
    world = World(EFFECTS)
    platform = world.add_body(Polygon.box(64, 16), position=(32, 72), kind="kinematic", velocity=velocity)
    hero = standing(world, 32, 64)
    for _ in range(120):
        world.step()
        moved = hero.move(0, 0)
        assert moved.grounded and moved.riding == platform and not moved.squeezed
        top = math.floor(platform.position[1] - 8 + 0.5)
        assert hero.position[1] + 10 == top
        assert abs((hero.position[0] - 32) - (platform.position[0] - 32)) <= 1.0


def test_rider_with_gravity_stays_on_a_platform_that_turns_around():
    world = World(EFFECTS)
    platform = world.add_body(Polygon.box(48, 16), position=(100, 100), kind="kinematic")
    hero = standing(world, 100, 92)
    for n in range(240):
        platform.velocity = (80 * math.cos(n / 20), 60 * math.sin(n / 15))
        world.step()
        assert hero.move(0, 1.0).grounded, n
        assert abs(hero.position[0] - platform.position[0]) <= 2


def test_solid_pushes_what_is_in_its_way_in_both_axes():
    for velocity, start in (
        ((120.0, 0.0), (0, 0)),
        ((-120.0, 0.0), (200, 0)),
        ((0.0, 120.0), (100, -100)),
        ((0.0, -120.0), (100, 100)),
    ):
        world = World(EFFECTS)
        piston = world.add_body(Polygon.box(40, 40), position=start, kind="kinematic", velocity=velocity)
        hero = Character(world, BOX, (100, 0))
        for _ in range(90):
            world.step()
            assert not hero.move(0, 0).squeezed
            gap_x = abs(hero.position[0] - piston.position[0]) - 25
            gap_y = abs(hero.position[1] - piston.position[1]) - 30
            assert max(gap_x, gap_y) >= -1.0


def test_squeeze_is_told_once_and_the_squeezed_stays():
    world, _, _ = ground(["....#", "....#", "....#"])
    world.add_body(Polygon.box(16, 40), position=(20, 24), kind="kinematic", velocity=(60.0, 0.0))
    hero = Character(world, BOX, (50, 24))
    told = []
    for _ in range(60):
        world.step()
        told.append(hero.move(0, 0).squeezed)
        if told[-1]:
            break
    assert told[-1] and hero.position[0] == 59


def test_one_way_opens_from_below_and_drops_on_demand():
    world, _, _ = ground(["....", "====", "....", "####"])
    hero = standing(world, 30, 48)
    assert hero.move(0, -40).y == -40, "from below"
    fall = hero.move(0, 30)
    assert fall.grounded and hero.position[1] == 6 and hero.move(0, 5).y == 0
    assert hero.move(8, 0).x == 8 and hero.move(-8, 0).grounded
    assert hero.move(0, 1, drop=True).y == 1
    for _ in range(10):
        moved = hero.move(0, 4)
    assert moved.grounded and hero.position[1] == 38
    inside = Character(world, BOX, (30, 20))
    assert inside.move(6, 0).x == 6 and inside.move(0, 2).y == 2, "what is inside it goes through"


@pytest.mark.parametrize(
    "rows, slope",
    [
        ([".......", ".......", "....###", "../####", "#######"], 1.0),
        ([".......", "....../", "...../#", "..../##", "#######"], 1.0),
        ([".......", ".......", ".......", "..12###", "#######"], 0.5),
    ],
)
def test_slopes_are_walked_up_and_down_without_leaving_the_ground(rows, slope):
    for mirrored in (False, True):
        turn = str.maketrans("/\\1234", "\\/4321")
        used = [row[::-1].translate(turn) if mirrored else row for row in rows]
        if used == rows:
            continue
        world, solid, slopes = ground(used)
        width = 16 * len(rows[0])
        hero = standing(world, width - 11 if mirrored else 11, 64)
        step = -1.5 if mirrored else 1.5
        seen, heights = set(), []
        for _ in range(50):
            moved = hero.move(step, 0)
            heights.append(hero.position[1])
            seen.add(abs(moved.slope))
            assert moved.grounded and not inside_ground(
                solid, slopes, 16, int(hero.position[0] - 5), int(hero.position[1] - 10), 10, 20
            )
        assert slope in seen and min(heights) <= 54 - 16
        while 10 < hero.position[0] < width - 10:
            moved = hero.move(-step, 0)
            assert moved.grounded, "glued to the slope on the way down"
        assert hero.position[1] == 54


@pytest.mark.parametrize("speed", [0.4, 1.0, 3.0, 7.9])
def test_slope_down_is_followed_at_any_speed(speed):
    rows = ["............", "#\\..........", "##\\.........", "###\\........", "############"]
    world, _, _ = ground(rows)
    hero = standing(world, 8, 16)
    travelled = 0
    while hero.position[0] < 120 and travelled < 900:
        moved = hero.move(speed, 0)
        travelled += 1
        assert moved.grounded
    assert hero.position[1] == 54


def test_slope_reports_its_rise():
    world, _, _ = ground(["....", "./\\.", "####"])
    hero = Character(world, Polygon.box(4, 8), (24, 20))
    hero.move(0, 30)
    assert hero.move(0, 0).slope == 1.0
    other = Character(world, Polygon.box(4, 8), (40, 16))
    other.move(0, 30)
    assert other.move(0, 0).slope == -1.0


def test_crate_is_pushed_by_walking_and_stops_at_a_wall():
    world, _, _ = ground(["..........", "..........", "........#.", "##########"])
    crate = Character(world, Polygon.box(16, 16), (60, 40), pushable=True)
    crate.move(0, 5)
    hero = standing(world, 20, 48)
    for _ in range(100):
        hero.move(2, 0)
        assert hero.position[0] + 5 <= crate.position[0] - 8
    assert crate.position == (120, 40) and hero.position[0] == 107 and hero.move(1, 0).wall == 1
    assert hero.move(-20, 0).x == -20 and crate.position == (120, 40)


def test_hero_stands_on_a_crate_and_does_not_move_it():
    world, _, _ = ground(["......", "......", "......", "######"])
    crate = Character(world, Polygon.box(16, 16), (40, 40), pushable=True)
    hero = standing(world, 40, 32)
    assert hero.move(0, 0).riding == crate.body
    hero.move(3, 0)
    assert crate.position == (40, 40)


def test_characters_ignore_each_other_unless_pushable():
    world, _, _ = ground(["......"])
    first, second = Character(world, BOX, (20, 60)), Character(world, BOX, (40, 60))
    assert first.move(20, 0).x == 20 and second.position == (40, 60)


def test_character_touches_sensors_and_reports_contacts():
    world = World(EFFECTS.with_(sensors=True))
    world.add_body(Circle(6), position=(60, 0), kind="static", sensor=True)
    hero = Character(world, BOX, (0, 0))
    begun = ended = 0
    for _ in range(120):
        hero.move(1, 0)
        world.step()
        begun, ended = begun + len(world.events.sensor_begin), ended + len(world.events.sensor_end)
    assert (begun, ended) == (1, 1)


def test_shapes_that_a_character_can_have():
    world = World(EFFECTS)
    solid = np.zeros((30, 20), bool)
    solid[5:25, 4:14] = True
    for shape in (BOX, Bounds(BOX), Bounds(PixelMask(solid))):
        hero = Character(world, shape, (0.3, 0.4))
        row = world.characters.rows[-1]
        assert (row["width"], row["height"]) == (10, 20) and hero.position == (0, 0)
    for shape in (PixelMask(solid), Segment((0, 0), (9, 0)), Chain([(0, 0), (9, 0)]), TileGrid([[True]], 8), "box"):
        with pytest.raises(TypeError, match="shape must be a Polygon, Circle or Capsule"):
            Character(world, shape, (0, 0))
    for shape in (Polygon.box(0.2, 5), Circle(0.4), Capsule((0, 0), (5, 0), 0.4), Bounds(PixelMask(~solid & solid))):
        with pytest.raises(ValueError, match="shape must"):
            Character(world, shape, (0, 0))
    for value in (-0.1, math.pi / 2, 2.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="max_slope must be"):
            Character(world, BOX, (0, 0), max_slope=value)
    with pytest.raises(TypeError, match="max_slope must be a number"):
        Character(world, BOX, (0, 0), max_slope="steep")


def test_removed_character_is_gone_and_says_so():
    world = World(EFFECTS)
    hero = Character(world, BOX, (0, 0))
    hero.remove()
    assert len(world.bodies) == len(world.characters.rows) == 0
    with pytest.raises(KeyError):
        hero.move(1, 0)
    world.step()


def test_previous_pose_and_move_to():
    world = World(EFFECTS)
    hero = Character(world, BOX, (0, 0))
    hero.move(7, 3)
    assert hero.previous == (0, 0) and hero.position == (7, 3)
    hero.move_to((50.4, 10))
    assert hero.position == hero.previous == (50, 10) and hero.move(0.4, 0).x == 0
