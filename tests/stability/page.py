"""docs/stability.md from the table of the rows and the figures kept in docs/stability.json."""

import json
from pathlib import Path

from tests.stability import found
from tests.stability.faults import table as faults
from tests.stability.rows import SECTIONS

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE, KEPT = DOCS / "stability.md", DOCS / "stability.json"
TITLE = """# Stability

The hard cases of this engine's tests: cases that broke the best engines, from their test suites, samples, issues and
papers. Limits are theirs if they name one. The tests are in [tests/stability](../tests/stability), a file per section,
with the row's id in the name of the test; the measured value is the worst over all its variants. Margin: the factor by
which it could grow before the limit; *exact*: one value is right, and it was measured.

Lengths are in the scene's own unit, m unless it says px. This page is generated:

```sh
python -m pytest tests/stability -m "not nightly" --stability-json docs/stability.json   # measures
python -m tests.stability                                                               # writes this page
```
"""
HEADER = "| row | case | limit | measured | margin | best peer | source |\n|---|---|---|---|---|---|---|"


def kept_figures():
    """{row: {figure: value}} as the last measured run left them."""
    return json.loads(KEPT.read_text())


def number(value):
    """A number as short as it is exact enough."""
    return f"{value:.0f}" if value == round(value) and abs(value) < 1e6 else f"{value:.4g}"


def cell(text):
    """Text that does not end its cell."""
    return text.replace("|", "\\|")


def lines_of(row, figures):
    """A line per figure of a row; the case stands on the first."""
    if row.absent:
        return [
            f"| {row.id} | {cell(row.case)} | – | does not apply: {cell(row.absent)} | – | {row.peer} | {row.source} |"
        ]
    lines = []
    for limit in row.limits:
        value, first = figures.get(limit.figure), not lines
        told = "–" if value is None else f"{number(value)} {limit.unit}".rstrip()
        margin = "–" if value is None else limit.margin(value)
        lines.append(
            f"| {row.id if first else ''} | {cell(row.case) if first else ''} | {cell(limit.figure)} {limit.sense} "
            f"{number(limit.value)} {limit.unit}".rstrip()
            + f" | {told} | {margin} | {row.peer if first else ''} | {row.source if first else ''} |"
        )
    if row.fault:
        lines.append(f"| | **open:** {cell(row.fault)} | | | | | |")
    return lines


def page(sections=SECTIONS, kept=None):
    """The whole page: a table for each section, the faults, what was found."""
    kept = kept_figures() if kept is None else kept
    parts = [TITLE]
    for section in sections:
        lines = [line for row in section.rows for line in lines_of(row, kept.get(row.id, {}))]
        parts.append("\n".join([f"## {section.letter}. {section.title}\n", HEADER, *lines]) + "\n")
    parts.append(faults.section())
    parts.append(f"## What the suite found\n\n{found.section()}\n")
    return "\n".join(parts)
