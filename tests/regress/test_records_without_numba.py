"""The benchmark record is written in an environment without numba.

Before the fix it raised PackageNotFoundError when it summed the sizes of the installed libraries.
"""

from importlib import metadata

import pytest

from tests.bench import record


@pytest.fixture
def without(monkeypatch):
    """Return a function that hides the distributions with these names from importlib.metadata."""
    there = metadata.distribution

    def leave_out(*names):
        def found(name):
            if name in names:
                raise metadata.PackageNotFoundError(name)
            return there(name)

        monkeypatch.setattr(metadata, "distribution", found)

    return leave_out


def test_a_record_is_made_without_numba(without):
    whole = record.installed()
    without("numba", "llvmlite")
    made = record.to_record({"masks": {"a": 1.0}}, quick=True)
    assert "numba" not in made["machine"], "metadata.version asks the same function"
    assert 0 < made["installed_mb"] and record.installed() <= whole


def test_what_is_not_there_weighs_nothing(without):
    without(*record.LIBRARIES)
    assert record.installed() == 0
