"""Resources shared by all screens: settings, high scores, devices, sound and the window's picture."""

import pygame

from game.audio.sound import Sounds
from game.drawing.window import mode_of, set_mode
from game.files.records import load_records
from game.files.settings import Settings, save_settings
from game.input.devices import DeviceSource
from game.input.pads import Pads
from game.registry import Registry
from game.run.options import Options
from game.run.picture import Picture
from game.startup import say


class Arcade:
    """State shared by all screens. running: if set to False, the program ends.

    message: warning about settings or records that could not be read, or "".
    """

    def __init__(
        self, options: Options, registry: Registry, settings: Settings, surface: pygame.Surface, message: str = ""
    ) -> None:
        self.options, self.registry, self.settings = options, registry, settings
        self.records, lost = load_records()
        say(lost)
        self.message = message or lost
        self.picture = Picture(surface)
        self.devices = DeviceSource(self.picture.presenter.to_canvas, settings.keys, Pads(), settings.buttons)
        self.sounds = Sounds(settings.master, settings.effects, settings.music)
        say(self.sounds.silent_because)
        self.mode = mode_of(settings)
        self.running = True

    def apply_settings(self) -> None:
        """Apply the settings after they have changed: window mode, keys, buttons and volumes."""
        if mode_of(self.settings) != self.mode:
            self.mode = mode_of(self.settings)
            try:
                self.picture.presenter.frame.surface = set_mode(self.settings)
            except pygame.error as error:
                say(f"the window stays as it is: {error}")
        self.devices.bind(self.settings.keys, self.settings.buttons)
        self.sounds.master, self.sounds.effects = self.settings.master, self.settings.effects

    def save_settings(self) -> None:
        """Write the settings to their file. A failure is reported and does not stop the game."""
        try:
            save_settings(self.settings)
        except OSError as error:
            say(f"settings could not be saved: {error}")
