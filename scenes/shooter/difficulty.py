"""Difficulty: factors that a stage raises as it proceeds."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Difficulty:
    """Factors on the speed of bullets and dives, the time between volleys, and health; extra bullets in a volley."""

    speed: float = 1.0
    patience: float = 1.0
    armour: float = 1.0
    extra: int = 0


EASY = Difficulty()
