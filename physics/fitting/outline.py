"""A smooth outline of pixels: staircases become straight lines, everything else stays where it is.

A line may replace a stretch of a crack loop that goes in at most one horizontal and one vertical direction, a
staircase, when for each corner c within it

    |cross(d, c - start)| <= reach * (|dx| + |dy|)        with reach = min(smooth, just under 0.5)

This one inequality is all of the contract. Between two legs that meet at c the line is at most `reach` from the nearer
leg, and c at most sqrt(2) * reach <= smooth + 0.21 from the line; a pixel's centre lies (0.5, 0.5) from a corner, so at
less than 0.5 every solid centre stays inside and every clear one outside. A line that parts the same centres as its
cracks never crosses another one that does: outlines are simple and pieces never meet but in pinches. For a fixed start
the inequality bounds the direction to an interval, so lines are found in one walk (as in O'Rourke 1981, "An on-line
algorithm for fitting straight lines between data ranges"), and the fewest by dynamic programming.
"""

from typing import NamedTuple

import numpy as np

from physics.fitting.contour import Contour, Loop, contours
from physics.fitting.cracks import SHARP
from physics.fitting.straight_lines import PLACE, lines_of_loop

LARGEST_REACH = 0.5 - 2.0**-20  # [px] less than from a crack to a pixel's centre: that one is never reached
JOINING = 0.25  # [px] from this smoothing on a line can pass a pinch, so that pieces are 8-connected


class Outline(NamedTuple):
    """One piece: simple polygons in raster pixels that touch at most in single points."""

    outer: np.ndarray  # (n, 2) float64: corners, clockwise on the screen
    holes: list[np.ndarray]  # each (n, 2) float64: corners, counter-clockwise on the screen


def outline(solid: np.ndarray, smooth: float = 0.5) -> list[Outline]:
    """The pieces of solid[row, col] bool, in straight lines; in the order of fitting.contour.

    smooth [px] >= 0: each point of an outline is within it of the pixels' edges, each point of those within
    smooth + 0.21 of the outline; 0: the edges themselves. Solid pixels' centres are inside, clear ones' outside.
    A corner between straight runs of 3 px and more stays, so do all of a rectangle. Pieces are 8-connected where the
    outline can pass between two pixels that touch diagonally: not at such a corner, nor when smooth < 0.25.
    Near the fewest corners that can be had on corners and middles of runs. O(corners * corners per line).
    """
    return [smoothed_piece(piece, smooth) for piece in pieces_of(solid, smooth)]


def pieces_of(solid: np.ndarray, smooth: float) -> list[Contour]:
    """The crack loops that outlines are made from, with their pinches joined where a line can pass."""
    return contours(solid, SHARP if smooth >= JOINING else 0)


def smoothed_piece(piece: Contour, smooth: float) -> Outline:
    """The outline of one piece."""
    reach = min(smooth, LARGEST_REACH)
    return Outline(smoothed(piece.outer, reach), [smoothed(hole, reach) for hole in piece.holes])


def smoothed(loop: Loop, reach: float) -> np.ndarray:
    """Corners (n, 2) float64 of a crack loop in straight lines; reach [px] as above."""
    if reach <= 0.0:
        return loop.corners.astype(float)
    places, anchor = _places(loop)
    chain = np.empty(len(places), np.int64)
    count = lines_of_loop(len(places) // 2, anchor, reach, places, chain)
    around = np.sort(chain[1:count] % (len(places) // 2))  # the first and the last are one
    points = np.stack([places["x"][around], places["y"][around]], axis=1)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return points[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]


def sharp(loop: Loop) -> np.ndarray:
    """(n,) bool: which corners of a crack loop stay: those between runs of 3 px and more, and those of rectangles."""
    runs = np.roll(loop.corners, -1, axis=0) - loop.corners
    lengths, signs = np.abs(runs).sum(axis=1), np.sign(runs)
    before = np.roll(signs, 1, axis=0)
    turns = before[:, 0] * signs[:, 1] - before[:, 1] * signs[:, 0]
    cap = turns == np.roll(turns, -1)  # a run whose ends turn to the same side is no part of a staircase
    return ((np.minimum(lengths, np.roll(lengths, 1)) >= SHARP) | (cap & np.roll(cap, 1))) & ~loop.joined


def _places(loop):
    """Where an outline may have corners along a crack loop: at its own but joined pinches, in the middle of each run
    and half a pixel from its ends. Twice round and the first again (PLACE), and the first that stays; -1: none does."""
    corners = loop.corners
    runs = np.roll(corners, -1, axis=0) - corners
    lengths = np.abs(runs).sum(axis=1)
    signs = np.sign(runs)
    steps = np.stack([0.0 * lengths, 0.0 * lengths + 0.5, lengths / 2.0, lengths - 0.5], axis=1)
    several = np.stack([lengths > 0, lengths > 1, lengths > 0, lengths > 1], axis=1)
    run = np.nonzero(several)[0]
    first = np.cumsum(several.sum(axis=1)) - several.sum(axis=1)
    places = np.zeros(len(run), PLACE)
    places["x"], places["y"] = (corners[run] + steps[several][:, None] * signs[run]).T
    places["right"], places["down"] = signs[run].T
    places["corner"][first] = True
    places["allowed"] = True
    places["allowed"][first[loop.joined]] = False
    stay = first[sharp(loop)]
    places["anchor"][stay] = True
    places = np.concatenate([places, places, places[:1]])
    x, y = places["x"], places["y"]
    places["swept"][1:] = np.cumsum(x[:-1] * y[1:] - y[:-1] * x[1:])
    return places, int(stay[0]) if len(stay) else -1
