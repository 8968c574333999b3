"""Renders the tunes of assets/tunes to assets/music/<name>.wav: mono, 16 bit, 22,050 Hz, looping without a seam.

Everything is laid on a ring as long as the tune: what still rings at the end is heard at the start. Filters and echoes go
around it too. The level is set by the loudness of the whole, so that no tune jumps out beside another.
"""

import math

import numpy as np

from assets import FOLDER
from assets.audio.harmony import STEPS_PER_BEAT, complaints
from assets.audio.notation import read_tune
from assets.audio.voices import FINE, OVERSAMPLING, RATE, decimated, drum, low_pass, tone
from assets.craft.synth import to_wav

TUNES = ("title", "shooter", "boss", "platformer", "lab")
JINGLES = ("victory", "game_over")
LOUDNESS = -21.0  # [dB of full scale] of what is above HEARD; the effects peak at -3 dB
HEARD = 100.0  # [Hz] what is below adds little to how loud a tune seems
RUMBLE = 25.0  # [Hz] what is below is taken out: nobody hears it
KNEE, CEILING = 0.45, 0.70  # peaks above the knee are rounded off and never reach the ceiling
TAIL = 0.9  # [s] a jingle rings out
STRESS = (1.0, 0.86, 0.93, 0.86)  # of the steps of a beat
ECHO_CORNER, LAST_ECHO = 2400.0, 0.05  # [Hz] above which repeats are duller; softer ones are left out
TAKES = 3  # strokes of each drum that differ a little, in turn
PRODUCTS = {f"music/{name}": ("assets.audio.music", "music_files", (name,)) for name in (*TUNES, *JINGLES)}


def tune_of(name):
    """The Tune of that name, read from assets/tunes."""
    return read_tune(FOLDER / "tunes" / f"{name}.txt")


def render(tune):
    """The tune as int16 samples at RATE."""
    length = round((tune.seconds(tune.steps) + (0 if tune.loop else TAIL)) * RATE) * OVERSAMPLING
    ring = np.zeros(length)
    for name, notes in tune.notes.items():
        voice = np.zeros(length)
        instrument = tune.voices[name]
        (_drums if instrument.wave == "noise" else _sing)(tune, notes, voice)
        if instrument.echo:
            _echo(tune, voice, instrument.echo, instrument.delay)
        ring += voice
    samples = decimated(ring)
    return _mastered(samples - low_pass(samples, RUMBLE, RATE, around=True), tune.loop)


def _sing(tune, notes, voice):
    """Add the notes of a pulse or triangle to its ring."""
    made, before = {}, None
    for note in notes:
        instrument = note.instrument
        starts = tune.seconds(note.start)
        last = tune.seconds(note.start + note.steps - 1)
        seconds = last + (tune.seconds(note.start + note.steps) - last) * instrument.gate - starts
        slide = before if "/" in note.marks else None
        key = (instrument, note.pitches, round(seconds, 6), slide, "~" in note.marks)
        if key not in made:
            made[key] = tone(
                instrument, note.pitches, seconds, slide, instrument.vibrato * 2 if "~" in note.marks else None
            )
        _add(voice, round(starts * FINE), made[key], _gain(note))
        before = note.pitches[0]


def _drums(tune, notes, voice):
    """Add the strokes of the drums to their ring, each with the next of its takes."""
    takes, struck = {}, {}
    for note in notes:
        for name in note.drums:
            number = struck[name] = struck.get(name, -1) + 1
            key = (name, number % TAKES)
            if key not in takes:
                takes[key] = drum(*key)
            _add(voice, round(tune.seconds(note.start) * FINE), takes[key], _gain(note))


def _gain(note):
    """How strongly a note is added: its own volume, and where in the beat it stands."""
    return note.volume * STRESS[note.start % STEPS_PER_BEAT]


def _add(ring, start, samples, gain):
    """Add samples to a ring, going on at its start when they reach its end."""
    start %= len(ring)
    room = len(ring) - start
    ring[start : start + len(samples)] += gain * samples[:room]
    if len(samples) > room:
        ring[: len(samples) - room] += gain * samples[room:]


def _echo(tune, voice, share, delay):
    """Add repeats, duller than the voice and each softer than the one before. delay: steps between them."""
    shift = round(delay * (60.0 / STEPS_PER_BEAT) / tune.tempo * FINE)
    dull, gain, number = low_pass(voice, ECHO_CORNER, around=True), share, 1
    while gain > LAST_ECHO:
        voice += gain * np.roll(dull, number * shift)
        gain, number = gain * share, number + 1


def _mastered(samples, loop):
    """Set the loudness, round the peaks, and give a jingle clean ends."""
    heard = samples - low_pass(samples, HEARD, RATE, around=True)
    samples = samples * round(10 ** (LOUDNESS / 20) / _level(heard), 4)
    size = np.abs(samples)
    over = np.maximum(size - KNEE, 0.0) / (CEILING - KNEE)
    samples = np.where(size > KNEE, np.sign(samples) * (KNEE + (CEILING - KNEE) * over / (1 + over)), samples)
    if not loop:
        fade = np.linspace(0, 1, int(0.004 * RATE))
        out = np.linspace(1, 0, int(TAIL / 2 * RATE))
        samples[: len(fade)] *= fade
        samples[-len(out) :] *= out
    return np.round(samples * 32767).astype(np.int16)


def _level(samples):
    """Root mean square of the parts that are not rests, in whole numbers so that the order of adding is the same anywhere."""
    block = int(0.4 * RATE)
    whole = np.round(samples * 65536).astype(np.int64) ** 2
    powers = [int(whole[i : i + block].sum()) / block for i in range(0, len(whole) - block + 1, block)]
    loud = [power for power in powers if power > max(powers) / 100]
    return math.sqrt(math.fsum(loud) / len(loud)) / 65536


def music_files(name):
    """Return {relative path: bytes} of one tune. Raises ValueError where a note does not fit its chord."""
    tune = tune_of(name)
    wrong = complaints(tune)
    if wrong:
        raise ValueError(f"tunes/{name}.txt: {wrong[0]} ({len(wrong)} in all)")
    return {f"music/{name}.wav": to_wav(render(tune), RATE)}
