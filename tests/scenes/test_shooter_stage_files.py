"""Stage files: the game's own is valid, and every mistake gives an error with the file, the position and the reason."""

import pytest

from game.errors import FileError
from scenes.shooter.fleet import KINDS
from scenes.shooter.patterns import wall
from scenes.shooter.plane import CORE_RADIUS
from scenes.shooter.scene import Shooter
from scenes.shooter.stage import GROUNDS, ITEMS, KIND_NAMES, PATTERNS, load_stage, read_stage
from tests.scenes.shooter_stages import boss_stage, leader_of, own_stage, write

PHASE = ("events", -1, "phases", 0)
PATTERN = (*PHASE, "patterns", 0)
BOSS_AT = len(own_stage()["events"]) - 1
# what is broken: path in the file, new value (None: taken out), place that is named, words of the reason
MISTAKES = [
    (("format",), "lunch", "format", "hitbox stage"),
    (("version",), 2, "version", "newer than this game"),
    (("version",), "1", "version", "whole number"),
    (("title",), "", "title", "1..16 characters"),
    (("title",), 7, "title", "must be text"),
    (("name",), "Käse", "name", "ASCII"),
    (("colour",), "red", "colour", "unknown field; allowed: format"),
    (("events",), [], "events", "2..400 entries"),
    (("events",), {}, "events", "must be a list"),
    (("events", 0), 3, "events[0]", "must be an object"),
    (("events", 0, "event"), "backdorp", "events[0].event", "did you mean backdrop?"),
    (("events", 0, "event"), None, "events[0].event", "is missing"),
    (("events", 0, "ground"), "moon", "events[0].ground", "must be one of sea, coast, storm"),
    (("events", 0, "at"), 2.0, "events[1].at", "before that of the event above"),
    (("events", 1, "at"), True, "events[1].at", "must be a number (got True)"),
    (("events", 1, "at"), 1e9, "events[1].at", "0..600"),
    (("events", 1, "groups"), [], "events[1].groups", "1..8 entries"),
    (("events", 1, "groups", 0, "kind"), "zeppelin", "events[1].groups[0].kind", "must be one of dart"),
    (("events", 1, "groups", 0, "places"), ["left"], "events[1].groups[0].places[0]", "must be a number"),
    (("events", 1, "groups", 0, "places"), [0.5, 1.5], "events[1].groups[0].places[1]", "must be 0..1"),
    (("events", 1, "groups", 0, "every"), None, "events[1].groups[0].every", "is missing"),
    (("events", 1, "groups", 0, "sway"), 40, "events[1].groups[0].sway", "unknown field"),
    (("events", 1, "groups", 0, "carries"), "gold", "events[1].groups[0].carries", "power, bomb, life"),
    (("events", -1, "event"), "midboss", f"events[{BOSS_AT}].phases", "must have 1 entries"),
    (("events", -1, "name"), None, f"events[{BOSS_AT}].name", "is missing"),
    (("events", -1, "phases"), [], f"events[{BOSS_AT}].phases", "1..3 entries"),
    ((*PHASE, "health"), -4, f"events[{BOSS_AT}].phases[0].health", "must be 1..5000"),
    ((*PHASE, "seconds"), 1e400, f"events[{BOSS_AT}].phases[0].seconds", "must be a number"),
    ((*PHASE, "bonus"), 10.5, f"events[{BOSS_AT}].phases[0].bonus", "whole number"),
    ((*PHASE, "move"), "left", f"events[{BOSS_AT}].phases[0].move", "must be an object with across, down, seconds"),
    ((*PATTERN, "shoot"), "laser", f"events[{BOSS_AT}].phases[0].patterns[0].shoot", "aimed, fan, ring"),
    ((*PATTERN, "bullet"), "shot", f"events[{BOSS_AT}].phases[0].patterns[0].bullet", "red, purple"),
    ((*PATTERN, "count"), 65, f"events[{BOSS_AT}].phases[0].patterns[0].count", "1..64"),
    ((*PATTERN, "every"), 0.0, f"events[{BOSS_AT}].phases[0].patterns[0].every", "0.03..30"),
    ((*PATTERN, "muzzles"), [[1]], f"events[{BOSS_AT}].phases[0].patterns[0].muzzles[0]", "must have 2 entries"),
    ((*PATTERN, "gap"), 40, f"events[{BOSS_AT}].phases[0].patterns[0].gap", "unknown field"),
]


def broken(path, way, value):
    """Write the game's stage with one value changed, and return its path.

    way: keys and indices to the value. value: None deletes it.
    """
    data = own_stage()
    at = data
    for step in way[:-1]:
        at = at[step]
    if value is None:
        del at[way[-1]]
    else:
        at[way[-1]] = value
    return write(path, data)


@pytest.mark.parametrize(("way", "value", "place", "reason"), MISTAKES, ids=lambda value: str(value)[:40])
def test_a_mistake_is_named_with_file_place_and_reason(tmp_path, way, value, place, reason):
    path = broken(tmp_path / "stage.json", way, value)
    with pytest.raises(FileError) as found:
        read_stage(path)
    assert found.value.path == path and found.value.place == place
    assert reason in found.value.reason
    assert "\n" not in str(found.value) and len(str(found.value)) < 400


def test_what_is_wrong_as_a_whole_is_named_too(tmp_path):
    data = own_stage()
    boss = data["events"].pop()
    assert "no boss" in reason_of(write(tmp_path / "a.json", data))
    data["events"] += [boss, dict(data["events"][-1], at=300)]
    assert "after the boss" in reason_of(write(tmp_path / "b.json", data))
    data = own_stage()
    data["events"][0] = dict(data["events"][1], at=0)
    assert "first backdrop" in reason_of(write(tmp_path / "c.json", data))
    data = own_stage()
    data["events"][1]["groups"] = [dict(data["events"][1]["groups"][0], places=[0.5] * 30)] * 3
    assert "90 planes; at most 80" in reason_of(write(tmp_path / "d.json", data))
    data = own_stage()
    pattern = {"shoot": "ring", "bullet": "red", "count": 64, "speed": 60, "every": 0.04}
    leader_of(data, "boss")["phases"][0]["patterns"] = [pattern]
    assert "1600 bullets a second; at most 1000" in reason_of(write(tmp_path / "e.json", data))
    leader_of(data, "boss")["phases"][0]["patterns"] = [dict(pattern, every=1, shots=10, faster=-9)]
    assert "px/s; at least 20" in reason_of(write(tmp_path / "f.json", data))


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "3", '"stage"', "null", '{"version": 99, "shape": "new"}', "[" * 100_000, '{"format": NaN}']
)
def test_what_is_no_stage_at_all_is_refused(tmp_path, text):
    path = tmp_path / "stage.json"
    path.write_text(text)
    assert reason_of(path)


def reason_of(path):
    with pytest.raises(FileError) as found:
        read_stage(path)
    return found.value.reason


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(FileError, match="No such file"):
        Shooter(level=tmp_path / "nowhere.json")


def test_the_game_plays_the_file_it_is_given(tmp_path):
    path = boss_stage(tmp_path / "short.json")
    scene = Shooter(level=path)
    assert len(scene.director.stage.events) == 2 and scene.director.stage != load_stage()


def test_the_own_stage_has_all_that_a_stage_may_have():
    events = load_stage().events
    groups = [group for event in events for group in event.groups]
    assert {group.kind for group in groups} == set(KIND_NAMES) == set(KINDS)
    assert {event.ground for event in events if event.event == "backdrop"} == set(GROUNDS)
    assert {group.carries for group in groups} | {event.item for event in events} >= {
        "power",
        "bomb",
    } and "life" in ITEMS
    boss = events[-1]
    assert boss.event == "boss" and len(boss.phases) == 3
    assert sum(event.event == "midboss" for event in events) == 1
    shot = {pattern.shoot for event in events for phase in event.phases for pattern in phase.patterns}
    assert shot == set(PATTERNS)
    assert 100 <= boss.at <= 200, "with the fights, about four minutes"


def test_walls_leave_a_gap_that_a_plane_fits_through():
    for event in load_stage().events:
        for phase in event.phases:
            for pattern in (each for each in phase.patterns if each.shoot == "wall"):
                places = wall(pattern.spacing, 240.0, pattern.gap)
                apart = max(b - a for a, b in zip(places, places[1:], strict=False))
                assert apart > 2 * (CORE_RADIUS + 14) and len(places) > 5
