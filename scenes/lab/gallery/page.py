"""Pages of the gallery. A page is a hard case that runs in two worlds: one uses a naive method, one the engine's.

A Way is the setup of one of the two worlds, and a Side is that world while it runs. Lengths are in pixels, 32 to the
metre. Each page has functions that build its bodies, move them, and read its error in a unit that the page names.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from game.measure.measured_runs import RunFigures
from game.measure.rates import Rate
from physics import Effects, Polygon, World
from physics.annotations import JointSolverName

METER = 32.0  # [px]
MM = 1000.0 / METER  # [mm/px]
FLOOR_DEPTH = 32.0 * METER
MARKED = 60  # steps for which a mark is visible
WORST, LAST = "worst", "last"  # error of a run that is compared with the limit


@dataclass(frozen=True)
class Way:
    """The setup of one of a page's two worlds.

    name: text on the screen; world: keyword arguments of World; bodies: keyword arguments for the page's own
    functions; without: names of effects that are off; step: function that steps the Side in place of World.step(), for
    methods that the engine lacks; joint_solver: the world's solver of joints.
    """

    name: str
    world: Mapping[str, Any] = field(default_factory=dict)
    bodies: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()
    step: Callable[["Side"], None] | None = None
    joint_solver: JointSolverName = "auto"


def auto(accuracy):
    """Return a Way in which the world chooses its number of substeps (substeps="auto").

    accuracy: greatest sag of a contact [mm] that the world accepts, as long as 32 substeps suffice.
    """
    name = f'substeps="auto", to {accuracy} mm'
    return Way(name, {"substeps": "auto", "accuracy": accuracy / MM})


SOFT = Way("soft step", {"solver": "soft_step"})
KEPT = Way("sequential impulse, 10 passes", {"solver": "sequential_impulse", "substeps": 4})
PUSHED = Way("projection", {"solver": "projection"})
PLAIN = Way("projection", PUSHED.world, without=("stacking",))


@dataclass(frozen=True)
class Larger:
    """A larger case of a page, too large for real time, which the measuring process runs during the game.

    maker: "module:function", a function that takes the keyword arguments of a World as a dict and returns a Snapshot;
    steps: number of steps, from the snapshot on, over which the error is measured.
    """

    name: str  # "1,000 boxes"
    maker: str
    steps: int
    read: Callable[[RunFigures], float]  # its error, in the unit of the page


@dataclass(frozen=True)
class Page:
    """A page of the gallery: a hard case for a physics engine, run in a naive world and in the engine's world.

    Expected: the error in the naive world exceeds `limit`, and the error in the engine's world does not. If `alike` is
    True, neither error may exceed the limit.
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
    glance: int = 20  # frames of the bot's first look
    larger: Larger | None = None
    also: Callable[["Side"], str] | None = None  # a second figure, as text
    rate: Callable[["Side"], Rate] | None = None  # the error as a number of cases, where it is a percentage of them


class Side:
    """One of a page's two worlds while it runs, with its error so far.

    other: Side of the page's other world; kept: data that the page's functions keep between steps; marks: list of (x
    [px], y [px], good, step) that are drawn for MARKED steps.
    """

    def __init__(self, page: Page, way: Way, world: World):
        self.page, self.way, self.world = page, way, world
        self.other = self
        self.steps = 0
        self.kept: dict[str, Any] = {}
        self.marks: list[tuple[float, float, bool, int]] = []
        self.now = self.worst = 0.0

    def begin(self, other: "Side"):
        """Add the page's bodies to the world. other: Side of the page's other world."""
        self.other = other
        self.world.joint_solver = self.way.joint_solver
        self.page.build(self)

    def step(self):
        """Make one step of this side's world. measure() reads the error after both worlds have been stepped."""
        if self.page.act is not None:
            self.page.act(self)
        if self.way.step is None:
            self.world.step()
        else:
            self.way.step(self)
        self.steps += 1

    def mark(self, place, good):
        """Mark the position `place` (x, y) [px] as a good or bad result, and remove old marks."""
        self.marks = [each for each in self.marks if self.steps - each[3] < MARKED]
        self.marks.append((*place, good, self.steps))

    def measure(self):
        """Read the page's error after a step, and update the worst error."""
        self.now = float(self.page.error(self))
        self.worst = max(self.worst, self.now)

    @property
    def error(self):
        """Error that is compared with the page's limit: the greatest or the last error, according to Page.judged."""
        return self.worst if self.page.judged == WORST else self.now

    @property
    def holds(self):
        """True while the error is within the limit."""
        return self.error <= self.page.limit


def dynamic(world):
    """Return the rows of world.bodies that are dynamic bodies."""
    bodies = world.bodies
    return bodies[bodies["inverse_mass"] > 0.0]


def floor(world, half=100.0 * METER, **options):
    """Add a thick static floor with its surface at y = 0 to a world, and return its body.

    half: half of the floor's width [px]; options: further arguments of World.add_body.
    """
    shape = Polygon.box(2.0 * half, FLOOR_DEPTH)
    return world.add_body(shape, position=(0.0, FLOOR_DEPTH / 2), kind="static", **options)
