"""Parser of tunes: the meaning of the tokens, and errors that name file, line and reason."""

import pytest

from assets.audio.harmony import chord, complaints, degree_pitch, pitch, scale, scale_over, tone_pitch
from assets.audio.notation import TuneError, parse_tune, read_tune

GOOD = """name Test ; a comment
tempo 120
key C major
voice lead wave=pulse25 volume=0.5
voice bass wave=triangle from=C2
voice drums wave=noise
phrase beat k . h . | s . kh! .
section one
  chords C | F G
  lead   C5 - - E5 | F5 . G5 -
  bass   1 8 5 3 | 1 5, 1 3'
  drums  @beat
section two
  chords Am7
  lead   [ace] - A5~? -
  set lead volume=0.2 wave=pulse50
order one two one+2(-drums)
"""


def test_notes_lie_where_the_page_says():
    tune = parse_tune(GOOD)
    assert (tune.name, tune.tempo, tune.steps) == ("Test", 120.0, 5 * 16)
    lead = [(note.start, note.steps, note.pitches) for note in tune.notes["lead"]]
    assert lead[:5] == [(0, 12, (72,)), (12, 4, (76,)), (16, 4, (77,)), (24, 8, (79,)), (32, 8, (60, 67, 72))]
    assert lead[6:] == [(48, 12, (74,)), (60, 4, (78,)), (64, 4, (79,)), (72, 8, (81,))], "two semitones up"
    bass = [note.pitches[0] for note in tune.notes["bass"]]
    assert bass == [36, 48, 43, 40, 41, 36, 43, 59, 38, 50, 45, 42, 43, 38, 45, 61]
    assert [(note.start, note.drums) for note in tune.notes["drums"]] == [(0, "k"), (8, "h"), (16, "s"), (24, "kh")]
    assert tune.parts == [("one", 0, 32), ("two", 32, 16), ("one", 48, 32)]


def test_marks_and_set_lines_change_the_loudness():
    tune = parse_tune(GOOD)
    assert [note.volume for note in tune.notes["lead"][4:6]] == pytest.approx([0.2, 0.12])
    assert tune.notes["lead"][4].instrument.wave == "pulse50" and tune.notes["lead"][0].instrument.wave == "pulse25"
    assert tune.notes["drums"][3].volume == pytest.approx(0.5 * 1.25)


def test_swing_delays_the_second_eighth_and_no_beat():
    tune = parse_tune(GOOD.replace("tempo 120", "tempo 120\nswing 0.6"))
    assert [tune.seconds(step) for step in (0, 2, 4, 8)] == pytest.approx([0.0, 0.3, 0.5, 1.0])
    assert tune.seconds(1) == pytest.approx(0.15) and tune.seconds(3) == pytest.approx(0.4)


def test_chords_and_their_tones():
    assert chord("F#m7/E").classes == {6, 9, 1, 4}
    assert pitch("C4") == 60 and pitch("Bb3") == 58 and pitch("F#5") == 78
    assert degree_pitch(chord("C/E"), 1, pitch("C2")) == pitch("E2")
    assert [tone_pitch(chord("G"), index, pitch("C4")) for index in range(4)] == [62, 67, 71, 74]
    assert scale_over(scale("D major"), chord("Bb")) == {1, 2, 5, 7, 10}, "its neighbours make way"


MISTAKES = [
    ("tempo 120", "tempo fast", 2, "tempo must be a number 30..300 (got 'fast')"),
    ("tempo 120", "tempo 0", 2, "tempo must be a number"),
    ("tempo 120", "tempo nan", 2, "tempo must be a number"),
    ("tempo 120", "; none", 17, "the tune has no tempo line"),
    ("key C major", "key H major", 3, "no key 'H major'"),
    ("key C major", "beats 5", 3, "beats must be 2, 3 or 4"),
    ("key C major", "swing 2", 3, "swing must be a number 0.5..0.75"),
    ("key C major", "loop maybe", 3, "loop must be yes or no"),
    ("key C major", "speed 3", 3, "no line starts with 'speed' here; valid: name, tempo"),
    ("wave=pulse25", "wave=sawtooth", 4, "no wave 'sawtooth'; choose one of pulse12"),
    ("volume=0.5", "volume=7", 4, "volume must be a number 0..1 (got '7')"),
    ("volume=0.5", "loudness=1", 4, "an instrument has no 'loudness'; it has wave, volume, from"),
    ("from=C2", "from=X2", 5, "no note 'X2'"),
    ("voice bass", "voice lead", 5, "the name 'lead' is taken"),
    ("phrase beat", "phrase beat ; ", 7, "phrase 'beat' is empty"),
    ("section one", "section", 8, "a section needs a name of its own"),
    ("section two", "section one", 13, "a section needs a name of its own"),
    ("chords C | F G", "chords C | F Gq", 9, "no chord 'Gq'"),
    ("chords C | F G", "chords C | F G A", 9, "3 chords do not share a bar equally"),
    ("chords C | F G", "chords C", 10, "section one has 1 bars of chords"),
    ("C5 - - E5 | F5", "C5 - - E5 | C5 | F5", 10, "section one has 2 bars of chords, lead has 3"),
    ("C5 - - E5", "C5 - E5", 10, "lead: 3 tokens do not share a bar of 16 steps equally: 'C5 - E5'"),
    ("C5 - - E5", "- - - E5", 10, "lead: nothing to hold"),
    ("C5 - - E5", "C5 - - E9", 10, "lead: no note 'E9'"),
    ("C5 - - E5", "C5 - - k", 10, "lead: 'k' is no note"),
    ("1 8 5 3", "1 8 5 7", 11, "bass: chord C has no 7"),
    ("drums  @beat", "drums  @beet", 12, "no phrase 'beet' above this line; there are: beat"),
    ("k . h .", "k . x .", 7, "drums: 'x' is no note, degree, chord tone, drum, - or ."),
    ("set lead", "set leed", 16, "no voice 'leed'"),
    ("set lead", "set", 16, "no voice 'volume=0.2'"),
    ("set lead", "set lead echo=0.5", 16, "echo, delay and what is noise hold for the whole tune"),
    ("set lead volume=0.2 wave=pulse50", "set lead wave=noise", 16, "hold for the whole tune"),
    ("set lead volume=0.2 wave=pulse50", "set drums wave=pulse25", 16, "hold for the whole tune"),
    ("order one two", "order one three", 17, "no section 'three'; there are: one, two"),
    ("(-drums)", "(-drum)", 17, "no voice 'drum' to rest"),
]


@pytest.mark.parametrize(("old", "new", "line", "reason"), MISTAKES, ids=[new for _, new, _, _ in MISTAKES])
def test_a_mistake_is_named_by_file_line_and_reason(old, new, line, reason):
    assert old in GOOD
    with pytest.raises(TuneError) as caught:
        parse_tune(GOOD.replace(old, new, 1), "mine.txt")
    assert str(caught.value).startswith(f"mine.txt: line {line}: ") and reason in str(caught.value)


def test_a_file_is_named_without_its_folder(tmp_path):
    path = tmp_path / "mine.txt"
    path.write_text(GOOD + "order nothing\n")
    with pytest.raises(TuneError, match="^mine.txt: line 18: no section 'nothing'"):
        read_tune(path)


def bars(lead, second="", chords="C | F"):
    lines = [
        "tempo 120",
        "key C major",
        "voice lead wave=pulse25",
        "voice second wave=pulse12",
        "section one",
        f"chords {chords}",
        f"lead {lead}",
    ]
    return parse_tune("\n".join([*lines, f"second {second}" if second else "", "order one"]))


@pytest.mark.parametrize(
    ("lead", "second", "complaint"),
    [
        ("C5 - E5 - | F5 - C5 -", "", ""),
        ("C5 - E5 - | G5 - F5 -", "", ""),  # a suspension goes on by step
        ("C5 - E5 - | B5 - F5 -", "", "83 stands out against F"),
        ("C5 - - - | Eb5 - F5 -", "", "75 is not in the scale over F"),
        ("C5 - - - | - - - -", "", ""),  # a tone of both chords
        ("E5 - - - | - - - -", "", "76 is held into F"),
        ("C5 D5 E5 C5 E5 C5 G5 C5 | F5", "", ""),  # passing by step
        ("C5 A5 E5 C5 E5 C5 G5 C5 | F5", "", "81 is come to and left by leaps over C"),
        ("C5 - E5 - | F5 - C5 -", "C4 | E4 F4 A4 F4", "lead and second are a semitone apart"),
        ("G5 - E5 - | F5 - C5 -", "E4 | A4 - A4 -", ""),
    ],
)
def test_the_rules_of_harmony_hear_a_wrong_note(lead, second, complaint):
    found = [line for line in complaints(bars(lead, second)) if "second: " not in line]
    assert (complaint in " ".join(found)) if complaint else found == [], found


def test_a_close_semitone_is_wrong_even_inside_a_chord():
    assert "semitone" in " ".join(complaints(bars("B4 | A4", "C5 | C5", "Cmaj7 | F")))
    assert complaints(bars("B5 | A5", "C5 | C5", "Cmaj7 | F")) == []
