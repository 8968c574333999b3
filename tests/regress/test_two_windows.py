"""With two windows open, saving the high scores of one keeps those of the other."""

from game.files.records import Entry, load_records


def entry(points, name="AAA"):
    return Entry(name, points, 60.0, "2026-11-21")


def test_both_windows_keep_their_places(tmp_path):
    path = tmp_path / "records.json"
    (first, _), (second, _) = load_records(path), load_records(path)
    first.add("shooter", "points", entry(500, "ONE"))
    first.add("maze", "seconds", entry(1, "ONE"))
    assert first.save() == ""
    second.add("shooter", "points", entry(700, "TWO"))
    second.add("shooter", "points", entry(300, "TWO"))
    assert second.save() == ""
    found = load_records(path)[0].tables
    assert [each.name for each in found["shooter"]] == ["TWO", "ONE", "TWO"] and [
        each.name for each in found["maze"]
    ] == ["ONE"]
    first.save()
    assert load_records(path)[0].tables == found


def test_what_another_program_wrote_meanwhile_is_kept_beside(tmp_path):
    path = tmp_path / "records.json"
    records, _ = load_records(path)
    records.add("shooter", "points", entry(500))
    path.write_text('{"version": 99}')
    assert "kept as records.json.newer-1" in records.save()
    assert (tmp_path / "records.json.newer-1").read_text() == '{"version": 99}'
    assert load_records(path)[0].best("shooter").points == 500


def test_ten_places_are_ten(tmp_path):
    path = tmp_path / "records.json"
    (first, _), (second, _) = load_records(path), load_records(path)
    for number in range(8):
        first.add("shooter", "points", entry(100 + number))
        second.add("shooter", "points", entry(200 + number))
    first.save()
    second.save()
    assert [each.points for each in load_records(path)[0].entries("shooter")] == [*range(207, 199, -1), 107, 106]
