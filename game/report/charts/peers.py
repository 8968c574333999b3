"""Chart 14: comparison with common libraries, which do the same work.

They are pygame's rectangles and masks, and pymunk's solver and rays. Each library is shown at its best. pygame is
measured as a plain program and as the best program that we know. pymunk is measured with several overlap slops,
iterations and substeps. Box2D v3 is not measured: its figures are quoted from box2d.json, beside those of Hitbox and
pymunk on its machine, and are not compared with times of this report.

Sprites are moved by whole pixels, because pygame compares whole pixels. The reference is the set of pairs of masks that
share a pixel, found by testing all pairs.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

from game.measure.pareto_front import TIE as SHARE
from game.measure.pareto_front import pareto_front
from game.measure.rates import Rate
from game.measure.timing import timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, percent, time, value
from game.report.charts import peer_queries
from game.report.claim import FAILS, HOLDS, TIE, Claim, at_least, ordering, pair, ratio_of
from game.report.job import Job, ReportScope, Row, counted, spread
from game.report.piles import overlap, pyramid, world_of
from game.report.pygame_sprites import BEST, FRAMES, MOVE, RECIPE, STEP, Hits, Traffic, programs
from game.report.pymunk_piles import library, overlap_in, space_of

LOOKS = 4  # frames whose hits are compared with the truth
SLOPS, ITERATIONS, DIVISIONS = (0.1, 0.03, 0.01), (5, 10, 20, 40), (1, 2, 4)  # of pymunk; slops in px
SUBSTEPS = (1, 2, 4, 8, "auto")
SETTLE, LAST = 120, 30  # steps before the measurement; the deepest overlap of the last ones counts
DT = 1.0 / 60.0  # [s]
QUOTED = json.loads(Path(__file__).parents[1].joinpath("box2d.json").read_text(encoding="utf-8"))
ELSEWHERE = "measured elsewhere, not compared with this report: a step of a pyramid"
ALIKE = (1.0, 0.1, 0.03)  # [px] overlaps at which the engines' times are compared


def measure_sprites(count: int) -> list[Row]:
    """Return a row for each way to find all hits among `count` sprites: time per frame, false and missed hits.

    All ways play the same frames. A pair is one encounter, however many of the LOOKS frames it lasts. The field
    "tested" is the number of pairs of boxes that a broad phase tested in the measured frames. Raises RuntimeError for a
    world that tested none, because its time would have no meaning.
    """
    traffic = Traffic(count)
    made = dict(programs(traffic))
    truth: Hits = set().union(*(traffic.truth(frame) for frame in range(1, LOOKS + 1)))
    wrong, missed = {}, {}
    for name, program in made.items():
        found: Hits = set()
        for _ in range(LOOKS):
            program.play()
            found |= program.found()
        wrong[name] = Rate(len(found - truth), len(found))
        missed[name] = Rate(len(truth - found), len(truth))
    before = {name: getattr(program, "tested", 0) for name, program in made.items()}
    costs = timed_steps({name: program.play for name, program in made.items()}, FRAMES)
    rows = []
    for name, program in made.items():
        tested = getattr(program, "tested", None)
        if tested is not None and tested == before[name]:
            raise RuntimeError(f"{name}: the broad phase of {count} moving sprites tested no pair")
        rows.append(
            {
                "series": name,
                "label": f"{name}, {count} sprites",
                "panel": "sprites",
                "n": count,
                "wrong": counted(wrong[name]),
                "missed": counted(missed[name]),
                "tested": None if tested is None else tested - before[name],
                "cost": spread(costs[name]),
            }
        )
    return rows


def quote_box2d() -> list[Row]:
    """Return the rows of box2d.json: times of a step [us] of Box2D v3, and of others on the same machine."""
    return [
        {
            "series": f"{name}, elsewhere",
            "label": f"{name}, {row['boxes']} boxes; {QUOTED['version']}; {QUOTED['machine']}; {QUOTED['measured']}",
            "panel": ELSEWHERE,
            "boxes": row["boxes"],
            "quoted_us": 1e3 * row["step_ms"],
            "machine": QUOTED["machine"],
            "version": QUOTED["version"],
        }
        for name, rows in QUOTED["engines"].items()
        for row in rows
    ]


def _settled(step: Callable[[], object], depth: Callable[[], float]) -> float:
    """Make SETTLE steps, and return the greatest overlap in the last LAST of these steps [px].

    step: function that makes one step; depth: function that measures the overlap [px].
    """
    found = []
    for number in range(SETTLE):
        step()
        if number >= SETTLE - LAST:
            found.append(depth())
    return max(found)


def _steps_of(space: Any, divisions: int) -> None:
    for _ in range(divisions):
        space.step(DT / divisions)


def measure_piles(rows: int) -> list[Row]:
    """Return a row for each engine and setting: the overlap of a pyramid after two seconds, and the time of a step.

    A step is 1/60 s. rows: number of rows of the pyramid. Each setting starts from a new pyramid. Without pymunk, a row
    without figures says so.
    """
    made, found, steps, missing = pyramid(rows), {}, {}, ""
    try:
        library()
    except ModuleNotFoundError as error:
        missing = str(error)
    for substeps in SUBSTEPS:
        world, label = world_of(made, "soft_step", substeps), f"ours: {substeps} substeps"
        steps[label] = world.step
        found[label] = ("ours", _settled(world.step, partial(overlap, world)), {"substeps": substeps})
    for slop, count, divisions in () if missing else product(SLOPS, ITERATIONS, DIVISIONS):
        space = space_of(made, count)
        space.collision_slop = slop
        label = f"pymunk: slop {slop:g} px, {count} iterations, {divisions} substeps"
        steps[label] = partial(_steps_of, space, divisions)
        given = {"slop": slop, "iterations": count, "substeps": divisions}
        found[label] = ("pymunk", _settled(steps[label], partial(overlap_in, space)), given)
    costs = timed_steps(steps, 20)
    panel = f"pyramid of {len(made.places)}"
    return [
        {"series": engine, "label": label, "panel": panel, **given, "overlap": deep, "cost": spread(costs[label])}
        for label, (engine, deep, given) in found.items()
    ] + ([{"series": "pymunk", "label": missing, "panel": panel}] if missing else [])


def _jobs(scope: ReportScope) -> list[Job]:
    work = __name__
    counts, rows = ((300,), (10,)) if scope.quick else ((100, 300, 1000, 2000), (10, 20, 45))
    return [
        *(Job(f"peers/sprites-{n}", f"{work}:measure_sprites", {"count": n}, 2.0 + n / 80) for n in counts),
        Job("peers/box2d", f"{work}:quote_box2d", {}, 0.1),
        *peer_queries.jobs(scope.quick),
        *(Job(f"peers/pyramid-{n}", f"{work}:measure_piles", {"rows": n}, n * n / 12) for n in rows),
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for count in dict.fromkeys(row["n"] for row in rows if row["panel"] == "sprites"):
        exact = {
            row["series"]: row["cost"]
            for row in rows
            if row["panel"] == "sprites" and row["n"] == count and row["wrong"][0] == 0 and row["missed"][0] == 0
        }
        found.append(ordering(f"{count} sprites, every hit right", {name: pair(cost) for name, cost in exact.items()}))
        found += [
            at_least(
                f"{count} sprites, {name}: faster than the best pygame program", ratio_of(exact[BEST], exact[name]), 1.1
            )
            for name in (STEP, MOVE, RECIPE)
            if name in exact and BEST in exact
        ]
    for panel in _piles(rows):
        missing = [row["label"] for row in rows if row["panel"] == panel and "cost" not in row]
        if missing:
            found.append(Claim(f"{panel} boxes: beside pymunk", missing[0], TIE))
        else:
            found += [_at_overlap(panel, most, rows) for most in ALIKE]
    return [*found, *peer_queries.claims(rows), *_quoted_claims(rows)]


def _piles(rows) -> list[str]:
    """Return the names of the panels that show piles."""
    return [panel for panel in dict.fromkeys(row["panel"] for row in rows) if panel.startswith("pyramid of ")]


def _quoted_claims(rows) -> Iterator[Claim]:
    """Yield a Claim for each pile that Box2D and Hitbox stepped elsewhere, on one machine."""
    quoted = {(row["series"].split(",")[0], row["boxes"]): row for row in rows if row["panel"] == ELSEWHERE}
    for (name, count), row in quoted.items():
        ours = quoted.get(("Hitbox", count))
        if name == "Box2D v3" and ours:
            its, mine = row["quoted_us"], ours["quoted_us"]
            figure = f"{its:.3g} us against {mine:.3g} us there: {row['version']}; {row['machine']}; one run"
            text = f"pyramid of {count} boxes, 4 substeps, quoted from elsewhere: Box2D v3 takes less time than Hitbox"
            yield Claim(text, figure, HOLDS if its < (1.0 - SHARE) * mine else FAILS, "game/report/box2d.json")


def _at_overlap(panel, most, rows) -> Claim:
    """Return a Claim that names the fastest engine at an overlap of at most `most` [px].

    Each engine is represented by its fastest setting within this limit. panel: name of the panel; rows: its measured
    rows.
    """
    about = f"{panel} boxes, overlap of at most {most:g} px"
    curves, best = fronts(rows, panel), cheapest(rows, panel, most)
    if len(best) > 1:
        return ordering(about, {engine: pair(row["cost"]) for engine, row in best.items()})
    reached = f"{' and '.join(best)} alone reaches it" if best else "no setting reaches it"
    figure = ", ".join(f"{engine} {curve[-1]['overlap']:.3g} px at least" for engine, curve in curves.items())
    return Claim(f"{about}: {reached}", figure, HOLDS)


def fronts(rows: Sequence[Row], panel: str) -> dict[str, list[Row]]:
    """Return {engine: rows on the Pareto front of time and overlap}, fastest first.

    rows: measured rows; panel: name of the panel whose rows are used.
    """
    found = {}
    for engine in ("ours", "pymunk"):
        mine = {
            row["label"]: row for row in rows if row["panel"] == panel and row["series"] == engine and "cost" in row
        }
        points = {label: (pair(row["cost"])[1], row["overlap"]) for label, row in mine.items()}
        found[engine] = [mine[label] for label in pareto_front(points)]
    return found


def cheapest(rows: Sequence[Row], panel: str, most: float) -> dict[str, Row]:
    """Return {engine: its fastest row in a panel with an overlap of at most `most` [px]}.

    Engines without such a row are omitted.
    """
    within = {
        engine: next((row for row in curve if row["overlap"] <= most), None)
        for engine, curve in fronts(rows, panel).items()
    }
    return {engine: row for engine, row in within.items() if row is not None}


def _panels(rows: Sequence[Row]) -> list[Panel]:
    cost = Axis("us a frame", time("cost"))
    counts = dict.fromkeys(row["n"] for row in rows if row["panel"] == "sprites")
    sprites = [Panel("time of a frame", Axis("sprites", value("n")), cost, panel_is("sprites"), line="series")]
    sprites += [
        Panel(
            f"{count} sprites: {word}",
            cost,
            Axis(f"{word} [%]", percent(key), log=False),
            lambda row, n=count: row["panel"] == "sprites" and row["n"] == n,
        )
        for count in counts
        for word, key in (("wrong hits", "wrong"), ("missed hits", "missed"))
    ]
    piles = [
        Panel(panel, Axis("us a step", time("cost")), Axis("overlap [px]", value("overlap"), mark=1.0), panel_is(panel))
        for panel in _piles(rows)
    ]
    quoted = Panel(
        ELSEWHERE, Axis("boxes", value("boxes")), Axis("us a step", value("quoted_us")), panel_is(ELSEWHERE), "series"
    )
    return [*(sprites if counts else []), *piles, *peer_queries.panels(), quoted]


CHART = Chart(
    14,
    "peers",
    "Beside pygame, pymunk and Box2D",
    "What does the same work cost with common libraries, and is it as exact?",
    "sprites: which masks share a pixel, asked for every pair in each frame; piles: no box overlaps another. Box2D's "
    f"figures are quoted, not measured here: {QUOTED['version']}; {QUOTED['machine']}; {QUOTED['measured']}",
    _panels,
    _jobs,
    _claims,
)
