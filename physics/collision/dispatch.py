"""From candidate pairs to contacts: one pass per kind of pair, called only when such pairs are there."""

import numpy as np

from physics.collision.ahead import reach_of
from physics.collision.approach import nearing
from physics.collision.box_pairs import ALL, SENSORS, SOLIDS, collide_boxes, may_change
from physics.collision.chain_pairs import collide_chain_pairs
from physics.collision.hull_pairs import collide_circle_pairs, collide_polygon_circle_pairs, collide_polygon_pairs
from physics.collision.left_over import drop_opposed, settle_left
from physics.collision.manifold import (
    CHAIN_ANY,
    CIRCLES,
    GRID_ANY,
    MASK_CIRCLE,
    MASK_HULL_EXACT,
    MASK_POLYGON,
    MASKS,
    MASKS_EXACT,
    NOTHING,
    POLYGON_CIRCLE,
    POLYGONS,
    SURFACE_ANY,
    Batch,
    new_workspace,
    place_in_order,
)
from physics.collision.mask_exact_pairs import (
    collide_exact_hull_pairs,
    collide_exact_mask_pairs_full,
    collide_exact_mask_pairs_hit,
)
from physics.collision.mask_pairs import collide_mask_pairs_full, collide_mask_pairs_hit, collide_mask_shape_pairs
from physics.collision.persist import recycle_manifolds, remember_ground
from physics.collision.surfaces import admit_to_surfaces
from physics.collision.tile_pairs import collide_grid_pairs_closed, collide_grid_pairs_one_way
from physics.jit import kernel, subkernel
from physics.tables.counters import COUNTERS, NARROW_TESTS, SENSOR_TESTS
from physics.tables.geometry import Geometry
from physics.tables.manifold import MANIFOLD
from physics.tables.shape import CHAIN, CIRCLE, MASK, PART, TILES

PARTED = NOTHING + 1  # behind the kinds of pairs: where it is counted how many are of parts


@subkernel
def kind_of_pair(low, high):
    """The kind of pair of two shape kinds, the lower first."""
    if low == CIRCLE and high == CIRCLE:
        return CIRCLES
    # Grids and chains carry, and are never moved by what they meet.
    if high == CHAIN:
        return CHAIN_ANY if low != TILES and low != CHAIN else NOTHING
    if high == TILES or low == TILES:
        return GRID_ANY if low != high else NOTHING
    if low == MASK and high == MASK:
        return MASKS
    if low == MASK or high == MASK:
        return MASK_CIRCLE if low == CIRCLE else MASK_POLYGON
    return POLYGON_CIRCLE if low == CIRCLE else POLYGONS


@subkernel
def as_snapped(kind, a, b):
    """The kind of pair of two SHAPE rows, when `kind` is that of their kinds: two snapped masks are met as drawn, and a
    snapped mask by a hull; a mask that is not snapped is met at its exact pose. A chain that is a mask's part is its
    surface."""
    if kind == CHAIN_ANY:
        chain = a if a.kind == CHAIN else b
        return SURFACE_ANY if chain.role == PART else kind
    if kind == MASKS:
        return kind if a.snap and b.snap else MASKS_EXACT
    if kind == MASK_CIRCLE or kind == MASK_POLYGON:
        return kind if a.snap or b.snap else MASK_HULL_EXACT
    return kind


@subkernel
def boxes_apart(a, b, margin):
    """Whether the boxes of two SHAPE rows are further apart than a margin [px]."""
    return (
        a.min_x - margin > b.max_x
        or b.min_x - margin > a.max_x
        or a.min_y - margin > b.max_y
        or b.min_y - margin > a.max_y
    )


@kernel
def classify(
    # read
    bodies,
    shapes,
    candidates,
    count,
    margin,
    ahead,
    which,
    # write
    kind_out,
    counts_out,
    work_inout,
):
    """Write the kind of every candidate pair, how many there are of each, and in how many, counts_out[PARTED], a side
    is a part of another shape. O(candidates).

    which: ALL, or only the SOLIDS of pairs that something can change and whose boxes are within `margin` [px], or meet
    within `ahead` [s], or only the SENSORS. The others are NOTHING.
    """
    for i in range(len(counts_out)):
        counts_out[i] = 0
    sensors = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        sensor = a.sensor or b.sensor
        kind = NOTHING
        if which == ALL or sensor == (which == SENSORS):
            kind = as_snapped(kind_of_pair(min(a.kind, b.kind), max(a.kind, b.kind)), a, b)
        if kind != NOTHING and which != ALL:
            apart = boxes_apart(a, b, margin)
            if apart and ahead > 0.0 and kind <= POLYGONS:
                p = bodies[a.body_row]
                q = bodies[b.body_row]
                _, _, speed = nearing(p, q)
                apart = boxes_apart(a, b, reach_of(p, q, speed, margin, ahead))
            if apart:
                kind = NOTHING
            elif which == SOLIDS and not may_change(bodies[a.body_row], bodies[b.body_row]):
                kind = NOTHING
        kind_out[i] = kind
        counts_out[kind] += 1
        if kind != NOTHING and (a.owner != a.id or b.owner != b.id):
            counts_out[PARTED] += 1
        sensors += int(sensor and kind != NOTHING)
    work_inout[NARROW_TESTS] += count - counts_out[NOTHING]
    work_inout[SENSOR_TESTS] += sensors


class NarrowPhase:
    """Turns candidates into manifolds; keeps the workspace for them from step to step.

    full_masks: area, normal and depth of mask pairs; one_way: what is open from below takes part; boxes_only: stop at
    AABBs.
    """

    def __init__(self, full_masks: bool, one_way: bool, boxes_only: bool) -> None:
        self.boxes_only, self.one_way = boxes_only, one_way
        masks = collide_mask_pairs_full if full_masks else collide_mask_pairs_hit
        exact = collide_exact_mask_pairs_full if full_masks else collide_exact_mask_pairs_hit
        grids = collide_grid_pairs_one_way if one_way else collide_grid_pairs_closed
        self.passes = (
            ((CIRCLES,), collide_circle_pairs),
            ((POLYGON_CIRCLE,), collide_polygon_circle_pairs),
            ((POLYGONS,), collide_polygon_pairs),
            ((MASKS,), masks),
            ((MASK_CIRCLE, MASK_POLYGON), collide_mask_shape_pairs),
            ((MASKS_EXACT,), exact),
            ((MASK_HULL_EXACT,), collide_exact_hull_pairs),
            ((GRID_ANY,), grids),
            ((CHAIN_ANY,), collide_chain_pairs),
        )
        self.workspace = new_workspace()
        self.kinds = np.zeros(64, np.int64)
        self.counts, self.deep = np.zeros(PARTED + 1, np.int64), np.zeros(64, bool)
        self.raw, self.ordered = np.zeros(64, MANIFOLD), np.zeros(64, MANIFOLD)
        self.last_raw, self.last_ordered = np.zeros(64, MANIFOLD), np.zeros(64, MANIFOLD)

    def collide(
        self,
        geometry: Geometry,
        bodies: np.ndarray,
        shapes: np.ndarray,
        candidates: np.ndarray,
        margin: float,
        work: np.ndarray,
        which: int = ALL,
        bias: float = 0.0,
        previous: np.ndarray | None = None,
        anchors: np.ndarray | None = None,
        recycle: float = 0.0,
        graze: float = 0.0,
        ahead: float = 0.0,
    ) -> np.ndarray:
        """Manifolds of the candidate pairs, in their order: a view that the call after the next one overwrites.

        candidates (n, 2) int64 shape rows; margin [px]: pairs apart by at most that are found too; work: counters;
        which: see classify; bias [px]: see hulls.collide_hulls. previous: manifolds of the step before, which tell who
        stood on what is open from below; with their anchors they are used again where nothing moved by more than
        `recycle` [px]. graze [px], ahead [s]: see Batch.
        """
        count = len(candidates)
        self.raw, self.last_raw = self.last_raw, self.raw
        self.ordered, self.last_ordered = self.last_ordered, self.ordered
        if len(self.kinds) < count + 1:
            self.kinds = np.zeros(2 * count + 1, np.int64)
        batch = Batch(
            geometry,
            bodies,
            shapes,
            candidates,
            self.kinds,
            count,
            float(margin),
            float(bias),
            float(graze),
            float(ahead),
        )
        if self.boxes_only:
            return self.raw[: self._with_room(work, lambda: collide_boxes(batch, which, self.raw, work))]
        classify(bodies, shapes, candidates, count, margin, ahead, which, self.kinds, self.counts, work)
        again, workspace = 0, self.workspace
        if previous is not None and len(previous):
            if anchors is not None:
                again = self._recycle(batch, previous, anchors, recycle)
            if self.one_way and (self.counts[GRID_ANY] or self.counts[SURFACE_ANY]):
                workspace = self._remember(batch, previous)
        if self.one_way and self.counts[SURFACE_ANY]:
            admit_to_surfaces(batch, workspace is not self.workspace, workspace, self.kinds, self.counts)
        counts, found, orders = self.counts.tolist(), again, int(again > 0)
        if any(counts[:NOTHING]):
            found, parts = self._detect(batch, workspace, previous, counts, again, work)
            orders += parts
        if counts[PARTED] and (counts[POLYGONS] or again):
            found = drop_opposed(bodies, found, margin, self._deep_for(found), self.raw)
        if orders < 2:
            return self.raw[:found]
        if len(self.ordered) < len(self.raw):
            self.ordered = np.zeros(len(self.raw), MANIFOLD)
        place_in_order(self.raw, found, count, self.kinds, self.ordered)
        return self.ordered[:found]

    def _detect(self, batch, workspace, previous, counts, again, work) -> tuple[int, int]:
        """Add the manifolds of the pairs whose kinds are counted to the first `again` that there are. Returns how many
        there are then, and how many runs of them, each in the order of the candidates, were added."""
        used = [run for kinds, run in self.passes if any(counts[kind] for kind in kinds)]
        if len(workspace.left) < batch.count + 1:
            workspace = workspace._replace(left=np.zeros(2 * batch.count + 1, np.int64))
            self.workspace = self.workspace._replace(left=workspace.left)

        def run_all():
            found = again
            workspace.left[0] = 0
            for run in used:
                found = run(batch, workspace, self.raw, found, work)
            return found

        found = self._with_room(work, run_all)
        if not workspace.left[0]:
            return found, len(used)
        before = self.raw[:0] if previous is None else previous
        rest = settle_left(batch, self.raw[:found], before, workspace)
        self._make_room(found + len(rest))
        self.raw[found : found + len(rest)] = rest
        return found + len(rest), len(used) + (len(rest) > 0)

    def _recycle(self, batch, previous, anchors, distance) -> int:
        """Use manifolds of the step before again, at the beginning of `raw`. Returns their number."""
        if len(previous) > len(self.raw):
            self.raw = np.zeros(2 * len(previous), MANIFOLD)
        return recycle_manifolds(batch, previous, anchors, distance, self.kinds, self.counts, self.raw)

    def _remember(self, batch, previous):
        """The workspace with the previous manifolds of every pair with ground that may be open from below."""
        if len(self.workspace.memory) < batch.count:
            self.workspace = self.workspace._replace(memory=np.zeros((2 * batch.count, 2), np.int64))
        workspace = self.workspace._replace(previous=previous)
        remember_ground(batch, previous, workspace.memory)
        return workspace

    def _with_room(self, work, run):
        before = work.copy()
        found = run()
        if found > len(self.raw):
            self._make_room(found)
            work[:] = before
            found = run()
        return found

    def _deep_for(self, count) -> np.ndarray:
        """Room for so many flags."""
        if len(self.deep) < count:
            self.deep = np.zeros(2 * count, bool)
        return self.deep

    def _make_room(self, count):
        if count > len(self.raw):
            kept = self.raw
            self.raw = np.zeros(2 * count, MANIFOLD)
            self.raw[: len(kept)] = kept  # the recycled ones stand at the beginning


def narrow_phase_for_queries() -> NarrowPhase:
    """A narrow phase that tests shapes exactly and masks for hits alone."""
    return NarrowPhase(full_masks=False, one_way=False, boxes_only=False)


def exact_narrow_phase() -> NarrowPhase:
    """A narrow phase with all that a contact can tell."""
    return NarrowPhase(full_masks=True, one_way=True, boxes_only=False)


def no_work() -> np.ndarray:
    """Counters that nobody reads."""
    return np.zeros(len(COUNTERS), np.int64)
