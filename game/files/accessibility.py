"""Accessibility: the player's settings for camera shake, flashes and colours. No game rule reads them."""

from dataclasses import dataclass

PALETTES = ("standard", "safe", "contrast")  # safe: the Okabe-Ito colours; contrast: the same on a darkened picture


@dataclass(frozen=True)
class Accessibility:
    """Accessibility settings. shake: factor 0..1 on the camera's shake; palette: name in PALETTES.

    flashing: False disables blinking and flashes of the whole picture.
    """

    shake: float = 1.0
    flashing: bool = True
    palette: str = "standard"

    def __post_init__(self):
        if not 0.0 <= self.shake <= 1.0:
            raise ValueError(f"shake must be 0..1 (got {self.shake!r})")
        if self.palette not in PALETTES:
            raise ValueError(f"palette must be one of {', '.join(PALETTES)} (got {self.palette!r})")
