"""Hard cases, one per page: a naive method beside the engine's, with the error and time of both.

In short: only the left world fails. Below each side: its error, the page's limit, and the time of a step.

What to see: two worlds with the same bodies. The left world uses a simple method: tests at the poses only, a fixed
number of substeps, iterative joints, no sleep, hulls, or a simple solver of the page itself. The right world uses the
full method. Below each are its error, the limit of the page, and the time of a step. On some pages both sides should be
alike: a thousand bodies at one point, ten million pixels from the origin.

Why it matters: Hard cases decide which engine to choose; each is shown with both methods here.

To try: step through the pages; find one where the naive method is as good.

Source: the cases and their limits: docs/stability.md.
"""

from collections import deque
from math import log10

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, INK, NIGHT, ORANGE, PAPER, RED, SLATE, faded
from game.drawing.headline import ENOUGH, Headline
from game.drawing.number_text import SMALLEST
from game.drawing.sprites import load_backdrop
from game.drawing.typical import Typical
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, Recipe, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Effects
from scenes.lab.gallery.page import MARKED, Side
from scenes.lab.gallery.pages import PAGES
from scenes.lab.looks import Looks
from scenes.lab.piles import SOLVERS, step_seconds
from scenes.lab.yard import HEAD

NAMES = tuple(page.name for page in PAGES)
SIDES = ("left", "right")
VIEWS = ((4, 18, 234, 160), (242, 18, 234, 160))
COLORS = (ORANGE, GREEN)
PLOT = (116, 192, 118, 40)  # of the left side; the other's is offset like its view
HISTORY = 240  # steps in a plot
BELOW, ABOVE = 2.0, 3.0  # decades of a plot below the limit and above it
GLANCES = {sum(page.glance for page in PAGES[:number]): number for number in range(len(PAGES))}  # frame -> page
TOURED = sum(page.glance for page in PAGES)  # frames after which the bot has looked at each
STEPS_OF_LARGER = 2  # in a run with steps of seconds
DUE = TOURED + sum(page.steps for page in PAGES) + 2400  # frames after which the bot has judged all


class Gallery(Scene):
    """Scene that runs the selected page of the gallery: two sides with a world each, stepped in the same frame."""

    name = "lab/gallery"
    title = "Gallery"
    question = STANDS
    about = (
        "Twenty-nine hard cases, the naive way and ours side by side: what goes wrong, by how much, and what it costs."
    )
    effects = Effects(
        response=True,
        gravity=True,
        rotation=True,
        friction=True,
        restitution=True,
        stacking=True,
        continuous=True,
        sleeping=True,
        sensors=True,
        joints=True,
    )
    features = (
        "tunnelling, columns, mass ratios, gates, joints, seams, pixels",
        "error against a limit, and microseconds, of both ways",
        "a thousand bodies at one point, 10^7 px from the origin",
    )
    solvers = SOLVERS
    keeps = {"solver": "each page names its two ways to solve itself: they are what is compared"}
    sliders = (
        Slider("page", 0, len(PAGES) - 1, 0, choices=NAMES),
        Slider("side", 0, 1, 0, choices=SIDES),  # the one whose error is in the title line
    )
    actions = (("left right", "page"), ("Space", "again"), ("X", "other side"))
    head = HEAD
    legend_at = (6, 20)

    def build(self):
        """Load the picture of the sky, and open the selected page."""
        self.sky = load_backdrop("sky_dusk")
        self.verdicts = {}  # page name -> (error of the naive way, of the other) when it was judged
        self.open()

    def open(self):
        """Replace both worlds by new ones, in the state in which the selected page starts."""
        page = self.page
        self.worlds, self.sides = [], []
        for way in (page.naive, page.ours):
            wanted = {
                name: getattr(page.effects, name) and getattr(self.effects, name) for name in self.effects.names()
            }
            wanted.update(dict.fromkeys(way.without, False))
            settings = dict(way.world)
            solver = settings.pop("solver", "soft_step" if page.effects.stacking else "projection")
            world = self.add_world(Effects(**wanted), solver=solver, seed=self.seed, **settings)
            self.sides.append(Side(page, way, world))
        for side, other in zip(self.sides, reversed(self.sides), strict=True):
            side.begin(other)
        x, y, width = page.frame
        zoom = VIEWS[0][2] / width
        self.cameras = []
        for view, side in zip(VIEWS, self.sides, strict=True):
            origin = side.kept.get("origin", 0.0)
            self.cameras.append(Camera(view, zoom, x + origin - view[2] / zoom / 2, y + origin - view[3] / zoom / 2))
        self.looks = [Looks(side.world, camera) for side, camera in zip(self.sides, self.cameras, strict=True)]
        self.errors = [deque(maxlen=HISTORY) for _ in self.sides]
        self.costs = [Typical() for _ in self.sides]

    @property
    def page(self):
        """The selected Page."""
        return PAGES[int(self.values["page"])]

    def change_slider(self, name, value):
        """Set the slider `name` to `value`. A new page is opened from its start."""
        super().change_slider(name, value)
        if name == "page":
            self.open()

    def update(self, inputs):
        """Process keys, step both worlds, and read their errors."""
        turn = inputs.pressed("right") - inputs.pressed("left")
        if turn:
            self.change_slider("page", (self.values["page"] + turn) % len(PAGES))
        if inputs.pressed("fire"):
            self.open()
        if inputs.pressed("bomb"):
            self.change_slider("side", 1 - self.values["side"])
        for side in self.sides:
            side.step()
        for side, errors in zip(self.sides, self.errors, strict=True):
            side.measure()
            errors.append(side.now)
        if self.sides[0].steps == self.page.steps:
            self.verdicts[self.page.name] = tuple(side.error for side in self.sides)

    def observe(self):
        """Record the time of both sides' last step, for the figures under the pictures."""
        for cost, side in zip(self.costs, self.sides, strict=True):
            cost.note(step_seconds(side.world) * 1e6)

    def measured(self):
        """Return a RunRequest for the runs of the page's larger case, or None if the page has no larger case."""
        if self.page.larger is None:
            return None
        return RunRequest([self._run_name(side) for side in self.sides], self._make)

    def _run_name(self, side):
        return side.page.name, side.way.name, self.broadphase

    def _make(self, name):
        larger, way = self.page.larger, next(side.way for side in self.sides if self._run_name(side) == name)
        assert larger is not None
        made = Recipe(larger.maker, (dict(way.world),))
        return MeasuredRun([made], self.broadphase, STEPS_OF_LARGER, judged=(1, larger.steps))

    def larger(self, side):
        """Return (error, RunFigures) of a side in the page's larger case (see page.Larger), or None until
        it has run.
        """
        figures = self.figures.get(self._run_name(side))
        if self.page.larger is None or figures is None:
            return None
        return self.page.larger.read(figures), figures

    def views(self):
        """Return a list of (world, camera), one for the picture of each side."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw both worlds, the figures under each world, and the page's lines of text.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for index, camera in enumerate(self.cameras):
            view = camera.viewport
            canvas.surface.blit(self.sky, view, (60 * index, 60, *view.size))
            self.looks[index].draw(canvas, alpha)
            pygame.draw.rect(canvas.surface, COLORS[index], view.inflate(2, 2), 1)
            self._draw_figures(canvas, index)
        canvas.text(self.page.seen, 6, 240, PAPER)
        canvas.text(self.page.why, 6, 254, FOG, SMALL)

    def _draw_figures(self, canvas, index):
        side, x = self.sides[index], VIEWS[index][0]
        page, held = side.page, side.holds
        canvas.text(side.way.name, x + 2, 182, COLORS[index])
        judged = side.steps >= page.steps
        canvas.text(amount(side.error), x + 2, 194, RED if not held else GREEN if judged else PAPER)
        rate = None if page.rate is None else page.rate(side)
        canvas.text(page.unit if rate is None else f"{page.unit}, of {rate.total}", x + 2, 204, FOG, SMALL)
        limit = f"limit {amount(page.limit)}" if rate is None else f"limit {amount(page.limit)}; {interval(rate)}"
        canvas.text(limit, x + 2, 212, FOG, SMALL)
        if side.way.step is None:
            canvas.text(f"{self.costs[index].value:,.0f} us a step", x + 2, 221, GOLD, SMALL)
        else:
            canvas.text("stepped by this page", x + 2, 221, FOG, SMALL)
        if page.also is not None:
            canvas.text(page.also(side), x + 2, 229, PAPER, SMALL)
        if page.larger is not None:
            found = self.larger(side)
            sentence = "being stepped" if found is None else amount(found[0])
            if found is not None and found[1].sure:
                sentence += f", {found[1].cost.median:.1f} s"
            canvas.text(f"{page.larger.name}: {sentence}", x + 2, 229, PAPER, SMALL)

    def draw_on_frame(self, frame):
        """Draw the shapes and marks that need window resolution, and the plots of both errors with the limit."""
        for index, look in enumerate(self.looks):
            look.draw_on_frame(frame)
            self._draw_marks(frame, index)
            self._draw_errors(frame, index)

    def _draw_marks(self, frame, index):
        """Draw the marks of good (green) and bad (red) results on the picture of side number `index`."""
        side, lens = self.sides[index], frame.lens(self.cameras[index])
        frame.surface.set_clip(lens.clip)
        for x, y, good, step in side.marks:
            if side.steps - step >= MARKED:
                continue
            color = faded(GREEN if good else RED, 0.5 * (side.steps - step) / MARKED)
            pygame.draw.circle(frame.surface, color, lens.points(x, y), 1.5 * frame.scale)
        frame.surface.set_clip(None)

    def _draw_errors(self, frame, index):
        """Draw the error of side number `index` over time on a logarithmic scale, with a line at the limit."""
        left, top, width, height = PLOT
        rect = frame.from_canvas((left + VIEWS[index][0], top, width, height))
        surface, scale, limit = frame.surface, frame.scale, self.page.limit
        surface.fill(INK, rect)
        pygame.draw.rect(surface, SLATE, rect, 1)

        def height_of(error):
            share = (log10(max(error, limit * 10**-BELOW) / limit) + BELOW) / (BELOW + ABOVE)
            return rect.bottom - 2 - (rect.height - 4) * min(share, 1.0)

        y = height_of(limit)
        for x in range(rect.left + 2, rect.right - 2, 6 * scale):
            pygame.draw.line(surface, GOLD, (x, y), (min(x + 3 * scale, rect.right - 2), y))
        errors = self.errors[index]
        if len(errors) > 1:
            notch = (rect.width - 4) / (HISTORY - 1)
            points = [(rect.left + 2 + notch * k, height_of(error)) for k, error in enumerate(errors)]
            pygame.draw.lines(surface, COLORS[index], False, points, max(1, scale - 1))
        plot_scale = frame.plot_scale
        frame.text_if_free("limit", rect.right - 3 * plot_scale, y - 7 * plot_scale, GOLD, SMALL, plot_scale, "right")
        frame.fix(rect)

    def check(self):
        """Return the scene's goals, a list with one Goal for each page.

        The naive world's error exceeds the limit, and the error of the engine's world does not. On pages with `alike`,
        neither error exceeds it.
        """
        return [
            Goal(
                page.title,
                DUE,
                page.name in self.verdicts and is_met(page, *self.verdicts[page.name]),
                self._result(page),
            )
            for page in PAGES
        ]

    def _result(self, page):
        if page.name not in self.verdicts:
            return "not judged yet"
        naive, ours = self.verdicts[page.name]
        return f"{amount(naive)} and {amount(ours)} {page.unit}, limit {amount(page.limit)}"

    def _error(self, side):
        """Return the error of a side as text: a number, or the cases out of all with the interval of their share."""
        if self.page.rate is None:
            return amount(side.error)
        rate = self.page.rate(side)
        return f"{rate.count} of {rate.total} ({interval(rate)})"

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        page, at = self.page, int(self.values["side"])
        side = self.sides[at]
        number, unit, seen, of = amount(side.error), page.unit, side.steps, "steps"
        if page.rate is not None:
            rate = page.rate(side)
            number, unit = f"{rate.count} of {rate.total}", f"{page.unit.removeprefix('% ')} ({interval(rate)})"
            seen, of = rate.total, "shots"
        sentence = f"{page.title}: {side.way.name} fails."
        headline = Headline(sentence, f"X: the {SIDES[1 - at]} side", number, unit, seen, ENOUGH, of, side.holds)
        return headline.asks(f"{page.title}: does {side.way.name} hold?")

    def finding(self):
        """Return a sentence with both errors on this page so far, and the number of pages that had the expected
        result.
        """
        naive, ours = self.sides
        if not naive.steps:
            return "not yet: the page has to be stepped"
        page = self.page
        errors = ", ".join(f"{side.way.name} {self._error(side)}" for side in (naive, ours))
        unit = page.unit if page.rate is None else page.unit.removeprefix("% ")
        sentence = f"{page.title}, step {naive.steps}: {errors} {unit}"
        met = sum(is_met(page, *self.verdicts[page.name]) for page in PAGES if page.name in self.verdicts)
        judged = f"; {met} of {len(self.verdicts)} judged pages came out as expected" if self.verdicts else ""
        full = [found for side in self.sides if (found := self.larger(side)) is not None]
        if len(full) == len(self.sides) and page.larger is not None:
            sentence += f"; {page.larger.name} {' and '.join(amount(error) for error, _ in full)}"
        limit = f"limit {amount(page.limit)}{'' if page.rate is None else ' %'}"
        return f"{sentence}, {limit}{judged}"

    def bot(self):
        """Return the bot's input for the next step.

        The bot first opens each page for a few frames. Then it opens each page again until its result is known.
        """
        if self.frame < TOURED:
            number = GLANCES.get(self.frame)
            return InputFrame(changes=() if number is None else (("slider:page", number),))
        following = min(len(self.verdicts), len(PAGES) - 1)
        if self.page is not PAGES[following] or self.frame == TOURED:
            return InputFrame(changes=(("slider:page", following),))
        return InputFrame()

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the page, its errors and all verdicts."""
        sides = (value for side in self.sides for value in (side.steps, side.now, side.worst))
        verdicts = (value for pair in self.verdicts.values() for value in pair)
        return (self.frame, *self.values.values(), *sides, *self.verdicts, *verdicts)


def is_met(page, naive, ours):
    """Return whether the errors of the naive world (`naive`) and of the engine's world (`ours`) are as the page
    expects.
    """
    return ours <= page.limit and (naive <= page.limit) == page.alike


def interval(rate):
    """Return the 95 % confidence interval of a Rate as short text, for example "78 to 95 %"."""
    low, high = rate.interval
    return f"{100 * low:.0f} to {100 * high:.0f} %"


def amount(value):
    """Return an error as short text, for example "0", "<0.001", "18.2" or "50,314"."""
    if value == 0.0:
        return "0"
    if abs(value) < SMALLEST:
        return f"<{SMALLEST}"
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"
