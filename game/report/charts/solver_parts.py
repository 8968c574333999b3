"""Chart 4, the parts of a solver: substeps and iterations, warm starting, the relaxation pass.

A line joins the settings of equal work (substeps times iterations). It shows whether many substeps or many iterations
are better (Macklin et al., Small Steps in Physics Simulation, SCA 2019). The sequential impulse solver has no substeps.
Its step is divided into shorter steps instead, each with its own collision detection.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import exp, log
from typing import NamedTuple

import numpy as np

from game.measure import studied_solvers as studied
from game.measure.moment import failures_of
from game.measure.pareto_front import TIE as SHARE
from game.measure.pareto_front import pareto_front
from game.measure.staged import advance, stages_of
from game.measure.timing import UNSURE, timed_steps
from game.report.chart import Axis, Panel, time, value
from game.report.claim import FAILS, HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import PILES, world_of
from game.report.standing import FALLEN, VISIBLE, Watch
from physics import World
from physics.annotations import SolverName

SOFT, SEQUENTIAL = "soft_step", "sequential_impulse"
FEW, MANY = (1, 2, 4, 8), (1, 2, 4, 8, 16, 32)
LEAST = 0.01  # [px] smaller errors are rounding errors, whose ratio has no meaning


class Parts(NamedTuple):
    """One combination of the parts of a solver.

    warm: whether it has warm starting; relaxed: whether it has a relaxation pass.
    """

    solver: SolverName
    substeps: int
    iterations: int
    warm: bool = True
    relaxed: bool = True

    @property
    def series(self) -> str:
        """Name of the combination, without the numbers of substeps and iterations."""
        words = [self.solver, *(() if self.warm else ("cold",)), *(() if self.relaxed else ("not relaxed",))]
        return ", ".join(words)


WAYS = (
    *(Parts(SOFT, n, m) for n in MANY for m in FEW),
    *(Parts(SEQUENTIAL, n, m) for n in FEW for m in MANY),
    *(Parts(SOFT, n, 1, warm=False) for n in MANY),
    *(Parts(SEQUENTIAL, 1, m, warm=False) for m in MANY),
    *(Parts(SOFT, n, 1, relaxed=False) for n in MANY),
)


class Studied:
    """A world whose solver is replaced by a variant: one combination of solver parts (see Parts)."""

    def __init__(self, parts: Parts, world: World) -> None:
        self.world, self.divided, stage = world, 1, studied.soft_step(parts.iterations, parts.warm, parts.relaxed)
        if parts.solver == SEQUENTIAL:
            self.divided, stage = parts.substeps, studied.sequential_impulse(parts.iterations, parts.warm)
        self.stages = stages_of(world, stage)
        self.failures: Counter[str] | None = None  # counted only if the caller asks for it

    def step(self) -> None:
        """Make one step of the world with this combination of solver parts."""
        for _ in range(self.divided):
            advance(self.world, self.stages, self.world.dt / self.divided)
            if self.failures is not None:
                self.failures += failures_of(self.world)


def measure(pile: str) -> list[Row]:
    """Return a row for each combination of parts in WAYS, for the pile `pile`."""
    made = PILES[pile]()
    steps, rows = {}, {}
    for parts in WAYS:
        world = world_of(made, parts.solver, parts.substeps)
        way, watch = Studied(parts, world), Watch(world, made)
        way.failures = Counter()
        for _ in range(watch.settle):
            way.step()
            watch.look()
        rows[parts] = {
            "series": parts.series,
            "label": f"{parts.series}, {parts.substeps} x {parts.iterations}",
            "panel": f"{pile}: parts",
            **parts._asdict(),
            "work": parts.substeps * parts.iterations,
            **watch.found(),
            "failures": dict(way.failures),
        }
        way.failures = None
        steps[parts] = way.step
    return [row | {"cost": spread(cost)} for row, cost in zip(rows.values(), timed_steps(steps).values(), strict=True)]


def jobs(scope: ReportScope) -> list[Job]:
    """Return one job per pile; no jobs for a quick report."""
    return [
        Job(
            f"solvers/parts-{pile}".replace(" ", "-").replace(":", "-to-"),
            f"{__name__}:measure",
            {"pile": pile},
            60.0 if "pyramid" in pile else 9.0,
        )
        for pile in (() if scope.quick else PILES)
    ]


def panels(pile: str) -> list[Panel]:
    """Return the panels of a pile: one with all combinations of parts, and one for each solver.

    In the panel of a solver, a line joins the settings of equal work (substeps times iterations).
    """
    error = Axis("off or overlapping by at most [px]", value("error"), mark=VISIBLE)
    mine = f"{pile}: parts"
    return [
        Panel(mine, Axis("us a step", time("cost")), error, lambda row: row["panel"] == mine),
        *(
            Panel(
                f"{pile}: {solver}, equal work on one line",
                Axis("substeps", value("substeps")),
                error,
                lambda row, solver=solver: row["panel"] == mine and row["series"] == solver,
                "series",
                lambda row: f"{row['work']} = substeps x iterations",
            )
            for solver in (SOFT, SEQUENTIAL)
        ),
    ]


def claims(rows: Sequence[Row]) -> Iterator[Claim]:
    """Yield the claims of papers about substeps and warm starting, tested on each pile at equal measured time.

    rows: measured rows of the chart. Small steps are the settings with more substeps than iterations, and many
    iterations are those with more iterations than substeps. 1 x 1 belongs to both.
    """
    for pile in PILES:
        mine = [row for row in rows if row["panel"] == f"{pile}: parts"]
        for solver in (SOFT, SEQUENTIAL) if mine else ():
            usual = [row for row in mine if row["series"] == solver]
            small = [row for row in usual if row["substeps"] > row["iterations"] or row["work"] == 1]
            many = [row for row in usual if row["substeps"] < row["iterations"] or row["work"] == 1]
            text = f"{pile}, {solver}: in equal time small steps err less than many iterations"
            yield at_equal_time(text, small, many, "Macklin 2019")
        once = [row for row in mine if row["solver"] == SEQUENTIAL and row["substeps"] == 1]
        if once:
            warm, cold = ([row for row in once if row["warm"] is is_warm] for is_warm in (True, False))
            text = f"{pile}, {SEQUENTIAL}: in equal time it errs less warm than cold"
            yield at_equal_time(text, warm, cold, "Catto 2005")


class Family:
    """The least error that a family of settings reaches within a time, from its Pareto front.

    rows: measured rows of the family. Between two points of the front, the logarithm of the error is interpolated over
    the logarithm of the time. start: least time of the family [s].
    """

    def __init__(self, rows: Sequence[Row]) -> None:
        points = {k: (row["cost"]["seconds"][1], row["error"]) for k, row in enumerate(rows)}
        best = [points[k] for k in pareto_front(points)]
        self.times = [seconds for seconds, _ in best]
        # Smaller errors are rounding errors, and greater ones are those of a pile that lies on the ground.
        self.errors = [min(max(error, LEAST), FALLEN) for _, error in best]
        self.start = self.times[0]

    def at(self, seconds: float) -> float:
        """Return the error [px] that is reached within a time [s]; that of a fallen pile before the first point."""
        if seconds < self.start:
            return FALLEN
        return float(exp(np.interp(log(seconds), np.log(self.times), np.log(self.errors))))


def at_equal_time(text: str, better: Sequence[Row], worse: Sequence[Row], source: str) -> Claim:
    """Return a Claim that one family of settings errs less than another in equal measured time.

    The fronts of both are compared at each of their points' times, from the time at which both have a setting. A family
    errs less at a time if its error is a tenth below the other's, which is granted a tenth more time. The claim holds
    if the first family errs less at some of these times and nowhere more; the figure names both regions.
    text: the claim as a sentence; source: paper that makes the claim.
    """
    a, b = Family(better), Family(worse)
    times = sorted(t for t in {*a.times, *b.times} if t >= max(a.start, b.start))
    less = [t for t in times if a.at(t) < (1.0 - SHARE) * b.at((1.0 + SHARE) * t)]
    more = [t for t in times if b.at(t) < (1.0 - SHARE) * a.at((1.0 + SHARE) * t)]
    regions = [f"{word} {_region(found, a, b)}" for word, found in (("less", less), ("more", more)) if found]
    verdict = TIE if bool(less) == bool(more) else HOLDS if less else FAILS
    return Claim(text, "; ".join(regions) or f"{UNSURE} from {1e6 * times[0]:.3g} us on", verdict, source)


def _region(times, first, second):
    """Return a range of times as text, with the errors of both fronts at its start."""
    span = f"at {1e6 * times[0]:.3g}" if len(times) == 1 else f"at {1e6 * times[0]:.3g} to {1e6 * times[-1]:.3g}"
    errors = (family.at(times[0]) for family in (first, second))
    mine, its = ("fallen" if error > (1.0 - SHARE) * FALLEN else f"{error:.3g} px" for error in errors)
    return f"{span} us ({mine} against {its})"
