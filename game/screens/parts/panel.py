"""The side panel: a list of rows, rebuilt for each picture and operated with keyboard or mouse.

One row is marked (selected). Up and down move the mark, left and right change the marked row's value, and Enter presses
the row. The panel is independent of scenes: a Row contains its text and the functions that it calls.
"""

from collections.abc import Callable
from dataclasses import dataclass

import pygame

from game.drawing.canvas import SMALL, TEXT, shorten
from game.drawing.colors import DUSK, FOG, GOLD, INK, NIGHT, PAPER, SKY, SLATE, faded
from game.drawing.presenter import Frame

HEAD, CHECK, CHOICE, SLIDER, BUTTON, NOTE, LINE = "head", "check", "choice", "slider", "button", "note", "line"
LIVE = (CHECK, CHOICE, SLIDER, BUTTON, LINE)
ROW_HEIGHT = {HEAD: 15, CHECK: 11, CHOICE: 11, SLIDER: 17, BUTTON: 11, NOTE: 9, LINE: 9}  # [text px]
CELL = 34  # [text px] width of a column of a table
LABEL, ARROWS = 24, 20  # [text px] room for the label of a choice, and for the arrows beside its value
WHEEL_ROWS = 3


@dataclass(frozen=True)
class Row:
    """One line of the panel.

    turn(direction) changes the row's value by -1 or 1. press() is called on Enter or a click. put(share) sets a slider
    to a share 0..1 of its range.
    """

    kind: str
    label: str
    value: str = ""
    key: str = ""  # the key with the same function, shown at the right
    color: tuple = PAPER
    on: bool = False
    share: float = 0.0  # position of a slider in its range, 0..1
    turn: Callable | None = None
    press: Callable | None = None
    put: Callable | None = None
    hint: str = ""  # one sentence, shown at the panel's foot while marked
    cells: tuple[str, ...] = ()  # of a line of a table, or its column heads, at the right


class Panel:
    """Panel of rows. rows() returns the current rows.

    focused: True if keys operate the panel, False if they operate the game.
    """

    def __init__(self, rows: Callable[[], list[Row]]) -> None:
        self.rows = rows
        self.mark = 0
        self.first = 0  # first visible row, if not all fit
        self.focused = True
        self.places = []  # (rect, row number) of the last picture
        self.dragged = None  # row number of the slider being dragged
        self.rect = pygame.Rect(0, 0, 0, 0)

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event. Return whether the panel used the event."""
        if event.type == pygame.KEYDOWN and self.focused:
            return self.key(event.key)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self.focused = self.rect.collidepoint(event.pos)
            return self._click(event.pos)
        if event.type == pygame.MOUSEBUTTONUP and event.button == 1:
            used, self.dragged = self.dragged is not None, None
            return used
        if event.type == pygame.MOUSEMOTION:
            return self._move(event.pos)
        if event.type == pygame.MOUSEWHEEL and self.rect.collidepoint(pygame.mouse.get_pos()):
            self.first = max(0, self.first - event.y * WHEEL_ROWS)
            return True
        return False

    def key(self, key: int) -> bool:
        """Process a key. Return whether the panel used the key."""
        rows = self.rows()
        row = rows[self.mark] if self.mark < len(rows) else None
        if key in (pygame.K_UP, pygame.K_DOWN):
            self._step_mark(rows, 1 if key == pygame.K_DOWN else -1)
        elif row is not None and key in (pygame.K_LEFT, pygame.K_RIGHT):
            direction = 1 if key == pygame.K_RIGHT else -1
            act(row, direction)
        elif row is not None and key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            act(row)
        else:
            return False
        return True

    def show(self, head: str) -> None:
        """Scroll to the section with the heading `head`, and mark its first row.

        Do nothing if there is no such section.
        """
        rows = self.rows()
        for first, row in enumerate(rows):
            if row.kind == HEAD and row.label == head:
                self.first = first
                self.mark = next((n for n in range(first, len(rows)) if rows[n].kind in LIVE), self.mark)

    def _step_mark(self, rows, direction):
        live = [i for i, row in enumerate(rows) if row.kind in LIVE]
        if not live:
            return
        if self.mark in live:
            self.mark = live[(live.index(self.mark) + direction) % len(live)]
        else:
            self.mark = live[0]
        self.first = min(self.first, self.mark)

    def _click(self, position):
        if not self.rect.collidepoint(position):
            return False
        rows = self.rows()
        for rect, number in self.places:
            if number < len(rows) and rect.collidepoint(position) and rows[number].kind in LIVE:
                self.mark = number
                row = rows[number]
                if row.kind == SLIDER:
                    self.dragged = number
                    row.put(_share(rect, position))
                elif row.kind == CHOICE:
                    row.turn(1 if position[0] > rect.centerx else -1)
                else:
                    act(row)
        return True

    def _move(self, position):
        rows = self.rows()
        for rect, number in self.places:
            if number < len(rows) and number == self.dragged:
                rows[number].put(_share(rect, position))
                return True
            if rect.collidepoint(position) and number < len(rows) and rows[number].kind in LIVE:
                self.mark = number
        return self.rect.collidepoint(position)

    def draw(self, frame: Frame, rect: pygame.Rect) -> None:
        """Draw the panel into a rectangle of the frame."""
        self.rect = rect
        scale = frame.text_scale
        surface = frame.surface
        surface.fill(faded(NIGHT, 0.2), rect)
        pygame.draw.line(surface, SLATE, rect.topleft, rect.bottomleft, scale)
        rows = self.rows()
        live = [i for i, row in enumerate(rows) if row.kind in LIVE]
        if self.mark not in live and live:
            self.mark = live[0]
        foot = self._draw_foot(frame, rect, rows, scale)
        self._draw_rows(frame, pygame.Rect(rect.x, rect.y, rect.width, foot - rect.y), rows, scale)
        frame.reserve(rect)

    def _draw_rows(self, frame, rect, rows, scale):
        heights = [ROW_HEIGHT[row.kind] * scale for row in rows]
        room = rect.height - 12 * scale
        self.first = max(0, min(self.first, len(rows) - 1))
        while self.first < self.mark and sum(heights[self.first : self.mark + 1]) > room:
            self.first += 1
        while self.first > 0 and sum(heights[self.first - 1 :]) <= room:
            self.first -= 1
        y = rect.y + 2 * scale
        self.places = []
        for number in range(self.first, len(rows)):
            if y + heights[number] > rect.bottom - 8 * scale:
                frame.text(f"{len(rows) - number} more below", rect.centerx, y + scale, GOLD, SMALL, scale, "center")
                break
            place = pygame.Rect(rect.x + 5 * scale, y, rect.width - 10 * scale, heights[number])
            self._draw_row(frame, place, rows[number], number == self.mark, scale)
            self.places.append((place, number))
            y += heights[number]

    def _draw_row(self, frame, rect, row, marked, scale):
        surface = frame.surface
        if row.kind == HEAD:
            frame.text(row.label, rect.x, rect.y + 5 * scale, GOLD, TEXT, scale)
            _draw_cells(frame, rect, row.cells, rect.y + 7 * scale, FOG, scale)
            pygame.draw.line(surface, SLATE, (rect.x, rect.bottom - scale), (rect.right, rect.bottom - scale))
            return
        if row.kind == NOTE:
            text = shorten(row.label, rect.width, SMALL, scale)
            frame.text(text, rect.x, rect.y + 2 * scale, FOG, SMALL, scale)
            return
        if marked:
            surface.fill(DUSK if self.focused else faded(DUSK, 0.4), rect.inflate(4 * scale, 0))
        text_y = rect.y + scale
        x = rect.x + 2 * scale
        if row.kind == LINE:
            _draw_line(frame, rect, row, scale)
            return
        if row.kind == CHECK:
            x = _draw_check(surface, x, rect, row, frame.tone(row.color), scale)
        right = rect.right - 2 * scale
        if row.key:
            frame.text(row.key, right, rect.y + 3 * scale, FOG, SMALL, scale, "right")
            right -= 18 * scale
        value = row.value
        if row.kind == CHOICE:
            value = f"\u2190 {shorten(value, right - x - (LABEL + ARROWS) * scale, TEXT, scale)} \u2192"
        if value:
            right = frame.text(value, right, text_y, SKY if row.turn or row.put else FOG, TEXT, scale, "right").left
        label = shorten(row.label, right - x - 4 * scale, TEXT, scale)
        frame.text(label, x, text_y, PAPER if row.kind != BUTTON else row.color, TEXT, scale)
        if row.kind == SLIDER:
            bar = slider_bar(rect, scale)
            surface.fill(INK, bar)
            surface.fill(SKY, (bar.x, bar.y, int(bar.width * row.share), bar.height))
            surface.fill(PAPER, (bar.x + int(bar.width * row.share) - scale, bar.y - scale, 2 * scale, 4 * scale))

    def _draw_foot(self, frame, rect, rows, scale):
        """Draw the foot of the panel: the hint of the marked row, and the line that names the key to close the panel.

        Return the y of the foot's upper edge. rows: all rows; scale: frame px per text px.
        """
        hint = rows[self.mark].hint if self.mark < len(rows) else ""
        way_out = "Tab closes, click the game to play on" if self.focused else "Tab closes, click here to change things"
        lines = ([hint] if hint else []) + [way_out]
        top = rect.bottom - (len(lines) * 8 + 3) * scale
        for index, line in enumerate(lines):
            text = shorten(line, rect.width - 12 * scale, SMALL, scale)
            color = FOG if line is way_out else GOLD
            frame.text(text, rect.x + 6 * scale, top + index * 8 * scale, color, SMALL, scale)
        return top


def _draw_line(frame, rect, row, scale):
    """Draw a row of a table: a square (filled if `row.on`), the name, and the cells.

    rect: rectangle of the row; scale: frame px per text px.
    """
    square = pygame.Rect(rect.x + 2 * scale, rect.y + 2 * scale, 5 * scale, 5 * scale)
    color = frame.tone(row.color) if row.on else FOG
    pygame.draw.rect(frame.surface, color, square, 0 if row.on else scale)
    left = _draw_cells(frame, rect, row.cells, rect.y + 2 * scale, PAPER if row.on else FOG, scale)
    label = shorten(row.label, left - square.right - 6 * scale, SMALL, scale)
    frame.text(label, square.right + 4 * scale, rect.y + 2 * scale, PAPER if row.on else FOG, SMALL, scale)


def _draw_cells(frame, rect, cells, y, color, scale):
    """Draw the cells of a table row at the right of `rect`, in order. Return the x of the left end of the first cell.

    y, color: position and colour of the text; scale: frame px per text px.
    """
    right = rect.right - 2 * scale
    for text in reversed(cells):
        if text:
            frame.text(text, right, y, color, SMALL, scale, "right")
        right -= CELL * scale
    return right


def _draw_check(surface, x, rect, row, color, scale):
    box = pygame.Rect(x, rect.y + scale, 7 * scale, 7 * scale)
    surface.fill(INK, box)
    pygame.draw.rect(surface, color, box, scale)
    if row.on:
        surface.fill(color, box.inflate(-4 * scale, -4 * scale))
    return box.right + 4 * scale


def slider_bar(rect: pygame.Rect, scale: int) -> pygame.Rect:
    """Return the rectangle of a slider's bar. rect: rectangle of the slider's row; scale: frame px per text px."""
    return pygame.Rect(rect.x + 2 * scale, rect.bottom - 5 * scale, rect.width - 4 * scale, 2 * scale)


def _share(rect, position):
    """Return the position of a click along the width of a rectangle, 0 (left) .. 1 (right)."""
    return max(0.0, min(1.0, (position[0] - rect.x) / max(rect.width, 1)))


def act(row: Row, direction: int = 0) -> None:
    """Change a row's value by `direction` (-1 or 1). For the direction 0, press the row.

    A row without press() is changed by 1 instead.
    """
    if direction and row.turn is not None:
        row.turn(direction)
    elif row.press is not None:
        row.press()
    elif row.turn is not None:
        row.turn(1)
