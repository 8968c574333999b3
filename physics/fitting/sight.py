"""Which corners of a ring see each other: between them a ring can be cut.

Rings go clockwise on the screen, the inside to the right. Along a bridge to a hole they pass the same points twice,
once on either side; the two copies see to different sides, which the cones at the corners tell apart.
"""

import numpy as np


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Of vectors (..., 2): positive when b is clockwise of a on the screen."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


class Walls:
    """Sides from corners (n, 2) to following (n, 2) [px]; flat [px2]: doubled triangle areas that count as none."""

    def __init__(self, corners: np.ndarray, following: np.ndarray, flat: float) -> None:
        self.corners, self.following, self.flat = corners, following, flat
        self.after = following - corners

    def near(self, low: np.ndarray, high: np.ndarray) -> "Walls":
        """Those whose bounds meet a box."""
        meet = (np.minimum(self.corners, self.following) <= high) & (np.maximum(self.corners, self.following) >= low)
        meet = meet.all(axis=1)
        return Walls(self.corners[meet], self.following[meet], self.flat)

    def free(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Whether the lines from points a (m, 2) to b (m, 2) cross no side and pass no corner between their ends."""
        crossed, passed = self.obstacles(a, b)
        return ~crossed & ~passed.any(axis=1)

    def obstacles(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of lines as in free: (m,) whether they cross a side, and (m, n) which corners they pass."""
        along = (b - a)[:, None]
        to = self.corners - a[:, None]
        side, side_after = cross(along, to), cross(along, self.following - a[:, None])
        of_a, of_b = cross(to, self.after), cross(self.corners - b[:, None], self.after)
        for each in (side, side_after, of_a, of_b):
            each[np.abs(each) <= self.flat] = 0.0
        crossed = np.any((side * side_after < 0) & (of_a * of_b < 0), axis=1)
        ahead, length = (along * to).sum(axis=2), (along * along).sum(axis=2)
        apart = (self.corners != a[:, None]).any(axis=2) & (self.corners != b[:, None]).any(axis=2)
        return crossed, (side == 0) & (ahead > 0) & (ahead < length) & apart


class Ring(Walls):
    """A closed ring of corners (n, 2) [px], and to which sides of each the inside is."""

    def __init__(self, corners: np.ndarray, flat: float) -> None:
        super().__init__(corners, np.roll(corners, -1, axis=0), flat)
        self.back = np.roll(corners, 1, axis=0) - corners
        turn = cross(self.after, self.back)
        self.reflex = turn < -flat
        self.convex = turn > flat

    def faces(self, k: np.ndarray, toward: np.ndarray, closed: bool) -> np.ndarray:
        """Whether corners k (m,) have the inside of the ring in the direction toward (m, 2); closed: or a side."""
        low = self.flat if not closed else -self.flat
        from_after, to_back = cross(self.after[k], toward), cross(toward, self.back[k])
        within = np.where(self.reflex[k], (from_after > low) | (to_back > low), (from_after > low) & (to_back > low))
        return np.where(~self.reflex[k] & ~self.convex[k], from_after > low, within)

    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """(n, n) bool twice: which corners can be joined by a cut; and which by a line inside that may also run
        along sides and pass corners. O(n^3), vectorised."""
        count = len(self.corners)
        i, j = np.triu_indices(count, 2)
        toward = self.corners[j] - self.corners[i]
        apart = (toward != 0).any(axis=1)
        seen = apart & self.faces(i, toward, True) & self.faces(j, -toward, True)
        i, j, toward = i[seen], j[seen], toward[seen]
        crossed, passed = self.obstacles(self.corners[i], self.corners[j])
        cuts, lines = np.zeros((count, count), bool), np.zeros((count, count), bool)
        clear = ~crossed & ~passed.any(axis=1)
        strict = clear & self.faces(i, toward, False) & self.faces(j, -toward, False)
        cuts[i[strict], j[strict]] = True
        lines[i[clear], j[clear]] = True
        for row in np.flatnonzero(~crossed & passed.any(axis=1)):
            at = np.flatnonzero(passed[row])
            way = np.broadcast_to(toward[row], (len(at), 2))
            through = self.faces(at, way, True) & self.faces(at, -way, True)
            # Copies of a corner on a bridge: one that lets the line through is enough.
            places = {tuple(each) for each in self.corners[at].tolist()}
            lines[i[row], j[row]] = places == {tuple(each) for each in self.corners[at[through]].tolist()}
        return cuts, lines
