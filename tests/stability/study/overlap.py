"""Overlap of the bodies of a scene by the separating-axis theorem on their poses, computed alike for every engine.

The axes are the edge normals of both polygons. If one part is a disc, the line from its centre to the nearest corner of
the other is an axis, too. For overlapping polygons, the least move that separates them is minus the greatest separation
over these axes (Gottschalk 1996; Ericson 2005, section 5.2.1). The same holds for a disc with its centre outside or
inside a polygon. This module imports no engine.
"""

import numpy as np


class Overlaps:
    """The parts of a scene in arrays, for an overlap test of all pairs at once."""

    def __init__(self, scene):
        listed = [(k, part) for k, solid in enumerate(scene.solids) for part in solid.parts]
        most = max(len(part.points) for _, part in listed)
        self.body = np.array([k for k, _ in listed])
        self.radius = np.array([part.radius for _, part in listed])
        self.is_disc = np.array([len(part.points) == 1 for _, part in listed])
        # The last corner again and again: edges of no length, which count for nothing.
        self.points = np.array([[*part.points, *[part.points[-1]] * (most - len(part.points))] for _, part in listed])
        self.edges = np.arange(most)[None, :] < np.array([[len(part.points)] for _, part in listed])
        self.following = np.array([[(v + 1) % len(p.points) if v < len(p.points) else v for v in range(most)]
                                   for _, p in listed])  # fmt: skip
        moves = np.isin(self.body, scene.dynamic)
        meet = (self.body[:, None] != self.body[None, :]) & (moves[:, None] | moves[None, :])
        self.meet = np.triu(meet, 1)

    def deepest(self, poses):
        """Return the deepest overlap of any two bodies [m]; 0 if none overlap. poses: (bodies, 3 or more), NaN for
        removed bodies.
        """
        x, y, angle = (poses[self.body, k, None] for k in range(3))
        cosine, sine = np.cos(angle), np.sin(angle)
        px, py = self.points[:, :, 0], self.points[:, :, 1]
        corners = np.stack([x + cosine * px - sine * py, y + sine * px + cosine * py], axis=2)
        low, high = (corners.min(axis=1) - self.radius[:, None], corners.max(axis=1) + self.radius[:, None])
        near = self.meet.copy()
        for axis in range(2):
            near &= (low[:, None, axis] <= high[None, :, axis]) & (low[None, :, axis] <= high[:, None, axis])
        a, b = np.nonzero(near)
        if not len(a):
            return 0.0
        separation = np.maximum(self._along_edges(corners, a, b), self._along_edges(corners, b, a))
        separation = np.maximum(separation, self._from_centre(corners, a, b))
        separation = np.maximum(separation, self._from_centre(corners, b, a))
        return max(0.0, -float(separation.min()))

    def _along_edges(self, corners, a, b):
        """Return, for each pair of parts (a, b), the greatest separation along the outward normals of a's edges."""
        first = corners[a]
        edge = np.take_along_axis(first, self.following[a][:, :, None], axis=1) - first
        length = np.hypot(edge[:, :, 0], edge[:, :, 1])
        real = self.edges[a] & (length > 0.0)
        length = np.where(real, length, 1.0)
        nx, ny = edge[:, :, 1] / length, -edge[:, :, 0] / length
        reach = nx * first[:, :, 0] + ny * first[:, :, 1]
        other = nx[:, :, None] * corners[b][:, None, :, 0] + ny[:, :, None] * corners[b][:, None, :, 1]
        found = other.min(axis=2) - reach - self.radius[b][:, None] - self.radius[a][:, None]
        return np.where(real, found, -np.inf).max(axis=1)

    def _from_centre(self, corners, a, b):
        """Return, for each pair, the separation along the line from the nearest corner of b to the centre of disc a.

        The value is -inf if a is no disc.
        """
        centre = corners[a][:, 0]
        way = centre[:, None, :] - corners[b]
        distance = np.hypot(way[:, :, 0], way[:, :, 1])
        nearest, rows = distance.argmin(axis=1), np.arange(len(a))
        length = distance[rows, nearest]
        usable = self.is_disc[a] & (length > 0.0)
        axis = -way[rows, nearest] / np.where(usable, length, 1.0)[:, None]  # from a to b
        other = axis[:, None, 0] * corners[b][:, :, 0] + axis[:, None, 1] * corners[b][:, :, 1]
        here = axis[:, 0] * centre[:, 0] + axis[:, 1] * centre[:, 1]
        found = other.min(axis=1) - here - self.radius[a] - self.radius[b]
        return np.where(usable, found, -np.inf)
