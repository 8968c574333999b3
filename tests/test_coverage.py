"""docs/coverage.md matches the stored measurement: enough lines are run by tests, and all others have a reason."""

import copy

from tests import coverage


def kept():
    return coverage.kept()


def test_enough_lines_are_run_and_each_other_one_is_explained():
    assert coverage.share(kept()) >= coverage.ASKED
    assert not coverage.unexplained(kept())


def test_the_page_is_of_what_was_measured():
    assert coverage.PAGE.read_text(encoding="utf-8") == coverage.page(kept())
    assert all((coverage.ROOT / path).is_file() for path in kept())


def test_a_hole_is_named_and_a_line_that_any_run_met_is_none():
    files = copy.deepcopy(kept())
    files["physics/math2d.py"]["missing"] = [[7, "x = 8"]]
    assert coverage.unexplained(files) == ["physics/math2d.py:7: x = 8"] and "**no reason given**" in coverage.page(
        files
    )
    one = {"files": {"physics/math2d.py": {"executed_lines": [1, 3], "missing_lines": [5]}}}
    other = {"files": {"physics/math2d.py": {"executed_lines": [5], "missing_lines": [1, 9]}}}
    (found,) = coverage.merged([one, other]).values()
    assert found["lines"] == 4 and [number for number, _ in found["missing"]] == [9]
