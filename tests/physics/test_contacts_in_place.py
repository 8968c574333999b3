"""Contacts keep their row in the table while the same shapes touch.

They are copied to other rows when a contact begins or ends. The motion of a pile must not depend on it.
"""

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Effects, Polygon, World

STEPS = 150 if JIT else 12
STATE = ("x", "y", "angle", "vx", "vy", "angular_velocity")
SHAPES = {
    "boxes": (Polygon.box(24, 24),),
    "mixed": (
        Polygon.box(24, 16),
        Circle(10),
        Capsule((-8, 0), (8, 0), 6),
        Polygon([(0, -12), (11, -3), (7, 10), (-7, 10), (-11, -3)]),
    ),
}
STACKING = Effects.rigid_bodies().with_(sleeping=False)


def pile(solver, shapes):
    """Return (world, rows of a heap with its floor, box), where the box is far away above another floor.

    rows: slice of the table of bodies.
    """
    world = World(STACKING, solver=solver, substeps=4)
    world.add_body(Polygon.box(800, 40), kind="static", position=(0, 20))
    random = np.random.default_rng(5)
    for k in range(40):
        x, y = 26.0 * (k % 8) - 91.0 + random.uniform(-2, 2), -14.0 - 27.0 * (k // 8)
        world.add_body(shapes[k % len(shapes)], position=(x, y), angle=float(random.uniform(-0.2, 0.2)))
    heap = slice(0, len(world.bodies))
    world.add_body(Polygon.box(80, 40), kind="static", position=(5000, 20))
    return world, heap, world.add_body(Polygon.box(20, 20), position=(5000, -300), gravity_scale=0.0)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("shapes", SHAPES)
def test_a_pile_does_the_same_whether_contacts_elsewhere_come_and_go(solver, shapes):
    ran = []
    for comes_and_goes in (False, True):
        world, heap, guest = pile(solver, SHAPES[shapes])
        begun = 0
        for step in range(STEPS):
            if comes_and_goes:
                guest.position = (5000, -10.0 if step % 2 else -300.0)
                guest.velocity = (0, 0)
            world.step()
            begun += guest.id in world.events.begin["body_b"]
        assert begun == (STEPS // 2 if comes_and_goes else 0)
        ran.append([world.bodies[name][heap].copy() for name in STATE])
    for name, still, busy in zip(STATE, *ran, strict=True):
        assert np.array_equal(still, busy), name


@pytest.mark.parametrize("shapes", SHAPES)
def test_a_pile_does_the_same_whether_bodies_elsewhere_are_removed(shapes):
    ran = []
    for removes in (False, True):
        world, heap, guest = pile("soft_step", SHAPES[shapes])
        for step in range(STEPS):
            if removes and step % 7 == 3:
                guest.remove()
                # On the floor of the heap: its contact stands in the middle of the table.
                guest = world.add_body(Polygon.box(20, 20), position=(380, -10.0))
            world.step()
            assert (world.contact_rows["separation_1"] > -8.0).all(), f"step {step}"
        ran.append([world.bodies[name][heap].copy() for name in STATE])
    for name, still, busy in zip(STATE, *ran, strict=True):
        assert np.array_equal(still, busy), name


@pytest.mark.parametrize("shapes", SHAPES)
def test_a_pile_goes_on_alike_from_a_snapshot_when_its_contacts_have_stood_for_long(shapes):
    world, heap, _ = pile("soft_step", SHAPES[shapes])
    for _ in range(STEPS):
        world.step()
    kept, digests = world.snapshot(), []
    for _ in range(2):
        for _ in range(STEPS):
            world.step()
        digests.append(world.digest())
        world.restore(kept)
    assert digests[0] == digests[1]


def test_rows_stand_in_the_order_of_their_shapes_and_beside_their_anchors():
    world, _, guest = pile("soft_step", SHAPES["mixed"])
    for step in range(60 if JIT else 9):
        guest.position = (5000, -10.0 if step % 3 else -300.0)
        world.step()
        rows = world.contact_rows
        keys = rows["shape_a"] * 1000 + rows["shape_b"]
        assert (np.diff(keys) >= 0).all()
        assert len(world.contact_rows) == len(rows)
        a, b = (world.bodies[world.rows(rows[name])] for name in ("body_a", "body_b"))
        assert np.array_equal(a["id"], world.bodies["id"][rows["body_row_a"]])
        assert np.array_equal(b["id"], world.bodies["id"][rows["body_row_b"]])
