"""What a page of the gallery is: a hard case as data, with small functions that set it up, move it and read its error.

A way is how one of the two worlds is made; a side is that world while it runs. Lengths in the worlds are in pixels, 32
to the metre, as the physics has them by itself; errors carry the unit that the page names.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from game.measure.lanes import LaneFigures
from physics import Effects, Polygon, World

METER = 32.0  # [px]
MM = 1000.0 / METER  # [mm/px]
FLOOR_DEPTH = 32.0 * METER
MARKED = 60  # steps that a mark is seen
WORST, LAST = "worst", "last"  # which of a run's errors is held against the limit


@dataclass(frozen=True)
class Way:
    """One of a page's two ways. world: what its World is given; bodies: what its build() asks for; without: effects."""

    name: str
    world: Mapping[str, Any] = field(default_factory=dict)
    bodies: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()


def auto(accuracy):
    """As many substeps as keep contacts from sinking by more than this [mm]: no cap is hit where 32 of them reach."""
    name = f'substeps="auto", to {accuracy} mm'
    return Way(name, {"substeps": "auto", "accuracy": accuracy / MM})


SOFT = Way("soft step", {"solver": "soft_step"})
KEPT = Way("sequential impulse", {"solver": "sequential_impulse"})
PUSHED = Way("projection", {"solver": "projection"})


@dataclass(frozen=True)
class Larger:
    """The same case at a size that no frame has time for: it is stepped beside the game.

    maker: "module:function" of a snapshot; it is given a way's `world`. steps: that are judged, the first ones.
    """

    name: str  # "1,000 boxes"
    maker: str
    steps: int
    read: Callable[[LaneFigures], float]  # its error, in the unit of the page


@dataclass(frozen=True)
class Page:
    """A hard case. The naive way is expected above the limit and ours within it; where they are alike, both within."""

    name: str
    title: str
    seen: str  # one line: what is seen
    why: str  # one line: why
    naive: Way
    ours: Way
    effects: Effects
    build: Callable[["Side"], None]  # puts the bodies into side.world
    error: Callable[["Side"], float]  # after each step
    unit: str  # of the error
    limit: float
    steps: int  # after which it is judged, and the bot goes on
    frame: tuple[float, float, float]  # x and y of the middle, and width [px] of what is shown
    act: Callable[["Side"], None] | None = None  # before each step
    judged: str = WORST
    alike: bool = False
    glance: int = 28  # frames that the bot looks into it at first
    larger: Larger | None = None


class Side:
    """A world of a page while it runs.

    kept: whatever build, act and error remember between steps; marks: (x, y [px], good or bad, step) to be seen there.
    """

    def __init__(self, page: Page, way: Way, world: World):
        self.page, self.way, self.world = page, way, world
        self.other = self
        self.steps = 0
        self.kept: dict[str, Any] = {}
        self.marks: list[tuple[float, float, bool, int]] = []
        self.now = self.worst = 0.0

    def begin(self, other: "Side"):
        """Put the bodies in; other: the side next to this one."""
        self.other = other
        self.page.build(self)

    def step(self):
        """One step, without its error: the sides are measured when both have moved."""
        if self.page.act is not None:
            self.page.act(self)
        self.world.step()
        self.steps += 1

    def mark(self, place, good):
        """Leave a mark where something ended well or did not; old ones go."""
        self.marks = [each for each in self.marks if self.steps - each[3] < MARKED]
        self.marks.append((*place, good, self.steps))

    def measure(self):
        """Read the error after a step."""
        self.now = float(self.page.error(self))
        self.worst = max(self.worst, self.now)

    @property
    def error(self):
        """What is held against the limit."""
        return self.worst if self.page.judged == WORST else self.now

    @property
    def holds(self):
        """True while the error is within the limit."""
        return self.error <= self.page.limit


def dynamic(world):
    """The rows of what can be pushed."""
    bodies = world.bodies
    return bodies[bodies["inverse_mass"] > 0.0]


def floor(world, half=100.0 * METER, **options):
    """A thick floor whose surface is at y = 0."""
    shape = Polygon.box(2.0 * half, FLOOR_DEPTH)
    return world.add_body(shape, position=(0.0, FLOOR_DEPTH / 2), kind="static", **options)
