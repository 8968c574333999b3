"""The stack of screens, and what each outcome of a screen leads to.

A screen has step(inputs, dt) and draw(canvas, alpha) where it is drawn on the canvas, or advance(now) and draw(picture)
where it shows a scene; `outcome` None or (name, ...) of the table below; `shows_pointer`; `tune` (None: what plays, plays
on); `cues`, the sounds of its menus; feed(event) and resume() where it has them.
"""

from time import strftime

from game.drawing.window import copy_text
from game.errors import UsageError
from game.files.best_run import keep_ghost, load_ghost
from game.files.data_folder import free_name
from game.files.records import Entry
from game.input.bindings import help_pairs
from game.run.options import make_scene
from game.run.replay_check import load_replay_for
from game.run.replay_shelf import put_recent, replays_folder
from game.run.tape import Tape
from game.scene import set_loaded_aside
from game.screens.attract import Attract
from game.screens.loading import LoadingStopped
from game.screens.menu import Menu
from game.screens.message_screen import file_message
from game.screens.parts.background import SceneGround
from game.screens.pause_menu import PauseMenu
from game.screens.play import Play
from game.screens.replays_screen import ReplaysScreen
from game.screens.result_screen import ResultScreen
from game.screens.scores_screen import ScoresScreen, pages_of
from game.screens.settings_screen import SettingsScreen
from game.screens.title import Title
from game.screens.tour import Tour
from game.screens.watch import Watch
from game.startup import say


class Screens:
    """`app` has what screens need: options, registry, settings, records, devices, sounds, compile_for ..."""

    def __init__(self, app):
        self.app = app
        self.stack = []
        self.table = {
            "title": self.title,
            "menu": self.menu,
            "back": self.back,
            "settings": self.settings,
            "scores": self.scores,
            "replays": self.replays,
            "watch": self.watch,
            "tour": self.tour,
            "attract": self.attract,
            "play": self.play,
            "pause": self.pause,
            "restart": self.restart,
            "again": self.restart,
            "result": self.result,
            "save_replay": self.save_replay,
            "quit": self.quit,
        }
        self.last_played = None
        self.newest = None  # (table, place) of the last entry, marked in the high scores

    @property
    def top(self):
        """The screen that is seen and heard."""
        return self.stack[-1]

    @property
    def played(self):
        """The Play screen on the stack, or None."""
        return next((screen for screen in reversed(self.stack) if isinstance(screen, Play)), None)

    def follow(self, outcome):
        """Open what the top screen named. A file that cannot be used becomes a message."""
        name, *rest = outcome
        self.top.outcome = None
        try:
            self.table[name](*rest)
        except UsageError as error:
            self.complain(error, name != "watch")
        except LoadingStopped:
            self.app.stop_if_closed()

    def complain(self, error, ends_scene=True):
        """Show why a file cannot be used, over what can be gone on with.

        ends_scene: False where it is about another file than that of the scene on top, which then goes on.
        """
        ended = self.played
        if ends_scene and isinstance(self.top, (Play, Watch, Tour, Attract)):
            self.stack.pop()
        if ended is not None and ended not in self.stack:
            ended.end_run()
        if not self.stack:
            self.stack = [Title(), Menu(self.app.registry, self.app.records, self.last_played)]
        self.stack.append(file_message(error))

    def _ground(self):
        return SceneGround(self.played.scene) if self.played else None

    def title(self, message=""):
        """The title and nothing else."""
        self._leave_play()
        self.stack = [Title(message)]

    def menu(self):
        """The scene menu, over the title."""
        self._leave_play()
        self.stack = [Title(), Menu(self.app.registry, self.app.records, self.last_played)]

    def back(self):
        """The screen below; the title where there is none."""
        left = self.stack.pop()
        if isinstance(left, SettingsScreen):
            self.app.save_settings()
        if not self.stack:
            self.stack = [Title()]
        if hasattr(self.top, "resume"):
            self.top.resume()

    def settings(self, page=None):
        """The settings, over a game or over the title."""
        app = self.app
        self.stack.append(SettingsScreen(app.settings, app.devices, self._settings_changed, self._ground(), page))

    def _settings_changed(self):
        self.app.apply_settings()
        if self.played:
            self.played.apply_settings()

    def scores(self):
        """The high scores, from a game those of its scene or level."""
        app, play = self.app, self.played
        pages = pages_of(app.registry, app.records, play and (play.scene.name, play.scene.level_file))
        self.stack.append(ScoresScreen(pages, app.records, play and play.table, self.newest, self._ground()))

    def replays(self):
        """The list of replays."""
        self.stack.append(ReplaysScreen(self.app.registry, copy_text))

    def watch(self, path):
        """A replay. Raises UsageError for one that cannot be used."""
        self.stack.append(self.watching(path))

    def watching(self, path):
        """The screen that plays a recording; its kernels are compiled first."""
        app = self.app
        recording, scene_class = load_replay_for(path, app.registry)
        level = recording.level_path()
        app.compile_for(scene_class, recording.solver, recording.broadphase)

        def make():
            return scene_class(recording.seed, recording.broadphase, recording.solver, recording.tier, level)

        return Watch(Tape(make, recording), app.devices, app.sounds, app.settings.accessibility(), str(recording.path))

    def tour(self):
        """The tour of the overlays."""
        app = self.app
        self.stack.append(Tour(self._make_demo, app.registry.names, app.devices, app.settings.accessibility()))

    def attract(self):
        """The bots play, until somebody comes."""
        self.stack.append(Attract(self._make_shown, self.app.registry.names, self.app.settings.accessibility()))

    def _make_demo(self, name):
        scene_class = self.app.registry.scene_class(name)
        self.app.compile_for(scene_class)
        return scene_class(0)

    def _make_shown(self, name):
        scene_class = self.app.registry.scene_class(name)
        try:
            self.app.compile_for(scene_class, stops_for_anybody=True)
        except LoadingStopped:
            return None
        return scene_class(0)

    def play(self, name, level=None):
        """A scene from the menu."""
        app = self.app
        scene_class = app.registry.scene_class(name)
        app.compile_for(scene_class)
        scene = scene_class(app.options.seed or 0, level=level)
        self._begin(Play(scene, app.devices, app.sounds, settings=app.settings))

    def play_first(self):
        """The scene that the command line names, with all it says about it."""
        app, options = self.app, self.app.options
        scene_class = app.registry.scene_class(options.scene)
        app.compile_for(scene_class, options.solver, options.broadphase)
        scene = make_scene(options, app.registry)
        self._begin(
            Play(
                scene,
                app.devices,
                app.sounds,
                options.bot,
                options.recording,
                bool(options.record),
                options.overlay,
                app.settings,
            )
        )

    def _begin(self, play):
        scene_class = type(play.scene)
        self.last_played = play.scene.name
        set_loaded_aside()
        play.prepare = lambda solver: self.app.compile_for(scene_class, solver)
        play.run_ended = self._keep_run
        play.settings_changed = self.app.save_settings
        if play.person:
            self._bring_best(play)
        self.stack.append(play)

    def _bring_best(self, play):
        """What the scene shows of the best run so far: its points, or its ghost."""
        scene = play.scene
        best = self.app.records.best(play.table)
        if best is not None and hasattr(scene, "best"):
            scene.best = best.points
        scene.ghost = None
        if self.app.settings.ghost and scene.ranked_by == "seconds":
            scene.ghost, _, message = load_ghost(play.table)
            say(message)

    def _keep_run(self, recorder, result):
        try:
            put_recent(recorder, result)
        except OSError as error:
            say(f"the replay of this run could not be kept: {error}")

    def _leave_play(self):
        play = self.played
        if play is not None:
            play.end_run()

    def pause(self, message=""):
        """The pause menu; after the end of a game its result, or its place in the table would be lost."""
        play = self.played
        if play.scene.result is not None:
            self.result()
            return
        pairs = help_pairs(play.scene.actions, self.app.settings.keys)
        self.stack.append(PauseMenu(play.scene, play.renews, message, pairs))

    def restart(self):
        """From the pause menu or the result back into the game, from its start."""
        while not isinstance(self.top, Play):
            self.stack.pop()
        self.top.restart()
        self._bring_best(self.top)
        self.top.resume()

    def result(self):
        """What came of the game; a run that ranks asks for initials."""
        app, play = self.app, self.played
        scene, result = play.scene, play.scene.result
        entry = Entry(
            app.settings.initials,
            int(result.points),
            round(float(result.seconds), 3),
            strftime("%Y-%m-%d"),
            scene.seed,
            play.assisted,
        )
        table, notes = play.table, []
        place = app.records.place(table, scene.ranked_by, entry) if result.ranks(scene.ranked_by) else None
        if result.won and scene.trail and scene.ranked_by == "seconds" and not play.assisted:
            try:
                if keep_ghost(table, scene.trail, entry.seconds):
                    notes.append("your fastest: it will run beside you as a ghost")
            except OSError as error:
                notes.append(f"the ghost could not be saved: {error.strerror or error}")

        def enter(initials):
            app.settings.initials = initials
            app.save_settings()
            self.newest = table, app.records.add(table, scene.ranked_by, Entry(**{**vars(entry), "name": initials}))
            try:
                say(app.records.save())
            except OSError as error:
                screen.notes.append(f"the table could not be saved: {error.strerror or error}")

        screen = ResultScreen(scene, result, place, app.settings.initials, enter, play.renews, notes, play.assisted)
        self.stack.append(screen)

    def enter_results(self):
        """The window closes: a place in the table that waits for its initials is taken with those entered last."""
        play = self.played
        if (
            play is not None
            and play.since_result
            and not any(isinstance(screen, ResultScreen) for screen in self.stack)
        ):
            self.result()
        for screen in self.stack:
            if isinstance(screen, ResultScreen):
                screen.accept()

    def save_replay(self):
        """Keep the run so far for good, and say where."""
        play, screen = self.played, self.top
        try:
            path = free_name(replays_folder(), play.scene.name)
            play.recorder.save(path, play.scene.result)
            message = f"Saved as {path.name}"
        except OSError as error:
            message = f"It could not be saved: {error.strerror or error}"
        if isinstance(screen, PauseMenu):
            screen.message = message
        else:
            screen.notes[:] = [message]

    def quit(self):
        """Out of the program."""
        self._leave_play()
        self.app.running = False
