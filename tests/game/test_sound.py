"""Sound effects: every file plays, few voices play at once, important sounds are kept, and no file can crash a game."""

import ast
import wave

import numpy as np
import pygame
import pytest

from game.audio.sound import CHANNELS, PITCHES, RATE, SPACING, STEADY, VOICES, Sounds, Voice, pan, resampled
from game.drawing.canvas import CANVAS_SIZE
from game.places import ASSETS, SOUNDS


class Clock:
    """Clock whose seconds a test advances."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


class Heard(Sounds):
    """Sounds with a clock of their own; the reported lines are stored."""

    def __init__(self, **more):
        self.time, self.said = Clock(), []
        super().__init__(clock=self.time, report=self.said.append, **more)
        if self.silent_because:
            pytest.skip(self.silent_because)

    def later(self, name, *more, seconds=2 * SPACING):
        self.time.now += seconds
        return self.play(name, *more)

    def playing(self):
        return [voice.name for voice in self.voices if voice.channel.get_busy()]


@pytest.fixture
def sounds():
    made = Heard()
    pygame.mixer.stop()
    yield made
    pygame.mixer.stop()


def test_every_sound_of_the_folder_plays(sounds):
    names = [path.stem for path in sorted(SOUNDS.glob("*.wav"))]
    assert len(names) >= 14
    for name in names:
        assert sounds.later(name, 240.0)
        pygame.mixer.stop()
    assert sounds.said == []


def test_every_sound_that_a_scene_or_screen_names_is_there():
    root = ASSETS.parent
    for path in [*(root / "scenes").rglob("*.py"), *(root / "game").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text())):
            named = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "play"
            if named and node.args and isinstance(node.args[0], ast.Constant) and isinstance(node.args[0].value, str):
                assert (SOUNDS / f"{node.args[0].value}.wav").is_file(), f"{path.name}:{node.lineno}"


def test_voices_of_one_sound_are_limited_and_the_oldest_gives_way(sounds):
    for _ in range(12):
        assert sounds.later("explosion")
    assert sounds.playing() == ["explosion"] * VOICES
    assert {voice.started for voice in sounds.voices if voice.name == "explosion"} == {10, 11, 12}


def test_hurt_is_never_lost_to_shots(sounds):
    for number in range(CHANNELS):  # every channel is taken by something that matters more than a shot
        sounds.samples[f"thing_{number}"] = np.zeros(RATE * 5, np.int16)
        assert sounds.later(f"thing_{number}")
    assert not sounds.later("laser"), "what matters less waits"
    assert sounds.later("hurt") and len(sounds.playing()) == CHANNELS
    assert "thing_0" not in sounds.playing() and "thing_1" in sounds.playing(), "the oldest of the least gave way"
    for _ in range(40):
        sounds.later("enemy_shot")
    assert "hurt" in sounds.playing()


class FakeChannel:
    """Replacement of a mixer channel that records the volumes it is given."""

    def get_busy(self):
        return False

    def play(self, sound):
        self.sound = sound

    def set_volume(self, left, right):
        self.sides = (left, right)


def test_many_hits_at_once_are_one_and_of_a_step_the_loudest(sounds):
    channel = FakeChannel()
    sounds.voices = [Voice(channel)]
    sounds.master = sounds.effects = 1.0
    sounds.play_cues([("hit", 0, 0.1), ("hit", 480, 0.9), ("hit", 240, 0.2)])
    assert channel.sides == pytest.approx([0.9 * side for side in pan(480)])
    assert not sounds.play("hit") and sounds.later("hit")


def test_volumes_multiply_and_nought_is_silence(sounds):
    channel = FakeChannel()
    sounds.voices[0].channel = channel
    sounds.master, sounds.effects = 0.5, 0.8
    assert sounds.play("coin", None, 0.5)
    assert channel.sides == pytest.approx([0.2 * side for side in pan(None)])
    for volume in ("master", "effects"):
        setattr(sounds, volume, 0.0)
        assert not sounds.later("coin")
        setattr(sounds, volume, 1.0)


def test_pan_follows_the_picture_with_equal_power():
    width = CANVAS_SIZE[0]
    assert pan(None) == pan(width / 2) and pan(0)[0] > pan(0)[1] and pan(width)[0] < pan(width)[1]
    assert pan(-1000) == pan(0), "what is outside the picture is at its edge"
    for x in (0, 100, 240, 400, width):
        assert sum(side * side for side in pan(x)) == pytest.approx(1.0)
    assert min(pan(0)) > 0.25, "never in one ear alone"


def test_pitches_vary_but_melodies_stay_in_tune(sounds):
    used = []
    for _ in range(40):
        sounds.later("laser")
        used.append(sounds.last_pitch["laser"])
    assert set(used) == set(PITCHES)
    assert all(a != b for a, b in zip(used, used[1:], strict=False)), "never the same twice running"
    for name in sorted(STEADY):
        assert sounds.later(name) and sounds.later(name) and sounds.last_pitch[name] == 1.0
        assert (SOUNDS / f"{name}.wav").is_file()


@pytest.mark.parametrize("speed", PITCHES)
def test_resampling_moves_the_pitch(speed):
    tone = np.round(8000 * np.sin(2 * np.pi * 441 * np.arange(RATE) / RATE)).astype(np.int16)
    moved = resampled(tone, speed)
    peak = np.abs(np.fft.rfft(moved * np.hanning(len(moved)))).argmax() * RATE / len(moved)
    assert peak == pytest.approx(441 * speed, abs=1.5)


def test_the_variation_takes_no_random_numbers_of_others(sounds):
    import random

    random.seed(5)
    np.random.seed(5)
    before = random.getstate(), np.random.get_state()[1].tolist()
    for _ in range(9):
        sounds.later("hit")
    assert (random.getstate(), np.random.get_state()[1].tolist()) == before


def wav(path, channels=1, rate=RATE, frames=b"\0\0" * 100):
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(frames)


def test_a_file_that_cannot_be_used_is_one_message_that_names_it(tmp_path):
    (tmp_path / "noise.wav").write_bytes(b"no sound at all")
    (tmp_path / "empty.wav").write_bytes(b"")
    wav(tmp_path / "wide.wav", channels=2)
    wav(tmp_path / "slow.wav", rate=8000)
    wav(tmp_path / "short.wav", frames=b"")
    (tmp_path / "odd.wav").mkdir()
    names = ("noise", "empty", "wide", "slow", "short", "odd", "absent")
    sounds = Heard(folder=tmp_path)
    for name in names * 3:
        assert not sounds.later(name)
    assert len(sounds.said) == len(names)
    for name, line in zip(names, sounds.said, strict=True):
        assert f"{name}.wav: sound: " in line and "\n" not in line
        assert not line.endswith(": ")


@pytest.mark.parametrize("error", [pygame.error("no such device"), NotImplementedError("mixer module not available")])
def test_no_device_is_silence_with_a_reason(monkeypatch, error):
    def refuse(*arguments, **more):
        raise error

    monkeypatch.setattr(pygame.mixer, "init", refuse)
    sounds = Sounds()
    assert str(error) in sounds.silent_because
    check_silent(sounds)


def test_sound_that_is_off_is_silence():
    sounds = Sounds(silent=True)
    assert sounds.silent_because == "sound is off"
    check_silent(sounds)


def check_silent(sounds):
    assert not sounds.play("laser")
    sounds.play_cues([("laser", 1.0, 1.0)])
    sounds.tune("title")
    sounds.jingle("victory")
    sounds.pause()
    sounds.step(1 / 60)
    sounds.resume()
    assert sounds.player.playing is None
