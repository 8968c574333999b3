"""The stored record of the benchmarks: its form, its comparison and its command line. No timing is done here."""

import json
import platform

import pytest

from game import VERSION
from tests.bench import __main__ as command
from tests.bench import broadphase, record
from tests.bench.timing import best_in_turns, table

RATIOS = {"masks": {"hash / collidelistall": 0.0401234}, "solvers": {"soft_step 4 / pymunk": 1.25, "other": 2.0}}


@pytest.fixture
def reported(monkeypatch):
    """Replace the benchmarks by functions that return RATIOS immediately and print a line."""

    def measured(names, quick):
        print("a table")
        return {name: RATIOS.get(name, {}) for name in names}

    monkeypatch.setattr(command, "measured", measured)


def test_a_record_has_ratios_and_the_machine_but_not_its_name():
    made = record.to_record(RATIOS, quick=False)
    assert made["version"] == VERSION and made["quick"] is False
    assert made["ratios"]["masks"] == {"hash / collidelistall": 0.04012}, "four digits"
    assert set(made["machine"]) >= {"cpu", "cores", "system", "python", "numpy"}
    assert made["machine"]["cpu"] and made["machine"]["cores"] >= 1
    assert platform.node() not in record.to_text(made) or len(platform.node()) < 3
    assert json.loads(record.to_text(made)) == made


def test_json_is_all_that_is_printed(reported, capsys):
    assert command.main(["--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["ratios"] == {
        "masks": {"hash / collidelistall": 0.04012},
        "broadphase": {},
        "solvers": RATIOS["solvers"],
        "moving": {},
    }
    assert "a table" in said.err


def test_a_kept_file_is_compared_and_what_moved_is_flagged(reported, tmp_path, capsys):
    kept = tmp_path / "kept.json"
    assert command.main(["--json", str(kept)]) == 0
    changed = record.read_record(kept)
    changed["ratios"]["solvers"] = {"soft_step 4 / pymunk": 1.0, "gone": 3.0}
    changed["ratios"]["masks"]["hash / collidelistall"] = 0.0385
    kept.write_text(json.dumps(changed))
    capsys.readouterr()
    assert command.main(["--compare", str(kept)]) == 0, "speed is told, not tested"
    lines = {line.split("  ")[0]: line.split() for line in capsys.readouterr().out.splitlines() if ": " in line}
    assert lines["solvers: soft_step 4 / pymunk"][-5:] == ["1", "1.25", "+25.0", "%", "slower"]
    assert lines["masks: hash / collidelistall"][-3:] == ["0.04012", "+4.2", "%"]
    assert lines["solvers: gone"][-3:] == ["-", "not", "measured"] and lines["solvers: other"][-1] == "new"


@pytest.mark.parametrize("change", [-10.0, -4.9, 4.9])
def test_five_percent_are_noise(change):
    kept = {"ratios": {"masks": {"x": 100.0}}}
    row = record.compared(kept, {"ratios": {"masks": {"x": 100.0 + change}}})[0]
    assert row[3].endswith("faster") == (change < -5.0) and not row[3].endswith("slower")


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"ratios": {"masks": {"a": "b"}}}', '{"ratios": {"masks": {"a": 0}}}']
)
def test_a_file_that_is_no_record_is_refused_before_anything_is_measured(text, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "measured", None)
    path = tmp_path / "kept.json"
    path.write_text(text)
    assert command.main(["--compare", str(path)]) == 2 and "is no record of ratios" in capsys.readouterr().err
    assert command.main(["--compare", str(tmp_path / "absent.json")]) == 2


def test_kept_records_can_be_read():
    for path in record.KEPT.glob("*.json"):
        kept = record.read_record(path)
        assert kept["version"] == path.stem and not kept["quick"] and set(kept["ratios"]) == set(command.NAMES)


def test_without_a_peer_it_says_what_to_install(monkeypatch, capsys):
    def measured(names, quick):
        raise ModuleNotFoundError("No module named 'pymunk'")

    monkeypatch.setattr(command, "measured", measured)
    assert command.main([]) == 2 and '".[bench]"' in capsys.readouterr().err


def test_broad_phases_are_compared_with_brute_force():
    findings = broadphase.Findings()
    for moving in ("all moving", "nothing moving"):
        for size, brute, grid in ((100, 2e-5, 1e-5), (1000, 2e-3, 4e-4)):
            findings.keep(moving, "even", size, "brute", brute)
            findings.keep(moving, "even", size, "hash", grid)
        findings.keep(moving, "even", 50_000, "hash", 0.01)
    assert findings.ratios() == {"1000 bodies even, all moving: hash / brute": pytest.approx(0.2)}
    assert findings.fastest("all moving", "even", 1000) == "hash (5.0x)"
    assert broadphase.growth({100: 9.0, 1000: 1.0, 10_000: 10.0}) == pytest.approx(1.0)


def test_tables_are_aligned(capsys):
    table("Title", ("a", "bb"), [("long name", 1), ("b", 22)])
    assert capsys.readouterr().out == "\nTitle\na          bb\nlong name   1\nb          22\n"


def test_all_are_measured_in_every_round():
    called = []
    times = {"a": iter((3.0, 1.0, 2.0)), "b": iter((5.0, 6.0, 4.0))}
    timed = {name: lambda name=name: called.append(name) or next(times[name]) for name in times}
    assert best_in_turns(3, timed) == {"a": 1.0, "b": 4.0}
    assert called == ["a", "b"] * 3
