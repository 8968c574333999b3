"""Body.set_cells changes the cells of a TileGrid in place."""

import numpy as np
import pytest

from physics import BROADPHASES, Character, Circle, Effects, Filter, Material, Polygon, TileGrid, World

BOX = Polygon.box(14, 14)


def yard(crates=12, columns=40, effects=None, **settings):
    """Return (world, ground, crates) with a row of crates asleep on a tile grid.

    One crate lies on every third cell, beginning with the second.
    """
    world = World(effects, **settings)
    ground = world.add_body(TileGrid(np.ones((2, columns), bool), 16), position=(0, 100), kind="static")
    boxes = [world.add_body(BOX, position=(24 + 48 * k, 93)) for k in range(crates)]
    for _ in range(120):
        world.step()
    return world, ground, boxes


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("cells, solid, woken", [
    ([(38, 0)], False, []),
    ([(4, 0)], False, [1]),
    ([(4, 0), (10, 0)], [False, False], [1, 3]),
    ([(3, 1), (4, 1)], False, []),  # below the top row
    ([(4, 0)], True, []),  # it is solid already
    ([(4, 0), (38, 0)], [True, False], []),
    ([], False, []),
    (np.zeros((0, 2), int), True, []),
])  # fmt: skip
def test_only_what_touches_a_changed_cell_wakes(solver, cells, solid, woken):
    world, ground, boxes = yard(solver=solver)
    assert not any(box.awake for box in boxes)
    ids = ground.shape_ids
    ground.set_cells(cells, solid)
    assert [k for k, box in enumerate(boxes) if box.awake] == woken and ground.shape_ids == ids
    for _ in range(15):  # the second row of tiles is reached after 19
        world.step()
        assert len(world.events.begin) == 0
        assert set(world.events.end["body_b"].tolist()) <= {boxes[k].id for k in woken}
    for k, box in enumerate(boxes):
        assert (box.position.y > 94.0) == (k in woken)


def test_a_wall_that_grows_into_a_sleeper_wakes_it():
    world = World()
    solid = np.zeros((3, 20), bool)
    solid[2] = True
    ground = world.add_body(TileGrid(solid, 16), kind="static")
    boxes = [world.add_body(BOX, position=(x, 25)) for x in (40, 200)]
    for _ in range(120):
        world.step()
    ground.set_cells([(3, 1)], True)  # x 48..64, beside the first box, whose right edge is at 47
    assert [box.awake for box in boxes] == [False, False]
    ground.set_cells([(2, 1)], True)
    assert [box.awake for box in boxes] == [True, False]
    world.step()
    assert boxes[0].contacts["separation"].min() < -1.0


@pytest.mark.parametrize("broadphase", sorted(BROADPHASES))
@pytest.mark.parametrize("edit", [
    None,
    lambda ground: ground.move_to((0, 90), 0.0),
    lambda ground: setattr(ground, "filter", Filter(3)),
    lambda ground: setattr(ground, "material", Material(friction=0.1)),
    lambda ground: ground.set_cells([(k, 0) for k in range(8)], False),
    lambda ground: ground.set_kind("kinematic"),
], ids=["added", "moved", "filter", "material", "cells", "kind"])  # fmt: skip
def test_the_next_bodies_meet_a_grid_that_was_edited_a_step_before(edit, broadphase):
    """A body that arrives one step after an edit of a tile grid still collides with the grid.

    The step of the edit searches the pairs of the grid; the next step searches those of the new body.
    """
    world = World(broadphase=broadphase)
    ground = world.add_body(TileGrid(np.ones((1, 8), bool), 16), position=(0, 100), kind="static")
    old = world.add_body(Circle(5), position=(20, -300))
    for _ in range(3 if edit else 0):
        world.step()
    if edit:
        edit(ground)
    world.step()
    ground.set_cells([(k, 0) for k in range(7)], False)
    ground.set_cells([(k, 0) for k in range(8)], True)
    top = ground.position.y
    old.position, new = (20, top - 5), world.add_body(Circle(5), position=(60, top - 5))
    for _ in range(20):
        world.step()
    assert old.position.y == pytest.approx(top - 5, abs=0.2) and new.position.y == pytest.approx(top - 5, abs=0.2)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection", "blocking"])
def test_awake_bodies_feel_it_at_once(solver):
    stacks = solver in ("soft_step", "sequential_impulse")
    effects = Effects(response=True, gravity=True, friction=True, stacking=stacks)
    world, ground, boxes = yard(3, effects=effects, solver=solver)
    before = world.bodies.copy()
    ground.set_cells([(4, 0), (4, 1)], False)
    ends = []
    for _ in range(30):
        world.step()
        assert len(world.events.begin) == 0
        ends += world.events.end["body_b"].tolist()
    assert ends == [boxes[1].id] and boxes[1].position.y > 110
    for k in (1, 3):
        assert world.bodies["y"][k] == pytest.approx(before["y"][k], abs=0.05)


def test_contacts_keep_their_impulses():
    """A change of a neighbouring cell keeps the impulses of resting contacts."""
    world, ground, boxes = yard(3, effects=Effects.rigid_bodies().with_(sleeping=False))
    weight = boxes[1].mass * 9.8 * 32 / 60
    ground.set_cells([(5, 0)], False)  # its left edge is that of the cell under the box
    world.step()
    for box in boxes:
        rows = world.contacts[world.contacts["body_b"] == box.id]
        assert rows["normal_impulse"].sum() == pytest.approx(weight, rel=1e-2)
        assert abs(box.velocity.y) < 0.05


def test_it_equals_a_grid_made_so():
    solid, one_way, slopes = np.zeros((3, 4), bool), np.zeros((3, 4), bool), np.zeros((3, 4, 2))
    one_way[0, 1], slopes[1, 2] = True, (0.0, 1.0)
    world = World(Effects.rigid_bodies().with_(one_way=True))
    material, filter = Material(friction=0.2), Filter(2, 3)
    body = world.add_body(
        Circle(3, (-40, 0)), TileGrid(solid, 8, one_way, slopes).with_(material, filter, False), kind="kinematic"
    )
    body.set_cells([(1, 0), (2, 1), (3, 2), (0, 0)], np.array([True, False, True, False]))
    expected = np.zeros((3, 4), bool)
    expected[0, 1] = expected[2, 3] = True
    grid = body.shapes[1]
    assert (grid.solid == expected).all() and not grid.one_way.any() and not grid.slopes.any()
    assert (grid.material, grid.filter, grid.sensor) == (material, filter, False)
    assert [each.id for each in world.query_point((9, 1))] == [body.id] and world.query_point((17, 15)) == []
    taken = world.snapshot()
    body.set_cells([(0, 2)], True)
    assert [each.id for each in world.query_point((1, 17))] == [body.id]
    world.restore(taken)
    assert world.query_point((1, 17)) == []


def test_a_character_walks_on_what_has_changed():
    world = World(Effects(response=True))
    ground = world.add_body(TileGrid(np.ones((1, 10), bool), 16), position=(0, 100), kind="static")
    hero = Character(world, Polygon.box(8, 8), (24, 96))
    assert hero.move(0, 4).grounded
    ground.set_cells([(1, 0)], False)
    assert not hero.move(0, 4).grounded and hero.position[1] == 100


def test_many_changes_do_not_fill_the_memory():
    world = World()
    body = world.add_body(TileGrid(np.ones((50, 50), bool), 16), kind="static")
    for k in range(300):
        body.set_cells([(k % 50, k // 50)], False)
    assert len(world.library.tile_grids) < 200


@pytest.mark.parametrize("cells, solid, error, message", [
    ([(40, 0)], False, ValueError, r"cells\[0\] must be \(column, row\) within 0..39 and 0..1 \(got \(40, 0\)\)"),
    ([(0, 0), (0, -1)], False, ValueError, r"cells\[1\] must be .* \(got \(0, -1\)\)"),
    ((3, 0), False, ValueError, r"cells must have shape \(n, 2\) \(got \(2,\)\)"),
    ([(1, 2, 3)], False, ValueError, r"cells must have shape \(n, 2\)"),
    ([(1.0, 0.0)], False, TypeError, "cells must be whole numbers"),
    ([(True, False)], False, TypeError, "cells must be an array of numbers"),
    ("ab", False, TypeError, "cells must be an array of numbers"),
    ([(1, 0)], 1, TypeError, r"solid must be a bool, or one for each of cells \(got 1\)"),
    ([(1, 0)], None, TypeError, "solid must be a bool"),
    ([(1, 0)], [True, False], ValueError, r"solid must be a bool or have shape \(1,\), as cells has \(got \(2,\)\)"),
    ([(1, 0), (2, 0)], [[True], [False]], ValueError, "solid must be a bool or have shape"),
])  # fmt: skip
def test_wrong_arguments(cells, solid, error, message):
    world, ground, _ = yard(1)
    before = world.digest()
    with pytest.raises(error, match=message):
        ground.set_cells(cells, solid)
    assert world.digest() == before and ground.shapes[0].solid.all()


@pytest.mark.parametrize("count", [0, 2])
def test_a_body_must_have_one_grid(count):
    world = World()
    grid = TileGrid(np.ones((1, 2), bool), 16)
    body = world.add_body(Circle(4, (-50, 0)), *[grid] * count, kind="static")
    with pytest.raises(ValueError, match=f"set_cells needs a body with one TileGrid; body {body.id} has"):
        body.set_cells([(0, 0)], False)
    body.remove()
    with pytest.raises(KeyError):
        body.set_cells([(0, 0)], False)


# ---- remove_bodies takes a set ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("ids", [[2, 0, 2], (0, 2), np.array([2, 2, 0]), {0, 2}, [0, 0, 2, 2]])
def test_bodies_are_removed_once_however_often_they_are_named(ids):
    world = World()
    world.add_bodies(Circle(4), [(20 * k, 0) for k in range(4)])
    world.remove_bodies(ids)
    assert world.bodies["id"].tolist() == [1, 3]
    world.step()


@pytest.mark.parametrize("ids", [[0, 0, 9], np.array([9, 9]), [-1, -1]])
def test_an_unknown_body_among_them_removes_nothing(ids):
    world = World()
    world.add_bodies(Circle(4), [(20 * k, 0) for k in range(4)])
    with pytest.raises(KeyError):
        world.remove_bodies(ids)
    assert len(world) == 4


def test_bodies_can_be_named_by_handles_and_repeated():
    world = World()
    bodies = [world.add_body(Circle(4), position=(20 * k, 0)) for k in range(3)]
    world.remove_bodies([bodies[1], bodies[1], bodies[0].id])
    assert world.bodies["id"].tolist() == [2]
