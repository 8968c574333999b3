"""Chart 13: cost and error of every setting of each scene, measured from one state of the bot's run.

The game's panel of accuracy and cost shows the same measurement live.
"""

from collections.abc import Sequence

from game.measure.advice import measure_settings
from game.measure.moment import Moment
from game.measure.setting import settings_around
from game.measure.survey import Survey, reported_error
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.charts.latency import scene_class
from game.report.claim import Claim, ordering, pair
from game.report.job import Job, ReportScope, Row, counted, spread
from game.run.headless import start_dummy_display
from game.run.session import Session
from game.run.sources import BotSource
from game.run.warmup import warm_up_scene
from physics.step import ignored_effects

FRAME = 300  # frame whose state is measured: five seconds into the bot's run
VISIBLE = 1.0  # [px], or wrong answers per 100 encounters
UNITS = {"verdict": "wrong hits and misses per 100 encounters"}
FEW = ("shooter", "lab/pyramid")


def measure(scene: str, where: str) -> list[Row]:
    """Return a row for each setting and each kind of error of a scene. where: "module:Class" of the scene."""
    start_dummy_display()
    made = scene_class(where)
    warm_up_scene(made, None, None)
    session = Session(made(0), BotSource())
    for _ in range(FRAME):
        session.step()
    world = session.scene.views()[0][0]
    moment, survey = Moment(world.snapshot(), world.broadphase.name), Survey()
    measure_settings(survey, [moment], settings_around(moment.here, moment.effects), lambda done, of: None, 0)
    rows = []
    for kind in survey.kinds:
        for setting, (cost, error) in survey.known(kind).items():
            rows.append(
                {
                    "series": " ".join(setting.differs(moment.here)) or "as it is",
                    "label": setting.label(moment.here),
                    "panel": f"{scene}, {kind}",
                    "setting": setting._asdict(),
                    "ignored_effects": list(ignored_effects(moment.effects, setting.solver or world.solver)),
                    "error": _with_interval(error),
                    "floor": error.floor,
                    "wrong": None if error.wrong is None else counted(error.wrong),
                    "missed": None if error.missed is None else counted(error.missed),
                    "failures": dict(error.failures),
                    "cost": spread(cost),
                }
            )
    return rows


def _with_interval(error):
    """Return [low, reported, high] of an Error. An error in wrong answers has a confidence interval.

    An error in pixels has the interval from value - floor to value + floor.
    """
    if error.verdicts is None:
        return [max(0.0, error.value - error.floor), reported_error(error), error.value + error.floor]
    least, most = error.interval
    return [least, error.value, most]


def _jobs(scope: ReportScope) -> list[Job]:
    return [
        Job(
            f"scenes/{name}".replace("lab/", "lab-"),
            f"{__name__}:measure",
            {"scene": name, "where": scope.scenes[name]},
            15.0,
        )
        for name in (FEW if scope.quick else scope.scenes)
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for panel in dict.fromkeys(row["panel"] for row in rows):
        good = {
            row["label"]: pair(row["cost"])
            for row in rows
            if row["panel"] == panel
            and row["error"][2 if panel.endswith("verdict") else 1] <= VISIBLE
            and not any(row["failures"].values())
        }
        if len(good) > 1:
            found.append(ordering(f"{panel}, in frame {FRAME} alone, error at most 1", good))
    return found


def _panels(rows: Sequence[Row]) -> list[Panel]:
    return [
        Panel(
            panel.replace(",", ":"),
            Axis("us a step", time("cost")),
            Axis(UNITS.get(panel.split(", ")[1], f"{panel.split(', ')[1]} [px]"), value("error"), mark=VISIBLE),
            panel_is(panel),
        )
        for panel in dict.fromkeys(row["panel"] for row in rows)
    ]


CHART = Chart(
    13,
    "scenes",
    "Every setting of every scene, in one frame",
    "What would another broad phase, tier, solver or count of substeps cost here, and how wrong would it be?",
    "finer runs of the same moment, as far as two of them agree; exact pixels for verdicts; no overlap for piles",
    _panels,
    _jobs,
    _claims,
)
