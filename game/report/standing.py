"""How well a pile stands: looked at after every step, told at the end."""

from collections import deque

from game.report.job import Row
from game.report.piles import BOX, Pile, energy, overlap, sunk
from physics import World

SETTLE, LAST = 120, 30  # steps until what stands is measured, of which the worst of the last counts
VISIBLE = 1.0  # [px]
FALLEN = 0.5 * BOX  # [px] the highest came down by more


class Watch:
    """Of one world: what was worst so far, and when it fell [s]."""

    settle = SETTLE

    def __init__(self, world: World, pile: Pile) -> None:
        self.world, self.pile, self.start, self.began = world, pile, energy(world), world.time
        self.deepest, self.most, self.fell = 0.0, self.start, None
        self.overlaps: deque[float] = deque(maxlen=LAST)
        self.sunk: deque[float] = deque(maxlen=LAST)

    def look(self) -> None:
        """After a step."""
        self.overlaps.append(overlap(self.world))
        self.sunk.append(sunk(self.world, self.pile))
        self.deepest = max(self.deepest, self.overlaps[-1])
        self.most = max(self.most, energy(self.world))
        if self.fell is None and self.sunk[-1] > FALLEN:
            self.fell = self.world.time - self.began

    def found(self) -> Row:
        """overlap, and off: how far the highest is from where it was set, up or down, both the worst of the LAST steps;
        error: the worse of the two; deepest [px]; won: energy, as a share of that of the pile's height; stands_s: when
        it fell, None: not yet. A pile that must rise to rest is nowhere to be off from."""
        deep, off = max(self.overlaps), max(map(abs, self.sunk)) if self.pile.rests else None
        return {
            "overlap": deep,
            "off": off,
            "error": max(deep, off or 0.0),
            "deepest": self.deepest,
            "won": (self.most - self.start) / self.start,
            "stands_s": self.fell,
        }
