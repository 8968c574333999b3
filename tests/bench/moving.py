"""Scenes of moving bodies compared with pymunk: rain, collapses, a tumbler, small worlds, crowds, bullets and carving.

Bodies are boxes and discs of 16 to 24 px with friction 0.6, gravity is 10 m/s2, at 60 steps/s. pymunk runs at its
defaults: 10 iterations, one step per frame, slop 0.1 px. Hitbox runs with substeps by load ("auto", the default) and
with 4. All runs of a scene advance in turns of 20 steps, so that other load on the machine affects them alike. A ratio
is median over median in this run. Bodies sleep only after they have come to rest.
"""

from collections.abc import Callable
from functools import lru_cache
from statistics import median
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from game.report.piles import FRICTION, GRAVITY
from physics import Circle, Effects, Material, PixelMask, Polygon, World
from tests.bench.timing import table

DT, TURN = 1 / 60, 20  # [s]; steps in a turn
EFFECTS = Effects.rigid_bodies()
SURFACE = Material(friction=FRICTION)
SUBSTEPS = ("auto", 4)


class Item(NamedTuple):
    """A body of a scene. size: (width, height) of a box, (radius,) of a disc [px]."""

    size: tuple[float, ...]
    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    density: float = 1.0
    kind: str = "dynamic"


@lru_cache
def shape_of(size):
    """Return the shape for a size; bodies of one size share their shape, as sprites do."""
    return Circle(size[0]) if len(size) == 1 else Polygon.box(*size)


def stages_now(world, spent):
    """Return {stage: seconds} of the last step. A further entry has the time between the stages.

    spent: seconds of the whole step.
    """
    stages = dict(world.profile.stages)
    return stages | {"between stages": spent - sum(stages.values())}


class Timed:
    """A world whose steps are timed. edit(self, n), if given, is called before step n; its time
    is counted as `edits`.
    """

    def __init__(self, world, edit=None):
        self.world, self.edit, self.n = world, edit, 0
        self.stages: list[dict[str, float]] = []

    def step(self):
        """Apply the edit of this step, if there is one, and make the step. Return the seconds of both."""
        start = perf_counter()
        if self.edit:
            self.edit(self, self.n)
        edited = perf_counter()
        self.world.step()
        end = perf_counter()
        self.n += 1
        self.stages.append(stages_now(self.world, end - edited) | {"edits": edited - start})
        return end - start


class Ours(Timed):
    """A scene in a Hitbox world."""

    def __init__(self, items, substeps, effects=EFFECTS, gravity=(0.0, GRAVITY), edit=None, shapes=None):
        gravity = gravity if effects.gravity else None
        super().__init__(World(effects, gravity=gravity, substeps=substeps), edit)
        self.ids = []
        for item in items:
            self.add(item, None if shapes is None else shapes[len(self.ids) % len(shapes)])

    def add(self, item, shape=None):
        shape = shape_of(item.size) if shape is None or item.kind != "dynamic" else shape
        material = SURFACE if item.density == 1.0 else Material(friction=FRICTION, density=item.density)
        where, velocity = (item.x, item.y), (item.vx, item.vy)
        body = self.world.add_body(shape, position=where, velocity=velocity, kind=item.kind, material=material)
        self.ids.append(body.id)
        return body

    def remove_first(self, first):
        """Remove the body at index `first` of the remaining bodies, in the order of their addition."""
        self.world.remove_body(self.ids.pop(first))


class Pymunk:
    """The same scene in pymunk. Raises ModuleNotFoundError if pymunk is not installed."""

    def __init__(self, items, gravity=(0.0, GRAVITY), edit=None):
        import pymunk

        self.pymunk, self.space, self.edit, self.n, self.ids = pymunk, pymunk.Space(), edit, 0, []
        self.space.gravity = gravity
        for item in items:
            self.add(item)

    def add(self, item):
        pymunk = self.pymunk
        if item.kind == "dynamic":
            area = item.size[0] * item.size[1] if len(item.size) == 2 else np.pi * item.size[0] ** 2
            mass = item.density * float(area)
            moment = (
                pymunk.moment_for_box(mass, item.size)
                if len(item.size) == 2
                else pymunk.moment_for_circle(mass, 0.0, item.size[0])
            )
            body = pymunk.Body(mass, moment)
        else:
            body = pymunk.Body(body_type=getattr(pymunk.Body, item.kind.upper()))
        body.position, body.velocity = (item.x, item.y), (item.vx, item.vy)
        shape = pymunk.Poly.create_box(body, item.size) if len(item.size) == 2 else pymunk.Circle(body, item.size[0])
        shape.friction = FRICTION
        self.space.add(body, shape)
        self.ids.append((body, shape))
        return body

    def remove_first(self, first):
        self.space.remove(*self.ids.pop(first))

    def step(self):
        start = perf_counter()
        if self.edit:
            self.edit(self, self.n)
        self.space.step(DT)
        self.n += 1
        return perf_counter() - start


class Several:
    """Several runs that step one after another and count as one run."""

    def __init__(self, runs):
        self.runs, self.stages = runs, []

    def step(self):
        return sum(run.step() for run in self.runs)


# ---- scenes ----------------------------------------------------------------------------------------------------------


def ground(width):
    return Item((width, 64.0), 0.0, 32.0, kind="static")


def tray(width, height):
    """Return the ground with a wall at each end."""
    walls = [Item((32.0, height), side * (width / 2 + 16.0), -height / 2, kind="static") for side in (-1, 1)]
    return [ground(width + 64.0), *walls]


def drops(count, columns, size, seed=1, gap=1.5):
    """Return `count` boxes above each other in loose rows, shifted at random."""
    rng = np.random.default_rng(seed)
    shift = rng.uniform(-0.2, 0.2, (count, 2)) * size
    return [
        Item(
            (size, size),
            float((k % columns - (columns - 1) / 2) * gap * size + shift[k, 0]),
            float(-size - (k // columns) * gap * size + shift[k, 1]),
        )
        for k in range(count)
    ]


def rain(make: Callable[..., Any], count: int = 1500) -> Any:
    """Return a run with rain: each step removes the six oldest boxes and adds six at the top."""
    rng = np.random.default_rng(2)
    walls = tray(1600.0, 1200.0)

    def edit(run, n):
        for k in range(6):
            run.remove_first(len(walls))
            run.add(Item((20.0, 20.0), float(rng.uniform(-780, 780)), -1000.0 - 24.0 * k, 0.0, 200.0))

    return make([*walls, *drops(count, 50, 20.0)], edit=edit)


def falling(count):
    """Return a function that makes a run in which `count` boxes rain onto ground and pile up."""
    return lambda make: make([*tray(30 * count**0.5, 3000.0), *drops(count, int(count**0.5), 20.0)])


def wall(make):
    """Return a run with a wall of 600 boxes that is hit by a ball."""
    bricks = [Item((20.0, 20.0), 20.0 * (k % 20) + 10.0 * (k // 20 % 2), -10.0 - 20.0 * (k // 20)) for k in range(600)]
    return make([ground(6000.0), *bricks, Item((40.0,), -500.0, -300.0, 1200.0, 0.0, 10.0)])


def towers(make):
    """Return a run with 20 towers of 10 boxes, hit by a ball."""
    boxes = [Item((20.0, 20.0), 60.0 * (k // 10), -10.0 - 20.0 * (k % 10)) for k in range(200)]
    return make([ground(6000.0), *boxes, Item((20.0,), -300.0, -150.0, 900.0, 0.0, 10.0)])


def pyramid_hit(make):
    """Return a run with a pyramid of 210 boxes, hit by a ball."""
    boxes = [
        Item((20.0, 20.0), 22.0 * (column - (19 - row) / 2), -10.0 - 20.0 * row)
        for row in range(20)
        for column in range(20 - row)
    ]
    return make([ground(6000.0), *boxes, Item((30.0,), -600.0, -120.0, 1200.0, 0.0, 10.0)])


TUMBLER = 240.0  # [px] half width of the drum


def tumbler(make):
    """Return a run with 500 boxes in a drum of four walls that turns at 25 degrees a second."""
    rate, place = 0.4363, TUMBLER + 10.0
    walls = [
        Item((2 * TUMBLER + 40.0, 20.0) if k % 2 else (20.0, 2 * TUMBLER + 40.0), x, y, kind="kinematic")
        for k, (x, y) in enumerate(((-place, 0.0), (0.0, -place), (place, 0.0), (0.0, place)))
    ]

    def edit(run, _):
        for k in range(4):
            if isinstance(run, Ours):
                body = run.world.body(run.ids[k])
            else:
                body = run.ids[k][0]
            x, y = body.position
            body.velocity, body.angular_velocity = (-rate * y, rate * x), rate

    boxes = [Item((12.0, 12.0), 16.0 * (k % 25) - 192.0, 16.0 * (k // 25) - 160.0) for k in range(500)]
    return make([*walls, *boxes], edit=edit)


def small_worlds(make):
    """Return a run with 100 worlds, each with five boxes that fall on ground."""
    return Several([make([ground(600.0), *drops(5, 2, 20.0, seed=k)]) for k in range(100)])


def crowd(count, moving):
    """Return a function that makes a run with `count` discs in loose rows, without gravity.

    moving: True gives each disc a random velocity, False gives all discs the same velocity.
    """

    def scene(make):
        rng, side = np.random.default_rng(3), int(count**0.5)
        velocities = rng.uniform(-60, 60, (count, 2)) if moving else np.full((count, 2), 60.0)
        discs = [
            Item((8.0,), 24.0 * (k % side), 24.0 * (k // side), float(vx), float(vy))
            for k, (vx, vy) in enumerate(velocities)
        ]
        return make(discs, gravity=(0.0, 0.0))

    return scene


class Scene(NamedTuple):
    """A scene that each engine can run.

    steps: number of steps to measure; build: function of one argument, `make`, that returns a run. `make` belongs to an
    engine: make(items, ...) returns a run with these items in this engine.
    """

    steps: int
    build: Callable[[Callable[..., Any]], Any]


SCENES = {
    "rain of 1,500, six added and removed a step": Scene(240, rain),
    "rain of 400 falling": Scene(240, falling(400)),
    "rain of 1,000 falling": Scene(240, falling(1000)),
    "wall of 600 hit by a ball": Scene(240, wall),
    "20 towers of 10 hit by a ball": Scene(240, towers),
    "pyramid of 210 hit by a ball": Scene(240, pyramid_hit),
    "tumbler of 500": Scene(240, tumbler),
    "100 worlds of five": Scene(120, small_worlds),
    "10,000 awake": Scene(60, crowd(10_000, moving=True)),
    "100,000 flying": Scene(20, crowd(100_000, moving=False)),
}


# ---- sprites ---------------------------------------------------------------------------------------------------------


def sprites(side=20):
    """Return (disc, box) as pixel masks."""
    y, x = np.indices((side, side)) - (side - 1) / 2
    return PixelMask(np.hypot(x, y) < side / 2), PixelMask(np.ones((side, side), bool))


def masks_and_boxes(steps):
    """Measure a rain of 300 pixel masks, and the same rain of boxes. Return the result of in_turns().

    In each step the two oldest bodies are removed and two are added.
    """

    def make(shapes):
        rng, walls = np.random.default_rng(4), tray(600.0, 1200.0)

        def edit(run, n):
            for k in range(2):
                run.remove_first(len(walls))
                item = Item((20.0, 20.0), float(rng.uniform(-280, 280)), -700.0 - 24.0 * k, 0.0, 200.0)
                run.add(item, shapes[(n + k) % 2] if shapes else None)

        return Ours([*walls, *drops(300, 18, 20.0)], "auto", edit=edit, shapes=shapes)

    return in_turns({"masks": make(sprites()), "boxes": make(None)}, steps)


def bullets(steps):
    """Measure 5,000 bullets among 200 sprites, as masks and as boxes. Return the result of in_turns().

    Hits are only detected: nothing is pushed.
    """

    def make(tier):
        world, rng = World(Effects()), np.random.default_rng(5)
        for side, count, speed in ((6, 5000, 400.0), (32, 200, 60.0)):
            shape = sprites(side)[0] if tier == "pixels" else Polygon.box(side, side)
            angles = rng.uniform(0, 2 * np.pi, count)
            velocities = speed * np.stack([np.cos(angles), np.sin(angles)], axis=1)
            world.add_bodies(shape, rng.uniform((-800, -450), (800, 450), (count, 2)), velocities)
        return Timed(world)

    return in_turns({"pixels": make("pixels"), "boxes": make("boxes")}, steps)


def carving(steps):
    """Measure 60 discs on ground of 1,200 x 200 pixels. Return the result of in_turns().

    In the run "carved" each step carves a hole; in the run "whole" the ground does not change.
    """

    def make(carves):
        world = World(EFFECTS.with_(carving=True), gravity=(0.0, GRAVITY))
        earth = world.add_body(PixelMask(np.ones((200, 1200), bool)), kind="static", material=SURFACE)
        for k in range(60):
            world.add_body(Circle(8.0), position=(18.0 * k - 540.0, -140.0 - 20.0 * (k % 3)), material=SURFACE)
        rng = np.random.default_rng(6)

        def edit(run, n):
            earth.carve(Circle(10.0), (float(rng.uniform(-560, 560)), float(rng.uniform(-95, 60)), 0.0))

        return Timed(world, edit if carves else None)

    return in_turns({"carved": make(True), "whole": make(False)}, steps)


OWN = {
    "rain of 300 masks": (180, masks_and_boxes),
    "5,000 mask bullets, 200 sprites": (60, bullets),
    "carving every frame": (120, carving),
}


# ---- measuring -------------------------------------------------------------------------------------------------------


def in_turns(runs, steps):
    """Step all runs in turns. Return {name: (times of its steps [ms], {stage: median time [ms]})}.

    runs: {name: run}.
    """
    times = {name: [] for name in runs}
    for first in range(0, steps, TURN):
        for name, run in runs.items():
            times[name] += [1e3 * run.step() for _ in range(min(TURN, steps - first))]
    return {name: (times[name], stages_of(run)) for name, run in runs.items()}


def stages_of(run):
    """Return {stage: median [ms]} of a Hitbox run, largest first; {} for other runs."""
    kept = getattr(run, "stages", [])
    if not kept:
        return {}
    middle = {name: 1e3 * median(each.get(name, 0.0) for each in kept) for name in kept[-1]}
    return dict(sorted(middle.items(), key=lambda item: -item[1]))


def measure(name, quick):
    """Measure one scene with all engines. Return the result of in_turns()."""
    if name in OWN:
        steps, build = OWN[name]
        return build(TURN if quick else steps)
    scene = SCENES[name]
    makes: dict[str, Callable[..., Any]] = {
        f"substeps {each}": lambda items, each=each, **options: Ours(items, each, **options) for each in SUBSTEPS
    }
    makes["pymunk"] = lambda items, **options: Pymunk(items, **options)
    runs = {run: scene.build(make) for run, make in makes.items()}
    for run in list(runs)[:-1]:
        warm = scene.build(makes[run])  # compiled before the clock runs
        warm.step()
    return in_turns(runs, TURN if quick else scene.steps)


def show(name, found):
    """Print the table of one scene. Return {"scene, run / reference": ratio of the median times of a step}.

    found: result of measure(); the last run in it is the reference.
    """
    *others, reference = found
    base = median(found[reference][0])
    rows = []
    for run, (times, stages) in found.items():
        first = "  ".join(f"{stage} {spent:.2f}" for stage, spent in list(stages.items())[:5])
        p50, p99 = median(times), float(np.percentile(times, 99))
        rows.append((run, f"{p50:.3f}", f"{p99:.3f}", f"{p50 / base:.2f}", first))
    table(name, ("", "p50 ms", "p99 ms", f"x {reference}", "longest stages, ms"), rows)
    return {f"{name}, {run} / {reference}": median(found[run][0]) / base for run in others}


def run(quick=False):
    """Print the tables of all scenes. Return {name: ratio of the median times of a step}.

    The names say which times: Hitbox and pymunk, masks and boxes, or ground with and without carving.
    """
    ratios = {}
    for name in [*SCENES, *OWN]:
        ratios |= show(name, measure(name, quick))
    return ratios
