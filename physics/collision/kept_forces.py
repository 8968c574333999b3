"""Contact forces across a shape replacement: they are transferred where the new surface coincides with the old one.

Feature ids are valid for one shape only, so no cached contact matches the new one. The new shape is tested at once.
Each new point takes the forces of the old point at the same place with the same normal direction.
"""

import numpy as np

from physics.collision.cache import carry_over
from physics.collision.narrow_phase import BIAS, SOLIDS, no_work
from physics.islands.sleep import order_of
from physics.shapes.placement import refresh_aabbs
from physics.tables.contact import ANCHOR, MANIFOLD
from physics.tables.shape import CHAIN, PIXELS
from physics.tables.step_state import WorldTables
from physics.tables.table import joined, rows_of

ALIKE = (
    0.9  # smallest cosine between normals that count as equal: an outline that is smoothed again turns them a little
)


class KeptForces:
    """The contacts of SHAPE rows that are about to be removed; empty in worlds without stacking."""

    def __init__(self, tables: WorldTables, rows: np.ndarray) -> None:
        found = tables.manifolds
        self.manifolds, self.anchors = found[:0], tables.anchors[:0]
        if len(rows) and len(tables.anchors) == len(found) > 0:
            going = np.zeros(len(tables.shapes), bool)
            going[rows] = True
            # Rows are those of the last step: shapes added since come after them; removed ones took their contacts.
            at_a = going[found["row_a"]]
            kept = np.flatnonzero(at_a | going[found["row_b"]])
            if len(kept):
                self.manifolds, self.anchors = found[kept], tables.anchors[kept]
                self.others = np.unique(np.where(at_a, found["shape_b"], found["shape_a"])[kept])

    def hand_on(self, tables: WorldTables, new: np.ndarray) -> None:
        """Transfer the kept forces to the contacts of new SHAPE rows, after the old rows are removed. O(pairs)."""
        if not len(self.manifolds):
            return
        shapes = tables.shapes
        rows, others = new[shapes["role"][new] != PIXELS], rows_of(shapes, self.others)
        others = others[others >= 0]
        refresh_aabbs(rows, tables.library.tables, tables.bodies, shapes)
        pairs = np.array([sorted((row, other)) for row in rows.tolist() for other in others.tolist()], np.int64)
        if not len(pairs):
            return
        pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
        slop, speculative = tables.tolerances.slop, tables.tolerances.speculative
        found = tables.workspace.narrow.collide(
            tables.library,
            tables.bodies,
            shapes,
            pairs,
            speculative,
            no_work(),
            which=SOLIDS,
            bias=BIAS * slop,
            previous=self._stood_on(shapes, pairs),
        )
        manifolds, anchors = np.zeros(len(found), MANIFOLD), np.zeros(len(found), ANCHOR)
        none = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR), np.zeros(0, np.int32)
        carry_over(tables.library.tables, tables.bodies, shapes, *none, found, manifolds, anchors)
        for manifold, anchor in zip(manifolds, anchors, strict=True):
            for k in range(1, int(manifold["count"]) + 1):
                self._take(manifold, anchor, k, speculative)
        known = joined([tables.manifolds, manifolds])
        order = order_of(known)
        tables.manifolds, tables.anchors = known[order], joined([tables.anchors, anchors])[order]

    def _stood_on(self, shapes, pairs):
        """Return a manifold for each new surface and each body on the old one: it stays on it, however deep."""
        some = shapes[pairs[(shapes["kind"][pairs] == CHAIN).any(axis=1)]]
        found = np.zeros(len(some), MANIFOLD)
        found["shape_a"], found["shape_b"] = some["id"].T
        return found

    def _take(self, manifold, anchor, k, reach):
        """Copy the forces of the nearest old point, within reach [px], to point k of a new manifold."""
        old = self.manifolds
        same = (old["body_a"] == manifold["body_a"]) & (old["body_b"] == manifold["body_b"])
        swapped = (old["body_a"] == manifold["body_b"]) & (old["body_b"] == manifold["body_a"])
        along = old["normal_x"] * manifold["normal_x"] + old["normal_y"] * manifold["normal_y"]
        fits = np.where(swapped & ~same, -along, along) > ALIKE
        best = (np.inf, -1, 0)
        for point in (1, 2):
            there = fits & (same | swapped) & (old["count"] >= point)
            gap = np.hypot(old[f"x_{point}"] - manifold[f"x_{k}"], old[f"y_{point}"] - manifold[f"y_{k}"])
            for at in np.flatnonzero(there & (gap <= reach)).tolist():
                best = min(best, (float(gap[at]), at, point))
        _, at, point = best
        if at >= 0:
            for name in ("normal_force", "tangent_force"):
                anchor[f"{name}_{k}"] = self.anchors[f"{name}_{point}"][at]
            if k == point == 1:
                anchor["rolling_force"] = self.anchors["rolling_force"][at]
