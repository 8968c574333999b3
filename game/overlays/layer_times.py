"""Stage times as a stacked graph that scrolls, with the counters of the last step beside it."""

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, NIGHT, PAPER, SERIES, SLATE, faded, toned
from game.drawing.presenter import Frame
from game.overlays.layer import Layer
from game.scene import Scene

HISTORY = 240  # steps kept: four seconds
SMOOTHING = 0.06  # share of the newest step in the figures written out; raw ones cannot be read
SHOWN = (  # counters written out, in the order of the step
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
SCALED_TO = 0.95  # share of the steps that the graph shows at full height
LEAST_GRAPH = 70  # [text px] the graph keeps at least this width
LEAST_TOP = 0.5  # [ms] top of the graph when everything is fast
FRAME_BUDGET = 1000 / 60  # [ms] a frame at 60 Hz


class Times(Layer):
    """note(scene) once per step; draw() paints graph and tables into a rect."""

    name, title, key, color = "times", "Stage times", "8", GOLD

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Forget the history (another scene)."""
        self.steps = []  # per step: {stage: ms}
        self.totals = []  # [ms] of the same steps
        self.mean = {}
        self.counters = {}
        self.noted = self.painted = 0  # steps since the start, and how many of them the sheet shows
        self.sheet, self.sheet_for = pygame.Surface((0, 0)), None

    def note(self, scene: Scene) -> None:
        """Take the measurements of the last step."""
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
        self.mean = {
            name: spent if name not in self.mean else self.mean[name] + (spent - self.mean[name]) * SMOOTHING
            for name, spent in step.items()
        }

    def draw_graph(self, frame: Frame, rect: pygame.Rect) -> None:
        """Paint into a frame rect: graph on the left, stages in the middle, counters on the right."""
        scale = frame.text_scale
        frame.surface.fill(faded(NIGHT, 0.3), rect)
        pygame.draw.rect(frame.surface, SLATE, rect, 1)
        inner = rect.inflate(-6 * scale, -6 * scale)
        column = _column_width(frame, scale)
        tables = [
            ("stage [us]", [(self._color(name), name, f"{spent * 1000:.0f}") for name, spent in self.mean.items()]),
            ("last step", [(FOG, name, f"{self.counters.get(name, 0)}") for name in SHOWN]),
        ]
        # Where there is no room for both tables the counters give way, then the stages.
        fitting = max(0, min(len(tables), (inner.width - LEAST_GRAPH * scale) // (column + 5 * scale)))
        width = inner.width - fitting * (column + 5 * scale)
        self._graph(frame, pygame.Rect(inner.x, inner.y, width, inner.height), scale)
        x = inner.x + width
        for head, rows in tables[:fitting]:
            self._table(frame, x + 5 * scale, inner, column, scale, rows, head)
            x += column + 5 * scale

    def _color(self, name):
        names = list(self.mean)
        return SERIES[names.index(name) % len(SERIES)] if name in self.mean else FOG

    def _graph(self, frame, rect, scale):
        totals = sorted(self.totals) or [0.0]
        # One slow step (a compiler, a garbage collection) must not flatten all others: it is cut, and capped white.
        top = round_up(max(LEAST_TOP, totals[int(len(totals) * SCALED_TO)] * 1.1))
        self._scroll(rect.size, top, frame.palette)
        frame.surface.blit(self.sheet, rect)
        for part in (0.5, 1.0):
            y = rect.bottom - int(rect.height * part * 0.999)
            pygame.draw.line(frame.surface, SLATE, (rect.left, y), (rect.right, y))
        frame.text_if_free(f"{top:g} ms", rect.x + scale, rect.y + scale, PAPER, SMALL, scale, "left", True)
        frame.text_if_free(
            f"{sum(self.mean.values()):.2f} ms a step, frame {FRAME_BUDGET:.1f}",
            rect.x + scale,
            rect.bottom - 8 * scale,
            GOLD,
            SMALL,
            scale,
            "left",
            True,
        )

    def _scroll(self, size, top, palette):
        """Bring the graph's sheet up to date: only the new columns are painted unless its size or scale changed."""
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

    def _table(self, frame, x, inner, width, scale, rows, head):
        height = 7 * scale
        y = inner.y
        frame.text(head, x, y, FOG, SMALL, scale)
        room = inner.height // height - 1
        shown = rows if len(rows) <= room else rows[: max(room - 1, 0)]
        for color, name, value in shown:
            y += height
            frame.surface.fill(frame.tone(color), (x, y, 2 * scale, 5 * scale))
            frame.text(name.replace("_", " "), x + 4 * scale, y, PAPER, SMALL, scale)
            frame.text(value, x + width, y, PAPER, SMALL, scale, "right")
        if len(shown) < len(rows):
            frame.text(f"and {len(rows) - len(shown)} more", x + 4 * scale, y + height, FOG, SMALL, scale)


def round_up(value: float) -> float:
    """The next of 0.5, 1, 2, 5, 10, 20, ...: a scale that changes seldom and is easily read."""
    power = 0.1
    while True:
        for digit in (1, 2, 5):
            if digit * power >= value:
                return digit * power
        power *= 10


def _column_width(frame, scale):
    """Room for the longest name and a number of seven digits."""
    longest = max(frame.measure(name.replace("_", " "), SMALL, scale)[0] for name in SHOWN)
    return longest + frame.measure(" 9999999", SMALL, scale)[0] + 6 * scale
