"""docs/manual.md names exactly the flags, overlays and settings of the program; README.md is short."""

import re
from pathlib import Path

import pytest

from game.command_line import make_parser
from game.overlays.stack import LAYERS
from physics import BROADPHASES

ROOT = Path(__file__).resolve().parents[1]
LONGEST = 170  # lines of the README


def section(title):
    text = (ROOT / "docs/manual.md").read_text(encoding="utf-8")
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", text, re.DOTALL | re.MULTILINE)
    assert found, f"docs/manual.md has no section {title!r}"
    return found.group(1)


def cells(text):
    """Return the rows of a section's table, each as a list of its cells."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]
    return rows[2:]


def test_every_flag_is_in_the_manual_and_no_other():
    flags = {name for action in make_parser()._actions for name in action.option_strings if name.startswith("--")}
    told = set(re.findall(r"--[a-z]+", section("Flags")))
    assert told == flags, f"not told: {sorted(flags - told)}; there is no {sorted(told - flags)}"


def test_the_names_of_broad_phases_are_those_of_the_flag():
    for name in BROADPHASES:
        assert name in section("Flags")


def test_every_overlay_is_in_the_manual_with_its_key():
    told = {}
    for names, keys, _ in cells(section("Overlays")):
        told |= dict(zip(re.findall(r"`([a-z]+)`", names), re.split(", ?", keys), strict=True))
    assert told == {layer.name: layer.key.upper() for layer in LAYERS}


@pytest.mark.parametrize("key", ["Esc", "Tab", "E", "F1", "M", "K", "P, O"])
def test_the_keys_of_every_scene_are_in_the_manual(key):
    assert any(row[0].startswith(key) for row in cells(section("Keys")))


def test_the_readme_is_short_and_opens_with_the_games_in_motion():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGEST
    opening = text.split("\n## ")[0]
    (picture,) = re.findall(r"!\[[^]]+\]\(([^)]+)\)", opening)
    kept = ROOT / picture
    content = kept.read_bytes()
    assert kept.suffix == ".webp" and b"ANIM" in content[:64] and content.count(b"ANMF") > 100
    assert len(content) <= 3e6, f"{picture} has {len(content):,} bytes"
