"""Two reports beside each other: what contradicts, and where it got slower."""

from game.measure.timing import Cost
from game.report.chart import Chart
from game.report.claim import ordering, pair
from game.report.job import spread
from tests.accuracy.compare import contradictions, ratios


def of_series(rows):
    return [ordering("n bodies", {row["series"]: pair(row["cost"]) for row in rows})]


CHART = Chart(8, "c", "", "", "", (), lambda plan: [], of_series)


def report(**seconds):
    rows = []
    for name, least in seconds.items():
        cost = spread(Cost(least, 1.02 * least, 1.05 * least, 5, 60))
        rows.append({"job": "c/1", "series": name, "label": name, "panel": "p", "cost": cost})
    return {"c": rows}


def found(first, second):
    return [name for name, _, _ in contradictions(first, second, (CHART,))]


def test_another_winner_is_a_contradiction():
    assert found(report(a=1.0, b=2.0), report(a=2.0, b=1.0)) == ["c: n bodies"]
    assert not found(report(a=1.0, b=2.0), report(a=1.1, b=1.9))


def test_a_tie_contradicts_only_who_is_not_in_it():
    tie = report(a=1.0, b=1.01, c=3.0)
    assert not found(report(a=1.0, b=2.0, c=3.0), tie) and not found(tie, report(a=2.0, b=1.0, c=3.0))
    assert found(tie, report(a=2.0, b=2.0, c=1.0))


def test_what_got_slower_stands_out_on_a_slower_machine():
    slower = ratios(report(a=1.0, b=2.0, c=3.0), report(a=1.3, b=2.6, c=7.8))
    assert slower["c", "c"] == 2.0 and slower["c", "a"] == slower["c", "b"] == 1.0
