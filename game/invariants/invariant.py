"""What an invariant is, what it can answer, and how it is shown: held, broken, not asked."""

from collections.abc import Iterable
from dataclasses import dataclass

from game.invariants.step import Step


@dataclass(frozen=True)
class Broken:
    """An invariant that does not hold. `bodies`: ids of those it was found at; `value` of at most `allowed`."""

    invariant: str  # U1 ... U11
    word: str
    step: int  # of the world, counted from 1
    bodies: tuple[int, ...]
    value: float
    allowed: float
    sentence: str
    world: int = 0  # place among the worlds of its scene

    def __str__(self) -> str:
        return f"{self.invariant} ({self.word}) is broken in step {self.step}: {self.brief}"

    @property
    def brief(self) -> str:
        """Where, what, how much."""
        world = [f"world {self.world}"] if self.world else []
        bodies = [f"bodies {' '.join(map(str, self.bodies))}"] if self.bodies else []
        where = ", ".join(world + bodies)
        return f"{where + ': ' if where else ''}{self.sentence}: {self.value:.6g}, allowed {self.allowed:.6g}"


@dataclass(frozen=True)
class NotAsked:
    """The invariant says nothing of a world like this; why."""

    reason: str


Answer = Broken | NotAsked | None  # None: asked, and it holds


class Invariant:
    """`id` and `word`: of its light. look() is called after every step, in the order of the steps."""

    id: str
    word: str

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        raise TypeError(f"{type(self).__name__} must define look")

    def broken(self, step: Step, bodies: Iterable[int], value: float, allowed: float, sentence: str) -> Broken:
        """What look() answers where it does not hold."""
        return Broken(
            self.id, self.word, step.number, tuple(int(b) for b in bodies), float(value), float(allowed), sentence
        )
