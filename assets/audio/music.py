"""Render the tunes of assets/tunes to assets/music/<name>.ogg: stereo, 22,050 Hz, looping without a seam.

All sound is added to a ring buffer of the tune's length: sound past its end continues at its start, and so do filters
and echoes. The gain of a tune is computed from its loudness, so that all tunes are equally loud.

Bass, kick and snare are in the middle, the other voices at their `pan` and `spread`. Echoes alternate between the left
and the right side. The gains of both sides always have the same sum, so a mono mix does not depend on a voice's
position.
"""

import hashlib
import json
import math

import numpy as np

from assets import FOLDER
from assets.audio.harmony import STEPS_PER_BEAT, complaints
from assets.audio.notation import read_tune
from assets.audio.voices import FINE, OVERSAMPLING, RATE, decimated, drum, low_pass, tone
from assets.craft.ogg import Recording

TUNES = ("title", "shooter", "boss", "platformer", "lander", "lab")
JINGLES = ("victory", "game_over")
LOUDNESS = -21.0  # [dB of full scale] of frequencies above HEARD; the effects peak at -3 dB
HEARD = 100.0  # [Hz] lower frequencies add little to the loudness of a tune
RUMBLE = 25.0  # [Hz] lower frequencies are removed: they are inaudible
KNEE, CEILING = 0.45, 0.70  # peaks above the knee are rounded off and never reach the ceiling
TAIL = 0.9  # [s] in which a jingle rings out
STRESS = (1.0, 0.86, 0.93, 0.86)  # of the steps of a beat
ECHO_CORNER, LAST_ECHO = 2400.0, 0.05  # [Hz] above which repeats are duller; softer ones are omitted
ECHO_PLACE = 0.6  # of every second repeat, the others are as far on the other side
TAKES = 3  # strokes of each drum that differ a little, in turn
DRUM_PLACES = {"k": 0.0, "s": 0.0, "h": 0.3, "o": 0.3, "c": -0.3, "t": -0.35}  # a tom's takes move over to the right
PRODUCTS = {f"music/{name}": (__name__, "music_files", (name,)) for name in (*TUNES, *JINGLES)}


def tune_of(name):
    """Return the Tune called `name`, read from assets/tunes."""
    return read_tune(FOLDER / "tunes" / f"{name}.txt")


def render(tune):
    """Return the samples of a tune, (frames, 2) int16 at RATE."""
    length = round((tune.seconds(tune.steps) + (0 if tune.loop else TAIL)) * RATE) * OVERSAMPLING
    ring = np.zeros((2, length))
    for name, notes in tune.notes.items():
        voice = np.zeros((2, length))
        instrument = tune.voices[name]
        (_drums if instrument.wave == "noise" else _sing)(tune, notes, voice)
        if instrument.echo:
            _echo(tune, voice, instrument)
        ring += voice
    samples = np.stack([decimated(side) for side in ring])
    return _mastered(samples - low_pass(samples, RUMBLE, RATE, around=True), tune.loop)


def _sing(tune, notes, voice):
    """Add the notes of a pulse or triangle voice to the voice's ring buffer `voice`, samples (2, length)."""
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
        _add(voice, round(starts * FINE), made[key], _gain(note), note.place)
        before = note.pitches[0]


def _drums(tune, notes, voice):
    """Add the strokes of a tune's drums to the ring buffer `voice`, samples (2, length).

    Each drum has TAKES variants, which are used in rotation.
    """
    takes, struck = {}, {}
    for note in notes:
        for name in note.drums:
            number = struck[name] = (struck.get(name, -1) + 1) % TAKES
            if (name, number) not in takes:
                takes[name, number] = drum(name, number)
            place = DRUM_PLACES[name] * (1 - number if name == "t" else 1)
            _add(voice, round(tune.seconds(note.start) * FINE), takes[name, number], _gain(note), place)


def _gain(note):
    """Return the factor on a Note's samples, from its volume and its position in the beat."""
    return note.volume * STRESS[note.start % STEPS_PER_BEAT]


def _sides(place):
    """Return the gains of the left and the right side, an array (2, 1). place: position, from -1 (left) to
    1 (right).
    """
    place = max(-1.0, min(1.0, place))
    return np.array([[1 - place], [1 + place]])


def _add(ring, start, samples, gain, place):
    """Add mono samples to a ring buffer (2, length) from index `start` on.

    Samples past its end continue at its start. gain: factor on the samples; place: position, from -1 (left) to 1
    (right).
    """
    length, gains = ring.shape[1], gain * _sides(place)
    start %= length
    room = length - start
    ring[:, start : start + len(samples)] += gains * samples[:room]
    if len(samples) > room:
        ring[:, : len(samples) - room] += gains * samples[room:]


def _echo(tune, voice, instrument):
    """Add the echoes of a voice to the voice's ring buffer `voice`, samples (2, length).

    Each echo is duller than the voice and softer than the echo before. The echoes alternate between the sides, and the
    first one is on the side opposite to the voice.
    """
    shift = round(instrument.delay * (60.0 / STEPS_PER_BEAT) / tune.tempo * FINE)
    dull, gain, number = low_pass(voice.mean(axis=0), ECHO_CORNER, around=True), instrument.echo, 1
    place = ECHO_PLACE if instrument.pan < 0 else -ECHO_PLACE
    while gain > LAST_ECHO:
        voice += gain * _sides(place) * np.roll(dull, number * shift)
        gain, number, place = gain * instrument.echo, number + 1, -place


def _mastered(samples, loop):
    """Return samples (2, n) as int16 (n, 2) at the standard loudness, with high peaks rounded off.

    A jingle (`loop` is False) is faded at both ends.
    """
    heard = samples - low_pass(samples, HEARD, RATE, around=True)
    samples = samples * round(10 ** (LOUDNESS / 20) / _level(heard), 4)
    size = np.abs(samples)
    over = np.maximum(size - KNEE, 0.0) / (CEILING - KNEE)
    samples = np.where(size > KNEE, np.sign(samples) * (KNEE + (CEILING - KNEE) * over / (1 + over)), samples)
    if not loop:
        fade = np.linspace(0, 1, int(0.004 * RATE))
        out = np.linspace(1, 0, int(TAIL / 2 * RATE))
        samples[:, : len(fade)] *= fade
        samples[:, -len(out) :] *= out
    return np.ascontiguousarray(np.round(samples * 32767).astype(np.int16).T)


def _level(samples):
    """Return the root mean square of samples (2, n), without the parts that are nearly silent.

    The sum is over integers, so that the order of summing has no effect.
    """
    block = int(0.4 * RATE)
    whole = np.round(samples * 65536).astype(np.int64) ** 2
    starts = range(0, whole.shape[1] - block + 1, block)
    powers = [int(whole[:, start : start + block].sum()) / (2 * block) for start in starts]
    loud = [power for power in powers if power > max(powers) / 100]
    return math.sqrt(math.fsum(loud) / len(loud)) / 65536


def music_files(name):
    """Return the two files of one tune, {path relative to assets/: content}.

    The content of the music file is a Recording. The other file is JSON with the hash of the samples. Raises ValueError
    if a note does not fit its chord.
    """
    tune = tune_of(name)
    wrong = complaints(tune)
    if wrong:
        raise ValueError(f"tunes/{name}.txt: {wrong[0]} ({len(wrong)} in all)")
    samples = render(tune)
    made_from = {
        "sha256": hashlib.sha256(samples.astype("<i2").tobytes()).hexdigest(),
        "frames": len(samples),
        "channels": samples.shape[1],
        "rate": RATE,
    }
    return {
        f"music/{name}.json": (json.dumps(made_from, indent=1) + "\n").encode(),
        f"music/{name}.ogg": Recording(samples, RATE),
    }
