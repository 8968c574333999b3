"""The one place that knows pygame 2.6.1 lacks what pygame-ce has."""

import pygame


def blit_many(surface, pairs, flags=0):
    """Blit a list of (image, (x, y)). fblits skips the argument checks of blits: 0.4 against 0.5 µs each."""
    if hasattr(surface, "fblits"):
        surface.fblits(pairs, flags)
    elif flags:
        surface.blits([(image, place, None, flags) for image, place in pairs], doreturn=False)
    else:
        surface.blits(pairs, doreturn=False)


def pygame_name():
    """Which pygame this is, for --version."""
    edition = "pygame-ce" if getattr(pygame, "IS_CE", 0) else "pygame"
    return f"{edition} {pygame.version.ver}"


def controller_module():
    """pygame._sdl2.controller (uniform button names), or None where SDL has none."""
    try:
        from pygame._sdl2 import controller
    except ImportError:
        return None
    return controller
