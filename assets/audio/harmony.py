"""Notes, chords and scales, and the rules by which every note of a tune fits its chord.

Pitches are MIDI numbers: C4 = 60, a semitone is 1. A pitch class is a pitch modulo 12, C = 0.
"""

import re
from typing import NamedTuple

LETTERS = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}
SIGNS = {"": 0, "#": 1, "b": -1}
QUALITIES = {  # semitones above the root
    "": (0, 4, 7),
    "m": (0, 3, 7),
    "7": (0, 4, 7, 10),
    "m7": (0, 3, 7, 10),
    "maj7": (0, 4, 7, 11),
    "6": (0, 4, 7, 9),
    "m6": (0, 3, 7, 9),
    "9": (0, 4, 7, 10, 14),
    "m9": (0, 3, 7, 10, 14),
    "maj9": (0, 4, 7, 11, 14),
    "add9": (0, 4, 7, 14),
    "sus4": (0, 5, 7),
    "sus2": (0, 2, 7),
    "7sus4": (0, 5, 7, 10),
    "dim": (0, 3, 6),
    "dim7": (0, 3, 6, 9),
    "m7b5": (0, 3, 6, 10),
    "5": (0, 7),
}
SCALES = {
    "major": (0, 2, 4, 5, 7, 9, 11),
    "minor": (0, 2, 3, 5, 7, 8, 10),
    "dorian": (0, 2, 3, 5, 7, 9, 10),
    "lydian": (0, 2, 4, 6, 7, 9, 11),
    "mixolydian": (0, 2, 4, 5, 7, 9, 10),
    "phrygian": (0, 1, 3, 5, 7, 8, 10),
}
# Degree in the notation -> the chord's tones that may stand for it, in semitones above the root.
DEGREES = {1: (0,), 2: (2, 14), 3: (3, 4, 5, 2), 5: (6, 7), 6: (9,), 7: (10, 11, 9), 8: (12,), 9: (14,)}
STEPS_PER_BEAT = 4
STEP_WISE = 2  # semitones: a whole tone at most counts as a step


class Chord(NamedTuple):
    """A chord of a tune. root, bass: pitch classes (0 C .. 11 B); tones: semitones above the root."""

    name: str
    root: int
    tones: tuple
    bass: int

    @property
    def classes(self):
        """The pitch classes of the chord, including its bass note, a frozenset."""
        return frozenset((self.root + tone) % 12 for tone in self.tones) | {self.bass}

    def moved(self, semitones):
        """Return the same chord, transposed by a number of semitones."""
        return Chord(self.name, (self.root + semitones) % 12, self.tones, (self.bass + semitones) % 12)


def pitch(name):
    """Return the MIDI number of a note such as "F#4". Raises ValueError for any other text."""
    match = re.fullmatch(r"([A-G])([#b]?)([0-8])", name)
    if not match:
        raise ValueError(f"no note {name!r}; notes are a letter A..G, # or b if wanted, and an octave, such as F#4")
    letter, sign, octave = match.groups()
    return 12 * (int(octave) + 1) + LETTERS[letter] + SIGNS[sign]


def chord(name):
    """Return the Chord of a symbol such as "F#m7" or "C/E". Raises ValueError for any other text."""
    match = re.fullmatch(r"([A-G])([#b]?)([a-z0-9]*)(?:/([A-G])([#b]?))?", name)
    if not match or match.group(3) not in QUALITIES:
        raise ValueError(
            f"no chord {name!r}; a chord is a root and one of {', '.join(QUALITIES)}, then /bass if wanted"
        )
    letter, sign, quality, bass, bass_sign = match.groups()
    root = (LETTERS[letter] + SIGNS[sign]) % 12
    return Chord(name, root, QUALITIES[quality], (LETTERS[bass] + SIGNS[bass_sign]) % 12 if bass else root)


def scale(text):
    """Return the pitch classes of a key such as "D mixolydian", a frozenset. Raises ValueError for any other text."""
    match = re.fullmatch(r"([A-G])([#b]?) (\w+)", text)
    if not match or match.group(3) not in SCALES:
        raise ValueError(f"no key {text!r}; a key is a root and one of {', '.join(SCALES)}")
    root = LETTERS[match.group(1)] + SIGNS[match.group(2)]
    return frozenset((root + tone) % 12 for tone in SCALES[match.group(3)])


def degree_pitch(at, degree, floor):
    """Return the MIDI pitch of a degree (1, 3, 5 ...) of the chord `at`, counted upward from the chord's bass note.

    The bass note is the lowest one at or above the MIDI pitch `floor`. Raises ValueError if the chord has no such
    degree.
    """
    bass = floor + (at.bass - floor) % 12
    if degree in (1, 8):
        return bass + (12 if degree == 8 else 0)
    for tone in DEGREES.get(degree, ()):
        if tone in at.tones:
            return bass + (at.root + tone - bass) % 12
    raise ValueError(f"chord {at.name} has no {degree}")


def tone_pitch(at, index, floor):
    """Return the MIDI pitch of the chord tone with number `index`, counted upward from the MIDI pitch `floor`.

    at: the chord. The count starts at the same pitch for all chords, so each tone moves only a small interval when the
    chord changes.
    """
    ladder = sorted(floor + (tone - floor) % 12 for tone in {(at.root + tone) % 12 for tone in at.tones})
    return ladder[index % len(ladder)] + 12 * (index // len(ladder))


def scale_over(key, at):
    """Return the pitch classes of `key` adapted to the chord `at`, a frozenset.

    It contains all tones of the chord. For a chord tone that is not in the key, the key's pitch classes a semitone away
    are left out, unless they are chord tones.
    """
    foreign = at.classes - key
    bent = {tone for tone in key if tone in at.classes or all((tone - other) % 12 not in (1, 11) for other in foreign)}
    return frozenset(bent | at.classes)


def complaints(tune):
    """Return the audible errors of a tune as a list of texts, one for each broken rule; [] without errors.

    1. A note is in the key, or in the key as adapted to its chord (scale_over).
    2. A note that stands out is a tone of its chord, or is followed by a step to such a tone. A note stands out if it
       starts on a beat and lasts a beat or more, or if it lasts two beats.
    3. A note held over a change of chord is also a tone of the new chord, or is followed by such a step within a beat.
    4. A short note that is not a tone of its chord is reached or left by a step.
    5. Two voices that start together on a beat are not a semitone apart. With octaves in between they may be, if the
       chord contains both notes.

    A step is at most a whole tone.
    """
    found = []
    for voice, notes in tune.notes.items():
        sung = [note for note in notes if note.pitches]
        for number, note in enumerate(sung):
            before, after = sung[number - 1] if number else None, sung[number + 1] if number + 1 < len(sung) else None
            found += [f"line {note.line}: {voice}: {text}" for text in _of_one_voice(tune, before, note, after)]
    return found + list(_clashes(tune))


def _of_one_voice(tune, before, note, after):
    at = tune.chords[note.start]
    by_step = after is not None and after.start == note.start + note.steps and _is_step(note, after)
    resolves = by_step and after is not None and after.pitches[0] % 12 in tune.chords[after.start].classes
    for each in note.pitches:
        if each % 12 not in scale_over(tune.keys[note.start], at):
            yield f"{each} is not in the scale over {at.name}"
    on_beat = note.start % STEPS_PER_BEAT == 0
    lasting = (on_beat and note.steps >= STEPS_PER_BEAT) or note.steps >= 2 * STEPS_PER_BEAT
    if lasting and note.pitches[0] % 12 not in at.classes and not resolves:
        yield f"{note.pitches[0]} stands out against {at.name}"
    elif note.pitches[0] % 12 not in at.classes and not by_step:
        if before is None or before.start + before.steps != note.start or not _is_step(before, note):
            yield f"{note.pitches[0]} is come to and left by leaps over {at.name}"
    for step in range(note.start + 1, note.start + note.steps):
        new = tune.chords[step]
        if new == tune.chords[step - 1]:
            continue
        for each in note.pitches:
            left = note.start + note.steps - step
            if each % 12 not in new.classes and not (resolves and left <= STEPS_PER_BEAT):
                yield f"{each} is held into {new.name}"


def _is_step(note, after):
    return 0 < abs(after.pitches[0] - note.pitches[0]) <= STEP_WISE


def _clashes(tune):
    on_beats = {}
    for voice, notes in tune.notes.items():
        for note in notes:
            if note.pitches and note.start % STEPS_PER_BEAT == 0:
                on_beats.setdefault(note.start, []).append((voice, note))
    for start, together in sorted(on_beats.items()):
        at = tune.chords[start]
        for index, (voice, note) in enumerate(together):
            for other, second in together[index + 1 :]:
                apart = (note.pitches[0] - second.pitches[0]) % 12
                inside = {note.pitches[0] % 12, second.pitches[0] % 12} <= at.classes
                if abs(note.pitches[0] - second.pitches[0]) == 1 or (apart in (1, 11) and not inside):
                    yield f"line {note.line}: {voice} and {other} are a semitone apart over {at.name}"
