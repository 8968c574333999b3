"""Regression tests of visible defects: overlays over the score, keys across the picture, times of one slow step, cut
names.
"""

import re
from importlib import import_module

import numpy as np
import pygame
import pytest

import game.screens.parts.first_hint as first_hint
from game.audio.sound import Sounds
from game.drawing.number_text import plain_name
from game.drawing.typical import KEPT, Typical
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.overlays.layer import Layer
from game.overlays.layer_times import Times
from game.overlays.stack import LAYERS, layer_names
from game.registry import Registry
from game.run.picture import Picture
from game.screens.parts.panel import LINE, SLIDER
from game.screens.parts.switches import REPORT_SECONDS
from game.screens.play import Play
from physics import SOLVERS
from scenes import SCENES
from tests.architecture import ROOT

REGISTRY = Registry(SCENES)
WINDOWS = {"x2": (960, 540), "x3": (1440, 810)}
LABS = [name for name in SCENES if name.startswith("lab/")]
pytestmark = pytest.mark.usefixtures("nothing_is_measured")


def screen(name, frames=30, layers=(), person=True, hint=False):
    """Return a screen (`Play`) with a scene that has been played for some frames.

    person: True if a person plays, False for the bot. hint: True shows the hint of the first start.
    """
    scene = REGISTRY.scene_class(name)(0)
    settings = Settings()
    settings.hint_seen = not hint
    play = Play(scene, DeviceSource(), Sounds(silent=True), not person, overlays=layers, settings=settings)
    for _ in range(frames):
        play.step()
    play.clock.accumulator = play.clock.step / 2
    return play


def pixels(surface, rect):
    return pygame.surfarray.array3d(surface.subsurface(rect.clip(surface.get_rect())))


@pytest.mark.parametrize("name", SCENES)
def test_words_and_bars_lie_over_all_overlays(name):
    play = screen(name, 12 if name == "lab/broadphases" else 45, person=False)
    play.session.report.steps = 10_000  # no line of keys
    play.clock.accumulator = play.clock.step  # at the last step's poses, as with overlays
    for window in WINDOWS:
        words_and_bars_lie_over_all_overlays(play, window)


def words_and_bars_lie_over_all_overlays(play, window):
    play.overlays.on = set()
    picture = Picture(pygame.Surface(WINDOWS[window]))
    layers = [layer for layer in layer_names() if layer != "times"]
    plain = play.draw(picture)
    fixed, bare = [rect.copy() for rect in plain.fixed], plain.surface.copy()
    words = [(rect.copy(), text) for rect, text in plain.boxes]
    play.overlays.on = set(layers)
    picture.presenter.frame.surface = pygame.Surface(WINDOWS[window])
    over = play.draw(picture)
    standing = {(tuple(rect), text) for rect, text in over.boxes}
    legend = over.boxes[len(words) :]
    for rect, text in [*words, *((rect, "") for rect in fixed)]:
        if text and (tuple(rect), text) not in standing:
            continue
        if any(rect.colliderect(other) for other, _ in legend):
            continue
        assert (pixels(over.surface, rect) == pixels(bare, rect)).all(), f"{text!r} at {rect}"


@pytest.mark.parametrize("name", LABS)
def test_the_line_of_a_lab_stands_in_a_free_place(name):
    play = screen(name)
    for window in WINDOWS:
        for state in ("keys", "frozen", "slow"):
            the_line_stands_in_a_free_place(play, window, state)


def the_line_stands_in_a_free_place(play, window, state):
    play.clock.paused, play.clock.speed = state == "frozen", 0.25 if state == "slow" else 1.0
    frame = play.draw(Picture(pygame.Surface(WINDOWS[window])))
    wanted = {"keys": "Esc menu", "frozen": "FROZEN", "slow": "SPEED"}[state]
    lines = [rect for rect, text in frame.boxes if wanted in text]
    assert len(lines) == 1 and frame.area.contains(lines[0])
    head, headline = frame.from_canvas((0, 0, 480, play.scene.head)), play.scene.headline()
    number = headline.number if headline.known else headline.waiting
    covered = [text for rect, text in frame.boxes if rect != lines[0] and rect.colliderect(lines[0])]
    assert number not in covered
    assert head.contains(lines[0]) or not covered


@pytest.mark.parametrize("name", [name for name in SCENES if REGISTRY.scene_class(name).sliders])
def test_sliders_are_in_sight_in_a_small_window(name):
    play = screen(name, 5)
    play.panel_open = True
    frame = play.draw(Picture(pygame.Surface(WINDOWS["x2"])))
    rows = play.panel.rows()
    shown = {number for _, number in play.panel.places}
    for number, row in enumerate(rows):
        if row.kind == SLIDER or (row.label in play.scene.values and row.kind != LINE):  # effects are named so too
            assert number in shown, f"{row.label} is hidden"
    for plot in frame.fixed:  # plots keep their text inside
        for rect, text in frame.boxes:
            if rect.colliderect(plot) and plot.height > 40 * frame.scale:
                assert plot.contains(rect), f"{text!r} leaves its plot"


@pytest.mark.parametrize("name", ["shooter", "platformer", "lab/pyramid"])
@pytest.mark.parametrize("window", WINDOWS)
@pytest.mark.parametrize("panel", [False, True])
def test_the_graph_of_times_hides_no_stage_and_no_bar(name, window, panel, monkeypatch):
    play = screen(name, 30, ("times",))
    play.hint = None  # a lab's card covers what it needs to, until it is put away
    play.panel_open = panel
    plots = []
    scroll = Times._scroll

    def noted(times, size, *more):
        plots.append(size)
        scroll(times, size, *more)

    monkeypatch.setattr(Times, "_scroll", noted)
    blits = []
    surface = pygame.Surface(WINDOWS[window])
    frame = play.draw(Picture(surface))
    texts = [text for _, text in frame.boxes]
    for stage in play.overlays.times.stages:
        assert plain_name(stage) in texts, f"{stage} is hidden"
    assert not any(re.fullmatch(r"and \d+ more", text) for text in texts)
    assert len(plots) == 1 and plots[0][1] >= 4 and not blits
    top = next(rect for rect, text in frame.boxes if text.startswith("top "))
    plot = pygame.Rect(top.left, top.bottom + frame.text_scale, *plots[0])
    for rect, text in frame.boxes:
        assert not rect.colliderect(plot), f"{text!r} lies on the bars"


def test_one_slow_step_is_not_a_figure():
    typical = Typical()
    assert typical.value == 0.0
    for value in [1.0] * 20 + [1107.0] + [1.0] * 20 + [900.0, 3.0]:
        typical.note(value)
        assert typical.value == 1.0
    for _ in range(KEPT):
        typical.note(5.0)
    assert typical.value == 5.0 == np.median(list(typical.last))


@pytest.mark.parametrize("name", ["lab/gallery"])
def test_a_slow_step_is_not_shown(name, monkeypatch):
    play = screen(name, 20)
    scene = play.scene
    for world in scene.worlds:
        for stage in world.profile.stages:
            world.profile.stages[stage] = 3.0  # seconds
    scene.observe()
    play.overlays.note(scene)
    play.session.report.steps = 10_000
    frame = play.draw(Picture(pygame.Surface(WINDOWS["x3"])))
    figures = [text for _, text in frame.boxes if re.search(r"[\d,.]+ (ms|us) a step$", text)]
    assert figures
    for text in figures:
        value, unit = text.split()[:2]
        assert float(value.replace(",", "")) < (2.9e6 if unit == "us" else 2.9e3)


@pytest.mark.parametrize("name", SCENES)
def test_a_solver_has_one_name(name):
    play = screen(name, 3)
    play.panel_open = True
    frame = play.draw(Picture(pygame.Surface((1920, 1080))))
    drawn = " | ".join(text for _, text in frame.boxes)
    for wrong in ("push out", "impulses |", *(solver for solver in SOLVERS if "_" in solver)):
        assert wrong not in drawn
    scene_class = type(play.scene)
    said = " ".join((scene_class.about, *scene_class.features, *(goal.name for goal in play.scene.check())))
    assert not re.search(r"push(ing|es)? out|push-out|sequential impulses", said)


@pytest.mark.parametrize("name", SCENES)
def test_filters_are_named(name):
    play = screen(name, 60, ("filters",), person=False)
    play.draw(Picture(pygame.Surface(WINDOWS["x3"])))
    lines = [text for _, text in play.overlays.filters.notes()][1:]
    assert lines
    for line in lines:
        assert re.fullmatch(r"\d+ [a-z][a-z ,-]* meet [a-z][a-z ,-]*( and \d+ more)?|and \d+ more", line), line
        assert "some" not in line and "others" not in line


@pytest.mark.parametrize("name", SCENES)
def test_what_is_switched_is_said(name):
    play = screen(name, 3)
    scene = play.scene
    play.advance(10.0)

    def said(key):
        play.feed(pygame.event.Event(pygame.KEYDOWN, key=key, mod=0, unicode=""))
        frame = play.draw(Picture(pygame.Surface(WINDOWS["x2"])))
        assert any(play.news in text for _, text in frame.boxes), play.news
        return play.news

    line = said(pygame.K_b)
    if scene.switches_broadphase:
        new = dict(play.devices.changes)["broadphase"]
        assert line == f"broad phase: {new}, was {scene.broadphase}" and new != scene.broadphase
    line = said(pygame.K_v)
    if scene.solver_choices():
        new = dict(play.devices.changes)["solver"]
        assert plain_name(new) in line and "was " in line
    line = said(pygame.K_t)
    if scene.tiers:
        assert line == f"tested as: {dict(play.devices.changes)['tier']}, was {scene.tier}"
    before = scene.narrowphase
    assert ("on, was off" if not before else "off, was on") in said(pygame.K_n)
    play.clock.paused = True
    play.advance(10.1 + REPORT_SECONDS)
    assert play.news == ""


@pytest.mark.parametrize("window", WINDOWS)
@pytest.mark.parametrize("name, needed", [("shooter", ("fire", "focus", "bomb")), ("platformer", ("jump",))])
def test_a_new_player_is_told_what_the_keys_do(name, needed, window):
    play = screen(name, 400, hint=True)
    picture = Picture(pygame.Surface(WINDOWS[window]))

    def reported():
        frame = play.draw(picture)
        return all(any(word in text for _, text in frame.boxes) for word in needed)

    assert play.hint is not None and reported(), "while the card is up"
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=first_hint.KEYS[1], mod=0, unicode=""))
    assert play.hint is None
    for _ in range(120):
        play.step()
    assert reported(), "and for a while after it"
    for _ in range(600):
        play.step()
    assert not reported()


@pytest.mark.parametrize(
    "name, ends",
    [
        ("lab/dominoes", lambda scene: scene._push()),
        ("lab/card_house", lambda scene: scene.cards[-1].move_to((20.0, 100.0), 0.0)),
        ("lab/stacks", lambda scene: [top.move_to((0.0, 300.0), 0.0) for top in scene.tops]),
        ("lab/pyramid", lambda scene: scene.top.move_to((900.0, -20.0), 0.0)),
        ("lab/cradle", lambda scene: setattr(scene.balls[1][2], "velocity", (33.0, 0.0))),
        ("lab/billiards", lambda scene: [scene.ball_names.pop(ball) for ball in list(scene.ball_names)[1:]]),
    ],
)
def test_a_lab_that_is_over_offers_another_run(name, ends):
    play = screen(name, 3)
    picture = Picture(pygame.Surface(WINDOWS["x2"]))
    assert play.scene.offer == ""
    ends(play.scene)
    for _ in range(600 if name == "lab/dominoes" else 0):
        play.step()
    play.session.report.steps = 10_000
    offer = play.scene.offer
    frame = play.draw(picture)
    assert offer and any(f"R {offer}" in text for _, text in frame.boxes)
    assert any("Esc menu" in text for _, text in frame.boxes), "with the keys"
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_r, mod=0, unicode=""))
    play.step()
    assert play.scene.offer == "" and play.scene.frame == 0 or play.scene.frame == 1


def test_all_layers_are_there():
    """Every layer class of a file layer_*.py is in the list LAYERS once."""
    modules = [import_module(f"game.overlays.{path.stem}") for path in (ROOT / "game/overlays").glob("layer_*.py")]
    there = {each for module in modules for each in vars(module).values() if isinstance(each, type)}
    assert {each for each in there if issubclass(each, Layer)} - {Layer} == set(LAYERS)
    assert len(set(layer_names())) == len(LAYERS)
