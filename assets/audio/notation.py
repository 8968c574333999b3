"""Read the tunes in assets/tunes/*.txt. A file has one line per voice, with bars between | signs.

; after a semicolon comes a comment
name Over the Bay              what the tune is called
tempo 150                      beats a minute
beats 4                        in a bar; a beat has four steps
swing 0.62                     where the second eighth of a beat falls, 0.5 (straight) .. 0.75; left out: straight
key D mixolydian               harmony.SCALES
loop no                        a jingle: played once; left out: yes

voice lead wave=pulse25 volume=0.5 vibrato=20      a channel and its Instrument (see there for all values)
phrase beat k . h . | s . h .  bars under a name, for use as @beat

section theme                  as many bars as it has chords
  chords D | A/C# Bm           symbols share their bar equally
  lead   D5 - A5 . | @run      a bar has 1, 2, 4, 8 or 16 tokens of equal length (of 16 steps; 3, 6, 12 of a bar of 12)
  bass   @drive *2             *2: twice
  set lead volume=0.4          another instrument in this section
order theme bridge theme+2 theme(-lead -drums)      +2: two semitones up; (-lead): that voice rests

Tokens:
    F#5              a note
    1 2 3 5 6 7 8 9  that degree of the chord, upward from its bass note, the first at or above the voice's `from`
    a b c .. h       the chord's tones, counted upward from `from`
    [ace]            several chord tones as a rapid arpeggio
    - .              hold the note; rest
    k s h o t c      on a noise voice: kick, snare, hat, open hat, tom, crash; together as in `kh`

Marks after a note: `'` and `,` an octave up and down, `!` louder, `?` softer, `/` slides up or down to it, `~` more
vibrato. A mistake raises TuneError with file, line and reason.
"""

import re
from dataclasses import dataclass, field, fields, replace

from assets.audio.harmony import STEPS_PER_BEAT, chord, degree_pitch, pitch, scale, tone_pitch
from assets.audio.tune import RANGES, WAVES, Instrument, Note, Tune

DRUMS = "kshotc"
TOKEN = re.compile(r"(?P<what>[A-G][#b]?\d|[1-9]|[a-h]|\[[a-h]{2,4}\])(?P<octaves>'*|,*)(?P<marks>[!?/~]*)")
DRUM_TOKEN = re.compile(rf"(?P<what>[{DRUMS}]+)(?P<marks>[!?]*)")


class TuneError(ValueError):
    """A tune that cannot be read. The error has the file, the line number and the reason."""

    def __init__(self, path, line, reason):
        super().__init__(f"{path}: line {line}: {reason}")
        self.path, self.line, self.reason = path, line, reason


@dataclass
class Section:
    """One section of a tune: the contents of its lines in the file, with their line numbers."""

    line: int
    chords: list = field(default_factory=list)  # a list of Chord per bar
    bars: dict = field(default_factory=dict)  # voice -> [(text of the bar, line)]
    changes: dict = field(default_factory=dict)  # voice -> values of set lines


def read_tune(path):
    """Return the Tune in a file. Raises TuneError for a mistake."""
    return parse_tune(path.read_text(encoding="utf-8"), path.name)


def parse_tune(text, source="tune"):
    """Return the Tune in a text. Raises TuneError for a mistake. source: name of the file in errors."""
    return _Reader(source).read(text)


class _Reader:
    def __init__(self, source):
        self.source = source
        self.line = 0
        self.tune = Tune()
        self.phrases = {}
        self.sections = {}
        self.section = Section(0)  # the section being read; no section begins in line 0
        self.order = []

    def fail(self, reason, line=None):
        raise TuneError(self.source, self.line if line is None else line, reason)

    def read(self, text):
        for self.line, raw in enumerate(text.splitlines(), 1):
            word, _, rest = raw.split(";")[0].strip().partition(" ")
            if word:
                self._line(word, rest.strip())
        for given, what in (
            (self.tune.tempo, "tempo"),
            (self.tune.key, "key"),
            (self.tune.voices, "voice"),
            (self.order, "order"),
        ):
            if not given:
                self.fail(f"the tune has no {what} line")
        self.tune.notes = {name: [] for name in self.tune.voices}
        for name, move, mutes, line in self.order:
            self._append(name, move, mutes, line)
        return self.tune

    def _line(self, word, rest):
        readers = {
            "name": self._name,
            "tempo": self._tempo,
            "beats": self._beats,
            "swing": self._swing,
            "key": self._key,
            "loop": self._loop,
            "voice": self._voice,
            "phrase": self._phrase,
            "section": self._section,
            "order": self._order,
        }
        if self.sections:
            readers |= {"chords": self._chords, "set": self._set}
        if word in readers:
            readers[word](rest)
        elif self.sections and word in self.tune.voices:
            self.section.bars.setdefault(word, []).extend(self._bars(rest))
        else:
            voices = self.tune.voices if self.sections else ()
            self.fail(f"no line starts with {word!r} here; valid: {', '.join([*readers, *voices])}")

    def _name(self, rest):
        self.tune.name = rest or self.fail("name what?")

    def _number(self, text, low, high, what):
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not low <= value <= high:
            self.fail(f"{what} must be a number {low}..{high} (got {text!r})")
        return value

    def _tempo(self, rest):
        self.tune.tempo = self._number(rest, 30, 300, "tempo")

    def _beats(self, rest):
        if rest not in ("2", "3", "4"):
            self.fail(f"beats must be 2, 3 or 4 (got {rest!r})")
        self.tune.beats = int(rest)

    def _swing(self, rest):
        self.tune.swing = self._number(rest, 0.5, 0.75, "swing")

    def _key(self, rest):
        try:
            self.tune.key = scale(rest)
        except ValueError as error:
            self.fail(str(error))

    def _loop(self, rest):
        if rest not in ("yes", "no"):
            self.fail(f"loop must be yes or no (got {rest!r})")
        self.tune.loop = rest == "yes"

    def _voice(self, rest):
        name, *values = rest.split() or self.fail("voice what?")
        if name in self.tune.voices or name in ("chords", "set"):
            self.fail(f"the name {name!r} is taken")
        self.tune.voices[name] = replace(Instrument(), **self._values(values))

    def _values(self, pairs):
        values = {}
        for pair in pairs:
            key, _, text = pair.partition("=")
            if key == "wave" and text in WAVES:
                values["wave"] = text
            elif key == "wave":
                self.fail(f"no wave {text!r}; choose one of {', '.join(WAVES)}")
            elif key == "from":
                values["floor"] = self._pitch(text)
            elif key in RANGES:
                values[key] = self._number(text, *RANGES[key], key)
            else:
                valid = ", ".join("from" if entry.name == "floor" else entry.name for entry in fields(Instrument))
                self.fail(f"an instrument has no {key!r}; it has {valid}")
        return values

    def _pitch(self, text):
        try:
            return pitch(text)
        except ValueError as error:
            self.fail(str(error))

    def _phrase(self, rest):
        name, _, bars = rest.partition(" ")
        if not bars.strip() or name in self.phrases:
            self.fail(f"phrase {name!r} is empty" if name not in self.phrases else f"phrase {name!r} is there already")
        self.phrases[name] = self._bars(bars)

    def _section(self, rest):
        if not re.fullmatch(r"[a-z]\w*", rest) or rest in self.sections:
            self.fail(f"a section needs a name of its own in small letters (got {rest!r})")
        self.section = self.sections[rest] = Section(self.line)

    def _chords(self, rest):
        for bar in _split(rest):
            try:
                symbols = [chord(symbol) for symbol in bar.split()]
            except ValueError as error:
                self.fail(str(error))
            if self.tune.beats * STEPS_PER_BEAT % len(symbols):
                self.fail(f"{len(symbols)} chords do not share a bar equally")
            self.section.chords.append(symbols)

    def _set(self, rest):
        name, *values = rest.split() or self.fail("set which voice?")
        if name not in self.tune.voices:
            self.fail(f"no voice {name!r}; there are: {', '.join(self.tune.voices)}")
        changes, wave = self._values(values), self.tune.voices[name].wave
        if {"echo", "delay"} & set(changes) or (changes.get("wave", wave) == "noise") != (wave == "noise"):
            self.fail("echo, delay and what is noise hold for the whole tune: they belong into the voice line")
        self.section.changes.setdefault(name, {}).update(changes)

    def _bars(self, text):
        """Return the bars of a line, a list of (text of one bar, line number), with phrases and repeats expanded."""
        bars = []
        for bar in _split(text):
            repeated = re.search(r"\s\*(\d+)$", bar)
            inner = bar[: repeated.start()].strip() if repeated else bar
            times = int(repeated[1]) if repeated else 1
            if inner.startswith("@"):
                if inner[1:] not in self.phrases:
                    self.fail(
                        f"no phrase {inner[1:]!r} above this line; there are: {', '.join(self.phrases) or 'none'}"
                    )
                bars += self.phrases[inner[1:]] * times
            else:
                bars += [(inner, self.line)] * times
        return bars

    def _order(self, rest):
        for name, move, mutes in re.findall(r"(\S+?)([+-]\d+)?(?:\(([^)]*)\))?(?:\s+|$)", rest):
            if name not in self.sections:
                self.fail(f"no section {name!r}; there are: {', '.join(self.sections) or 'none'}")
            resting = [mute.removeprefix("-") for mute in mutes.split()]
            for mute in resting:
                if mute not in self.tune.voices:
                    self.fail(f"no voice {mute!r} to rest; there are: {', '.join(self.tune.voices)}")
            self.order.append((name, int(move or 0), resting, self.line))

    def _append(self, name, move, mutes, line):
        """Append the section `name` to the tune.

        move: transposition in semitones; mutes: names of the voices to leave out; line: number of the line, for
        errors.
        """
        section, tune = self.sections[name], self.tune
        bar_steps = tune.beats * STEPS_PER_BEAT
        if not section.chords:
            self.fail(f"section {name} has no chords", section.line)
        first = len(tune.chords)
        tune.parts.append((name, first, len(section.chords) * bar_steps))
        for symbols in section.chords:
            for symbol in symbols:
                tune.chords += [symbol.moved(move)] * (bar_steps // len(symbols))
        tune.keys += [frozenset((each + move) % 12 for each in tune.key)] * (len(section.chords) * bar_steps)
        for voice, bars in section.bars.items():
            if len(bars) != len(section.chords):
                self.fail(
                    f"section {name} has {len(section.chords)} bars of chords, {voice} has {len(bars)}", bars[-1][1]
                )
            if voice not in mutes:
                instrument = replace(tune.voices[voice], **section.changes.get(voice, {}))
                tune.notes[voice] += self._notes(voice, bars, instrument, first, move)

    def _notes(self, voice, bars, instrument, first, move):
        """Return the notes of one voice in one section, a list of Note. Degrees and chord tones are replaced by
        pitches.

        bars: [(text of a bar, line number)]; instrument: the voice's instrument in this section; first: step at which
        the section begins; move: transposition in semitones.
        """
        notes, bar_steps, sounding = [], self.tune.beats * STEPS_PER_BEAT, False
        for index, (bar, line) in enumerate(bars):
            tokens = bar.split()
            if not tokens or bar_steps % len(tokens):
                self.fail(
                    f"{voice}: {len(tokens)} tokens do not share a bar of {bar_steps} steps equally: {bar!r}", line
                )
            steps = bar_steps // len(tokens)
            for place, token in enumerate(tokens):
                start = first + index * bar_steps + place * steps
                if token == "-":
                    if not sounding:
                        self.fail(f"{voice}: nothing to hold in {bar!r}", line)
                    notes[-1] = replace(notes[-1], steps=notes[-1].steps + steps)
                elif token == ".":
                    sounding = False
                else:
                    notes.append(self._note(voice, token, instrument, start, steps, move, line))
                    sounding = True
        return notes

    def _note(self, voice, token, instrument, start, steps, move, line):
        match = (DRUM_TOKEN if instrument.wave == "noise" else TOKEN).fullmatch(token)
        if not match:
            self.fail(f"{voice}: {token!r} is no note, degree, chord tone, drum, - or .", line)
        if instrument.wave == "noise":
            return Note(start, steps, (), match["what"], match["marks"], instrument, line)
        what, at = match["what"], self.tune.chords[start]
        octave = 12 * (match["octaves"].count("'") - match["octaves"].count(","))
        try:
            if what[0] in "ABCDEFG":
                pitches = (pitch(what) + move,)
            elif what.isdigit():
                pitches = (degree_pitch(at, int(what), instrument.floor),)
            else:
                pitches = tuple(tone_pitch(at, "abcdefgh".index(each), instrument.floor) for each in what.strip("[]"))
        except ValueError as error:
            self.fail(f"{voice}: {error}", line)
        return Note(start, steps, tuple(each + octave for each in pitches), "", match["marks"], instrument, line)


def _split(text):
    """Return a list of the texts of a line's bars, which are separated by |. A | at the line's start or end is
    ignored.
    """
    return [bar.strip() for bar in text.strip().strip("|").split("|") if bar.strip()]
