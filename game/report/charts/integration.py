"""Chart 5: cost of a second of motion, and its error against the exact solution, for several lengths of the step.

A slope is level ground under tilted gravity. If the step is halved, a first-order error halves, and a second-order
error falls to a quarter.
"""

from collections.abc import Callable, Sequence
from math import cos, radians, sin
from typing import NamedTuple

import numpy as np

from game.measure.power_law import fit_power_law
from game.measure.timing import Cost, clock, undisturbed
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row, spread
from physics import Circle, Effects, Material, Polygon, Vec2, World
from physics.annotations import SolverName

G, SECONDS, RUNS = 320.0, 1.0, 5
RATES = (30, 60, 120, 240, 480)  # steps a second
SLOPE, FRICTION, SIZE = radians(30.0), 0.3, 16.0
COPIES = 32  # bodies side by side: with a single one, the call would be most of the cost
SOLVERS = ("projection", "sequential_impulse", "soft_step")


class Case(NamedTuple):
    """A motion with a known result.

    error(position, velocity): function that returns the error [px] of a body after SECONDS. Its arguments are relative
    to the start. slope: angle of the ground [rad].
    """

    effects: Effects
    solvers: tuple[SolverName, ...]
    slope: float
    shape: Polygon | Circle
    material: Material
    above: float  # [px] height of the start over the ground
    error: Callable[[Vec2, Vec2], float]


def _fall(position, velocity):
    return abs(position.y - 0.5 * G * SECONDS**2)


def _slide(position, velocity):
    return abs(position.x - 0.5 * G * (sin(SLOPE) - FRICTION * cos(SLOPE)) * SECONDS**2)


def _roll(position, velocity):
    return abs(position.x - 0.5 * (2.0 / 3.0) * G * sin(SLOPE) * SECONDS**2)


DROP = 40.0  # [px]


def _bounce(position, velocity):
    """Return the error [px] of a ball that bounces with restitution 1. It should keep its energy.

    The error is the change of energy, expressed as a height. position, velocity: state of the ball after SECONDS,
    relative to the start.
    """
    return abs(position.y - 0.5 * velocity.y**2 / G)


STACKS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)
CASES = {
    "free fall": Case(STACKS, SOLVERS, 0.0, Circle(SIZE / 2), Material(), 1e6, _fall),
    "slide down 30 degrees": Case(
        STACKS, SOLVERS[1:], SLOPE, Polygon.box(SIZE, SIZE), Material(friction=FRICTION), 0.0, _slide
    ),
    "roll down 30 degrees": Case(STACKS, SOLVERS[1:], SLOPE, Circle(SIZE / 2), Material(friction=1.0), 0.0, _roll),
    "bounce of 1": Case(STACKS, SOLVERS, 0.0, Circle(SIZE / 2), Material(restitution=1.0), DROP, _bounce),
}


def world_of(case: Case, solver: SolverName, rate: int) -> World:
    """Return a world of COPIES equal bodies at the case's height above the ground, too far apart to meet.

    solver: solver of the world; rate: steps per second.
    """
    gravity = (G * sin(case.slope), G * cos(case.slope))
    world = World(case.effects, solver=solver, gravity=gravity, dt=1.0 / rate, substeps=4)
    far = 40.0 * SIZE
    ground = Polygon.box(far * (COPIES + 2), 64.0, center=(0.5 * far * COPIES, case.above + SIZE / 2 + 32.0))
    world.add_body(ground, kind="static", material=case.material)
    world.add_bodies(case.shape, np.column_stack([far * np.arange(COPIES), np.zeros(COPIES)]), material=case.material)
    return world


def measure(case: str) -> list[Row]:
    """Return a row for each solver and each length of the step. case: key of CASES."""
    made, rows, spent = CASES[case], {}, {}
    ways: list[tuple[SolverName, int]] = [(solver, rate) for solver in made.solvers for rate in RATES]
    for solver, rate in ways:
        world = world_of(made, solver, rate)
        steps = round(SECONDS * rate)
        for _ in range(steps):
            world.step()
        first = next(each for each in world if each.kind == "dynamic")
        rows[solver, rate] = {
            "series": solver,
            "label": f"{solver}, {rate} steps a second",
            "panel": case,
            "dt": 1.0 / rate,
            "error": float(made.error(first.position, first.velocity)),
        }
    with undisturbed():
        for _ in range(RUNS):
            for solver, rate in ways:
                world, steps = world_of(made, solver, rate), round(SECONDS * rate)
                started = clock()
                for _ in range(steps):
                    world.step()
                spent.setdefault((solver, rate), []).append((clock() - started) / SECONDS)
    return [row | {"cost": spread(Cost.of(spent[way], way[1]))} for way, row in rows.items()]


def order_of(rows: Sequence[Row]) -> tuple[float, float] | None:
    """Return (p, standard error of p) of a fit in which the error is proportional to dt^p.

    The fit is by least squares on the logarithms. Return None if fewer than three rows have errors above the rounding
    error.
    """
    points = [(row["dt"], row["error"]) for row in rows if row["error"] > 1e-9 * G]
    return fit_power_law(points)[:2] if len(points) >= 3 else None


def _jobs(scope: ReportScope) -> list[Job]:
    return [Job(f"integration/{case}".replace(" ", "-"), f"{__name__}:measure", {"case": case}, 4.0) for case in CASES]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for case in dict.fromkeys(row["panel"] for row in rows):
        for solver in SOLVERS:
            mine = [row for row in rows if row["panel"] == case and row["series"] == solver]
            if not mine:
                continue
            order, worst = order_of(mine), max(row["error"] for row in mine)
            text = f"{case}, {solver}: "
            if order is None:
                found.append(Claim(text + "exact at every length of a step", f"at most {worst:.2g} px", HOLDS))
            else:
                sure = abs(order[0]) > 2.0 * order[1] + 0.25
                found.append(
                    Claim(
                        text + "a shorter step is closer",
                        f"error grows with dt^{order[0]:.2f} +- {order[1]:.2f}",
                        HOLDS if sure and order[0] > 0 else TIE,
                    )
                )
    return found


CHART = Chart(
    5,
    "integration",
    "Lengths of a step",
    "How much time does a second of motion take, and how large is its error at the end?",
    "closed forms of fall, sliding, rolling and bouncing",
    tuple(
        Panel(f"{case}: {word}", x, Axis("off after 1 s by [px]", value("error"), mark=1.0), panel_is(case), line)
        for case in CASES
        for word, x, line in (
            ("over time", Axis(f"us a second of {COPIES} bodies", time("cost")), "front"),
            ("over dt", Axis("step [s]", value("dt")), "series"),
        )
    ),
    _jobs,
    _claims,
)
