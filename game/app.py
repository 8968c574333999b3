"""The window's program: events in, fixed steps, a picture out. Which screen is next is told in game/screens/stack.py."""

from time import perf_counter

import pygame

from game.audio.sound import Sounds
from game.drawing.canvas import SMALL
from game.drawing.colors import GOLD
from game.drawing.window import mode_of, open_window, set_mode
from game.errors import UsageError
from game.files.data_folder import data_folder, free_name
from game.files.records import load_records
from game.files.settings import load_settings, save_settings
from game.input.devices import DeviceSource
from game.input.inputs import InputState
from game.input.pads import Pads
from game.run.headless import finish, save_or_fail
from game.run.loop import FixedStep
from game.run.picture import Picture, save_png
from game.run.warmup import warm_up_scene
from game.scene import STEP_SECONDS
from game.screens.loading import Loading, LoadingStopped
from game.screens.parts.wipe import Wipe
from game.screens.pause_menu import PauseMenu
from game.screens.play import Play
from game.screens.stack import Screens
from game.screens.watch import Watch
from game.startup import say

IDLE_SECONDS = 0.002  # rest between frames when the display does not wait for its refresh
QUIET = 0.3  # of the music's volume while nobody plays


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


class App:
    """What all screens share, and the loop that runs the one on top."""

    def __init__(self, options, registry, settings, surface, message=""):
        self.options, self.registry, self.settings = options, registry, settings
        self.records, lost = load_records()
        say(lost)
        self.picture = Picture(surface)
        self.pads = Pads()
        self.devices = DeviceSource(self.picture.presenter.to_canvas, settings.keys, self.pads, settings.buttons)
        self.sounds = Sounds(settings.master, settings.effects, settings.music)
        say(self.sounds.silent_because)
        self.mode = mode_of(settings)
        self.inputs = InputState()
        self.clock = FixedStep()
        self.wipe = Wipe()
        self.frame_seconds = STEP_SECONDS
        self.before = None
        self.running = True
        self.screens = Screens(self)
        self._open_first(message or lost)
        self.apply_settings()

    def _open_first(self, message):
        recording = self.options.recording
        try:
            if recording is not None and not self._is_a_run():
                self.screens.stack.append(self.screens.watching(self.options.replay))
            elif self.options.scene:
                self.screens.play_first()
            else:
                self.screens.title(message)
        except LoadingStopped:
            self.screens.title(message)
            self.stop_if_closed()

    def _is_a_run(self):
        """True for a run that the command line measures or saves: it is about one scene, and ends with it."""
        o = self.options
        return bool(o.frames or o.record or o.json or o.profile or o.screenshot)

    @property
    def screen(self):
        """The screen on top."""
        return self.screens.top

    def run(self):
        """The loop. Returns the exit code."""
        code = 0
        try:
            while self.running:
                self.turn()
        finally:
            self._save_what_is_open()
        play = self.screens.played
        if play is not None and self.options.scene:
            if self.options.screenshot:
                frame = self.picture.presenter.frame
                save_or_fail(lambda path: save_png(frame.surface, path), self.options.screenshot)
            code = finish(play.scene, play.session.report, self.options)
        elif isinstance(self.screen, Watch) and self.screen.tape.diverged:
            say(self.screen.tape.diverged)
            code = 1
        return code

    def turn(self):
        """One turn of the loop: events, due steps, one picture."""
        started = perf_counter()
        try:
            for event in pygame.event.get():
                self._feed(event)
            if hasattr(self.screen, "advance"):
                self._turn_scene(started)
            else:
                self._turn_menu(started)
        except UsageError as error:
            if self._is_a_run():
                raise
            self.screens.complain(error)
            self._arrive()
            return
        except LoadingStopped:
            self.stop_if_closed()
            return
        self.wipe.draw(self.picture.presenter.frame.surface, started, self.settings.reduced_flashing)
        self._sound(started)
        pygame.mouse.set_visible(self.screen.shows_pointer)
        pygame.display.flip()
        self._rest(started)
        if self.screen.outcome is not None:
            self._follow(self.screen.outcome)

    def _turn_scene(self, now):
        """A screen that shows a scene: it keeps its own time and draws at the window's resolution."""
        screen = self.screen
        if isinstance(screen, Play):
            screen.advance(now, self.options.frames)
            drawn = perf_counter()
        else:
            screen.advance(now)
        frame = screen.draw(self.picture)
        if self.settings.show_fps:
            frame.text_if_free(
                f"{self.frame_seconds * 1000:.1f} ms a frame",
                frame.area.right - 4,
                frame.area.top + 4,
                GOLD,
                SMALL,
                frame.text_scale,
                "right",
                True,
            )
        if isinstance(screen, Play):
            screen.session.report.note_drawing(perf_counter() - drawn)
            self._end_run(screen)

    def _end_run(self, play):
        if play.wants_screenshot:
            play.wants_screenshot = False
            self._save_screenshot(play.scene.name)
        ended = self.options.frames or (self.options.recording and self.options.recording.frames)
        if ended and play.session.report.steps >= ended and self.options.scene:
            self.running = False

    def _turn_menu(self, now):
        screen = self.screen
        for _ in range(self.clock.advance(now)):
            self.inputs.set(self.devices.next())
            screen.step(self.inputs, STEP_SECONDS)
            if screen.outcome is not None:
                break
        self.picture.draw_screen(screen)

    def _sound(self, now):
        """The menu's sounds and the tune of this moment."""
        screen = self.screen
        if getattr(screen, "cues", None):
            self.sounds.play_cues([(name, None, 1.0) for name in screen.cues])
            screen.cues.clear()
        if screen.tune is not None:
            self.sounds.tune(screen.tune)
        self.sounds.music = self.settings.music * (QUIET if getattr(screen, "quiet", False) else 1.0)
        self.sounds.step(0.0 if self.before is None else now - self.before)
        self.before = now

    def _rest(self, started):
        """Wait for the next picture, so that an unpaced display does not burn a core."""
        spent = perf_counter() - started
        self.frame_seconds += (spent - self.frame_seconds) * 0.05
        wanted = 1.0 / self.settings.frame_cap if self.settings.frame_cap else 0.0
        if spent < wanted:
            pygame.time.wait(max(1, int((wanted - spent - IDLE_SECONDS) * 1000)))

    def _feed(self, event):
        if event.type == pygame.QUIT:
            self.running = False
        elif event.type == pygame.KEYDOWN and event.key == pygame.K_F11:
            self.settings.fullscreen = not self.settings.fullscreen
            self.apply_settings()
            self.save_settings()
        elif event.type in (pygame.VIDEORESIZE, pygame.WINDOWSIZECHANGED):
            self.picture.presenter.frame.surface = pygame.display.get_surface()
        elif event.type == pygame.DROPFILE:
            self._follow(("watch", event.file))
        else:
            if event.type == pygame.WINDOWFOCUSLOST and isinstance(self.screen, Play) and self.screen.person:
                self.screen.outcome = self.screen.outcome or ("pause", "")
            if not (hasattr(self.screen, "feed") and self.screen.feed(event)):
                self.devices.feed(event)

    def stop_if_closed(self):
        """End the program if the window's closing waits in the queue: it was what stopped the loading."""
        self.running = self.running and not pygame.event.peek(pygame.QUIT)

    def _follow(self, outcome):
        """Go where the top screen leads; the old picture is wiped away."""
        if outcome[0] == "menu" and self.screens.played is not None:
            if self.options.scene and (self._is_a_run() or self.options.recording):
                self.running = False  # such a run is about one scene; leaving it ends the program
                self.screen.outcome = None
                return
            self.options.scene = None
        self.wipe.begin(self.picture.presenter.frame.surface, perf_counter())
        self.screens.follow(outcome)
        self._arrive()

    def _arrive(self):
        """Another screen is on top: nothing is held there yet, and its time begins."""
        self.devices.release_all()
        self.devices.menus = not isinstance(self.screen, Play)
        self.devices.lost_pad = False
        if isinstance(self.screen, PauseMenu):
            self.sounds.pause()
        else:
            self.sounds.resume()
        self.inputs = InputState()
        self.clock.rest()

    def compile_for(self, scene_class, solver=None, broadphase=None, stops_for_anybody=False):
        """Compile what a scene needs, behind a bar. Raises LoadingStopped."""
        loading = Loading(scene_class.title, stops_for_anybody)
        warm_up_scene(
            scene_class,
            broadphase or self.options.broadphase,
            solver,
            lambda done, total, kernel: loading.show(self.picture, done / max(total, 1), kernel),
        )

    def apply_settings(self):
        """Put changed settings to work."""
        if mode_of(self.settings) != self.mode:
            self.mode = mode_of(self.settings)
            self.picture.presenter.frame.surface = set_mode(self.settings)
        self.devices.bind(self.settings.keys, self.settings.buttons)
        self.sounds.master, self.sounds.effects = self.settings.master, self.settings.effects

    def save_settings(self):
        """Write the settings; a failed save is said and does not stop the game."""
        try:
            save_settings(self.settings)
        except OSError as error:
            say(f"settings could not be saved: {error}")

    def _save_what_is_open(self):
        """The window is closed mid-game: the run is kept, and what was asked for is written."""
        if not self.options.frames:
            self.screens.enter_results()
        self.save_settings()
        play = self.screens.played
        if play is not None and self.options.record and play.recorder is not None:
            save_or_fail(play.recorder.save, self.options.record)
        elif play is not None:
            play.end_run()

    def _save_screenshot(self, name):
        """F12: into the player's folder, under the time."""
        folder = data_folder() / "screenshots"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path = free_name(folder, name, ".png")
            save_png(self.picture.presenter.frame.surface, path)
            say(f"saved {path}")
        except OSError as error:
            say(f"screenshot could not be saved: {error}")
