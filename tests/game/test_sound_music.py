"""Music: a tune fades into the next, a jingle plays between, a loud effect lowers the volume,
no file crashes a game.
"""

import re

import pygame
import pytest

from game.audio.music import DUCK_UP, DUCKED, FADE
from game.audio.sound import DUCK_SECONDS, DUCKING, Sounds
from game.places import MUSIC

FRAME = 1 / 60


@pytest.fixture
def sounds():
    said = []
    made = Sounds(master=0.5, music=0.8, report=said.append)
    if made.silent_because:
        pytest.skip(made.silent_because)
    made.said = said
    yield made
    pygame.mixer.music.stop()
    pygame.mixer.stop()


def run(sounds, seconds):
    """Step the sounds for a time [s] and return the list of music volumes after each frame."""
    volumes = []
    for _ in range(round(seconds / FRAME)):
        sounds.step(FRAME)
        volumes.append(pygame.mixer.music.get_volume())
    return volumes


def test_every_tune_and_jingle_is_there_and_plays(sounds):
    for name in ("title", "shooter", "boss", "platformer", "lab", "victory", "game_over"):
        assert (MUSIC / f"{name}.ogg").is_file()
        sounds.tune(name)
        run(sounds, 1.0)
        assert sounds.player.playing == name and pygame.mixer.music.get_busy()
    assert sounds.said == []


def test_every_tune_that_a_scene_or_screen_names_is_there():
    found = set()
    for path in [*(MUSIC.parent.parent / "scenes").rglob("*.py"), *(MUSIC.parent.parent / "game").rglob("*.py")]:
        found |= set(re.findall(r"\b(?:music|tune) = \"(\w+)\"", path.read_text()))
    assert "lab" in found
    assert [name for name in sorted(found) if not (MUSIC / f"{name}.ogg").is_file()] == []


def test_a_tune_fades_in_and_into_the_next_and_out(sounds):
    sounds.tune("title")
    rising = run(sounds, FADE + 0.1)
    assert rising == sorted(rising) and rising[2] < 0.1 and rising[-1] == pytest.approx(0.4, abs=0.01)
    sounds.tune("boss")
    falling = run(sounds, FADE - 0.05)
    assert sounds.player.playing == "title" and falling == sorted(falling, reverse=True) and falling[-1] < 0.1
    run(sounds, FADE + 0.15)
    assert sounds.player.playing == "boss" and pygame.mixer.music.get_volume() == pytest.approx(0.4, abs=0.01)
    steps = [abs(a - b) for a, b in zip(rising, rising[1:], strict=False)]
    assert max(steps) < 0.03, "no jump is heard"
    sounds.tune(None)
    run(sounds, 2 * FADE)
    assert not pygame.mixer.music.get_busy()


def test_the_same_tune_again_does_nothing(sounds, monkeypatch):
    sounds.tune("title")
    run(sounds, 1.0)
    monkeypatch.setattr(pygame.mixer.music, "load", None)
    for _ in range(30):
        sounds.tune("title")
        assert set(run(sounds, FRAME)) == {pygame.mixer.music.get_volume()}


def test_a_mind_changed_in_mid_fade_goes_back_without_a_restart(sounds):
    sounds.tune("title")
    run(sounds, 1.0)
    sounds.tune("boss")
    run(sounds, FADE / 2)
    sounds.tune("title")
    run(sounds, 1.0)
    assert sounds.player.playing == "title" and sounds.player.level == 1.0


def test_volumes_are_heard_while_they_change(sounds):
    sounds.tune("lab")
    run(sounds, 1.0)
    for master, music in ((1.0, 1.0), (0.5, 0.5), (0.3, 0.0), (0.0, 1.0)):
        sounds.master, sounds.music = master, music
        run(sounds, FRAME)
        assert pygame.mixer.music.get_volume() == pytest.approx(master * music, abs=0.01)


@pytest.mark.parametrize("name", sorted(DUCKING))
def test_the_music_steps_back_for_a_loud_moment(sounds, name):
    sounds.tune("shooter")
    run(sounds, 1.0)
    assert sounds.play(name)
    volumes = run(sounds, DUCK_SECONDS)
    assert volumes[6] == pytest.approx(0.4 * DUCKED, abs=0.01) and volumes[-1] == pytest.approx(0.4 * DUCKED, abs=0.01)
    volumes = run(sounds, DUCK_UP + 0.1)
    assert volumes == sorted(volumes) and volumes[-1] == pytest.approx(0.4, abs=0.01)


def test_a_shot_does_not_push_the_music_back(sounds):
    sounds.tune("shooter")
    run(sounds, 1.0)
    assert sounds.play("laser") and sounds.play("hit")
    assert set(run(sounds, 0.3)) == {pygame.mixer.music.get_volume()}


def test_a_jingle_plays_once_and_the_tune_comes_back(sounds):
    sounds.tune("shooter")
    run(sounds, 1.0)
    sounds.jingle("victory")
    volumes = run(sounds, 0.3)
    assert sounds.player.playing == "victory" and volumes[-1] == pytest.approx(0.4, abs=0.01)
    sounds.tune("title")  # the next screen: its tune waits for the end
    run(sounds, 1.0)
    assert sounds.player.playing == "victory"
    pygame.mixer.music.stop()  # as at its end
    run(sounds, 1.0)
    assert sounds.player.playing == "title" and pygame.mixer.music.get_busy()


def test_a_pause_silences_the_tune_and_another_tune_ends_it(sounds):
    sounds.tune("shooter")
    run(sounds, 1.0)
    sounds.pause()
    sounds.pause()
    run(sounds, 0.2)
    assert pygame.mixer.music.get_volume() == 0.0
    sounds.tune("shooter")
    run(sounds, 0.2)
    assert sounds.player.paused and pygame.mixer.music.get_volume() == 0.0
    sounds.resume()
    run(sounds, 0.1)
    assert pygame.mixer.music.get_volume() > 0.0 and sounds.player.playing == "shooter"
    sounds.pause()
    sounds.tune("title")
    run(sounds, 1.0)
    assert sounds.player.playing == "title" and pygame.mixer.music.get_busy()


def test_a_pause_never_waits_for_the_sound_thread(sounds, monkeypatch):
    """Pausing the music never waits for the sound thread.

    pygame's own pause froze the program if an effect ended at that moment (see Music.pause).
    """
    for name in ("pause", "unpause"):
        monkeypatch.setattr(pygame.mixer.music, name, None)
    sounds.tune("shooter")
    run(sounds, 1.0)
    sounds.pause()
    sounds.resume()


def test_a_pause_in_a_jingle_does_not_end_it(sounds):
    sounds.tune("shooter")
    sounds.jingle("victory")
    run(sounds, 0.3)
    sounds.pause()
    run(sounds, 1.0)
    sounds.resume()
    run(sounds, 0.2)
    assert sounds.player.playing == "victory"


def test_a_file_that_cannot_be_used_is_one_message_and_silence(tmp_path):
    said = []
    sounds = Sounds(music_folder=tmp_path, report=said.append)
    if sounds.silent_because:
        pytest.skip(sounds.silent_because)
    (tmp_path / "broken.ogg").write_bytes(b"OggS no music")
    for name in ("broken", "absent", "broken", "absent"):
        sounds.tune(name)
        run(sounds, 1.0)
    sounds.jingle("absent")
    run(sounds, 1.0)
    assert [line.count("\n") for line in said] == [0, 0]
    assert "broken.ogg: music: " in said[0] and "absent.ogg: music: there is no such file" in said[1]
