"""From candidate pairs to contacts: one pass per kind of pair, called only when such pairs are there."""

import numpy as np

from physics.jit import kernel
from physics.narrowphase.contacts import (CIRCLES, GRID_ANY, MASK_CIRCLE, MASK_POLYGON, MASKS, NOTHING, POLYGON_CIRCLE,
                                          POLYGONS, new_scratch, place_in_order)
from physics.narrowphase.grid_pass import collide_grid_pairs_closed, collide_grid_pairs_one_way
from physics.masks.passes import collide_mask_pairs_full, collide_mask_pairs_hit, collide_mask_shape_pairs
from physics.narrowphase.passes import (collide_boxes, collide_circle_pairs, collide_polygon_circle_pairs,
                                        collide_polygon_pairs)
from physics.profile import NARROW_TESTS, SENSOR_TESTS
from physics.tables import CIRCLE, CONTACT, MASK, TILES


@kernel
def classify(
    # read
    shapes, candidates, count,
    # write
    kind_out, counts_out, work_inout,
):
    """Write the kind of every candidate pair, and how many there are of each. O(candidates)."""
    for i in range(len(counts_out)):
        counts_out[i] = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        low = min(a.kind, b.kind)
        high = max(a.kind, b.kind)
        if low == CIRCLE and high == CIRCLE:
            kind = CIRCLES
        elif high == TILES:
            kind = GRID_ANY if low != TILES else NOTHING
        elif high == MASK and low == TILES:
            kind = GRID_ANY
        elif high == MASK and low == MASK:
            kind = MASKS
        elif high == MASK:
            kind = MASK_CIRCLE if low == CIRCLE else MASK_POLYGON
        elif low == CIRCLE:
            kind = POLYGON_CIRCLE
        else:
            kind = POLYGONS
        kind_out[i] = kind
        counts_out[kind] += 1
        work_inout[NARROW_TESTS] += 1
        if a.sensor or b.sensor:
            work_inout[SENSOR_TESTS] += 1


class NarrowPhase:
    """Turns candidates into contacts; keeps the room for them from step to step.

    full_masks: area, normal and depth of mask pairs; one_way: tiles open from below take part; boxes_only: stop at AABBs.
    """

    def __init__(self, full_masks: bool, one_way: bool, boxes_only: bool):
        self.boxes_only = boxes_only
        masks = collide_mask_pairs_full if full_masks else collide_mask_pairs_hit
        grids = collide_grid_pairs_one_way if one_way else collide_grid_pairs_closed
        self.passes = (((CIRCLES,), collide_circle_pairs), ((POLYGON_CIRCLE,), collide_polygon_circle_pairs),
                       ((POLYGONS,), collide_polygon_pairs), ((MASKS,), masks),
                       ((MASK_CIRCLE, MASK_POLYGON), collide_mask_shape_pairs), ((GRID_ANY,), grids))
        self.scratch = new_scratch()
        self.kinds = np.zeros(64, np.int64)
        self.counts = np.zeros(NOTHING + 1, np.int64)
        self.raw, self.ordered = np.zeros(64, CONTACT), np.zeros(64, CONTACT)
        self.last_raw, self.last_ordered = np.zeros(64, CONTACT), np.zeros(64, CONTACT)

    def collide(self, geometry, bodies, shapes, candidates, count, margin, bias, work) -> np.ndarray:
        """Contacts of the candidate pairs, in their order: a view that the call after the next one overwrites.

        candidates (capacity, 2) int64 shape rows, `count` of them used; margin [px]: pairs apart by at most that are
        found too; bias [px]: see sat.collide_polygons; work: counters.
        """
        self.raw, self.last_raw = self.last_raw, self.raw
        self.ordered, self.last_ordered = self.last_ordered, self.ordered
        if self.boxes_only:
            found = self._with_room(work, lambda: collide_boxes(geometry, bodies, shapes, candidates, count, self.raw, work))
            return self.raw[:found]
        if len(self.kinds) < count + 1:
            self.kinds = np.zeros(2 * count + 1, np.int64)
        classify(shapes, candidates, count, self.kinds, self.counts, work)
        used = [run for kinds, run in self.passes if any(self.counts[kind] for kind in kinds)]

        def run_all():
            found = 0
            for run in used:
                found = run(geometry, bodies, shapes, candidates, self.kinds, count, margin, bias, self.scratch, self.raw,
                            found, work)
            return found
        found = self._with_room(work, run_all)
        if len(used) < 2:
            return self.raw[:found]
        if len(self.ordered) < len(self.raw):
            self.ordered = np.zeros(len(self.raw), CONTACT)
        place_in_order(self.raw, found, count, self.kinds, self.ordered)
        return self.ordered[:found]

    def _with_room(self, work, run):
        before = work.copy()
        found = run()
        if found > len(self.raw):
            self.raw = np.zeros(2 * found, CONTACT)
            work[:] = before
            found = run()
        return found
