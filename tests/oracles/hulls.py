"""Bounds on the distance of two convex outlines without a distance algorithm: projections, and corner-to-edge
distances.
"""

import math

import numpy as np


def random_outline(rng, corners, aspect, size=1.0):
    """Return the corners of a random convex polygon on a rotated ellipse, clockwise on the screen. aspect: ratio of the
    axes.
    """
    angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, corners))
    points = np.stack([np.cos(angles), np.sin(angles) * aspect], axis=1) * size
    turn = rng.uniform(0.0, 2.0 * math.pi)
    c, s = math.cos(turn), math.sin(turn)
    return points @ np.array([[c, s], [-s, c]])


def projected_gap(a, b, normal):
    """Return the gap between the projections of two outlines on a direction from A to B; it never exceeds their
    distance.
    """
    return float((b @ normal).min() - (a @ normal).max())


def best_face_gap(a, b):
    """Return the greatest gap over the normals of all faces.

    It is a lower bound of the distance, and exactly minus the depth if the outlines overlap.
    """
    best = -math.inf
    for first, second in ((a, b), (b, a)):
        edges = np.roll(first, -1, axis=0) - first
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(*edges.T)[:, None]
        gaps = ((second[None] - first[:, None]) * normals[:, None]).sum(axis=2).min(axis=1)
        best = max(best, float(gaps.max()))
    return best


def corner_to_edge(a, b):
    """Return the least distance of a corner of one outline from an edge of the other.

    It is the distance of outlines that are separate.
    """
    best = math.inf
    for first, second in ((a, b), (b, a)):
        edges = np.roll(first, -1, axis=0) - first
        to = second[None] - first[:, None]
        share = np.clip((to * edges[:, None]).sum(axis=2) / (edges * edges).sum(axis=1)[:, None], 0.0, 1.0)
        best = min(best, float(np.hypot(*(to - share[:, :, None] * edges[:, None]).transpose(2, 0, 1)).min()))
    return best


def shadow_overlap(a, b):
    """Return the least move along x or y that separates two AABBs; no overlap of the outlines is deeper."""
    return float(np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0)).min())
