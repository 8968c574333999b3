"""Pages of the gallery: a hard case as data, with functions that set it up, move it and read its error.

A way is the setup of one of the two worlds; a side is that world while it runs. Lengths in the worlds are in pixels, 32
to the metre, the default of physics; errors have the unit that the page names.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from game.measure.measured_runs import RunFigures
from physics import Effects, Polygon, World

METER = 32.0  # [px]
MM = 1000.0 / METER  # [mm/px]
FLOOR_DEPTH = 32.0 * METER
MARKED = 60  # steps for which a mark is visible
WORST, LAST = "worst", "last"  # error of a run that is compared with the limit


@dataclass(frozen=True)
class Way:
    """One of a page's two ways. world: arguments of its World; bodies: arguments of its build(); without: effects.

    step: makes a step of its side instead of World.step(), for a method that the engine does not have.
    """

    name: str
    world: Mapping[str, Any] = field(default_factory=dict)
    bodies: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()
    step: Callable[["Side"], None] | None = None


def auto(accuracy):
    """Return the setting that takes enough substeps to limit the sag of contacts to this [mm]; no cap is hit while 32
    suffice.
    """
    name = f'substeps="auto", to {accuracy} mm'
    return Way(name, {"substeps": "auto", "accuracy": accuracy / MM})


SOFT = Way("soft step", {"solver": "soft_step"})
KEPT = Way("sequential impulse, 10 passes", {"solver": "sequential_impulse", "substeps": 4})
PUSHED = Way("projection", {"solver": "projection"})
PLAIN = Way("projection", PUSHED.world, without=("stacking",))


@dataclass(frozen=True)
class Larger:
    """The same case at a size too large for a frame: it is stepped beside the game.

    maker: "module:function" of a snapshot, with a way's `world` as its argument. steps: number of judged steps, from
    the start.
    """

    name: str  # "1,000 boxes"
    maker: str
    steps: int
    read: Callable[[RunFigures], float]  # its error, in the unit of the page


@dataclass(frozen=True)
class Page:
    """A hard case. The naive way must exceed the limit and the other keep it; if they are alike, both must keep it."""

    name: str
    title: str
    seen: str  # one line: what is visible
    why: str  # one line: the reason
    naive: Way
    ours: Way
    effects: Effects
    build: Callable[["Side"], None]  # adds the bodies to side.world
    error: Callable[["Side"], float]  # after each step
    unit: str  # of the error
    limit: float
    steps: int  # after which it is judged, and the bot continues
    frame: tuple[float, float, float]  # x and y of the middle, and width [px] of the view
    act: Callable[["Side"], None] | None = None  # before each step
    judged: str = WORST
    alike: bool = False
    glance: int = 24  # frames of the bot's first look
    larger: Larger | None = None
    also: Callable[["Side"], str] | None = None  # a second figure, as text


class Side:
    """A world of a page while it runs.

    kept: data of build, act and error between steps; marks: (x, y [px], good or bad, step) to be drawn there.
    """

    def __init__(self, page: Page, way: Way, world: World):
        self.page, self.way, self.world = page, way, world
        self.other = self
        self.steps = 0
        self.kept: dict[str, Any] = {}
        self.marks: list[tuple[float, float, bool, int]] = []
        self.now = self.worst = 0.0

    def begin(self, other: "Side"):
        """Add the bodies; other: the other side."""
        self.other = other
        self.page.build(self)

    def step(self):
        """Make one step, without its error: the sides are measured after both have moved."""
        if self.page.act is not None:
            self.page.act(self)
        if self.way.step is None:
            self.world.step()
        else:
            self.way.step(self)
        self.steps += 1

    def mark(self, place, good):
        """Mark the place of a good or bad end; old marks are removed."""
        self.marks = [each for each in self.marks if self.steps - each[3] < MARKED]
        self.marks.append((*place, good, self.steps))

    def measure(self):
        """Read the error after a step."""
        self.now = float(self.page.error(self))
        self.worst = max(self.worst, self.now)

    @property
    def error(self):
        """Error that is compared with the limit."""
        return self.worst if self.page.judged == WORST else self.now

    @property
    def holds(self):
        """True while the error is within the limit."""
        return self.error <= self.page.limit


def dynamic(world):
    """Return the rows of dynamic bodies."""
    bodies = world.bodies
    return bodies[bodies["inverse_mass"] > 0.0]


def floor(world, half=100.0 * METER, **options):
    """Return a thick floor whose surface is at y = 0."""
    shape = Polygon.box(2.0 * half, FLOOR_DEPTH)
    return world.add_body(shape, position=(0.0, FLOOR_DEPTH / 2), kind="static", **options)
