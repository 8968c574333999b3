"""The screen in which a scene is played: its clock, overlays, panel and keys."""

import pygame

from game.colors import GOLD, PAPER
from game.draw import SMALL
from game.inputs import BotSource
from game.loop import FixedStep
from game.overlays.stack import Overlays
from game.panel import Panel
from game.panel_rows import following, play_rows
from game.replay import Recorder
from game.run_report import solver_name
from game.session import Session
from physics import BROADPHASES

PAD_KEYS = {           # what a pad's buttons do besides playing; never part of the recorded input
    pygame.CONTROLLER_BUTTON_START: pygame.K_p,
    pygame.CONTROLLER_BUTTON_BACK: pygame.K_ESCAPE,
    pygame.CONTROLLER_BUTTON_Y: pygame.K_TAB,
}
HELP_SECONDS = 6.0     # how long the key line stays after the start


class Play:
    """One scene on the screen. `outcome` is set to ("menu",) when the player leaves."""

    def __init__(self, scene, devices, sounds, bot=False, recording=None, records=False, overlays=None):
        self.scene, self.devices, self.sounds = scene, devices, sounds
        source = recording or (BotSource(devices) if bot else devices)
        recorder = Recorder(scene, bot) if records else None
        self.session = Session(scene, source, recorder, recording)
        self.overlays = Overlays(scene.overlays if overlays is None else overlays)
        self.clock = FixedStep()
        self.panel = Panel(lambda: play_rows(self))
        self.panel_open = False
        self.outcome = None
        self.message = ""
        self.wants_screenshot = False
        self.prepare = lambda solver: None     # called before a solver is switched to; the app compiles it then

    @property
    def open_panel(self):
        """The panel while it is open, else None."""
        return self.panel if self.panel_open else None

    @property
    def shows_pointer(self):
        """True while the mouse has something to do."""
        scene = self.scene
        return self.panel_open or scene.draggable or not scene.hides_pointer or self.clock.paused

    def advance(self, now, limit=None):
        """Make the steps that are due at `now` [s]; at most `limit` in all of this run."""
        if self.devices.lost_pad:
            self.devices.lost_pad = False
            self.clock.paused = True
            self.message = "The controller is gone. Plug it in again, or play on with the keyboard: P."
        if self.session.replay is not None:
            self.devices.next()        # a replay takes no advice
        elif self.clock.paused and self.devices.changes and not self.clock.requested:
            self.clock.request_step()  # a change while paused costs one step, so that its effect is seen
        for _ in range(self.clock.advance(now)):
            if limit is not None and self.session.report.steps >= limit:
                return
            self.step()

    def step(self):
        """One fixed step, its sounds and its measurements."""
        self.session.step()
        self.overlays.times.note(self.scene)
        self.sounds.play_cues(self.scene.cues)

    def switch_solver(self, way):
        """The next solver, or the one before; its kernels are compiled first, behind a bar."""
        name = following(self.scene.solver_choices(), solver_name(self.scene), way)
        self.prepare(name)
        self.devices.change("solver", name)

    def toggle_pause(self):
        """Stop or go on."""
        self.clock.paused = not self.clock.paused
        self.message = ""

    def single_step(self):
        """Pause, and make one step."""
        self.clock.paused = True
        self.clock.request_step()

    def feed(self, event):
        """Take an event before the game does; True if it is used up."""
        if self.panel_open and self.panel.feed(event):
            self.devices.release_all()
            return True
        if event.type == pygame.CONTROLLERBUTTONDOWN and event.button in PAD_KEYS:
            return self._key(PAD_KEYS[event.button])
        return event.type == pygame.KEYDOWN and self._key(event.key)

    def _key(self, key):
        change, scene = self.devices.change, self.scene
        layers = {getattr(pygame, f"K_{layer.key}"): layer.name for layer in self.overlays.layers}
        if key in layers and key not in self.devices.keys:       # a letter the player gave to a move stays a move
            self.overlays.toggle(layers[key])
        elif key == pygame.K_0:
            self.overlays.toggle_all()
        elif key == pygame.K_TAB:
            self.panel_open = not self.panel_open
            self.panel.focused = True
            self.devices.release_all()
        elif key == pygame.K_ESCAPE:
            self.outcome = ("menu",)
        elif key == pygame.K_b and scene.switches_broadphase:
            change("broadphase", following(tuple(BROADPHASES), scene.broadphase, 1))
        elif key == pygame.K_v and scene.solver_choices():
            self.switch_solver(1)
        elif key == pygame.K_t and scene.tiers:
            change("tier", following(scene.tiers, scene.tier, 1))
        elif key == pygame.K_n:
            change("narrowphase", not scene.narrowphase)
        elif key == pygame.K_r:
            change("restart", True)
        elif key == pygame.K_p or "pause" in self.devices.keys.get(key, ()):
            self.toggle_pause()        # not through the input of a step: a paused game makes none
        elif key == pygame.K_o:
            self.single_step()
        elif key == pygame.K_MINUS:
            self.clock.slower()
        elif key in (pygame.K_EQUALS, pygame.K_PLUS):
            self.clock.faster()
        elif key == pygame.K_F12:
            self.wants_screenshot = True
        else:
            return False
        return True

    def draw(self, picture):
        """Draw the scene and what lies over it; returns the frame."""
        frame = picture.draw_scene(self.scene, self.overlays, self.clock.alpha, self.open_panel)
        for line in self._lines():
            self._draw_line(frame, *line)
        return frame

    def _lines(self):
        lines = []
        if self.clock.paused:
            lines.append((self.message or "PAUSED   P goes on   O one step   R restart   Esc menu", GOLD))
        elif self.clock.speed < 1.0:
            lines.append((f"SPEED {self.clock.speed:.0%}   - slower   + faster", GOLD))
        elif self.session.report.steps < HELP_SECONDS * 60 and not self.panel_open:
            parts = [f"{key} {what}" for key, what in self.scene.actions] + ["mouse drag"] * self.scene.draggable
            lines.append(("   ".join([*parts, "1-9 see", "Tab panel", "Esc menu"]), PAPER))
        return lines

    def _draw_line(self, frame, text, color):
        """In the middle near the bottom, or wherever a line is free."""
        scale = frame.text_scale
        width, height = frame.measure(text, SMALL, scale)
        area = frame.area.clip(frame.rect)
        size = (width + 8 * scale, height + 6 * scale)
        x = area.centerx - size[0] // 2
        rows = [area.bottom - size[1] - n * size[1] for n in range(1, 20)] + [area.top + 4 * scale]
        place = frame.free_place(size, [(x, y) for y in rows if y >= area.top])
        if place is not None:
            shade = pygame.Surface(size, pygame.SRCALPHA)
            shade.fill((20, 16, 32, 170))
            frame.surface.blit(shade, place)
            frame.text(text, place[0] + 4 * scale, place[1] + 3 * scale, color, SMALL, scale)
