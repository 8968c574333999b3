"""The window: events in, fixed steps, a picture out. Screens: title, menu, options, play."""

import os
import sys
from time import perf_counter, strftime

import pygame

from game.bindings import key_codes
from game.colors import GOLD
from game.command_line import make_scene
from game.data_folder import data_folder
from game.devices import DeviceSource, Pads
from game.draw import CANVAS_SIZE, SMALL
from game.errors import UsageError
from game.headless import finish, save_or_fail
from game.inputs import InputState
from game.loading import Loading
from game.loop import STEP_SECONDS, FixedStep
from game.menu import Menu
from game.options import Options
from game.picture import Picture, save_png
from game.play import Play
from game.settings import load_settings, save_settings
from game.sound import Sounds
from game.startup import say
from game.title import Title
from game.warmup import warm_up_scene

LARGEST_SHARE = 0.9        # of the desktop that a window opened without a chosen size may take
IDLE_SECONDS = 0.002       # rest between frames when the display does not wait for its refresh


def run_app(options, registry):
    """Open the window and run until it is closed. Returns the exit code."""
    settings, message = load_settings()
    say(message)
    surface = open_window(settings)
    try:
        app = App(options, registry, settings, surface, message)
        return app.run()
    finally:
        pygame.quit()


def open_window(settings):
    """The window's surface. Raises UsageError when there is no display to open it on."""
    try:
        if not has_screen(sys.platform, os.environ):
            raise pygame.error("neither DISPLAY nor WAYLAND_DISPLAY is set")
        pygame.display.init()
        # SDL falls back to drivers nobody can see; only who asks for one by name gets it.
        if pygame.display.get_driver() in ("dummy", "offscreen") and not os.environ.get("SDL_VIDEODRIVER"):
            raise pygame.error("no screen found")
        surface = set_mode(settings)
    except pygame.error as error:
        raise UsageError(f"no display to open a window on ({error}); run without one: "
                         "--headless --scene NAME") from error
    pygame.display.set_caption("Hitbox")
    return surface


def has_screen(platform, environment):
    """False where SDL could only fail, with noise of its own: Linux without X, Wayland or a driver by name."""
    names = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    return not platform.startswith("linux") or any(environment.get(name) for name in names)


def set_mode(settings):
    """Open or change the window to the settings' size."""
    desktop = pygame.display.get_desktop_sizes()[0]
    if settings.fullscreen:
        return pygame.display.set_mode(desktop, pygame.FULLSCREEN)
    fits = min(desktop[0] * LARGEST_SHARE // CANVAS_SIZE[0], desktop[1] * LARGEST_SHARE // CANVAS_SIZE[1])
    scale = settings.window_scale or max(1, int(fits))
    return pygame.display.set_mode((CANVAS_SIZE[0] * scale, CANVAS_SIZE[1] * scale), pygame.RESIZABLE)


class App:
    """One screen at a time; a screen that is done names the next in `outcome`."""

    def __init__(self, options, registry, settings, surface, message=""):
        self.options, self.registry, self.settings = options, registry, settings
        self.picture = Picture(surface)
        self.pads = Pads()
        self.devices = DeviceSource(self.picture.presenter.to_canvas, settings.keys, self.pads)
        self.sounds = Sounds(settings.volume)
        say(self.sounds.silent_because)
        self.inputs = InputState()
        self.clock = FixedStep()
        self.frame_seconds = STEP_SECONDS
        self.running = True
        self.screen = self._play(options.scene, first=True) if options.scene else Title(message)

    def run(self):
        """The loop. Returns the exit code."""
        code = 0
        try:
            while self.running:
                self.turn()
        finally:
            self._save_recording()
        if isinstance(self.screen, Play) and self.options.scene:
            play = self.screen
            if self.options.screenshot:
                frame = self.picture.presenter.frame
                save_or_fail(lambda path: save_png(frame.surface, path), self.options.screenshot)
            recording = self.options.recording
            code = finish(play.scene, play.session.report, self.options,
                          self.options.bot or bool(recording and recording.bot))
        return code

    def turn(self):
        """One turn of the loop: events, due steps, one picture."""
        started = perf_counter()
        for event in pygame.event.get():
            self._feed(event)
        if isinstance(self.screen, Play):
            self._turn_play(started)
        else:
            self._turn_screen(started)
        pygame.mouse.set_visible(self.screen.shows_pointer)
        pygame.display.flip()
        spent = perf_counter() - started
        self.frame_seconds += (spent - self.frame_seconds) * 0.05
        if spent < STEP_SECONDS:
            pygame.time.wait(max(1, int((STEP_SECONDS - spent - IDLE_SECONDS) * 1000)))
        if self.screen.outcome is not None:
            self._follow(self.screen.outcome)

    def _turn_play(self, now):
        play = self.screen
        play.advance(now, self.options.frames)
        drawn = perf_counter()
        if not self.settings.shake:
            play.scene.camera.trauma = 0.0
        frame = play.draw(self.picture)
        if self.settings.show_fps:
            frame.text_if_free(f"{self.frame_seconds * 1000:.1f} ms a frame", frame.area.right - 4, frame.area.top + 4,
                               GOLD, SMALL, frame.text_scale, "right", True)
        play.session.report.note_drawing(perf_counter() - drawn)
        if play.wants_screenshot:
            play.wants_screenshot = False
            self._save_screenshot()
        ended = self.options.frames or (self.options.recording and self.options.recording.frames)
        if ended and play.session.report.steps >= ended:
            self.running = False

    def _turn_screen(self, now):
        for _ in range(self.clock.advance(now)):
            self.inputs.set(self.devices.next())
            self.screen.step(self.inputs, STEP_SECONDS)
        self.picture.draw_screen(self.screen)

    def _feed(self, event):
        if event.type == pygame.QUIT:
            self.running = False
        elif event.type == pygame.KEYDOWN and event.key == pygame.K_F11:
            self.settings.fullscreen = not self.settings.fullscreen
            self._apply_settings()
        elif event.type in (pygame.VIDEORESIZE, pygame.WINDOWSIZECHANGED):
            self.picture.presenter.frame.surface = pygame.display.get_surface()
        elif not (hasattr(self.screen, "feed") and self.screen.feed(event)):
            self.devices.feed(event)

    def _follow(self, outcome):
        """Open the screen that the last one named."""
        kind, *rest = outcome
        if isinstance(self.screen, Options):
            self._apply_settings()
        if isinstance(self.screen, Play) and (self.options.scene or kind == "quit"):
            self.screen.outcome = None
            if self.options.frames or self.options.record or self.options.replay or self.options.json:
                self.running = False       # such a run is about one scene; leaving it ends the program
                return
            self.options.scene = None
        self.devices.release_all()
        self.inputs = InputState()
        if kind == "quit":
            self.running = False
        elif kind == "title":
            self.screen = Title()
        elif kind == "menu":
            self.screen = Menu(self.registry, rest[0] if rest else getattr(self, "last_played", None))
        elif kind == "options":
            self.screen = Options(self.settings)
        else:
            self.screen = self._play(rest[0])

    def _play(self, name, first=False):
        """A Play screen for a scene, its kernels compiled behind a bar. `first`: the command line's scene."""
        self.last_played = name
        options = self.options
        scene_class = self.registry.scene_class(name)
        loading = Loading(scene_class.title)

        def compile_for(solver):
            loading.show(self.picture, 0.0, "")
            warm_up_scene(scene_class, options.broadphase, solver,
                          lambda done, total, kernel: loading.show(self.picture, done / max(total, 1), kernel))
        compile_for(options.solver if first else None)
        if first:
            scene = make_scene(options, self.registry)
            play = Play(scene, self.devices, self.sounds, options.bot, options.recording, bool(options.record),
                        options.overlay)
        else:
            play = Play(scene_class(options.seed or 0), self.devices, self.sounds)
        play.prepare = compile_for
        return play

    def _apply_settings(self):
        """Put changed settings to work and save them; a failed save is said and does not stop the game."""
        self.picture.presenter.frame.surface = set_mode(self.settings)
        self.devices.keys = key_codes(self.settings.keys)
        self.sounds.volume = self.settings.volume
        try:
            save_settings(self.settings)
        except OSError as error:
            say(f"settings could not be saved: {error}")

    def _save_recording(self):
        recorder = self.screen.session.recorder if isinstance(self.screen, Play) else None
        if recorder is not None:
            save_or_fail(recorder.save, self.options.record)

    def _save_screenshot(self):
        """F12: into the player's folder, under the time."""
        folder = data_folder() / "screenshots"
        path = folder / f"{self.screen.scene.name.replace('/', '-')}-{strftime('%Y%m%d-%H%M%S')}.png"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            save_png(self.picture.presenter.frame.surface, path)
            say(f"saved {path}")
        except OSError as error:
            say(f"screenshot could not be saved: {error}")
