"""Text of docs/stability.md, made from the table of rows and the figures in docs/stability.json."""

import json
from pathlib import Path

from tests.stability import found, joint_peers, peers
from tests.stability.faults import table as faults
from tests.stability.rows import SECTIONS
from tests.stability.settings import DEFAULTS, FOUR

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE, KEPT = DOCS / "stability.md", DOCS / "stability.json"
TITLE = """# Stability

The hard cases of this engine's tests: cases that broke the best engines, from their test suites, samples, issues and
papers. Limits are theirs if they name one. The tests are in [tests/stability](../tests/stability), a file per section,
with the row's id in the name of the test; the measured value is the worst over all its variants. Margin: the factor by
which it could grow before the limit; *exact*: one value is right, and it was measured. Rows of worlds that stack run
with 4 substeps, the first value, and under the settings of `World()`, the second; a limit beside that is its own.
A test also fails where a value is worse than this page's by more than a factor of two, unless it is below a thousandth
of its limit. Values are the worst over ten phases, seeds or angles wherever a row has them.

Lengths are in the scene's own unit, m unless it says px. This page is generated:

```sh
python -m pytest tests/stability -m "" --stability-json docs/stability.json   # measures
python -m tests.stability                                                     # writes this page
```
"""
HEADER = (
    "| row | case | limit | measured | margin | by default | margin | best peer | source |\n"
    "|---|---|---|---|---|---|---|---|---|"
)


def kept_figures():
    """Return {settings: {row: {figure: value}}} from docs/stability.json."""
    return json.loads(KEPT.read_text())


def number(value):
    """Return a number as short text."""
    return f"{value:.0f}" if value == round(value) and abs(value) < 1e6 else f"{value:.4g}"


def cell(text):
    """Return a text with its vertical bars escaped, for one cell of a Markdown table."""
    return text.replace("|", "\\|")


def measured_cells(limit, value, usual):
    """Return (value, margin) as texts of two table cells; both are "–" if value is None.

    usual: limit that the line of the table already shows. Another limit is added to the text of the value.
    """
    if value is None:
        return "–", "–"
    told = f"{number(value)} {limit.unit}".rstrip()
    return told if limit == usual else f"{told}, limit {number(limit.value)}", limit.margin(value)


def lines_of(row, figures, defaults):
    """Return the lines of a row in the Markdown table, one for each figure. Only the first line names the case.

    figures, defaults: {figure: value} measured with 4 substeps and with the default settings.
    """
    if row.absent:
        told = f"does not apply: {cell(row.absent)}"
        return [f"| {row.id} | {cell(row.case)} | – | {told} | – | – | – | {row.peer} | {row.source} |"]
    lines = []
    for limit in row.limits:
        first = not lines
        told, margin = measured_cells(limit, figures.get(limit.figure), limit)
        also, its = measured_cells(row.limit(limit.figure, True), defaults.get(limit.figure), limit)
        lines.append(
            f"| {row.id if first else ''} | {cell(row.case) if first else ''} | {cell(limit.figure)} {limit.sense} "
            f"{number(limit.value)} {limit.unit}".rstrip()
            + f" | {told} | {margin} | {also} | {its} | {row.peer if first else ''} | {row.source if first else ''} |"
        )
    if row.fault:
        lines.append(f"| | **open:** {cell(row.fault)} | | | | | | | |")
    return lines


def page(sections=SECTIONS, kept=None):
    """Return the text of the whole page: a table for each section, the comparisons, the faults and the defects found.

    kept: figures as returned by `kept_figures`; None: those of docs/stability.json.
    """
    kept = kept_figures() if kept is None else kept
    parts = [TITLE]
    for section in sections:
        lines = [
            line
            for row in section.rows
            for line in lines_of(row, kept[FOUR].get(row.id, {}), kept[DEFAULTS].get(row.id, {}))
        ]
        parts.append("\n".join([f"## {section.letter}. {section.title}\n", HEADER, *lines]) + "\n")
    parts.append(peers.section())
    parts.append(joint_peers.section())
    parts.append(faults.section())
    parts.append(f"## What the suite found\n\n{found.section()}\n")
    return "\n".join(parts)
