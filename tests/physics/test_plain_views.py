"""Views of tables, as plain kernels get them, share memory and numbers with the table and keep nothing alive."""

import gc
import importlib
import pkgutil
import weakref

import numpy as np
import pytest

import physics
from physics.jit.plain import view_of


def _tables():
    """Return {name: dtype} of the row types in the modules of physics that have only numeric columns."""
    found = {}
    for module in pkgutil.walk_packages(physics.__path__, f"{physics.__name__}."):
        if module.name.startswith(f"{physics.__name__}.jit"):
            continue  # what compiles has no tables, and imports a compiler that need not be installed
        for name, value in vars(importlib.import_module(module.name)).items():
            if isinstance(value, np.dtype) and value.names:
                found.setdefault(value, name)
    return {name: dtype for dtype, name in found.items() if all(dtype[each].kind in "biuf" for each in dtype.names)}


TABLES = _tables()


def _any_rows(dtype, count):
    """Return rows with various values in each column: integer extremes, fractions, infinity and NaN."""
    rows = np.zeros(count, dtype)
    random = np.random.default_rng(3)
    for name in dtype.names:
        kind = dtype[name]
        if kind.kind == "f":
            rows[name] = random.choice([0.1, -0.0, np.inf, np.nan, 5e-324, 1.7e300], count).astype(kind)
        elif kind.kind == "b":
            rows[name] = random.integers(0, 2, count)
        else:
            extremes = (np.iinfo(kind).min, np.iinfo(kind).max, 1)
            rows[name] = [extremes[each] for each in random.integers(0, 3, count)]
    return rows


def _same(number, other):
    return type(number) is type(other) and (number == other or (number != number and other != other))


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("count", [0, 1, 7])
def test_a_row_reads_and_writes_the_table(name, count):
    rows = _any_rows(TABLES[name], count)
    others = np.zeros_like(rows)
    seen, written = view_of(rows), view_of(others)
    assert len(seen) == count
    for index in range(count):
        for column in rows.dtype.names:
            value = getattr(seen[index], column)
            assert _same(value, rows[column][index].item()), column
            setattr(written[index], column, value)
    for column in rows.dtype.names:  # the bytes between columns are undefined
        assert others[column].tobytes() == rows[column].tobytes(), column
    for index in (-1, count, count + 5):  # -1 stands for none in many columns
        with pytest.raises(IndexError, match=f"row {index} of a table of {count}"):
            seen[index]


def test_there_are_tables_to_be_seen():
    assert len(TABLES) > 20


@pytest.mark.parametrize("owns", [True, False])
def test_a_view_keeps_no_table_alive(owns):
    whole = np.zeros(8, [("x", np.float64)])
    rows = whole.copy() if owns else whole[2:5]
    view_of(rows)[0].x = 3.0
    assert view_of(rows)[0].x == rows["x"][0] == 3.0
    gone = weakref.ref(rows)
    memory = weakref.ref(whole)
    del rows, whole
    gc.collect()
    assert gone() is None and memory() is None


def test_another_table_in_its_place_is_not_mistaken_for_it():
    """A view of a new array is correct although the array may have the address of a freed one."""
    whole = np.zeros(1000, [("x", np.float64)])
    whole["x"] = np.arange(1000)
    for start in range(900):
        view = view_of(whole[start : start + 1 + start % 7])
        assert view[0].x == start and len(view) == 1 + start % 7


@pytest.mark.parametrize("column", [("x", "U4"), ("x", "O"), ("x", "M8[s]"), ("x", "c16")])
def test_a_table_with_other_columns_than_numbers_is_refused(column):
    with pytest.raises(TypeError, match="columns of numbers"):
        view_of(np.zeros(2, [column]))
