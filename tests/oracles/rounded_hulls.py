"""Bounds on the distance of many pairs of rounded convex outlines at once, without a distance algorithm.

The lower bound is the greatest gap along many separating axes. The upper bound is the distance of a point on one
outline from a point on the other. The arrays have one row for each pair. Nothing is imported from physics.
"""

from typing import NamedTuple

import numpy as np


class Hulls(NamedTuple):
    """One shape of each of n pairs; a disc has one corner, a line or a capsule two."""

    corners: np.ndarray  # (n, m, 2) [px]; a hull of fewer corners repeats its last one
    radii: np.ndarray  # (n,) [px] rounding

    def placed(self, x, y, angle):
        """Return these hulls rotated by angle [rad] about their origins and moved by (x, y) [px]."""
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        u, v = self.corners[..., 0], self.corners[..., 1]
        return Hulls(np.stack([x[:, None] + c * u - s * v, y[:, None] + s * u + c * v], axis=2), self.radii)

    def boxes(self):
        """Return the (lower, upper) corners (n, 2) of the hulls' AABBs."""
        radius = self.radii[:, None]
        return self.corners.min(axis=1) - radius, self.corners.max(axis=1) + radius


class Bounds(NamedTuple):
    """Bounds on n distances [px], negative for overlapping hulls."""

    lower: np.ndarray  # the widest gap over the normals of all faces and the line between the nearest points
    shadows: np.ndarray  # gap along the best axis of x and y: of an overlap, minus the AABBs' least overlap


def gap_along(a, b, normal):
    """Return (n,) gaps [px] between the projections on directions (n, 2) from A to B; no gap exceeds the distance."""
    shadow_a = np.einsum("nmk,nk->nm", a.corners, normal).max(axis=1)
    shadow_b = np.einsum("nmk,nk->nm", b.corners, normal).min(axis=1)
    return shadow_b - shadow_a - a.radii - b.radii


def bounds(a, b):
    """Return the bounds of the distances of pairs of hulls."""
    axis = nearest_axis(a, b)
    lower = np.where(np.isnan(axis[:, 0]), -np.inf, gap_along(a, b, np.nan_to_num(axis)))
    radii = a.radii + b.radii
    for one, other in ((a.corners, b.corners), (b.corners, a.corners)):
        edges = np.roll(one, -1, axis=1) - one
        length = np.hypot(edges[..., 0], edges[..., 1])
        faces = length > 0.0
        normal = np.stack([edges[..., 1], -edges[..., 0]], axis=2) / np.where(faces, length, 1.0)[..., None]
        ahead = np.einsum("nik,njk->nij", normal, other).min(axis=2) - np.einsum("nik,nik->ni", normal, one)
        lower = np.maximum(lower, np.where(faces, ahead, -np.inf).max(axis=1) - radii)
    (low_a, high_a), (low_b, high_b) = a.boxes(), b.boxes()
    return Bounds(lower, np.maximum(low_b - high_a, low_a - high_b).max(axis=1))


def nearest_axis(a, b):
    """Return (n, 2) unit vectors from the nearest point of A's outline to that of B's; NaN if
    these points are equal.
    """
    of_b, on_a = _nearest(a.corners, b.corners)
    of_a, on_b = _nearest(b.corners, a.corners)
    first = np.hypot(*(of_b - on_a).T) <= np.hypot(*(of_a - on_b).T)
    way = np.where(first[:, None], of_b - on_a, on_b - of_a)
    length = np.hypot(*way.T)
    return np.where(length > 0.0, 1.0, np.nan)[:, None] * way / np.where(length > 0.0, length, 1.0)[:, None]


def distance_to_core(hulls, points):
    """Return (n,) distances [px] of points (n, 2) from the edges of their hulls, without the rounding radius."""
    of, on = _nearest(hulls.corners, points[:, None])
    return np.hypot(*(of - on).T)


def _nearest(corners, points):
    """Return (points, edge points), both (n, 2): the given point nearest to each outline, and its nearest edge point.

    corners (n, m, 2): corners of n outlines. points (n, k, 2): k points for each outline.
    """
    edges = np.roll(corners, -1, axis=1) - corners
    square = (edges * edges).sum(axis=2)
    to = points[:, None] - corners[:, :, None]
    share = np.einsum("nmk,nmjk->nmj", edges, to) / np.where(square > 0.0, square, 1.0)[..., None]
    on = corners[:, :, None] + np.clip(share, 0.0, 1.0)[..., None] * edges[:, :, None]
    off = points[:, None] - on
    pairs, count = np.arange(len(corners)), points.shape[1]
    edge, point = np.divmod((off * off).sum(axis=3).reshape(len(corners), -1).argmin(axis=1), count)
    return points[pairs, point], on[pairs, edge, point]
