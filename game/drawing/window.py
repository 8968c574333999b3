"""Functions that open the window, and that update it when the settings change."""

import os
import sys
import warnings
from collections.abc import Mapping

import pygame

from game.drawing.canvas import CANVAS_SIZE
from game.errors import UsageError
from game.files.settings import Settings

LARGEST_SHARE = 0.9  # of the desktop: greatest share of a window opened without a chosen size


def open_window(settings: Settings) -> pygame.Surface:
    """Open the window with these settings, and return its surface. Raises UsageError if there is no display."""
    try:
        if not has_screen(sys.platform, os.environ):
            raise pygame.error("neither DISPLAY nor WAYLAND_DISPLAY is set")
        pygame.display.init()
        # SDL falls back to invisible drivers, which are accepted only if the environment names one.
        if pygame.display.get_driver() in ("dummy", "offscreen") and not os.environ.get("SDL_VIDEODRIVER"):
            raise pygame.error("no screen found")
        surface = set_mode(settings)
    except pygame.error as error:
        raise UsageError(
            f"no display to open a window on ({error}); run without one: --headless --scene NAME"
        ) from error
    pygame.display.set_caption("Hitbox")
    return surface


def has_screen(platform: str, environment: Mapping[str, str]) -> bool:
    """Return whether SDL can find a display.

    On Linux, an environment variable must name an X or Wayland display or a video driver. Without any of them, SDL
    would print its own error messages.
    """
    names = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    return not platform.startswith("linux") or any(environment.get(name) for name in names)


def mode_of(settings: Settings) -> tuple[bool, int, bool]:
    """Return the settings that determine the window: (fullscreen, window scale, vsync).

    The window is opened again only if one of these changes.
    """
    return settings.fullscreen, settings.window_scale, settings.vsync


def set_mode(settings: Settings) -> pygame.Surface:
    """Open the window, or change the open window, according to the settings. Return the window's surface."""
    desktop = pygame.display.get_desktop_sizes()[0]
    if settings.fullscreen:
        return _open(desktop, pygame.FULLSCREEN, settings.vsync)
    fits = min(desktop[0] * LARGEST_SHARE // CANVAS_SIZE[0], desktop[1] * LARGEST_SHARE // CANVAS_SIZE[1])
    scale = settings.window_scale or max(1, int(fits))
    return _open((CANVAS_SIZE[0] * scale, CANVAS_SIZE[1] * scale), pygame.RESIZABLE, settings.vsync)


def _open(size, flags, vsync):
    """Open the window and return its surface. vsync: True requests vsync; if it is not available, the window has none.

    Without vsync, the game loop's own timing sets the frame rate. flags: pygame's flags of the display mode.
    """
    if vsync and pygame.display.get_driver() not in ("dummy", "offscreen"):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # "no fast renderer" is no reason to stop, even under --strict
                return pygame.display.set_mode(size, flags, vsync=1)
        except pygame.error:
            return pygame.display.set_mode(size, flags)
    return pygame.display.set_mode(size, flags)


def copy_text(text: str) -> bool:
    """Copy a text to the clipboard. Return whether the clipboard now contains the text."""
    try:
        pygame.scrap.put_text(text)
        return pygame.scrap.get_text() == text
    except (AttributeError, UnicodeEncodeError, pygame.error):  # a file name need not be text
        return False
