"""Chart 12: step times of every scene, played by its bot, up to the slowest step, and the memory that a step allocates.

A step is a step of the whole scene, as `--headless` runs it without drawing: bot, rules and physics.
"""

import tracemalloc
from collections.abc import Sequence
from pkgutil import resolve_name

import numpy as np

from game.measure.pareto_front import TIE as SHARE
from game.measure.timing import clock, undisturbed
from game.report.chart import Axis, Chart, Panel, time, value
from game.report.claim import FAILS, HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row
from game.run.headless import start_dummy_display
from game.run.session import Session
from game.run.sources import BotSource
from game.run.warmup import warm_up_scene
from game.scene import Scene

BUDGET, HALF_BUDGET = 1000.0 / 60.0, 1000.0 / 120.0  # [ms] of a frame at 60 and 120 Hz
RUNS, TRACED = 3, 30  # runs, of which each step's least time counts; steps whose memory is measured


def scene_class(where: str) -> type[Scene]:
    """Return the scene class with the name `where`, "module:Class"."""
    return resolve_name(where)


def measure(scene: str, where: str, frames: int) -> list[Row]:
    """Return a list of one row: percentiles 50, 95 and 100 of the scene's step times, and the memory of a step.

    All runs make the same steps. The time of each step is its least time over the runs. where: "module:Class" of the
    scene; frames: length of a run.
    """
    start_dummy_display()
    made = scene_class(where)
    warm_up_scene(made, None, None)
    spent, contacts = np.full((RUNS, frames), np.inf), 0
    for run in range(RUNS):
        session = Session(made(0), BotSource())
        for frame in range(frames):
            with undisturbed():
                started = clock()
                session.step()
                spent[run, frame] = clock() - started
            if not run:
                contacts = max(contacts, sum(len(world.contacts) for world in session.scene.worlds))
    least = spent.min(axis=0)
    p50, p95, most = (float(each) for each in np.percentile(least, (50, 95, 100)))
    peaks = _peaks(made, min(frames, TRACED))
    return [
        {
            "series": scene.split("/")[0],
            "label": scene,
            "panel": "latency",
            "contacts": contacts,
            "kilobytes": [float(each) / 1024.0 for each in np.percentile(peaks, (5, 50, 95))],
            "frames": frames,
            "cost": {"seconds": [p50, p95, most], "runs": RUNS, "pieces": frames},
        }
    ]


def _peaks(made, frames):
    """Return (frames,) greatest memory in use during each step, minus the memory at the start of the step [bytes].

    made: class of the scene.
    """
    session, found = Session(made(0), BotSource()), []
    for _ in range(5):
        session.step()
    tracemalloc.start()
    try:
        for _ in range(frames):
            tracemalloc.reset_peak()
            before = tracemalloc.get_traced_memory()[0]
            session.step()
            found.append(tracemalloc.get_traced_memory()[1] - before)
    finally:
        tracemalloc.stop()
    return np.array(found)


def _jobs(scope: ReportScope) -> list[Job]:
    frames = 120 if scope.quick else 600
    chosen = ("shooter", "platformer", "lab/pyramid", "lab/masks") if scope.quick else tuple(scope.scenes)
    return [
        Job(
            f"latency/{name}".replace("lab/", "lab-"),
            f"{__name__}:measure",
            {"scene": name, "where": scope.scenes[name], "frames": frames},
            3.0 if scope.quick else 12.0,
        )
        for name in chosen
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for row in rows:
        most = 1e3 * row["cost"]["seconds"][2]
        near = abs(most - HALF_BUDGET) < SHARE * HALF_BUDGET  # one step decides: another run has another slowest step
        verdict = TIE if near else HOLDS if most < HALF_BUDGET else FAILS
        found.append(Claim(f"{row['label']}: every step within 8.3 ms", f"{most:.2f} ms at most", verdict))
    return found


CHART = Chart(
    12,
    "latency",
    "The slowest step of every scene",
    "How long are the steps, typical and slowest, and how much memory do they allocate?",
    "the least of three runs of the same step; bars reach from the median to the slowest, dots are the 95th percentile",
    (
        Panel(
            "time",
            Axis("contacts at most", value("contacts")),
            Axis("ms a step", time("cost", "ms"), mark=BUDGET),
            line="",
        ),
        Panel(
            "memory",
            Axis("contacts at most", value("contacts")),
            Axis("kB a step holds at most", value("kilobytes")),
            line="",
        ),
    ),
    _jobs,
    _claims,
)
