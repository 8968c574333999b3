"""The labs speak in plain words: no exponents, identifiers or Python values in cards, goals, findings and labels."""

import re

import pytest

import physics
from game.drawing.number_text import error_text, gap_text, share_text, tier_name
from game.registry import Registry
from game.run.figures_csv import figures_of
from game.run.session import Session
from game.run.sources import BotSource
from game.screens.parts.lab_card import what_to_see
from scenes import SCENES
from scenes.lab.machines.kinds import MACHINES
from tests.architecture import ROOT
from tests.game.test_findings import PLAYED, USUAL
from tests.game.test_findings import figures_of as measured_figures
from tests.lockstep import make_scene

LABS = [name for name in SCENES if name.startswith("lab/")]
RAW = re.compile(r"\d(\.\d*)?e[-+]?\d|0x|\b(True|False|None|nan|inf|aabb|obb)\b|[a-z]_[a-z]")
FILES = re.compile(r"[\w/]+\.(py|md)\b|b2\w+|pygame\.mask")  # cited, not said
needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of frames")


def raw_words(text):
    return [found.group() for found in RAW.finditer(FILES.sub("", text))]


@pytest.mark.parametrize("name", LABS)
def test_a_card_has_no_raw_words(name):
    scene_class = Registry(SCENES).scene_class(name)
    for text in (*what_to_see(scene_class), scene_class.title, scene_class.about, *scene_class.features):
        assert not raw_words(text), text


@needs_speed
@pytest.mark.parametrize("name", LABS)
def test_goals_findings_and_labels_have_no_raw_words(name):
    scene = make_scene(name, few=True)
    session = Session(scene, BotSource())
    for steps in (2, max(PLAYED.get(name, USUAL))):
        for _ in range(steps):
            session.step()
        if scene.measured() is not None:
            scene.figures = measured_figures(scene)
        headline = scene.headline()
        texts = [headline.sentence, headline.mend, headline.unit, headline.number, scene.finding()]
        texts += [goal.text for goal in scene.check()]
        for figure in figures_of(scene):
            texts += [figure.name, figure.unit, figure.value if isinstance(figure.value, str) else ""]
        for text in texts:
            assert not raw_words(text), text


@pytest.mark.parametrize("machine", MACHINES)
def test_goals_of_machines_have_no_raw_words(machine):
    for results in (None, (0.5, 1, 1e-7, 7.0)):
        try:
            goals = machine.goals(results, results)
        except ValueError:  # a machine with another number of figures
            continue
        for name, _, detail in goals:
            assert not raw_words(f"{name}: {detail}")


def test_no_text_of_a_lab_is_written_with_an_exponent():
    for path in sorted((ROOT / "scenes/lab").rglob("*.py")):
        assert not re.search(r"\{[^{}]*:[+]?\.\d+e\}", path.read_text()), path


@pytest.mark.parametrize(
    "share, text, error",
    [
        (0.0, "0 %", "no error that can be told"),
        (5e-17, "0 %", "no error that can be told"),
        (4e-6, "under 0.001 %", "off by under 0.001 %"),
        (0.00015, "0.015 %", "off by 0.015 %"),
        (0.005, "0.5 %", "off by 0.5 %"),
        (0.033, "3.3 %", "off by 3.3 %"),
        (1.0, "100.0 %", "off by 100.0 %"),
    ],
)
def test_shares_in_plain_digits(share, text, error):
    assert share_text(share) == text and error_text(share) == error


def test_lengths_and_tiers_in_plain_words():
    assert [gap_text(each) for each in (7e-15, 1e-6, 0.0123, 72.3)] == [
        "no difference that can be told", "under 0.001 px", "0.012 px", "72.300 px"
    ]  # fmt: skip
    assert [tier_name(each) for each in ("aabb", "obb", "mask", "hull")] == ["box", "turned box", "exact", "hull"]
