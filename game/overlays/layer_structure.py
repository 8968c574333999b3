"""Structure of the broad phase: cells of a grid, boxes of a tree (coloured by depth), or intervals of a sweep."""

from collections.abc import Iterable

import numpy as np

from game.drawing.colors import BLUE, FOG, GREEN, PINK, SKY, YELLOW, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_bounds import draw_boxes
from physics import World, debug

RECT_BUDGET = 2500  # cells or tree boxes per picture; the note says how many there are
INTERVAL_BUDGET = 1200  # intervals per picture
LANES = 8  # the intervals of one axis are spread over this many rows, so that neighbours are distinguishable
DEPTHS = tuple(faded(color, amount) for color in (PINK, YELLOW, GREEN, SKY, BLUE) for amount in (0.0, 0.25))


class Structure(Layer):
    """Overlay that draws the data structure of the world's broad phase, such as grid cells or tree nodes.

    Brute force has no structure. Then the overlay draws nothing, and the legend says so.
    """

    name, title, key, color = "structure", "Structure", "3", YELLOW

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limits on drawn objects are divided evenly among the views."""
        self.drawn = self.total = 0
        self.views = views
        self.kinds = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the structure of a world's broad phase. lens: maps world to frame coordinates."""
        found = debug.structure(world)
        self.kinds.append(found.kind)
        self._rects(frame, lens, found)
        self._intervals(frame, lens, found.intervals)

    def _rects(self, frame, lens, found):
        rows = found.rects
        self.total += len(rows)
        if len(rows) == 0:
            return
        seen = np.flatnonzero(lens.seen(rows))
        # Too many for the budget: the upper boxes of a tree, an even selection of cells.
        seen = seen[np.argsort(found.depth[seen], kind="stable")] if found.kind == "tree" else seen
        seen = seen[: RECT_BUDGET // self.views] if found.kind == "tree" else thinned(seen, RECT_BUDGET // self.views)
        self.drawn += len(seen)
        draw_boxes(frame, lens, rows[seen], DEPTHS, found.depth[seen] % len(DEPTHS))

    def _intervals(self, frame, lens, rows):
        """Draw the intervals of the sweep as bars: x axis along the top of the view, y axis along its left side.

        rows: (n, 3) axis (0 for x, 1 for y), low end [px] and high end [px] of each interval.
        """
        self.total += len(rows)
        if len(rows) == 0:
            return
        along_y, clip = rows[:, 0] != 0.0, lens.clip
        shift = np.where(along_y, lens.dy - clip.top, lens.dx - clip.left)
        length = np.where(along_y, clip.height, clip.width)
        low, high = rows[:, 1] * lens.scale + shift, rows[:, 2] * lens.scale + shift
        seen = thinned(np.flatnonzero((high >= 0.0) & (low <= length)), INTERVAL_BUDGET // self.views)
        self.drawn += len(seen)
        low = np.maximum(low, 0.0).astype(int)[seen]
        high = np.minimum(np.maximum(high[seen], low + 1), length[seen]).astype(int)
        lanes = np.arange(len(seen)) % LANES + LANES * along_y[seen]
        thick, yellow, pink = max(1, frame.scale - 1), frame.tone(YELLOW), frame.tone(PINK)
        for lane, first, last in covered(low, high, lanes, 2 * LANES, max(clip.size)):
            across = lane % LANES * (thick + 1) + 1
            if lane < LANES:
                frame.surface.fill(yellow, (clip.left + first, clip.top + across, last - first, thick))
            else:
                frame.surface.fill(pink, (clip.left + across, clip.top + first, thick, last - first))

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        kinds = "/".join(dict.fromkeys(self.kinds))
        if self.total == 0:
            return [(FOG, f"{kinds}: keeps no structure")]
        parts = {"hash": "cells", "tree": "tree boxes", "sweep": "intervals"}
        what = parts[self.kinds[0]] if len(set(self.kinds)) == 1 and self.kinds[0] in parts else "parts"
        return [(self.color, f"{kinds}: {self.drawn} of {self.total} {what}")]


def covered(
    low: np.ndarray, high: np.ndarray, lanes: np.ndarray, count: int, length: int
) -> Iterable[tuple[int, int, int]]:
    """Return the bars that cover the given intervals, each as (lane, first, last).

    A lane is one line of the picture, in which overlapping intervals are merged to one bar. low, high: (n,) ends of the
    intervals, whole numbers 0..length; lanes: (n,) lane in which each interval is drawn; count: number of lanes.
    """
    edges = np.zeros((count, length + 1), int)
    np.add.at(edges, (lanes, low), 1)
    np.add.at(edges, (lanes, high), -1)
    turns = np.diff(np.cumsum(edges, axis=1) > 0, axis=1, prepend=False)  # starts and ends alternate in each lane
    lane, place = np.nonzero(turns)
    return zip(lane[::2].tolist(), place[::2].tolist(), place[1::2].tolist(), strict=True)


def thinned(rows: np.ndarray, room: int) -> np.ndarray:
    """Return at most `room` elements of the array `rows`, evenly spaced; all elements if there are at most `room`."""
    if len(rows) <= room:
        return rows
    return rows[np.linspace(0, len(rows) - 1, room).astype(int)]
