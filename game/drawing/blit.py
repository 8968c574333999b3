"""Many pictures in one call, under either pygame."""

from collections.abc import Iterable

import pygame


def blit_many(
    surface: pygame.Surface, pairs: Iterable[tuple[pygame.Surface, tuple[float, float]]], flags: int = 0
) -> None:
    """Blit (image, (x, y)) pairs. fblits, which pygame 2.6.1 lacks, skips the checks of blits: 0.4 against 0.5 µs each."""
    if hasattr(surface, "fblits"):
        surface.fblits(pairs, flags)
    elif flags:
        surface.blits([(image, place, None, flags) for image, place in pairs], doreturn=False)
    else:
        surface.blits(pairs, doreturn=False)
