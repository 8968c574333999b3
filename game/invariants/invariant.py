"""Base class of the invariants, and the results of their checks: holds, broken, or not checked."""

from collections.abc import Iterable
from dataclasses import dataclass

from game.invariants.step import Step


@dataclass(frozen=True)
class Broken:
    """Result for an invariant that does not hold. bodies: ids of the bodies concerned.

    value: the measured value; allowed: the greatest allowed value.
    """

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
        """One line of text with the world, the bodies, the quantity and its value."""
        world = [f"world {self.world}"] if self.world else []
        bodies = [f"bodies {' '.join(map(str, self.bodies))}"] if self.bodies else []
        where = ", ".join(world + bodies)
        return f"{where + ': ' if where else ''}{self.sentence}: {self.value:.6g}, allowed {self.allowed:.6g}"


@dataclass(frozen=True)
class NotAsked:
    """Result for an invariant that cannot be checked in this step. reason: why it cannot be checked."""

    reason: str


Answer = Broken | NotAsked | None  # None: checked, and it holds


class Invariant:
    """Base class of the invariants. id, word: labels of the invariant, such as "U1" and "finite".

    look() is called once after every step.
    """

    id: str
    word: str

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, a NotAsked, or None if the invariant holds."""
        raise TypeError(f"{type(self).__name__} must define look")

    def broken(self, step: Step, bodies: Iterable[int], value: float, allowed: float, sentence: str) -> Broken:
        """Return a Broken with the given values, as the result of look().

        bodies: ids of the bodies concerned; value: the measured value; allowed: the greatest allowed value; sentence:
        description of the violation.
        """
        return Broken(
            self.id, self.word, step.number, tuple(int(b) for b in bodies), float(value), float(allowed), sentence
        )
