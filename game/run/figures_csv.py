"""The numbers that a scene has measured in a run, as CSV.

Each row contains the command that measures the number again.
"""

import csv
import io
from collections.abc import Iterator
from typing import NamedTuple

from game.drawing.number_text import plain_name, tier_name
from game.measure.effect_totals import FIELDS, SCALES, EffectTotal
from game.measure.machine import machine_line
from game.measure.measured_runs import RunFigures
from game.measure.tiers import TierFigures
from game.measure.timing import Cost
from game.scene import Scene
from game.startup import start_line


class Figure(NamedTuple):
    """One row of the CSV file.

    of: source of the number, which is "headline", "goal", "finding", "own hits", "run", ...; value: a number or a text.
    low, high: interval of the value, "" for none. For times, they are the least time and the upper quartile.
    """

    of: str
    name: str
    value: str | float
    unit: str = ""
    low: str | float = ""
    high: str | float = ""
    runs: str | int = ""


COLUMNS = ("scene", "seed", "step", *Figure._fields, "command", "machine")


def command_of(scene: Scene, replay: str | None = None, bot: bool = False) -> str:
    """Return the command that makes the same run again and writes its numbers to figures.csv.

    replay: file of the recorded run, None for a run without a recording. bot: whether the scene's bot played that run.
    If not, the run had no input.
    """
    if replay is not None:
        run = ["--replay", replay]
    else:
        run = ["--scene", scene.name, "--seed", f"{scene.seed}", "--frames", f"{scene.frame}"]
        run += ["--bot"] if bot else []
    return start_line(*run, "--headless", "--csv", "figures.csv")


def figures_csv(scene: Scene, command: str) -> str:
    """Return the text of the CSV file: the headline, the goals, the finding, and all measured runs, tiers and effects.

    command: command that makes the same run again, see command_of(). A number that is not known yet has no row.
    """
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    system = machine_line()
    for figure in figures_of(scene):
        writer.writerow((scene.name, scene.seed, scene.frame, *figure, command, system))
    return file.getvalue()


def figures_of(scene: Scene) -> Iterator[Figure]:
    """Yield all numbers that the scene has measured in this run so far."""
    headline = scene.headline()
    if headline is not None and headline.known:
        yield Figure("headline", headline.sentence, headline.number, headline.unit)
    for goal in scene.check():
        verdict = "met" if goal.met else "pending" if goal.waits(scene.frame) else "not met"
        yield Figure("goal", goal.name, verdict, goal.detail if goal.measured else "not yet")
    if finding := scene.finding():
        yield Figure("finding", scene.title, finding)
    for part, count in scene.own_hits.items():
        yield Figure("own hits", part, count, "hits")
    for name, figures in scene.figures.items():
        if isinstance(figures, RunFigures):
            yield from _run_figures(_name_of(scene, name), figures)
        elif isinstance(figures, TierFigures):
            yield from _tier_figures(figures)
    for name, total in scene.totals.items():
        yield from _totals(name, total)


def _name_of(scene, name):
    """Return the name of a measured run of the scene as text: its parts in plain words, separated by commas.

    The values of the sliders and switches, with which many names begin, get their own names.
    """
    if not isinstance(name, tuple):
        return plain_name(f"{name}")
    chosen, words, count = scene.chosen, [], len(scene.values)
    if name[: len(chosen)] == chosen:
        words = [f"{slider.name} {slider.show(scene.values[slider.name])}" for slider in scene.sliders]
        name = *chosen[count:-1], "" if chosen[-1] else "boxes only", *name[len(chosen) :]
    words += [tier_name(plain_name(f"{part}")) for part in name if part not in (None, "")]
    return ", ".join(words)


def _timed(of, name, cost: Cost, unit="us", scale=1e6):
    return Figure(of, name, scale * cost.median, unit, scale * cost.least, scale * cost.upper, cost.runs)


def _run_figures(name, figures):
    yield _timed("run", f"{name}, a step", figures.cost)
    for what, value in (("deepest overlap", figures.overlap), ("greatest motion in a step", figures.farthest)):
        if value is not None:
            yield Figure("run", f"{name}, {what}", value, "px")


def _tier_figures(figures):
    for what, cost in (("a hit", figures.hit), ("a miss", figures.miss)):
        yield _timed("tier", f"{tier_name(figures.tier)}, {what}", cost, "ns", 1e9)
    yield _timed("tier", f"{tier_name(figures.tier)}, shapes made", figures.build)
    for what, rate in (("false hits of reported hits", figures.wrong), ("missed hits of true hits", figures.missed)):
        low, high = rate.interval
        name = f"{tier_name(figures.tier)}, {what} ({rate.count} of {rate.total})"
        yield Figure("tier", name, 100 * rate.share, "per 100", 100 * low, 100 * high)
    for what, value in figures.fit._asdict().items():
        yield Figure("tier", f"{tier_name(figures.tier)}, fit, {plain_name(what)}", value)


def _totals(name, total: EffectTotal):
    for field, unit in FIELDS.items():
        if field == "time" and total.value("time") is not None and total.time is not None:
            yield _timed("effects", f"{name}, {field}", total.time)
        elif field != "time" and (value := total.value(field)) is not None:
            yield Figure("effects", f"{name}, {field}", SCALES[field] * value, unit)
