"""Pages of the gallery. A page is a hard case that runs in two worlds side by side: a naive method, and the engine's.

A Way is the setup of one of the two worlds, and a Side is that world while it runs. Lengths are in pixels, 32 to the
metre. Each page has functions that build its bodies, move them and read its error, in a unit that the page names.
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
    """The setup of one of a page's two worlds. `world`: arguments of World; `bodies`: arguments of the page's build();
    `without`: effects that are off.

    `step`: function that steps the Side instead of World.step(), for a method that the engine does not have.
    """

    name: str
    world: Mapping[str, Any] = field(default_factory=dict)
    bodies: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()
    step: Callable[["Side"], None] | None = None


def auto(accuracy):
    """Return the Way whose world chooses the number of substeps that limits the sag of contacts to `accuracy` [mm].

    The limit is kept as long as 32 substeps suffice.
    """
    name = f'substeps="auto", to {accuracy} mm'
    return Way(name, {"substeps": "auto", "accuracy": accuracy / MM})


SOFT = Way("soft step", {"solver": "soft_step"})
KEPT = Way("sequential impulse, 10 passes", {"solver": "sequential_impulse", "substeps": 4})
PUSHED = Way("projection", {"solver": "projection"})
PLAIN = Way("projection", PUSHED.world, without=("stacking",))


@dataclass(frozen=True)
class Larger:
    """The case of a page at a size that is too large for real time, which runs beside the game.

    `maker`: "module:function" that returns its snapshot; the argument is a Way's `world`. `steps`: how many steps from
    the start are judged.
    """

    name: str  # "1,000 boxes"
    maker: str
    steps: int
    read: Callable[[RunFigures], float]  # its error, in the unit of the page


@dataclass(frozen=True)
class Page:
    """A hard case. The expected result: the error in the naive way's world exceeds `limit`, the error in the engine's
    world does not.

    If `alike`, both errors must stay within the limit.
    """

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
    """One of a page's two worlds while it runs. `other`: the Side of the other world.

    `kept`: data that the page's functions keep between steps; `marks`: (x, y [px], good, step) of marks to draw.
    """

    def __init__(self, page: Page, way: Way, world: World):
        self.page, self.way, self.world = page, way, world
        self.other = self
        self.steps = 0
        self.kept: dict[str, Any] = {}
        self.marks: list[tuple[float, float, bool, int]] = []
        self.now = self.worst = 0.0

    def begin(self, other: "Side"):
        """Add the bodies of the page. `other`: the Side of the other world."""
        self.other = other
        self.page.build(self)

    def step(self):
        """Make one step. The error is read later by measure(), after both worlds have moved."""
        if self.page.act is not None:
            self.page.act(self)
        if self.way.step is None:
            self.world.step()
        else:
            self.way.step(self)
        self.steps += 1

    def mark(self, place, good):
        """Mark a place (x, y) [px] as a good or bad result, and remove old marks."""
        self.marks = [each for each in self.marks if self.steps - each[3] < MARKED]
        self.marks.append((*place, good, self.steps))

    def measure(self):
        """Read the page's error after a step."""
        self.now = float(self.page.error(self))
        self.worst = max(self.worst, self.now)

    @property
    def error(self):
        """The error that is compared with the limit: the worst or the last, as the page says."""
        return self.worst if self.page.judged == WORST else self.now

    @property
    def holds(self):
        """True while the error is within the limit."""
        return self.error <= self.page.limit


def dynamic(world):
    """Return the rows of all dynamic bodies of a world."""
    bodies = world.bodies
    return bodies[bodies["inverse_mass"] > 0.0]


def floor(world, half=100.0 * METER, **options):
    """Add a thick static floor whose surface is at y = 0. Return its body. `half`: half its width [px]."""
    shape = Polygon.box(2.0 * half, FLOOR_DEPTH)
    return world.add_body(shape, position=(0.0, FLOOR_DEPTH / 2), kind="static", **options)
