"""Chart 8: cost of the broad phases against the number of bodies, and the number of candidate pairs that they report.

Layouts and shares of moving bodies are those of Broadmark (Serpa and Rodrigues 2020). Each broad phase is compared with
the naive baseline `every pair`, which tests all n (n - 1) / 2 pairs in every step.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from game.measure.power_law import fit_power_law
from game.measure.staged import advance, seconds_of_stage, stages_of
from game.measure.timing import Cost, undisturbed
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import Claim, at_least, at_most, ordering, pair, ratio_of, region
from game.report.job import Job, ReportScope, Row, spread
from physics import BROADPHASES, Bounds, BruteForce, Circle, Effects, SweepAndPrune, World

SPACING, RADIUS, SPEED = 22.0, 6.0, 60.0  # [px], [px], [px/s]
STEPS, RUNS = 60, 5  # 300 steps in all
COUNTED = 30  # steps whose tests are counted; a moving body is searched for once in several
SIZES = (10, 100, 300, 1000, 10_000)
FROM = 100  # bodies: with fewer, the call costs more than the work
NAIVE_LIMIT = 1000  # bodies: with more, `every pair` takes seconds
WAYS: dict[str, Callable[[], Any]] = {
    **BROADPHASES,
    "every pair": lambda: BruteForce(incremental=False),
    "sweep both axes": lambda: SweepAndPrune(axes="both"),
}
SPEEDS = (6.0, 60.0, 300.0, 1000.0, 3000.0)  # [px/s]
SLOW = SPEEDS[:2]  # speeds of slow movers: at most a pixel in a step
FASTER, WORDS = (0.0, 0.9), "faster//no faster"  # a ratio of times, and the words for it
SWEPT, SWEPT_COUNT, OVER_SPEED = ("sweep", "hash", "tree"), 1000, "even, 1000 bodies, over speed"
MOVERS = {"all move": 1.0, "half move": 0.5, "one in twenty moves": 0.05}
Places = tuple[np.ndarray, np.ndarray]  # centres (n, 2) and radii (n,) [px]


def even(rng: np.random.Generator, n: int) -> Places:
    """Return (positions (n, 2), radii (n,)) [px] of n discs, spread evenly with about one overlap per disc.

    Each layout is a function with these arguments and results. rng: random generator.
    """
    return rng.uniform(0, SPACING * math.sqrt(n), (n, 2)), np.full(n, RADIUS)


def line(rng: np.random.Generator, n: int) -> Places:
    """Return (positions (n, 2), radii (n,)) [px] of n discs spread along the ground, in a long and low strip."""
    return np.column_stack([rng.uniform(0, 0.5 * SPACING * n, n), rng.exponential(20.0, n)]), np.full(n, RADIUS)


def clusters(rng: np.random.Generator, n: int) -> Places:
    """Return (positions (n, 2), radii (n,)) [px] of n discs in n / 100 clusters.

    Each cluster has a standard deviation of 60 px. rng: random generator.
    """
    middles = rng.uniform(0, SPACING * math.sqrt(n), (max(1, n // 100), 2))
    return middles[rng.integers(0, len(middles), n)] + rng.normal(0, 60.0, (n, 2)), np.full(n, RADIUS)


def mixed(rng: np.random.Generator, n: int) -> Places:
    """Return (positions (n, 2), radii (n,)) [px] of n discs with radii of 1 to 100 px. Small radii are more frequent.

    The discs cover the same share of the area as those of `even`. rng: random generator.
    """
    radii = np.round(100.0 ** (rng.random(n) ** 3), 1)  # rounded, so that few different shapes are needed
    side = math.sqrt(float((math.pi * radii**2).sum()) * SPACING**2 / (math.pi * RADIUS**2))
    return rng.uniform(0, side, (n, 2)), radii


def point(rng: np.random.Generator, n: int) -> Places:
    """Return (positions (n, 2), radii (n,)) [px] of n discs at nearly the same point, so that every pair overlaps."""
    return rng.normal(0, 0.1, (n, 2)), np.full(n, RADIUS)


QUICK = (
    ("even", "all move"),
    ("even", "one in twenty moves"),
    ("line", "all move"),
    ("mixed sizes", "all move"),
    ("one point", "all move"),
)
LAYOUTS = {"even": even, "line": line, "clusters": clusters, "mixed sizes": mixed, "one point": point}


def world_of(strategy: Any, layout: str, n: int, moving: float, speed: float = SPEED) -> World:
    """Return a world of n discs in a layout of LAYOUTS. The shapes are the bounding boxes of the discs.

    strategy: the broad phase. moving: share 0..1 of the discs that move, all at the same speed [px/s] in random
    directions; the other discs are static.
    """
    seed = 5
    rng = np.random.default_rng(seed)
    places, radii = LAYOUTS[layout](rng, n)
    world = World(Effects(narrowphase=False), strategy)
    movers = max(1, round(moving * n))
    angle = rng.uniform(0, math.tau, n)
    speeds = speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for radius in np.unique(radii).tolist():
        here, shape = np.flatnonzero(radii == radius), Bounds(Circle(radius))
        still, moves = here[here >= movers], here[here < movers]
        if len(still):
            world.add_bodies(shape, places[still], kind="static")
        if len(moves):
            world.add_bodies(shape, places[moves], speeds[moves])
    return world


def measure(layout: str, n: int, moving: str) -> list[Row]:
    """Return a row for each broad phase: time per step, number of candidate pairs, number of overlapping boxes.

    layout, moving: keys of LAYOUTS and MOVERS; n: number of discs.
    """
    makes = {name: make for name, make in WAYS.items() if n <= NAIVE_LIMIT or name in BROADPHASES or "tree" in name}
    if n > NAIVE_LIMIT:
        makes.pop("brute", None)
    if layout == "one point":
        makes.pop("sweep both axes", None)
    worlds = {name: world_of(make(), layout, n, MOVERS[moving]) for name, make in makes.items()}
    spent: dict[str, list[float]] = {name: [] for name in worlds}
    counters = {}
    for name, world in worlds.items():
        world.step()
        world.step()
        counters[name] = dict(world.profile.counters)
    truth = len(worlds["hash"].contacts)  # of boxes
    tests = {name: _tests_of(world) for name, world in worlds.items()}
    for _ in range(RUNS):
        for name, world in worlds.items():
            # The mean of STEPS steps, because moving bodies are searched for once in several steps.
            spent[name].append(seconds_of_stage(world, "broad_phase", STEPS))
    return [
        {
            "series": name,
            "label": f"{name}, {n} bodies {layout}, {moving}",
            "panel": f"{layout}, {moving}",
            "layout": layout,
            "n": n,
            "moving": moving,
            "candidates": counters[name]["candidates"],
            "true_pairs": truth,
            "tests": tests[name],
            "possible": n * (n - 1) // 2,
            "false_ratio": counters[name]["candidates"] / truth if truth else None,
            "cost": spread(Cost.of(spent[name], STEPS)),
        }
        for name in worlds
    ]


def measure_speed(speed: float) -> list[Row]:
    """Return a row for each broad phase of SWEPT: time per step of SWEPT_COUNT discs that move in a square.

    speed: speed of the discs [px/s]. Discs that have left the square fly back into it.
    """
    worlds = {name: world_of(BROADPHASES[name](), "even", SWEPT_COUNT, 1.0, speed) for name in SWEPT}
    stages = {name: stages_of(world) for name, world in worlds.items()}
    side, spent, tests = SPACING * math.sqrt(SWEPT_COUNT), {name: [] for name in worlds}, Counter()
    with undisturbed():
        for _ in range(RUNS + 1):
            for name, world in worlds.items():
                seconds: dict[str, Any] = {}
                for _ in range(STEPS):
                    _turn_back(world, side)
                    advance(world, stages[name], world.dt, seconds)
                    tests[name] += world.profile.counters["pairs_tested"] + world.profile.counters["nodes_visited"]
                spent[name].append(seconds["broad_phase"] / STEPS)
    return [
        {
            "series": name,
            "label": f"{name}, {speed:g} px/s",
            "panel": OVER_SPEED,
            "layout": OVER_SPEED,
            "n": SWEPT_COUNT,
            "moving": "all move",
            "speed": speed,
            "tests": tests[name] / (STEPS * (RUNS + 1)),
            "cost": spread(Cost.of(spent[name][1:], STEPS)),  # the first run settles the margins
        }
        for name in worlds
    ]


def _turn_back(world, side):
    """Reverse the speeds of the bodies that leave the square of the given side [px]."""
    bodies = world.bodies
    for place, speed in (("x", "vx"), ("y", "vy")):
        outwards = ((bodies[place] < 0.0) & (bodies[speed] < 0.0)) | ((bodies[place] > side) & (bodies[speed] > 0.0))
        bodies[speed][outwards] *= -1.0


def _tests_of(world: World) -> float:
    """Make COUNTED steps of a world. Return its mean number of tests a step, of two boxes or a box and a node."""
    found = 0
    for _ in range(COUNTED):
        world.step()
        found += world.profile.counters["pairs_tested"] + world.profile.counters["nodes_visited"]
    return found / COUNTED


def _jobs(scope: ReportScope) -> list[Job]:
    sizes = SIZES[:4] if scope.quick else SIZES
    found = []
    for layout in LAYOUTS:
        for moving in MOVERS:
            if scope.quick and (
                layout == "clusters" or moving == "half move" or (layout == "line" and moving != "all move")
            ):
                continue
            for n in sizes:
                if layout == "one point" and (n > (100 if scope.quick else NAIVE_LIMIT) or moving != "all move"):
                    continue
                params = {"layout": layout, "n": n, "moving": moving}
                name = f"broadphases/{layout}-{moving}-{n}".replace(" ", "-")
                found.append(Job(name, f"{__name__}:measure", params, 0.1 + n / 700))
    speeds = SPEEDS[::4] if scope.quick else SPEEDS
    return found + [Job(f"broadphases/speed-{v:g}", f"{__name__}:measure_speed", {"speed": v}, 1.5) for v in speeds]


def growth(rows: Sequence[Row], series: str, panel: str) -> tuple[float, float] | None:
    """Return (p, standard error of p) of a fit in which the cost of a broad phase grows as n^p.

    The fit uses the rows of one series in one panel, for worlds of at least FROM bodies. Return None if there are fewer
    than three of them, because the standard error needs three.
    """
    mine = [row for row in rows if row["series"] == series and row["panel"] == panel and row["n"] >= FROM]
    points = [(row["n"], row["cost"]["seconds"][1]) for row in mine]
    return fit_power_law(points)[:2] if len(points) >= 3 else None


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for panel in dict.fromkeys(row["panel"] for row in rows if row["panel"] != OVER_SPEED):
        mine = [row for row in rows if row["panel"] == panel]
        n = max(row["n"] for row in mine)
        costs = {row["series"]: pair(row["cost"]) for row in mine if row["n"] == n}
        if len(costs) > 1:
            found.append(ordering(f"{n} bodies, {panel}", costs))
    return [*found, *_of_papers(rows), *_regions(rows), *_powers(rows)]


def _regions(rows) -> Iterator[Claim]:
    """Yield a Claim for each statement about the bodies that suit a broad phase, over the speeds or the numbers."""
    speeds = {(row["speed"], row["series"]): row["cost"] for row in rows if row["panel"] == OVER_SPEED}
    ratios = {
        f"{speed:g} px/s": ratio_of(speeds[speed, "sweep"], speeds[speed, "hash"])
        for speed in SPEEDS
        if (speed, "hash") in speeds
    }
    slow = {name: ratio for name, ratio in ratios.items() if name in [f"{speed:g} px/s" for speed in SLOW]}
    if slow:
        yield region("the sweep suits slow movers: faster there than the grid", slow, FASTER, WORDS, "Baraff 1992")
        yield region("the sweep is faster than the grid at every speed", ratios, FASTER, WORDS)
    every, *_, few = MOVERS
    cases = (
        (
            "the tree suits few movers: faster than the grid where one in twenty moves",
            "tree",
            ("hash",),
            few,
            "Catto 2019",
        ),
        ("the grid suits one size: the fastest where all move", "hash", ("sweep", "tree"), every, "Teschner 2003"),
    )
    for text, name, others, moving, source in cases:
        ratios = {}
        for n in SIZES:
            costs = {
                row["series"]: row["cost"]
                for row in rows
                if (row["layout"], row["moving"], row["n"]) == ("even", moving, n)
            }
            if name in costs and n >= FROM:
                best = min((costs[other] for other in others), key=pair)
                ratios[f"{n:,} bodies"] = ratio_of(costs[name], best)
        if ratios:
            yield region(text, ratios, FASTER, WORDS, source)


def _of_papers(rows) -> Iterator[Claim]:
    """Yield a Claim for each statement of papers about broad phases, tested on worlds of NAIVE_LIMIT bodies.

    NAIVE_LIMIT is the largest number of bodies at which the test of every pair is measured. rows: measured rows of the
    chart.
    """
    known = {(row["series"], row["layout"], row["moving"], row["n"]): row for row in rows}

    def beside(first, second):
        """Return the ratio of the costs of two rows; None if one of them is not measured.

        first, second: keys of the rows in `known`.
        """
        return ratio_of(known[first]["cost"], known[second]["cost"]) if first in known and second in known else None

    n, all_move, few = NAIVE_LIMIT, *list(MOVERS)[:: len(MOVERS) - 1]
    for name in BROADPHASES:
        row = known.get((name, "even", all_move, n))
        if row and name != "brute":  # brute force leaves out no pair of a body that has left its margin
            if "tests" in row:
                share = 100.0 * row["tests"] / row["possible"]
                text = f"{name} tests at most 5 % of {n} bodies' pairs in a step"
                yield at_most(text, (share,) * 3, 5.0, "Cohen 1995", "%")
            naive = beside((name, "even", all_move, n), ("every pair", "even", all_move, n))
            if naive:
                yield at_most(f"{name} is faster than every pair, every step, at {n} bodies", naive, 0.9)
    moves = beside(("tree", "even", all_move, n), ("hash", "even", all_move, n))
    stands = beside(("tree", "even", few, n), ("hash", "even", few, n))
    if moves and stands:
        gain = moves[0] / stands[2], moves[1] / stands[1], moves[2] / stands[0]
        yield at_least("the tree gains on the grid where few move", gain, 1.1, "Catto 2019, Dynamic BVH")
    along = beside(("sweep", "line", all_move, n), ("hash", "line", all_move, n))
    if along:
        yield at_most("the sweep suits what lies along its axis: faster there than the grid", along, 0.9, "Baraff 1992")
    for name, text in (("hash", "mixed sizes hurt the grid"), ("tree", "mixed sizes hurt the tree")):
        mixed_sizes = beside((name, "mixed sizes", all_move, n), (name, "even", all_move, n))
        if mixed_sizes:
            yield at_least(text + ", as dense and as many", mixed_sizes, 1.1, "Teschner 2003")
    both = beside(("sweep both axes", "even", all_move, n), ("sweep", "even", all_move, n))
    if both:
        yield at_most("sweeping both axes is faster than one", both, 0.9, "Cohen 1995")


def _powers(rows) -> Iterator[Claim]:
    panel = f"even, {next(iter(MOVERS))}"
    for name in WAYS:
        found = growth(rows, name, panel)
        if found:
            power, unsure = found
            limits = (power - 2.0 * unsure, power, power + 2.0 * unsure)
            if name == "every pair":
                yield at_least(
                    "every pair, every step: the cost grows with the square of n", limits, 1.8, unit="power of n"
                )
            else:
                yield at_most(f"{name}: the cost grows slower than the square of n", limits, 1.8, unit="power of n")


def _panel(layout, moving):
    return Panel(
        f"{layout}, {moving}",
        Axis("bodies", value("n")),
        Axis("broad phase [us a step]", time("cost")),
        panel_is(f"{layout}, {moving}"),
        line="series",
    )


CHART = Chart(
    8,
    "broadphases",
    "Broad phases over the number of bodies",
    "How much time does a broad phase take, and how many false pairs does it leave?",
    "all pairs of boxes; no strategy may lose one, so they are compared by their number of false pairs",
    (
        *(_panel(layout, moving) for layout in LAYOUTS for moving in MOVERS),
        Panel(
            OVER_SPEED,
            Axis("speed [px/s]", value("speed")),
            Axis("broad phase [us a step]", time("cost")),
            panel_is(OVER_SPEED),
            line="series",
        ),
        Panel(
            "pairs kept for each that truly meets",
            Axis("broad phase [us a step]", time("cost")),
            Axis("candidates / true pairs", value("false_ratio")),
            lambda row: row["n"] == 1000 and row["layout"] != "one point",
        ),
    ),
    _jobs,
    _claims,
)
