"""Each kind of change changes one operator of one kernel, the same one for the same seed."""

import ast
from pathlib import Path

import pytest

from tests.mutants.operators import KINDS, change, find_kernel, places
from tests.mutants.table import EQUIVALENT, MUTANTS
from tests.mutants.trial import ROOT, ids_of

SOURCE = '''"""A module."""

LIMIT = 5


@subkernel
def reach(a, b):
    """Say how far 1 + 1 reaches."""
    if a < b and b == 2:
        a += min(-b, 0.5) * 3
    return a


def make(flag):
    @kernel
    def inner(values):
        """A kernel that a factory makes."""
        return values[0] - 1

    return inner


def reach_out(a):
    return a + 1
'''


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "deeper").mkdir()
    (tmp_path / "deeper" / "module.py").write_text(SOURCE)
    return tmp_path


@pytest.mark.parametrize(
    "kind, before, after",
    [
        ("edge", "if a < b and b == 2:", "if a <= b and b == 2:"),
        ("sign", "a += min(-b, 0.5) * 3", "a -= min(-b, 0.5) * 3"),
        ("factor", "a += min(-b, 0.5) * 3", "a += min(-b, 0.5) / 3"),
        ("side", "a += min(-b, 0.5) * 3", "a += max(-b, 0.5) * 3"),
        ("both", "if a < b and b == 2:", "if a < b or b == 2:"),
        ("minus", "a += min(-b, 0.5) * 3", "a += min(+b, 0.5) * 3"),
    ],
)
def test_one_operator_is_changed(folder, kind, before, after):
    made = change(folder, "reach", kind, 1)
    assert (made.before, made.after, made.path) == (before, after, folder / "deeper" / "module.py")
    tree = ast.unparse(ast.parse(SOURCE))
    assert tree.count(before) == 1 and ast.unparse(ast.parse(made.source)) == tree.replace(before, after)


@pytest.mark.parametrize("kind, afters", [("turn", {"if a > b and b == 2:", "if a < b and b != 2:"})])
def test_seeds_pick_among_the_places(folder, kind, afters):
    assert {change(folder, "reach", kind, seed).after for seed in range(20)} == afters
    assert change(folder, "reach", kind, 3) == change(folder, "reach", kind, 3)


def test_numbers_grow(folder):
    found = {change(folder, "reach", "number", seed).after for seed in range(30)}
    assert found == {"if a < b and b == 3:", "a += min(-b, 0.75) * 3", "a += min(-b, 0.5) * 4"}


def test_a_kernel_of_a_factory_is_found_and_stays_where_it_is(folder):
    made = change(folder, "inner", "sign", 1)
    assert made.before == "return values[0] - 1" and "        return values[0] + 1\n" in made.source
    assert ast.dump(ast.parse(made.source)) == ast.dump(ast.parse(SOURCE.replace("[0] - 1", "[0] + 1")))


@pytest.mark.parametrize("name", ["reach_out", "nowhere"])
def test_what_is_no_kernel_is_not_changed(folder, name):
    with pytest.raises(LookupError, match=f"0 kernels called {name}"):
        change(folder, name, "sign", 1)


def test_two_kernels_of_a_name_are_refused(folder):
    (folder / "other.py").write_text(SOURCE)
    with pytest.raises(LookupError, match="2 kernels called reach"):
        change(folder, "reach", "sign", 1)


def test_a_kind_without_a_place_is_refused(folder):
    with pytest.raises(LookupError, match="inner has no place for a change of kind 'both'"):
        change(folder, "inner", "both", 1)


def test_the_table_holds_twenty_different_mutants_of_kernels_that_are_there():
    made = {(each.path, each.line, each.after) for each in (change(ROOT / "physics", *m.key) for m in MUTANTS)}
    assert len(made) == len(MUTANTS) >= 20
    assert {mutant.kind for mutant in MUTANTS} >= set(KINDS) - {"number"}
    assert not EQUIVALENT.keys() & {mutant.key for mutant in MUTANTS}
    assert all(change(ROOT / "physics", *key).before != change(ROOT / "physics", *key).after for key in EQUIVALENT)
    for mutant in MUTANTS:
        assert places(find_kernel(ROOT / "physics", mutant.kernel)[2], mutant.kind)
        assert all((ROOT / each.split("::")[0]).is_file() for each in ids_of(mutant.tests))


def test_a_test_that_is_not_there_is_named():
    with pytest.raises(LookupError, match="no test called test_of_nothing_at_all"):
        ids_of(["test_of_nothing_" + "at_all"])
    assert Path(__file__).relative_to(ROOT).as_posix() + "::test_numbers_grow" in ids_of(["test_numbers_grow"])
