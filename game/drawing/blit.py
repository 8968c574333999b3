"""Blits of many pictures in one call, with pygame-ce or pygame."""

from collections.abc import Iterable
from typing import Any, cast

import pygame


def blit_many(
    surface: pygame.Surface, pairs: Iterable[tuple[pygame.Surface, tuple[float, float]]], flags: int = 0
) -> None:
    """Blit many pictures. pairs: (image, (x, y)); flags: pygame's blend flags.

    fblits, which pygame 2.6.1 lacks, skips checks: 0.4 instead of 0.5 µs a pair.
    """
    if hasattr(surface, "fblits"):
        surface.fblits(pairs, flags)
    elif flags:
        # The area None is the whole picture; the stubs of pygame-ce do not allow it.
        surface.blits(cast(Any, [(image, place, None, flags) for image, place in pairs]), doreturn=False)
    else:
        surface.blits(pairs, doreturn=False)
