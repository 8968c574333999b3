"""The report as one self-contained HTML page: plots with the data of each dot, tables, and the raw data."""

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from game import VERSION
from game.report.answer import answer_of
from game.report.chart import Chart
from game.report.claim import Claim
from game.report.job import Row
from game.report.plots import draw, shown
from game.startup import start_line

HEADLINE = "tiers"  # key of the chart whose first panel follows the answer
STEPS = "peers"  # key of the chart with the whole steps that the answer compares
# The questions of the report, and the keys of the charts that answer them; other charts follow the last question.
QUESTIONS = (
    ("Which hits are fair?", ("tiers", "contacts", "fit", "continuous", "continuous-time")),
    ("What stands?", ("solvers", "integration", "joints", "far", "chaos")),
    ("What is fast?", ("broadphases", "latency")),
    ("What does a scene need?", ("effects", "scenes")),
    ("How do others do?", ("peers", "papers")),
)
PAGE = Path(__file__).with_name("page.html")


class Measured(NamedTuple):
    """A chart with the results of its jobs.

    failed: {name of a job: reason}; left: number of jobs that have not run yet.
    """

    chart: Chart
    rows: list[Row]  # each with the name of its job under "job"
    failed: Mapping[str, str]
    left: int


def write_page(measured: Sequence[Measured], manifest: Mapping[str, Any], folder: str, spent: float) -> str:
    """Return the HTML text of the report's page. measured: the charts with their results.

    manifest: description of the report, see Store; folder: the report's folder as on the command line, used in the
    commands that measure a dot again; spent: total duration of the jobs [s].
    """
    reported: dict[str, Any] = {}
    quick = bool(manifest["quick"])
    groups = _groups(measured)
    charts = "\n".join(
        f'<h2 class=question id="q{number}">{escape(question)}</h2>\n'
        + "\n".join(_chart(each, reported, folder, quick) for each in members)
        for number, (question, members) in enumerate(groups)
    )
    rows = {each.chart.key: each.rows for each in measured}
    parts = {
        "version": VERSION,
        "kind": "quick" if manifest["quick"] else "full",
        "machine": _machine(manifest["machine"], spent),
        "answer": escape(answer_of(rows.get(HEADLINE, []), rows.get(STEPS, []))),
        "headline": _headline(measured, reported, folder, quick),
        "contents": "".join(_contents(number, *group) for number, group in enumerate(groups)),
        "failures": _failures(measured),
        "claims": _claims([claim for each in measured for claim in each.chart.claims(each.rows)]),
        "charts": charts,
        "dots": _script(reported),
        "data": _script(rows),
    }
    page = PAGE.read_text(encoding="utf-8")
    for name, text in parts.items():
        page = page.replace("{{" + name + "}}", text)
    return page


def _groups(measured):
    """Return a list of (question, charts of `measured` that answer the question)."""
    known = {key: number for number, (_, keys) in enumerate(QUESTIONS) for key in keys}
    found = [(question, []) for question, _ in QUESTIONS]
    for each in measured:
        found[known.get(each.chart.key, len(QUESTIONS) - 1)][1].append(each)
    return [(question, members) for question, members in found if members]


def _contents(number, question, members):
    charts = "".join(
        f'<li><a href="#{each.chart.key}">{each.chart.number}. {escape(each.chart.title)}</a></li>' for each in members
    )
    return f'<li><a href="#q{number}">{escape(question)}</a><ul>{charts}</ul></li>'


def _headline(measured, reported, folder, quick):
    """Return the HTML figure at the top of the page, the first panel of the chart HEADLINE; "" without dots.

    measured: the charts with their results; reported, folder, quick: as in _figure().
    """
    for each in measured:
        if each.chart.key == HEADLINE and isinstance(each.chart.panels, tuple):
            return _figure(each.chart.panels[0], each.rows, "headline", reported, folder, quick)
    return ""


def _figure(panel, rows, name, reported, folder, quick):
    """Return a panel as an HTML figure; "" if it has no dots. Add the texts of its dots to `reported`, {id: texts}.

    name: name of the panel, the first part of the ids; folder, quick: values of --report and --quick.
    """
    svg, dots = draw(panel, rows, name)
    if not svg:
        return ""
    for k, dot in enumerate(dots):
        reported[f"{name}-{k}"] = {**shown(dot, panel), "again": command(dot.row, folder, quick)}
    return f"<figure><figcaption>{escape(panel.title)}</figcaption>{svg}</figure>"


def _script(value):
    """Return a value as JSON text for a <script> element. "</" is escaped, so that the text cannot end the element."""
    return json.dumps(value).replace("</", "<\\/")


def _chart(measured, reported, folder, quick):
    chart, rows = measured.chart, measured.rows
    panels = chart.panels if isinstance(chart.panels, tuple) else chart.panels(rows)
    text = "".join(
        _figure(panel, rows, f"{chart.key}-{number}", reported, folder, quick) for number, panel in enumerate(panels)
    )
    text = text or "<p>Nothing of this is measured.</p>"
    text += "".join(f"<p>{escape(job)} is missing: {escape(why)}</p>" for job, why in measured.failed.items())
    return (
        f'<section id="{chart.key}"><h3>{chart.number}. {escape(chart.title)}</h3>'
        f"<p>{escape(chart.question)}</p><p class=truth>Truth: {escape(chart.truth)}</p>"
        f"<div class=panels>{text}</div>{_claims(chart.claims(rows))}"
        f"<details><summary>{len(rows)} rows, and the commands that measure them again</summary>"
        f'<button data-key="{chart.key}" data-as=csv>CSV</button> '
        f'<button data-key="{chart.key}" data-as=json>JSON</button>'
        f"{_table(rows, folder, quick)}</details></section>"
    )


def command(row: Row, folder: str, quick: bool) -> str:
    """Return the shell command that repeats the job of a row. folder, quick: values of --report and --quick."""
    report = [f"--report={folder}"] if folder.startswith("-") else ["--report", folder]
    return start_line(*report, *(["--quick"] if quick else []), "--only", row["job"])


def _claims(claims: Iterable[Claim]):
    lines = [
        f"<tr class={claim.verdict.replace(' ', '-')}><td>{escape(claim.text)}</td><td>{escape(claim.figure)}</td>"
        f"<td>{escape(claim.verdict)}</td><td>{escape(claim.source)}</td></tr>"
        for claim in claims
    ]
    if not lines:
        return ""
    head = "<tr><th>claim</th><th>measured</th><th>verdict</th><th>whose</th></tr>"
    return f"<div class=wide><table class=claims>{head}{''.join(lines)}</table></div>"


def _failures(measured):
    lines = [f"<li>{escape(job)}: {escape(why)}</li>" for each in measured for job, why in each.failed.items()]
    left = sum(each.left for each in measured)
    text = f"<h2>What failed</h2><ul>{''.join(lines)}</ul>" if lines else ""
    return text + (f"<p>{left} jobs are not done yet: the same command goes on with them.</p>" if left else "")


def _machine(machine, spent):
    facts = ", ".join(f"{escape(str(name))} {escape(str(value))}" for name, value in machine.items())
    return f"{facts}; measured in {spent:.0f} s"


def _table(rows, folder, quick):
    names = columns(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in [*names, "command"])
    body = "".join(
        "<tr>"
        + "".join(f"<td>{escape(cell(row.get(name)))}</td>" for name in names)
        + f"<td><code>{escape(command(row, folder, quick))}</code></td></tr>"
        for row in rows
    )
    return f"<div class=wide><table><tr>{head}</tr>{body}</table></div>"


def columns(rows: Iterable[Row]) -> list[str]:
    """Return the keys of all rows, in the order of their first appearance."""
    return list(dict.fromkeys(name for row in rows for name in row))


def cell(value: Any) -> str:
    """Return a value of a row as the text of a table cell."""
    if value is None:
        return ""
    if isinstance(value, dict) and "seconds" in value:
        return " / ".join(f"{each:.4g}" for each in value["seconds"]) + " s"
    if isinstance(value, float):
        return f"{value:.5g}"
    return value if isinstance(value, str) else json.dumps(value)


def as_csv(rows: Sequence[Row]) -> str:
    """Return the rows as CSV text. Each time has three columns [s]: least, median and upper quartile."""
    flat = []
    for row in rows:
        line: Row = {}
        for name, value in row.items():
            if isinstance(value, dict) and "seconds" in value:
                line |= {
                    f"{name}_{part}": each
                    for part, each in zip(("least", "median", "upper"), value["seconds"], strict=True)
                }
            else:
                line[name] = json.dumps(value) if isinstance(value, (dict, list)) else value
        flat.append(line)
    file = io.StringIO()
    writer = csv.DictWriter(file, columns(flat))
    writer.writeheader()
    writer.writerows(flat)
    return file.getvalue()
