"""Measurements of a scene while it is played, made in other processes, and changes of the scene's setting."""

from collections.abc import Callable, Hashable, Sequence
from operator import is_
from typing import NamedTuple

from game.files.data_folder import free_name, measurements_folder, short_path, write_atomically
from game.input.devices import DeviceSource
from game.measure.advice import advised, settings_within, share
from game.measure.errors import VISIBLE
from game.measure.moment import here_of
from game.measure.setting import Setting, settings_around
from game.measure.survey_csv import csv_of
from game.measure.surveyor import Surveyor
from game.measure.tuner import Tuner
from game.measurement_requests import RunRequest, SpriteRequest
from game.run import run_worker
from game.run.figures_csv import command_of, figures_csv
from game.run.proven_advice import LEAST_STEPS, Applied
from game.run.recorded_run import RecordedRun, changes_to
from game.run.replay import Recorder
from game.run.warmup import pieces_of
from game.scene import Scene
from game.screens.parts.race import Race
from game.screens.parts.race_split import SplitScreen
from game.startup import start_line
from physics import World

NO_RACE = "no race: nothing can be switched here"
RIVALS_NAMED = 4  # settings named in a message
LINGER = 0.5  # [s] for which the panel must be open before the effects are measured
EVERY = 8.0  # [s] between two moments (measured states of the world), if the last one is done and the game runs


class Proof(NamedTuple):
    """A test of a setting on the recorded run, as ordered from the measuring process."""

    here: Setting  # the present setting at that time
    setting: Setting
    steps: int  # of the run
    number: int  # index of the result in Surveyor.proofs


class Measuring:
    """The measurements of one played scene. beside() and turn() continue them; close() and leave() end them.

    recorder(): returns the recorder of the current run; None if the run is not recorded.
    """

    def __init__(self, scene: Scene, devices: DeviceSource, recorder: Callable[[], Recorder | None]) -> None:
        self.scene, self.devices, self.recorder = scene, devices, recorder
        self.surveyor = Surveyor(run_worker.__name__)
        self.tuner = Tuner(self.surveyor.survey, self._try, self.prove)
        self.asked: Proof | None = None  # the last advice that was tried on the recorded run
        self.advice: tuple[Setting, float | str | None] | None = (
            None  # the advised setting, and what prove() says of it
        )
        self.bench = Surveyor()  # for the scene's measurement requests …
        self.benched: SpriteRequest | Sequence[Hashable] | None = (
            None  # … which are these sprites, or runs of these names
        )
        self.ledger = Surveyor()  # for the effects
        self.opened_at: float | None = None  # [s] opening time of the panel; None: it is closed
        self.whole = False  # whether the scene's choice of effects was measured, or is being measured
        self.weighed = False  # whether the effects were measured since the panel was opened
        self.taken_at: tuple[float, int] | None = None  # [s] and step of the last moment
        self.race: Race | None = None  # the running race; None: there is none
        self.split: SplitScreen | None = None  # split screen of the race; None: the rival is drawn over the scene
        self.against = 0  # index in rivals(), as chosen in the panel

    @property
    def world(self) -> World:
        """The world whose settings are measured: the world in the scene's first view, which the overlays show."""
        return self.scene.views()[0][0]

    def now(self) -> Setting:
        """Return the current setting of the measured world."""
        return here_of(self.world, self.scene.tier)

    def beside(self, now: float, panel_open: bool) -> None:
        """Continue the measurements that the scene requests. While the panel is open, also measure the scene's effects.

        Call this once per picture, at `now` [s]. panel_open: whether the panel is open.
        """
        self._measure_request()
        if self.scene.weighs_effects:
            self.weigh_effects()
        self._measure_effects(now if panel_open else None)
        self.take_weights()

    def weigh_effects(self) -> None:
        """Measure the scene's choice of effects from the world's current state, unless this was done or has started."""
        if not self.whole:
            self.whole = True
            self.ledger.measure_effects(*self._weighed(), each=False)

    def _weighed(self):
        world = self.scene.weighed_world
        return world.snapshot(), world.broadphase.name, pieces_of(type(self.scene))

    def take_weights(self) -> None:
        """Store the results about effects that have arrived. Call this once per picture, also during an inspection."""
        if self.ledger.process is not None:
            self.ledger.turn()
            if not self.ledger.busy:
                self.ledger.stop()
        self.scene.totals = self.ledger.totals

    def _measure_effects(self, now):
        """Measure the cost of each effect, from the world's state shortly after the panel is opened.

        now: current time [s]; None while the panel is closed.
        """
        if now is None:
            if self.opened_at is not None:
                self.whole = self.whole and not self.ledger.busy
                self.ledger.stop()
            self.opened_at = None
            return
        if self.opened_at is None:
            self.opened_at, self.weighed = now, False
        elif not self.weighed and now - self.opened_at >= LINGER:
            self.weighed = self.whole = True
            self.ledger.measure_effects(*self._weighed())

    def _measure_request(self) -> None:
        """Start the measurements that the scene requests, if the request is new, and pass all results to the scene."""
        request = self.scene.measured()
        if isinstance(request, SpriteRequest) and not (self.benched and all(map(is_, request, self.benched))):
            self.bench.stop()
            self.bench, self.benched = Surveyor(), request
            self.bench.measure_sprites(*request)
        if isinstance(request, RunRequest) and request.names != self.benched:
            self.benched = request.names
            self.bench.measure_runs(request)
        if self.bench.busy:
            self.bench.turn()
            if not self.bench.busy:
                self.bench.stop()
        self.scene.figures = self.bench.figures

    def turn(self, now: float) -> str:
        """Collect the results of measurements. When one is complete, start the next, of the world's current state.

        Call this once per frame. now [s]: present time. Return a line about a decision of the tuner, or "" if there is
        none.
        """
        self.surveyor.turn()
        best = advised(self.surveyor.survey, self.now())
        self.advice = None if best is None else (best, self.prove(best))
        self._take_moment(now)
        decided = self.tuner.step(self.scene.frame, self.now())
        if decided is None:
            return ""
        reported = f"{decided.after.label(decided.before)}, {decided.share:.2f} x the time"
        return f"tuned: {reported}" if not decided.refused else f"not tuned: {decided.refused}"

    def _try(self, setting):
        """Apply a setting. Return "" if it was applied, otherwise the reason why it cannot be applied."""
        changes = changes_to(setting, self.scene)
        if isinstance(changes, str):
            return changes
        self.apply(setting)
        return ""

    def prove(self, setting: Setting) -> float | str | None:
        """Test a setting on the run recorded so far. Return its time as a share of the time with the current setting.

        Return None while the test is running, or a text with the reason if the advice is withdrawn. A setting is tested
        again once the run is twice as long.
        """
        recorder, surveyor = self.recorder(), self.surveyor
        if recorder is None or recorder.frames < LEAST_STEPS:
            return f"a recorded run of {LEAST_STEPS} steps or more is needed to try it on"
        here, asked = self.now(), self.asked
        known = asked is not None and asked[:2] == (here, setting) and recorder.frames < 2 * asked.steps
        if asked is None or not known:
            if not surveyor.busy:
                self.asked = Proof(here, setting, recorder.frames, len(surveyor.proofs))
                predicted = share(surveyor.survey, setting, here)
                surveyor.prove(RecordedRun.of(self.scene, recorder), setting, predicted)
            return None
        if asked.number >= len(surveyor.proofs):
            return None
        applied = Applied.from_json(surveyor.proofs[asked.number])
        if applied.is_advisable(here in settings_within(surveyor.survey, VISIBLE)):
            return applied.mean
        return applied.refused or f"predicted {applied.predicted:.2f}, measured {applied.mean:.2f}: withdrawn"

    def _take_moment(self, now):
        frame = self.scene.frame
        if self.taken_at is not None:
            waits = self.surveyor.busy or now - self.taken_at[0] < EVERY or frame == self.taken_at[1]
            if waits or self.surveyor.trouble:
                return
        self.taken_at, recorder = (now, frame), self.recorder()
        run = RecordedRun.of(self.scene, recorder) if recorder is not None and recorder.frames else None
        self.surveyor.measure(self.world.snapshot(), self.world.broadphase.name, run)

    def close(self) -> None:
        """Stop the measurement of settings, unless the tuner is on.

        The results are kept, and more are added when the panel is opened again.
        """
        if self.tuner.on:
            return
        self.surveyor.stop()
        self.taken_at = None

    def leave(self) -> None:
        """End all measurements because the player leaves the scene."""
        self.tuner.on = False
        self.close()
        self.bench.stop()
        self.ledger.stop()

    def apply(self, setting: Setting) -> str:
        """Apply a setting as input of the next step, so that recordings contain it.

        Return a line of text that reports the change to the player.
        """
        now, changes = self.now(), changes_to(setting, self.scene)
        if isinstance(changes, str):
            return changes
        for name, value in changes:
            self.devices.change(name, value)
        return f"{setting.label(now)}, was {now.label(setting)}" if changes else "that is what runs"

    def start_race(self, setting: Setting) -> str:
        """Start a race against a copy of the scene under the given setting. Return a line of text for the player.

        The caller must restart the scene in the next step.
        """
        now, changes = self.now(), changes_to(setting, self.scene)
        if isinstance(changes, str):
            return changes
        self.race = Race(self.scene, changes)
        if self.split is not None:
            self.split = SplitScreen(self.race)
        return f"the race: {now.label(setting)} against {setting.label(now)}"

    def end_race(self) -> None:
        """End the race between the scene and its rival, and close the split screen."""
        self.race = self.split = None

    def toggle_split(self) -> str:
        """Switch the display of a race between a split screen and the rival's outlines over the scene.

        Return "", or a line of text for the player if there is no race.
        """
        if self.race is None:
            names = [setting.label(self.now()) for setting in self.rivals()]
            return f"no race: the panel starts one, against {', '.join(names[:RIVALS_NAMED])}" if names else NO_RACE
        self.split = None if self.split is not None else SplitScreen(self.race)
        return ""

    def boxes_or_pixels(self) -> Setting | None:
        """Return the setting to race against: boxes if the scene tests pixels, otherwise pixels.

        Return None for a scene without sprites, or if the scene does not support that setting.
        """
        now = self.now()
        if now.tier is None:
            return None
        rival = now._replace(tier="aabb" if now.tier in ("pixels", "mask") else "pixels")
        return None if isinstance(changes_to(rival, self.scene), str) else rival

    def save_figures(self) -> str:
        """Save the numbers of the scene as a CSV file in the user's folder, and the recorded run in the same folder.

        Return a line of text with the path. Raises OSError.
        """
        path, replay = self._places()
        write_atomically(path, figures_csv(self.scene, command_of(self.scene, replay and str(replay))))
        return f"saved as {short_path(path)}"

    def save_csv(self) -> str:
        """Save the survey as a CSV file in the user's folder, and the recorded run in the same folder.

        Return a line of text with the path. Raises OSError.
        """
        survey, scene = self.surveyor.survey, self.scene
        if not survey.dots:
            return "nothing is measured yet"
        path, replay = self._places()
        of = ("--seed", f"{scene.seed}", "--frames", f"{scene.frame}") if replay is None else ("--replay", str(replay))
        write_atomically(path, csv_of(survey, scene.name, start_line("--advise", scene.name, *of, "--json")))
        return f"saved as {short_path(path)}"

    def _places(self):
        """Save the recorded run, if any. Return (free path of a CSV file beside it, path of the recording or None)."""
        path, recorder = free_name(measurements_folder(), self.scene.name, ".csv"), self.recorder()
        if recorder is None or not recorder.frames:
            return path, None
        replay = path.with_suffix(".json")
        recorder.save(replay)
        return path, replay

    def rivals(self) -> list[Setting]:
        """Return the settings that the scene can be raced against.

        Each of these settings differs from the current setting by one change.
        """
        found = settings_around(self.now(), self.world.effects)[1:]
        return [setting for setting in found if not isinstance(changes_to(setting, self.scene), str)]
