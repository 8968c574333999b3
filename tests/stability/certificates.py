"""Checks of distance, depth and contacts of random pairs against bounds that need no distance algorithm.

Golden values only show that a result has changed; these bounds show that it is wrong. A separating line gives a lower
bound of a distance. A point on each shape gives an upper bound. The overlap of the bounding boxes limits the depth.
"""

from typing import NamedTuple

import numpy as np

from physics import collide, distance
from tests.oracles import rounded_hulls
from tests.oracles.rounded_hulls import Hulls
from tests.stability.random_pairs import draw_pairs

AT_ONCE = 2_000  # pairs: what fits into the processor's cache
ROUNDING = 1e-12  # of the larger shape …
ULPS = 4.0  # … and of where the two are
CLIPPING = 1e-9  # of the larger shape: within it a contact keeps a face where two rounded corners are as near


class Chunk(NamedTuple):
    """Some pairs of hulls with the results of distance() and collide() for each pair.

    Points are relative to the position of shape A [px].
    """

    a: Hulls
    b: Hulls
    room: np.ndarray  # [px] for rounding
    distance: np.ndarray
    normal: np.ndarray
    point_a: np.ndarray
    point_b: np.ndarray
    touching: np.ndarray  # bool: collide has found points
    separation: np.ndarray  # of the deepest of them, NaN without any
    contact_normal: np.ndarray


def chunks(seed, count):
    """Yield the random pairs of a seed in groups (`Chunk`), with the results of distance() and
    collide() for each pair.
    """
    pairs = draw_pairs(seed, count)
    places = [list(map(tuple, poses.tolist())) for poses in (pairs.poses_a, pairs.poses_b)]
    for start in range(0, count, AT_ONCE):
        part = slice(start, start + AT_ONCE)
        asked = list(zip(pairs.shapes_a[part], places[0][part], pairs.shapes_b[part], places[1][part], strict=True))
        gaps, met = [distance(*each) for each in asked], [collide(*each) for each in asked]
        origin = pairs.poses_a[part, :2]
        a, b = (Hulls(each.corners[part], each.radii[part]) for each in (pairs.a, pairs.b))
        far = np.abs(np.hstack([pairs.poses_a[part, :2], pairs.poses_b[part, :2]])).max(axis=1)
        yield Chunk(
            a,
            b,
            room_for(a, b) + ULPS * np.spacing(far),
            np.array([each.distance for each in gaps]),
            np.array([each.normal for each in gaps]),
            np.array([each.point_a for each in gaps]) - origin,
            np.array([each.point_b for each in gaps]) - origin,
            np.array([len(each) > 0 for each in met]),
            np.array([each.separations.min() if len(each) else np.nan for each in met]),
            np.array([each.normal for each in met]),
        )


def room_for(a, b):
    """Return (n,) allowances for rounding [px], in proportion to the farthest coordinate of each pair of hulls."""
    return ROUNDING * np.maximum(*(np.abs(each.boxes()).max(axis=(0, 2)) for each in (a, b)))


def distance_excess(found):
    """Return the worst error of the distances in a chunk, divided by the allowance for rounding. A correct result has
    at most 1.

    The reported normal must separate the hulls by the reported distance, and no other line may separate them by more.
    The two reported points must lie on the surfaces, at the reported distance from each other.
    """
    known = rounded_hulls.bounds(found.a, found.b)
    overlap = found.distance <= 0.0
    across = ((found.point_b - found.point_a) * found.normal).sum(axis=1)
    apart = np.hypot(*(found.point_b - found.point_a).T)
    beyond = [
        np.abs(np.hypot(*found.normal.T) - 1.0) * (found.room / 1e-15),
        known.lower - found.distance,  # some line parts them by more
        found.distance - rounded_hulls.gap_along(found.a, found.b, found.normal),  # not by its normal
        np.where(overlap, known.shadows - found.distance, 0.0),  # no overlap is deeper than that of the boxes
        np.abs(across - found.distance),
        np.abs(apart - np.abs(across)),
    ]
    for hulls, points in ((found.a, found.point_a), (found.b, found.point_b)):
        beyond.append(np.abs(rounded_hulls.distance_to_core(hulls, points) - hulls.radii))
    return float((np.array(beyond) / found.room).max())


def contact_excess(found):
    """Return (worst error of the contacts / allowance for rounding, share of pairs with a larger error).

    The normal must be a unit vector, and a move along it by the depth must end the overlap. A larger error occurs only
    if a contact stays on a face beside a rounded corner.
    """
    met, room = found.touching, found.room * (CLIPPING / ROUNDING)
    along = rounded_hulls.gap_along(found.a, found.b, found.contact_normal)
    off = np.array([np.abs(found.separation - told)[met] for told in (found.distance, along)])
    odd = np.abs(np.hypot(*found.contact_normal[met].T) - 1.0) / 1e-15
    return max(float((off / room[met]).max()), float(odd.max())), float((off > found.room[met]).mean())


def disagreements(found):
    """Return how many pairs have contacts although they are separate, or none although they overlap (invariant U10)."""
    return int((found.touching != (found.distance <= 0.0)).sum())
