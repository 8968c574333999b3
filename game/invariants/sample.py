"""Samples of the candidate pairs of a step, as shapes with poses for collision queries.

The sample differs in each step.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from game.invariants.step import Step
from physics import PixelMask, TileGrid, World
from physics.shapes.shape import Shape
from physics.shapes.values import Convex

PAIRS = 2  # checked in a step; a concave one counts for two: it takes ten times as long or more
TRIES = 8  # candidates examined to find them
LARGEST = 1 << 16  # pixels or tiles of a shape that is checked: a moon of 4096 x 1024 px takes a second

Pose = tuple[float, float, float]


class Pair(NamedTuple):
    """Two shapes that may touch, with their poses and the ids of their bodies.

    size: greatest coordinate of the poses plus the extents of the bodies [px]. Rounding errors are proportional to it.
    """

    body_a: int
    body_b: int
    shape_id_a: int
    shape_id_b: int
    shape_a: Shape
    pose_a: Pose
    shape_b: Shape
    pose_b: Pose
    size: float

    @property
    def bodies(self) -> tuple[int, int]:
        """Ids of the two bodies."""
        return self.body_a, self.body_b

    @property
    def hulls(self) -> bool:
        """Whether both shapes are convex and rotate with their bodies."""
        return isinstance(self.shape_a, Convex) and isinstance(self.shape_b, Convex)

    @property
    def small(self) -> bool:
        """Whether neither shape is a mask or a tile grid of more than LARGEST pixels or tiles."""
        return max(extent_of(self.shape_a), extent_of(self.shape_b)) <= LARGEST

    @property
    def same(self) -> bool:
        """Whether A and B are the same shape at the same pose."""
        return self.pose_a == self.pose_b and self.shape_a == self.shape_b


def sample(step: Step, turn: int, concave: bool) -> Iterator[Pair]:
    """Yield up to PAIRS of the candidate pairs of a step, each as a Pair. `turn` selects the pairs.

    turn: number of checks so far; concave: whether pairs with concave shapes are included.
    """
    world = step.world
    rows = world.pairs.rows
    if not len(rows):
        return
    room, seen = PAIRS, set()
    for k in range(min(TRIES, len(rows))):
        owners = world.shapes["parent"][rows[(turn * PAIRS + k) % len(rows)]]
        ids = int(owners.min()), int(owners.max())
        if ids in seen:
            continue
        seen.add(ids)
        pair = pair_of(world, *ids)
        if pair is None or not (pair.hulls or concave and pair.small):
            continue
        yield pair
        room -= 1 if pair.hulls else PAIRS
        if room <= 0:
            return


def pair_of(world: World, shape_a: int, shape_b: int) -> Pair | None:
    """Return the Pair of the shapes with these ids.

    Return None if one of the bodies is disabled or one of the poses is not finite.
    """
    found_a, found_b = placed(world, shape_a), placed(world, shape_b)
    if found_a is None or found_b is None:
        return None
    (body_a, one, pose_a, reach_a), (body_b, two, pose_b, reach_b) = found_a, found_b
    if not np.isfinite((*pose_a, *pose_b)).all():
        return None
    size = max(map(abs, (*pose_a[:2], *pose_b[:2]))) + reach_a + reach_b
    return Pair(body_a, body_b, shape_a, shape_b, one, pose_a, two, pose_b, size)


def extent_of(shape: Shape) -> int:
    """Return the number of pixels of a mask, or the number of tiles of a tile grid; 1 for other shapes.

    Empty pixels and tiles are included.
    """
    if isinstance(shape, PixelMask):
        return shape.size[0] * shape.size[1]
    return shape.solid.size if isinstance(shape, TileGrid) else 1


def placed(world: World, shape_id: int) -> tuple[int, Shape, Pose, float] | None:
    """Return (body id, shape, pose, reach) of the shape with the id `shape_id`; None if its body is disabled.

    reach: an upper bound of the distance of the body's points from the body's position [px].
    """
    shapes, bodies = world.shapes, world.bodies
    at = int(np.searchsorted(shapes["id"], shape_id))
    row = int(shapes["body_row"][at])
    if bodies["quarantined"][row]:
        return None
    body = world.body(int(bodies["id"][row]))
    shape = body.shapes[body.shape_ids.index(shape_id)]
    pose = bodies["x"].item(row), bodies["y"].item(row), bodies["angle"].item(row)
    center = abs(bodies["local_center_x"].item(row)) + abs(bodies["local_center_y"].item(row))
    return body.id, shape, pose, bodies["extent"].item(row) + center
