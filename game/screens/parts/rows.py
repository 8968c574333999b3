"""The list of rows that every menu uses. Rows can be marked (selected), changed, dragged (sliders) and scrolled.

Keyboard, controller and mouse have the same functions. A Row contains its text and the functions that it calls. The
list is independent of screens. All sizes are canvas px, multiples of 8.
"""

from collections.abc import Callable
from dataclasses import dataclass

import pygame

from game.drawing.canvas import SMALL, TEXT, Box, Canvas, shorten
from game.drawing.colors import DUSK, FOG, GOLD, INK, PAPER, SKY, SLATE
from game.input.inputs import InputState

FIRST_WAIT, NEXT_WAIT = 0.4, 0.1  # [s] before a held direction repeats, and between repeats
GRID = 8
LINE = 16  # from one row to the next
VALUE_WIDTH = 112  # at the right of a row: width of the value, in which a click turns it
BAR_WIDTH = 64  # of a slider


@dataclass(frozen=True)
class Row:
    """One line of a list on a menu screen. `head`: whether the row is a heading, which cannot be marked.

    turn(direction) changes the row's value, by -1 or 1. press() is called on Enter or a click. put(share) sets a slider
    to a share 0..1.
    """

    label: str
    value: str = ""
    press: Callable | None = None
    turn: Callable | None = None
    put: Callable | None = None
    share: float = 0.0
    head: bool = False
    hint: str = ""  # one sentence, shown by the screen while it is marked
    color: tuple = PAPER


class Repeat:
    """Conversion of a held direction into single moves: the first at once, the next ones at fixed intervals."""

    def __init__(self, names: tuple[str, str]) -> None:
        self.names = names  # (action for -1, action for +1)
        self.wait = 0.0

    def move(self, inputs: InputState, dt: float) -> int:
        """Return the move of this step: -1, 0 or 1. Call this in each step. dt: length of the step [s]."""
        back, forth = self.names
        for action, way in ((back, -1), (forth, 1)):
            if inputs.pressed(action):
                self.wait = FIRST_WAIT
                return way
        way = inputs.held(forth) - inputs.held(back)
        if way == 0:
            return 0
        self.wait -= dt
        if self.wait > 0.0:
            return 0
        self.wait += NEXT_WAIT
        return way


def confirmed(inputs: InputState) -> bool:
    """Return whether the player confirms in this step, with Enter, Space or the pad's A button."""
    return inputs.pressed("confirm") or inputs.pressed("fire")


class RowList:
    """A scrollable list of rows on a menu screen.

    rows() returns the current rows; rect: rectangle of the list [canvas px]. cues: the screen's list of sounds to play,
    to which this object appends sounds.
    """

    def __init__(self, rows: Callable[[], list[Row]], rect: Box, cues: list[str], mark: int = 0) -> None:
        self.rows, self.rect, self.cues = rows, pygame.Rect(rect), cues
        self.first = 0  # first visible row, if not all fit
        self.dragged: int | None = None  # row number of the bar being dragged
        self.pointer: tuple[int, int] | None = None
        self.vertical, self.sideways = Repeat(("up", "down")), Repeat(("left", "right"))
        self.mark = mark
        self.show_marked()

    @property
    def room(self) -> int:
        """Number of rows that fit into the list's rectangle."""
        return max(1, self.rect.height // LINE)

    @property
    def marked(self) -> Row | None:
        """The marked row; None in an empty list."""
        rows = self.rows()
        return rows[self.mark] if self.mark < len(rows) else None

    def place(self, number: int) -> pygame.Rect | None:
        """Return the rectangle of row `number`, or None if the row is scrolled out of view."""
        if not self.first <= number < self.first + self.room:
            return None
        return pygame.Rect(self.rect.x, self.rect.y + (number - self.first) * LINE, self.rect.width, LINE - 2)

    def show_marked(self) -> None:
        """Move the mark to the nearest row that is not a heading, and scroll until that row is visible.

        A heading directly above the row is also kept visible.
        """
        rows = self.rows()
        live = [number for number, row in enumerate(rows) if not row.head]
        if live and self.mark not in live:
            self.mark = min(live, key=lambda number: abs(number - self.mark))
        top = self.mark - 1 if self.mark > 0 and rows[self.mark - 1].head else self.mark
        self.first = max(min(self.first, top), self.mark - self.room + 1)
        self.first = max(0, min(self.first, len(rows) - self.room))

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s]: move the mark, scroll, and change, drag or press rows."""
        self._step_mark(self.vertical.move(inputs, dt))
        rows = self.rows()
        self.first = max(0, min(self.first - inputs.wheel, len(rows) - self.room))
        under = self._row_at(inputs.pointer)
        if inputs.pointer != self.pointer and under is not None and self.dragged is None:
            self.mark = under  # only a moving pointer changes the mark
        self.pointer = inputs.pointer
        row = self.marked
        if row is None:
            return
        if inputs.pointer_pressed and under is not None:
            self.mark = under
            self._click(rows[under], under, inputs.pointer)
        elif self.dragged is not None and inputs.pointer_down:
            self._drag(self.dragged, inputs.pointer)
        elif confirmed(inputs):
            self._act(row, 0)
        else:
            way = self.sideways.move(inputs, dt)
            if way and row.turn is not None:
                self._act(row, way)
        if not inputs.pointer_down:
            self.dragged = None

    def _step_mark(self, way):
        live = [number for number, row in enumerate(self.rows()) if not row.head]
        if way and live:
            at = live.index(self.mark) if self.mark in live else 0
            self.mark = live[(at + way) % len(live)]
            self.cues.append("blip")
            self.show_marked()

    def _row_at(self, pointer):
        rows = self.rows()
        for number in range(self.first, min(len(rows), self.first + self.room)):
            place = self.place(number)
            if place is not None and not rows[number].head and place.collidepoint(pointer):
                return number
        return None

    def _click(self, row, number, pointer):
        place = self.place(number)
        if place is None:
            return
        value = self.value_place(place)
        if row.put is not None and pointer[0] >= value.x:
            self.dragged = number
            self._drag(number, pointer)
        elif row.turn is not None and pointer[0] >= value.x:
            self._act(row, 1 if pointer[0] >= value.centerx else -1)
        else:
            self._act(row, 0)

    def _drag(self, number, pointer):
        rows, place = self.rows(), self.place(number)
        put = rows[number].put if number < len(rows) else None
        if place is not None and put is not None:
            bar = self.bar_place(place)
            put(max(0.0, min(1.0, (pointer[0] - bar.x) / bar.width)))

    def _act(self, row, way):
        if way and row.turn is not None:
            row.turn(way)
            self.cues.append("blip")
        elif row.press is not None:
            self.cues.append("confirm")
            row.press()
        elif row.turn is not None:
            row.turn(1)
            self.cues.append("blip")

    def value_place(self, place: pygame.Rect) -> pygame.Rect:
        """Return the rectangle of a row's value. place: rectangle of the row."""
        wide = min(VALUE_WIDTH, place.width // 2)
        return pygame.Rect(place.right - wide, place.y, wide, place.height)

    def bar_place(self, place: pygame.Rect) -> pygame.Rect:
        """Return the rectangle of a slider's bar. place: rectangle of the slider's row."""
        value = self.value_place(place)
        return pygame.Rect(value.x, value.centery - 2, BAR_WIDTH, 4)

    def draw(self, canvas: Canvas, focused: bool = True) -> None:
        """Draw the visible rows. focused: whether the keys operate this list."""
        rows = self.rows()
        for number in range(self.first, min(len(rows), self.first + self.room)):
            self._draw_row(canvas, rows[number], self.place(number), number == self.mark, focused)
        self._draw_scroll_bar(canvas.surface, len(rows))

    def _draw_row(self, canvas, row, place, marked, focused):
        if row.head:
            canvas.text(row.label, place.x, place.bottom - 7, GOLD, SMALL)
            return
        if marked:
            canvas.surface.fill(DUSK, place)
            canvas.surface.fill(GOLD if focused else SLATE, (place.x, place.y, 2, place.height))
        y, right = place.y + 3, place.right - GRID // 2
        has_value = bool(row.value) or row.put is not None
        label_end = self.value_place(place).x - 4 if has_value else right
        color = row.color if row.color != PAPER else PAPER if marked else FOG
        canvas.text(shorten(row.label, label_end - place.x - GRID, TEXT), place.x + GRID, y, color)
        if row.put is not None:
            self._draw_slider(canvas, row, place, marked)
        elif row.value:
            value = self.value_place(place)
            text = f"\u2190 {row.value} \u2192" if marked and row.turn is not None else row.value
            canvas.text(shorten(text, value.width - 4, TEXT), right, y, SKY, TEXT, 1, "right")

    def _draw_slider(self, canvas, row, place, marked):
        bar = self.bar_place(place)
        canvas.surface.fill(INK if marked else DUSK, bar)
        canvas.surface.fill(SKY, (bar.x, bar.y, round(bar.width * row.share), bar.height))
        canvas.surface.fill(PAPER, (bar.x + round((bar.width - 3) * row.share), bar.y - 2, 3, bar.height + 4))
        canvas.text(row.value, place.right - GRID // 2, place.y + 3, SKY, TEXT, 1, "right")

    def _draw_scroll_bar(self, surface, count):
        """Draw the scroll bar, unless all rows fit. count: number of rows."""
        if count > self.room:
            track = pygame.Rect(self.rect.right + 2, self.rect.y, 2, self.room * LINE - 2)
            surface.fill(DUSK, track)
            top = track.y + round(self.first * track.height / count)
            surface.fill(GOLD, (track.x, top, 2, max(4, round(track.height * self.room / count))))
