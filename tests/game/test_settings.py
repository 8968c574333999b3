"""Damaged settings, or those of other versions, give the defaults and a one-line message; the old file is kept."""

import json
from random import Random

import pytest

from game.files.data_folder import data_folder, keep_beside, write_atomically
from game.files.settings import Settings, load_settings, save_settings
from game.input.bindings import BUTTON_NAMES, DEFAULT_KEYS, REBOUND, button_actions, key_codes, rivals
from game.input.rebinding import FIXED, clash, default_table, rebind


@pytest.fixture
def path(tmp_path):
    return tmp_path / "settings.json"


def test_a_missing_file_is_no_problem(path):
    assert load_settings(path) == (Settings(), "")


def test_saved_settings_come_back(path):
    chosen = Settings(window_scale=2, music=0.3, palette="contrast", speed=0.55, invincible=True, initials="B.9")
    chosen.keys["fire"] = ["k"]
    save_settings(chosen, path)
    assert load_settings(path) == (chosen, "")


def test_broken_json_is_kept_and_named(path):
    path.write_text('{"version": 1,\n "volume": }')
    settings, message = load_settings(path)
    assert settings == Settings()
    assert str(path) in message and "line 2" in message and "damaged-1" in message
    assert (path.parent / "settings.json.damaged-1").read_text() == path.read_text()
    load_settings(path)
    assert len(list(path.parent.iterdir())) == 2, "the same damage is kept once"


FIRST_VERSION = {"version": 1, "window_scale": 3, "fullscreen": False, "volume": 0.4, "shake": False, "show_fps": True}


def test_the_first_version_is_read(path):
    keys = {action: list(keys) for action, keys in DEFAULT_KEYS.items() if action != "bomb"}
    keys |= {"left": ["x", "a"], "confirm": ["return"], "cancel": ["escape", "backspace"], "pause": ["p"]}
    keys["jump"] = ["space"]
    path.write_text(json.dumps({**FIRST_VERSION, "keys": keys}))
    settings, message = load_settings(path)
    assert message == ""
    assert (settings.window_scale, settings.effects, settings.shake, settings.show_fps) == (3, 0.4, 0.0, True)
    assert settings.keys["left"] == ["x", "a"] and settings.keys["bomb"] == ["left ctrl"], "x was taken already"
    assert set(settings.keys) == set(REBOUND) and clash(settings.keys) is None


BAD = [
    ("music", 7),
    ("effects", "loud"),
    ("master", True),
    ("master", float("nan")),
    ("window_scale", 2.5),
    ("window_scale", 99),
    ("fullscreen", 1),
    ("vsync", None),
    ("shake", -0.1),
    ("speed", 0.2),
    ("palette", "pink"),
    ("palette", 3),
    ("frame_cap", 61),
    ("frame_cap", False),
    ("initials", "AB"),
    ("initials", "ab?"),
    ("keys", {}),
    ("keys", {"left": ["nokey"]}),
    ("keys", {**default_table("keys"), "left": ["right"]}),
    ("keys", {**default_table("keys"), "left": ["escape"]}),
    ("keys", {**default_table("keys"), "left": []}),
    ("keys", {**default_table("keys"), "left": ["nokey"]}),
    ("buttons", {**default_table("buttons"), "fire": ["start"]}),
    ("buttons", {**default_table("buttons"), "fire": ["trigger"]}),
    ("buttons", 5),
]


@pytest.mark.parametrize("entry, value", BAD)
def test_one_bad_value_falls_back_alone(path, entry, value):
    path.write_text(json.dumps({"version": 2, "show_fps": True, entry: value}))
    settings, message = load_settings(path)
    assert settings.show_fps and getattr(settings, entry) == getattr(Settings(), entry)
    assert entry in message and "damaged-1" in message


@pytest.mark.parametrize("version", [99, 0, "2", None, True, [2]])
def test_another_version_is_not_guessed_at(path, version):
    text = json.dumps({"version": version, "music": 0.1})
    path.write_text(text)
    settings, message = load_settings(path)
    assert settings == Settings() and "version: " in message and "newer-1" in message
    save_settings(settings, path)
    assert (path.parent / "settings.json.newer-1").read_text() == text, "what a newer program wrote is kept"


@pytest.mark.parametrize("text", [b"\xff\xfe\x00\x80", b"", b"[1, 2]", b"[" * 100_000, b"null", b"9" * 5000])
def test_not_settings_at_all(path, text):
    path.write_bytes(text)
    assert "defaults are used" in load_settings(path)[1]


def test_kept_files_are_never_overwritten(path):
    path.write_text("one")
    first = keep_beside(path)
    path.write_text("two")
    second = keep_beside(path)
    assert first != second and first.read_text() == "one" and second.read_text() == "two"


def test_a_failed_write_leaves_the_old_file(path, monkeypatch):
    write_atomically(path, "old")
    monkeypatch.setattr("os.replace", lambda *a: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError):
        write_atomically(path, "new")
    assert path.read_text() == "old" and list(path.parent.iterdir()) == [path]


def test_folder_follows_the_platform(tmp_path):
    assert data_folder({"XDG_DATA_HOME": "/x"}, "linux").as_posix() == "/x/hitbox"
    assert data_folder({"APPDATA": "C:/u"}, "win32").as_posix() == "C:/u/Hitbox"
    assert "Application Support" in data_folder({}, "darwin").as_posix()
    assert data_folder({"HITBOX_DATA": str(tmp_path)}, "linux") == tmp_path


def test_a_taken_key_is_swapped_and_said():
    keys = default_table("keys")
    line = rebind(keys, "keys", "left", "right")
    assert keys["left"] == ["right", "a"] and keys["right"] == ["left", "d"]
    assert line == "left: \u2192. right now has \u2190."


def test_actions_of_different_games_share_a_key():
    keys = default_table("keys")
    assert not rivals("fire", "jump") and rivals("fire", "bomb") and rivals("left", "jump")
    rebind(keys, "keys", "jump", "z")
    assert keys["jump"][0] == "z" and "z" in keys["fire"]


@pytest.mark.parametrize(
    "device, control",
    [
        ("keys", "escape"),
        ("keys", "p"),
        ("keys", "tab"),
        ("keys", "f11"),
        ("keys", None),
        ("buttons", "start"),
        ("buttons", "y"),
        ("buttons", "back"),
    ],
)
def test_what_always_does_the_same_cannot_be_taken(device, control):
    table = default_table(device)
    assert "cannot be taken" in rebind(table, device, "left", control) or control is None
    assert table == default_table(device)


@pytest.mark.parametrize(
    "device, names",
    [("keys", [*"abcdefghijkl", "left", "right", "up", "space", "left shift", "tab"]), ("buttons", list(BUTTON_NAMES))],
)
def test_however_keys_are_given_away_every_action_has_one_of_its_own(device, names):
    random, table = Random(7), default_table(device)
    for _ in range(1500):
        action = random.choice(REBOUND)
        line = rebind(table, device, action, random.choice(names))
        assert line and clash(table) is None
        assert all(table.values()) and all(len(set(each)) == len(each) for each in table.values())
        assert not FIXED[device].intersection(each for controls in table.values() for each in controls)
    (key_codes if device == "keys" else button_actions)(table)
