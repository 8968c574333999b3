"""docs/examples/: the scene of CONTRIBUTING.md is whole in 40 lines; it is listed, played and judged as any."""

import json
import re
from pathlib import Path

import pygame
import pytest

from game.command_line import run
from game.registry import Registry
from game.scene import Scene, Slider

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "docs" / "examples"
LISTING = {"example/bounce": "bounce:Bounce"}


@pytest.fixture
def registry(monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    return Registry(LISTING)


def test_every_example_is_tried_here_and_short():
    files = sorted(EXAMPLES.glob("*.py"))
    assert {path.stem for path in files} == {place.split(":")[0] for place in LISTING.values()}
    for path in files:
        assert len(path.read_text().splitlines()) <= 40, path.name


@pytest.mark.parametrize("name", LISTING)
def test_an_example_is_a_scene_that_its_bot_wins(name, registry, capsys):
    assert issubclass(registry.scene_class(name), Scene)
    assert run(["--scene", name, "--headless", "--bot", "--frames", "300", "--json"], registry) == 0
    reported = json.loads(capsys.readouterr().out)
    assert reported["frames"] == 300 and reported["check"] == {"ok": True, "failures": [], "pending": []}


def test_the_ball_is_judged(registry, monkeypatch, capsys):
    """Its goal is not met by itself: a ball that the slider belies is told of."""
    bounce = registry.scene_class("example/bounce")
    monkeypatch.setattr(bounce, "sliders", (Slider("restitution", 0.4, 0.9, 0.5, step=0.1),))
    scene = bounce(seed=1)
    scene.values["restitution"] = 0.9
    for _ in range(240):
        scene.update(None)
    assert [goal.met for goal in scene.check()] == [False]
    scene.restart()
    for _ in range(240):
        scene.update(None)
    assert [goal.met for goal in scene.check()] == [True], "the slider holds from the restart on"


def test_it_draws_a_ball_where_it_is(registry):
    scene = registry.scene_class("example/bounce")(seed=1)

    class Canvas:
        surface = pygame.Surface((480, 270))

    scene.draw(Canvas, 0.0)
    assert Canvas.surface.get_at((240, 40)) == pygame.Color("gold")
    assert Canvas.surface.get_at((240, 100)) == pygame.Color("navy")


def test_contributing_shows_the_example_as_it_is():
    """The page names the file, and its links lead somewhere."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    links = re.findall(r"\]\(([^)#:]+)\)", text)
    assert "docs/examples/bounce.py" in links
    for link in links:
        assert (ROOT / link).exists(), f"CONTRIBUTING.md links to {link}, which is not there"
    for command in re.findall(r"python -m (tests\.\w+|assets[\w.]*|scenes[\w.]*)", text):
        place = ROOT / command.replace(".", "/")
        assert place.with_suffix(".py").exists() or (place / "__main__.py").exists(), command
