"""Narrow phase: computes the contacts of the candidate pairs in one pass per kind of pair, and runs as a stage."""

import numpy as np

from physics.collision.chains import admit_to_surfaces, collide_chain_pairs
from physics.collision.hull_pairs import (
    collide_aabb_pairs,
    collide_circle_pairs,
    collide_polygon_circle_pairs,
    collide_polygon_pairs,
    speculative_distance,
)
from physics.collision.manifold import (
    AABBS,
    CHAIN_ANY,
    CIRCLES,
    GRID_ANY,
    HULLS,
    MASK_HULL,
    MASKS,
    MASKS_EXACT,
    NOTHING,
    POLYGON_CIRCLE,
    POLYGONS,
    SURFACE_ANY,
    Batch,
    add_manifold,
    boxes_apart,
    center_velocity,
    closing_speed_bound,
    empty_hulls,
    is_before,
    is_of,
    measure_approach,
    new_workspace,
    place_in_order,
)
from physics.collision.mask_parts import drop_opposed, fallback_manifolds
from physics.collision.masks import collide_mask_pairs_full, collide_mask_pairs_hit
from physics.collision.masks_exact import (
    collide_exact_mask_pairs_full,
    collide_exact_mask_pairs_hit,
    collide_mask_hull_pairs,
)
from physics.collision.seams import BodyLists, drop_seams, has_seams
from physics.collision.tiles import collide_grid_pairs_closed, collide_grid_pairs_one_way
from physics.islands.awake import is_active, wakes
from physics.jit import inlined, kernel, subkernel
from physics.shapes.library import Library, draw_masks
from physics.shapes.placement import drawn_beyond, is_drawn_when_asked
from physics.tables.contact import CONTACT
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, PART, TILES
from physics.tables.step_state import COUNTERS, NARROW_TESTS, SENSOR_TESTS, StepState, stage
from physics.tables.table import zeros_in_lines

# ---- box pairs -------------------------------------------------------------------------------------------------------
# Selection of the candidates that a pass reads, and the pass that only compares AABBs.

# Candidates that a call tests. ALL: all. NO_SENSORS: candidates without a sensor. SOLIDS: candidates without a sensor
# whose contact can change in a step. SENSORS: candidates with a sensor.
ALL, NO_SENSORS, SOLIDS, SENSORS = 0, 1, 2, 3


@inlined
def may_change(a, b):
    """Return whether a step can change the contact of two bodies: one of them is active, or wakes the other.

    a, b: BODY rows.
    """
    return is_active(a) or is_active(b) or wakes(a, b) or wakes(b, a)


@inlined
def is_wanted(which, a, b):
    """Return whether the selection `which` accepts a pair of shapes, considering only their sensor flags.

    which: pairs to select: ALL, NO_SENSORS, SOLIDS or SENSORS; a, b: SHAPE rows. The second condition of SOLIDS,
    may_change, is not tested.
    """
    return which == ALL or (a.sensor or b.sensor) == (which == SENSORS)


@subkernel
def is_asked(which, bodies, a, b):
    """Return whether the selection `which` (ALL, NO_SENSORS, SOLIDS or SENSORS) contains a pair of shapes.

    SOLIDS contains a pair only if a step can change its contact, see may_change. a, b: SHAPE rows.
    """
    if not is_wanted(which, a, b):
        return False
    return which != SOLIDS or may_change(bodies[a.body_row], bodies[b.body_row])


@kernel
def collide_boxes(batch, which, manifolds_out, work_inout):
    """Write a contact for each candidate pair whose AABBs overlap. Return the number of contacts. O(candidates).

    The normal is the axis along which the AABBs overlap least, the point is the middle of the overlap. which: the pairs
    to test: ALL, NO_SENSORS, SOLIDS or SENSORS. manifolds_out: CONTACT rows; work_inout: counters, see COUNTERS; batch:
    input of the pass, a manifold.Batch.
    """
    shapes, candidates = batch.shapes, batch.candidates
    found = 0
    for i in range(batch.count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        if not is_asked(which, batch.bodies, a, b):
            continue
        if a.sensor or b.sensor:
            work_inout[SENSOR_TESTS] += 1
        right = a.max_x - b.min_x
        left = b.max_x - a.min_x
        down = a.max_y - b.min_y
        up = b.max_y - a.min_y
        least = min(min(right, left), min(down, up))
        if least < 0.0:
            continue
        nx, ny = 0.0, -1.0
        if least == right:
            nx, ny = 1.0, 0.0
        elif least == left:
            nx, ny = -1.0, 0.0
        elif least == down:
            ny = 1.0
        x = 0.5 * (max(a.min_x, b.min_x) + min(a.max_x, b.max_x))
        y = 0.5 * (max(a.min_y, b.min_y) + min(a.max_y, b.max_y))
        found = add_manifold(shapes, candidates, i, (nx, ny, x, y, -least, 0.0, 0), manifolds_out, found)
    return found


# ---- classify --------------------------------------------------------------------------------------------------------
# The kind of each candidate pair, which selects its pass.

# Counters after the kinds of pairs: pairs with a part, and pairs with a mask whose raster is drawn for the test.
WITH_CHILD, DRAWN_PAIRS = NOTHING + 1, NOTHING + 2


@inlined
def kind_of_pair(low, high):
    """Return the kind of pair (CIRCLES, POLYGONS, …) of two shapes.

    low, high: kinds of the two shapes (CIRCLE, MASK, …), the smaller number first.
    """
    if low == CIRCLE and high == CIRCLE:
        return CIRCLES
    if low == BOUNDS and high == BOUNDS:
        return AABBS
    # Contacts never move grids and chains, so two of them have no contact.
    if high == CHAIN:
        return CHAIN_ANY if low != TILES and low != CHAIN else NOTHING
    if high == TILES or low == TILES:
        return GRID_ANY if low != high else NOTHING
    if low == MASK and high == MASK:
        return MASKS
    if low == MASK or high == MASK:
        return MASK_HULL
    return POLYGON_CIRCLE if low == CIRCLE else POLYGONS


@inlined
def as_snapped(kind, a, b):
    """Return a pair's kind, refined for masks at exact poses (snap=False) and for one-way surfaces of masks.

    kind: result of kind_of_pair. MASKS becomes MASKS_EXACT if at least one mask has snap=False. CHAIN_ANY becomes
    SURFACE_ANY if the chain is the one-way surface of a mask. Other kinds are returned unchanged. a, b: SHAPE rows.
    """
    if kind == CHAIN_ANY:
        chain = a if a.kind == CHAIN else b
        return SURFACE_ANY if chain.role == PART else kind
    if kind == MASKS:
        return kind if a.snap and b.snap else MASKS_EXACT
    return kind


@inlined
def kind_asked(bodies, a, b, margin, lookahead, which):
    """Return the kind of a candidate pair (CIRCLES, POLYGONS, …); NOTHING if the pair need not be tested.

    a, b: SHAPE rows; margin [px], lookahead [s]: as in Batch; which: pairs to select: ALL, NO_SENSORS, SOLIDS or
    SENSORS.
    """
    if not is_wanted(which, a, b):
        return NOTHING
    kind = as_snapped(kind_of_pair(min(a.kind, b.kind), max(a.kind, b.kind)), a, b)
    if kind == NOTHING or which <= NO_SENSORS:
        return kind
    if which == SENSORS:
        margin += drawn_beyond(bodies[a.body_row], a) + drawn_beyond(bodies[b.body_row], b)
    if boxes_apart(a, b, margin):
        if lookahead <= 0.0 or POLYGONS < kind < GRID_ANY or a.kind == MASK or b.kind == MASK:
            return NOTHING
        p, q = bodies[a.body_row], bodies[b.body_row]
        if lookahead * closing_speed_bound(p, q) <= margin:
            return NOTHING
        _, _, speed = center_velocity(p, q)
        if boxes_apart(a, b, speculative_distance(p, q, speed, margin, lookahead)):
            return NOTHING
    if which == SOLIDS and not may_change(bodies[a.body_row], bodies[b.body_row]):
        return NOTHING
    return kind


@inlined
def is_of_child(a, b):
    """Return whether at least one of two SHAPE rows is a part of a larger shape."""
    return a.parent != a.id or b.parent != b.id


@kernel
def classify(batch, which, kinds_out, counts_out, work_inout):
    """Write the kind of each candidate pair, and the number of pairs of each kind. O(candidates).

    which: pairs to select: ALL, NO_SENSORS, SOLIDS or SENSORS; pairs that are not selected get the kind NOTHING. With
    SOLIDS and SENSORS, pairs whose AABBs are farther apart than batch.margin also get NOTHING, unless they may meet
    within batch.lookahead. counts_out[WITH_CHILD]: number of pairs with a part of a larger shape;
    counts_out[DRAWN_PAIRS]: number of pairs with a mask that must be rasterized first. work_inout: counters, see
    COUNTERS.
    """
    bodies, shapes, candidates = batch.bodies, batch.shapes, batch.candidates
    for i in range(len(counts_out)):
        counts_out[i] = 0
    sensors = 0
    for i in range(batch.count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        kind = kind_asked(bodies, a, b, batch.margin, batch.lookahead, which)
        kinds_out[i] = kind
        counts_out[kind] += 1
        if kind != NOTHING:
            counts_out[WITH_CHILD] += int(is_of_child(a, b))
            counts_out[DRAWN_PAIRS] += int(is_drawn_when_asked(a) or is_drawn_when_asked(b))
            sensors += int(a.sensor or b.sensor)
    work_inout[NARROW_TESTS] += batch.count - counts_out[NOTHING]
    work_inout[SENSOR_TESTS] += sensors


# ---- one-way ground --------------------------------------------------------------------------------------------------
# Contacts of the last step with one-way ground; bodies pass through it from below.


@kernel
def remember_ground(batch, previous, memory_out):
    """Find the contacts of the last step of each candidate pair with a tile grid or one-way surface.

    These contacts show which bodies stood on one-way ground. previous: CONTACT rows of the last step, sorted by shape
    ids like the candidates; memory_out (count, 2): for each pair, the first row in `previous` and the number of rows.
    O(candidates + previous). batch: input of the pass, a manifold.Batch.
    """
    j = 0
    for i in range(batch.count):
        memory_out[i, 0] = 0
        memory_out[i, 1] = 0
        if batch.kinds[i] != GRID_ANY and batch.kinds[i] != SURFACE_ANY:
            continue
        a = batch.shapes[batch.candidates[i, 0]].id
        b = batch.shapes[batch.candidates[i, 1]].id
        while j < len(previous) and is_before(previous[j], a, b):
            j += 1
        last = j
        while last < len(previous) and is_of(previous[last], a, b):
            last += 1
        memory_out[i, 0] = j
        memory_out[i, 1] = last - j


# ---- dispatch --------------------------------------------------------------------------------------------------------
# From candidate pairs to contacts: one pass per kind of pair, which is called only if such pairs exist.


class NarrowPhase:
    """Narrow phase of one world, with arrays that are reused between steps.

    full_masks: True to compute area, normal and depth of pairs of masks, False to find only whether they overlap.
    one_way: whether the world has one-way ground. boxes_only: True to compute contacts from AABBs alone. The attribute
    skin [px], see Batch, is 0 unless a solver keeps bodies apart.
    """

    def __init__(self, full_masks: bool, one_way: bool, boxes_only: bool) -> None:
        self.boxes_only, self.one_way, self.skin = boxes_only, one_way, 0.0
        masks = collide_mask_pairs_full if full_masks else collide_mask_pairs_hit
        exact = collide_exact_mask_pairs_full if full_masks else collide_exact_mask_pairs_hit
        grids = collide_grid_pairs_one_way if one_way else collide_grid_pairs_closed
        self.passes = (
            (CIRCLES, collide_circle_pairs),
            (POLYGON_CIRCLE, collide_polygon_circle_pairs),
            (POLYGONS, collide_polygon_pairs),
            (AABBS, collide_aabb_pairs),
            (MASKS, masks),
            (MASKS_EXACT, exact),
            (MASK_HULL, collide_mask_hull_pairs),
            (GRID_ANY, grids),
            (CHAIN_ANY, collide_chain_pairs),
        )
        self.workspace = new_workspace()
        self.kinds = np.zeros(64, np.int64)
        self.counts, self.deep = np.zeros(DRAWN_PAIRS + 1, np.int64), np.zeros(64, bool)
        self.lists = self.ground = BodyLists(np.zeros(0, np.int64), np.zeros(0, np.int64))
        self.raw, self.ordered, self.last_raw, self.last_ordered = (zeros_in_lines(64, CONTACT) for _ in range(4))

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
    ) -> np.ndarray:
        """Return the CONTACT rows of the candidate pairs, in the order of the candidates.

        The result is a view. The next call leaves it valid, the call after that overwrites it. Masks are first
        rasterized at the poses of their bodies, see physics/shapes/library.py. candidates (n, 2): int64 row numbers in
        SHAPE; margin [px]: largest gap of a contact; work: counters of work done; which: pairs to select: ALL,
        NO_SENSORS, SOLIDS or SENSORS; bias [px]: as in hulls.collide_hulls; previous: CONTACT rows of the last step,
        used for one-way ground, or None.
        """
        self.raw, self.last_raw = self.last_raw, self.raw
        self.ordered, self.last_ordered = self.last_ordered, self.ordered
        batch = self.batch_of(library, bodies, shapes, candidates, float(margin), float(bias), 0.0, 0.0)
        if self.boxes_only:
            return self.find_boxes(batch, which, work)
        classify(batch, which, self.kinds, self.counts, work)
        if self.counts[DRAWN_PAIRS]:
            draw_masks(library, np.unique(candidates[self.kinds[: batch.count] != NOTHING]), bodies, shapes)
            batch = batch._replace(geometry=library.tables)
        return self.complete(batch, previous, 0, work)

    def batch_of(
        self,
        library: Library,
        bodies: np.ndarray,
        shapes: np.ndarray,
        candidates: np.ndarray,
        margin: float,
        bias: float,
        graze: float,
        lookahead: float,
    ) -> Batch:
        """Return the Batch of the given candidates, with room for their kinds. Arguments as in `collide` and Batch."""
        count = len(candidates)
        self._make_room_for_pairs(count)
        lists = library.tables, bodies, shapes, candidates, self.kinds
        return Batch(*lists, count, margin, bias, graze, lookahead, self.skin)

    def find_boxes(self, batch: Batch, which: int, work: np.ndarray) -> np.ndarray:
        """Return the CONTACT rows of the candidates, computed from AABBs alone, see collide_boxes.

        which: pairs to select: ALL, NO_SENSORS, SOLIDS or SENSORS; work: counters of work done.
        """
        found = self._with_room(work, lambda: collide_boxes(batch, which, self.raw, work))
        return self.raw[:found]  # self.raw is a new, larger table if the old one was too small

    def complete(self, batch: Batch, previous: np.ndarray | None, recycled: int, work: np.ndarray) -> np.ndarray:
        """Test all pairs that `classify` has selected. Return the CONTACT rows in the order of the candidates.

        recycled: number of contacts reused from the last step without a test. The caller has written them to the first
        rows of self.raw, and they are part of the result. previous: CONTACT rows of the last step, or None; work:
        counters of work done; batch: input of the pass, a manifold.Batch.
        """
        workspace, counts = self.workspace, self.counts
        if self.one_way and (counts[GRID_ANY] or counts[SURFACE_ANY]):
            remembered = previous is not None and len(previous) > 0
            workspace = self._remember(batch, previous) if remembered else workspace
            if counts[SURFACE_ANY]:
                admit_to_surfaces(batch, remembered, workspace, self.kinds, counts)
        counts, found, orders = counts.tolist(), recycled, int(recycled > 0)
        if any(counts[:NOTHING]):
            found, parts = self._detect(batch, workspace, previous, counts, recycled, work)
            orders += parts
        if counts[WITH_CHILD]:
            found = drop_opposed(batch.bodies, found, batch.margin, self._deep_for(found), self.raw)
        if batch.graze > 0.0 and has_seams(batch, self.raw, found, workspace):
            found = self._drop_seams(batch, self.raw[:0] if previous is None else previous, found)
        if orders < 2:
            return self.raw[:found]
        if len(self.ordered) < len(self.raw):
            self.ordered = zeros_in_lines(len(self.raw), CONTACT)
        place_in_order(self.raw, found, batch.count, self.kinds, self.ordered)
        return self.ordered[:found]

    def _detect(self, batch, workspace, previous, counts, recycled, work) -> tuple[int, int]:
        """Test all candidates. Return (number of contacts including the recycled ones, number of passes).

        There is one pass for each kind of pair, such as polygon against circle. Pairs that a pass cannot decide go to a
        fallback, which counts as a pass if it added a contact. The contacts of a single pass are in the order of the
        candidates, so the caller need not sort them.

        recycled: number of contacts reused from the last step. They are the first rows of self.raw, and new contacts
        follow them. batch: the candidates, a manifold.Batch; counts: number of pairs of each kind; previous: CONTACT
        rows of the last step, or None; workspace: scratch memory; work: counters of work done.
        """
        used = [run for kind, run in self.passes if counts[kind]]
        if len(workspace.fallback) < batch.count + 1:
            workspace = workspace._replace(fallback=np.zeros(2 * batch.count + 1, np.int64))
            self.workspace = self.workspace._replace(fallback=workspace.fallback)

        if counts[POLYGONS] or counts[POLYGON_CIRCLE] or counts[AABBS]:
            workspace = self._without_hulls(workspace, len(batch.shapes))

        def run_all():
            found = recycled
            workspace.fallback[0] = 0
            for run in used:
                found = run(batch, workspace, self.raw, found, work)
            return found

        found = self._with_room(work, run_all)
        if not workspace.fallback[0]:
            return found, len(used)
        before = self.raw[:0] if previous is None else previous
        rest = fallback_manifolds(batch, self.raw[:found], before, workspace)
        self._make_room(found + len(rest))
        self.raw[found : found + len(rest)] = rest
        return found + len(rest), len(used) + (len(rest) > 0)

    def _without_hulls(self, workspace, shapes):
        """Clear the cache of hulls in the workspace, and return the workspace.

        shapes: number of shapes for which the cache gets room.
        """
        if len(workspace.hull_rows) < min(shapes, HULLS):
            hulls, rows = empty_hulls(min(HULLS, 1 << (2 * shapes).bit_length()))
            workspace = workspace._replace(hulls=hulls, hull_rows=rows)
            self.workspace = self.workspace._replace(hulls=hulls, hull_rows=rows)
        workspace.hull_rows.fill(-1)
        return workspace

    def _remember(self, batch, previous):
        """Add the contacts of the last step on one-way ground to the workspace, and return the workspace.

        See remember_ground. previous: CONTACT rows of the last step; batch: input of the pass, a manifold.Batch.
        """
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
        """Return a bool scratch array for at least `count` contacts, for the flags of drop_opposed."""
        if len(self.deep) < count:
            self.deep = np.zeros(2 * count, bool)
        return self.deep

    def _drop_seams(self, batch, previous, found) -> int:
        """Drop ghost contacts at seams between flush pieces of ground. Return the number of remaining contacts.

        found: number of contacts in self.raw before the call; previous: CONTACT rows of the last step; batch: input of
        the pass, a manifold.Batch.
        """
        bodies, rows = len(batch.bodies), found + len(previous)
        rows = max(rows, batch.count)
        if len(self.lists.heads) < bodies or len(self.lists.links) < rows:
            self.lists, self.ground = (
                BodyLists(np.zeros(2 * bodies, np.int64), np.zeros(2 * rows, np.int64)) for _ in range(2)
            )
        return drop_seams(batch, previous, found, self.workspace, self.lists, self.ground, self.raw)

    def room_for(self, count: int) -> np.ndarray:
        """Return self.raw, enlarged to at least `count` CONTACT rows.

        The caller writes contacts that are reused from the last step without a test to the first rows. The caller then
        passes the number of these contacts to the next call of `complete` as `recycled`.
        """
        self._make_room(count)
        return self.raw

    def _make_room(self, count):
        if count > len(self.raw):
            kept = self.raw
            self.raw = zeros_in_lines(2 * count, CONTACT)
            self.raw[: len(kept)] = kept  # recycled manifolds may be at the beginning


def no_work() -> np.ndarray:
    """Return a new array of work counters, for calls of the narrow phase whose work is not counted."""
    return np.zeros(len(COUNTERS), np.int64)


# ---- detect ----------------------------------------------------------------------------------------------------------
# The narrow phase as a stage of worlds without a contact cache, at the final poses.

PLACE = ("count", "normal_x", "normal_y", *(f"{name}_{k}" for k in (1, 2) for name in ("x", "y", "separation", "area")))
BIAS = 0.1  # bias of hulls.collide_hulls, as a share of the slop
GRAZE = 1.5  # Batch.graze, in slops; more than the one slop by which a resting body may overlap the floor
SKIN = 0.5  # Batch.skin, in slops: more than a line sinks under its load, and too little to be seen


def detect(state: StepState) -> np.ndarray:
    """Return the CONTACT rows at the present poses, with approach speeds.

    state.contact_rows must hold the contacts of the last step. In worlds with contact response, pairs with sensors are
    omitted, because the stage `sense` tests them at the final poses.
    """
    slop = state.tolerances.slop
    narrow = state.workspace.narrow
    manifolds = narrow.collide(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows,
        slop,
        state.work,
        which=NO_SENSORS if state.effects.response else ALL,
        bias=BIAS * slop,
        previous=state.contact_rows,
    )
    measure_approach(state.bodies, manifolds)
    return manifolds


def place_swept_contacts(state: StepState, met: np.ndarray) -> None:
    """Recompute points, normals and separations of swept contacts at the present poses.

    met: CONTACT rows of the swept contacts, updated in place; a row stays unchanged if the narrow phase finds no
    contact with a similar normal.
    """
    found = state.workspace.narrow.collide(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows[met["candidate"]],
        state.tolerances.slop,
        state.work,
        bias=BIAS * state.tolerances.slop,
    )
    pair = found["candidate"]
    alike = met["normal_x"][pair] * found["normal_x"] + met["normal_y"][pair] * found["normal_y"]
    # If a pair touches at several points, the contact with the normal most similar to the sweep's is used.
    best = np.lexsort((-alike, pair))
    best = best[np.unique(pair[best], return_index=True)[1]]
    best = best[alike[best] > 0.0]
    for name in PLACE:
        met[name][pair[best]] = found[name][best]


@stage(
    "narrow_phase",
    reads=("effects", "tolerances", "bodies", "shapes", "library", "pairs", "contact_rows", "workspace"),
    writes=("contact_rows", "work", "workspace"),
)
def detect_ended(state: StepState) -> None:
    """Write the contacts at the final poses of the step to state.contact_rows, in worlds without a contact cache."""
    state.contact_rows = detect(state)
