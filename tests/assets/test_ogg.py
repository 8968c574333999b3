"""Ogg files: as long as their samples, and checked correctly with or without soundfile."""

import json

import numpy as np
import pytest

from assets import FOLDER, build
from assets.craft import ogg
from assets.craft.ogg import LOSS, Recording, frame_count, loss

RATE = 22_050
needs_encoder = pytest.mark.skipif(not ogg.is_available(), reason="soundfile (extra assets) is not installed")


def chord(frames, seed=1):
    """Return a stereo chord of a few held tones, (frames, 2) int16."""
    time = np.arange(frames)[:, None] / RATE
    tones = np.random.default_rng(seed).uniform(100, 2000, (5, 2))
    return (np.sum([np.sin(2 * np.pi * tone * time) for tone in tones], axis=0) * 3000).astype(np.int16)


@needs_encoder
@pytest.mark.parametrize("frames", [1, 700, 8192, 50_001])
def test_a_file_decodes_to_as_many_frames(frames):
    samples = chord(frames)
    packed = ogg.encode(samples, RATE)
    kept, rate = ogg.decode(packed)
    assert kept.shape == samples.shape and rate == RATE and frame_count(packed) == frames


@needs_encoder
def test_a_recording_knows_its_file_from_others():
    samples = chord(40_000)
    recording, packed = Recording(samples, RATE), ogg.encode(samples, RATE)
    assert recording.is_kept_in(packed) and recording.is_kept_in(recording.encoded())
    for other in (chord(40_000, seed=2), samples[:, ::-1], samples[:-1], samples // 2):
        assert not Recording(other, RATE).is_kept_in(packed)
    assert not Recording(samples, 44_100).is_kept_in(packed)
    assert not recording.is_kept_in(packed[:-9]) and not recording.is_kept_in(b"")
    torn = bytearray(packed)
    torn[len(torn) // 2] ^= 255  # the page's checksum no longer holds
    assert not recording.is_kept_in(bytes(torn))


@pytest.mark.parametrize("name", ["title", "victory"])
def test_the_length_is_read_without_a_decoder(name):
    packed = (FOLDER / "music" / f"{name}.ogg").read_bytes()
    assert frame_count(packed) == json.loads((FOLDER / "music" / f"{name}.json").read_text())["frames"]
    for wrong in (packed[:-1], packed[1:], packed + b"x", b"", b"RIFF"):
        with pytest.raises(ValueError, match="not a whole Ogg file"):
            frame_count(wrong)


def test_loss_is_a_share_of_the_samples():
    samples = chord(9000)
    assert loss(samples, samples) == 0.0
    assert loss(samples // 2, samples) == pytest.approx(0.5, abs=0.01) and 0.5 > LOSS


def test_without_soundfile_hashes_and_lengths_are_checked_and_it_is_said(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(ogg, "soundfile", None)
    assert build.main(["music/victory", "--check"]) == 0
    assert "not by decoding" in capsys.readouterr().err
    monkeypatch.setattr(build, "FOLDER", tmp_path)
    (tmp_path / "music").mkdir()
    packed = (FOLDER / "music" / "victory.ogg").read_bytes()
    made_from = (FOLDER / "music" / "victory.json").read_bytes()
    for file, content, wrong in (
        ("victory.ogg", (FOLDER / "music" / "game_over.ogg").read_bytes(), ["music/victory.ogg"]),
        ("victory.json", made_from.replace(b'"sha256": "', b'"sha256": "0'), ["music/victory.json"]),
    ):
        (tmp_path / "music" / "victory.ogg").write_bytes(packed)
        (tmp_path / "music" / "victory.json").write_bytes(made_from)
        assert build.differences("music/victory") == []
        (tmp_path / "music" / file).write_bytes(content)
        assert build.differences("music/victory") == wrong


def test_without_soundfile_a_missing_tune_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setattr(ogg, "soundfile", None)
    monkeypatch.setattr(build, "FOLDER", tmp_path)
    with pytest.raises(RuntimeError, match="pip install soundfile"):
        build.write("music/victory")


def test_a_right_file_is_not_encoded_again(monkeypatch, tmp_path):
    monkeypatch.setattr(build, "FOLDER", tmp_path)
    (tmp_path / "music").mkdir()
    packed = (FOLDER / "music" / "victory.ogg").read_bytes()
    (tmp_path / "music" / "victory.ogg").write_bytes(packed)
    assert build.write("music/victory") == ["music/victory.json", "music/victory.ogg"]
    assert (tmp_path / "music" / "victory.ogg").read_bytes() == packed
