"""The table of faults names only existing tests, and every test in this folder is in the table."""

import ast
from pathlib import Path

import pytest

from tests.stability.faults.table import FAULTS, HERE, ROOT, section

ROWS = [each for faults in FAULTS.values() for each in faults]


def functions(path):
    """Return the names of the test functions in a file."""
    tree = ast.parse((ROOT / path).read_text())
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")}


@pytest.mark.parametrize("row", ROWS, ids=[each.fault[:40] for each in ROWS])
def test_the_test_of_a_row_exists(row):
    path, _, function = row.test.partition("::")
    assert (ROOT / path).is_file() and (not function or function in functions(path)), row.test


def test_every_file_of_faults_is_in_the_table():
    there = {path.name for path in Path(ROOT / HERE).glob("test_*.py")} - {"test_table.py"}
    assert there == {Path(row.test.partition("::")[0]).name for row in ROWS if row.test.startswith(HERE)}


def test_the_section_has_a_line_for_each_fault_and_whole_tables():
    text = section()
    assert text.startswith("## Faults\n") and all(f"| {row.fault} | {row.gets} |" in text for row in ROWS)
    assert all(line.count(" | ") == 2 for line in text.splitlines() if line.startswith("| "))
