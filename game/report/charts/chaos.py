"""Chart 11: predictability of a run in which a bullet strikes a pyramid.

The bullet's start position is shifted a little from run to run, by multiples of 1e-9 px. The chart shows the time at
which the runs diverge, and their distance at the end (Chung and Pollard 2016 call it predictability). A chaotic motion
has no reference.
"""

from collections.abc import Sequence

import numpy as np

from game.measure.timing import timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import BOX, EFFECTS, pyramid, world_of
from physics import Circle

NUDGE = 1e-9  # [px] shift of the bullet's start from run to run
WITH_CHILD, STEPS = 1.0, 180  # [px] distance that a player can see; steps of a run
WAYS = (("sequential_impulse", 4), ("soft_step", 2), ("soft_step", 4), ("soft_step", 8), ("soft_step", "auto"))
LENGTH = STEPS / 60.0  # [s] of a run: the greatest time that can be measured
SPEED = 40.0 * BOX  # [px/s]


def _world(solver, substeps, aside):
    rows = 6
    world = world_of(pyramid(rows), solver, substeps, EFFECTS.with_(continuous=True))
    world.add_body(
        Circle(BOX / 4), position=(-6.0 * BOX, -1.3 * BOX + aside), velocity=(SPEED, -0.1 * SPEED), mass=BOX * BOX
    )
    return world


def measure(seeds: int) -> list[Row]:
    """Return a row for each setting: the time at which runs from shifted starts diverge, and their distance at the end.

    Each run is compared with a run from the unshifted start. The runs have diverged when the RMS distance between the
    same bodies exceeds a pixel. seeds: number of runs from shifted starts.
    """
    rows, steps = {}, {}
    for solver, substeps in WAYS:
        ways = np.array([_way(_world(solver, substeps, NUDGE * seed)) for seed in range(seeds + 1)])
        gaps = np.sqrt(((ways[1:] - ways[0]) ** 2).sum(axis=3).mean(axis=2))  # (seeds, steps)
        parted = np.where((gaps > WITH_CHILD).any(axis=1), (gaps > WITH_CHILD).argmax(axis=1), STEPS) / 60.0
        label = f"{solver}, {substeps}"
        steps[label] = _world(solver, substeps, 0.0).step
        rows[label] = {
            "series": label,
            "label": label,
            "panel": "chaos",
            "parted": [float(each) for each in np.percentile(parted, (5, 50, 95))],
            "spread": [float(each) for each in np.percentile(gaps[:, -1], (5, 50, 95))],
            "together": [int((parted >= LENGTH).sum()), seeds],
        }
    costs = timed_steps(steps)
    return [row | {"cost": spread(costs[label])} for label, row in rows.items()]


def _way(world):
    """Step a world STEPS times, and return the motion of its bodies: a list of (bodies, 2) arrays [px].

    An array contains the centres of mass after one step.
    """
    found = []
    for _ in range(STEPS):
        world.step()
        found.append(np.stack([world.bodies["center_x"], world.bodies["center_y"]], axis=1))
    return found


def _jobs(scope: ReportScope) -> list[Job]:
    seeds = 6 if scope.quick else 30
    return [Job("chaos/pyramid", f"{__name__}:measure", {"seeds": seeds}, seeds * 0.6)]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    if len(rows) < 2:
        return []
    order = sorted(rows, key=lambda row: -row["parted"][1])
    first, second = order[:2]
    if second["parted"][1] >= LENGTH:  # half of the runs of both are never seen to part
        capped = [row["label"] for row in order if row["parted"][1] >= LENGTH]
        text = f"{' and '.join(capped)} can be foretold the longest"
        return [Claim(text, f"each {time_text(LENGTH)}, the length of the run", TIE)]
    sure = first["parted"][0] > second["parted"][2]
    low, middle, high = map(time_text, first["parted"])
    interval = f" ({low} to {high})" if low != high else ""
    figure = f"{middle}{interval}, then {second['label']} {time_text(second['parted'][1])}"
    return [Claim(f"{first['label']} can be foretold the longest", figure, HOLDS if sure else TIE)]


def time_text(seconds: float) -> str:
    """Return the time at which runs part [s] as text. A time of LENGTH or more is the end of the run, not a figure."""
    return f"more than {LENGTH:.2f} s" if seconds >= LENGTH else f"{seconds:.2f} s"


PANELS = (
    Panel(
        "when",
        Axis("us a step", time("cost")),
        Axis(f"parted by 1 px after [s]; {LENGTH:g}: not in the run", value("parted"), log=False, cap=LENGTH),
        panel_is("chaos"),
        "",
    ),
    Panel(
        "how far",
        Axis("us a step", time("cost")),
        Axis("apart after 3 s [px]", value("spread"), mark=1.0),
        panel_is("chaos"),
        "",
    ),
)
CHART = Chart(
    11,
    "chaos",
    "Predictability of a run",
    f"Runs that begin {NUDGE:g} px apart: when do they differ by a pixel, and how far do they diverge?",
    "none: chaos has no reference; bars reach from the 5th to the 95th percentile of the runs",
    PANELS,
    _jobs,
    _claims,
)
