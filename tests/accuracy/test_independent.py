"""The main charts of the report, compared with values and ratios of times from other programs."""

import pytest

pytest.importorskip("shapely")
from tests.accuracy import independent, independent_times  # noqa: E402
from tests.accuracy.independent import CHARTS, Point, interval  # noqa: E402


@pytest.mark.parametrize("chart", CHARTS)
def test_three_points_of_each_chart_are_what_others_compute(chart):
    points = [*CHARTS[chart]()]
    assert len(points) == 3
    assert all(point.agrees for point in points), [point for point in points if not point.agrees]


@pytest.mark.parametrize("chart", CHARTS)
def test_a_report_that_is_wrong_by_a_fifth_is_found(chart, monkeypatch):
    """A report in which every value is one fifth too large is found to be wrong."""

    def larger(value):
        if isinstance(value, bool) or value is None:
            return value
        if isinstance(value, dict):
            return {name: larger(each) for name, each in value.items()}
        if isinstance(value, list) and len(value) == 2 and all(isinstance(each, int) for each in value):
            return [round(1.2 * value[0]) + 1, value[1]]  # a count of a total
        if isinstance(value, list):
            return [larger(each) for each in value]
        return 1.2 * value if isinstance(value, float) else value

    wrong = {name: [larger(each) for each in rows] for name, rows in independent.kept().items()}
    for mine, its in zip(wrong["continuous"], independent.kept()["continuous"], strict=True):
        mine["ratio"] = its.get("ratio")  # it selects the rows
    monkeypatch.setattr(independent, "kept", lambda: wrong)
    points = [*CHARTS[chart]()]
    assert not all(point.agrees for point in points)


def test_points_and_intervals():
    assert Point("", 1.0, 1.1, 0.2).agrees and not Point("", 1.0, 1.1, 0.05).agrees
    middle, half = interval(50, 100)
    assert middle == pytest.approx(0.5) and 0.1 < half < 0.2
    assert interval(0, 100)[0] > 0.0


@pytest.mark.parametrize("count", independent_times.COUNTS)
def test_the_ratio_of_chart_14_has_a_kept_value_beside_it(count):
    low, middle, high = independent_times.kept_ratio(count)
    assert 0.0 < low <= middle <= high


@pytest.mark.parametrize("count", [20, 60])
def test_the_second_program_finds_the_same_hits_and_a_ratio(count):
    """All frames of a round are compared, so that both programs do the same work."""
    assert independent_times.ratio_here(count, rounds=1) > 0.0


def test_programs_that_find_other_hits_are_not_timed(monkeypatch):
    monkeypatch.setattr(independent_times.Sky, "in_pygame", lambda sky: lambda frame: set())
    with pytest.raises(ValueError, match="frame 1 of 60 sprites"):
        independent_times.ratio_here(60, rounds=1)
