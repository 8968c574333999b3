"""One minute through the overlays: bots play, one layer after the other comes on, two lines say what it shows."""

from collections.abc import Callable, Sequence
from time import perf_counter

import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import DUSK, FOG, GOLD, INK, PAPER, SLATE
from game.drawing.presenter import Frame
from game.errors import UsageError
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.run.picture import Picture
from game.scene import Scene
from game.screens.parts.demo import Demo
from game.screens.parts.panel import HEAD, NOTE, Panel, Row
from game.screens.parts.panel_rows import layer_rows
from game.screens.screen import SceneScreen

SECONDS = 5  # of each stop: twelve stops are a minute
CARD = (312, 66)  # [text px]
# Scene and how many steps its bot has played before it is shown; layer, or the panel; title; two lines.
GAME, LEVEL, PILE, SHOTS = ("shooter", 800), ("platformer", 240), ("lab/pyramid", 120), ("lab/tunnelling", 90)
STOPS = (
    (
        GAME,
        "bounds",
        "1  Bounding boxes",
        ("Every shape in its box. Orange: two boxes meet.", "Red: what is inside them touches."),
    ),
    (
        GAME,
        "motion",
        "2  Motion rectangles",
        ("Where a body is, was, and will be in one step.", "So nothing fast slips between two pictures."),
    ),
    (
        GAME,
        "structure",
        "3  Broad phase",
        ("The grid that finds who could meet whom", "without asking every pair. B switches it."),
    ),
    (
        GAME,
        "pairs",
        "4  Candidate pairs",
        ("What the broad phase hands on: the few pairs", "that are worth a closer look."),
    ),
    (
        GAME,
        "masks",
        "5  Masks",
        ("The pixels that decide. Yellow: shared ones.", "Boxes may meet and it is still a miss."),
    ),
    (
        LEVEL,
        "islands",
        "I  Islands",
        ("What leans on each other is solved together,", "and sleeps together, z, when nothing moves."),
    ),
    (
        LEVEL,
        "contacts",
        "6  Contacts",
        ("Where things touch, and the normal that says", "whether it is floor, wall or slope."),
    ),
    (
        LEVEL,
        "outlines",
        "L  Shapes",
        ("What the solver knows under the painted picture:", "boxes, circles, tiles, chains."),
    ),
    (
        PILE,
        "impulses",
        "9  Impulses",
        ("How hard each contact pushes: the bottom row", "carries all that lies above it."),
    ),
    (
        SHOTS,
        "ghosts",
        "H  Times of impact",
        ("Where a fast body was stopped on its way,", "before it could pass through a thin wall."),
    ),
    (
        LEVEL,
        "times",
        "8  Stage times",
        ("What each stage of a step costs, live.", "What a scene does not use costs nothing."),
    ),
    (
        LEVEL,
        "panel",
        "Tab  The panel",
        ("All of it in one place, in any scene, mid-game:", "layers, solver, slow motion, single step."),
    ),
)
NEXT, BACK, LEAVE = "next", "back", "leave"
KEYS = {
    pygame.K_RIGHT: NEXT,
    pygame.K_RETURN: NEXT,
    pygame.K_SPACE: NEXT,
    pygame.K_LEFT: BACK,
    pygame.K_ESCAPE: LEAVE,
    pygame.K_BACKSPACE: LEAVE,
}
AHEAD = 0.03  # [s] of each picture are spent on playing up to where it gets interesting
BUTTONS = {
    "a": NEXT,
    "right shoulder": NEXT,
    "dpad right": NEXT,
    "dpad left": BACK,
    "left shoulder": BACK,
    "b": LEAVE,
    "start": LEAVE,
    "back": LEAVE,
}


class Tour(SceneScreen):
    """`make(name)` builds a scene; a stop whose scene is not there shows the first. `outcome` becomes ("back",)."""

    tune = "title"

    def __init__(
        self, make: Callable[[str], Scene], names: Sequence[str], devices: DeviceSource, accessibility: Accessibility
    ) -> None:
        super().__init__()
        self.make, self.devices, self.accessibility = make, devices, accessibility
        self.stops = [stop if stop[0][0] in names else ((names[0], 0), *stop[1:]) for stop in STOPS]
        self.demos = {}  # scene name -> Demo, each played on from stop to stop
        self.at = 0
        self.shown = 0  # steps of this stop
        self.places = []  # (rect, what it does) of the last picture
        self.panel = Panel(self._panel_rows)
        self.panel.focused = False

    @property
    def demo(self) -> Demo:
        """The scene of this stop, played by its bot."""
        name = self.stops[self.at][0][0]
        if name not in self.demos:
            self.demos[name] = Demo(self.make(name), self.accessibility)
        return self.demos[name]

    @property
    def begins_in(self) -> int:
        """How many steps the bot plays first, fast, up to where there is something to see."""
        return self.stops[self.at][0][1] - self.demo.session.report.steps

    def _panel_rows(self):
        return [
            Row(HEAD, self.demo.scene.title),
            Row(HEAD, "See"),
            *layer_rows(self.demo.overlays),
            Row(HEAD, "Time"),
            Row(NOTE, "P freezes, O makes one step, - and + change the speed"),
            Row(NOTE, "B broad phase, V solver, T tier, N narrow phase"),
            Row(NOTE, "R restart, F12 a picture"),
        ]

    def advance(self, now: float) -> None:
        """Make the steps that are due at `now` [s]; the next stop when this one has had its time."""
        try:
            due = self.demo.advance(now)
            started = perf_counter()
            while self.begins_in > 0 and perf_counter() - started < AHEAD:
                self.demo.step()
        except UsageError:  # a scene whose files are damaged cannot be shown; the menu says why
            self.outcome = ("back",)
            return
        self.shown += due if self.begins_in <= 0 else 0
        if self.demo.scene.result is not None:
            self._play_again()
        if self.shown >= SECONDS * 60:
            self._go(NEXT)

    def _play_again(self):
        """A bot that has come to its end starts over, so that there is always something to see."""
        self.demo.scene.restart()

    def _go(self, what):
        if what == LEAVE or (what == NEXT and self.at == len(self.stops) - 1):
            self.outcome = ("back",)
            return
        self.at = max(0, self.at + (1 if what == NEXT else -1))
        self.shown = 0
        self.demo.clock.rest()

    def feed(self, event: pygame.event.Event) -> bool:
        """Take an event; True if it is used up."""
        what = None
        if event.type == pygame.KEYDOWN:
            what = KEYS.get(event.key)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            what = next((does for rect, does in self.places if rect.collidepoint(event.pos)), None)
        else:
            what = BUTTONS.get(self.devices.pressed_button(event) or "")
        if what is not None:
            self._go(what)
        return what is not None

    def draw(self, picture: Picture) -> Frame:
        """Draw the scene with this stop's layer, and its card."""
        layer = self.stops[self.at][1]
        demo = self.demo
        with_panel = layer == "panel"
        demo.overlays.on = {"contacts"} if with_panel else {layer}
        frame = demo.draw(picture, self.panel if with_panel else None, lambda frame: frame.reserve(card_rect(frame)))
        if not (with_panel and picture.presenter.crowded):
            self._draw_card(frame)
        return frame

    def _draw_card(self, frame):
        (_, first), _, title, lines = self.stops[self.at]
        scale = frame.scale_for(CARD[0])
        rect = card_rect(frame)
        covered = [each for each in frame.boxes if rect.colliderect(each[0])]
        frame.boxes[:] = [each for each in frame.boxes if each not in covered]
        frame.surface.fill(INK, rect)
        pygame.draw.rect(frame.surface, SLATE, rect, scale)
        frame.surface.fill(GOLD, (rect.x, rect.y, 2 * scale, rect.height))
        x, y = rect.x + 10 * scale, rect.y + 6 * scale
        frame.text(title, x, y, GOLD, TEXT, scale)
        if self.begins_in > 0:
            part = f"{100 - 100 * self.begins_in // first} %"
            frame.text(f"the bot plays ahead, {part}", rect.right - 8 * scale, y + scale, FOG, SMALL, scale, "right")
        for number, line in enumerate(lines):
            frame.text(line, x, y + (14 + 12 * number) * scale, PAPER, TEXT, scale)
        self._draw_foot(frame, rect, scale)

    def _draw_foot(self, frame, rect, scale):
        """Dots for the stops, and what the keys do; all of it can be clicked."""
        self.places = []
        y = rect.bottom - 11 * scale
        for number in range(len(self.stops)):
            color = GOLD if number == self.at else FOG if number < self.at else DUSK
            frame.surface.fill(color, (rect.x + (10 + 8 * number) * scale, y + scale, 4 * scale, 4 * scale))
        share = min(1.0, self.shown / (SECONDS * 60)) if self.begins_in <= 0 else 0.0
        frame.surface.fill(
            SLATE, (rect.x + 2 * scale, rect.bottom - 2 * scale, int((rect.width - 4 * scale) * share), scale)
        )
        right = rect.right - 8 * scale
        for text, does in (("Esc leave", LEAVE), ("\u2192 next", NEXT), ("\u2190 back", BACK)):
            place = frame.text(text, right, y, FOG, SMALL, scale, "right")
            self.places.append((place.inflate(8 * scale, 8 * scale), does))
            right = place.left - 12 * scale


def card_rect(frame: Frame) -> pygame.Rect:
    """Where the card goes: over the lower edge of the game."""
    scale, area = frame.scale_for(CARD[0]), frame.area.clip(frame.rect)
    rect = pygame.Rect(0, 0, min(CARD[0] * scale, area.width), CARD[1] * scale)
    rect.midbottom = area.centerx, area.bottom - 6 * scale
    return rect
