"""What all screens share: settings, high scores, devices, sound and the window's picture."""

import pygame

from game.audio.sound import Sounds
from game.drawing.window import mode_of, set_mode
from game.files.records import load_records
from game.files.settings import Settings, save_settings
from game.input.devices import DeviceSource
from game.input.pads import Pads
from game.registry import Registry
from game.run.compilers import Compilers, jobs_of
from game.run.options import Options
from game.run.picture import Picture
from game.run.warmup import warm_up_scene
from game.scene import Scene
from game.screens.loading import Loading
from game.startup import say

WAIT = 100  # [ms] between two pictures of the bar: painting it must not cost those who compile a core


class Arcade:
    """`running` turns False when the program is to end. `message`: what there is to say of the files that were read."""

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
        self.compilers: Compilers | None = None  # at work in the background, where a window is open

    def stop_if_closed(self) -> None:
        """End the program if the window's closing waits in the queue: it was what stopped the loading."""
        self.running = self.running and not pygame.event.peek(pygame.QUIT)

    def compile_for(
        self,
        scene_class: type[Scene],
        solver: str | None = None,
        broadphase: str | None = None,
        stops_for_anybody: bool = False,
    ) -> None:
        """Compile what a scene needs, behind a bar. Raises LoadingStopped."""
        loading = Loading(scene_class.title, stops_for_anybody)
        broadphase = broadphase or self.options.broadphase
        self._wait_for_compilers(loading, jobs_of(scene_class, broadphase, solver))
        warm_up_scene(
            scene_class,
            broadphase,
            solver,
            lambda done, total, kernel: loading.show(self.picture, done / max(total, 1), kernel),
        )

    def _wait_for_compilers(self, loading, jobs):
        """Let the processes in the background do it, all of them; where none is left the foreground does."""
        if self.compilers is None:
            return
        self.compilers.first(jobs)
        while (share := self.compilers.share(jobs)) is not None and share < 1.0:
            loading.show(self.picture, share, f"{share:.0%} of the kernels, on every core")
            pygame.time.wait(WAIT)

    def apply_settings(self) -> None:
        """Put changed settings to work."""
        if mode_of(self.settings) != self.mode:
            self.mode = mode_of(self.settings)
            try:
                self.picture.presenter.frame.surface = set_mode(self.settings)
            except pygame.error as error:
                say(f"the window stays as it is: {error}")
        self.devices.bind(self.settings.keys, self.settings.buttons)
        self.sounds.master, self.sounds.effects = self.settings.master, self.settings.effects

    def save_settings(self) -> None:
        """Write the settings; a failed save is said and does not stop the game."""
        try:
            save_settings(self.settings)
        except OSError as error:
            say(f"settings could not be saved: {error}")
