"""What the last query looked at in the broad phase's structure, box by box, for drawing. Only reads.

The structure is walked once more, as the strategies' `near` does, with each box that the query asked for.
"""

from math import floor
from typing import NamedTuple

import numpy as np

from physics.broadphase.cells import CELL_RANGE, LEVELS
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.proxies import Box
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.broadphase.tree_nodes import ROOT_MOVING
from physics.queries.index import IndexedWorld

CORNERS = ("lower_x", "lower_y", "upper_x", "upper_y")


class Visited(NamedTuple):
    """The boxes that a query asked for, and those that it looked at for them [px], in order; twice looked at is twice
    there."""

    kind: str  # brute, sweep, hash, tree
    asked: np.ndarray  # (k, 4) min_x min_y max_x max_y
    rects: np.ndarray  # (m, 4) nodes of the tree, cells of the hash, boxes that were compared
    met: np.ndarray  # (m,) whether the box asked for meets it


def visited(world: IndexedWorld) -> Visited:
    """What the last query of a world visited. As long as nobody has stepped or changed it since."""
    strategy, asked = world.broadphase, np.array(world.queries.asked).reshape(-1, 4)
    boxes = asked.tolist() if world.queries.asks_broadphase(world) else []
    found = [_rects(strategy, world.pairs.proxies, tuple(box)) for box in boxes]
    met = [_meets(rects, box) for rects, box in zip(found, asked, strict=False)]
    return Visited(
        strategy.name, asked, np.concatenate([np.zeros((0, 4)), *found]), np.concatenate([np.zeros(0, bool), *met])
    )


def _meets(rects, box):
    return (rects[:, 0] <= box[2]) & (rects[:, 2] >= box[0]) & (rects[:, 1] <= box[3]) & (rects[:, 3] >= box[1])


def _rects(strategy, proxies, box: Box) -> np.ndarray:
    if isinstance(strategy, DynamicTree):
        return _nodes(strategy, box)
    if isinstance(strategy, SpatialHashGrid):
        return _cells(strategy, proxies, box)
    if isinstance(strategy, SweepAndPrune):
        return _stretch(strategy, proxies, box)
    return _boxes(proxies[proxies["row"] >= 0])


def _boxes(rows):
    return np.stack([rows[name] for name in CORNERS], axis=1)


def _nodes(tree, box):
    """The nodes from the roots down, as deep as they meet the box."""
    boxes, children, height = _boxes(tree.nodes), tree.nodes[["child_a", "child_b"]], tree.nodes["height"]
    found, level = [], tree.state[ROOT_MOVING:]
    level = level[level >= 0]
    while len(level):
        found.append(boxes[level])
        inner = level[_meets(boxes[level], box) & (height[level] > 0)]
        level = np.concatenate([children["child_a"][inner], children["child_b"][inner]])
    return np.concatenate([np.zeros((0, 4)), *found])


def _cells(grid, proxies, box):
    """The cells that the box reaches into, per level; of a level that has fewer bodies, those."""
    found, (x0, y0, x1, y1) = [np.zeros((0, 4))], box
    for level in np.flatnonzero(grid.level_counts).tolist():
        size = grid.base * 2.0**level
        if level < LEVELS and max(map(abs, box)) < CELL_RANGE * size:
            left, top, right, bottom = (floor(each * (1.0 / size)) for each in box)
            if (right - left + 1) * (bottom - top + 1) <= grid.level_counts[level] + 4 and (x1 - x0) / size + (
                y1 - y0
            ) / size <= grid.level_counts[level] + 4:
                y, x = np.mgrid[top : bottom + 1, left : right + 1].reshape(2, -1) * size
                found.append(np.stack([x, y, x + size, y + size], axis=1))
                continue
        slots, slot = [], int(grid.level_heads[level])
        while slot >= 0:
            slots.append(slot)
            slot = int(grid.lists[slot, 1])
        found.append(_boxes(proxies[slots]))
    return np.concatenate(found)


def _stretch(sweep, proxies, box):
    """The boxes along the sorted axis from the first that may reach the box to the last that begins before its end."""
    axis = sweep.sorted[0]
    lows, highest = axis.boxes[: len(axis.order), 0], np.maximum.accumulate(axis.boxes[: len(axis.order), 1])
    first = int(np.searchsorted(highest, box[axis.axis]))
    last = int(np.searchsorted(lows, box[axis.axis + 2], side="right"))
    return _boxes(proxies[axis.order[first:last]])
