"""Difficulty of the shooter: factors that the stage file increases in the course of a stage."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Difficulty:
    """Factors of the enemies' strength.

    speed: factor on the speed of bullets and dives; patience: factor on the time between volleys; armour: factor on
    health; extra: number of additional bullets in a volley.
    """

    speed: float = 1.0
    patience: float = 1.0
    armour: float = 1.0
    extra: int = 0


EASY = Difficulty()
