"""Every sound: its length, its peak at -3 dB, no click at its ends, no DC, something to hear."""

import wave

import numpy as np
import pytest

from assets import FOLDER
from assets.build import PRODUCTS
from assets.sounds import SOUNDS
from assets.synth import PEAK, RATE, voice

ISSUE = ("laser", "enemy_shot", "hit", "explosion", "coin", "powerup", "jump", "hurt")
LONGEST = {"explosion": 1.0, "big_explosion": 1.5, "goal": 1.3}   # [s]; the others are effects of under 0.7


def read(name):
    with wave.open(str(FOLDER / "sounds" / f"{name}.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32767


def test_the_eight_effects_are_there_and_every_sound_is_a_product():
    assert set(ISSUE) <= set(SOUNDS)
    assert {f"sounds/{name}" for name in SOUNDS} == {name for name in PRODUCTS if name.startswith("sounds/")}


@pytest.mark.parametrize("name", SOUNDS)
def test_sound_is_clean(name):
    samples = read(name)
    assert 0.04 <= len(samples) / RATE <= LONGEST.get(name, 0.7)
    assert abs(samples).max() == pytest.approx(PEAK, abs=1e-4)
    assert abs(samples[0]) < 1e-3 and abs(samples[-1]) < 1e-3
    assert abs(samples[: RATE // 2000]).max() < 0.5, "the first half millisecond is part of the fade"
    assert abs(samples.mean()) < 1e-3
    assert samples.std() > 0.03


def test_unknown_oscillator_names_the_valid_ones():
    with pytest.raises(ValueError, match="pulse, saw"):
        voice("square", 100, 100, np.ones(8))
