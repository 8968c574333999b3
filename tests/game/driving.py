"""Driver of the whole program for tests: it posts events, makes turns of the program's loop, and returns the top
screen.
"""

import pygame

from game.app import App
from game.command_line import read_options
from game.drawing.window import open_window
from game.files.settings import Settings
from game.registry import Registry
from tests.game.arena import GAMES

BUTTONS = {
    "a": pygame.CONTROLLER_BUTTON_A,
    "b": pygame.CONTROLLER_BUTTON_B,
    "x": pygame.CONTROLLER_BUTTON_X,
    "y": pygame.CONTROLLER_BUTTON_Y,
    "start": pygame.CONTROLLER_BUTTON_START,
    "back": pygame.CONTROLLER_BUTTON_BACK,
    "up": pygame.CONTROLLER_BUTTON_DPAD_UP,
    "down": pygame.CONTROLLER_BUTTON_DPAD_DOWN,
    "left": pygame.CONTROLLER_BUTTON_DPAD_LEFT,
    "right": pygame.CONTROLLER_BUTTON_DPAD_RIGHT,
    "rb": pygame.CONTROLLER_BUTTON_RIGHTSHOULDER,
}
PAD = 5  # instance id of the pad


class Driver:
    """An App under the dummy driver whose clock advances one step in each turn, so that tests
    run as fast as possible.
    """

    def __init__(self, monkeypatch, *arguments, listing=GAMES, settings=None):
        self.now = 100.0
        monkeypatch.setattr("game.app.perf_counter", self.time)
        monkeypatch.setattr("pygame.time.wait", lambda milliseconds: 0)
        self.settings = settings or Settings(window_scale=1)
        registry = Registry(listing)
        pygame.event.clear()
        self.app = App(read_options(list(arguments), registry), registry, self.settings, open_window(self.settings))

    def time(self):
        """Return the time of the app's clock [s]; it does not advance within a turn."""
        return self.now

    @property
    def screen(self):
        """Return the screen on top."""
        return self.app.screen

    @property
    def name(self):
        """Return the class name of the screen on top."""
        return type(self.app.screen).__name__

    def turns(self, count=1):
        """Make `count` turns of the loop, each a step of 1/60 s."""
        for _ in range(count):
            if self.app.arcade.running:
                self.now += 1.0001 / 60
                self.app.turn()

    def post(self, kind, **values):
        """Post one pygame event with these attributes."""
        pygame.event.post(pygame.event.Event(kind, **values))

    def key(self, *keys, turns=2):
        """Press and release each of the keys, with `turns` turns after each."""
        for key in keys:
            self.post(pygame.KEYDOWN, key=key, mod=0, unicode="")
            self.post(pygame.KEYUP, key=key, mod=0)
            self.turns(turns)

    def hold(self, key, turns):
        """Hold a key down for a number of turns."""
        self.post(pygame.KEYDOWN, key=key, mod=0, unicode="")
        self.turns(turns)
        self.post(pygame.KEYUP, key=key, mod=0)
        self.turns(1)

    def pad(self, *buttons, turns=2):
        """Press and release each of the controller's buttons, with `turns` turns after each."""
        for button in buttons:
            self.post(pygame.CONTROLLERBUTTONDOWN, instance_id=PAD, button=BUTTONS[button])
            self.post(pygame.CONTROLLERBUTTONUP, instance_id=PAD, button=BUTTONS[button])
            self.turns(turns)

    def hold_pad(self, button, turns):
        """Hold a button of the controller down for a number of turns."""
        self.post(pygame.CONTROLLERBUTTONDOWN, instance_id=PAD, button=BUTTONS[button])
        self.turns(turns)
        self.post(pygame.CONTROLLERBUTTONUP, instance_id=PAD, button=BUTTONS[button])
        self.turns(1)

    def move(self, place):
        """Move the mouse to a position on the canvas."""
        self.post(pygame.MOUSEMOTION, pos=self.to_window(place), rel=(0, 0), buttons=(0, 0, 0))
        self.turns(1)

    def click(self, place):
        """Click on a position on the canvas."""
        self.move(place)
        self.press(place)

    def press(self, place):
        """Press and release the mouse button at a position on the canvas, without moving the pointer there."""
        position = self.to_window(place)
        self.post(pygame.MOUSEBUTTONDOWN, button=1, pos=position)
        self.turns(2)
        self.post(pygame.MOUSEBUTTONUP, button=1, pos=position)
        self.turns(2)

    def to_window(self, place):
        """Return the window position of a position on the canvas."""
        frame = self.app.arcade.picture.presenter.frame
        return frame.area.x + place[0] * frame.scale, frame.area.y + place[1] * frame.scale

    def click_row(self, label, rows=None):
        """Click on the row with this label. rows: list that contains it; None for the list of the top screen."""
        rows = rows or self.screen.list
        number = next(i for i, row in enumerate(rows.rows()) if row.label.strip() == label)
        while rows.place(number) is None:
            self.post(pygame.MOUSEWHEEL, x=0, y=-1)
            self.turns(1)
        place = rows.place(number)
        self.click((place.x + 12, place.centery))

    def mark(self, label, by=None):
        """Move down to the row with this label and confirm it.

        by: (down, confirm), functions that make these inputs; None for the keyboard.
        """
        down, yes = by or (lambda: self.key(pygame.K_DOWN), lambda: self.key(pygame.K_RETURN))
        for _ in range(40):
            row = self.screen.list.marked
            if row is not None and row.label.strip() == label:
                return yes()
            down()
        raise AssertionError(f"no row {label!r} on {self.name}")

    def by_pad(self, label):
        """Move down to the row with this label and confirm it, with the controller."""
        self.mark(label, (lambda: self.pad("down"), lambda: self.pad("a")))
