"""Comparison of two reports: contradictions, and series that became slower."""

from copy import deepcopy
from random import Random

from game.measure.timing import Cost
from game.report.chart import Chart
from game.report.claim import ordering, pair
from game.report.job import spread
from tests.accuracy.compare import changes, contradictions, main
from tests.accuracy.page import charts, read


def of_series(rows):
    return [ordering("n bodies", {row["series"]: pair(row["cost"]) for row in rows})]


CHART = Chart(8, "c", "", "", "", (), lambda plan: [], of_series)


def report(**seconds):
    rows = []
    for job in range(4):
        for name, least in seconds.items():
            cost = spread(Cost(least, 1.02 * least, 1.05 * least, 5, 60))
            rows.append({"job": f"c/{job}", "series": name, "label": name, "panel": "p", "cost": cost})
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
    found = changes(report(a=1.0, b=2.0, c=3.0), report(a=1.3, b=2.6, c=7.8), (CHART,))
    assert found["c", "c"].ratio == 2.0 and found["c", "a"].ratio == found["c", "b"].ratio == 1.0
    assert [name for name, change in found.items() if change.slower] == [("c", "c")]


def test_what_has_nothing_beside_it_and_what_is_one_row_is_not_judged():
    two, three = report(a=1.0, b=2.0), report(a=1.0, b=2.0, c=3.0)
    assert not changes(two, report(a=1.0, b=4.0), (CHART,))
    once = {"c": three["c"][:3]}
    assert not changes(once, report(a=1.0, b=2.0, c=9.0), (CHART,))


def test_in_a_kept_report_the_series_that_was_slowed_down_is_named_and_no_other():
    """Compared with a copy in which one series is 1.5 times slower, exactly this series is reported.

    The copy simulates a second run: the times of each job are longer by a common factor of 1 to 1.5, and each time
    varies by up to 4 %.
    """
    kept, chance = read()["rows"], Random(5)
    kept_charts = [chart for chart in charts() if not chart.of]

    def again(slowed):
        second, load = deepcopy(kept), {}
        for key, rows in second.items():
            for row in rows:
                here = load.setdefault(row["job"], chance.uniform(1.0, 1.5))
                factor = here * chance.uniform(0.96, 1.04) * (1.5 if (key, row["series"]) == slowed else 1.0)
                for cost in row.values():
                    if isinstance(cost, dict) and "seconds" in cost:
                        cost["seconds"] = [each * factor for each in cost["seconds"]]
        return [name for name, change in changes(kept, second, kept_charts).items() if change.slower]

    for slowed in (("broadphases", "sweep"), ("tiers", "capsule"), ("solvers", "sequential_impulse"), None):
        assert again(slowed) == ([slowed] if slowed else [])


def test_a_folder_without_a_report_is_named(tmp_path, capsys):
    assert main(tmp_path, tmp_path) == 2
    assert str(tmp_path / "data" / "tiers.json") in capsys.readouterr().err
