"""Ray casts and point queries, one or many in a call: a search of candidates in the broad phase, then exact tests.

A long slanted ray is divided into pieces, and the broad phase is searched with the box around each piece. The
candidates of a ray are the shapes that the query admits and whose AABBs the ray crosses. A point is a ray of length 0.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from physics import checks
from physics.annotations import Points
from physics.broadphase.brute_force import search_all
from physics.broadphase.dynamic_tree import search_trees
from physics.broadphase.spatial_hash import search_cells
from physics.broadphase.sweep_and_prune import search_order
from physics.ccd.time_of_impact import MISS
from physics.distance.gjk import copy_part
from physics.jit import kernel, subkernel
from physics.math2d import rotate
from physics.queries.index import ROUNDING, AskedWorld, meets_aabb
from physics.queries.rays import cast_on_disc, cast_on_hull, cast_on_shape, crosses_box
from physics.settings import DRAWN, MASK_ANGLE_BUCKETS, POSITION_LIMIT
from physics.shapes.library import draw_masks
from physics.shapes.placement import cosine_and_sine
from physics.shapes.shape import Filter, Parts, checked_filter, parts_of
from physics.tables.geometry import Geometry
from physics.tables.shape import MASK, PART, PIXELS
from physics.tables.step_state import NARROW_TESTS, PAIRS_TESTED

RAY_PIECES = 16  # greatest number of pieces of a ray …
PIECE = 4.0  # [m] … each of about this width, along the axis on which the ray is shorter

RAY_HIT = np.dtype(
    [  # the first hit of a ray
        ("body", np.int64),  # id of the body that was hit; -1: no hit
        ("shape", np.int64),  # id of the shape; -1: no hit
        ("point_x", np.float64),  # [px] point of the hit; the end of the ray if there is no hit
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit normal of the hit surface; 0 if there is no hit
        ("normal_y", np.float64),
        ("fraction", np.float64),  # fraction of the translation before the hit; 1 if there is no hit
    ]
)
POINT_HIT = np.dtype(
    [  # a body that contains a point
        ("point", np.int64),  # index of the point
        ("body", np.int64),  # id of the body
    ]
)
ROW, FRACTION, HIT_NX, HIT_NY = range(4)  # columns of a hit


class Targets(NamedTuple):
    """The tables of a world in which a search of candidates finds shapes."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE
    row_of_slot: np.ndarray  # see QueryIndex
    loose: np.ndarray  # rows of the shapes that the broad phase may miss


class Workspace(NamedTuple):
    """The candidates of n rays, and the scratch arrays of their search."""

    starts: np.ndarray  # (n + 2,) int64: first candidate of each ray, number of candidates, number of searched boxes
    rows: np.ndarray  # SHAPE rows of the candidates, ray after ray
    boxes: np.ndarray  # (16 n, 4) [px] searched boxes
    slots: np.ndarray  # slots of proxies that the broad phase found
    stamps: np.ndarray  # (shapes,) int64: the ray that was last compared with the shape
    corners: np.ndarray  # (16, 2)


class Admitted(NamedTuple):
    """The conditions for shapes that a query admits, and the parameters of its search."""

    membership: int  # bits of the query's Filter
    mask: int
    sensors: bool  # whether sensors are admitted
    known: bool  # whether the broad phase is searched
    beyond: float  # [px] how far an outline may extend beyond the AABB of its shape
    piece: float  # [px] width of a piece of a ray
    stamp: int  # stamp of the first ray; later rays have the following numbers


class MaskOutlines(NamedTuple):
    """The outlines of masks as convex parts in body space, which ray casts use.

    They are needed because the parts have SHAPE rows of their own only in worlds with the effect `response`.
    """

    first: np.ndarray  # (masks,) int64: first part of each mask, by geometry row
    count: np.ndarray  # (masks,) int64
    parts: Parts


# ---- candidates ------------------------------------------------------------------------------------------------------


@subkernel
def is_admitted(shape, point, admitted):
    """Return whether a query admits a shape (SHAPE row).

    point: True: the query is a point, which is tested against the pixels of masks; False: it is a ray, which is tested
    against the outlines of masks. admitted: an Admitted.
    """
    return (
        shape.role != (PART if point else PIXELS)
        and (shape.membership & admitted.mask) != 0
        and (shape.mask & admitted.membership) != 0
        and (admitted.sensors or not shape.sensor)
    )


@subkernel
def box_around(x, y, dx, dy, margin):
    """Return the box (lower x, lower y, upper x, upper y) [px] around the segment from (x, y) to (x + dx, y + dy).

    The box is enlarged by `margin` [px], and by a share ROUNDING of its coordinates.
    """
    lower_x = min(x, x + dx) - margin
    lower_y = min(y, y + dy) - margin
    upper_x = max(x, x + dx) + margin
    upper_y = max(y, y + dy) + margin
    reach = ROUNDING * max(max(abs(lower_x), abs(lower_y)), max(abs(upper_x), abs(upper_y)))
    return lower_x - reach, lower_y - reach, upper_x + reach, upper_y + reach


@subkernel
def may_hit(x, y, dx, dy, shape, beyond):
    """Return whether a ray crosses the AABB of a shape (SHAPE row), enlarged by `beyond` [px].

    x, y, dx, dy: start and vector of the ray [px].
    """
    return crosses_box(
        x, y, dx, dy, shape.min_x - beyond, shape.min_y - beyond, shape.max_x + beyond, shape.max_y + beyond
    )


def make_candidate_search(search: Any) -> Any:
    """Return a kernel that lists the candidates of rays.

    search: function (box, structure, slots, work) -> count that finds the proxies in a box, such as search_trees.
    """

    @kernel
    def list_candidates(
        # read
        targets,
        rays,
        admitted,
        # write
        structure_inout,
        workspace,
        work_inout,
    ):
        """Write the candidates of each ray to `workspace`, and return their number, even if they do not all fit.

        targets: a Targets; rays: (n, 4) start and vector (x, y, dx, dy) [px]; admitted: an Admitted; structure_inout:
        the argument `structure` of `search`; workspace: a Workspace; work_inout: counters, see COUNTERS. O(pieces ·
        search).
        """
        count = 0
        boxes = 0
        loose, slots, stamps = targets.loose, workspace.slots, workspace.stamps
        for i in range(len(rays)):
            x, y, dx, dy = rays[i, 0], rays[i, 1], rays[i, 2], rays[i, 3]
            point = dx == 0.0 and dy == 0.0
            pieces = 1 + int(min(RAY_PIECES - 1.0, min(abs(dx), abs(dy)) / admitted.piece))
            workspace.starts[i] = count
            for piece in range(pieces):
                share = 1.0 / pieces if pieces > 1 else 1.0
                begin = piece * share
                box = box_around(x + begin * dx, y + begin * dy, share * dx, share * dy, admitted.beyond)
                for side in range(4):
                    workspace.boxes[boxes, side] = box[side]
                boxes += 1
                found = search(box, structure_inout, slots, work_inout) if admitted.known else 0
                work_inout[PAIRS_TESTED] += len(loose)
                for k in range(found + len(loose)):
                    row = loose[k - found] if k >= found else targets.row_of_slot[slots[k]]
                    if row < 0 or stamps[row] == admitted.stamp + i or not meets_aabb(targets.shapes[row], box):
                        continue
                    stamps[row] = admitted.stamp + i
                    s = targets.shapes[row]
                    if is_admitted(s, point, admitted) and (point or may_hit(x, y, dx, dy, s, admitted.beyond)):
                        if count < len(workspace.rows):
                            workspace.rows[count] = row
                        count += 1
        workspace.starts[len(rays)] = count
        workspace.starts[len(rays) + 1] = boxes
        return count

    return list_candidates


SEARCHES = {  # by name of the broad phase
    "brute": make_candidate_search(search_all),
    "sweep": make_candidate_search(search_order),
    "hash": make_candidate_search(search_cells),
    "tree": make_candidate_search(search_trees),
}


# ---- casts -----------------------------------------------------------------------------------------------------------


@subkernel
def cast_on_outline(outlines, mask, body, ray, corners_inout):
    """Cast a ray (x, y, dx, dy) [px] at the outline of a mask. Return (fraction or MISS, nx, ny), see rays.py.

    outlines: a MaskOutlines; mask: geometry row of the mask; body: BODY row; corners_inout: (16, 2) scratch. O(parts).
    """
    cosine, sine = cosine_and_sine(body.angle, body.angle)
    x, y = rotate(ray[0] - body.x, ray[1] - body.y, cosine, -sine)
    dx, dy = rotate(ray[2], ray[3], cosine, -sine)
    parts = outlines.parts
    best = MISS
    best_x, best_y = 0.0, -1.0
    first = outlines.first[mask]
    for k in range(first, first + outlines.count[mask]):
        if not crosses_box(x, y, dx, dy, parts.boxes[k, 0], parts.boxes[k, 1], parts.boxes[k, 2], parts.boxes[k, 3]):
            continue
        count = parts.counts[k]
        copy_part(parts.corners, k, count, corners_inout)
        if count == 1:
            fraction, nx, ny = cast_on_disc(x - corners_inout[0, 0], y - corners_inout[0, 1], dx, dy, parts.radii[k])
        else:
            fraction, nx, ny = cast_on_hull(corners_inout, count, parts.radii[k], x, y, dx, dy)
        if fraction < best:
            best = fraction
            best_x, best_y = nx, ny
    best_x, best_y = rotate(best_x, best_y, cosine, sine)
    return best, best_x, best_y


@subkernel
def write_hit(row, hit, place, hits_out):
    """Write a hit to hits_out[place]. row: SHAPE row number; hit: (fraction, normal x, normal y)."""
    hits_out[place, ROW] = float(row)
    hits_out[place, FRACTION] = hit[0]
    hits_out[place, HIT_NX] = hit[1]
    hits_out[place, HIT_NY] = hit[2]


@kernel
def cast_candidates(
    # read
    targets,
    outlines,
    rays,
    # read, scalars
    nearest,
    # write
    workspace,
    hits_out,
    work_inout,
):
    """Cast rays at their candidates in `workspace`, and write (SHAPE row number, fraction or MISS, nx, ny) of each hit.

    nearest: 1: write the nearest hit of each ray to hits_out (n, 4), with row -1 for no hit and the lowest row of
    equally near hits; 0: write the result for each candidate to hits_out (candidates, 4). targets: a Targets; outlines:
    a MaskOutlines with all masks that a ray of length > 0 may hit; rays: (n, 4) start and vector (x, y, dx, dy) [px];
    workspace: a Workspace; work_inout: counters, see COUNTERS. O(candidates).
    """
    rows = workspace.rows
    for i in range(len(rays)):
        ray = (rays[i, 0], rays[i, 1], rays[i, 2], rays[i, 3])
        by_outline = ray[2] != 0.0 or ray[3] != 0.0
        best_row = -1
        best = (MISS, 0.0, 0.0)
        for k in range(workspace.starts[i], workspace.starts[i + 1]):
            s = targets.shapes[rows[k]]
            work_inout[NARROW_TESTS] += 1
            if s.kind == MASK and by_outline:
                hit = cast_on_outline(outlines, s.geometry, targets.bodies[s.body_row], ray, workspace.corners)
            else:
                hit = cast_on_shape(targets.geometry, targets.bodies, targets.shapes, rows[k], ray, workspace.corners)
            if nearest == 0:
                write_hit(rows[k], hit, k, hits_out)
            elif hit[0] <= 1.0 and (hit[0] < best[0] or (hit[0] == best[0] and rows[k] < best_row)):
                best_row = rows[k]
                best = hit
        if nearest == 1:
            write_hit(best_row, best, i, hits_out)


# ---- queries ---------------------------------------------------------------------------------------------------------


class OutlineStore:
    """The outlines of the masks at which rays were cast, in one MaskOutlines. Outlines are computed when first used."""

    def __init__(self) -> None:
        self.masks: dict[int, Any] = {}  # geometry row of each mask -> the PixelMask
        self.outlines = MaskOutlines(np.zeros(0, np.int64), np.zeros(0, np.int64), parts_of([]))

    def with_all(self, library: Any, rows: list[int]) -> MaskOutlines:
        """Return a MaskOutlines that contains at least the masks `rows`. library: the Library of the world.

        rows: geometry rows of masks.
        """
        masks = library.masks
        if all(self.masks.get(row) is masks[row] for row in rows):
            return self.outlines
        self.masks |= {row: masks[row] for row in rows}
        self.masks = {row: mask for row, mask in self.masks.items() if row < len(masks) and masks[row] is mask}
        parts = [mask._parts for mask in self.masks.values()]
        counts = [len(each.counts) for each in parts]
        first, count = np.zeros(len(masks), np.int64), np.zeros(len(masks), np.int64)
        kept = list(self.masks)
        first[kept], count[kept] = np.cumsum([0, *counts])[:-1], counts
        flat = Parts(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
        self.outlines = MaskOutlines(first, count, flat)
        return self.outlines


class Found(NamedTuple):
    """The result of find_candidates, and the input of `cast`. count: total number of candidates of all rays."""

    targets: Targets
    rays: np.ndarray
    workspace: Workspace
    count: int


def find_candidates(world: AskedWorld, rays: np.ndarray, filter: Filter, sensors: bool) -> Found:
    """Return the candidates of n rays as a Found.

    rays: (n, 4) start and vector (x, y, dx, dy) [px]; filter: Filter of the rays; sensors: whether sensors are
    admitted.
    """
    index = world.queries
    index.begin(world)
    count, known, piece = len(rays), index.asks_broadphase(world), PIECE * world.tolerances.pixels_per_meter
    strategy, proxies = world.broadphase, world.pairs.proxies
    by_name = known and strategy.name in SEARCHES
    search = SEARCHES[strategy.name if by_name else "brute"]
    structure = strategy.structure(proxies) if by_name else (proxies,)
    loose = index.loose[: index.loose_count]
    targets = Targets(world.library.tables, world.bodies, world.shapes, index.row_of_slot, loose)
    starts, rows = np.zeros(count + 2, np.int64), np.zeros(max(64, 8 * count), np.int64)
    beyond = beyond_drawn(world)
    boxes = np.empty((count * RAY_PIECES, 4))  # only the boxes in use are ever touched
    while True:
        stamp = index.next_stamps(count)
        admitted = Admitted(filter.membership, filter.mask, sensors, known, beyond, piece, stamp)
        workspace = Workspace(starts, rows, boxes, index.slots, index.stamps, index.corners)
        found = search(targets, rays, admitted, structure, workspace, index.work)
        if found <= len(rows):
            break
        rows, index.work[:] = np.zeros(found, np.int64), 0
    index.asked = boxes[: starts[count + 1]]
    return Found(targets, rays, workspace, found)


def cast(world: AskedWorld, found: Found, nearest: bool) -> np.ndarray:
    """Cast rays at their candidates, and return rows (SHAPE row number, fraction or MISS, normal x, normal y).

    found: result of find_candidates; nearest: True: one row for each ray, False: one for each candidate, see
    cast_candidates.
    """
    index, rows = world.queries, found.workspace.rows[: found.count]
    if index.outlines is None:
        index.outlines = OutlineStore()
    library, targets, met = world.library, found.targets, index.outlines.outlines
    masks = rows[world.shapes["kind"][rows] == MASK] if library.masks else rows[:0]
    if len(masks):
        directed = found.rays[:, 2:].any(axis=1)
        if directed.any():
            met = index.outlines.with_all(library, np.unique(world.shapes["geometry"][masks]).tolist())
        if not directed.all():
            draw_masks(library, masks, world.bodies, world.shapes)  # for points: the pixels at their present angles
            targets = targets._replace(geometry=library.tables)
    hits = np.zeros((len(found.rays) if nearest else found.count, 4))
    cast_candidates(targets, met, found.rays, int(nearest), found.workspace, hits, index.work)
    return hits


def beyond_drawn(world: AskedWorld) -> float:
    """Return an upper bound [px] of the distance by which outlines of masks extend beyond the masks' drawn pixels.

    The outlines are at the exact poses, and the bound holds for all masks of the world.
    """
    if not world.library.masks or not len(world.bodies):
        return 0.0
    extent = world.bodies["extent"]
    return DRAWN + float(extent[extent < POSITION_LIMIT].max(initial=0.0)) * math.pi / MASK_ANGLE_BUCKETS


def ray_casts(world: AskedWorld, origins: Points, translations: Points, filter: Filter, sensors: bool) -> Any:
    """Return a RAY_HIT row (n,) with the first hit of each of n rays. For arguments and errors see World.ray_casts."""
    origins = checks.positions("origins", origins)
    translations = checks.columns("translations", translations, len(origins), like="origins")
    filter, sensors = checked_filter(filter), checks.flag("sensors", sensors)
    rays = np.concatenate([origins, translations], axis=1)
    hits = cast(world, find_candidates(world, rays, filter, sensors), True)
    rows, found = hits[:, ROW].astype(np.int64), np.zeros(len(rays), RAY_HIT)
    hit = rows >= 0
    found["body"], found["shape"] = -1, -1
    found["body"][hit], found["shape"][hit] = (world.shapes[name][rows[hit]] for name in ("body", "parent"))
    found["fraction"] = fractions = np.where(hit, hits[:, FRACTION], 1.0)
    found["normal_x"], found["normal_y"] = (hits[:, [HIT_NX, HIT_NY]] + 0.0).T
    found["point_x"], found["point_y"] = (origins + fractions[:, None] * translations).T
    return found


def query_points(world: AskedWorld, points: Points, filter: Filter, sensors: bool) -> Any:
    """Return a POINT_HIT row for each pair of a point and a body that contains it, sorted by point, then by body.

    For arguments and errors see World.query_points.
    """
    points = checks.positions("points", points)
    filter, sensors = checked_filter(filter), checks.flag("sensors", sensors)
    rays = np.concatenate([points, np.zeros_like(points)], axis=1)
    asked = find_candidates(world, rays, filter, sensors)
    hits = cast(world, asked, False)
    inside = hits[:, FRACTION] <= 1.0
    owners = world.shapes["body_row"][hits[inside, ROW].astype(np.int64)]
    point = np.repeat(np.arange(len(points)), np.diff(asked.workspace.starts[:-1]))[inside]
    keys = np.unique(point * max(1, len(world.bodies)) + owners)
    found = np.zeros(len(keys), POINT_HIT)
    found["point"], rows = np.divmod(keys, max(1, len(world.bodies)))
    found["body"] = world.bodies["id"][rows]
    return found
