"""The split screen that opens "What accuracy costs", and how every menu leads to it.

On its side with boxes planes are hit; on its side with pixels they never are.
"""

import re
from itertools import combinations
from pathlib import Path

import pygame
import pytest

from game.drawing.number_text import plain_name
from game.drawing.sprites import load_atlas
from game.measure.ledger import EFFECTS
from game.run.picture import Picture
from game.screens.near_misses import CLEAR, HITS, NearMisses, corner, course
from game.screens.play import Play
from game.screens.tour import MISSES, STOPS
from scenes import SCENES
from tests.game.reading import Reader, assert_text_is_apart

ROOT = Path(__file__).resolve().parents[2]
DTS = (1 / 30, 1 / 60, 1 / 75, 1 / 120)


@pytest.fixture(autouse=True)
def display():
    pygame.display.init()
    pygame.display.set_mode((480, 270))


@pytest.mark.parametrize("dt", DTS)
def test_boxes_kill_at_nearly_every_pass_and_pixels_never(dt):
    shown = NearMisses(dt)
    for _ in range(3 * round(shown.length / dt)):
        shown.advance(dt)
    boxes, pixels = shown.flights
    assert boxes.deaths >= 2 * len(shown.misses) and pixels.deaths == 0


@pytest.mark.parametrize("dt", DTS)
def test_the_sprites_as_drawn_never_come_closer_than_a_stranger_can_see(dt):
    """The visible pixels of the sprites keep a visible distance at every step of the loop.

    The test computes the distance of the nearest pixels itself, independently of the code that placed the sprites.
    """
    shown, planes = NearMisses(dt), load_atlas("planes")
    flight = shown.flights[1]
    solid = {name: pygame.mask.from_surface(planes[name]).outline() for name in {m.sprite for m in shown.misses}}
    own = pygame.mask.from_surface(planes["player"]).outline()
    nearest = {}
    for _ in range(round(shown.length / dt)):
        shown.advance(dt)
        a = corner(planes["player"], *flight.plane.position)
        for number, (miss, body) in enumerate(zip(shown.misses, flight.others, strict=True)):
            b = corner(planes[miss.sprite], *body.position)
            if abs(body.position.y - flight.plane.position.y) < 40:
                found = min(
                    max(abs(b[0] + x - a[0] - u), abs(b[1] + y - a[1] - v))
                    for x, y in solid[miss.sprite]
                    for u, v in own
                )
                nearest[number] = min(nearest.get(number, 99), found)
    assert len(nearest) == len(shown.misses)
    assert all(CLEAR < gap <= CLEAR + 8 for gap in nearest.values()), nearest


def test_nothing_is_said_of_the_price_before_it_is_measured_and_noise_is_no_price():
    shown = NearMisses()
    boxes, pixels = shown.flights
    assert shown.price() == ""
    boxes.deaths = HITS
    boxes.seconds = [1e-5] * HITS
    for seconds, wanted in (
        ([1.5e-5] * HITS, "for 1.50 x the time"),
        ([0.5e-5] * HITS, "for 0.50 x the time"),
        ([0.9e-5, 1.1e-5] + [1.0e-5] * (HITS - 2), "for the same time"),
    ):
        pixels.seconds = seconds
        assert shown.price() == wanted
    boxes.deaths = HITS - 1
    assert shown.price() == ""


@pytest.mark.parametrize("size", ((480, 270), (960, 540), (1440, 810), (1920, 1080)))
@pytest.mark.parametrize("steps", (1, 90, 700))
def test_every_text_is_whole_at_every_size(size, steps):
    shown = NearMisses()
    for _ in range(steps):
        shown.advance(1 / 60)
    with Reader() as reader:
        frame = Picture(pygame.Surface(size)).draw_screen(shown)
        assert_text_is_apart(frame.boxes, frame.rect)
        reader.assert_readable()
    words = " ".join(text for _, text in frame.boxes)
    assert ("by pixels never" in words) == (steps == 700) and ("measuring" in words) == (steps == 1)


def test_the_course_is_the_same_each_time():
    assert course(1 / 60) == course(1 / 60)
    assert all(a.start != b.start for a, b in combinations(course(1 / 60)[0], 2))


@pytest.fixture
def driver(drive):
    driver = drive(listing=SCENES)
    yield driver
    if driver.app.screens.played is not None:
        driver.app.screens.played.close()


def press(driver, *keys):
    for key in keys:
        driver.key(key)
        driver.turns(40)


def test_three_keys_lead_a_stranger_from_the_title_to_the_false_hits_of_boxes(driver):
    """Three keys lead from the title to the plot of false hits of boxes: Down and Enter to the split screen, Enter to
    the plot.

    The plot opens in the shooter with its sentence.
    """
    press(driver, pygame.K_DOWN, pygame.K_RETURN)
    assert driver.name == "NearMisses"
    press(driver, pygame.K_RETURN)
    play = driver.screen
    assert isinstance(play, Play) and play.costs_open and play.scene.name == "shooter" and not play.person
    survey = play.measuring.surveyor.survey
    for _ in range(1200):
        driver.turns(10)
        play.measuring.surveyor.wait(0.05)
        if survey.boxes_and_pixels():
            break
    assert survey.boxes_and_pixels().startswith("Boxes")
    play.costs.sheet = None
    driver.turns(2)
    words = " ".join(text for _, text in driver.app.arcade.picture.presenter.frame.boxes)
    assert "Boxes" in words and "hits" in words
    press(driver, pygame.K_m, pygame.K_ESCAPE)
    assert driver.name in ("Menu", "Title")


def test_escape_leads_back_to_the_title(driver):
    press(driver, pygame.K_DOWN, pygame.K_RETURN, pygame.K_ESCAPE)
    assert driver.name == "Title"


def test_the_title_opens_the_lab_of_effects(driver):
    press(driver, pygame.K_DOWN, pygame.K_DOWN, pygame.K_RETURN)
    assert isinstance(driver.screen, Play) and driver.screen.scene.name == "lab/effects"


@pytest.mark.parametrize("downs, opened", ((0, "costs_open"), (1, "panel_open")))
def test_the_pause_menu_opens_both_beside_the_game_that_was_paused(driver, downs, opened):
    driver.app.screens.play("platformer")
    driver.turns(20)
    play = driver.screen
    press(driver, pygame.K_ESCAPE)
    assert driver.name == "PauseMenu"
    labels = [row.label for row in driver.screen.list.rows()]
    for _ in range(labels.index("What accuracy costs") + downs):
        press(driver, pygame.K_DOWN)
    press(driver, pygame.K_RETURN)
    if not downs:
        assert driver.name == "NearMisses"
        press(driver, pygame.K_RETURN)
    assert driver.screen is play and getattr(play, opened)
    if not downs:
        return
    for size in ((480, 270), (640, 360), (960, 540), (1440, 810)):
        frame = play.draw(Picture(pygame.Surface(size)))
        words = [text for _, text in frame.boxes]
        assert "Effects" in words and plain_name(EFFECTS[0]) in words, size


def test_it_is_a_stop_of_the_tour(driver):
    driver.app.screens.tour()
    tour = driver.screen
    tour.at = [stop[1] for stop in STOPS].index(MISSES)
    driver.turns(120)
    assert tour.misses.flights[0].steps > 60
    frame = driver.app.arcade.picture.presenter.frame
    words = " ".join(text for _, text in frame.boxes)
    assert "What accuracy costs" in words and "boxes" in words and "pixels" in words


def test_each_flight_is_first_in_every_second_step(monkeypatch):
    shown, order = NearMisses(), []
    for flight in shown.flights:
        monkeypatch.setattr(flight, "step", lambda *of, tier=flight.tier: order.append(tier))
    for _ in range(10):
        shown.advance(1 / 60)
    assert order[::2].count("aabb") == order[::2].count("pixels") == 5


def test_every_sound_that_a_menu_plays_exists():
    names = {
        name
        for path in (ROOT / "game").rglob("*.py")
        for name in re.findall(r'cues\.append\(.*?"(\w+)"', path.read_text(encoding="utf-8"))
    }
    assert {"back", "confirm"} <= names
    missing = {name for name in names if not (ROOT / "assets" / "sounds" / f"{name}.wav").exists()}
    assert not missing
