"""The stored music as the game plays it: decoded by pygame's mixer, which needs no encoder."""

from functools import cache

import numpy as np
import pygame

from assets import FOLDER
from assets.audio.voices import RATE


@cache
def decoded(name):
    """Return (frames, 2) int16 of assets/music/<name>.ogg, at the rate of the file."""
    pygame.mixer.quit()
    pygame.mixer.init(RATE, -16, 2, allowedchanges=0)
    try:
        return pygame.sndarray.array(pygame.mixer.Sound(str(FOLDER / "music" / f"{name}.ogg")))
    finally:
        pygame.mixer.quit()  # other tests open it at the game's own rate


def sides_of(name):
    """Return the left and the right channel, (2, frames) float64 within -1..1."""
    return decoded(name).T.astype(np.float64) / 32767
