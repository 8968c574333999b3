"""A table of bars: one row for each compared thing, one column for each quantity, and a number beside each bar."""

from collections.abc import Sequence
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL, Canvas
from game.drawing.colors import FOG, INK, PAPER, Color, faded

ROW = 8  # [text px] height of a row
NAME = 42  # [text px] width of the column of names
NUMBER = 21  # [text px] room for a number at the right of its bar


class BarRow(NamedTuple):
    """A row of the table: its name, its colour, and (value, text) for each column.

    A value of None is drawn without a bar.
    """

    name: str
    color: Color
    cells: Sequence[tuple[float | None, str]]


def bar_table_height(rows: int) -> int:
    """Return the height of a table with `rows` rows [text px]."""
    return ROW * (rows + 1)


def draw_bar_table(
    canvas: Canvas, rect: pygame.Rect, columns: Sequence[str], rows: Sequence[BarRow], scale: int = 1
) -> None:
    """Draw the table into the rectangle `rect`.

    All bars start at 0, and the longest bar of a column fills the column's width. columns: headings of the columns,
    with units; scale: canvas or frame px per text px.
    """
    wide = (rect.width - NAME * scale) // len(columns)
    room = wide - (NUMBER + 4) * scale
    for index, heading in enumerate(columns):
        left = rect.x + NAME * scale + index * wide
        canvas.text(heading, left, rect.y, FOG, SMALL, scale)
        most = max((row.cells[index][0] or 0.0 for row in rows), default=0.0)
        for number, row in enumerate(rows, 1):
            value, text = row.cells[index]
            y = rect.y + ROW * number * scale
            bar = pygame.Rect(left, y, room, 5 * scale)
            canvas.surface.fill(faded(INK, 0.0), bar)
            if value and most:
                canvas.surface.fill(row.color, (left, y, max(scale, round(room * value / most)), bar.height))
            canvas.text(text, bar.right + 2 * scale, y, PAPER, SMALL, scale)
    for number, row in enumerate(rows, 1):
        canvas.text(row.name, rect.x, rect.y + ROW * number * scale, row.color, SMALL, scale)
