"""One-minute tour of the overlays. Bots play, one layer after another is shown, and a card describes the layer.

Each stop of the tour waits for a step that shows an example of its layer. The scene is frozen in this step, with a ring
around the example, and then continues.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from time import perf_counter

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT
from game.drawing.colors import DUSK, FOG, GOLD, INK, PAPER, SLATE
from game.drawing.presenter import Frame
from game.errors import UsageError
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.run.loop import FixedStep
from game.run.picture import Picture
from game.scene import STEP_SECONDS, Scene
from game.screens.near_misses import COUNTS, NearMisses
from game.screens.parts.demo import Demo
from game.screens.parts.panel import HEAD, NOTE, Panel, Row
from game.screens.parts.panel_rows import layer_rows
from game.screens.parts.subjects import SUBJECTS, subject_of
from game.screens.screen import SceneScreen

SECONDS, STILL = 5, 3  # duration of each stop; the step is frozen for STILL of them
MISSES = "near misses"  # in place of a layer: the split screen of game/screens/near_misses.py
PATIENCE = 900  # steps that a stop waits for an example of its layer
MARGIN = 6  # [canvas px] between an example and the ring around it
EDGE = 6  # [text px] between the card and the border of the picture
CARD = (312, 66)  # [text px]
# Of each stop: (scene, steps that its bot plays first), layer or "panel", title, two lines of text.
GAME, LEVEL = ("shooter", 800), ("platformer", 240)
HEAPS, PILE, SHOTS = ("lab/sleeping", 100), ("lab/pyramid", 120), ("lab/tunnelling", 90)
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
        LEVEL,
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
        GAME,
        MISSES,
        "M  What accuracy costs",
        ("The same flight: by boxes the plane dies, by", "pixels it lives. M measures it in any scene."),
    ),
    (
        HEAPS,
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
AHEAD = 0.03  # [s] of each picture spent on the steps before a stop begins
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
    """Guided tour of the overlays. At each stop, a bot plays a scene, and a card explains one overlay layer.

    make(name) builds a scene. `outcome`, the request for the next screen, becomes ("back",) at the end. names: the
    scenes that exist. A stop whose scene is missing uses the first of them.
    """

    tune = "title"

    def __init__(
        self, make: Callable[[str], Scene], names: Sequence[str], devices: DeviceSource, accessibility: Accessibility
    ) -> None:
        super().__init__()
        self.make, self.devices, self.accessibility = make, devices, accessibility
        self.stops = [stop if stop[0][0] in names else ((names[0], 0), *stop[1:]) for stop in STOPS]
        self.demos = {}  # scene name -> Demo, which continues from stop to stop
        self.at = 0
        self.shown = 0  # steps of this stop since its example appeared
        self.waited = 0  # steps that this stop has waited for its example
        self.subject: pygame.Rect | None = None  # place of the example on the canvas, while the step is frozen
        self.ring: pygame.Rect | None = None  # around the subject of the last picture [frame px]
        self.card = pygame.Rect(0, 0, 0, 0)  # of the last picture [frame px]
        self.places = []  # (rect, action) of the last picture
        self.panel = Panel(self._panel_rows)
        self.panel.focused = False

    @cached_property
    def misses(self) -> NearMisses:
        """The split screen of near misses. Its flight continues from stop to stop."""
        return NearMisses()

    @property
    def demo(self) -> Demo:
        """The scene of this stop, played by its bot."""
        name = self.stops[self.at][0][0]
        if name not in self.demos:
            self.demos[name] = Demo(self.make(name), self.accessibility)
        return self.demos[name]

    @property
    def begins_in(self) -> int:
        """Number of steps that the bot still has to play before this stop begins. They are played at high speed."""
        return self.stops[self.at][0][1] - self.demo.session.report.steps

    def _panel_rows(self):
        return [
            Row(HEAD, self.demo.scene.title),
            Row(HEAD, "See"),
            *layer_rows(self.demo.overlays),
            Row(HEAD, "Time"),
            Row(NOTE, "P freezes, O makes one step"),
            Row(NOTE, "- and + change the speed"),
            Row(NOTE, "B, V, T, N: broad phase, solver, tier,"),
            Row(NOTE, "narrow phase; R restart, F12 picture"),
        ]

    @property
    def waits(self) -> bool:
        """Whether the bot plays at high speed until an example of this stop's layer appears."""
        if self.stops[self.at][1] == MISSES:
            return False
        return not self.shown and self.subject is None and (self.begins_in > 0 or self.waited < PATIENCE)

    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s]. When a stop has been shown for SECONDS, go to the next stop."""
        try:
            due = self.demo.clock.advance(now)
            if self.stops[self.at][1] == MISSES:
                for _ in range(due):
                    self.misses.advance(STEP_SECONDS)
            elif self.waits:
                self._play_ahead()
            elif self.subject is None or self.shown >= STILL * 60:
                self.subject = None
                for _ in range(due):
                    self.demo.step()
        except UsageError:  # a scene with damaged files cannot be shown; the menu shows the error
            self.outcome = ("back",)
            return
        if not self.waits:
            self.shown += due
        if self.demo.scene.result is not None:
            self._play_again()
        if self.shown >= SECONDS * 60:
            self._go(NEXT)

    def _play_ahead(self):
        """Make steps until an example of this stop's layer appears, for at most AHEAD seconds of real time."""
        layer, started = self.stops[self.at][1], perf_counter()
        while self.waits and perf_counter() - started < AHEAD:
            if self.begins_in <= 0:
                if layer not in SUBJECTS:  # it is always on the frame
                    self.waited = PATIENCE
                    return
                self.subject = subject_of(self.demo.scene, layer)
                self.waited += 1
            if self.waits:
                self.demo.step()
                if self.demo.scene.result is not None:
                    self._play_again()

    def _play_again(self):
        """Restart the scene after the end of its game, so that the bot always has a game to play."""
        self.demo.scene.restart()

    def _go(self, what):
        if what == LEAVE or (what == NEXT and self.at == len(self.stops) - 1):
            self.outcome = ("back",)
            return
        self.at = max(0, self.at + (1 if what == NEXT else -1))
        self.shown = self.waited = 0
        self.subject = None
        self.demo.clock.rest()

    @property
    def running_clock(self) -> FixedStep | None:
        """Clock that schedules the scene's steps; None if there is no scene."""
        return self.demo.clock if self.demo else None

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event. Return whether the event was used."""
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
        """Draw the scene with this stop's layer, a ring around the example, and the card. Return the frame."""
        layer = self.stops[self.at][1]
        demo = self.demo
        if layer == MISSES:
            frame = picture.draw_screen(self.misses)
            self.ring = None
            self.card = docked(frame, frame.from_canvas((0, 0, *CANVAS_SIZE)), frame.from_canvas(COUNTS))
            self._draw_card(frame)
            return frame
        with_panel = layer == "panel"
        demo.overlays.on = {"contacts"} if with_panel else {layer}
        frame = demo.draw(picture, self.panel if with_panel else None, self._reserve)
        alone = with_panel and picture.presenter.crowded  # then the panel is the whole picture
        self.ring = None
        if layer in SUBJECTS:
            self.ring = self._ring_on(frame)
        elif self.shown < STILL * 60 and not alone:
            self.ring = picture.presenter.panel_rect if with_panel else demo.overlays.times.rect
        if self.ring is not None:
            draw_ring(frame, self.ring)
        if not alone:
            self._draw_card(frame)
        return frame

    def _ring_on(self, frame):
        """Return the rectangle of the ring around the example [frame px]; None if there is no example."""
        if self.subject is None:
            return None
        return frame.from_canvas(self.subject.inflate(2 * MARGIN, 2 * MARGIN))

    def _reserve(self, frame):
        """Place the card where it covers the least text and not the ring, and reserve the rectangles of both."""
        ring = self._ring_on(frame)
        beside_panel = self.stops[self.at][1] == "panel"
        self.card = docked(frame, frame.area.clip(frame.rect) if beside_panel else frame.rect, ring)
        frame.reserve(self.card)
        if ring is not None:
            frame.reserve(ring)

    def _draw_card(self, frame):
        (_, first), _, title, lines = self.stops[self.at]
        scale = frame.scale_for(CARD[0])
        rect = self.card
        covered = [each for each in frame.boxes if rect.colliderect(each[0])]
        frame.boxes[:] = [each for each in frame.boxes if each not in covered]
        frame.surface.fill(INK, rect)
        pygame.draw.rect(frame.surface, SLATE, rect, scale)
        frame.surface.fill(GOLD, (rect.x, rect.y, 2 * scale, rect.height))
        x, y = rect.x + 10 * scale, rect.y + 6 * scale
        frame.text(title, x, y, GOLD, TEXT, scale)
        if self.waits:
            text = "the bot plays until there is one"
            if self.begins_in > 0:
                text = f"the bot plays ahead, {100 - 100 * self.begins_in // first} %"
            frame.text(text, rect.right - 8 * scale, y + scale, FOG, SMALL, scale, "right")
        for number, line in enumerate(lines):
            frame.text(line, x, y + (14 + 12 * number) * scale, PAPER, TEXT, scale)
        self._draw_foot(frame, rect, scale)

    def _draw_foot(self, frame, rect, scale):
        """Draw a dot for each stop, the progress of this stop, and the names of the keys, which can be clicked.

        rect: rectangle of the card; scale: frame px per text px.
        """
        self.places = []
        y = rect.bottom - 11 * scale
        for number in range(len(self.stops)):
            color = GOLD if number == self.at else FOG if number < self.at else DUSK
            frame.surface.fill(color, (rect.x + (10 + 8 * number) * scale, y + scale, 4 * scale, 4 * scale))
        share = min(1.0, self.shown / (SECONDS * 60))
        frame.surface.fill(
            SLATE, (rect.x + 2 * scale, rect.bottom - 2 * scale, int((rect.width - 4 * scale) * share), scale)
        )
        right = rect.right - 8 * scale
        for text, does in (("Esc leave", LEAVE), ("\u2192 next", NEXT), ("\u2190 back", BACK)):
            place = frame.text(text, right, y, FOG, SMALL, scale, "right")
            self.places.append((place.inflate(8 * scale, 8 * scale), does))
            right = place.left - 12 * scale


def docked(frame: Frame, area: pygame.Rect, ring: pygame.Rect | None) -> pygame.Rect:
    """Return the rectangle of the card in `area`: at a corner, or at the middle of the upper or lower border.

    Positions that do not cover the ring are preferred. Among these, the card is placed where it covers the least text.
    ring: rectangle of the ring, or None.
    """
    scale = frame.scale_for(CARD[0])
    size = (min(CARD[0] * scale, area.width), CARD[1] * scale)
    room = area.inflate(-2 * EDGE * scale, -2 * EDGE * scale)
    x = area.centerx - size[0] // 2
    lefts = (x, max(area.left, min(x, room.left)), max(x, room.right - size[0]))
    places = [pygame.Rect(left, top, *size) for top in (room.bottom - size[1], room.top) for left in lefts]
    free = [place for place in places if ring is None or not place.colliderect(ring)] or places
    taken = [box for box, _ in frame.boxes]
    return min(free, key=lambda place: sum(both.width * both.height for both in map(place.clip, taken)))


def draw_ring(frame: Frame, ring: pygame.Rect) -> None:
    """Draw a golden rectangle between two dark ones, which is visible on any background.

    ring: the rectangle [frame px].
    """
    thick = max(2, frame.scale)
    outer = ring.inflate(2 * thick, 2 * thick).clip(frame.rect)
    corner = 5 * frame.scale
    pygame.draw.rect(frame.surface, INK, outer, 3 * thick, corner)
    pygame.draw.rect(frame.surface, GOLD, outer.inflate(-2 * thick, -2 * thick), thick, corner)
