"""Main loop of the windowed program: events, fixed steps and drawing.

The stack of screens is in game/screens/stack.py.
"""

from collections.abc import Iterator
from time import perf_counter

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import GOLD
from game.drawing.presenter import Frame
from game.drawing.typical import Typical
from game.drawing.window import open_window
from game.errors import UsageError
from game.files.data_folder import data_folder, free_name
from game.files.leftovers import remove_leftovers
from game.files.settings import Settings, load_settings
from game.input.inputs import InputState
from game.registry import Registry
from game.run.beside import Beside
from game.run.headless import finish, save_or_fail
from game.run.loop import FixedStep
from game.run.options import Options
from game.run.picture import save_png
from game.screens.arcade import Arcade
from game.screens.parts.status_line import draw_in_a_corner
from game.screens.parts.wipe import Wipe
from game.screens.screen import Outcome
from game.screens.stack import AnyScreen, Screens
from game.startup import say

IDLE_SECONDS = 0.002  # by which the wait for the next frame is shortened
QUIET = 0.3  # factor of the music's volume in quiet screens


def run_app(options: Options, registry: Registry) -> int:
    """Open the window and run the main loop until the window is closed. Return the exit code."""
    remove_leftovers(data_folder())
    settings, message = load_settings()
    say(message)
    beside = Beside(registry)
    try:
        surface = open_window(settings)
        if options.scene or options.replay:
            beside.start(plays=True)  # the title screen is not shown
        return App(options, registry, settings, surface, message, beside).run()
    finally:
        beside.stop()
        pygame.quit()


class App:
    """Main loop of the windowed program. It runs the top screen of the stack `screens`.

    arcade: the state that all screens share.
    """

    def __init__(
        self,
        options: Options,
        registry: Registry,
        settings: Settings,
        surface: pygame.Surface,
        message: str = "",
        beside: Beside | None = None,
    ) -> None:
        self.options, self.settings, self.beside = options, settings, beside
        self.arcade = Arcade(options, registry, settings, surface, message)
        self.screens = Screens(self.arcade)
        self.inputs = InputState()
        self.clock = FixedStep()  # of the menus; a scene has its own clock
        self.wipe = Wipe()
        self.frame_time = Typical()  # [s] to make one picture, without the wait for the next
        self.before: float | None = None
        self.screens.open_first()
        self.arcade.apply_settings()

    @property
    def screen(self) -> AnyScreen:
        """The top screen of the screen stack."""
        return self.screens.top

    @property
    def window(self) -> pygame.Surface:
        """The pygame surface of the window."""
        return self.arcade.picture.presenter.frame.surface

    def run(self) -> int:
        """Run the loop until the program ends. Return the exit code."""
        try:
            while self.arcade.running:
                self.turn()
        except pygame.error as error:
            if pygame.display.get_surface() is not None:
                raise
            raise UsageError(f"the display is gone ({error}); what was played and chosen is kept") from error
        finally:
            self._save_what_is_open()
        play = self.screens.played
        if play is not None and self.options.scene:
            if self.options.screenshot:
                save_or_fail(lambda path: save_png(self.window, path), self.options.screenshot)
            return finish(play.scene, play.session.report, self.options)
        say(self.screen.failure)
        return 1 if self.screen.failure else 0

    def turn(self) -> None:
        """Run one iteration of the loop: events, due steps, one picture."""
        started = perf_counter()
        try:
            for event in pygame.event.get():
                self._feed(event)
            frame = self.screen.turn(started, self._menu_steps(started), self.arcade.picture)
            self._after_drawing(frame)
            self.screen.note_busy(perf_counter() - started)
        except UsageError as error:
            if self.options.is_a_run:
                raise
            self.screens.complain(error)
            self._arrive()
            return
        self.wipe.draw(self.window, started, self.settings.reduced_flashing)
        self._sound(started)
        pygame.mouse.set_visible(self.screen.shows_pointer)
        pygame.display.flip()
        if self.beside is not None:
            self.beside.turn(self.screen.shows_scene)
        self._rest(started)
        if self.screen.outcome is not None:
            self._follow(self.screen.outcome)

    def _menu_steps(self, now: float) -> Iterator[InputState]:
        """Yield the player's input once for each menu step that is due at `now` [s].

        A screen that shows a scene ignores this iterator, because it has its own clock.
        """
        for _ in range(self.clock.advance(now)):
            self.inputs.set(self.arcade.devices.next())
            yield self.inputs

    def _after_drawing(self, frame: Frame | None) -> None:
        if frame is not None and self.beside is not None and (share := self.beside.share) < 1.0:
            play = self.screens.played
            lighter = play.lighter.line if play is not None and play.lighter is not None else ""
            draw_in_a_corner(frame, f"{lighter or 'getting faster'}: {share:.0%}")
        if frame is not None and self.settings.show_fps:
            text = f"{self.frame_time.value * 1000:.1f} ms a frame"
            x, y = frame.area.right - 4, frame.area.top + 4
            frame.text_if_free(text, x, y, GOLD, SMALL, frame.text_scale, "right", True)
        screen = self.screen
        if screen.wants_screenshot:
            screen.wants_screenshot = False
            self._save_screenshot()
        if screen.finished:
            self.arcade.running = False

    def _sound(self, now: float) -> None:
        """Play the queued sounds of the top screen, and update the music. now: current time [s]."""
        screen, sounds = self.screen, self.arcade.sounds
        if screen.cues:
            sounds.play_cues([(name, None, 1.0) for name in screen.cues])
            screen.cues.clear()
        if screen.tune is not None:
            sounds.tune(screen.tune)
        sounds.music = self.settings.music * (QUIET if screen.quiet else 1.0)
        sounds.step(0.0 if self.before is None else now - self.before)
        self.before = now

    def _rest(self, started: float) -> None:
        """Wait until the frame cap allows the next frame.

        Without vsync and this wait, the loop would occupy a whole core. started: time at which this iteration of the
        loop began [s].
        """
        spent = perf_counter() - started
        self.frame_time.note(spent)
        wanted = 1.0 / self.settings.frame_cap if self.settings.frame_cap else 0.0
        if spent < wanted:
            pygame.time.wait(max(1, int((wanted - spent - IDLE_SECONDS) * 1000)))

    def _feed(self, event: pygame.event.Event) -> None:
        if event.type == pygame.QUIT:
            self.arcade.running = False
        elif event.type == pygame.KEYDOWN and event.key == pygame.K_F11:
            self.settings.fullscreen = not self.settings.fullscreen
            self.arcade.apply_settings()
            self.arcade.save_settings()
        elif event.type in (pygame.VIDEORESIZE, pygame.WINDOWSIZECHANGED):
            self.arcade.picture.presenter.frame.surface = pygame.display.get_surface() or self.window
        elif event.type == pygame.DROPFILE:
            self._follow(("file", event.file))
        else:
            if event.type == pygame.WINDOWFOCUSLOST:
                self.screen.lose_focus()
            if not self.screen.feed(event):
                self.arcade.devices.feed(event)

    def _follow(self, outcome: Outcome) -> None:
        """Switch to the screen that the top screen requests with `outcome`, with a wipe as the transition.

        For some runs that the command line starts, the request for the menu ends the program instead.
        """
        if outcome[0] == "menu" and self.screens.played is not None:
            if self.options.scene and (self.options.is_a_run or self.options.recording):
                self.arcade.running = False  # such a run is about one scene: leaving the scene ends the program
                self.screen.outcome = None
                return
            self.options.scene = None
        self.wipe.begin(self.window, perf_counter())
        self.screens.follow(outcome)
        self._arrive()

    def _arrive(self) -> None:
        """Release all inputs, restart the clock, and pause or resume the music, as the new top screen requires."""
        devices, sounds = self.arcade.devices, self.arcade.sounds
        devices.release_all()
        devices.menus = not self.screen.takes_game_input
        devices.lost_pad = False
        if self.screen.holds_music:
            sounds.pause()
        else:
            sounds.resume()
        self.inputs = InputState()
        self.clock.rest()

    def _save_what_is_open(self) -> None:
        """Before the program ends, save the high score, the settings and the current run or its recording."""
        if not self.options.frames:
            self.screens.enter_results()
        self.arcade.save_settings()
        play = self.screens.played
        if play is not None and self.options.record and play.recorder is not None:
            save_or_fail(play.recorder.save, self.options.record)
        elif play is not None:
            play.end_run()

    def _save_screenshot(self) -> None:
        """Save a screenshot in the player's folder. Its file name contains the scene's name and the time."""
        folder, play = data_folder() / "screenshots", self.screens.played
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path = free_name(folder, play.scene.name if play else "hitbox", ".png")
            save_png(self.window, path)
            say(f"saved {path}")
        except OSError as error:
            say(f"screenshot could not be saved: {error}")
