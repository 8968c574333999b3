"""Watching replays: seeking gives the state of normal play, a difference is shown, and overlays change nothing."""

import json

import pygame
import pytest

from game.audio.sound import Sounds
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.replay import Recorder, load_replay
from game.run.replay_shelf import RECENT, keep, put_recent, recent_folder, replays_folder, shelf
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.run.tape import KEY_SECONDS, MOST_KEYS, Tape
from game.screens.watch import Watch
from scenes import SCENES
from tests.game.arena import Arena

LENGTH = 1000


def recorded(path, frames=LENGTH, scene=None):
    scene = scene or Arena(seed=3)
    source = (
        BotSource()
        if type(scene) is not Arena
        else ScriptSource(
            [
                InputFrame(
                    frozenset({"right"} if n % 90 < 50 else {"left"}),
                    changes=(("slider:speed", 10 + n % 150),) * (n % 7 == 0),
                )
                for n in range(frames)
            ]
        )
    )
    recorder = Recorder(scene, every=30)
    session = Session(scene, source, recorder)
    digests = [scene_digest(scene)]
    for _ in range(frames):
        session.step()
        digests.append(scene_digest(scene))
    recorder.save(path)
    return load_replay(path), digests


@pytest.fixture
def tape(tmp_path):
    replay, digests = recorded(tmp_path / "run.json")
    tape = Tape(lambda: Arena(seed=3), replay)
    tape.expected = digests
    return tape


def test_seeking_ends_where_straight_play_does(tape):
    for frame in (700, 699, 3, 301, 300, 1000, 0, 650, 5000, -3):
        tape.seek(frame)
        assert tape.position == max(0, min(LENGTH, frame))
        assert scene_digest(tape.scene) == tape.expected[tape.position], f"frame {frame}"
    tape.seek(0)
    while not tape.ended:
        tape.step()
        assert scene_digest(tape.scene) == tape.expected[tape.position]
    assert not tape.diverged


@pytest.mark.parametrize("name", [name for name in SCENES if "/" not in name] + ["lab/pyramid"])
def test_seeking_in_the_games(tmp_path, name):
    make = Registry(SCENES).scene_class(name)
    replay, digests = recorded(tmp_path / "run.json", 420, make(seed=2))
    tape = Tape(lambda: make(seed=2), replay)
    for frame in (420, 310, 40, 380):
        tape.seek(frame)
        assert scene_digest(tape.scene) == digests[frame]
    assert not tape.diverged


def test_key_frames_are_spaced_out_in_long_recordings(tape):
    assert tape.spacing == 60 * KEY_SECONDS
    tape.seek(LENGTH)
    assert sorted(tape.keys) == [0, 300, 600, 900]
    tape.recording.inputs = tape.recording.inputs * 60  # a quarter of an hour
    long = Tape(lambda: Arena(seed=3), tape.recording)
    assert long.spacing == 60 * 21 and long.length // long.spacing < MOST_KEYS


def test_a_difference_is_shown_and_where_it_began(tmp_path, tape):
    path = tmp_path / "run.json"
    data = json.loads(path.read_text())
    data["digests"][10] = "0" * 16
    path.write_text(json.dumps(data))
    watch = Watch(Tape(lambda: Arena(seed=3), load_replay(path)), DeviceSource(), Sounds(silent=True), Accessibility())
    watch.tape.seek(329)
    assert not watch.diverged
    watch.step()
    assert watch.diverged and watch.tape.diverged_at == 330
    frame = watch.draw(Picture())
    assert any("DIVERGED at frame 330" in text for _, text in frame.boxes)
    watch.tape.seek(900)
    assert watch.tape.diverged_at == 330, "the first difference is the one that counts"
    watch.tape.seek(10)
    assert not watch.diverged


@pytest.fixture
def watch(tape):
    return Watch(tape, DeviceSource(), Sounds(silent=True), Accessibility())


def press(watch, *keys):
    for key in keys:
        watch.feed(pygame.event.Event(pygame.KEYDOWN, key=key, mod=0, unicode=""))
        while watch.tape.goal is not None:
            watch.tape.seek_on(1.0)


def test_keys_of_the_player(watch):
    press(watch, pygame.K_RIGHT, pygame.K_RIGHT)
    assert watch.tape.position == 600
    press(watch, pygame.K_LEFT)
    assert watch.tape.position == 300
    press(watch, pygame.K_COMMA, pygame.K_COMMA, pygame.K_PERIOD)
    assert watch.tape.position == 299 and watch.clock.paused
    press(watch, pygame.K_END)
    assert watch.tape.ended
    press(watch, pygame.K_HOME, pygame.K_UP, pygame.K_UP, pygame.K_UP)
    assert watch.tape.position == 0 and watch.clock.game_speed == 4.0
    press(watch, *[pygame.K_DOWN] * 9)
    assert watch.clock.game_speed == 0.25


@pytest.mark.parametrize("times, speed", [(0, 1.0), (1, 2.0), (2, 4.0), (-1, 0.5), (-2, 0.25)])
def test_speeds(watch, times, speed):
    press(watch, *[pygame.K_UP if times > 0 else pygame.K_DOWN] * abs(times))
    watch.advance(10.0)
    for number in range(60):
        watch.advance(10.0 + (number + 1.01) / 60)
    assert watch.tape.position == pytest.approx(60 * speed, abs=2)


def test_it_stops_at_the_end_and_starts_over(watch):
    watch.tape.seek(LENGTH - 2)
    for number in range(10):
        watch.advance(10.0 + number / 60)
    assert watch.tape.ended and watch.clock.paused
    press(watch, pygame.K_SPACE)
    assert watch.tape.position == 0 and not watch.clock.paused


def test_overlays_and_panel_only_look(watch):
    press(watch, pygame.K_RIGHT, pygame.K_1, pygame.K_TAB)
    watch.draw(Picture())
    assert watch.overlays.on >= {"bounds"} and watch.panel_open
    watch.panel.mark = 0
    press(watch, pygame.K_b, pygame.K_n, pygame.K_r, pygame.K_t, pygame.K_v)
    labels = [row.label for row in watch.panel.rows()]
    assert (
        "Restart" not in labels
        and "Broad phase" not in labels
        and any("key frames every 5 s" in each for each in labels)
    )
    assert watch.devices.changes == []
    assert scene_digest(watch.tape.scene) == watch.tape.expected[watch.tape.position]


def test_controls_come_and_go(watch):
    watch.advance(10.0)
    assert watch.shows_controls
    watch.advance(20.0)
    assert not watch.shows_controls and not watch.shows_pointer
    watch.feed(pygame.event.Event(pygame.MOUSEMOTION, pos=(1, 1), rel=(0, 0), buttons=(0, 0, 0)))
    assert watch.shows_controls


def test_only_recent_runs_are_ever_deleted(tmp_path):
    import os

    paths = []
    for number in range(RECENT + 4):
        session = Session(Arena(seed=number), BotSource(), Recorder(Arena(seed=number)))
        for _ in range(130):
            session.step()
        paths.append(put_recent(session.recorder))
        os.utime(paths[-1], (1000 + number, 1000 + number))
        if number < 3:
            keep(paths[-1])
    assert len(list(recent_folder().glob("*.json"))) == RECENT
    assert sorted(p.name for p in replays_folder().glob("*.json")) == sorted(p.name for p in paths[:3])
    assert len(shelf()) == RECENT + 3
    assert put_recent(Recorder(Arena())) is None, "nobody wants to see nothing"
