"""View of the step inspector: the frozen scene shows its next step stage by stage, and a card describes each stage."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import pygame

from game.drawing.bar_table import bar_table_height, draw_bar_table
from game.drawing.canvas import SMALL, TEXT, wrap
from game.drawing.colors import FOG, GOLD, GREEN, INK, NIGHT, ORANGE, PAPER, SKY, Color, faded
from game.drawing.number_text import count_text, plain_name
from game.drawing.presenter import Frame
from game.invariants.watch import WatchedWorld
from game.measure.effect_totals import FIELDS, bars_of, sentence_of
from game.overlays.stack import Overlays
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.step_inspector import Done, StepInspector, next_input
from game.screens.parts.lab_card import least_covering

WIDTHS, ROW, EDGE = (200, 215, 230, 250, 280), 7, 4  # [text px] of the card: the first width at which it fits
BETWEEN = 1  # [text px] between two paragraphs of the card
GAP = 5  # [text px] between two names in the strip
KEYS_LINE = "\u2190 \u2192 a stage   Home End   E puts the step back"
WORLDS_LINE = "   \u2191 \u2193 another world"
WAYS = {pygame.K_LEFT: -1, pygame.K_RIGHT: 1, pygame.K_HOME: -1000, pygame.K_END: 1000}
WORLD_WAYS = {pygame.K_UP: -1, pygame.K_DOWN: 1}
PAD_KEYS = {
    "dpad left": pygame.K_LEFT,
    "dpad right": pygame.K_RIGHT,
    "dpad up": pygame.K_UP,
    "dpad down": pygame.K_DOWN,
    "b": pygame.K_e,
}
PASSED_ON = (pygame.K_0, pygame.K_F11, pygame.K_F12, pygame.K_LSHIFT, pygame.K_RSHIFT, pygame.K_LCTRL, pygame.K_RCTRL)
COLORS = {"joints": GREEN, "changed": PAPER, "counted": PAPER, "reads": SKY, "may write": ORANGE}
PARTS = ("x", "y", "angle", "1", "2")  # ends of the names of columns that are parts of one quantity
# The layers that show the results or motion of a stage.
SHOWN = {
    "awake": ("islands",),
    "weigh": ("centers",),
    "integrate_velocities": ("centers",),
    "motion_rectangles": ("motion",),
    "broad_phase": ("pairs", "structure"),
    "narrow_phase": ("contacts",),
    "wake": ("islands",),
    "soft_step": ("impulses", "joints", "centers"),
    "sequential_impulse": ("impulses", "joints", "centers"),
    "projection": ("contacts", "centers"),
    "blocking": ("contacts", "centers"),
    "integrate_positions": ("bounds", "centers"),
    "time_of_impact": ("ghosts",),
    "carry": ("outlines",),
    "final_poses": ("bounds", "contacts"),
    "joints": ("joints",),
    "sensors": ("contacts",),
    "islands": ("islands",),
    "events": ("contacts",),
}


class StepInspectorView:
    """View of the step inspector. enter() starts an inspection, and leave() ends it.

    During an inspection, feed() processes events, and draw() shows the strip of stages and a card. rewind: the past
    steps, which supply the next step's input after a rewind; None means that steps cannot be inspected.
    """

    def __init__(self, session: Session, rewind: Rewind | None, overlays: Overlays) -> None:
        self.session, self.rewind, self.overlays = session, rewind, overlays
        self.step: StepInspector | None = None
        self.world = 0  # index in worlds()
        self.whose = ""  # origin of the input
        self.names: list[tuple[pygame.Rect, int]] = []  # (place, number) of each stage in the last picture
        self.corner: int | None = None  # of the card, chosen in the first picture

    @property
    def open(self) -> bool:
        """Whether a step is being inspected."""
        return self.step is not None

    def worlds(self) -> list[WatchedWorld]:
        """Return the worlds of the scene's views, each world once."""
        return list({id(world): world for world, _ in self.session.scene.views()}.values())

    def enter(self, world: int = 0) -> str:
        """Start to inspect the next step of a world. Return "", or the reason why this is impossible.

        world: index of the world in worlds().
        """
        self.leave()
        if self.rewind is None:
            return "a recording is only watched"
        session, worlds = self.session, self.worlds()
        self.world = world % len(worlds)
        following, self.whose = next_input(session, self.rewind)
        step = StepInspector(session.scene, worlds[self.world], session.inputs.now, following)
        if not step.stages:
            return "the next frame makes no step here: there is nothing to inspect"
        self.step, self.corner = step, None
        step.go(1)
        return ""

    def leave(self) -> None:
        """End the inspection, and restore the scene to its state before the inspected step."""
        if self.step is not None:
            self.step.leave()
            self.step = None
            self.overlays.watch(self.session.scene)

    def feed(self, event: pygame.event.Event, button: str | None) -> bool:
        """Process an event. Return whether the event was used. button: the pad button that the event presses, or None.

        A key that has no function here or in the overlays ends the inspection.
        """
        step = self.step
        if step is None:
            return False
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            place = next((number for rect, number in self.names if rect.collidepoint(event.pos)), None)
            if place is not None:
                step.go(place)
            return place is not None
        key = event.key if event.type == pygame.KEYDOWN else PAD_KEYS.get(button or "")
        if key is None and button is None:
            return False
        if key in WAYS:
            step.go(step.place + WAYS[key])
        elif key in WORLD_WAYS:
            self._turn_world(WORLD_WAYS[key])
        elif key in PASSED_ON or any(key == getattr(pygame, f"K_{layer.key}") for layer in self.overlays.layers):
            return False
        else:
            self.leave()
            return key in (pygame.K_e, pygame.K_ESCAPE)
        return True

    def _turn_world(self, way):
        """Inspect the next or previous world in worlds() that makes a step in this frame.

        way: 1 for the next, -1 for the previous.
        """
        here, count = self.world, len(self.worlds())
        for number in range(1, count + 1):
            if not self.enter(here + way * number):
                return

    @contextmanager
    def showing(self) -> Iterator[None]:
        """Turn on the overlays that show the results of the last stage, within the `with` block."""
        overlays, chosen = self.overlays, self.overlays.on
        if self.step is not None and self.step.done is not None:
            shown = set(SHOWN.get(self.step.done.stage.stage, ()))
            overlays.on = chosen | (shown if len(self.step.world.joints) else shown - {"joints"})
        try:
            yield
        finally:
            overlays.on = chosen

    # --- the picture ------------------------------------------------------------------------------------------------

    def reserve(self, frame: Frame) -> None:
        """Reserve the rectangle of the strip of stages, so that other text avoids it."""
        frame.reserve(self._layout(frame)[0])

    def _layout(self, frame):
        """Return (rectangle of the strip of stages, list of its stages). The strip is at the bottom of the picture.

        Each stage is (text, rectangle, number of the stage, counted from 1).
        """
        assert self.step is not None
        scale, area = frame.text_scale, frame.area.clip(frame.rect)
        several = len(self.step.starts) > 1
        names, x, row = [], area.x + EDGE * scale, 0
        for number, stage in enumerate(self.step.stages):
            text = plain_name(stage.stage)
            if several and number in self.step.starts:
                text = f"step {self.step.starts.index(number) + 1}: {text}"
            width = frame.measure(text, SMALL, scale)[0]
            if x + width > area.right - EDGE * scale:
                x, row = area.x + EDGE * scale, row + 1
            names.append((text, x, row, width, number + 1))
            x += width + GAP * scale
        high = (8 * (row + 2) + 5) * scale
        rect = pygame.Rect(area.x, area.bottom - high, area.width, high)
        return rect, [
            (text, pygame.Rect(x - scale, rect.y + (2 + 8 * row) * scale, width + 2 * scale, 8 * scale), number)
            for text, x, row, width, number in names
        ]

    def draw(self, frame: Frame) -> None:
        """Draw the strip of stages, and the card of the last stage that was run."""
        if self.step is None:
            return
        rect, names = self._layout(frame)
        scale, place = frame.text_scale, self.step.place
        frame.surface.fill(INK, rect)
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]  # now hidden
        for text, box, number in names:
            if number == place:
                frame.surface.fill(GOLD, box)
            color = INK if number == place else SKY if number < place else FOG
            frame.text(text, box.x + scale, box.y + scale, color, SMALL, scale)
        self.names = [(box, number) for _, box, number in names]
        line = KEYS_LINE + (WORLDS_LINE if len(self.worlds()) > 1 else "")
        frame.text(line, rect.centerx, rect.bottom - 8 * scale, FOG, SMALL, scale, "center")
        self._ring_view(frame)
        self._draw_card(frame, rect.top)

    def _ring_view(self, frame):
        """Draw a border around the view of the inspected world, if the scene shows several worlds."""
        views = self.session.scene.views()
        if len(views) > 1 and self.step is not None:
            camera = next(camera for world, camera in views if world is self.step.world)
            pygame.draw.rect(frame.surface, GOLD, frame.lens(camera).clip, max(1, frame.scale - 1))

    def _lines(self, width, scale):
        """Return the lines of the card. width: width of the text [frame px]; scale: frame px per text px."""
        lines: list[tuple[str, Color, str, int]] = []
        for text, ink, font, height in self._paragraphs():
            wrapped = wrap(text, width, font, scale)
            lines += [("", ink, font, BETWEEN)] * bool(lines) + [(each, ink, font, height) for each in wrapped]
        return lines

    def _draw_card(self, frame, bottom):
        """Draw the card above the strip of stages, whose top is `bottom`. A long card is wider, so that it fits."""
        area = frame.area.clip(frame.rect)
        area.height = bottom - area.y
        bars = bars_of(self.session.scene.totals)
        below = bar_table_height(len(bars)) + BETWEEN
        for scale, width in ((scale, width) for scale in range(frame.text_scale, 0, -1) for width in WIDTHS):
            room = width * scale
            lines = self._lines(room - 2 * EDGE * scale, scale)
            size = room, (sum(height for *_, height in lines) + below + 2 * EDGE) * scale
            if size[0] <= area.width and size[1] <= area.height:
                break
        head = round(self.session.scene.head * frame.zoom)
        if size[1] <= area.height - head:  # the title line stays visible
            area = pygame.Rect(area.x, area.y + head, area.width, area.height - head)
        rect = self._place(frame, area, size)
        frame.surface.fill(faded(NIGHT, 0.1), rect)
        pygame.draw.rect(frame.surface, GOLD, rect, max(1, scale // 2))
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]
        y = rect.y + EDGE * scale
        for text, ink, font, height in lines:
            frame.text(text, rect.x + EDGE * scale, y, ink, font, scale)
            y += height * scale
        table = pygame.Rect(rect.x + EDGE * scale, y + BETWEEN * scale, room - 2 * EDGE * scale, 0)
        draw_bar_table(frame, table, list(FIELDS.values()), bars, scale)
        frame.fix(rect)

    def _place(self, frame, area, size):
        """Return the rectangle of the card: in the upper corner of `area` where it covers less text.

        The corner does not change while the step is inspected. size: size of the card.
        """
        corners = area.left, area.right - size[0]
        if self.corner is None:
            narrow = pygame.Rect(area.x, area.y, area.width, min(area.height, size[1]))
            best = least_covering([box for box, _ in frame.boxes], narrow, (size[0], narrow.height))
            self.corner = int(best.centerx > area.centerx)
        return pygame.Rect(corners[self.corner], area.top, *size)

    def _paragraphs(self):
        """Yield (text, colour, font, height) of each paragraph of the card."""
        step = self.step
        assert step is not None
        count, done = len(step.stages), step.done
        if done is None:
            yield "Before the first stage", GOLD, TEXT, 10
            yield (
                "The scene's rules have run up to the step: velocities and forces are what they set.",
                PAPER,
                SMALL,
                ROW,
            )
        else:
            yield f"{step.place} of {count}: {plain_name(done.stage.stage)}", GOLD, TEXT, 10
            seconds = step.seconds[step.place - 1]
            runs = count_text(len(seconds), "run")
            yield f"{1e6 * min(seconds):,.1f} us, the least of {runs} of this step", PAPER, SMALL, ROW
            for head, text in described(done):
                yield f"{head}: {text}", COLORS[head], SMALL, ROW
        worlds = len(self.worlds())
        if worlds > 1:
            yield f"world {self.world + 1} of {worlds}", FOG, SMALL, ROW
        if len(step.starts) > 1:
            yield f"{len(step.starts)} steps in this frame, one after the other", FOG, SMALL, ROW
        yield self.whose, FOG, SMALL, ROW
        choice = sentence_of(self.session.scene.totals) or "Measuring the effects of this scene, all, and none:"
        yield choice, GOLD, SMALL, ROW


def described(done: Done) -> list[tuple[str, str]]:
    """Return (heading, text) pairs about a finished stage: its results for joints, its changes, counters and fields.

    done: the Done of the stage.
    """
    changes = [f"{name} {new}, were {old}" for name, old, new in done.rows]
    for name, rows, columns in done.changed:
        of = f" ({compact(columns)}) of" if columns else ""
        changes.append(f"{name}{of} {count_text(rows, 'row')}")
    counted = [f"{plain_name(name)} {count:+,}" for name, count in done.counted.items()]
    joints = [("joints", done.joints)] if done.joints else []
    return [
        *joints,
        ("changed", "; ".join(changes) or "nothing in these tables"),
        ("counted", ", ".join(counted) or "nothing"),
        ("reads", grouped(done.stage.reads)),
        ("may write", grouped(done.stage.writes)),
    ]


def grouped(fields: Iterable[str]) -> str:
    """Return names of fields as text, with the columns of each table in parentheses: "dt, library, bodies (x y)"."""
    whole: dict[str, list[str]] = {}
    for field in fields:
        name, _, column = field.partition(".")
        whole.setdefault(name, [])
        if column and column not in whole[name]:
            whole[name].append(column)
    return ", ".join(
        plain_name(name) + (f" ({compact(columns)})" if columns else "") for name, columns in whole.items()
    )


def compact(columns: Iterable[str]) -> str:
    """Return names of columns as text. Columns of one quantity share its name: "vx vy center_x/y settled_x/y/angle"."""
    parts: dict[str, list[str]] = {}
    for column in columns:
        quantity, _, part = column.rpartition("_")
        if quantity and part in PARTS:
            parts.setdefault(f"{quantity}_", []).append(part)
        else:
            parts[column] = []
    return " ".join(name + "/".join(found) for name, found in parts.items())
