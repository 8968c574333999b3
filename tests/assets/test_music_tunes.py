"""The tunes: in harmony, varied for ten minutes, equally loud, in stereo, and looping without a seam."""

import hashlib
import json

import numpy as np
import pytest

from assets import FOLDER, build
from assets.audio import music
from assets.audio.harmony import complaints
from assets.audio.music import JINGLES, LOUDNESS, PRODUCTS, TUNES, render, tune_of
from assets.audio.notation import parse_tune
from assets.audio.voices import OVERSAMPLING, RATE, decimated, drum, low_pass, tone
from assets.craft.ogg import LOSS, loss
from assets.craft.synth import PEAK
from tests.assets.music_reading import decoded, sides_of

ALL = (*TUNES, *JINGLES)


def decibels(samples):
    return 20 * np.log10(max(1e-9, float(np.sqrt(np.mean(samples * samples)))))


def shares(samples, *edges):
    """Return the share of the power in each frequency band. edges: the limits of the bands [Hz], in ascending order."""
    power = np.abs(np.fft.rfft(samples)) ** 2
    hertz = np.fft.rfftfreq(len(samples), 1 / RATE)
    return [
        power[(hertz >= low) & (hertz < high)].sum() / power.sum() for low, high in zip(edges, edges[1:], strict=False)
    ]


def loudness(sides):
    """Return the loudness of a tune [dB]. Frequencies below 100 Hz are left out, because they add little to it."""
    return decibels(sides - low_pass(sides, 100.0, RATE))


def width(sides):
    """Return the power of the difference of left and right divided by that of their sum."""
    left, right = sides
    return float(np.square(right - left).sum() / np.square(right + left).sum())


def test_every_tune_is_a_product_and_every_page_a_tune():
    assert {path.stem for path in (FOLDER / "tunes").glob("*")} == set(ALL)
    assert set(PRODUCTS) == {f"music/{name}" for name in ALL} <= set(build.PRODUCTS)
    kept = [f"{name}.{kind}" for name in ALL for kind in ("json", "ogg")]
    assert sorted(path.name for path in (FOLDER / "music").glob("*")) == sorted(kept)
    assert sum(path.stat().st_size for path in (FOLDER / "music").glob("*.ogg")) < 4.8e6


@pytest.mark.parametrize("name", ALL)
def test_every_note_fits_its_chord(name):
    assert complaints(tune_of(name)) == []


@pytest.mark.parametrize("name", TUNES)
def test_a_tune_has_a_shape(name):
    tune = tune_of(name)
    parts = [part for part, _, _ in tune.parts]
    assert len(set(parts)) >= 5 and all(a != b for a, b in zip(parts, parts[1:], strict=False))
    assert max(parts.count(part) for part in parts) <= 2
    bar = tune.beats * 4
    sung = [
        sum(note.steps for note in tune.notes["lead"] if first <= note.start < first + steps) / steps
        for _, first, steps in tune.parts
    ]
    assert max(sung) > 0.7 and min(sung) < 0.5, "the lead comes and goes"
    starts = {note.start // bar for note in tune.notes["lead"]}
    rests = [number for number in range(tune.steps // bar) if number not in starts]
    assert len(rests) >= 2, "it breathes for whole bars"
    chords = {symbol.name for symbol in tune.chords}
    assert len(chords) >= 8
    for voice, notes in tune.notes.items():
        ends = [note.start + note.steps for note in notes]
        assert all(end <= after.start for end, after in zip(ends, notes[1:], strict=False)), (
            f"{voice} sings over itself"
        )
    lead = [note.pitches[0] for note in tune.notes["lead"]]
    assert 60 <= min(lead) and max(lead) <= 90 and max(lead) - min(lead) >= 12


def test_two_voices_call_and_answer():
    for name in ("title", "shooter", "boss"):
        tune = tune_of(name)
        bars = {voice: {note.start // 16 for note in tune.notes[voice]} for voice in ("lead", "second")}
        assert len(bars["second"] - bars["lead"]) >= 4, "the second answers where the lead rests"


def test_the_boss_has_the_shooters_motif_in_minor_and_faster():
    shooter, boss = tune_of("shooter"), tune_of("boss")
    assert boss.tempo == shooter.tempo + 15
    motif = [[note for note in tune.notes["lead"] if note.start < 20] for tune in (shooter, boss)]
    assert [(a.start, a.steps) for a in motif[0]] == [(a.start, a.steps) for a in motif[1]]
    moved = [b.pitches[0] - a.pitches[0] for a, b in zip(*motif, strict=True)]
    assert set(moved) == {0, -1}, "only the thirds are lowered"


@pytest.mark.parametrize("name", ALL)
def test_the_file_is_as_long_as_its_samples_were(name):
    """The file has exactly as many frames as its samples, because a loop would otherwise stumble."""
    made_from = json.loads((FOLDER / "music" / f"{name}.json").read_text())
    assert decoded(name).shape == (made_from["frames"], made_from["channels"]) and made_from["channels"] == 2
    assert made_from["rate"] == RATE


@pytest.mark.parametrize("name", TUNES)
def test_a_loop_is_as_long_as_its_tune_and_never_silent(name):
    samples, tune = sides_of(name).mean(axis=0), tune_of(name)
    assert len(samples) == round(tune.seconds(tune.steps) * RATE) and 80 <= len(samples) / RATE <= 100
    tenth = RATE // 10
    quiet = [decibels(samples[i : i + tenth]) < -45 for i in range(0, len(samples) - tenth, tenth)]
    assert not any(all(quiet[i : i + 5]) for i in range(len(quiet))), "half a second of nothing"


@pytest.mark.parametrize("name", TUNES)
def test_sections_differ_in_loudness_but_none_jumps_out(name):
    sides, tune = sides_of(name), tune_of(name)
    levels = [
        decibels(sides[:, int(tune.seconds(first) * RATE) : int(tune.seconds(first + steps) * RATE)])
        for _, first, steps in tune.parts
    ]
    assert 0.7 < max(levels) - min(levels) < 6.0


def test_tunes_are_alike_in_loudness_and_below_the_effects():
    levels = {}
    for name in ALL:
        sides = sides_of(name)
        levels[name] = loudness(sides)
        assert abs(sides).max() < PEAK, name
        assert abs(sides.mean(axis=1)).max() < 1e-4
    assert max(levels[name] for name in TUNES) - min(levels[name] for name in TUNES) < 1.5
    assert all(abs(level - LOUDNESS) < 1.5 for level in levels.values()), levels


@pytest.mark.parametrize("name", ALL)
def test_the_panorama_is_wide_but_stands_on_its_middle(name):
    sides = sides_of(name)
    assert 0.01 < width(sides) < 0.2
    assert width(low_pass(low_pass(sides, 80.0, RATE), 80.0, RATE)) < 0.01, "bass and kick are in the middle"
    left, right = sides
    assert abs(decibels(left) - decibels(right)) < 1.2, "neither side is heavier"


def test_a_second_voice_is_to_the_right_and_its_echo_to_the_left():
    text = RING.replace("attack=0.01", "pan=0.5").replace("release=0.4", "release=0.02") + "one"
    for line in ("lead C5 - E5 G5", "bass 1 1 5 8", "drums kh s k ."):
        text = text.replace(line, "lead C5 . . ." if line.startswith("lead") else "", 1)
    left, right = render(parse_tune(text)).T.astype(float)
    beat = round(0.4 * RATE)
    assert decibels(right[: beat // 2]) - decibels(left[: beat // 2]) == pytest.approx(20 * np.log10(3), abs=0.5)
    first = slice(round(1.05 * beat), round(1.45 * beat))  # the note is over, its repeat is not
    assert decibels(left[first]) > decibels(right[first]) + 6


@pytest.mark.parametrize("name", [*JINGLES, *(pytest.param(name, marks=pytest.mark.nightly) for name in TUNES)])
def test_both_sides_added_are_the_mono_mix(name, monkeypatch):
    """The sum of both channels equals the mono mix, so one loudspeaker plays everything.

    The sum is within 1 dB as a whole, and differs little at any time.
    """
    added = render(tune_of(name)).mean(axis=1)
    monkeypatch.setattr(music, "_sides", lambda place: np.ones((2, 1)))
    mono = render(tune_of(name)).astype(float)
    assert (mono[:, 0] == mono[:, 1]).all()
    assert abs(decibels(added) - decibels(mono)) < 1.0
    scaled = mono[:, 0] * (np.dot(added, mono[:, 0]) / np.dot(mono[:, 0], mono[:, 0]))
    assert decibels(added - scaled) < decibels(added) - 20, "the same sound, but for rounded peaks"


@pytest.mark.parametrize("name", ALL)
def test_the_spectrum_is_warm(name):
    rumble, low, middle, high, harsh = shares(sides_of(name).mean(axis=0), 0, 45, 300, 2000, 6000, RATE / 2)
    assert harsh < 0.01 and rumble < 0.05
    assert 0.2 < low < 0.7 and 0.2 < middle < 0.75 and high < 0.2


@pytest.mark.parametrize("name", TUNES)
@pytest.mark.parametrize("side", [0, 1])
def test_the_seam_of_the_loop_has_no_click(name, side):
    samples = sides_of(name)[side]
    steps = np.abs(np.diff(samples))
    assert abs(samples[0] - samples[-1]) <= np.percentile(steps, 99.5)
    edge = np.abs(np.diff(np.roll(samples, RATE // 10)[: RATE // 5], 2))  # a click is a corner
    usual = np.abs(np.diff(samples, 2))
    assert edge[RATE // 10 - 20 : RATE // 10].max() <= np.percentile(usual, 99.9)


@pytest.mark.parametrize("name", JINGLES)
def test_a_jingle_is_short_and_ends_in_silence(name):
    sides = sides_of(name)
    assert 3.5 <= sides.shape[1] / RATE <= 5.0
    assert abs(sides[:, :3]).max() < 0.02 and abs(sides[:, -40:]).max() < 0.01
    samples = render(tune_of(name))
    assert abs(samples[:3]).max() < 0.01 * 32767 and abs(samples[-40:]).max() < 0.002 * 32767


RING = """tempo 150
key C major
voice lead wave=pulse25 volume=0.5 release=0.4 attack=0.01 vibrato=20 echo=0.5 delay=3
voice bass wave=triangle from=C2 gate=1
voice drums wave=noise
section one
  chords C
  lead C5 - E5 G5
  bass 1 1 5 8
  drums kh s k .
section two
  chords F
  lead A5 - F5 C6
  bass 1 1 5 8
  drums kh s k s
order """


def test_the_loop_has_no_beginning():
    """A tune played from its second half on gives the same samples, because echoes, releases
    and filters wrap around.
    """
    text = RING.replace("kh s k .", ". . . .").replace("kh s k s", "k s k s")
    forth, back = render(parse_tune(text + "one two")), render(parse_tune(text + "two one"))
    half = len(forth) // 2
    assert len(forth) == 2 * half and np.abs(np.roll(forth, half, axis=0).astype(int) - back).max() <= 2
    assert np.abs(forth[:8]).max() > 5, "what rings at the end is heard at the start"


def test_rendering_is_the_same_twice_and_a_jingle_regenerates():
    tune = parse_tune(RING + "one two")
    assert (render(tune) == render(tune)).all()
    assert build.differences("music/victory") == []


def test_the_hash_is_of_the_samples():
    made = build.make("music/victory")
    kept = json.loads((FOLDER / "music" / "victory.json").read_text())
    samples = made["music/victory.ogg"].samples
    assert kept["sha256"] == hashlib.sha256(samples.tobytes()).hexdigest() and kept["frames"] == len(samples)
    assert loss(decoded("victory"), samples) <= LOSS


def test_no_aliases_among_the_harmonics():
    """A high pulse keeps its harmonics, and aliases from above the band are 40 dB below them."""
    voice = parse_tune(RING.replace(" echo=0.5 delay=3", " bright=20000").replace("vibrato=20 ", "") + "one").voices[
        "lead"
    ]
    samples = decimated(tone(voice, (93,), 1.0))[2000:18000]  # A6, 1,760 Hz
    power = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    hertz = np.fft.rfftfreq(len(samples), 1 / RATE)
    away = np.abs(hertz / 1760 - np.round(hertz / 1760)) * 1760
    assert power[(away > 60) & (hertz > 60)].max() < power.max() / 100


def test_drums_differ_from_each_other_and_fall_silent():
    centers = {}
    for name in "kshotc":
        stroke = drum(name)
        power = np.abs(np.fft.rfft(stroke)) ** 2
        centers[name] = (power * np.fft.rfftfreq(len(stroke), 1 / RATE / OVERSAMPLING)).sum() / power.sum()
        assert abs(stroke[-1]) < 1e-3 and abs(stroke).max() < 1.6
    assert centers["k"] < centers["t"] < centers["s"] < centers["c"] < centers["h"]
    assert (drum("s", 0) != drum("s", 1)).any(), "no stroke is a copy"
