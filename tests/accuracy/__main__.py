"""Write docs/accuracy.json, docs/accuracy.md and its sixteen plots from the results of a report.

    python -m tests.accuracy DIR          all charts, from the full report in DIR
    python -m tests.accuracy DIR CHART    one chart, from a report of this chart alone (--only CHART)

A chart that was measured separately keeps a note with its machine on the page, until a full report replaces all charts.
"""

import json
import sys
from pathlib import Path

from game.report.chart import Chart
from game.report.plots import draw
from tests.accuracy.page import KEPT, PAGE, PLOTS, charts, panel_of, read, rounded, rows_of, text

STYLE = """<style>
:root { --ink: #1b2230; --paper: #ffffff; --faint: #b4bccb; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6ebf5; --paper: #171d2b; --faint: #4b566e; } }
text { font-family: sans-serif; }
</style>"""


def main(folder: Path, only: str = "") -> None:
    """Write docs/accuracy.json, docs/accuracy.md and the plots from the finished report in a folder.

    only: key of the single chart to replace; "" for all charts.
    """
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    if manifest["quick"]:
        raise SystemExit(f"{folder} holds a quick report; the page is made from a full one")
    results = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((folder / "results").iterdir())]
    failed = [found["name"] for found in results if "failed" in found]
    if failed:
        raise SystemExit(f"{folder}: {len(failed)} jobs failed: {', '.join(failed)}")
    chosen = [chart for chart in charts() if only in ("", chart.key)]
    if not chosen:
        raise SystemExit(f"no chart {only!r}; there are {', '.join(chart.key for chart in charts())}")
    rows = {
        chart.key: rounded(json.loads((folder / "data" / f"{chart.key}.json").read_text()))
        for chart in chosen
        if not chart.of
    }
    seconds = round(sum(found["spent"] for found in results if only in ("", found["name"].split("/")[0])))
    if only:
        kept = replaced(read(), rows, {"seconds": seconds, "machine": manifest["machine"]})
    else:
        kept = {"version": manifest["version"], "machine": manifest["machine"], "seconds": seconds, "rows": rows}
    write(kept, chosen)


def replaced(kept: dict, rows: dict, apart: dict) -> dict:
    """Return a copy of the stored report in which some charts have new rows.

    kept: the stored report; rows: {key of a chart: its new rows}; apart: duration [s] and machine of the separate
    report that measured these rows.
    """
    mine = {**kept.get("apart", {}), **dict.fromkeys(rows, apart)}
    return {**kept, "apart": mine, "rows": {**kept["rows"], **rows}}


def write(kept: dict, drawn: list[Chart]) -> None:
    """Write the rows, the plots of the charts in `drawn`, and the page."""
    lines = ",\n".join(f" {json.dumps(key)}: {json.dumps(each)}" for key, each in kept.items() if key != "rows")
    tables = ",\n".join(
        f"  {json.dumps(key)}: [\n" + ",\n".join("   " + json.dumps(row) for row in each) + "\n  ]"
        for key, each in kept["rows"].items()
    )
    KEPT.write_text(f'{{\n{lines},\n "rows": {{\n{tables}\n }}\n}}\n', encoding="utf-8")
    PLOTS.mkdir(exist_ok=True)
    for chart in drawn:
        svg, _ = draw(panel_of(chart, rows_of(kept, chart)), rows_of(kept, chart), chart.key)
        head, _, rest = svg.partition(">")
        (PLOTS / f"{chart.key}.svg").write_text(f"{head}>\n{STYLE}{rest}", encoding="utf-8")
    PAGE.write_text(text(kept), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:3])
