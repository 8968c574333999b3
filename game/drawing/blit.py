"""A function that blits many images in one call, under pygame-ce and pygame."""

from collections.abc import Iterable
from typing import Any, cast

import pygame


def blit_many(
    surface: pygame.Surface, pairs: Iterable[tuple[pygame.Surface, tuple[float, float]]], flags: int = 0
) -> None:
    """Blit many images onto `surface`. pairs: (image, (x, y)) of each image; flags: pygame's blend flags.

    pygame-ce's fblits is used if it exists; pygame 2.6.1 lacks it. fblits takes 0.4 instead of 0.5 µs per image.
    """
    if hasattr(surface, "fblits"):
        surface.fblits(pairs, flags)
    elif flags:
        # The area None is the whole picture; the stubs of pygame-ce do not allow it.
        surface.blits(cast(Any, [(image, place, None, flags) for image, place in pairs]), doreturn=False)
    else:
        surface.blits(pairs, doreturn=False)
