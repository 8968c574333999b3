"""Batch of narrow-phase tests without a world: many pairs of the same two bodies, each pair with its own poses.

A body is one shape or the union of several shapes. The AABB test, which a broad phase would do, runs once when the
batch is created. test() runs only the narrow phase, so its time divided by the number of pairs is the time of one test.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.collision.narrow_phase import NarrowPhase, no_work
from physics.shapes.kinds import checked_shapes
from physics.shapes.library import Library, describe
from physics.shapes.placement import refresh_aabbs
from physics.shapes.shape import Shape
from physics.tables.body import BODY
from physics.tables.contact import CONTACT
from physics.tables.shape import SHAPE


class PairBatch:
    """Batch of n pairs of a body A and a body B. poses_a, poses_b: (n, 3) rows of x [px], y [px], angle [rad].

    The bodies are stored in a random order drawn from `seed`, as in a world after some play. Raises TypeError or
    ValueError for invalid shapes or poses.
    """

    def __init__(
        self,
        shapes_a: Sequence[Shape],
        poses_a: ArrayLike,
        shapes_b: Sequence[Shape],
        poses_b: ArrayLike,
        seed: int = 0,
    ) -> None:
        sides = [
            (checked_shapes("shapes_a", shapes_a), checks.columns("poses_a", poses_a, width=3)),
            (checked_shapes("shapes_b", shapes_b), checks.columns("poses_b", poses_b, width=3)),
        ]
        self.count = len(sides[0][1])
        if len(sides[1][1]) != self.count:
            raise ValueError(f"poses_b must have as many rows as poses_a, {self.count} (got {len(sides[1][1])})")
        self.library, order = Library(), np.random.default_rng(seed).permutation(2 * self.count)
        self.bodies = np.zeros(2 * self.count, BODY)
        self.shapes = np.zeros(self.count * sum(len(shapes) for shapes, _ in sides), SHAPE)
        rows, first = [], 0
        for side, (shapes, poses) in enumerate(sides):
            who = order[side * self.count : (side + 1) * self.count]
            self._place_bodies(who, poses)
            rows.append(first + np.arange(self.count * len(shapes)).reshape(len(shapes), self.count))
            angles = np.unique(poses[:, 2]).tolist()
            for shape in shapes:
                last = first + self.count
                describe(self.library, shape, self.shapes[first:last], np.arange(first, last), who, angles)
                first = last
        refresh_aabbs(np.arange(len(self.shapes)), self.library.tables, self.bodies, self.shapes)
        self.candidates, self.pair_of = self._near(rows[0], rows[1], np.random.default_rng(seed + 1))
        self.narrow_phase = NarrowPhase(full_masks=False, one_way=False, boxes_only=False)
        self.found = np.zeros(0, CONTACT)

    def __len__(self) -> int:
        return self.count

    def _place_bodies(self, who, poses):
        for name, column in zip(("x", "y", "angle"), poses.T, strict=True):
            self.bodies[name][who] = self.bodies[f"previous_{name}"][who] = column
        self.bodies["id"][who] = who

    def _near(self, rows_a, rows_b, rng):
        """Return (rows, pairs) of the pairs of shapes whose AABBs overlap, in random order.

        rows: (m, 2) rows in the table SHAPE, of the shape of A and the shape of B. pairs: (m,) index of the pair of
        bodies that these shapes belong to.

        rows_a: one array for each shape of body A. It contains the shape's row in the table SHAPE for each of the n
        pairs of bodies. rows_b: the same for body B. rng: generator of the random order.
        """
        candidates, pairs = [], []
        for a in rows_a:
            for b in rows_b:
                s, t = self.shapes[a], self.shapes[b]
                meet = (s["min_x"] <= t["max_x"]) & (t["min_x"] <= s["max_x"])
                meet &= (s["min_y"] <= t["max_y"]) & (t["min_y"] <= s["max_y"])
                near = np.flatnonzero(meet)
                candidates.append(np.stack([a[near], b[near]], axis=1))
                pairs.append(near)
        both, owner = np.concatenate(candidates).astype(np.int64), np.concatenate(pairs)
        # The candidates of one pair stay together, as in a list of pairs.
        turn = np.argsort(rng.permutation(self.count)[owner], kind="stable")
        return np.ascontiguousarray(both[turn]), owner[turn]

    def test(self) -> int:
        """Run only the narrow phase, for all pairs. Return the number of manifolds."""
        candidates, work = self.candidates, no_work()
        self.found = self.narrow_phase.collide(self.library, self.bodies, self.shapes, candidates, 0.0, work)
        return len(self.found)

    def met(self) -> np.ndarray:
        """Return (n,) bool: whether each pair of bodies touched in the last test(), in the order of the poses."""
        met = np.zeros(self.count, bool)
        if len(self.found):
            met[self.pair_of[self.found["candidate"]]] = True
        return met
