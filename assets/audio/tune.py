"""A tune in memory: instruments, notes, and the chord and key at each step (a sixteenth note)."""

from dataclasses import dataclass, field

from assets.audio.harmony import STEPS_PER_BEAT

WAVES = ("pulse12", "pulse25", "pulse50", "triangle", "soft", "noise")
LOUDER, SOFTER = 1.25, 0.6


@dataclass(frozen=True)
class Instrument:
    """The sound of a voice. Times are in seconds."""

    wave: str = "pulse50"
    volume: float = 0.5  # 0..1
    floor: int = 60  # `from` in the notation: the note at which degrees and chord tones start
    attack: float = 0.004
    decay: float = 0.25  # time constant of the fall to `sustain`
    sustain: float = 0.6  # share of the volume that is held
    release: float = 0.03
    gate: float = 0.9  # share of a note's last step that sounds
    vibrato: float = 0.0  # cents, after a fifth of a second
    bright: float = 5000.0  # [Hz] corner of the low-pass
    echo: float = 0.0  # share of the first repeat; each further one is that share of the one before
    delay: float = 3.0  # steps between repeats
    pan: float = 0.0  # position, -1 left .. 1 right
    spread: float = 0.0  # shift to the left an octave below its middle, to the right an octave above


RANGES: dict[str, tuple[float, float]] = {
    "volume": (0, 1),
    "attack": (0.001, 2),
    "decay": (0.01, 9),
    "sustain": (0, 1),
    "release": (0.005, 3),
    "gate": (0.1, 1),
    "vibrato": (0, 100),
    "bright": (200, 20000),
    "echo": (0, 0.7),
    "delay": (0.25, 16),
    "pan": (-0.8, 0.8),
    "spread": (0, 0.8),
}


@dataclass(frozen=True)
class Note:
    """One note, which starts at step `start` and lasts `steps` steps.

    pitches: its MIDI pitches, of which several make a rapid arpeggio; drums: letters of its drums, if it is a stroke on
    drums; marks: characters after the note in the file, such as "!" for louder (see notation.py); line: line number in
    the file.
    """

    start: int
    steps: int
    pitches: tuple
    drums: str
    marks: str
    instrument: Instrument
    line: int

    @property
    def volume(self):
        """Volume of the instrument, changed by the note's marks for louder and softer."""
        return self.instrument.volume * (LOUDER if "!" in self.marks else 1) * (SOFTER if "?" in self.marks else 1)

    @property
    def place(self):
        """Position in the stereo field, from -1 (left) to 1 (right).

        The pitch an octave above the instrument's `floor` is at its `pan`. Higher pitches are farther right and lower
        ones farther left, in proportion to its `spread`.
        """
        octaves = (self.pitches[0] - self.instrument.floor) / 12 - 1
        return self.instrument.pan + self.instrument.spread * max(-1.0, min(1.0, octaves))


@dataclass
class Tune:
    """A whole tune, step by step.

    parts: list of (name of the section, first step, number of steps), in order.
    """

    name: str = ""
    tempo: float = 0.0
    beats: int = 4
    swing: float = 0.5
    key: frozenset = frozenset()
    loop: bool = True
    voices: dict = field(default_factory=dict)
    notes: dict = field(default_factory=dict)  # voice -> [Note]
    chords: list = field(default_factory=list)  # of each step
    keys: list = field(default_factory=list)  # of each step, pitch classes
    parts: list = field(default_factory=list)

    @property
    def steps(self):
        """Length of the tune in steps."""
        return len(self.chords)

    def seconds(self, step):
        """Return the time at which a step starts [s], including the swing."""
        beat, part = divmod(step, STEPS_PER_BEAT)
        part /= STEPS_PER_BEAT
        part = part * 2 * self.swing if part < 0.5 else self.swing + (part - 0.5) * 2 * (1 - self.swing)
        return (beat + part) * 60.0 / self.tempo
