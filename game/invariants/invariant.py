"""Invariants, their answers (held, broken, not asked), and their display."""

from collections.abc import Iterable
from dataclasses import dataclass

from game.invariants.step import Step


@dataclass(frozen=True)
class Broken:
    """An invariant that does not hold. `bodies`: ids of the bodies concerned; `value`: of at most `allowed`."""

    invariant: str  # U1 ... U11
    word: str
    step: int  # of the world, counted from 1
    bodies: tuple[int, ...]
    value: float
    allowed: float
    sentence: str
    world: int = 0  # index among the worlds of its scene

    def __str__(self) -> str:
        return f"{self.invariant} ({self.word}) is broken in step {self.step}: {self.brief}"

    @property
    def brief(self) -> str:
        """Place, quantity and amount in a line."""
        world = [f"world {self.world}"] if self.world else []
        bodies = [f"bodies {' '.join(map(str, self.bodies))}"] if self.bodies else []
        where = ", ".join(world + bodies)
        return f"{where + ': ' if where else ''}{self.sentence}: {self.value:.6g}, allowed {self.allowed:.6g}"


@dataclass(frozen=True)
class NotAsked:
    """The invariant does not apply to this world; `why`."""

    reason: str


Answer = Broken | NotAsked | None  # None: checked, and it holds


class Invariant:
    """One invariant; `id` and `word` label it. look() is called after every step, in the order of the steps."""

    id: str
    word: str

    def look(self, step: Step) -> Answer:
        """Check it for the last step."""
        raise TypeError(f"{type(self).__name__} must define look")

    def broken(self, step: Step, bodies: Iterable[int], value: float, allowed: float, sentence: str) -> Broken:
        """Return the answer of look() for a broken invariant."""
        return Broken(
            self.id, self.word, step.number, tuple(int(b) for b in bodies), float(value), float(allowed), sentence
        )
