"""Text of docs/accuracy.md: the results of a full report in sixteen plots, from the rows in docs/accuracy.json."""

import json
from pathlib import Path

from game.report.chart import Chart, Panel
from game.report.charts import CHARTS
from game.report.claim import TIE
from game.report.plots import Dot, dots_of

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE, KEPT, PLOTS = DOCS / "accuracy.md", DOCS / "accuracy.json", DOCS / "accuracy"
DIGITS = 4  # of the numbers that are kept
MOST = 6  # claims told of a chart; the others are in the report
STORY = {  # by chart: the panel that tells the most
    "tiers": "wrong hits, poses all around",
    "contacts": "normal, disc against disc",
    "fit": "largest distance",
    "solvers": "pyramid of 20 rows: overlap",
    "integration": "slide down 30 degrees: over dt",
    "continuous": "missed",
    "continuous-time": "100 discs",
    "broadphases": "even, all move",
    "far": "boxes",
    "effects": "declared: taken out",
    "chaos": "when",
    "latency": "time",
    "scenes": "shooter: verdict",
    "peers": "time of a frame",
    "papers": "corners of two polygons",
    "joints": "ball of 1000 rods on a chain",
}
INTRODUCTION = """# What accuracy costs in time

Measurements of {version} on one machine ({machine}),
in a full report of {seconds:.0f} s. Costs are the least, the median and the upper quartile of several runs; errors are
against exact references, which each plot names. A line joins the dots that no other beats in both; dashes are the limit
of what a player can see. An ordering needs separate intervals and a difference of more than a tenth; else it is a tie.

```sh
python main.py --report DIR             # measures it again, with interactive plots, tables and raw data
python -m tests.accuracy DIR            # writes this page from that report
```
"""


def panel_of(chart: Chart, rows: list) -> Panel:
    """Return the panel of a chart that the page shows. STORY has its title."""
    panels = chart.panels if isinstance(chart.panels, tuple) else chart.panels(rows)
    return next(panel for panel in panels if panel.title == STORY[chart.key])


def rounded(value):
    """Return a value with all its floats rounded to DIGITS digits. The value may be a dict, a list or a number."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def rows_of(kept: dict, chart: Chart) -> list:
    """Return the rows that a chart shows."""
    return kept["rows"][chart.of or chart.key]


def dots(kept: dict, chart: Chart) -> list[Dot]:
    """Return the dots of a chart's panel on the page."""
    return dots_of(panel_of(chart, rows_of(kept, chart)), rows_of(kept, chart))


def charts() -> list[Chart]:
    """Return the charts that the page shows, those in STORY, in the order of their numbers."""
    return [chart for chart in CHARTS if chart.key in STORY]


def facts_of(machine: dict) -> str:
    """Return the facts of a machine as text."""
    return ", ".join(f"{name} {value}" for name, value in machine.items())


def total_seconds(kept: dict) -> float:
    """Return the duration of a report with all charts [s], including separately measured ones."""
    return kept["seconds"] + sum(each["seconds"] for each in kept.get("apart", {}).values())


def text(kept: dict) -> str:
    """Return the text of the page."""
    facts = facts_of(kept["machine"])
    version = f"Hitbox {kept['version']}"
    parts = [INTRODUCTION.format(version=version, machine=facts, seconds=kept["seconds"])]
    for chart in charts():
        rows = rows_of(kept, chart)
        claims = chart.claims(rows)
        # Claims of papers come first, then certain ones.
        told = sorted(claims, key=lambda claim: (not claim.source, claim.verdict == TIE))
        lines = [f"| {claim.text} | {claim.figure} | {claim.verdict} | {claim.source} |" for claim in told[:MOST]]
        table = "\n".join(["| claim | measured | verdict | whose |", "|---|---|---|---|", *lines]) if lines else ""
        more = f"\nAnd {len(claims) - MOST} more, in the report." if len(claims) > MOST else ""
        apart = kept.get("apart", {}).get(chart.key)
        where = f"Measured apart, in {apart['seconds']} s ({facts_of(apart['machine'])})." if apart else ""
        parts += [
            f"## {chart.number}. {chart.title}",
            chart.question,
            f"![{STORY[chart.key]}](accuracy/{chart.key}.svg)",
            f"Truth: {chart.truth}. `python main.py --report DIR --only {chart.of or chart.key}`",
            where,
            f"{table}\n{more}",
        ]
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def read(path: Path = KEPT) -> dict:
    """Return the stored report."""
    return json.loads(path.read_text(encoding="utf-8"))
