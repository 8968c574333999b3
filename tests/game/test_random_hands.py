"""Random input in every scene neither ends the program nor leaves a number that is not finite.

The input: keys, buttons, clicks, drags, the wheel and a window that loses its focus, in any order.
"""

import threading

import numpy as np
import pygame
import pytest

from scenes import SCENES
from tests.game.driving import BUTTONS, PAD

KEYS = [
    *range(pygame.K_a, pygame.K_z + 1),
    *range(pygame.K_0, pygame.K_9 + 1),
    *range(pygame.K_F1, pygame.K_F12 + 1),
    *(pygame.K_UP, pygame.K_DOWN, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_RETURN, pygame.K_ESCAPE, pygame.K_SPACE),
    *(pygame.K_TAB, pygame.K_BACKSPACE, pygame.K_DELETE),
    *(pygame.K_HOME, pygame.K_END, pygame.K_PAGEUP, pygame.K_PAGEDOWN),
    *(pygame.K_COMMA, pygame.K_PERIOD, pygame.K_MINUS, pygame.K_PLUS, pygame.K_SLASH, pygame.K_QUESTION),
    *(pygame.K_LEFTBRACKET, pygame.K_RIGHTBRACKET, pygame.K_LSHIFT, pygame.K_LCTRL),
]
MODS = (0, 0, 0, 0, pygame.KMOD_SHIFT, pygame.KMOD_CTRL)
DEEDS, MORE_DEEDS = 15, 240  # of a scene, in every run and at night
KINDS = {"tap": 42, "hold": 10, "click": 20, "drag": 6, "wheel": 6, "pad": 8, "let_go": 5, "window": 3}  # of a hundred


class Hands:
    """Source of random inputs to a running program."""

    def __init__(self, driver, seed):
        self.driver, self.random = driver, np.random.default_rng(seed)
        self.held, self.deeds = set(), []

    def place(self):
        """Return a random position in the window, sometimes outside the picture."""
        width, height = pygame.display.get_window_size()
        return int(self.random.integers(-5, width + 5)), int(self.random.integers(-5, height + 5))

    def deed(self):
        """Make one random input that a player can make."""
        kind = str(self.random.choice(list(KINDS), p=np.array([*KINDS.values()]) / 100))
        self.deeds.append(kind)
        getattr(self, kind)()
        self.driver.turns(int(self.random.integers(1, 4)))

    def key(self):
        return int(KEYS[self.random.integers(len(KEYS))])

    def tap(self):
        key, mod = self.key(), int(self.random.choice(MODS))
        self.deeds[-1] = f"tap {pygame.key.name(key)} {mod}"
        letter = chr(key) if key < 127 else ""
        self.driver.post(pygame.KEYDOWN, key=key, mod=mod, unicode=letter)
        self.driver.post(pygame.KEYUP, key=key, mod=mod)

    def hold(self):
        key = self.key()
        self.held.add(key)
        self.driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="")

    def let_go(self):
        for key in sorted(self.held):
            self.driver.post(pygame.KEYUP, key=key, mod=0)
        self.held.clear()

    def click(self):
        place, button = self.place(), int(self.random.choice((1, 1, 1, 2, 3)))
        self.deeds[-1] = f"click {place} {button}"
        self.driver.post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0))
        self.driver.turns(1)
        self.driver.post(pygame.MOUSEBUTTONDOWN, button=button, pos=place)
        self.driver.turns(1)
        self.driver.post(pygame.MOUSEBUTTONUP, button=button, pos=place)

    def drag(self):
        self.driver.post(pygame.MOUSEBUTTONDOWN, button=1, pos=self.place())
        for _ in range(3):
            self.driver.post(pygame.MOUSEMOTION, pos=self.place(), rel=(3, 3), buttons=(1, 0, 0))
            self.driver.turns(1)
        self.driver.post(pygame.MOUSEBUTTONUP, button=1, pos=self.place())

    def wheel(self):
        self.driver.post(pygame.MOUSEWHEEL, x=0, y=int(self.random.integers(-3, 4)))

    def pad(self):
        button = BUTTONS[str(self.random.choice(list(BUTTONS)))]
        self.driver.post(pygame.CONTROLLERBUTTONDOWN, instance_id=PAD, button=button)
        self.driver.turns(1)
        self.driver.post(pygame.CONTROLLERBUTTONUP, instance_id=PAD, button=button)

    def window(self):
        kind = self.random.choice((pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED, pygame.WINDOWLEAVE))
        self.driver.post(int(kind))


def watched(monkeypatch):
    """Return a list to which every exception that ends a thread is appended."""
    ended = []
    monkeypatch.setattr(threading, "excepthook", lambda reported: ended.append(reported.exc_value))
    return ended


def try_out(driver, scene, seed, deeds):
    """Make `deeds` random inputs in a scene; the scene is started again if it was left."""
    hands = Hands(driver, seed)
    driver.app.screens.play(scene)
    driver.turns(5)
    try:
        for _ in range(deeds):
            hands.deed()
            if not driver.app.arcade.running:
                break  # the menus end the program, and may
            played = getattr(driver.screen, "scene", None)
            if played is None and hands.random.random() < 0.15:
                driver.app.screens.play(scene)
            for world in getattr(played, "worlds", ()):
                assert np.isfinite(world.bodies["x"]).all() and np.isfinite(world.bodies["angle"]).all(), hands.deeds
    finally:
        print(f"seed {seed}:", ", ".join(hands.deeds))  # seen where it fails
        if hasattr(driver.screen, "close"):
            driver.screen.close()


@pytest.mark.parametrize("scene", SCENES)
def test_nothing_that_hands_do_ends_a_scene(scene, drive, monkeypatch):
    ended = watched(monkeypatch)
    try_out(drive(listing=SCENES), scene, sum(map(ord, scene)), DEEDS)
    assert not ended


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("scene", SCENES)
def test_nothing_that_other_hands_do_ends_a_scene(scene, seed, drive, monkeypatch):
    ended = watched(monkeypatch)
    try_out(drive(listing=SCENES), scene, 1000 + seed, MORE_DEEDS)
    assert not ended
