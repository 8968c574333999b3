"""`python -m tests.accuracy.compare FIRST SECOND`: compare two reports of one machine.

It prints the claims on which the reports contradict each other, and the series of charts that are certainly slower or
faster in the second report.
"""

import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from game.measure.pareto_front import TIE as TIE_SHARE
from game.report.chart import Chart
from game.report.charts import CHARTS
from game.report.claim import FAILS, HOLDS, TIE, Claim
from game.report.job import Row

Reports = dict[str, list[Row]]
SURE = 0.6  # of a series' rows that must be slower beyond their intervals
LEAST = 3  # series of a job, of which the median is what the machine does
ROWS = 4  # of a series, at least: two rows of one tier were 1.16 times slower by what else the machine did


def read(folder: Path) -> Reports:
    """Return {key of a chart: its rows} of the report in a folder."""
    return {chart.key: json.loads((folder / "data" / f"{chart.key}.json").read_text()) for chart in CHARTS}


def claims_of(report: Reports, charts: Sequence[Chart] = CHARTS) -> dict[str, Claim]:
    """Return the claims of a report, {text: Claim}.

    A text names the subject of a claim, not its winner. So the text is the same in two reports with different winners.
    """
    found = {}
    for chart in charts:
        for claim in chart.claims(report[chart.key]):
            found[f"{chart.key}: {claim.about or claim.text}"] = claim
    return found


def contradicts(a: Claim, b: Claim) -> bool:
    """Return whether two claims on the same subject contradict each other.

    Two claims that name the cheapest method do so if they have no method in common. In a tie, a claim names several
    methods. Other claims contradict each other if one holds and the other fails.
    """
    if a.order and b.order:
        return not set(a.order) & set(b.order)
    return {a.verdict, b.verdict} == {HOLDS, FAILS}


def contradictions(first: Reports, second: Reports, charts: Sequence[Chart] = CHARTS) -> list[tuple[str, Claim, Claim]]:
    """Return (text, claim in the first report, claim in the second) of each claim on which the reports disagree."""
    ours, theirs = claims_of(first, charts), claims_of(second, charts)
    both = [name for name in ours if name in theirs]
    return [(name, ours[name], theirs[name]) for name in both if contradicts(ours[name], theirs[name])]


class Change(NamedTuple):
    """Change of a series' times from the first report to the second, and how certain it is.

    The ratio of times is relative to the series that were measured in the same job.
    """

    ratio: float  # median of the least times
    sure: float  # share of its rows whose intervals, least to median, are apart

    @property
    def slower(self) -> bool:
        """Whether the series is certainly slower, by more than the share that counts as a tie in a report."""
        return self.ratio >= 1.0 + TIE_SHARE and self.sure >= SURE


def changes(first: Reports, second: Reports, charts: Sequence[Chart] = CHARTS) -> dict[tuple[str, str], Change]:
    """Return {(chart, series): Change} from the first report to the second.

    Each ratio of times is divided by the median ratio of its job, because the speed of the machine changes between jobs
    but hardly within one. Jobs with fewer than LEAST series are left out, because their median says little. Series with
    fewer than ROWS times are left out, and so are charts that show the rows of another chart.
    """
    found: dict[tuple[str, str], list[tuple[float, bool]]] = {}
    for chart in charts:
        if chart.of:
            continue
        pairs = list(_pairs(first[chart.key], second[chart.key]))
        for job in dict.fromkeys(row["job"] for row, _, _ in pairs):
            mine = [pair for pair in pairs if pair[0]["job"] == job]
            if len({row["series"] for row, _, _ in mine}) < LEAST:
                continue
            usual = median(b[0] / a[0] for _, a, b in mine)
            for row, a, b in mine:
                name = chart.key, str(row["series"])
                found.setdefault(name, []).append((b[0] / a[0] / usual, b[0] > usual * a[1]))
    return {
        name: Change(median(ratio for ratio, _ in every), sum(sure for _, sure in every) / len(every))
        for name, every in found.items()
        if len(every) >= ROWS
    }


def _pairs(rows, others) -> Iterator[tuple[Row, list[float], list[float]]]:
    """Yield (row, times, times in the other report) for every measured time that is in both lists of rows.

    rows, others: rows of one chart in the two reports. Times are [least, median] in seconds.
    """
    theirs = {_name(row): row for row in others}
    for row in rows:
        for name, cost in _costs(row):
            other = theirs.get(_name(row), {}).get(name)
            if other:
                yield row, cost["seconds"], other["seconds"]


def _costs(row) -> Iterator[tuple[str, Row]]:
    return (
        (name, value) for name, value in row.items() if isinstance(value, dict) and value.get("seconds", [0])[0] > 0
    )


def _name(row):
    return row["job"], row["series"], row["label"], row.get("panel")


def main(first: Path, second: Path) -> int:
    """Print the changes and the contradictions of two reports.

    Return 1 if the reports contradict each other, 2 for a folder without a finished report, otherwise 0.
    """
    try:
        a, b = read(first), read(second)
    except FileNotFoundError as error:
        sys.stderr.write(f"{error.filename} is not there: both must be folders of finished reports\n")
        return 2
    ours, theirs = claims_of(a), claims_of(b)
    found = contradictions(a, b)
    sure = [name for name in ours if name in theirs and ours[name].verdict != TIE]
    told = f"{len(ours)} and {len(theirs)} claims, {len(sure)} sure in the first and told by both"
    print(f"{told}, {len(found)} contradictions")
    for name, one, other in found:
        print(f"  {name}")
        for each in (one, other):
            print(f"    {each.text}: {each.figure} ({each.verdict})")
    for word, one, other in (("slower", a, b), ("faster", b, a)):
        slower = [(name, change) for name, change in changes(one, other).items() if change.slower]
        print(f"{len(slower)} of {len(changes(one, other))} series surely {word} in the second")
        for (chart, series), change in sorted(slower, key=lambda pair: -pair[1].ratio):
            print(f"  {change.ratio:6.2f} x  {chart}, {series}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
