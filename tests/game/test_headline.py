"""Every lab has a headline: one sentence, and one large number with its unit, measured in the current run."""

import re

import pygame
import pytest

import physics
from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, Canvas
from game.drawing.headline import LARGE, Headline, draw_headline
from game.input.devices import DeviceSource
from game.run.picture import Picture
from game.screens.play import Play
from scenes import SCENES
from tests.game.reading import assert_text_is_apart
from tests.game.test_findings import PLAYED, USUAL
from tests.game.test_lab_card import Silent
from tests.lockstep import make_scene

pytestmark = pytest.mark.usefixtures("nothing_is_measured")
LABS = [name for name in SCENES if name.startswith("lab/")]
SIZES = [(480, 270), (640, 360), (960, 540), (1440, 810), (1920, 1080)]
AT_ONCE = {"lab/ladder"}  # counted when the sprite is taken
WORDS = 14
LATER = 400  # steps after which all labs that need no player have a number
PLAYED_BY_HAND = {"lab/carving", "lab/billiards", "lab/one_way"}
needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of frames")


def in_the_band(frame, play):
    band = frame.from_canvas((0, 0, CANVAS_SIZE[0], play.scene.head))
    return [(rect, text) for rect, text in frame.boxes if band.colliderect(rect)], band


def assert_it_is_shown(play, size, waits):
    headline = play.scene.headline()
    assert len(headline.sentence.split()) <= WORDS, headline.sentence
    play.helped_since = -10_000  # the line of keys is gone
    play.switches.until = play.switches.now
    frame = play.draw(Picture(pygame.Surface(size)))
    assert_text_is_apart(frame.boxes, frame.rect)
    shown, band = in_the_band(frame, play)
    assert all(band.contains(rect) for rect, _ in shown), size
    words = " ".join(text for _, text in shown)
    assert all(word in words for word in f"{headline.sentence} {headline.mend}".split()), words
    if waits:
        assert headline.waiting in words and "measuring" in words
    else:
        assert re.search(r"\d", headline.number) and headline.unit
        assert headline.number in words and all(word in words for word in headline.unit.split())


@needs_speed
@pytest.mark.parametrize("name", LABS)
def test_a_lab_shows_one_sentence_and_one_number_once_there_are_enough_data(name):
    play = Play(make_scene(name, few=True), DeviceSource(), Silent())
    first = play.scene.headline()
    assert first.known == (name in AT_ONCE), "nothing is shown before it is measured"
    for size in SIZES:
        assert_it_is_shown(play, size, waits=not first.known)
    for _ in range(max(LATER, *PLAYED.get(name, USUAL))):
        play.step()
        if play.scene.headline().known and play.scene.frame > 60:
            break
    waits = name in PLAYED_BY_HAND or name == "lab/disagreement"
    assert play.scene.headline().known or waits
    for size in SIZES:
        assert_it_is_shown(play, size, waits=not play.scene.headline().known)


@needs_speed
@pytest.mark.parametrize("name", LABS)
def test_its_words_fit_with_every_value_of_the_sliders(name):
    scene = make_scene(name, few=True)
    for slider in scene.sliders:
        values = range(int(slider.low), int(slider.high) + 1) if slider.choices else (slider.low, slider.high)
        for value in values:
            scene.change_slider(slider.name, value)
            headline = scene.headline()
            assert len(headline.sentence.split()) <= WORDS, headline.sentence
            canvas = Canvas()
            draw_headline(canvas, scene.title, headline._replace(seen=headline.needed), scene.head)
            assert_text_is_apart(canvas.boxes, pygame.Rect(0, 0, CANVAS_SIZE[0], scene.head))
        if name not in ("lab/broadphases", "lab/queries"):  # thousands of bodies
            scene.change_slider(slider.name, slider.start)


def test_overlays_do_not_cover_the_title_line():
    frames = []
    for layers in ((), ("bounds", "motion", "structure", "pairs", "contacts", "outlines")):
        play = Play(make_scene("lab/one_way"), DeviceSource(), Silent(), overlays=layers)
        for _ in range(90):
            play.step()
        play.helped_since = -10_000
        frame = play.draw(Picture(pygame.Surface((960, 540))))
        frames.append(pygame.surfarray.array3d(frame.surface)[:, : 2 * play.scene.head])
    assert (frames[0] == frames[1]).all()


def test_the_keys_leave_the_number_free():
    play = Play(make_scene("lab/tunnelling"), DeviceSource(), Silent())
    for _ in range(120):
        play.step()
    headline = play.scene.headline()
    frame = play.draw(Picture(pygame.Surface((1440, 810))))
    shown = " ".join(text for _, text in in_the_band(frame, play)[0])
    assert headline.number in shown and "speed" in " ".join(text for _, text in frame.boxes)


def test_a_number_waits_for_its_data():
    canvas = Canvas()
    draw_headline(canvas, "A lab", Headline("It fails.", "Space: mend", "7 of 9", "went through", 3, 9, "shots"), 16)
    words = [text for _, text in canvas.boxes]
    assert "measuring, 3 of 9 shots" in words and "7 of 9" not in words
    draw_headline(canvas, "A lab", Headline("It fails.", "Space: mend", "7 of 9", "went through", 9, 9, "shots"), 16)
    boxes = {text: rect for rect, text in canvas.boxes}
    assert "7 of 9" in boxes and boxes["7 of 9"].width == canvas.measure("7 of 9", TEXT, LARGE)[0]
    assert boxes["A LAB"].height > boxes["It fails."].height == canvas.measure("It", SMALL)[1]


@needs_speed
@pytest.mark.parametrize(
    "name, values, fails",
    [
        ("lab/tunnelling", {}, True),
        ("lab/tunnelling", {"speed": 300, "plate": 16}, False),
        ("lab/tunnelling", {"speed": 12000}, True),
        ("lab/mask_sweep", {}, True),
        ("lab/mask_sweep", {"speed": 300}, None),
        ("lab/stacks", {}, True),
        ("lab/stacks", {"crates": 4, "substeps": 8}, None),
        ("lab/sensors", {}, True),
        ("lab/sensors", {"speed": 60, "scanner": 300}, False),
        ("lab/sensors", {"events": 1}, False),
        ("lab/ghost_bumps", {}, True),
        ("lab/ghost_bumps", {"speed": 600, "solver": 1}, False),
        ("lab/disagreement", {}, None),
        ("lab/shapes", {}, True),
        ("lab/shapes", {"step": 24}, False),
        ("lab/dominoes", {}, True),
        ("lab/dominoes", {"substeps": 4}, False),
        ("lab/conveyor", {}, True),
        ("lab/conveyor", {"speed": 60}, False),
        ("lab/filters", {}, True),
        ("lab/tumbler", {}, True),
        ("lab/tumbler", {"speed": 2.0, "substeps": 4}, False),
        ("lab/one_way", {}, True),
        ("lab/one_way", {"throw every": 20, "planks": 1}, False),
    ],
)
def test_a_sentence_claims_only_what_the_number_shows(name, values, fails):
    scene = make_scene(name)
    for slider, value in values.items():
        scene.change_slider(slider, value)
    play = Play(scene, DeviceSource(), Silent())
    for _ in range(60 if name == "lab/disagreement" else 400):
        headline = scene.headline()
        assert headline.sentence.endswith("?") == (headline.good or not headline.known), headline
        play.step()
    assert fails is None or headline.good != fails, headline
