"""Chart 10: benefit and cost of each effect. The benefit is the change of a scene's run without the effect.

The cost is the effect's time per step.
"""

from collections.abc import Sequence

from game.measure.ledger import EFFECTS, Entry, entry
from game.report.chart import Axis, Chart, Panel, panel_is, value
from game.report.charts.latency import scene_class
from game.report.claim import HOLDS, TIE, Claim
from game.report.job import Job, ReportScope, Row
from game.run.headless import start_dummy_display
from game.run.warmup import warm_up_scene

FRAMES, FRAMES_QUICK = 300, 150  # steps of the bot's run
LONGEST = {"lab/broadphases": 60}  # four worlds of thousands of bodies
FEW = ("shooter", "lab/pyramid")
MICRO = 1e6


def measure(scene: str, where: str, frames: int) -> list[Row]:
    """Return a row for each effect of a scene.

    The time in a row is the median difference between the steps with and without the effect. where: "module:Class" of
    the scene; frames: greatest length of a run.
    """
    start_dummy_display()
    made = scene_class(where)
    warm_up_scene(made, None, None)
    return [_row(scene, entry(made, effect, frames)) for effect in EFFECTS]


def _row(scene: str, found: Entry) -> Row:
    return {
        "series": found.effect,
        "label": f"{scene}, {'declared' if found.declared else 'put in idle'}",
        "panel": "declared" if found.declared else "idle",
        "scene": scene,
        "declared": found.declared,
        "with": list(found.changed),
        "refused": found.refused,
        "matters": found.matters,
        "moved": found.moved,
        "told": found.reported,
        "ruled": found.ruled,
        "parted": found.parted,
        "apart": None if found.refused else found.apart,
        "worst": None if found.refused else [found.p99, found.worst, found.worst],
        "worked": found.worked,
        "worked_without": found.worked_without,
        "us_cost": None if found.refused else MICRO * found.cost,
    }


def _jobs(scope: ReportScope) -> list[Job]:
    frames, chosen = (FRAMES_QUICK, FEW) if scope.quick else (FRAMES, scope.scenes)
    return [
        Job(
            f"effects/{name}".replace("lab/", "lab-"),
            f"{__name__}:measure",
            {"scene": name, "where": scope.scenes[name], "frames": min(frames, LONGEST.get(name, frames))},
            6.0 if scope.quick else 25.0,
        )
        for name in chosen
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        declared = [row for row in rows if row["scene"] == scene and row["declared"]]
        idle = [row["series"] for row in declared if not row["matters"]]
        figure = f"{len(declared) - len(idle)} of {len(declared)} were missed"
        figure += f", not yet {', '.join(idle)}" if idle else ""  # they may act in a longer run
        found.append(Claim(f"{scene} declares only effects that it calls for", figure, TIE if idle else HOLDS))
    return found


CHART = Chart(
    10,
    "effects",
    "Benefit and cost of each effect",
    "How far does a run deviate without an effect, and how much time does that save? What would an idle one cost?",
    "the same scene, played by the same keys beside it; figures are of 2 s after the two differ",
    (
        Panel(
            "declared: taken out",
            Axis("us a step that it takes", value("us_cost"), log=False),
            Axis("px RMS astray without it", value("apart"), mark=1.0),
            panel_is("declared"),
            "",
        ),
        Panel(
            "declared: taken out, the worst body",
            Axis("us a step that it takes", value("us_cost"), log=False),
            Axis("px astray without it: worst body (bar from p99)", value("worst"), mark=1.0),
            panel_is("declared"),
            "",
        ),
        Panel(
            "not declared: put in with nothing to do",
            Axis("us a step that it takes", value("us_cost"), log=False),
            Axis("px RMS astray with it", value("apart"), mark=1.0),
            panel_is("idle"),
            "",
        ),
    ),
    _jobs,
    _claims,
)
