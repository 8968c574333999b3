"""High scores and ghosts: sorted, ten at most, and robust against any content of the file."""

import json

import pytest

from game.files.best_run import ghost_path, keep_ghost, load_ghost
from game.files.records import PLACES, Entry, load_records, table_of
from game.scene import Result


def entry(points=100, seconds=60.0, name="EVA", **more):
    return Entry(name, points, seconds, "2026-01-31", **more)


def test_most_points_first_and_then_the_faster():
    records, message = load_records()
    assert message == ""
    for points, seconds in ((100, 60.0), (300, 50.0), (100, 40.0), (200, 10.0)):
        records.add("shooter", "points", entry(points, seconds))
    assert [(e.points, e.seconds) for e in records.entries("shooter")] == [
        (300, 50.0),
        (200, 10.0),
        (100, 40.0),
        (100, 60.0),
    ]


def test_least_time_first():
    records, _ = load_records()
    places = [records.add("platformer", "seconds", entry(5, seconds)) for seconds in (60.0, 50.0, 55.0, 50.0)]
    assert places == [1, 1, 2, 2], "an equal time comes after the one that was there first"


def test_ten_places_and_no_more():
    records, _ = load_records()
    places = [records.add("shooter", "points", entry(points)) for points in range(1, 15)]
    assert places == [1] * 14
    assert len(records.entries("shooter")) == PLACES
    assert records.place("shooter", "points", entry(5)) is None and records.add("shooter", "points", entry(5)) is None


def test_who_ranks():
    assert Result(False, 10, 5.0).ranks("points") and not Result(True, 0, 5.0).ranks("points")
    assert Result(True, 0, 5.0).ranks("seconds") and not Result(False, 10, 5.0).ranks("seconds")
    assert not Result(True, 10, 5.0).ranks(None)


def test_a_level_of_one_s_own_has_its_own_table(tmp_path):
    level = tmp_path / "a.tmj"
    level.write_text("1")
    first = table_of("platformer", level)
    level.write_text("2")
    assert table_of("platformer") == "platformer" != first != table_of("platformer", level)


def test_saved_tables_come_back():
    records, _ = load_records()
    records.add("shooter", "points", entry(7, 3.25, seed=4, assisted=True))
    records.save()
    again, message = load_records()
    assert message == "" and again.tables == records.tables


GOOD = {"name": "EVA", "points": 1, "seconds": 2.0, "date": "2026-01-31", "seed": 0, "assisted": False}
DAMAGE = [
    ("{", "line 1"),
    ("[]", "version"),
    ('{"version": 1}', "tables"),
    ('{"version": 1, "tables": {"shooter": 3}}', "tables.shooter"),
    *(
        (json.dumps({"version": 1, "tables": {"shooter": [GOOD, {**GOOD, **bad}]}}), r"tables.shooter[1]")
        for bad in (
            {"name": "TOOLONG"},
            {"name": 3},
            {"points": -1},
            {"points": 1.5},
            {"seconds": float("nan")},
            {"seconds": "1"},
            {"date": 5},
            {"assisted": 1},
            {"more": 1},
        )
    ),
]


@pytest.mark.parametrize("text, place", DAMAGE)
def test_damage_is_named_and_kept(tmp_path, text, place):
    path = tmp_path / "records.json"
    path.write_text(text)
    records, message = load_records()
    assert place in message and "kept as records.json." in message
    assert records.entries("shooter") == ([Entry(**GOOD)] if "EVA" in text else [])
    records.save()
    assert [kept.read_text() for kept in tmp_path.glob("records.json.*")] == [text]


def test_a_newer_file_is_refused_and_kept(tmp_path):
    text = json.dumps({"version": 2, "tables": {}})
    (tmp_path / "records.json").write_text(text)
    records, message = load_records()
    assert "version: 2 cannot be read here" in message and "newer-1" in message
    records.add("shooter", "points", entry())
    records.save()
    assert (tmp_path / "records.json.newer-1").read_text() == text


TRAIL = [(1.0, 2.5, "run_0", 1), (2.0, 2.5, "run_1", -1)]


def test_the_fastest_run_is_the_ghost():
    assert keep_ghost("dash", TRAIL, 20.0) and not keep_ghost("dash", TRAIL[:1], 21.0)
    assert load_ghost("dash") == (TRAIL, 20.0, "")
    assert keep_ghost("dash", TRAIL[:1], 19.0)
    assert load_ghost("dash")[0] == TRAIL[:1]
    assert not keep_ghost("dash", [], 1.0)


@pytest.mark.parametrize(
    "change, place",
    [
        ({"version": 9}, "version"),
        ({"format": "x"}, "format"),
        ({"seconds": 0}, "seconds"),
        ({"rows": []}, "rows"),
        ({"rows": [[1, 2, "run_0", 1], [1, 2, 3, 4]]}, "rows[1]"),
        ({"rows": [[1e300, 2, "run_0", 1]]}, "rows[0]"),
        ({"rows": [[float("nan"), 2, "run_0", 1]]}, "rows[0]"),
    ],
)
def test_a_ghost_that_cannot_be_used_is_left_out_and_kept(change, place):
    keep_ghost("dash", TRAIL, 20.0)
    path = ghost_path("dash")
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    rows, seconds, message = load_ghost("dash")
    assert rows is None and seconds is None and place in message and "kept as dash.json." in message
    assert keep_ghost("dash", TRAIL, 30.0), "a run after that is the best again"
