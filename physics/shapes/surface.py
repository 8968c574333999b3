"""The upper side of a mask that is open from below: what stands on it meets these chains, and no convex parts."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from physics.fitting.outline import outline
from physics.shapes.lines import Chain
from physics.shapes.outline_tiles import Sprite


class Stretch(NamedTuple):
    """A stretch of an upper side in body space."""

    shape: Chain
    inner: int = 0  # as OutlinePart's: no line lies inside


def surfaces_of(mask: Sprite) -> tuple[Stretch, ...]:
    """Chains in body space along the upper side of a mask's outline, worked out once; () for a mask without pixels.

    Each is a run of the outline's lines that lead to the right, from its left end to its right one: all whose outward
    normals point upwards in the mask's own space, floors of holes among them. Vertical lines and undersides are no part
    of them, and part runs from one another; but steps of at most `smooth` [px], where two lines miss each other, are
    joined in their middle: nobody stumbles over them. The outline as in fitting.outline; O(pixels).
    """
    if "surfaces" not in mask.fitted:
        rings = [ring for piece in outline(mask.solid, mask.smooth) for ring in (piece.outer, *piece.holes)]
        runs = [run - np.array(mask.origin) for ring in rings for run in _runs(_joined(ring, mask.smooth))]
        mask.fitted["surfaces"] = tuple(Stretch(Chain(run.tolist())) for run in runs)
    return mask.fitted["surfaces"]


def _joined(ring, most):
    """A ring without the steps of at most so many px between two lines that lead to the right."""
    way = np.roll(ring, -1, axis=0) - ring
    right = way[:, 0] > 0.0
    step = (way[:, 0] == 0.0) & (np.abs(way[:, 1]) <= most) & np.roll(right, 1) & np.roll(right, -1)
    middle = np.where(step[:, None], ring + 0.5 * way, ring)
    return middle[~np.roll(step, 1)]


def _runs(ring):
    """Points of the stretches of a ring, its inside to the right, that lead to the right [px]."""
    right = np.roll(ring[:, 0], -1) > ring[:, 0]
    first = int(np.flatnonzero(~right)[0])  # what leads back: no stretch goes over it
    ring, right = np.roll(ring, -first, axis=0), np.roll(right, -first)
    closed = np.concatenate([ring, ring[:1]])
    turns = np.flatnonzero(np.diff(right.astype(np.int8), prepend=0, append=0))
    return [closed[start : end + 1] for start, end in pairwise(turns.tolist()) if right[start]]
