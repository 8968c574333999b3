"""Runs of a person: one recording for each attempt, notes of help, ranked results, ghosts, reports of damaged files."""

import json

import pygame
import pytest

from game.audio.sound import Sounds
from game.errors import FileError
from game.files.best_run import load_ghost
from game.files.records import load_records
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame
from game.run.digest import scene_digest
from game.run.replay import load_replay
from game.run.replay_shelf import recent_folder, replays_folder
from game.run.session import Session
from game.run.sources import ScriptSource
from game.screens.play import Play
from tests.game.arena import Arena, Race

K = pygame
SEEN = {"hint_seen": True, "window_scale": 1}


def played(scene, settings=None):
    return Play(scene, DeviceSource(), Sounds(silent=True), settings=settings or Settings(**SEEN))


def steered(play, steps, *actions):
    play.session.source = ScriptSource(
        [InputFrame(frozenset(actions), changes=play.devices.next().changes)]
        + [InputFrame(frozenset(actions))] * (steps - 1)
    )
    for _ in range(steps):
        play.step()


def test_a_recording_after_a_restart_needs_nothing_of_the_run_before(tmp_path):
    play, runs = played(Race(seed=5), Settings(**SEEN, invincible=True)), []
    play.run_ended = lambda recorder, result: runs.append(recorder.frames)
    play.devices.change("slider:speed", 120)
    play.devices.change("narrowphase", False)
    steered(play, 40, "right")
    play.restart()
    steered(play, 30, "left")
    assert runs == [40]
    play.recorder.save(tmp_path / "run.json")
    replay = load_replay(tmp_path / "run.json")
    scene = Race(replay.seed, replay.broadphase, replay.solver, replay.tier)
    session = Session(scene, replay, replay=replay)
    for _ in range(replay.frames):
        session.step()
    assert replay.frames == 30 and scene_digest(scene) == scene_digest(play.scene)
    assert scene.values["speed"] == 120 and scene.assist["invincible"]


@pytest.mark.parametrize(
    "settings, change, assisted",
    [
        ({}, None, False),
        ({"invincible": True}, None, True),
        ({"speed": 0.9}, None, True),
        ({"hit_stop": False}, None, False),
        ({}, ("slider:speed", 20), True),
        ({}, ("narrowphase", False), True),
        ({}, ("broadphase", "tree"), False),
    ],
)
def test_help_is_noticed(settings, change, assisted):
    play = played(Race(), Settings(**SEEN, **settings))
    if change:
        play.devices.change(*change)
    steered(play, 5, "right")
    assert play.assisted == assisted
    if not change and settings != {"invincible": True} and settings != {"speed": 0.9}:
        play.clock.slower()
        steered(play, 1)
        assert play.assisted


def test_a_restart_begins_an_honest_run():
    play = played(Race())
    play.clock.slower()
    steered(play, 5)
    play.clock.faster()
    play.restart()
    steered(play, 5)
    assert not play.assisted


def test_bots_and_recordings_are_not_helped_nor_kept():
    play = Play(
        Race(), DeviceSource(), Sounds(silent=True), bot=True, settings=Settings(**SEEN, invincible=True, speed=0.5)
    )
    assert play.devices.changes == [] and play.clock.game_speed == 1.0 and not play.renews and play.hint is None


def test_pads_rumble_when_it_hurts_and_only_then():
    class Pads:
        shakes = []

        def rumble(self, *values):
            self.shakes.append(values)

    class Hurting(Race):
        def update(self, inputs):
            super().update(inputs)
            if self.frame == 3:
                self.play("hurt")

    for wanted, times in ((True, 1), (False, 0)):
        Pads.shakes.clear()
        play = Play(Hurting(), DeviceSource(pads=Pads()), Sounds(silent=True), settings=Settings(**SEEN, rumble=wanted))
        for _ in range(6):
            play.step()
        assert len(Pads.shakes) == times


def finish_race(d, steps=60):
    d.hold(K.K_RIGHT, steps)
    assert d.screen.scene.result is not None
    d.turns(70)
    d.key(K.K_SPACE)
    assert d.name == "ResultScreen"


def test_the_fastest_run_comes_back_as_a_ghost(drive):
    d = drive("--scene", "dash", settings=Settings(**SEEN))
    assert d.screen.scene.ghost is None
    finish_race(d)
    d.key(K.K_RETURN, K.K_RETURN, K.K_RETURN, K.K_RETURN)
    rows, seconds, _ = load_ghost("dash")
    assert len(rows) == len(d.screen.scene.trail) and any("ghost" in note for note in d.screen.notes)
    d.mark("Again")
    d.turns(2)
    assert d.name == "Play" and d.screen.scene.ghost == rows and d.screen.scene.result is None
    d.turns(30)
    finish_race(d)
    assert load_ghost("dash")[1] == seconds, "slower"
    assert d.screen.place == 2
    d.settings.ghost = False
    d.key(K.K_ESCAPE)
    d.mark("Again")
    assert d.screen.scene.ghost is None


def test_initials_are_remembered_and_a_hasty_escape_loses_no_place(drive):
    d = drive("--scene", "race", settings=Settings(**SEEN))
    finish_race(d)
    d.key(K.K_z, K.K_BACKSPACE, K.K_y, K.K_ESCAPE)
    assert not d.screen.entering and d.name == "ResultScreen"
    assert load_records()[0].best("race").name == "YAA" and d.settings.initials == "YAA"


def test_restart_and_escape_after_the_end_lead_to_the_result(drive):
    for key in (K.K_r, K.K_ESCAPE):
        d = drive("--scene", "race", settings=Settings(**SEEN))
        d.hold(K.K_RIGHT, 60)
        d.key(key)
        assert d.name == "ResultScreen"


def test_a_lost_race_against_the_clock_does_not_rank(drive):
    d = drive("--scene", "dash", settings=Settings(**SEEN))
    d.turns(250)
    finish_race(d, 2)
    assert d.screen.place is None and not d.screen.entering and load_ghost("dash")[0] is None


def test_help_marks_the_entry(drive):
    d = drive("--scene", "race", settings=Settings(**SEEN, invincible=True))
    finish_race(d)
    d.key(K.K_ESCAPE)
    assert load_records()[0].best("race").assisted


def test_a_table_that_cannot_be_written_is_said_on_the_screen(drive, monkeypatch):
    d = drive("--scene", "race", settings=Settings(**SEEN))
    finish_race(d)
    monkeypatch.setattr("os.replace", lambda *a: (_ for _ in ()).throw(OSError("disk full")))
    d.key(K.K_ESCAPE)
    d.turns(2)
    assert "disk full" in d.screen.notes[0]


def test_each_attempt_is_a_recent_replay_with_its_result(drive):
    d = drive("--scene", "race", settings=Settings(**SEEN))
    d.turns(150)
    d.key(K.K_r)
    finish_race(d)
    d.key(K.K_ESCAPE, K.K_ESCAPE)
    assert d.name == "Menu"
    results = [load_replay(path).result for path in recent_folder().glob("*.json")]
    assert len(results) == 2 and None in results
    (result,) = [each for each in results if each]
    assert result == {"won": True, "points": pytest.approx(45, abs=3), "seconds": pytest.approx(0.75, abs=0.1)}


def make_level(tmp_path, text):
    folder = tmp_path / "levels"
    folder.mkdir(exist_ok=True)
    (folder / "mine.json").write_text(text)
    return folder / "mine.json"


def test_own_levels_are_in_the_menu_and_have_a_table_of_their_own(drive, tmp_path):
    make_level(tmp_path, "{}")
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.key(K.K_RETURN)
    d.mark("mine")
    assert d.name == "Play" and d.screen.scene.level_file.name == "mine.json"
    finish_race(d)
    d.key(K.K_ESCAPE)
    records, _ = load_records()
    assert records.entries("race") == [] and len(records.tables) == 1
    d.mark("High scores")
    assert d.name == "ScoresScreen" and d.screen.pages[d.screen.at].title == "Race: mine"
    assert records.entries(d.screen.pages[d.screen.at].table)


def test_a_mistake_in_a_level_is_a_message_and_the_menu_goes_on(drive, tmp_path):
    path = make_level(tmp_path, "a mistake")
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.key(K.K_RETURN)
    d.mark("mine")
    assert d.name == "MessageScreen"
    assert dict(d.screen.parts) == {"file": str(path), "place": "line 1", "reason": "has a mistake in it"}
    d.key(K.K_RETURN)
    assert d.name == "Menu"
    d.mark("Race")
    assert d.name == "Play"


def test_a_file_that_breaks_while_playing_is_a_message(drive, monkeypatch):
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.key(K.K_RETURN)
    d.mark("Race")

    def broken(self, inputs):
        raise FileError("stage.json", "waves[3]", "is gone")

    monkeypatch.setattr(Race, "update", broken)
    d.turns(3)
    assert d.name == "MessageScreen"
    d.key(K.K_RETURN)
    assert d.name == "Menu"


@pytest.mark.parametrize(
    "text, place",
    [('{"version": 1', "line 1"), ('{"format": "hitbox replay", "version": 3}', "version"), (None, "file")],
)
def test_a_dropped_file_is_watched_or_refused_with_its_reason(drive, tmp_path, text, place):
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    path = tmp_path / "friend.json"
    if text is not None:
        path.write_text(text)
    d.post(K.DROPFILE, file=str(path))
    d.turns(2)
    assert d.name == "MessageScreen" and dict(d.screen.parts)["place"].startswith(place)
    d.key(K.K_RETURN)
    assert d.name == "Title"


def test_a_friend_s_file_is_watched(drive, tmp_path):
    from tests.game.test_replay import record

    path = tmp_path / "friend.json"
    record(path, 200)
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.post(K.DROPFILE, file=str(path))
    d.turns(250)
    assert d.name == "Watch" and d.screen.tape.ended and not d.screen.tape.diverged
    d = drive("--replay", str(path))
    d.turns(250)
    assert d.name == "Watch" and d.screen.tape.ended
    d.key(K.K_ESCAPE)
    assert d.name == "Title"


def test_a_replay_whose_level_changed_says_so(drive, tmp_path):
    level = make_level(tmp_path, "{}")
    d = drive("--scene", "race", "--level", str(level), settings=Settings(**SEEN))
    d.turns(150)
    d.key(K.K_ESCAPE)
    d.mark("Save replay")
    assert "Saved as race-" in d.screen.message
    (path,) = replays_folder().glob("*.json")
    level.write_text("{ }")
    d.post(K.DROPFILE, file=str(path))
    d.turns(2)
    assert d.name == "MessageScreen" and "has changed since" in dict(d.screen.parts)["reason"]


def test_messages_of_files_are_on_the_title(drive, tmp_path):
    (tmp_path / "records.json").write_text(json.dumps({"version": 7, "tables": {}}))
    d = drive()
    d.turns(2)
    assert "records.json: version: 7" in d.screen.message


def test_a_bad_scene_change_of_a_recording_is_refused_not_crashed(drive, tmp_path):
    from tests.game.test_replay import record

    path = tmp_path / "run.json"
    record(path, 60)
    data = json.loads(path.read_text())
    data["inputs"][0][1]["changes"] = [["slider:gravity", 3]]
    path.write_text(json.dumps(data))
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.post(K.DROPFILE, file=str(path))
    d.turns(5)
    assert d.name == "MessageScreen" and "slider:gravity" in dict(d.screen.parts)["reason"]


def test_arena_is_not_ranked(drive):
    assert Arena.ranked_by is None
