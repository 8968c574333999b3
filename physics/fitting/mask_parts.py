"""What a mask's outline is made of: rounded convex parts with known inner sides."""

from typing import NamedTuple

import numpy as np

from physics.fitting.few_parts import few_parts
from physics.fitting.kept import Parts, fitted
from physics.fitting.outline import pieces_of, smoothed_piece
from physics.fitting.rounding import rounded_core


class Part(NamedTuple):
    """A convex polygon in raster pixels, grown by a radius."""

    corners: np.ndarray  # (k, 2) float64: 1 to 16, clockwise on the screen; 1: a disc, 2: a capsule
    inner: np.ndarray  # (k,) bool: side k -> k + 1 is shared with another part, no boundary
    radius: float  # [px]


def mask_parts(solid: np.ndarray, smooth: float = 0.5) -> list[Part]:
    """Convex parts of the outline of solid[row, col] bool; none of no pixels.

    Each piece in turn: its rounded core if it is round (fitting.rounding), else the convex parts of its outline with
    radius 0 (fitting.few_parts), each from its topmost, then leftmost corner on. smooth [px] as in fitting.outline,
    whose contract holds for the parts together. A full rectangle is one part: its four corners from the upper left on.
    """
    parts = fitted("mask_parts", solid, smooth, lambda: _joined(_fit(solid, smooth)))
    ends = np.cumsum(parts.counts)[:-1]
    corners, inner = np.split(parts.corners, ends), np.split(parts.inner, ends)
    if not len(parts.counts):
        return []
    return [Part(*each) for each in zip(corners, inner, parts.radii.tolist(), strict=True)]


def _joined(parts):
    if not parts:
        return Parts(np.zeros((0, 2)), np.zeros(0, bool), np.zeros(0, np.int64), np.zeros(0))
    return Parts(
        np.concatenate([each.corners for each in parts]),
        np.concatenate([each.inner for each in parts]),
        np.array([len(each.corners) for each in parts], np.int64),
        np.array([each.radius for each in parts], float),
    )


def _fit(solid, smooth):
    found = []
    for piece in pieces_of(solid, smooth):
        outer, holes = smoothed_piece(piece, smooth)
        round_one = None if holes else rounded_core(outer, piece.outer, smooth)
        if round_one is not None:
            core, radius = round_one
            found.append(Part(core, np.zeros(len(core), bool), radius))
        else:
            found += [Part(corners, inner, 0.0) for corners, inner in few_parts([outer, *holes])]
    return found
