"""The stack of screens, and the actions for each outcome. game/screens/screen.py defines the interface of a screen."""

from collections.abc import Callable
from pathlib import Path
from time import strftime

from game.drawing.window import copy_text
from game.errors import UsageError
from game.files.best_run import keep_ghost, load_ghost
from game.files.data_folder import free_name
from game.files.own_levels import level_digest
from game.files.records import Entry
from game.input.bindings import help_pairs
from game.run.options import make_scene
from game.run.replay_check import load_replay_for
from game.run.replay_shelf import put_recent, replays_folder
from game.run.tape import Tape
from game.scene import set_loaded_aside
from game.screens.arcade import Arcade
from game.screens.attract import Attract
from game.screens.menu import Menu
from game.screens.message_screen import error_message
from game.screens.near_misses import NearMisses
from game.screens.parts import effect_rows
from game.screens.parts.background import SceneBackground
from game.screens.pause_menu import PauseMenu
from game.screens.play import Play
from game.screens.replays_screen import ReplaysScreen
from game.screens.result_screen import ResultScreen
from game.screens.scores_screen import ScoresScreen, pages_of
from game.screens.screen import CanvasScreen, Outcome, SceneScreen
from game.screens.settings_screen import SettingsScreen
from game.screens.title import Title
from game.screens.tour import Tour
from game.screens.watch import Watch
from game.startup import say

AnyScreen = CanvasScreen | SceneScreen
PLOTTED, EFFECTS_LAB = "shooter", "lab/effects"  # scenes that the title's entries open


class Screens:
    """The stack of screens. Only the top screen is visible and audible. `played`: the game on the stack, or None."""

    def __init__(self, arcade: Arcade) -> None:
        self.arcade = arcade
        self.stack: list[AnyScreen] = []
        self.played: Play | None = None
        self.last_played: str | None = None  # name of the scene played last, marked in the menu
        self.table: dict[str, Callable[..., None]] = {
            "title": self.title,
            "menu": self.menu,
            "back": self.back,
            "settings": self.settings,
            "scores": self.scores,
            "replays": self.replays,
            "watch": self.watch,
            "file": self.open_file,
            "tour": self.tour,
            "costs": self.costs,
            "plot": self.plot,
            "effects": self.effects,
            "attract": self.attract,
            "play": self.play,
            "pause": self.pause,
            "restart": self.restart,
            "again": self.restart,
            "result": self.result,
            "save_replay": self.save_replay,
            "quit": self.quit,
        }
        self.newest: tuple[str, int | None] | None = None  # (table, place) of the last entry, marked in the high scores

    def open_first(self) -> None:
        """Open the first screen, according to the command line: a recording, a scene, or the title."""
        arcade, options = self.arcade, self.arcade.options
        if options.replay and not options.is_a_run:
            self.watch(options.replay)
        elif options.scene:
            self.play_first()
        else:
            self.title(arcade.message)

    @property
    def top(self) -> AnyScreen:
        """The top screen of the stack."""
        return self.stack[-1]

    def follow(self, outcome: Outcome) -> None:
        """Execute an outcome (name, *arguments) of the top screen: call the function that `table` has for the name.

        A UsageError, such as one about an unusable file, is shown as a message.
        """
        name, *rest = outcome
        self.top.outcome = None
        try:
            self.table[name](*rest)
        except UsageError as error:
            self.complain(error, name not in ("watch", "file"))

    def complain(self, error: UsageError, ends_scene: bool = True) -> None:
        """Show a message about an error, such as an unusable file, over the screen to which the player returns.

        ends_scene: whether the error concerns the scene on top, which is then closed.
        """
        if ends_scene and self.top.shows_scene:
            self.stack.pop()
        if self.played not in self.stack:
            self._leave_play()
        if not self.stack:
            self.stack = [Title(), self._scene_menu()]
        self.stack.append(error_message(error))

    def _scene_menu(self) -> Menu:
        return Menu(self.arcade.registry, self.arcade.records, self.last_played)

    def _ground(self) -> SceneBackground | None:
        return SceneBackground(self.played.scene) if self.played else None

    def title(self, message: str = "") -> None:
        """Show the title as the only screen. message: a line of text to show on it, or ""."""
        self._leave_play()
        self.stack = [Title(message)]

    def menu(self) -> None:
        """Show the scene menu, with the title below it on the stack."""
        self._leave_play()
        self.stack = [Title(), self._scene_menu()]

    def back(self) -> None:
        """Return to the screen below the top one, or to the title if there is none."""
        self.stack.pop().close()
        if not self.stack:
            self.stack = [Title()]
        self.top.resume()

    def settings(self, page: str | None = None) -> None:
        """Open the settings over the current screen. page: the page to open first, or None."""
        arcade = self.arcade
        changed, saved = self._settings_changed, arcade.save_settings
        self.stack.append(SettingsScreen(arcade.settings, arcade.devices, changed, self._ground(), page, saved))

    def _settings_changed(self):
        self.arcade.apply_settings()
        if self.played:
            self.played.apply_settings()

    def scores(self) -> None:
        """Open the high scores. If a game is on the stack, its table is shown first."""
        arcade, play = self.arcade, self.played
        pages = pages_of(arcade.registry, arcade.records, play and (play.scene.name, play.scene.level_file))
        self.stack.append(ScoresScreen(pages, arcade.records, play and play.table, self.newest, self._ground()))

    def replays(self) -> None:
        """Open the list of replays."""
        self.stack.append(ReplaysScreen(self.arcade.registry, copy_text))

    def open_file(self, path: str | Path) -> None:
        """Open a file that was dropped on the window. Raises UsageError for an unusable file.

        A PNG picture is opened in the scene that can load pictures as levels. Any other file is played as a recording.
        After an error, the current game continues.
        """
        classes = self.arcade.registry.all_classes() if Path(path).suffix.lower() == ".png" else []
        taker = next((each for each in classes if each.takes_level and each.level_suffix == ".png"), None)
        if taker is None:
            self.watch(path)
            return
        arcade = self.arcade
        level_digest(path)
        scene = taker(arcade.options.seed or 0, level=Path(path))
        self._leave_play()
        self.stack = [Title(), self._scene_menu()]
        self._begin(Play(scene, arcade.devices, arcade.sounds, settings=arcade.settings))

    def watch(self, path: str | Path) -> None:
        """Play a recording. Raises UsageError if the file is unusable."""
        arcade = self.arcade
        recording, scene_class = load_replay_for(path, arcade.registry)
        level = recording.level_path()

        def make():
            return scene_class(recording.seed, recording.broadphase, recording.solver, recording.tier, level)

        tape, name = Tape(make, recording), str(recording.path)
        self.stack.append(Watch(tape, arcade.devices, arcade.sounds, arcade.settings.accessibility(), name))

    def tour(self) -> None:
        """Open the tour of the overlays."""
        arcade = self.arcade
        accessibility = arcade.settings.accessibility()
        self.stack.append(Tour(self._make_shown, arcade.registry.names, arcade.devices, accessibility))

    def costs(self) -> None:
        """Open the split screen of near misses, from which the player reaches the plot of accuracy and cost."""
        self.stack.append(NearMisses())

    def plot(self) -> None:
        """Open the plot of accuracy and cost beside the paused game.

        Without a game, start the shooter, played by its bot.
        """
        self.stack.pop().close()
        if self.played is None:
            names = self.arcade.registry.names
            self.play(PLOTTED if PLOTTED in names else names[0], bot=True)
        self._open_in_game(Play.toggle_costs, "costs_open")

    def effects(self) -> None:
        """Open the panel of the paused game, which shows the cost of each effect.

        Without a game, start the lab of effects.
        """
        if self.played is not None:
            self._open_in_game(Play.toggle_panel, "panel_open")
            self._game().panel.show(effect_rows.TITLE)
        elif EFFECTS_LAB in self.arcade.registry.names:
            self.play(EFFECTS_LAB)
        else:
            self.menu()

    def _open_in_game(self, toggle, name):
        """Return to the game, and open one of its panels with toggle(play), a method of Play.

        name: name of the attribute of Play that is True while the panel is open.
        """
        play = self._game()
        while self.top is not play:
            self.stack.pop().close()
        play.resume()
        if not getattr(play, name):
            toggle(play)

    def attract(self) -> None:
        """Start the demonstration. Any input ends it."""
        self.stack.append(Attract(self._make_shown, self.arcade.registry.names, self.arcade.settings.accessibility()))

    def _make_shown(self, name):
        return self.arcade.registry.scene_class(name)(0)

    def play(self, name: str, level: Path | None = None, bot: bool = False) -> None:
        """Play the scene `name`. level: level file of the player, or None; bot: whether the scene's bot plays."""
        arcade = self.arcade
        scene = arcade.registry.scene_class(name)(arcade.options.seed or 0, level=level)
        self._begin(Play(scene, arcade.devices, arcade.sounds, bot, settings=arcade.settings))

    def play_first(self) -> None:
        """Play the scene that the command line names, with its options."""
        arcade, options = self.arcade, self.arcade.options
        scene = make_scene(options, arcade.registry)
        play = Play(
            scene,
            arcade.devices,
            arcade.sounds,
            options.bot,
            options.recording,
            bool(options.record),
            options.overlay,
            arcade.settings,
            options.strict,
        )
        play.last_frame = options.last_frame
        self._begin(play)

    def _begin(self, play):
        self.last_played = play.scene.name
        set_loaded_aside()
        play.run_ended = self._keep_run
        play.settings_changed = self.arcade.save_settings
        if play.person:
            self._bring_best(play)
        self.stack.append(play)
        self.played = play

    def _bring_best(self, play):
        """Pass the best run so far to the scene of `play`: its points and, if ranked by time, its path as a ghost."""
        scene = play.scene
        best = self.arcade.records.best(play.table)
        if best is not None:
            scene.best = best.points
        scene.ghost = None
        if self.arcade.settings.ghost and scene.ranked_by == "seconds":
            scene.ghost, _, message = load_ghost(play.table)
            say(message)

    def _keep_run(self, recorder, result):
        try:
            put_recent(recorder, result)
        except OSError as error:
            say(f"the replay of this run could not be kept: {error}")

    def _leave_play(self):
        if self.played is not None:
            self.played.end_run()
            self.played.close()
            self.played = None

    def _game(self) -> Play:
        """Return the game on the stack, for the outcomes of the pause menu and of the result screen.

        These two screens are open only over a game.
        """
        assert self.played is not None
        return self.played

    def pause(self, message: str = "") -> None:
        """Open the pause menu. message: a line of text to show in it, or "".

        If the game has ended, its result is opened instead, so that its place in the high scores is not lost.
        """
        play = self._game()
        if play.scene.result is not None:
            self.result()
            return
        pairs = help_pairs(play.scene.actions, self.arcade.settings.keys)
        self.stack.append(PauseMenu(play.scene, play.renews, message, pairs))

    def restart(self) -> None:
        """Restart the game, and close the pause menu or the result screen over it."""
        play = self._game()
        while self.top is not play:
            self.stack.pop()
        play.restart()
        self._bring_best(play)
        play.resume()

    def result(self) -> None:
        """Open the result of the game. If the result is ranked, the screen asks for initials."""
        arcade, play = self.arcade, self._game()
        scene, result = play.scene, play.scene.result
        assert result is not None
        entry = Entry(
            arcade.settings.initials,
            int(result.points),
            round(float(result.seconds), 3),
            strftime("%Y-%m-%d"),
            scene.seed,
            play.assisted,
        )
        table, notes = play.table, []
        place = arcade.records.place(table, scene.ranked_by, entry) if result.ranks(scene.ranked_by) else None
        if result.won and scene.trail and scene.ranked_by == "seconds" and not play.assisted:
            try:
                if keep_ghost(table, scene.trail, entry.seconds):
                    notes.append("your fastest: it will run beside you as a ghost")
            except OSError as error:
                notes.append(f"the ghost could not be saved: {error.strerror or error}")

        def enter(initials):
            arcade.settings.initials = initials
            arcade.save_settings()
            self.newest = table, arcade.records.add(table, scene.ranked_by, Entry(**{**vars(entry), "name": initials}))
            try:
                say(arcade.records.save())
            except OSError as error:
                screen.notes.append(f"the table could not be saved: {error.strerror or error}")

        screen = ResultScreen(scene, result, place, arcade.settings.initials, enter, play.renews, notes, play.assisted)
        self.stack.append(screen)

    def enter_results(self) -> None:
        """Enter an ended game into the high scores with the last used initials.

        This is called when the window closes.
        """
        play = self.played
        if play is not None and play.since_result and not any(screen.shows_result for screen in self.stack):
            self.result()
        for screen in self.stack:
            screen.accept()

    def save_replay(self) -> None:
        """Save a replay of the run so far, and show the file's name."""
        play = self._game()
        assert play.recorder is not None  # otherwise the screens do not offer it
        play.drop_future()
        try:
            path = free_name(replays_folder(), play.scene.name)
            play.recorder.save(path, play.scene.result)
            self.top.report(f"Saved as {path.name}")
        except OSError as error:
            self.top.report(f"It could not be saved: {error.strerror or error}")

    def quit(self) -> None:
        """End the program."""
        self._leave_play()
        self.arcade.running = False
