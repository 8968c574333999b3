"""The screen that plays a recording: freeze, slow motion, single steps and seeks.

Overlays and panel work as in a game, but the recorded game cannot be changed.
"""

import pygame

from game.audio.sound import Sounds
from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import DUSK, FOG, GOLD, INK, PAPER, RED, SKY, SLATE
from game.drawing.number_text import plain_name, short_clock
from game.drawing.presenter import Frame
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.outcome import solver_name
from game.run.picture import Picture
from game.run.tape import Tape
from game.screens.parts.panel import BUTTON, CHECK, CHOICE, HEAD, NOTE, Panel, Row
from game.screens.parts.panel_rows import layer_rows
from game.screens.screen import SceneScreen

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)
SPEED_NAMES = ("1/4", "1/2", "1", "2", "4")
LEAP = 5 * 60  # frames of one leap by left or right
SEEK_SECONDS = 0.025  # of each picture, spent on a seek
HIDE_SECONDS = 3.0  # time without input after which the controls disappear; the next input shows them again
LEAST_WIDTH = 360  # [text px] that the controls need
BAR_HEIGHT = 26  # [text px] of the controls at the bottom
KEYS_LINE = (
    "Space play   \u2190 \u2192 5 s   \u2191 \u2193 speed   , . step   Home End   1-9 see   Tab panel   Esc back"
)
BUTTON_KEYS = {
    "a": pygame.K_SPACE,
    "b": pygame.K_ESCAPE,
    "start": pygame.K_SPACE,
    "back": pygame.K_ESCAPE,
    "y": pygame.K_TAB,
    "x": pygame.K_PERIOD,
    "dpad left": pygame.K_LEFT,
    "dpad right": pygame.K_RIGHT,
    "dpad up": pygame.K_UP,
    "dpad down": pygame.K_DOWN,
    "left shoulder": pygame.K_HOME,
    "right shoulder": pygame.K_END,
}


class Watch(SceneScreen):
    """Screen that plays a recording (a Tape). name: name of the recording's file.

    `outcome`, the request for the next screen, becomes ("back",).
    """

    def __init__(
        self, tape: Tape, devices: DeviceSource, sounds: Sounds, accessibility: Accessibility, name: str = ""
    ) -> None:
        super().__init__()
        self.tape, self.devices, self.sounds, self.accessibility, self.name = tape, devices, sounds, accessibility, name
        self.overlays = Overlays(tape.scene.overlays)
        self.clock = FixedStep()
        self.speed = SPEEDS.index(1.0)
        self.panel = Panel(lambda: watch_rows(self))
        self.panel_open = False
        self.dragging = False
        self.alone = 0.0  # [s] since the last key or mouse motion
        self.before = None
        self.bar = self.button = pygame.Rect(0, 0, 0, 0)  # of the last picture

    @property
    def shows_pointer(self) -> bool:
        """Whether something on the screen can be clicked."""
        return self.shows_controls or self.panel_open

    @property
    def running_clock(self) -> FixedStep:
        """Clock that schedules the scene's steps."""
        return self.clock

    @property
    def tune(self) -> str | None:
        """Name of the recorded game's music; None if it has none."""
        return self.tape.scene.music

    @property
    def failure(self) -> str:
        """Message if the game differs from the recording, otherwise "".

        For a recording of another physics version it is always "", because such a recording may differ.
        """
        return "" if self.tape.recording.outdated else self.tape.diverged

    @property
    def diverged(self) -> bool:
        """Whether the current frame is at or after the frame at which the game first differed from the recording."""
        return self.tape.diverged_at is not None and self.tape.position >= self.tape.diverged_at

    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s], or continue a seek."""
        self.devices.next()  # recorded input replaces it
        self.alone += 0.0 if self.before is None else now - self.before
        self.before = now
        due = self.clock.advance(now)
        if self.tape.goal is not None:
            self.tape.seek_on(SEEK_SECONDS)
        else:
            for _ in range(due):
                self.step()
        self.tape.scene.set_accessibility(self.accessibility)
        if self.tape.ended and self.tape.goal is None:
            self.clock.paused = True

    def step(self) -> None:
        """Play one recorded step. The sounds of the step are played only at normal speed."""
        if not self.tape.ended:
            self.tape.step()
            self.overlays.note(self.tape.scene)
            if SPEEDS[self.speed] == 1.0:
                self.sounds.play_cues(self.tape.scene.cues)

    def toggle(self) -> None:
        """Freeze the playback, or continue it. At the end of the recording, play it from the start."""
        if self.tape.ended:
            self.tape.begin_seek(0)
            self.clock.paused = False
        else:
            self.clock.paused = not self.clock.paused

    def turn_speed(self, way: int) -> None:
        """Change to the next higher playback speed (`way` 1) or the next lower one (-1)."""
        self.speed = max(0, min(len(SPEEDS) - 1, self.speed + way))
        self.clock.game_speed = SPEEDS[self.speed]

    def leap(self, frames: int) -> None:
        """Seek to the frame that is `frames` later, or earlier if the number is negative.

        The frames are counted from the current frame or, during a seek, from its target.
        """
        start = self.tape.position if self.tape.goal is None else self.tape.goal
        self.tape.begin_seek(start + frames)

    @property
    def shows_controls(self) -> bool:
        """Whether the controls are visible.

        The controls are hidden during playback without input, because they cover the game.
        """
        return self.clock.paused or self.alone < HIDE_SECONDS or self.tape.goal is not None or self.dragging

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event. Return whether the event was used."""
        self.alone = 0.0
        if self.panel_open and self.panel.feed(event):
            return True
        button = self.devices.pressed_button(event)
        if event.type == pygame.KEYDOWN:
            return self._key(event.key)
        if button in BUTTON_KEYS:
            self._key(BUTTON_KEYS[button])
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self._click(event.pos)
        elif event.type == pygame.MOUSEMOTION and self.dragging:
            self._seek_to(event.pos)
        elif event.type == pygame.MOUSEBUTTONUP and event.button == 1:
            self.dragging = False
        elif event.type == pygame.MOUSEWHEEL:
            self.leap(event.y * LEAP // 5)
        return False

    def _click(self, position):
        if self.bar.collidepoint(position):
            self.dragging = True
            self._seek_to(position)
        elif self.button.collidepoint(position):
            self.toggle()

    def _seek_to(self, position):
        share = (position[0] - self.bar.x) / max(self.bar.width, 1)
        self.tape.begin_seek(round(max(0.0, min(1.0, share)) * self.tape.length))

    def single(self, way: int) -> None:
        """Freeze the playback, and move one frame forward (`way` 1) or back (-1)."""
        self.clock.paused = True
        self.leap(way)

    def _key(self, key):
        layers = {getattr(pygame, f"K_{layer.key}"): layer.name for layer in self.overlays.layers}
        does = {
            pygame.K_SPACE: self.toggle,
            pygame.K_RETURN: self.toggle,
            pygame.K_p: self.toggle,
            pygame.K_LEFT: lambda: self.leap(-LEAP),
            pygame.K_RIGHT: lambda: self.leap(LEAP),
            pygame.K_UP: lambda: self.turn_speed(1),
            pygame.K_DOWN: lambda: self.turn_speed(-1),
            pygame.K_EQUALS: lambda: self.turn_speed(1),
            pygame.K_PLUS: lambda: self.turn_speed(1),
            pygame.K_MINUS: lambda: self.turn_speed(-1),
            pygame.K_PERIOD: lambda: self.single(1),
            pygame.K_o: lambda: self.single(1),
            pygame.K_COMMA: lambda: self.single(-1),
            pygame.K_HOME: lambda: self.leap(-self.tape.length),
            pygame.K_END: lambda: self.leap(self.tape.length),
            pygame.K_0: self.overlays.toggle_all,
            pygame.K_TAB: self._toggle_panel,
            pygame.K_ESCAPE: self._leave,
            pygame.K_BACKSPACE: self._leave,
        }
        if key in layers:
            self.overlays.toggle(layers[key])
        elif key in does:
            does[key]()
        else:
            return False
        return True

    def _toggle_panel(self):
        self.panel_open = not self.panel_open
        self.panel.focused = True

    def _leave(self):
        self.outcome = ("back",)

    def draw(self, picture: Picture) -> Frame:
        """Draw the scene, its overlays and panel, and the controls. Return the frame."""
        panel = self.panel if self.panel_open else None
        frame = picture.draw_scene(self.tape.scene, self.overlays, self.clock.alpha, panel, self._reserve)
        if self.shows_controls and not (panel and picture.presenter.crowded):
            self._draw_controls(frame)
        if self.diverged:
            self._draw_diverged(frame)
        return frame

    def _reserve(self, frame):
        """Reserve the rectangle of the controls, so that the legend of the overlays avoids it."""
        if self.shows_controls:
            frame.reserve(self._controls_rect(frame))

    def _controls_rect(self, frame):
        high = BAR_HEIGHT * frame.scale_for(LEAST_WIDTH)
        area = frame.area.clip(frame.rect)
        return pygame.Rect(area.x, area.bottom - high, area.width, high)

    def _draw_controls(self, frame):
        scale, rect = frame.scale_for(LEAST_WIDTH), self._controls_rect(frame)
        frame.surface.fill(INK, rect)
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]  # now hidden
        self.button = pygame.Rect(rect.x + 4 * scale, rect.y + 4 * scale, 14 * scale, 9 * scale)
        _draw_button(frame.surface, self.button, self.clock.paused, scale)
        total = (
            f"{short_clock(self.tape.position / 60)} / {short_clock(self.tape.length / 60)}  x{SPEED_NAMES[self.speed]}"
        )
        text = frame.text(total, rect.right - 4 * scale, rect.y + 4 * scale, PAPER, TEXT, scale, "right")
        self.bar = pygame.Rect(self.button.right + 4 * scale, rect.y + 3 * scale, 0, 10 * scale)
        self.bar.width = text.left - 6 * scale - self.bar.x
        self._draw_bar(frame, scale)
        if frame.measure(KEYS_LINE, SMALL, scale)[0] < rect.width - 8 * scale:
            frame.text(KEYS_LINE, rect.centerx, rect.bottom - 9 * scale, FOG, SMALL, scale, "center")

    def _draw_bar(self, frame, scale):
        """Draw the bar with the current frame, the key frames, and the frame of the first difference, if there is one.

        scale: frame px per text px.
        """
        surface, tape, bar = frame.surface, self.tape, self.bar
        line = pygame.Rect(bar.x, bar.centery - scale, bar.width, 2 * scale)
        surface.fill(DUSK, line)
        length = max(tape.length, 1)
        surface.fill(SKY, (line.x, line.y, line.width * tape.position // length, line.height))
        for key in tape.keys:
            surface.fill(SLATE, (line.x + line.width * key // length, line.y - scale, scale, line.height + 2 * scale))
        if tape.diverged_at is not None:
            surface.fill(RED, (line.x + line.width * tape.diverged_at // length, bar.y, scale, bar.height))
        x = line.x + line.width * tape.position // length
        surface.fill(PAPER, (x - scale, bar.y + scale, 3 * scale, bar.height - 2 * scale))

    def _draw_diverged(self, frame):
        scale = frame.scale_for(LEAST_WIDTH)
        why = "it was played under another physics" if self.tape.recording.outdated else "this is not what was played"
        text = f"DIVERGED at frame {self.tape.diverged_at}: {why}"
        width, height = frame.measure(text, TEXT, scale)
        size = (width + 12 * scale, height + 8 * scale)
        area = frame.area.clip(frame.rect)
        place = frame.free_place(
            size,
            [(area.centerx - size[0] // 2, y) for y in range(area.y + 4 * scale, area.bottom - size[1], 8 * scale)],
        )
        if place is not None:
            frame.surface.fill(INK, (*place, *size))
            pygame.draw.rect(frame.surface, RED, (*place, *size), scale)
            frame.text(text, place[0] + 6 * scale, place[1] + 4 * scale, GOLD, TEXT, scale)


def _draw_button(surface, rect, paused, scale):
    """Draw the play button: a triangle while `paused`, two bars during playback."""
    x, y, high = rect.x + 3 * scale, rect.y, rect.height
    if paused:
        pygame.draw.polygon(surface, GOLD, ((x, y), (x, y + high), (x + high, y + high // 2)))
    else:
        surface.fill(GOLD, (x, y, 3 * scale, high))
        surface.fill(GOLD, (x + 5 * scale, y, 3 * scale, high))


def watch_rows(watch: Watch) -> list[Row]:
    """Return the panel's rows for a Watch screen. They change the view, not the recorded game."""
    scene, tape = watch.tape.scene, watch.tape
    spacing = tape.spacing // 60
    solver = plain_name(solver_name(scene) or "no solver")
    rows = [
        Row(HEAD, scene.title),
        Row(NOTE, f"a recording: {watch.name}"),
        Row(NOTE, f"seed {scene.seed}, {scene.broadphase}, {solver}, tier {scene.tier or 'none'}"),
        Row(HEAD, "See"),
        *layer_rows(watch.overlays),
        Row(HEAD, "Time"),
        Row(CHECK, "Freeze", key="P", on=watch.clock.paused, press=watch.toggle),
        Row(BUTTON, "Single step", key=".", press=lambda: watch.single(1), hint="one sixtieth of a second"),
        Row(CHOICE, "Speed", f"x{SPEED_NAMES[watch.speed]}", "- +", turn=watch.turn_speed),
        Row(NOTE, f"key frames every {spacing} s: seeking starts at the one before"),
    ]
    rows += [Row(NOTE, f"{name}: {value:g}") for name, value in scene.values.items()]
    return [*rows, Row(NOTE, "effects: " + (", ".join(scene.effects.names()) or "none"))]
