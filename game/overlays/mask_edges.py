"""Outlines of masks as lines: the outer edges, which collide, and the seams between convex parts, which do not."""

from math import ceil, pi
from typing import NamedTuple

import numpy as np

from game.overlays.outlines import ARC_STEP, corners_of
from physics import World, debug
from physics.tables.shape import PART, POLYGON


class MaskEdges(NamedTuple):
    """Edges of the convex parts of masks, for drawing. `outer`: edges on the outline; `inner`: seams between two parts.

    `outer` and `inner` are (n, 4) arrays of lines in world coordinates [px], with columns ax, ay, bx, by.
    """

    outer: np.ndarray  # edges that contacts, casts and characters use
    inner: np.ndarray  # edges between two parts of one mask


def mask_edges(world: World, rows: np.ndarray, scale: float = 1.0) -> MaskEdges:
    """Return the lines of mask outlines, as MaskEdges.

    rows: indices of rows of world.shapes. Rows that are not part of a mask's outline are ignored. The edges of a
    rounded part are at the distance `radius` outside its polygon, with arcs around the corners. scale: frame px per
    world px, which determines the number of segments per arc.
    """
    edges = debug.part_edges(world, rows)
    outer, inner = [], []
    dx, dy = edges["bx"] - edges["ax"], edges["by"] - edges["ay"]
    length = np.maximum(np.sqrt(dx * dx + dy * dy), np.finfo(float).tiny)
    out_x, out_y = dy / length, -dx / length
    lines = np.column_stack([edges[name] for name in ("ax", "ay", "bx", "by")])
    lines += edges["radius"][:, None] * np.column_stack((out_x, out_y, out_x, out_y))
    outer.append(lines[~edges["inner"]])
    inner.append(lines[edges["inner"]])
    for arc, hidden in _arcs(edges, np.arctan2(out_y, out_x), scale):
        (inner if hidden else outer).append(arc)
    round_ones = rows[(world.shapes["role"][rows] == PART) & (world.shapes["kind"][rows] != POLYGON)]
    for outline in debug.outlines(world, round_ones):
        found = corners_of(outline, scale)
        if found is not None:
            points, closed = np.array(found[0]), found[1]
            lines = np.column_stack((points, np.roll(points, -1, axis=0)))
            outer.append(lines if closed else lines[:-1])
    return MaskEdges(np.concatenate(outer), np.concatenate(inner) if inner else np.zeros((0, 4)))


def _arcs(edges, facing, scale):
    """Yield (lines, hidden) for the arc around each corner of a rounded part.

    hidden: whether the arc is inside the outline. edges: rows of debug.part_edges(); facing: (n,) angle of each edge's
    outward normal [rad]; scale: as in mask_edges().
    """
    rounded = np.flatnonzero(edges["radius"] > 0.0)
    if not len(rounded):
        return
    row = edges["row"]
    before = np.arange(len(edges)) - 1
    starts = np.flatnonzero(np.concatenate([[True], row[1:] != row[:-1]]))
    before[starts] = np.append(starts[1:], len(edges)) - 1  # the last edge of the same part
    for k in rounded.tolist():
        start, radius = facing[before[k]], edges["radius"][k]
        turn = (facing[k] - start) % (2.0 * pi)
        steps = max(1, ceil(turn * radius * scale / ARC_STEP))
        angles = start + turn * np.arange(steps + 1) / steps
        points = np.column_stack((edges["ax"][k] + radius * np.cos(angles), edges["ay"][k] + radius * np.sin(angles)))
        hidden = edges["covered"][k] or edges["inner"][k] or edges["inner"][before[k]]
        yield np.column_stack((points[:-1], points[1:])), bool(hidden)
