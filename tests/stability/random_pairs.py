"""Random pairs of convex shapes for C13: thin and round, tiny and huge, near the origin and far from it.

About half of the pairs overlap.
"""

from typing import NamedTuple

import numpy as np

from physics import Capsule, Circle, Polygon, Segment
from tests.oracles.rounded_hulls import Hulls

CORNERS = 16
FURTHEST = 1e7  # [px] from the origin


class Pairs(NamedTuple):
    """n pairs of shapes and poses, as arguments of physics functions and as arrays.

    The arrays a and b contain the same shapes as rounded hulls, relative to the position of shape A.
    """

    shapes_a: list
    shapes_b: list
    poses_a: np.ndarray  # (n, 3)
    poses_b: np.ndarray
    a: Hulls
    b: Hulls


def any_shape(rng):
    """Return a random shape: a disc, capsule, segment, or a hull of 3 to 16 corners, rounded or not.

    It measures 0.1 to 1,000 px and is up to 10,000 times as long as it is thick.
    """
    size, thin = 10.0 ** rng.uniform(-1.0, 3.0), 10.0 ** -rng.uniform(0.0, 4.0)
    kind, (x, y) = rng.integers(8), rng.normal(size=2) * size
    if kind == 0:
        return Circle(size, (x, y))
    if kind in (1, 2):
        ends = (x - size, y), (x + size, y + size * rng.uniform(-1.0, 1.0))
        return Capsule(*ends, size * thin) if kind == 1 else Segment(*ends)
    while True:
        # A corner in each of so many arcs of an ellipse.
        count = int(rng.integers(3, CORNERS + 1))
        around = (np.arange(count) + rng.uniform(0.0, 0.9, count)) * (2.0 * np.pi / count)
        turn, u, v = rng.uniform(0.0, 7.0), np.cos(around) * size, np.sin(around) * size * thin
        c, s = np.cos(turn), np.sin(turn)
        points = np.stack([x + c * u - s * v, y + s * u + c * v], axis=1)
        try:
            return Polygon(points, size * 10.0 ** -rng.uniform(0.0, 4.0) if kind == 3 else 0.0)
        except ValueError:  # three in line, once in thousands of needles
            continue


def hulls_of(shapes):
    """Return the corners and radii of a list of shapes as arrays."""
    corners = np.zeros((len(shapes), CORNERS, 2))
    for row, shape in enumerate(shapes):
        points = (shape.center,) if isinstance(shape, Circle) else shape.points
        corners[row, : len(points)] = points
        corners[row, len(points) :] = points[-1]
    return Hulls(corners, np.array([getattr(shape, "radius", 0.0) for shape in shapes]))


def draw_pairs(seed, count):
    """Return `count` random pairs: half have random positions near each other, the others nearly touch.

    The pairs draw from count / 10 shapes, at least 20.
    """
    rng = np.random.default_rng(seed)
    shapes = [any_shape(rng) for _ in range(max(count // 10, 20))]
    hulls = hulls_of(shapes)
    one, two = rng.integers(len(shapes), size=(2, count))
    angles = rng.uniform(-7.0, 7.0, (2, count))
    zero = np.zeros(count)
    a = Hulls(hulls.corners[one], hulls.radii[one]).placed(zero, zero, angles[0])
    b = Hulls(hulls.corners[two], hulls.radii[two]).placed(zero, zero, angles[1])
    offset = np.where((rng.random(count) < 0.5)[:, None], _near(rng, a, b), _touching(rng, a, b))
    far = FURTHEST ** rng.uniform(0.0, 1.0, (count, 1)) * (rng.random((count, 1)) < 0.5)
    place = far * rng.uniform(-1.0, 1.0, (count, 2))
    poses_a = np.column_stack([place, angles[0]])
    poses_b = np.column_stack([place + offset, angles[1]])
    seen = poses_b - poses_a  # what rounding far out has left of the offset
    moved = Hulls(b.corners + seen[:, None, :2], b.radii)
    return Pairs([shapes[k] for k in one], [shapes[k] for k in two], poses_a, poses_b, a, moved)


def _near(rng, a, b):
    """Return random (n, 2) offsets of B from A at which the bounding boxes of most pairs overlap.

    The range of the offsets is 1.2 times the range in which the boxes overlap.
    """
    (low_a, high_a), (low_b, high_b) = a.boxes(), b.boxes()
    low, high = low_a - high_b, high_a - low_b
    return (low + high) / 2.0 + (high - low) / 2.0 * rng.uniform(-1.2, 1.2, low.shape)


def _touching(rng, a, b):
    """Return random (n, 2) offsets of B from A at which the shapes nearly touch, along a random direction.

    The gap or overlap along this direction is 1 to 1e-12 times the size of the smaller shape.
    """
    angle = rng.uniform(0.0, 2.0 * np.pi, len(a.radii))
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rows = np.arange(len(angle))
    foremost = a.corners[rows, np.einsum("nmk,nk->nm", a.corners, normal).argmax(axis=1)]
    hindmost = b.corners[rows, np.einsum("nmk,nk->nm", b.corners, normal).argmin(axis=1)]
    smaller = np.minimum(*(np.ptp(each.boxes(), axis=0).max(axis=1) for each in (a, b)))
    gap = smaller * 10.0 ** -rng.uniform(0.0, 12.0, len(angle)) * np.where(rng.random(len(angle)) < 0.1, 1.0, -1.0)
    return foremost - hindmost + (a.radii + b.radii + gap)[:, None] * normal
