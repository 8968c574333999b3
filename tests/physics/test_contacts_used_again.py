"""Contacts of the previous step are recycled where both bodies are still at the poses of that step.

The oracle is a run in which no contact is recycled: the flag `can_recycle` of every contact is cleared in every step.
"""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Character, Circle, Effects, PixelMask, Polygon, World
from physics.contacts.cache import update_contacts

STEPS = 90 if JIT else 20
AWAKE = Effects.rigid_bodies().with_(sleeping=False)
ALL = Effects.rigid_bodies().with_(continuous=True, carving=True, one_way=True, sensors=True)
TOLD = ("shape_a", "shape_b", "count", "normal_x", "normal_y", "x_1", "y_1", "separation_1", "speed_1")
SHAPES = (
    Polygon.box(24, 16),
    Circle(10),
    Capsule((-8, 0), (8, 0), 6),
    Polygon([(0, -12), (11, -3), (7, 10), (-7, 10), (-11, -3)]),
)


def heap(effects, solver="soft_step", shapes=SHAPES, **arguments):
    """Return (world, floor, bodies of a heap on the floor)."""
    world = World(effects, solver=solver, **arguments)
    floor = world.add_body(Polygon.box(400, 40), kind="static", position=(0, 20))
    bodies = [
        world.add_body(shapes[k % len(shapes)], position=(26.0 * (k % 4) - 39.0, -13.0 - 26.0 * (k // 4)))
        for k in range(12)
    ]
    return world, floor, bodies


def ask_again(world):
    """Clear `can_recycle` of all contacts, so that the next step computes all of them."""
    world.contact_rows["can_recycle"] = False
    for island in world.sleeping_set.islands.values():
        island.contacts["can_recycle"] = False


def follow(make, edit):
    """Run a world with recycled contacts, and again without them. Assert that each step reports the same.

    edit(world, step, memory): function called before each step. memory: dict that it may use, with the result of make()
    as "made".
    """
    ran = []
    for asked in (False, True):
        world, _, _ = made = make()
        memory, told = {"made": made}, []
        for step in range(STEPS):
            edit(world, step, memory)
            if asked:
                ask_again(world)
            world.step()
            told.append((world.digest(), [world.contact_rows[name].copy() for name in TOLD]))
        ran.append(told)
    for step, ((digest, rows), (expected, asked)) in enumerate(zip(*ran, strict=True)):
        for name, values, wanted in zip(TOLD, rows, asked, strict=True):
            assert np.array_equal(values, wanted), f"step {step}: {name}"
        assert digest == expected, f"step {step}"


def leave(world, step, memory):
    """Edit that leaves the world unchanged."""


def move_floor(world, step, memory):
    if step % 7 == 5:
        _, floor, _ = memory["made"]
        floor.position = (0.0, 20.0 + 0.5 * (step % 2))


def write_floor(world, step, memory):
    if step % 7 == 5:
        world.bodies["y"][0] += 0.3 if step % 2 else -0.3


def turn_one_in_the_table(world, step, memory):
    if step % 9 == 4:
        world.bodies["angle"][6] += 0.01


def put_in_its_place(world, step, memory):
    """Edit that removes a body and moves the next one in the table to the pose of the removed body.

    The moved body thus gets both the row and the pose of the removed one.
    """
    _, _, bodies = memory["made"]
    if step in (STEPS // 3, STEPS // 2):
        first, second = bodies.pop(4), bodies[4]
        pose = first.position, first.angle
        first.remove()
        second.move_to(*pose)


def restore(world, step, memory):
    """Edit that moves the floor and takes a snapshot, and restores this snapshot in two later steps."""
    _, floor, _ = memory["made"]
    if step == STEPS // 4:
        floor.position = (0.0, 20.75)
        memory["kept"] = world.snapshot()
    if step in (STEPS // 2, STEPS // 2 + 3):
        world.restore(memory["kept"])


def retune(world, step, memory):
    if step % 11 == 3:
        world.shapes["friction"][1 + step % 10] = 0.1 * (step % 5)
    if step == STEPS // 2:
        world.solver = "sequential_impulse"
    if step == STEPS // 2 + 5:
        world.solver = "soft_step"


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_a_heap_that_is_left_alone(solver):
    follow(lambda: heap(AWAKE, solver), leave)


def spoil_contacts(world, step, memory):
    """Write NaN into values of some contacts; the next step must still match these contacts to the contact cache."""
    if step % 8 == 6:
        for name in ("normal_x", "y_1", "separation_1"):
            world.contact_rows[name][step % 3 :: 4] = math.nan


EDITS = (leave, spoil_contacts, move_floor, write_floor, turn_one_in_the_table, put_in_its_place, restore, retune)


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit.__name__)
@pytest.mark.parametrize("effects", [AWAKE, ALL], ids=["awake", "all effects"])
def test_a_heap_that_hands_move(edit, effects):
    follow(lambda: heap(effects), edit)


def test_contacts_that_sleep_are_asked_when_they_wake():
    """Sleeping contacts cannot be recycled when they wake, because the last step's poses do not apply to sleeping
    bodies.
    """
    world, _, bodies = heap(Effects.rigid_bodies(), shapes=(Polygon.box(24, 24),))
    for _ in range(120):
        world.step()
        if not any(body.awake for body in bodies):
            break
    asleep = [island.contacts for island in world.sleeping_set.islands.values()]
    assert sum(map(len, asleep)) >= 12 and not any(rows["can_recycle"].any() for rows in asleep)


def test_contacts_sleep_exactly_where_they_stand():
    """The contacts of an island are stored at its final poses when it sleeps, so that they are valid when it wakes.

    They equal, to the bit, contacts whose points are all evaluated again at these poses.
    """
    world, _, bodies = heap(Effects.rigid_bodies(), shapes=(Polygon.box(30, 16), Polygon.box(18, 24)))
    for k, body in enumerate(bodies):
        body.move_to((26.0 * (k % 4) - 39.0 + 7.0 * (k // 4), -20.0 - 30.0 * (k // 4)), 0.4 * math.sin(5.0 * k))
    for _ in range(400):
        world.step()
        if not any(body.awake for body in bodies):
            break
    islands = list(world.sleeping_set.islands.values())
    assert sum(len(island.contacts) for island in islands) >= 12
    for island in islands:
        rows = world.rows(island.contacts["body_a"]), world.rows(island.contacts["body_b"])
        carried = island.contacts.copy()
        carried["body_row_a"], carried["body_row_b"] = rows
        update_contacts(world.bodies, carried)
        for name in (*TOLD[3:8], "x_2", "y_2", "separation_2"):
            kept, moved = island.contacts[name], carried[name]
            two = island.contacts["count"] == 2 if name.endswith("_2") else slice(None)
            assert np.array_equal(kept[two], moved[two]), name


def test_a_character_that_pushes_and_a_lift_that_carries():
    def made():
        world, floor, _ = heap(ALL, shapes=(Polygon.box(24, 24),))
        lift = world.add_body(Polygon.box(60, 10), kind="kinematic", position=(120, -5), velocity=(0, -20))
        world.add_body(Polygon.box(16, 16), position=(120, -18))
        return world, floor, (lift, Character(world, Polygon.box(12, 20), (-90, -20)))

    def edit(world, step, memory):
        _, _, (lift, hero) = memory["made"]
        hero.move(2.0, 1.0)
        if step % 20 == 19:
            lift.velocity = (0, 20 if step % 40 == 19 else -20)
        if step % 30 == 10:
            lift.set_target((120, -6))

    follow(made, edit)


def test_masks_that_are_carved():
    def made():
        solid = np.ones((24, 24), bool)
        solid[:6, :6] = False
        return heap(ALL, shapes=(PixelMask(solid), Polygon.box(20, 14)))

    def edit(world, step, memory):
        _, _, bodies = memory["made"]
        if step % 15 == 8 and bodies[step % 3 * 2].id in world.bodies["id"]:
            hit = bodies[step % 3 * 2]
            hit.carve(Circle(4), (*hit.position, 0.0))

    follow(made, edit)


def test_what_rests_is_used_as_it_is_and_what_turns_is_not():
    world, _, _ = heap(AWAKE, shapes=(Polygon.box(24, 24),))
    for _ in range(STEPS):
        world.step()
    assert world.contact_rows["can_recycle"].all() and len(world.contact_rows) >= 12
    world.bodies["angular_velocity"][9:] = math.tau
    world.step()
    again = world.contact_rows["can_recycle"]
    turned = (world.contact_rows["body_row_a"] >= 9) | (world.contact_rows["body_row_b"] >= 9)
    assert turned.any() and not again[turned].any() and again[~turned].any()
