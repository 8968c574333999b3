"""The static types of arrays and keywords agree with the tables, and physics does not need pygame."""

import subprocess
import sys
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from physics import BROADPHASES, SOLVERS, TIERS, annotations
from physics.edit import BodyDef
from physics.joint import JOINT_SOLVERS
from physics.tables import columns
from physics.tables.body import BODY, CONTINUOUS, DYNAMIC, KINDS, KINEMATIC, STATIC
from physics.tables.contact import CONTACT_POINT, EVENT, HIT, QUARANTINE
from physics.tables.joint import BROKEN, JOINT
from physics.world import Definition

ROOT = Path(__file__).resolve().parents[2]
ROWS = {
    "Body": BODY, "Contact": CONTACT_POINT, "Event": EVENT, "Hit": HIT, "Quarantine": QUARANTINE, "Joint": JOINT,
    "Broken": BROKEN,
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
def test_the_named_columns_are_those_of_the_table(name):
    """The column types in physics/tables/columns.py list exactly the columns of each table.

    A new column must be added there, in the list of its type.
    """
    dtype, kinds = ROWS[name], {"f": [], "i": [], "b": [], "U": []}
    for column in dtype.names:
        kinds[dtype[column].kind].append(column)
    named = [get_args(each) for each in get_args(getattr(columns, f"{name}Rows"))]
    assert {kind: set(found) for kind, found in zip(kinds, named, strict=True)} == {k: set(v) for k, v in kinds.items()}


def test_the_words_are_those_of_the_tables():
    assert get_args(annotations.KindName) == KINDS and (KINDS[STATIC], KINDS[DYNAMIC]) == ("static", "dynamic")
    assert KINDS[KINEMATIC] == "kinematic"
    assert set(get_args(annotations.ContinuousName)) == set(CONTINUOUS)
    assert get_args(annotations.SolverName) == SOLVERS and get_args(annotations.TierName) == TIERS
    assert get_args(annotations.JointSolverName) == JOINT_SOLVERS
    assert get_args(annotations.BroadphaseName) == tuple(BROADPHASES)
    assert all(made.name == name for name, made in BROADPHASES.items())


def test_the_arguments_of_add_bodies_are_those_of_add_body():
    assert tuple(Definition.__annotations__) == BodyDef._fields


def test_the_typed_rows_behave_as_arrays():
    """The typed row classes behave as arrays when a user views an array as one of them."""
    rows = np.zeros(3, EVENT).view(columns.Rows)
    rows["point_x"] = 2.0
    rows[1] = rows[0]
    assert rows["point_x"].tolist() == [2.0] * 3 and [each["body_a"] for each in rows] == [0, 0, 0]
    row = np.zeros(1, np.dtype((columns.Row, EVENT)))[0]
    row["body_a"] = 4
    assert row["body_a"] == 4


def test_physics_is_imported_without_pygame():
    code = (
        "import sys; sys.modules['pygame'] = None\n"
        "from physics import *\n"
        "w = World(broadphase='tree'); w.add_body(Circle(3), position=Vec2(1, 2)); w.step(); print(w)\n"
        "try: w.add_body(7)\n"
        "except TypeError as error: print(error)"
    )
    ran = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "write Circle(7)" in ran.stdout and "World(1 bodies" in ran.stdout
