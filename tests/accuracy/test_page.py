"""docs/accuracy.md agrees with docs/accuracy.json, and each plot shows all its dots."""

import re
import xml.etree.ElementTree as ElementTree

import pytest

from game.report.charts import CHARTS
from game.report.claim import FAILS, HOLDS, TIE
from tests.accuracy.__main__ import replaced
from tests.accuracy.page import DOCS, PAGE, PLOTS, STORY, charts, dots, read, text, total_seconds


@pytest.fixture(scope="module")
def kept():
    return read()


def test_the_page_is_what_the_kept_rows_say(kept):
    assert PAGE.read_text(encoding="utf-8") == text(kept), "make it again: python -m tests.accuracy DIR"


@pytest.mark.parametrize("chart", charts(), ids=lambda chart: chart.key)
def test_each_plot_shows_every_dot(kept, chart):
    shown = dots(kept, chart)
    path = PLOTS / f"{chart.key}.svg"
    ids = {each.get("id") for each in ElementTree.parse(path).iter()}
    assert len(shown) > 2 and {f"{chart.key}-{k}" for k in range(len(shown))} <= ids
    assert f"{chart.key}-{len(shown)}" not in ids
    assert "var(--ink)" in path.read_text(encoding="utf-8")


def test_a_chart_that_is_measured_apart_names_its_machine(kept):
    machine = {"cpu": "of another kind"}
    one = replaced(kept, {"far": kept["rows"]["far"][:1]}, {"seconds": 7, "machine": machine})
    assert one["rows"].keys() == kept["rows"].keys() and len(one["rows"]["far"]) == 1
    assert one["rows"]["tiers"] is kept["rows"]["tiers"] and one["machine"] == kept["machine"]
    assert text(one).count("Measured apart, in 7 s (cpu of another kind).") == 1
    assert total_seconds(one) == total_seconds(kept) + 7


@pytest.mark.parametrize("chart", CHARTS, ids=lambda chart: chart.key)
def test_every_chart_of_the_report_is_on_the_page(chart):
    """No chart is left out without a word."""
    page = PAGE.read_text(encoding="utf-8")
    assert f"## {chart.number}. {chart.title}" in page and f"(accuracy/{chart.key}.svg)" in page


def test_there_are_sixteen_and_each_claims_something(kept):
    assert len(STORY) == 16 == len(charts()) == len(CHARTS)
    assert len(re.findall(r"!\[", PAGE.read_text(encoding="utf-8"))) == 16
    verdicts = {claim.verdict for chart in charts() for claim in chart.claims(kept["rows"][chart.of or chart.key])}
    assert verdicts >= {HOLDS, FAILS, TIE}, "what does not hold is told too"


def test_the_readme_has_a_plot_of_it_under_its_own_heading():
    sections = (DOCS.parent / "README.md").read_text(encoding="utf-8").split("\n## ")
    (headline,) = (each for each in sections if each.startswith("What accuracy costs\n"))
    assert "docs/accuracy/tiers.svg" in headline and "docs/accuracy.md" in headline
    assert sections.index(headline) <= 2, "after the game, before everything else"
