"""Times of the stages of a step, drawn as a scrolling stacked graph.

The counters of the last step are shown beside the graph.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, NIGHT, PAPER, SERIES, SLATE, Color, faded, toned
from game.drawing.number_text import plain_name
from game.drawing.presenter import Frame
from game.drawing.typical import Typical
from game.overlays.layer import Layer
from game.scene import Scene

HISTORY = 240  # steps kept: four seconds
SHOWN = (  # counters in the table, in the order of the step
    "bodies_integrated",
    "nodes_visited",
    "pairs_tested",
    "filtered",
    "candidates",
    "narrow_tests",
    "mask_tests",
    "gjk_iterations",
    "contacts",
    "toi_calls",
    "solver_rows",
    "islands",
    "cap_hits",
)
SCALED_TO = 0.95  # quantile of the step times that fits the graph's height
LEAST_TOP = 0.5  # [ms] least top of the graph
FRAME_BUDGET = 1000 / 60  # [ms] a frame at 60 Hz
LINE, GAP, MARGIN = 7, 5, 3  # [text px] of a line of a table, between two tables, and inside the frame
GRAPH = (70, 40)  # [text px] least size of the graph, including three lines of text above the bars
PLOT_LEAST = 10  # [text px] least height of the bars under the text


class Table(NamedTuple):
    """A table with a heading, and rows of (colour, name, value)."""

    head: str
    rows: Sequence[tuple[Color, str, str]]


class Times(Layer):
    """Stage times of a scene's steps. Call note(scene) once per step.

    draw_graph() draws a graph and tables of the times into a rectangle.
    """

    name, title, key, color = "times", "Stage times", "8", GOLD

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Clear the history. This is called when the scene has changed."""
        self.steps = []  # per step: {stage: ms}
        self.totals = []  # [ms] sum over the stages of each of these steps
        self.total = Typical()  # [ms]
        self.rect: pygame.Rect | None = None  # [frame px] the graph's place in the picture, None if it is not drawn
        self.stages: dict[str, Typical] = {}  # stages of the last step [ms]
        self.counters = {}
        self.noted = self.painted = 0  # steps since the start, and the number of them painted on the sheet
        self.sheet, self.sheet_for = pygame.Surface((0, 0)), None

    def note(self, scene: Scene) -> None:
        """Record the stage times and counters of the last step, summed over all worlds of the scene."""
        step, counters = {}, {}
        for world in scene.worlds:
            for name, seconds in world.profile.stages.items():
                step[name] = step.get(name, 0.0) + seconds * 1000.0
            for name, count in world.profile.counters.items():
                counters[name] = counters.get(name, 0) + int(count)
        self.steps.append(step)
        self.totals.append(sum(step.values()))
        del self.steps[:-HISTORY], self.totals[:-HISTORY]
        self.noted += 1
        self.counters = counters
        self.total.note(self.totals[-1])
        self.stages = {name: self.stages.get(name) or Typical() for name in step}
        for name, spent in step.items():
            self.stages[name].note(spent)

    def sizes(self, frame: Frame) -> Iterator[tuple[int, int]]:
        """Yield useful sizes (width, height) [frame px] of the graph with its tables, largest first.

        All of these sizes have room for every stage.
        """
        stages, counters = self._tables()
        wide = [_column_width(frame, table, 1) + GAP for table in (stages, counters)]
        high = [LINE * (len(table.rows) + 1) for table in (stages, counters)]
        for width, height in (
            (GRAPH[0] + sum(wide), max(GRAPH[1], *high)),
            (GRAPH[0] + wide[0], max(GRAPH[1], high[0])),
            (max(GRAPH[0], wide[0]), GRAPH[1] + high[0]),
        ):
            scale = frame.text_scale
            yield (width + 2 * MARGIN) * scale, (height + 2 * MARGIN) * scale

    def draw_graph(self, frame: Frame, rect: pygame.Rect) -> None:
        """Draw the graph, the table of stages and the table of counters into a frame rectangle, from left to right.

        If both tables do not fit, the counters are left out. In a narrow rectangle, the stages are drawn below the
        graph.
        """
        scale, self.rect = frame.text_scale, pygame.Rect(rect)
        frame.surface.fill(faded(NIGHT, 0.3), rect)
        pygame.draw.rect(frame.surface, SLATE, rect, 1)
        inner = rect.inflate(-2 * MARGIN * scale, -2 * MARGIN * scale)
        stages, counters = self._tables()
        columns = [_split(table, inner.height // (LINE * scale)) for table in (stages, counters)]
        widths = [_column_width(frame, table, scale) + GAP * scale for table in (stages, counters)]
        room = inner.width - GRAPH[0] * scale
        taken = 0
        shown = []
        for parts, width in zip(columns, widths, strict=True):
            if taken + width * len(parts) > room:
                break
            shown += [(part, width) for part in parts]
            taken += width * len(parts)
        if not shown:
            below = min(LINE * scale * (len(stages.rows) + 1), max(0, inner.height - GRAPH[1] * scale))
            lower = pygame.Rect(inner.x, inner.bottom - below, inner.width, below)
            self._graph(frame, pygame.Rect(inner.x, inner.y, inner.width, inner.height - below), scale)
            if below >= 2 * LINE * scale:
                _draw_table(frame, _cut(stages, below // (LINE * scale)), lower.x, lower.y, lower.width, scale)
            return
        self._graph(frame, pygame.Rect(inner.x, inner.y, inner.width - taken, inner.height), scale)
        x = inner.right - taken
        for table, width in shown:
            _draw_table(frame, table, x + GAP * scale, inner.y, width - GAP * scale, scale)
            x += width

    def _tables(self):
        stages = [(self._color(name), name, f"{spent.value * 1000:.0f}") for name, spent in self.stages.items()]
        counters = [(FOG, name, f"{self.counters.get(name, 0)}") for name in SHOWN]
        return Table("stage [us]", stages), Table("last step", counters)

    def _color(self, name):
        names = list(self.stages)
        return SERIES[names.index(name) % len(SERIES)] if name in self.stages else FOG

    def _graph(self, frame, rect, scale):
        """Draw up to three lines of text, and below them the graph of the stage times as bars.

        scale: frame px per text px.
        """
        totals = sorted(self.totals) or [0.0]
        # A single slow step (compilation, garbage collection) must not flatten the others: it is cut, with a white cap.
        top = round_up(max(LEAST_TOP, totals[int(len(totals) * SCALED_TO)] * 1.1))
        lines = ((f"{self.total.value:.2f} ms a step", GOLD), (f"a frame has {FRAME_BUDGET:.1f}", FOG))
        lines = (*lines, (f"top {top:g} ms", PAPER))
        fitting = min(len(lines), max(0, (rect.height - PLOT_LEAST * scale) // (LINE * scale)))
        for number, (text, color) in enumerate(lines[:fitting]):
            frame.text(text, rect.x, rect.y + number * LINE * scale, color, SMALL, scale)
        plot = pygame.Rect(rect.x, rect.y + fitting * LINE * scale, rect.width, rect.height - fitting * LINE * scale)
        if plot.width < 1 or plot.height < 1:
            return
        self._scroll(plot.size, top, frame.palette)
        frame.surface.blit(self.sheet, plot)
        for part in (0.5, 1.0):
            y = plot.bottom - int(plot.height * part * 0.999)
            pygame.draw.line(frame.surface, SLATE, (plot.left, y), (plot.right - 1, y))

    def _scroll(self, size, top, palette):
        """Update the image of the bars: scroll the image to the left, and paint the new steps at its right side.

        size: size of the image [frame px]; top: time at its upper edge [ms]; palette: name of the colour palette. If
        size, top or palette has changed, the whole image is painted.
        """
        column = max(1, size[0] // HISTORY)
        new = self.noted - self.painted
        if self.sheet_for != (size, top, palette) or new >= len(self.steps):
            self.sheet, self.sheet_for = pygame.Surface(size), (size, top, palette)
            self.sheet.fill(faded(NIGHT, 0.3))
            new = min(len(self.steps), size[0] // column)
        elif new:
            self.sheet.scroll(-new * column, 0)
            self.sheet.fill(faded(NIGHT, 0.3), (size[0] - new * column, 0, new * column, size[1]))
        for place in range(new):
            self._paint_column(
                self.steps[len(self.steps) - new + place], size[0] - (new - place) * column, column, top, palette
            )
        self.painted = self.noted

    def _paint_column(self, step, x, width, top, palette):
        height = self.sheet.get_height()
        base = float(height)
        for name, spent in step.items():
            upper = max(base - spent / top * height, 0.0)
            if int(base) > int(upper):
                self.sheet.fill(toned(self._color(name), palette), (x, int(upper), width, int(base) - int(upper)))
            base = upper
        if base <= 0.0:
            self.sheet.fill(PAPER, (x, 0, width, 2))


def _split(table, lines):
    """Return a table as a list of tables of at most `lines` lines. Each has the heading as its first line."""
    rows = max(1, lines - 1)
    return [Table(table.head, table.rows[first : first + rows]) for first in range(0, max(len(table.rows), 1), rows)]


def _cut(table, lines):
    """Return a table shortened to `lines` lines.

    The last line of a shortened table contains the number of omitted rows.
    """
    if len(table.rows) < lines:
        return table
    kept = table.rows[: max(lines - 2, 0)]
    return Table(table.head, [*kept, (FOG, f"and {len(table.rows) - len(kept)} more", "")])


def _draw_table(frame, table, x, y, width, scale):
    frame.text(table.head, x, y, FOG, SMALL, scale)
    for color, name, value in table.rows:
        y += LINE * scale
        frame.surface.fill(frame.tone(color), (x, y, 2 * scale, 5 * scale))
        frame.text(plain_name(name), x + 4 * scale, y, PAPER, SMALL, scale)
        frame.text(value, x + width, y, PAPER, SMALL, scale, "right")


def round_up(value: float) -> float:
    """Return the smallest of the numbers 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is at least `value`.

    Such a number makes a readable scale that seldom changes.
    """
    power = 0.1
    while True:
        for digit in (1, 2, 5):
            if digit * power >= value:
                return digit * power
        power *= 10


def _column_width(frame, table, scale):
    """Return the width [frame px] that a table needs for its longest name and its longest expected number.

    scale: frame px per text px.
    """
    longest = max((frame.measure(plain_name(name), SMALL, scale)[0] for _, name, _ in table.rows), default=0)
    digits = " 999999" if table.head.startswith("stage") else " 9999999"
    return longest + frame.measure(digits, SMALL, scale)[0] + 6 * scale
