"""Accuracy of a pile that should remain at rest: measured after every step, and reported at the end."""

from collections import deque

from game.report.job import Row
from game.report.piles import BOX, Pile, energy, overlap, sunk
from physics import World

SETTLE, LAST = 120, 30  # steps to simulate; the worst of the LAST steps counts
VISIBLE = 1.0  # [px]
FALLEN = 0.5 * BOX  # [px] sag of the highest body that counts as a fall


class Watch:
    """Measurements of one pile over its steps: the worst values so far, and the time at which it fell [s]."""

    settle = SETTLE

    def __init__(self, world: World, pile: Pile) -> None:
        self.world, self.pile, self.start, self.began = world, pile, energy(world), world.time
        self.deepest, self.most, self.fell = 0.0, self.start, None
        self.overlaps: deque[float] = deque(maxlen=LAST)
        self.sunk: deque[float] = deque(maxlen=LAST)

    def look(self) -> None:
        """Measure the pile, and update the worst values. Call this after each step."""
        self.overlaps.append(overlap(self.world))
        self.sunk.append(sunk(self.world, self.pile))
        self.deepest = max(self.deepest, self.overlaps[-1])
        self.most = max(self.most, energy(self.world))
        if self.fell is None and self.sunk[-1] > FALLEN:
            self.fell = self.world.time - self.began

    def found(self) -> Row:
        """Return the measurements as fields of a report row.

        overlap: deepest contact [px]. off: distance of the highest body from its initial height, up or down [px]; None
        for a pile that need not stay in place. Both are the worst values in the last LAST steps. error: the greater of
        overlap and off. deepest: deepest contact of all steps [px]. won: energy gained, as a share of the pile's
        initial energy. stands_s: time at which the pile fell [s], None if it stands.
        """
        deep, off = max(self.overlaps), max(map(abs, self.sunk)) if self.pile.rests else None
        return {
            "overlap": deep,
            "off": off,
            "error": max(deep, off or 0.0),
            "deepest": self.deepest,
            "won": (self.most - self.start) / self.start,
            "stands_s": self.fell,
        }
