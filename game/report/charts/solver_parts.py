"""Chart 4, the parts of a solver: substeps and iterations, warm starting, the relaxation pass.

A line joins the settings of equal work (substeps times iterations). It shows whether many substeps or many iterations
are better (Macklin et al., Small Steps in Physics Simulation, SCA 2019). The sequential impulse solver has no substeps.
Its step is divided into shorter steps instead, each with its own collision detection.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from game.measure import studied_solvers as studied
from game.measure.moment import failures_of
from game.measure.pareto_front import TIE as SHARE
from game.measure.staged import advance, stages_of
from game.measure.timing import timed_steps
from game.report.chart import Axis, Panel, time, value
from game.report.claim import FAILS, HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import PILES, world_of
from game.report.standing import VISIBLE, Watch
from physics import World
from physics.annotations import SolverName

SOFT, SEQUENTIAL = "soft_step", "sequential_impulse"
FEW, MANY = (1, 2, 4, 8), (1, 2, 4, 8, 16, 32)
WORK = 8  # substeps times iterations of the settings that the claims compare
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
    """Yield the claims of papers about substeps and warm starting, tested on each pile.

    rows: measured rows of the chart.
    """
    for pile in PILES:
        known = {Parts(*(row[name] for name in Parts._fields)): row for row in rows if row["panel"] == f"{pile}: parts"}
        if not known:
            continue
        for solver in (SOFT, SEQUENTIAL):
            cut, solved = known[Parts(solver, WORK, 1)], known[Parts(solver, 1, WORK)]
            yield beside(f"{pile}, {solver}: {WORK} x 1 errs less than 1 x {WORK}", cut, solved, "Macklin 2019")
        warm, cold = known[Parts(SEQUENTIAL, 1, WORK)], known[Parts(SEQUENTIAL, 1, WORK, warm=False)]
        yield beside(f"{pile}, {SEQUENTIAL}, 1 x {WORK}: errs less warm than cold", warm, cold, "Catto 2005")


def beside(text: str, better: Row, worse: Row, source: str) -> Claim:
    """Return a Claim that one setting is better than another. text: the claim as a sentence.

    The claim holds if the error of the row `better` is at least a tenth below that of the row `worse`. Errors are the
    same in every run, so no interval is needed. source: paper that makes the claim.
    """
    a, b = better["error"], worse["error"]
    figure = ", ".join(f"{row['error']:.3g} px in {1e6 * row['cost']['seconds'][1]:.3g} us" for row in (better, worse))
    verdict = HOLDS if a < (1.0 - SHARE) * b else FAILS if b < (1.0 - SHARE) * a else TIE
    return Claim(text, figure, TIE if max(a, b) < LEAST else verdict, source)
