"""Functions that return the internal state of a World as arrays in world pixels, for debug drawing.

The functions do not change the simulation. They raise TypeError for a `world` that is not a World. Their other
arguments are not checked.
"""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, NamedTuple, TypeVar

import numpy as np

from physics import checks
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.collision.manifold import contacts_of
from physics.queries.index import visited
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes.library import draw_pictures
from physics.tables.body import DYNAMIC
from physics.tables.joint import ANGLE, GEARED, LENGTH, NO_JOINT, SLUNG, WORLD
from physics.tables.shape import BOUNDS, CAPSULE, CHAIN, CIRCLE, MASK, PART, POLYGON, SEGMENT
from physics.world import World

__all__ = [
    "bounds", "contact_points", "drawn_masks", "impact_ghosts", "islands", "joints", "mask_hits", "masks", "motion",
    "outlines", "pairs", "part_edges", "shape_rows", "structure", "visited",
]  # fmt: skip

ROW = np.dtype(
    [
        ("shape", np.int64),  # id
        ("body", np.int64),  # id
        ("kind", np.int64),  # kind of the body: STATIC 0, KINEMATIC 1, DYNAMIC 2
        ("membership", np.int64),  # 32 bits, see Filter
        ("mask", np.int64),  # 32 bits, see Filter
        ("sensor", np.bool_),  # the shape is a sensor: it reports overlaps and does not push
        ("awake", np.bool_),  # the body is awake
    ]
)
LINES = (POLYGON, CAPSULE, SEGMENT, CHAIN)
Called = TypeVar("Called", bound=Callable[..., Any])


def _of_world(function: Called) -> Called:
    """Decorate a function, so that it raises TypeError if its first argument is not a World."""

    @wraps(function)
    def checked(world: Any, *args: Any, **given: Any) -> Any:
        if not isinstance(world, World):
            raise TypeError(
                f"world must be a World (got {checks.shown(world)}): write debug.{function.__name__}(world)"
            )
        return function(world, *args, **given)

    return checked  # pyright: ignore[reportReturnType]


class Structure(NamedTuple):
    """The data structure of a broad phase, for drawing: boxes of grid cells or tree nodes, or intervals on two axes.

    kind: the broad phase, "brute", "sweep", "hash" or "tree".
    rects: (m, 4) boxes of cells or nodes: min_x, min_y, max_x, max_y [px]; empty for "brute" and "sweep".
    depth: (m,) level of each grid cell in `rects`, or depth of each tree node.
    intervals: (k, 4) intervals of shapes for "sweep": axis (0: x, 1: y), low, high [px], shape id; otherwise empty.
    """

    kind: str
    rects: np.ndarray
    depth: np.ndarray
    intervals: np.ndarray


EDGE = np.dtype(
    [
        ("row", np.int64),  # row of the part in world.shapes
        ("ax", np.float64),  # [px] start of the edge, clockwise to b; a rounded surface lies `radius` outside
        ("ay", np.float64),
        ("bx", np.float64),
        ("by", np.float64),
        ("radius", np.float64),  # [px] rounding of the part
        ("inner", np.bool_),  # the edge is inside the outline: no body is pushed out through it
        ("covered", np.bool_),  # the start of the edge is a corner inside the outline
    ]
)
CORNERS = 16  # bits of `inner` in SHAPE: edges below bit 16, corners from bit 16 on


DRAWN_JOINT = np.dtype(
    [
        ("joint", np.int64),  # id
        ("body_a", np.int64),  # ids of the bodies; -1: the world
        ("body_b", np.int64),
        ("kind", np.int64),  # index in physics.joints.kinds.KINDS
        ("coordinate", np.int64),  # NO_COORDINATE ANGLE TRANSLATION LENGTH of tables/joint.py
        ("hold", np.int64),  # FREE PINNED ON_AXIS TOOTHED GEARED SLUNG of tables/joint.py
        ("joint_a", np.int64),  # ids of the joints that a gear couples; the gear has their anchors; else -1
        ("joint_b", np.int64),
        ("ratio", np.float64),  # ratio of a gear or pulley
        ("ground_ax", np.float64),  # [px] the two pulley wheels in the world; (0, 0) for other kinds
        ("ground_ay", np.float64),
        ("ground_bx", np.float64),
        ("ground_by", np.float64),
        ("ax", np.float64),  # [px] anchors in the world
        ("ay", np.float64),
        ("bx", np.float64),
        ("by", np.float64),
        ("axis_x", np.float64),  # unit: axis of a slider or wheel, along a length or B's rope, direction of angle 0
        ("axis_y", np.float64),
        ("value", np.float64),  # the coordinate, or sum of coordinates, [px or rad]
        ("lower", np.float64),  # lower limit of `value`; -inf: no limit
        ("upper", np.float64),  # upper limit of `value`; inf: no limit
        ("force_x", np.float64),  # [mass px/s2] force on B in the last step
        ("force_y", np.float64),
        ("torque", np.float64),  # [mass px2/s2] torque on B in the last step
        ("awake", np.bool_),  # the joint was solved in the last step
    ]
)


@_of_world
def bounds(world: World) -> np.ndarray:
    """Return the tight AABBs (n, 4) [px] of all shapes at their present poses, in the order of shape ids.

    world: a World.

    Columns: min_x, min_y, max_x, max_y.
    """
    world.queries.refresh(world)
    return np.stack([world.shapes[name] for name in ("min_x", "min_y", "max_x", "max_y")], axis=1)


@_of_world
def shape_rows(world: World) -> np.ndarray:
    """Return a ROW for each shape, (n,) in the order of shape ids.

    world: a World.

    A ROW contains the ids of the shape and of its body, the kind of the body, the filter bits of the shape, whether the
    shape is a sensor, and whether the body is awake.
    """
    shapes = world.shapes
    rows = np.zeros(len(shapes), ROW)
    rows["shape"], rows["body"] = shapes["id"], shapes["body"]
    rows["membership"], rows["mask"], rows["sensor"] = shapes["membership"], shapes["mask"], shapes["sensor"]
    rows["kind"], rows["awake"] = world.bodies["kind"][shapes["body_row"]], world.bodies["awake"][shapes["body_row"]]
    return rows


@_of_world
def motion(world: World) -> np.ndarray:
    """Return the swept AABBs (n, 4) [px] of the last step, for the shapes of bodies that are not static.

    world: a World.

    Columns: min_x, min_y, max_x, max_y.
    """
    proxies = world.pairs.proxies
    rows = proxies[(proxies["row"] >= 0) & ~proxies["still"]]
    return np.stack([rows[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")], axis=1)


@_of_world
def structure(world: World) -> Structure:
    """Return the data structure of the world's broad phase after the last step, as a Structure.

    world: a World.
    """
    strategy = world.broadphase
    rects, depth, intervals = np.zeros((0, 4)), np.zeros(0, int), np.zeros((0, 4))
    if isinstance(strategy, SpatialHashGrid):
        rects, depth = strategy.cells()
    elif isinstance(strategy, DynamicTree):
        rects, depth = strategy.boxes()
    elif isinstance(strategy, SweepAndPrune):
        # Intervals on both axes: the boxes are sorted along one axis and tested along the other axis.
        axis = strategy.sorted[0]
        # Find shapes by slot: the shape rows in proxies are rows of the last step.
        owner = np.full(len(world.pairs.proxies), -1)
        active = world.shapes["proxy"] >= 0
        owner[world.shapes["proxy"][active]] = world.shapes["id"][active]
        there = owner[axis.order] >= 0
        shapes = owner[axis.order[there]]
        boxes = axis.boxes[: len(axis.order)][there]
        intervals = np.concatenate(
            [
                np.column_stack([np.full(len(shapes), each), ends, shapes])
                for each, ends in ((axis.axis, boxes[:, :2]), (1 - axis.axis, boxes[:, 2:]))
            ]
        )
    return Structure(strategy.name, rects, depth, intervals)


@_of_world
def pairs(world: World) -> np.ndarray:
    """Return a row (x0, y0, x1, y1, hit) for each candidate pair of the last step, as an array (m, 5).

    world: a World.

    (x0, y0) and (x1, y1) are the centres of the two shapes' AABBs [px]; hit is 1 if the pair has a contact, otherwise
    0.
    """
    boxes = bounds(world)
    rows = _candidate_rows(world)
    centers = (boxes[:, :2] + boxes[:, 2:]) / 2.0
    contacts = world.contacts
    touching = contacts["shape_a"] << 32 | contacts["shape_b"]
    ids = world.shapes["id"][rows]
    hit = np.isin(ids[:, 0] << 32 | ids[:, 1], touching)
    return np.column_stack([centers[rows[:, 0]], centers[rows[:, 1]], hit])


def _candidate_rows(world):
    """Return the candidate pairs of the last step as SHAPE row numbers (m, 2).

    Pairs with a shape that was removed after the step are omitted.
    """
    ids = world.pairs.ids(world.shapes)
    known = np.ascontiguousarray(world.shapes["id"])
    if not len(ids) or not len(known):
        return np.zeros((0, 2), np.int64)
    rows = np.minimum(np.searchsorted(known, ids), len(known) - 1)
    return rows[(known[rows] == ids).all(axis=1)]


@_of_world
def outlines(world: World, rows: Sequence[int] | np.ndarray | None = None) -> list:
    """Return a list with one tuple for each shape: the kind of its outline, and the outline in world pixels.

    world: a World.
    rows: row numbers in world.shapes; None: all shapes.

    The tuples are ("circle", x, y, r), ("polygon", points), ("rounded", points, r), ("capsule", ax, ay, bx, by, r),
    ("segment", points), ("chain", points), ("mask", shape id) and ("tiles", shape id). points: array (k, 2) of corners;
    r: radius. "rounded" is a polygon with a radius. The last corner of a closed chain repeats its first corner.
    """
    shapes = world.shapes if rows is None else world.shapes[rows]
    bodies, boxes = world.bodies[shapes["body_row"]], bounds(world)[slice(None) if rows is None else rows]
    cosine, sine = np.cos(bodies["angle"]), np.sin(bodies["angle"])
    circles = np.column_stack(
        (
            bodies["x"] + cosine * shapes["local_x"] - sine * shapes["local_y"],
            bodies["y"] + sine * shapes["local_x"] + cosine * shapes["local_y"],
            shapes["radius"],
        )
    ).tolist()
    found = []
    for k, (kind, identity, geometry) in enumerate(
        zip(*(shapes[name].tolist() for name in ("kind", "id", "geometry")), strict=True)
    ):
        if kind == CIRCLE:
            found.append(("circle", *circles[k]))
        elif kind in LINES:
            drawn = (world.library.chain_shapes if kind == CHAIN else world.library.outlines)[geometry]
            turn = np.array([[cosine[k], sine[k]], [-sine[k], cosine[k]]])
            found.append(_line(drawn, kind, (bodies["x"][k], bodies["y"][k]) + np.array(drawn.points) @ turn))
        elif kind == BOUNDS:
            x0, y0, x1, y1 = boxes[k]
            found.append(("polygon", np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])))
        else:
            found.append(("mask" if kind == MASK else "tiles", identity))
    return found


def _line(shape, kind, points):
    """Return the tuple of outlines() for a polygon, capsule, segment or chain.

    kind: kind of the shape, one of LINES; points (k, 2) [px]: corners of the shape in the world.
    """
    if kind == CHAIN:
        return "chain", np.concatenate([points, points[:1]]) if shape.loop else points
    if kind == CAPSULE:
        return "capsule", *points.ravel().tolist(), shape.radius
    if kind == POLYGON and shape.radius > 0.0:
        return "rounded", points, shape.radius
    return "segment" if kind == SEGMENT else "polygon", points


SAME_OF_JOINTS = (
    "body_a", "body_b", "kind", "coordinate", "hold", "joint_a", "joint_b", "ratio", "ground_ax", "ground_ay",
    "ground_bx", "ground_by", "lower", "upper", "force_x", "force_y", "torque", "awake",
)  # fmt: skip


@_of_world
def joints(world: World) -> np.ndarray:
    """Return a DRAWN_JOINT row for each joint, (n,) in the order of joint ids.

    world: a World.

    A row contains the joint's bodies, anchors, axis, coordinate, limits and forces.
    """
    rows, bodies = world.joints, world.bodies
    found = np.zeros(len(rows), DRAWN_JOINT)
    found["joint"] = rows["id"]
    for name in SAME_OF_JOINTS:
        found[name] = rows[name]
    of_gear = rows["hold"] == GEARED
    for name in ("joint_a", "joint_b"):
        found[name][~of_gear] = NO_JOINT
    turned = np.zeros(len(rows))  # angle of A
    columns = np.asarray(rows)  # its columns may have computed names
    for side in ("a", "b"):
        x, y = columns[f"local_{side}x"].copy(), columns[f"local_{side}y"].copy()
        there = columns[f"body_{side}"] != WORLD
        body = bodies[world.rows(columns[f"body_{side}"][there])]
        cosine, sine = np.cos(body["angle"]), np.sin(body["angle"])
        x[there], y[there] = (
            body["x"] + cosine * x[there] - sine * y[there],
            body["y"] + sine * x[there] + cosine * y[there],
        )
        found[side + "x"], found[side + "y"] = x, y
        if side == "a":
            turned[there] = body["angle"]
    of_angle, of_length = rows["coordinate"] == ANGLE, rows["coordinate"] == LENGTH
    along_x, along_y = np.where(of_angle, 1.0, rows["axis_x"]), np.where(of_angle, 0.0, rows["axis_y"])
    turned[of_angle] += rows["reference"][of_angle]
    found["axis_x"] = np.cos(turned) * along_x - np.sin(turned) * along_y
    found["axis_y"] = np.sin(turned) * along_x + np.cos(turned) * along_y
    for side, joint in (("a", rows["joint_a"]), ("b", rows["joint_b"])):  # a gear acts where its joints are
        coupled = np.flatnonzero(of_gear & (joint != NO_JOINT))
        joints_of = np.searchsorted(rows["id"], joint[coupled])
        for axis in ("x", "y"):
            found[side + axis][coupled] = found["b" + axis][joints_of]
    apart = np.stack([found["bx"] - found["ax"], found["by"] - found["ay"]])
    hung = rows["hold"] == SLUNG
    of_length |= hung
    apart[:, hung] = np.stack([found["bx"] - found["ground_bx"], found["by"] - found["ground_by"]])[:, hung]
    length = np.sqrt((apart * apart).sum(axis=0))
    known = of_length & (length > 0.0)
    found["axis_x"][known], found["axis_y"][known] = apart[:, known] / length[known]
    found["value"] = np.where(of_angle, rows["angle"], rows["translation"])
    return found


@_of_world
def part_edges(world: World, rows: np.ndarray | None = None) -> np.ndarray:
    """Return the edges of all convex polygons that form the outlines of masks, as EDGE rows.

    world: a World.
    rows: row numbers in world.shapes; None: all shapes.

    Parts of outlines that are circles or capsules have no edges; outlines() returns them.
    """
    shapes = world.shapes
    if rows is None:
        rows = np.arange(len(shapes))
    rows = rows[(shapes["role"][rows] == PART) & (shapes["kind"][rows] == POLYGON)]
    spans = world.library.polygons.rows[shapes["geometry"][rows]]
    counts = spans["count"]
    edges = np.zeros(int(counts.sum()), EDGE)
    if not len(edges):
        return edges
    of = np.repeat(np.arange(len(rows)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    number = np.arange(len(edges)) - first
    local = world.library.corners.rows[spans["offset"][of] + number]
    body = world.bodies[shapes["body_row"][rows]][of]
    cosine, sine = np.cos(body["angle"]), np.sin(body["angle"])
    edges["ax"] = body["x"] + cosine * local["x"] - sine * local["y"]
    edges["ay"] = body["y"] + sine * local["x"] + cosine * local["y"]
    after = first + (number + 1) % counts[of]
    edges["bx"], edges["by"] = edges["ax"][after], edges["ay"][after]
    edges["row"], edges["radius"] = rows[of], shapes["radius"][rows][of]
    inner = shapes["inner"][rows][of]
    edges["inner"], edges["covered"] = inner >> number & 1, inner >> (number + CORNERS) & 1
    return edges


class Drawn(NamedTuple):
    """The pixels of n masks, rasterised at their present poses. Masks with equal pixels share one array.

    solids: list of bool arrays [row, col], True for a solid pixel.
    which: (n,) index in `solids` of each mask's array.
    left, top: (n,) world position [px] of the first pixel of each mask's array.
    """

    solids: list
    which: np.ndarray
    left: np.ndarray
    top: np.ndarray


@_of_world
def masks(world: World) -> list:
    """Return a list with (shape id, left, top, solid) of each mask, rasterised at its present pose.

    world: a World.

    left, top: world position [px] of the first pixel; solid: bool array [row, col] of the pixels.
    """
    ids = world.shapes["id"][world.shapes["kind"] == MASK].tolist()
    found = drawn_masks(world)
    return [
        (each, left, top, found.solids[k])
        for each, left, top, k in zip(ids, found.left.tolist(), found.top.tolist(), found.which.tolist(), strict=True)
    ]


@_of_world
def drawn_masks(world: World) -> Drawn:
    """Return the pixels of all masks, rasterised at their present poses, as a Drawn.

    world: a World.

    The time depends mainly on the number of different rasters, not on the number of masks.
    """
    world.queries.refresh(world)
    return _drawn(world, np.flatnonzero(world.shapes["kind"] == MASK))


def _drawn(world, rows):
    """Return the pixels of some masks, rasterised at their present poses, as a Drawn.

    rows: SHAPE row numbers of the masks. Missing rasters are computed first.
    """
    draw_pictures(world.library, rows, world.bodies, world.shapes)
    shapes, library = world.shapes[rows], world.library
    raster_of = library.raster_of[: len(library.masks)].ravel()
    drawn = np.flatnonzero(raster_of >= 0)
    place = np.zeros(library.rasters.count, np.int64)
    place[raster_of[drawn]] = drawn
    used, which = np.unique(shapes["raster"], return_inverse=True)
    mask_of, bucket_of = np.divmod(place[used], MASK_ANGLE_BUCKETS)
    kept = zip(mask_of.tolist(), bucket_of.tolist(), strict=True)
    solids = [library.masks[mask].turned_to(bucket).solid for mask, bucket in kept]
    return Drawn(solids, which, shapes["left"], shapes["top"])


@_of_world
def mask_hits(world: World) -> list:
    """Return a list with (left, top, shared) for each candidate pair of masks that share pixels at present.

    world: a World.

    shared: bool array [row, col], True for the pixels that are solid in both masks; left, top: world position [px] of
    its first pixel.
    """
    found = []
    rows = _candidate_rows(world)
    world.queries.refresh(world)
    rows = rows[(world.shapes["kind"][rows] == MASK).all(axis=1)]
    a, b = _drawn(world, rows[:, 0]), _drawn(world, rows[:, 1])
    columns = (each.tolist() for drawn in (a, b) for each in (drawn.left, drawn.top, drawn.which))
    for left_a, top_a, which_a, left_b, top_b, which_b in zip(*columns, strict=True):
        solid_a, solid_b = a.solids[which_a], b.solids[which_b]
        left, top = max(left_a, left_b), max(top_a, top_b)
        right = min(left_a + solid_a.shape[1], left_b + solid_b.shape[1])
        bottom = min(top_a + solid_a.shape[0], top_b + solid_b.shape[0])
        if left < right and top < bottom:
            shared = (
                solid_a[top - top_a : bottom - top_a, left - left_a : right - left_a]
                & solid_b[top - top_b : bottom - top_b, left - left_b : right - left_b]
            )
            if shared.any():
                found.append((left, top, shared))
    return found


POINT = np.dtype(
    [
        ("point_x", np.float64),  # [px] midway between the two surfaces
        ("point_y", np.float64),
        ("normal_x", np.float64),  # unit vector from A to B
        ("normal_y", np.float64),
        ("separation", np.float64),  # [px] negative for an overlap
        ("normal_impulse", np.float64),  # [mass px/s] over the whole step
        ("tangent_impulse", np.float64),  # [mass px/s] friction
        ("feature", np.int64),  # feature id of the corner, edge, tile or pixel of the contact
        ("body_a", np.int64),  # ids of the bodies; A has the shape with the smaller id
        ("body_b", np.int64),
        ("shape_a", np.int64),  # ids of the shapes
        ("shape_b", np.int64),
        ("state", np.int64),  # SPECULATIVE 0, NEW 1, PERSISTED 2, SENSOR 3, ASLEEP 4
        ("color", np.int64),  # colour in the solver's graph colouring; -1: none
    ]
)
SPECULATIVE, NEW, PERSISTED, SENSOR, ASLEEP = range(5)


@_of_world
def contact_points(world: World) -> np.ndarray:
    """Return the POINT rows of all contacts of the last step, including speculative and sleeping contacts.

    world: a World.

    Column state: SPECULATIVE, NEW, PERSISTED, SENSOR or ASLEEP. Column color: the contact's colour in the solver's
    graph colouring, -1 for none.
    """
    found, sensed = world.contact_rows, world.sensed
    if sensed is None:
        sensed = found[found["sensor"]]
    solid, asleep = found[~found["sensor"]], world.sleeping_set.contacts()
    parts = [_points(world, rows, state) for rows, state in ((solid, None), (sensed, SENSOR), (asleep, ASLEEP))]
    return np.concatenate(parts)


def _points(world, contacts, state):
    """Return a POINT row for each contact point of CONTACT rows.

    state: value of column `state` for all points; None: compute it for each point.
    """
    if not len(contacts):
        return np.zeros(0, POINT)
    reported = contacts_of(contacts)
    points = np.zeros(len(reported), POINT)
    for name in set(reported.dtype.fields or ()) & set(POINT.fields or ()):
        points[name] = reported[name]
    points["color"] = -1
    if state is not None:
        points["state"] = state
        return points
    of = np.repeat(np.arange(len(contacts)), contacts["count"])  # index of each point's contact
    second = np.concatenate([[False], of[1:] == of[:-1]])
    if world.stacks:
        points["color"] = contacts["color"][of]
    acting = (points["separation"] <= 0.0) | (points["normal_impulse"] > 0.0) | contacts["swept"][of]
    persisted = np.where(second, contacts["persisted_2"][of], contacts["persisted_1"][of])
    points["state"] = np.where(persisted, PERSISTED, np.where(acting, NEW, SPECULATIVE))
    points["state"][~acting & (points["separation"] > world.tolerances.slop)] = SPECULATIVE
    if not world.stacks:  # contacts have no data of the previous step, but the begin events show which pairs are new
        begun = world.events.begin
        old = ~np.isin(points["shape_a"] << 32 | points["shape_b"], begun["shape_a"] << 32 | begun["shape_b"])
        points["state"][old & (points["state"] == NEW)] = PERSISTED
    return points


@_of_world
def islands(world: World) -> np.ndarray:
    """Return an int64 array (n,) with the island of each body: the lowest body id in it, or -1 for no island.

    world: a World.
    """
    bodies = world.bodies
    return np.where(
        (bodies["kind"] == DYNAMIC) & ~bodies["quarantined"] & (bodies["island"] >= 0), bodies["island"], -1
    )


GHOST = np.dtype(
    [
        ("body", np.int64),  # id
        ("x", np.float64),  # [px] origin at the end of the motion without the impact
        ("y", np.float64),
        ("angle", np.float64),  # [rad] angle at the end of the motion without the impact
        ("fraction", np.float64),  # fraction of the motion at which the body was stopped
    ]
)


@_of_world
def impact_ghosts(world: World) -> np.ndarray:
    """Return a GHOST row for each body that continuous collision stopped at an impact in the last step.

    world: a World.

    A row contains the pose that the body would have reached without the impact, and the fraction of its motion at which
    it was stopped.
    """
    rows = world.ghosts
    if rows is None or not len(rows):
        return np.zeros(0, GHOST)
    ghosts = np.zeros(len(rows), GHOST)
    ghosts["body"], ghosts["fraction"] = rows[:, 0], rows[:, 7]
    known = np.isin(ghosts["body"], world.bodies["id"])
    ghosts, rows = ghosts[known], rows[known]
    at = world.rows(ghosts["body"])
    ghosts["angle"] = rows[:, 6]
    cosine, sine = np.cos(rows[:, 6]), np.sin(rows[:, 6])
    u, v = world.bodies["local_center_x"][at], world.bodies["local_center_y"][at]
    ghosts["x"], ghosts["y"] = rows[:, 4] - cosine * u + sine * v, rows[:, 5] - sine * u - cosine * v
    return ghosts
