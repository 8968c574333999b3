"""python -m tests.accuracy DIR: docs/accuracy.json, docs/accuracy.md and its twelve plots from a full report in DIR."""

import json
import sys
from pathlib import Path

from game.report.plots import draw
from tests.accuracy.page import KEPT, PAGE, PLOTS, charts, panel_of, rounded, rows_of, text

STYLE = """<style>
:root { --ink: #1b2230; --paper: #ffffff; --faint: #b4bccb; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6ebf5; --paper: #171d2b; --faint: #4b566e; } }
text { font-family: sans-serif; }
</style>"""


def main(folder: Path) -> None:
    """Write docs/accuracy.json, docs/accuracy.md and the plots from the finished report in a folder."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    if manifest["quick"]:
        raise SystemExit(f"{folder} holds a quick report; the page is made from a full one")
    results = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((folder / "results").iterdir())]
    failed = [found["name"] for found in results if "failed" in found]
    if failed:
        raise SystemExit(f"{folder}: {len(failed)} jobs failed: {', '.join(failed)}")
    rows = {chart.key: json.loads((folder / "data" / f"{chart.key}.json").read_text()) for chart in charts()}
    kept = {
        "version": manifest["version"],
        "machine": manifest["machine"],
        "seconds": round(sum(found["spent"] for found in results)),
        "rows": rounded({chart.key: rows[chart.key] for chart in charts() if not chart.of}),
    }
    lines = ",\n".join(f" {json.dumps(key)}: {json.dumps(each)}" for key, each in kept.items() if key != "rows")
    tables = ",\n".join(
        f"  {json.dumps(key)}: [\n" + ",\n".join("   " + json.dumps(row) for row in each) + "\n  ]"
        for key, each in kept["rows"].items()
    )
    KEPT.write_text(f'{{\n{lines},\n "rows": {{\n{tables}\n }}\n}}\n', encoding="utf-8")
    PLOTS.mkdir(exist_ok=True)
    for chart in charts():
        svg, _ = draw(panel_of(chart, rows_of(kept, chart)), rows_of(kept, chart), chart.key)
        head, _, rest = svg.partition(">")
        (PLOTS / f"{chart.key}.svg").write_text(f"{head}>\n{STYLE}{rest}", encoding="utf-8")
    PAGE.write_text(text(kept), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
