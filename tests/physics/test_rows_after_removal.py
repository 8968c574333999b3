"""Contacts keep correct row numbers and unchanged other values when bodies are removed between steps."""

import numpy as np
import pytest

from physics import Circle, Effects, PixelMask, Polygon, World
from physics.tables.table import rows_of

RING = np.hypot(*(np.indices((24, 24)) - 11.5)) < 12


def heap(seed, count=40):
    """Return (world, ids of a heap) with boxes, discs, masks and bodies of two shapes."""
    effects = Effects.rigid_bodies().with_(sleeping=False)  # an island that wakes up would bring contacts back
    world, rng = World(effects), np.random.default_rng(seed)
    world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
    kinds = [
        (Polygon.box(20, 20),),
        (Circle(10),),
        (PixelMask(RING),),
        (Circle(8, center=(-8, 0)), Circle(8, center=(8, 0))),
    ]
    ids = []
    for k in range(count):
        x, y = 24.0 * (k % 8) - 84.0 + rng.uniform(-2, 2), 70.0 - 26.0 * (k // 8)
        ids.append(world.add_body(*kinds[rng.integers(4)], position=(x, y)).id)
    for _ in range(60):
        world.step()
    return world, ids


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("share", [0.05, 0.3, 0.9])
@pytest.mark.parametrize("seed", range(6))
def test_contacts_follow_the_rows_of_their_bodies_and_shapes(seed, share, at_once):
    world, ids = heap(seed)
    rng = np.random.default_rng(seed)
    for _ in range(4):
        before = world.contact_rows.copy()
        gone = [each for each in ids if rng.random() < share]
        ids = [each for each in ids if each not in gone]
        if at_once:
            world.remove_bodies(gone)
        else:
            for each in gone:
                world.remove_body(each)
        after = world.contact_rows
        stays = ~(np.isin(before["body_a"], gone) | np.isin(before["body_b"], gone))
        assert len(after) == np.count_nonzero(stays)
        for name in before.dtype.names:
            # A body that loses its support loses its cached forces.
            if name not in ("body_row_a", "body_row_b", "row_a", "row_b") and "force" not in name:
                assert after[name].tobytes() == before[name][stays].tobytes(), name
        for row, table, name in (
            ("body_row_a", world.bodies, "body_a"),
            ("body_row_b", world.bodies, "body_b"),
            ("row_a", world.shapes, "shape_a"),
            ("row_b", world.shapes, "shape_b"),
        ):
            assert np.array_equal(after[row], rows_of(table, after[name])), row
        world.step()
