"""From candidate pairs to contacts: one pass per kind of pair, called only when such pairs are there."""

from typing import NamedTuple

import numpy as np

from physics.collision.box_pairs import ALL, SOLIDS, collide_boxes
from physics.collision.carry_over import copy_kept
from physics.collision.chain_pairs import collide_chain_pairs
from physics.collision.classify import DRAWN_PAIRS, PARTED, classify
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
from physics.shapes.library import Library
from physics.shapes.rasters import draw_masks
from physics.tables.counters import COUNTERS
from physics.tables.lines import zeros_in_lines
from physics.tables.manifold import MANIFOLD


class Found(NamedTuple):
    """What became of the manifolds of the step before, and what was found beside those that are used again."""

    rows: np.ndarray  # MANIFOLD, in the order of their candidates: until the next call
    stale: np.ndarray  # int32 rows of those before that are not used again where they stand, ascending


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
        self.counts, self.deep = np.zeros(DRAWN_PAIRS + 1, np.int64), np.zeros(64, bool)
        self.raw, self.ordered, self.last_raw, self.last_ordered = (zeros_in_lines(64, MANIFOLD) for _ in range(4))
        self.stale = np.zeros(64, np.int32)

    def collide(
        self,
        library: Library,
        bodies: np.ndarray,
        shapes: np.ndarray,
        candidates: np.ndarray,
        margin: float,
        work: np.ndarray,
        which: int = ALL,
        bias: float = 0.0,
        previous: np.ndarray | None = None,
        graze: float = 0.0,
        ahead: float = 0.0,
    ) -> np.ndarray:
        """Manifolds of the candidate pairs, in their order: a view that the call after the next one overwrites.

        The masks among them are drawn at the poses of their bodies, see rasters.py. candidates (n, 2) int64 shape rows;
        margin [px]: pairs apart by at most that are found too; work: counters; which: see classify; bias [px]: see
        hulls.collide_hulls. previous: manifolds of the step before, which tell who stood on what is open from below.
        graze [px], ahead [s]: see Batch.
        """
        self.raw, self.last_raw = self.last_raw, self.raw
        self.ordered, self.last_ordered = self.last_ordered, self.ordered
        count = len(candidates)
        self._make_room_for_pairs(count)
        margin, bias, graze, ahead = float(margin), float(bias), float(graze), float(ahead)
        batch = Batch(library.tables, bodies, shapes, candidates, self.kinds, count, margin, bias, graze, ahead)
        if self.boxes_only:
            return self._boxes(batch, which, work)
        classify(bodies, shapes, candidates, count, margin, ahead, which, self.kinds, self.counts, work)
        if self.counts[DRAWN_PAIRS]:
            draw_masks(library, np.unique(candidates[self.kinds[:count] != NOTHING]), bodies, shapes)
            batch = batch._replace(geometry=library.tables)
        return self._complete(batch, previous, 0, work)

    def update(
        self,
        library: Library,
        bodies: np.ndarray,
        shapes: np.ndarray,
        candidates: np.ndarray,
        margin: float,
        work: np.ndarray,
        bias: float,
        graze: float,
        ahead: float,
        previous: np.ndarray,
        anchors: np.ndarray,
        recycle: float,
    ) -> Found | None:
        """As `collide` of what is solid, but manifolds of the step before whose points moved by no more than `recycle`
        [px] follow their bodies where they stand: previous, with their anchors. What else is found stands beside them;
        None: nothing else, and all of them follow.
        """
        count = len(candidates)
        self._make_room_for_pairs(count)
        batch = Batch(library.tables, bodies, shapes, candidates, self.kinds, count, margin, bias, graze, ahead)
        if len(self.stale) < len(previous):
            self.stale = np.zeros(2 * len(previous), np.int32)
        if self.boxes_only:
            return Found(self._boxes(batch, SOLIDS, work), self._all_stale(previous))
        left, asking = recycle_manifolds(batch, recycle, previous, anchors, self.kinds, self.counts, self.stale, work)
        if not (left or asking):
            return None
        stale = self.stale[:left]
        again = 0
        if left < len(previous) and self.counts[PARTED]:
            # Parts are told by what the others of their shape tell: all stand together.
            again = len(previous) - left
            self._make_room(again)
            copy_kept(previous, stale, self.raw)
            stale = self._all_stale(previous)
        return Found(self._complete(batch, previous, again, work), stale)

    def _boxes(self, batch, which, work) -> np.ndarray:
        return self.raw[: self._with_room(work, lambda: collide_boxes(batch, which, self.raw, work))]

    def _all_stale(self, previous) -> np.ndarray:
        self.stale[: len(previous)] = np.arange(len(previous))
        return self.stale[: len(previous)]

    def _complete(self, batch, previous, again, work) -> np.ndarray:
        """The manifolds of all pairs whose kinds are counted, in the order of the candidates; `again`: how many there
        are already."""
        workspace, counts = self.workspace, self.counts
        if self.one_way and (counts[GRID_ANY] or counts[SURFACE_ANY]):
            remembered = previous is not None and len(previous) > 0
            workspace = self._remember(batch, previous) if remembered else workspace
            if counts[SURFACE_ANY]:
                admit_to_surfaces(batch, remembered, workspace, self.kinds, counts)
        counts, found, orders = counts.tolist(), again, int(again > 0)
        if any(counts[:NOTHING]):
            found, parts = self._detect(batch, workspace, previous, counts, again, work)
            orders += parts
        if counts[PARTED] and (counts[POLYGONS] or again):
            found = drop_opposed(batch.bodies, found, batch.margin, self._deep_for(found), self.raw)
        if orders < 2:
            return self.raw[:found]
        if len(self.ordered) < len(self.raw):
            self.ordered = zeros_in_lines(len(self.raw), MANIFOLD)
        place_in_order(self.raw, found, batch.count, self.kinds, self.ordered)
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

    def _make_room_for_pairs(self, count):
        if len(self.kinds) < count + 1:
            self.kinds = np.zeros(2 * count + 1, np.int64)

    def _deep_for(self, count) -> np.ndarray:
        """Room for so many flags."""
        if len(self.deep) < count:
            self.deep = np.zeros(2 * count, bool)
        return self.deep

    def _make_room(self, count):
        if count > len(self.raw):
            kept = self.raw
            self.raw = zeros_in_lines(2 * count, MANIFOLD)
            self.raw[: len(kept)] = kept  # what is used again may stand at the beginning


def narrow_phase_for_queries() -> NarrowPhase:
    """A narrow phase that tests shapes exactly and masks for hits alone."""
    return NarrowPhase(full_masks=False, one_way=False, boxes_only=False)


def exact_narrow_phase() -> NarrowPhase:
    """A narrow phase with all that a contact can tell."""
    return NarrowPhase(full_masks=True, one_way=True, boxes_only=False)


def no_work() -> np.ndarray:
    """Counters that nobody reads."""
    return np.zeros(len(COUNTERS), np.int64)
