"""The table of rows, the tests and the page docs/stability.md agree."""

import ast
import math
from pathlib import Path

import pytest

from tests.stability.page import PAGE, kept_figures, page
from tests.stability.rows import ROWS, SECTIONS
from tests.stability.rows.row import SENSES, Row, Section, at_least, at_most, exactly
from tests.stability.settings import DEFAULTS, FOUR

HERE = Path(__file__).parent


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.letter)
def test_every_row_of_the_catalogue_is_there_in_its_order(section):
    assert [row.id for row in section.rows] == section.ids


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.letter)
def test_every_row_has_its_test_in_a_file_of_its_section(section):
    paths = list(HERE.glob(f"test_{section.letter.lower()}_*.py"))
    trees = [ast.parse(path.read_text()) for path in paths]
    tests = [node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    for row in section.rows:
        has = any(name.startswith(f"test_{row.id.lower()}_") for name in tests)
        assert has != bool(row.absent), row.id


@pytest.mark.parametrize("row", ROWS.values(), ids=lambda row: row.id)
def test_rows_say_what_they_are(row):
    assert row.case and row.source and bool(row.limits) != bool(row.absent)
    assert len({each.figure for each in row.limits}) == len(row.limits)
    assert all(each.sense in SENSES and math.isfinite(each.value) for each in row.limits)


@pytest.mark.parametrize("row", [row for row in ROWS.values() if not row.absent], ids=lambda row: row.id)
def test_kept_values_are_within_their_limits_unless_a_fault_is_told(row):
    kept = kept_figures()[FOUR][row.id]
    assert set(kept) == {each.figure for each in row.limits}
    assert all(each.met(kept[each.figure]) for each in row.limits) != bool(row.fault)


@pytest.mark.parametrize("row", kept_figures()[DEFAULTS])
def test_kept_values_by_default_are_within_their_limits(row):
    for figure, value in kept_figures()[DEFAULTS][row].items():
        assert ROWS[row].limit(figure, True).met(value), figure


@pytest.mark.parametrize("row", [row for row in ROWS.values() if row.defaults], ids=lambda row: row.id)
def test_limits_by_default_lie_within_twice_the_measured_value(row):
    kept = kept_figures()[DEFAULTS][row.id]
    for limit in row.defaults:
        assert limit.sense != "<=" or limit.value <= 2.0 * kept[limit.figure], limit.figure


def test_the_catalogue_is_whole():
    assert [section.letter for section in SECTIONS] == list("ABCDEFGHIJKLMN")
    assert len(ROWS) == sum(len(section.numbers) for section in SECTIONS) == 181


def test_nothing_is_kept_of_rows_that_there_are_not():
    assert set(kept_figures()[FOUR]) == {row.id for row in ROWS.values() if not row.absent}
    assert set(kept_figures()[DEFAULTS]) <= set(kept_figures()[FOUR])


def test_page_is_what_the_generator_makes():
    assert PAGE.read_text(encoding="utf-8") == page()


def test_limits_worst_values_and_margins():
    most, least, one = at_most("depth", 2.0, "m"), at_least("share", 0.5), exactly("count", 3)
    assert most.met(2.0) and not most.met(2.1) and not most.met(math.nan) and most.worse(1.0, 1.5) == 1.5
    assert least.met(0.5) and not least.met(0.4) and least.worse(0.9, 0.6) == 0.6
    assert one.met(3) and not one.met(4) and one.worse(3, 1) == 1 and math.isnan(most.worse(1.0, math.nan))
    assert [most.near(0.5).value, most.near(1.5).value, most.near(0.0).value, most.near(1e-9).value] == [
        1.0,
        2.0,
        2.0,
        2e-3,
    ]
    assert [least.near(1.6).value, least.near(0.9).value, one.near(3).value] == [0.8, 0.5, 3]
    assert [most.margin(0.5), most.margin(0.0), most.margin(3.0)] == ["4×", "> 1000×", "outside"]
    assert [least.margin(1.0), one.margin(3), one.margin(2)] == ["2×", "exact", "outside"]


def test_page_has_a_line_for_every_figure_and_says_why_there_is_none():
    rows = (
        Row("Z1", "a | b", (at_most("depth", 2.0, "m"), exactly("hits", 1)), "nobody", "9 m"),
        Row("Z2", "rope", (), "nobody", absent="there are none"),
        Row("Z3", "sag", (at_most("sag", 1.0),), "nobody", fault="too soft"),
    )
    found = page(
        [Section("Z", "Odd", (1, 2, 3), rows)],
        {FOUR: {"Z1": {"depth": 0.5, "hits": 1}, "Z3": {"sag": 2}}, DEFAULTS: {"Z1": {"depth": 1.0}}},
    )
    for line in (
        "## Z. Odd",
        "## Faults",
        "## What the suite found",
        "| Z1 | a \\| b | depth <= 2 m | 0.5 m | 4× | 1 m | 2× | 9 m | nobody |",
        "|  |  | hits == 1 | 1 | exact | – | – |  |  |",
        "| Z2 | rope | – | does not apply: there are none | – | – | – |  | nobody |",
        "| Z3 | sag | sag <= 1 | 2 | outside | – | – |  | nobody |\n| | **open:** too soft | | | | | | | |",
    ):
        assert line in found
