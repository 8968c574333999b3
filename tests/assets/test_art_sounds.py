"""Every sound: its length, a peak of -3 dB, no clicks, no DC, loud enough, not too bright,
different from all others.
"""

import wave

import numpy as np
import pytest

from assets import FOLDER, build
from assets.audio.sounds import SOUNDS
from assets.craft.synth import PEAK, RATE, voice

ISSUE = ("laser", "enemy_shot", "hit", "explosion", "coin", "powerup", "jump", "hurt")
LATER = (
    "heavy_laser",
    "big_explosion",
    "spring",
    "land",
    "stomp",
    "blip",
    "confirm",
    "back",
    "goal",
    "bomb",
    "graze",
    "warning",
    "crumble",
    "checkpoint",
    "secret",
    "crate",
    "ladder",
    "chain_break",
    "life",
)
LANDER = ("thrust", "blast", "clank", "alarm", "low_fuel", "hook", "touchdown")
BREAKING = ("tear", "splash", "fuse", "throw")
LONGEST = {
    "blast": 1.0,
    "touchdown": 1.4,
    "explosion": 1.0,
    "big_explosion": 1.5,
    "goal": 1.3,
    "bomb": 1.6,
    "warning": 1.4,
    "secret": 1.0,
    "life": 1.0,
}  # [s]
BLASTS = ("explosion", "big_explosion", "bomb")
OFTEN = ("thrust", "laser", "enemy_shot", "hit", "land", "graze", "ladder", "crate", "coin", "jump", "blip")
EDGES = 50.0 * 2.0 ** (np.arange(22) / 2.5)  # [Hz] bands from 50 Hz to 17 kHz, five to two octaves


def read(name):
    with wave.open(str(FOLDER / "sounds" / f"{name}.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32767


def spectrum(samples):
    """Return (frequencies [Hz], power at each) of a whole sound."""
    return np.fft.rfftfreq(len(samples), 1 / RATE), np.abs(np.fft.rfft(samples)) ** 2


def center(samples):
    """Return the mean frequency, weighted by power [Hz]."""
    hertz, power = spectrum(samples)
    return float((hertz * power).sum() / power.sum())


def test_the_effects_are_there_and_every_sound_is_a_product():
    assert set(SOUNDS) == {*ISSUE, *LATER, *LANDER, *BREAKING}
    assert {f"sounds/{name}" for name in SOUNDS} == {name for name in build.PRODUCTS if name.startswith("sounds/")}


@pytest.mark.parametrize("name", SOUNDS)
def test_sound_is_clean(name):
    samples = read(name)
    assert 0.04 <= len(samples) / RATE <= LONGEST.get(name, 0.7)
    assert abs(samples).max() == pytest.approx(PEAK, abs=1e-4)
    assert abs(samples[0]) < 1e-3 and abs(samples[-1]) < 1e-3
    assert abs(samples[: RATE // 2000]).max() < 0.5, "the first half millisecond is part of the fade"
    assert abs(samples[-RATE // 2000 :]).max() < 0.1, "it has died away before its last half millisecond"
    assert abs(samples.mean()) < 1e-3


@pytest.mark.parametrize("name", SOUNDS)
def test_sound_is_as_loud_as_the_others(name):
    level = 20 * np.log10(read(name).std())
    assert -18.0 < level < -7.0, f"{level:.1f} dB: a peak of -3 dB with nothing around it is not heard"


@pytest.mark.parametrize("name", SOUNDS)
def test_sound_is_not_harsh(name):
    hertz, power = spectrum(read(name))
    assert power[hertz > 6000].sum() < 0.03 * power.sum()
    assert center(read(name)) < 2200


@pytest.mark.parametrize("name", BLASTS)
def test_a_blast_is_dark_deep_and_darkens(name):
    samples = read(name)
    hertz, power = spectrum(samples)
    assert center(samples) < 700
    assert power[hertz < 100].sum() > 0.15 * power.sum(), "it has a sub"
    tail = samples[int(len(samples) * 0.6) :]
    assert center(tail) < center(samples[: len(samples) // 3])


def test_what_is_heard_all_the_time_is_short():
    assert all(len(read(name)) / RATE < 0.4 for name in OFTEN)


def test_no_sound_is_like_another():
    """No two sounds are alike in band levels [dB], loudness over time and length."""
    marks = {}
    for name in SOUNDS:
        samples = read(name)
        hertz, power = spectrum(samples)
        bands = [power[(hertz >= low) & (hertz < high)].sum() for low, high in zip(EDGES, EDGES[1:], strict=False)]
        bands = 10 * np.log10(np.array(bands) / power.sum() + 1e-4)
        shape = [
            10 * np.log10(float(np.mean(part * part)) / samples.var() + 1e-3) for part in np.array_split(samples, 8)
        ]
        marks[name] = np.concatenate([bands, shape, [20 * np.log2(len(samples) / RATE)]])
    names = list(marks)
    nearest = min(
        (float(np.sqrt(np.mean((marks[a] - marks[b]) ** 2))), a, b)
        for index, a in enumerate(names)
        for b in names[:index]
    )
    assert nearest[0] > 2.0, nearest


@pytest.mark.parametrize("name", ["graze", "crate", "hurt", "bomb"])
def test_sound_regenerates_bit_identical(name):
    assert build.differences(f"sounds/{name}") == []


def test_unknown_oscillator_names_the_valid_ones():
    with pytest.raises(ValueError, match="pulse, saw"):
        voice("square", 100, 100, np.ones(8))
