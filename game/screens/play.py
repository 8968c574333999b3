"""The screen that plays a scene: its clock, overlays, panel, keys, and the end of a game."""

from collections.abc import Iterable
from functools import partial
from time import perf_counter

import pygame

from game.audio.sound import Sounds
from game.drawing.presenter import Frame
from game.files.records import table_of
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.measure.setting import Setting
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.picture import Picture
from game.run.replay import KEPT_EVERY, Recorder, Replay, chosen_before
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import Scene
from game.screens.parts.cost_panel import CostPanel
from game.screens.parts.inspector_view import InspectorView
from game.screens.parts.lab_card import LabCard, asks_for_card, first_card, what_to_see
from game.screens.parts.lighter import Lighter
from game.screens.parts.measuring import Measuring
from game.screens.parts.panel import Panel
from game.screens.parts.panel_rows import play_rows
from game.screens.parts.play_keys import press, press_button
from game.screens.parts.rumble import rumble
from game.screens.parts.status_line import RESULT_WAIT, draw_status
from game.screens.parts.step_inspector_view import StepInspectorView
from game.screens.parts.switches import Switches
from game.screens.parts.timeline import Timeline
from game.screens.screen import SceneScreen

RECORDED_ON = 120  # steps recorded after the end of a game, so that a replay shows the end
EASIER = ("tier", "narrowphase", "slider:")  # changes that make a score an assisted one


class Play(SceneScreen):
    """Screen on which a scene is played.

    `outcome`, the request for the next screen, becomes ("pause", message), ("result",), or ("menu",) for a bot's game.
    settings: the player's settings, or None in a test. A run of the player (not of a bot or a recording) is recorded in
    `recorder`, from its last restart on.
    """

    takes_game_input = True

    def __init__(
        self,
        scene: Scene,
        devices: DeviceSource,
        sounds: Sounds,
        bot: bool = False,
        recording: Replay | None = None,
        records: bool = False,
        overlays: Iterable[str] | None = None,
        settings: Settings | None = None,
        strict: bool = False,
    ) -> None:
        super().__init__()
        self.scene, self.devices, self.sounds, self.settings = scene, devices, sounds, settings
        self.last_frame: int | None = None  # number of steps after which the run ends; None: it does not end
        self.person = not bot and recording is None
        source = recording or (BotSource(devices) if bot else devices)
        self.renews = self.person and not records  # each attempt gets its own recording
        self.table = table_of(scene.name, scene.level_file)  # before the level's file may change or vanish
        self.recorder = Recorder(scene, bot, 1 if records else KEPT_EVERY) if records or recording is None else None
        self.session = Session(scene, source, self.recorder, recording, strict)
        self.overlays = Overlays(scene.overlays if overlays is None else overlays)
        self.timeline: Timeline | None = None  # a recording is rewound by Watch only
        if recording is None:
            self.timeline = Timeline(Rewind(self.session, lambda: self.overlays.watch(scene)), self._went)
        self.step_inspector = StepInspectorView(self.session, self.timeline and self.timeline.rewind, self.overlays)
        self.clock = FixedStep()
        self.panel = Panel(lambda: play_rows(self))
        self.panel_open = False
        self.measuring = Measuring(scene, devices, lambda: self.recorder)
        self.costs = CostPanel(self.measuring, self.try_setting, self.start_race, self.save_costs)
        self.costs_open = False
        self.inspector = InspectorView(scene)
        self.lighter = Lighter(scene, devices) if self.person else None
        self.run_ended = lambda recorder, result: None  # called with each run that ends, to keep it
        self.settings_changed = lambda: None
        self.assisted = False
        self.since_result = 0
        self.helped_since = 0  # the step from which the help line is shown
        self.now = 0.0  # [s] of the last turn
        self.switches = Switches(scene, devices)
        self.hint = first_card(scene, settings) if self.person and settings is not None else None
        self.apply_settings()

    @property
    def running_clock(self) -> FixedStep:
        """Clock that schedules the scene's steps."""
        return self.clock

    def note_busy(self, seconds: float) -> None:
        """Record the time [s] that the steps and the picture of this frame took."""
        super().note_busy(seconds)
        if self.lighter is not None:
            self.lighter.note(seconds)

    @property
    def tune(self) -> str | None:
        """Name of the scene's music at this moment; None if it has none."""
        return self.scene.music

    @property
    def open_panel(self) -> Panel | CostPanel | None:
        """The open panel; None if none is open."""
        return self.costs if self.costs_open else self.panel if self.panel_open else None

    @property
    def shows_pointer(self) -> bool:
        """Whether the mouse currently has a function on this screen."""
        working = self.open_panel is not None or self.clock.paused or self.hint is not None
        return working or self.scene.draggable or not self.scene.hides_pointer

    def apply_settings(self) -> None:
        """Apply the player's settings.

        Settings that affect the game become input of the next step, so that recordings contain them.
        """
        if self.settings is None:
            return
        self.scene.set_accessibility(self.settings.accessibility())
        if not self.person:
            return
        self.clock.game_speed = self.settings.speed
        pending = dict(self.devices.changes)
        for name, value in self.settings.assists().items():
            if name in self.scene.assist and pending.get(f"assist:{name}", self.scene.assist[name]) != value:
                self.devices.change(f"assist:{name}", value)

    def resume(self) -> None:
        """Update the clock and the settings when the screen is shown again."""
        self.clock.rest()
        self.apply_settings()
        if self.timeline is not None:
            self.timeline.let_go()

    @property
    def finished(self) -> bool:
        """Whether the last step was made, in a run whose number of steps is limited by the command line."""
        return self.last_frame is not None and self.session.report.steps >= self.last_frame

    def lose_focus(self) -> None:
        """Open the pause menu because the window lost focus."""
        if self.person:
            self.outcome = self.outcome or ("pause", "")

    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s], up to the last step of the run."""
        self.now = self.switches.now = now
        if self.devices.lost_pad and self.person:
            self.devices.lost_pad = False
            self.outcome = ("pause", "The controller is gone. Plug it in again, or play on with the keyboard.")
            return
        if self.step_inspector.open and not self.devices.changes:
            self.clock.rest()
            return
        self.step_inspector.leave()
        if self.timeline is not None and self.timeline.turn(now, self.clock.paused):
            self.clock.rest()
            return
        if self.session.replay is not None:
            self.devices.next()  # recorded input replaces it
        elif self.clock.paused and self.devices.changes and not self.clock.requested:
            self.clock.request_step()  # a change while paused makes one step, so that its effect is visible
        for _ in range(self.clock.advance(now)):
            if self.finished:
                return
            self.step()
            if self.outcome is not None:
                return

    def _went(self):
        """Update this screen after the timeline has moved the scene to another step."""
        assert self.timeline is not None
        self.assisted = True
        self.measuring.end_race()
        self.since_result = self.timeline.rewind.since_result
        if self.settings is not None:
            self.scene.set_accessibility(self.settings.accessibility())

    def drop_future(self) -> None:
        """Continue the game and its recording from the step to which it was rewound, with the current settings.

        The later steps are lost.
        """
        self.step_inspector.leave()
        if self.timeline is not None and not self.timeline.rewind.live:
            self.apply_settings()
        if self.timeline is not None:
            self.timeline.rewind.drop_future()

    def step(self) -> None:
        """Make one fixed step, play its sounds, and record its measurements."""
        self.drop_future()
        self.session.step()
        if self.timeline is not None:
            self.timeline.rewind.note()
        if self.measuring.race is not None:
            self.measuring.race.step(self.session)
        self.overlays.note(self.scene)
        self.sounds.play_cues(self.scene.cues)
        if self.person:
            self._note_help()
            rumble(self.scene, self.devices.pads, self.settings)
            self._note_result()

    def _note_help(self):
        """Mark the score as assisted if the player had help in this step.

        Help is slow motion, a pause, an easier setting, invincibility, or dragging bodies.
        """
        slow = self.clock.speed < 1.0 or self.clock.game_speed < 1.0 or self.clock.paused
        changed = any(name.startswith(EASIER) for name, _ in self.session.inputs.now.changes)
        if slow or changed or self.scene.assist.get("invincible") or self.scene.drag.holds:
            self.assisted = True

    def _note_result(self):
        if self.scene.result is None:
            self.since_result = 0
            return
        self.since_result += 1
        if self.since_result == 1:
            self.sounds.jingle("victory" if self.scene.result.won else "game_over")
        if self.since_result > RECORDED_ON and self.renews:
            self.session.recorder = None
        inputs = self.session.inputs
        goes_on = inputs.pressed("fire") or inputs.pressed("jump") or inputs.pressed("confirm")
        if self.since_result > RESULT_WAIT and (goes_on or inputs.pointer_pressed):
            self.outcome = ("result",)

    def end_run(self) -> None:
        """Pass the recording of the ended run to run_ended(). A second call does nothing."""
        self.drop_future()
        if self.renews and self.recorder is not None:
            self.run_ended(self.recorder, self.scene.result)
            self.recorder = self.session.recorder = None

    def restart(self) -> None:
        """Restart the scene from its first frame. Each attempt of the player is a run with its own recording.

        The first input of the new recording contains the settings chosen before, so that the recording does not depend
        on earlier runs.
        """
        self.step_inspector.leave()
        self.table = table_of(self.scene.name, self.scene.level_file)
        if self.renews:
            self.end_run()
            self.recorder = self.session.recorder = Recorder(self.scene, False, KEPT_EVERY)
            self.assisted = False
            for name, value in chosen_before(self.scene):
                self.devices.change(name, value)
        self.since_result = 0
        self.devices.change("restart", True)

    def request_restart(self) -> None:
        """Restart the game.

        If it has ended, open its result instead, so that an accidental key does not lose the score.
        """
        if self.person and self.scene.result is not None:
            self.outcome = ("result",)
        else:
            self.restart()

    def switch_solver(self, way: int) -> None:
        """Change to the next solver (`way` 1) or the previous one (-1)."""
        self.switches.solver(way)

    @property
    def news(self) -> str:
        """Line of text about the last change of a setting; "" when it is no longer shown."""
        return self.switches.news

    def toggle_pause(self) -> None:
        """Pause the game, or continue it if it is paused."""
        self.clock.paused = not self.clock.paused

    def single_step(self) -> None:
        """Pause the game, and make one step."""
        self.clock.paused = True
        self.clock.request_step()

    def toggle_step_inspector(self) -> None:
        """Freeze the game and inspect its next step stage by stage. During an inspection, end it instead."""
        if self.step_inspector.open:
            self.step_inspector.leave()
        else:
            self.clock.paused, self.panel_open = True, False
            self.close_costs()
            self.measuring.weigh_effects()
            self.switches.report(self.step_inspector.enter())

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event that has a function on this screen, before the game receives it.

        Return whether the event was used.
        """
        hint = None if self.open_panel is not None else self.hint
        if isinstance(hint, LabCard) and hint.turned_by(event):
            return True
        if hint is not None and hint.dismissed_by(event, self.devices.pressed_button(event)):
            if self.settings is not None:
                hint.remember(self.settings)
            self.settings_changed()
            self.hint, self.helped_since = None, self.session.report.steps
            if hint.keeps_keys or event.type == pygame.MOUSEBUTTONDOWN:
                return True
        button = self.devices.pressed_button(event)
        if self.step_inspector.feed(event, button):
            return True
        if button is not None and press_button(self, button):
            return True
        panel = self.open_panel
        if panel is not None and panel.feed(event):
            self.devices.release_all()
            return True
        if self.timeline is not None and self.timeline.feed(event, self.devices, self.clock.paused, self.now):
            return True
        if self.measuring.split is not None and event.type == pygame.MOUSEBUTTONDOWN:
            return True  # clicks on the halves of a split screen have no effect
        if self.inspector.feed(event, self.clock.paused):
            return True
        if event.type == pygame.KEYDOWN and asks_for_card(event) and what_to_see(type(self.scene)):
            self.close_costs()
            self.panel_open, self.hint = False, LabCard(self.scene)
            return True
        return event.type == pygame.KEYDOWN and press(self, event.key)

    def stop(self) -> None:
        """Leave the game: show the scene menu if a bot plays, the result if the game has ended, else the pause menu."""
        if not self.person:
            self.outcome = ("menu",)
        else:
            self.outcome = ("result",) if self.scene.result is not None else ("pause", "")

    def toggle_panel(self) -> None:
        """Open the side panel. If a panel is open, close it instead."""
        was_open = self.open_panel is not None
        self.close_costs()
        self.panel_open = not was_open
        self.panel.focused = True
        self.devices.release_all()

    def toggle_costs(self) -> None:
        """Open the plot of accuracy and cost beside the game instead of the panel, or close the plot."""
        if self.costs_open:
            self.close_costs()
        else:
            self.costs_open, self.panel_open, self.costs.focused = True, False, True
        self.devices.release_all()

    def close_costs(self) -> None:
        """Close the plot of accuracy and cost, and stop its measurements. The results are kept."""
        self.costs_open = False
        self.measuring.close()

    def try_setting(self, setting: Setting) -> None:
        """Apply a setting that was chosen in the plot of accuracy and cost."""
        self.switches.report(self.measuring.apply(setting))

    def save_costs(self) -> None:
        """Save the measurements of the plot of accuracy and cost as a CSV file, and report its path."""
        self._save(self.measuring.save_csv)

    def save_figures(self) -> None:
        """Save the numbers that the scene has measured as a CSV file, and report its path."""
        self._save(self.measuring.save_figures)

    def _save(self, save):
        try:
            self.switches.report(save())
        except OSError as error:
            self.switches.report(f"it could not be saved: {error.strerror or error}")

    def toggle_split(self) -> None:
        """Switch the split screen of a race on or off.

        Without a race, start one between pixels and boxes if there are sprites.
        """
        rival = self.measuring.boxes_or_pixels()
        if self.measuring.race is None and rival is not None:
            self.start_race(rival)
            self.measuring.toggle_split()
            return
        self.switches.report(self.measuring.toggle_split())

    def start_race(self, setting: Setting) -> None:
        """Restart the scene in a race against a copy of the scene under the given setting."""
        self.switches.report(self.measuring.start_race(setting))
        if self.measuring.race is not None:
            self.restart()

    def close(self) -> None:
        """End inspections and measurements when the player leaves the screen and does not return to it."""
        super().close()
        self.step_inspector.leave()
        self.close_costs()
        self.measuring.leave()

    def _measure(self):
        self.measuring.beside(self.now, self.panel_open)
        if (self.costs_open or self.measuring.tuner.on) and (news := self.measuring.turn(self.now)):
            self.switches.report(news)

    def _below(self) -> StepInspectorView | Timeline | None:
        """Return the element at the bottom of the picture: the step inspector or the timeline.

        None while the game runs.
        """
        if self.step_inspector.open:
            return self.step_inspector
        return self.timeline if self.timeline is not None and (self.clock.paused or self.timeline.runs) else None

    def draw(self, picture: Picture) -> Frame:
        """Draw the scene and the elements over it. Return the frame."""
        started = perf_counter()
        if self.step_inspector.open:  # measurements cannot start within a step
            self.measuring.take_weights()
        else:
            self._measure()
        below = self._below()
        reserve = None if below is None else below.reserve
        alpha, split = self.clock.alpha, None if self.step_inspector.open else self.measuring.split
        if split is not None:
            draw = partial(split.draw, overlays=self.overlays, alpha=alpha)
            frame = picture.draw_without(draw, self.overlays, self.open_panel)
        else:
            with self.step_inspector.showing():
                frame = picture.draw_scene(self.scene, self.overlays, alpha, self.open_panel, reserve)
        covered = self.open_panel is not None and picture.presenter.crowded  # the panel is the whole picture
        if below is not None and not covered:
            below.draw(frame)
        if self.measuring.race is not None and split is None:
            self.measuring.race.draw(frame)
        if self.hint is not None and self.open_panel is None:
            self.hint.draw(frame)
        self.inspector.draw(frame, self.clock.paused)
        if not covered or self.news:
            draw_status(frame, self)
        self.session.report.note_drawing(perf_counter() - started)
        return frame
