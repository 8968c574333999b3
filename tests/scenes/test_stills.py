"""Stills: every picture of docs/pictures has an entry, and is taken of a screen with complete measurements."""

import re
from pathlib import Path

import pygame
import pytest

from scenes import SCENES, stills
from scenes.stills import STILLS, Still, missing

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs/pictures"


def test_every_picture_has_an_entry_and_every_entry_a_picture():
    assert {path.stem for path in PICTURES.glob("*.png")} == set(STILLS)
    shown = set(re.findall(r"pictures/(\w+)\.png", (ROOT / "docs/manual.md").read_text(encoding="utf-8")))
    assert shown and shown <= set(STILLS)
    assert {still.scene for still in STILLS.values()} <= set(SCENES)


@pytest.mark.parametrize("name", STILLS)
def test_a_picture_is_as_large_as_a_screenshot(name):
    assert pygame.image.load(PICTURES / f"{name}.png").get_size() == (1440, 810)


@pytest.mark.parametrize(
    "text, waits",
    [
        ("measuring", True),
        ("measuring, 3 of 9 shots", True),
        ("-", True),
        ("- m/s", False),
        ("-16.75", False),
        ("12 of 19 settings measured, 5 runs each", True),
        ("19 of 19 settings measured, 5 runs each", False),
        ("3 of 9", False),
    ],
)
def test_a_still_waits_for_the_numbers_that_are_missing(text, waits):
    assert missing(text) == waits


def test_a_still_is_the_screen_at_its_step(tmp_path):
    stills.take(Still("lab/one_way", 20), tmp_path / "one.png")
    play = stills.played(Still("lab/one_way", 20))
    assert play.scene.frame == 20
    first = pygame.surfarray.array3d(pygame.image.load(tmp_path / "one.png"))
    assert first.shape == (1440, 810, 3) and first.std() > 8


@pytest.mark.parametrize("names, reason", [(["nowhere"], "nowhere is no folder"), ([".", "moon"], "'moon'")])
def test_wrong_arguments_end_with_the_reason(names, reason, capsys):
    with pytest.raises(SystemExit):
        stills.main(names)
    assert reason in capsys.readouterr().err
