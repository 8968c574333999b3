"""The tests named in the table detect each mutant, and pass without it."""

import pytest

from tests.mutants.operators import change
from tests.mutants.table import MUTANTS
from tests.mutants.trial import copy_sources, run_tests

pytestmark = pytest.mark.nightly
PASSED, FAILED = 0, 1  # exit codes of pytest; others say that nothing was tested


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """Return a folder with a copy of the sources, in which one file at a time is changed."""
    return copy_sources(tmp_path_factory.mktemp("mutants"))


def test_the_named_tests_pass_as_long_as_nothing_is_changed(copy):
    names = sorted({name for mutant in MUTANTS for name in mutant.tests})
    for name in names:
        code, output = run_tests(copy, [name])
        assert code == PASSED and "100%" in output, output


@pytest.mark.parametrize("mutant", MUTANTS, ids=str)
def test_a_mutant_is_caught(copy, mutant):
    made = change(copy / "physics", *mutant.key)
    sound = made.path.read_text()
    made.path.write_text(made.source)
    try:
        code, output = run_tests(copy, mutant.tests)
    finally:
        made.path.write_text(sound)
    assert code == FAILED, f"{made.path.name}:{made.line}: `{made.after}` for `{made.before}` is not caught\n{output}"
