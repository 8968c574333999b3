"""Accessibility: what eyes and hands of this player want of the picture. No rule of a game ever reads it."""

from dataclasses import dataclass

PALETTES = ("standard", "safe", "contrast")  # safe: the Okabe-Ito colours; contrast: the same, darker behind them


@dataclass(frozen=True)
class Accessibility:
    """`shake`: factor 0..1 on camera shake. `flashing`: False leaves out flashes of the whole picture, and blinking."""

    shake: float = 1.0
    flashing: bool = True
    palette: str = "standard"

    def __post_init__(self):
        if not 0.0 <= self.shake <= 1.0:
            raise ValueError(f"shake must be 0..1 (got {self.shake!r})")
        if self.palette not in PALETTES:
            raise ValueError(f"palette must be one of {', '.join(PALETTES)} (got {self.palette!r})")
