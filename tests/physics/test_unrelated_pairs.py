"""The contacts of a deeply overlapping mask do not depend on the kinds of a pair of shapes far away."""

import numpy as np
import pytest

from physics import Circle, PixelMask, Polygon, TileGrid, World

FAR = 5000.0
FAR_SHAPES = {"boxes": Polygon.box(10, 10), "discs": Circle(5), "masks": PixelMask.from_array(np.ones((10, 10), bool))}
CELLS = np.array([[1, 1, 0, 1, 1, 0, 1, 0, 1, 1], [1, 0, 1, 0, 0, 1, 0, 0, 1, 1]], bool)


def ground(kind):
    """Return the shape of the ground: tiles with gaps, or a mask of the same cells."""
    if kind == "tiles":
        return TileGrid(CELLS, 16)
    return PixelMask.from_array(np.repeat(np.repeat(CELLS, 16, axis=0), 16, axis=1), snap=False)


def mover(kind):
    """Return the shape of a kind that starts inside the ground."""
    if kind == "mask":
        return PixelMask.from_array(np.ones((60, 26), bool), snap=False)
    if kind == "ring":
        solid = np.ones((30, 30), bool)
        solid[8:22, 8:22] = False
        return PixelMask.from_array(solid, snap=False)
    return Circle(12) if kind == "disc" else Polygon.box(26, 40)


def path(ground_kind, mover_kind, phase, far, solver):
    """Return the poses in 60 steps of a body that starts inside the ground. far: kind of the distant pair, or None."""
    world = World(solver=solver)
    world.add_body(ground(ground_kind), position=(-80, 88), kind="static")
    body = world.add_body(mover(mover_kind), position=(-47.0 + phase, 80.0), velocity=(0, 60), angle=0.07 * phase)
    if far is not None:
        world.add_body(FAR_SHAPES[far], position=(FAR, 0.0))
        world.add_body(FAR_SHAPES[far], position=(FAR + 9.0, 0.0), kind="static")
    poses = []
    for _ in range(60):
        world.step()
        poses.append((*body.position, body.angle))
    return poses


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("phase", [0.0, 2.3, 7.1, 11.6])
@pytest.mark.parametrize("mover_kind", ["mask", "ring", "disc", "box"])
@pytest.mark.parametrize("ground_kind", ["tiles", "mask"])
def test_a_far_pair_changes_no_path(ground_kind, mover_kind, phase, solver):
    alone = np.array(path(ground_kind, mover_kind, phase, None, solver))
    for far in FAR_SHAPES:
        # Other lanes sum in another order, so only rounding may differ.
        np.testing.assert_allclose(path(ground_kind, mover_kind, phase, far, solver), alone, rtol=0, atol=1e-6)
