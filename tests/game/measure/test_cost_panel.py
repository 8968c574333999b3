"""The plot of accuracy and cost: opened, read and used as by a player."""

from time import monotonic

import pygame
import pytest

from game.drawing.canvas import TEXT, wrap
from game.files.data_folder import short_path
from game.input.devices import DeviceSource
from game.measure.errors import Error, Verdicts
from game.measure.moment import STEPS
from game.measure.setting import settings_around
from game.measure.timing import RUNS
from game.run.figures_csv import figures_of
from game.run.picture import Picture
from game.run.replay import Recorder
from game.run.replay_check import is_possible
from game.screens.play import Play
from scenes import SCENES
from scenes.lab.pyramid import Pyramid
from scenes.lab.stacks import Stacks
from scenes.shooter.scene import Shooter
from tests.game.reading import Reader, assert_text_is_apart
from tests.game.test_lab_card import Silent


def words(frame):
    """Return all text on a frame, joined by spaces."""
    return " ".join(text for _, text in frame.boxes)


@pytest.fixture
def driver(drive):
    driver = drive(listing=SCENES)
    yield driver
    play = driver.app.screens.played
    if play is not None:
        play.close()


def look(driver, known):
    """Wait until known(survey) is true, at most 120 s. Return the frame that then shows the survey."""
    surveyor, end = driver.screen.measuring.surveyor, monotonic() + 120.0
    while not known(surveyor.survey) and monotonic() < end:
        surveyor.wait(0.1)
    driver.turns(2)
    return driver.app.arcade.picture.presenter.frame


def test_a_strangers_path_from_the_title_to_what_accuracy_costs_in_the_shooter(driver):
    """A new player gets from the title to the plot of costs in the shooter with at most four keys.

    The plot's finding is completely visible at every size of the window.
    """
    pressed = []

    def press(key):
        pressed.append(key)
        driver.key(key)
        driver.turns(30)

    assert driver.name == "Title" and not driver.settings.hint_seen, "nobody has played here before"
    press(pygame.K_RETURN)
    assert driver.name == "Menu"
    press(pygame.K_RETURN)
    assert driver.name == "Play"
    press(pygame.K_m)
    play = driver.screen
    assert len(pressed) <= 4 and isinstance(play.scene, Shooter) and play.costs_open
    look(driver, lambda survey: survey.finding("verdict", play.measuring.now()))
    finding = play.measuring.surveyor.survey.finding("verdict", play.measuring.now())
    assert any(letter.isdigit() for letter in finding)
    for size in ((960, 540), (1440, 810), (1920, 1080)):
        with Reader() as reader:
            frame = play.draw(Picture(pygame.Surface(size)))
            assert_text_is_apart(frame.boxes, frame.rect)
            reader.assert_readable()
        texts = {text: rect for rect, text in frame.boxes}
        lines = wrap(finding, play.costs.rect.width - 10 * frame.text_scale, TEXT, frame.text_scale)
        assert lines and " ".join(lines) == finding and "What accuracy costs" in texts
        for line in lines:
            assert play.costs.rect.contains(texts[line]) and frame.rect.contains(texts[line]), (size, line)
        assert len(play.costs.places) > 1, "the dots of the plot"
        assert all(play.costs.rect.collidepoint(place) for place, _ in play.costs.places)
        rows = [rect for rect, _ in play.costs.rows]
        assert rows and all(frame.rect.contains(rect) for rect in rows)


def open_scene(driver, name):
    driver.app.screens.play(name)
    driver.turns(20)
    driver.key(pygame.K_m)
    driver.turns(2)
    return driver.screen


def test_enter_puts_a_setting_to_work_and_a_recording_holds_it(driver):
    play = open_scene(driver, "lab/pyramid")
    assert isinstance(play.scene, Pyramid)
    play.scene.change_slider("solver", play.scene.solvers.index("soft_step"))
    driver.turns(3)
    here = play.measuring.now()
    play.costs.hovered = here._replace(substeps=8)
    driver.key(pygame.K_RETURN)
    driver.turns(3)
    assert play.scene.world.substeps == 8 and play.scene.values["substeps"] == 8
    assert play.measuring.now() == here._replace(substeps=8) and "8 substeps" in play.news
    assert isinstance(play.recorder, Recorder)
    assert ("substeps", 8) in [change for _, frame in play.recorder.runs for change in frame.changes]
    driver.turns(3)
    assert play.costs.trail[-2:] == [here, here._replace(substeps=8)], "what was tried stays as a trail"


def test_a_setting_that_a_scene_does_not_play_with_is_reported_and_changes_nothing(driver):
    play = open_scene(driver, "lab/stacks")
    assert isinstance(play.scene, Stacks)
    before = [world.solver for world in play.scene.worlds]
    blocking = play.measuring.now()._replace(solver="blocking", substeps=None)
    play.try_setting(blocking)
    driver.turns(2)
    assert [world.solver for world in play.scene.worlds] == before and "only measured" in play.news


def test_the_panel_turns_to_another_error_and_closes(driver):
    play = open_scene(driver, "lab/tunnelling")
    frame = look(driver, lambda survey: survey.known("way"))
    assert play.costs.shown_kind() == "overlap"
    driver.key(pygame.K_RIGHT)
    driver.turns(1)
    assert play.costs.shown_kind() == "way" and "astray" in words(frame)
    process = play.measuring.surveyor.process
    driver.key(pygame.K_m)
    driver.turns(1)
    assert not play.costs_open and process.poll() is not None
    assert play.measuring.surveyor.survey.dots, "what was measured is kept for the next look"
    driver.key(pygame.K_TAB)
    assert play.panel_open
    driver.key(pygame.K_m)
    assert play.costs_open and not play.panel_open


def test_only_what_a_scene_can_take_is_possible_in_a_recording():
    assert is_possible(Pyramid, "substeps", 8) and is_possible(Pyramid, "substeps", "auto")
    assert not is_possible(Pyramid, "substeps", 3) and not is_possible(Pyramid, "substeps", True)
    assert not is_possible(Shooter, "substeps", 8), "nothing is stacked there"


def test_a_process_that_dies_is_reported(driver):
    play = open_scene(driver, "lab/filters")
    play.measuring.surveyor.process.kill()
    for _ in range(100):
        driver.turns(1)
        if play.measuring.surveyor.trouble:
            break
        pygame.time.delay(20)
    driver.turns(1)
    assert "has ended" in words(driver.app.arcade.picture.presenter.frame)
    assert isinstance(play, Play)


def test_f9_saves_what_is_measured_as_csv(driver, tmp_path):
    open_scene(driver, "lab/filters")
    driver.key(pygame.K_F9)
    driver.turns(2)
    assert "nothing is measured yet" in words(driver.app.arcade.picture.presenter.frame)
    look(driver, lambda survey: len(survey.known("verdict")) > 1)
    driver.key(pygame.K_F9)
    driver.turns(2)
    (saved,) = (tmp_path / "measurements").glob("lab-filters-*.csv")
    assert len(saved.read_text().splitlines()) > 2
    assert driver.screen.news == f"saved as {short_path(saved)}"


def play_with_a_survey():
    """Return the shooter's screen with the plot open and a result for every setting."""
    play = Play(Shooter(seed=1), DeviceSource(), Silent())
    for _ in range(3):
        play.step()
    play.toggle_costs()
    survey = play.measuring.surveyor.survey
    settings = settings_around(play.measuring.now(), play.scene.world.effects)
    survey.kinds, survey.planned, survey.moments = ("verdict",), len(settings), 1
    true = frozenset((1, k) for k in range(2, 40))
    for number, setting in enumerate(settings):
        dot = survey.dot(setting)
        dot.steps = STEPS
        for run in range(RUNS):
            dot.took(1, 1e-6 * (40 + 7 * number + run))
        reported = true | {(0, k) for k in range(3 * number)}
        dot.erred(1, {"verdict": Error.of(Verdicts(frozenset(reported), true, not number), STEPS, {})})
    return play


@pytest.mark.usefixtures("nothing_is_measured")
def test_the_plot_says_what_the_picture_counts():
    play = play_with_a_survey()
    play.scene.hits.count.update(core=2, hull=11, box=18)
    frame = play.draw(Picture(pygame.Surface((1440, 810))))
    assert "7 of 18 hits by your box are false" in words(frame)
    assert {"core 2", "hull 11", "box 18"} <= {text for _, text in frame.boxes}
    rows = {figure.name: figure.value for figure in figures_of(play.scene) if figure.of == "own hits"}
    assert rows == {"core": 2, "hull": 11, "box": 18}
    play.scene.tier = "aabb"
    assert "by your box" not in words(play.draw(Picture(pygame.Surface((1440, 810))))), "its hull is a box, too"
    play.close()


@pytest.mark.usefixtures("nothing_is_measured")
@pytest.mark.parametrize("size", [(480, 270), (640, 360), (800, 450), (960, 540), (1440, 810), (1920, 1080)])
def test_nothing_in_the_plot_is_under_nine_pixels(size):
    play = play_with_a_survey()
    frame = play.draw(Picture(pygame.Surface(size)))
    inside = [(rect, text) for rect, text in frame.boxes if play.costs.rect.contains(rect)]
    assert len(inside) > 10
    assert all(rect.height >= 9 for rect, _ in inside), [text for rect, text in inside if rect.height < 9]
    assert_text_is_apart(inside, frame.rect)
    play.close()


@pytest.mark.usefixtures("nothing_is_measured")
@pytest.mark.parametrize("size", [(640, 360), (960, 540), (1280, 720), (1440, 810)])
def test_the_longest_texts_leave_room_for_the_list_and_are_not_cut(size, monkeypatch):
    advice = "leave it; brute: predicted 0.77, measured 1.03: withdrawn"
    monkeypatch.setattr("game.screens.parts.advice_rows.AdviceRows._advice", lambda rows: advice)
    play = play_with_a_survey()
    play.scene.hits.count.update(core=2, hull=1_100, box=1_800)
    here = play.measuring.now()
    frame = play.draw(Picture(pygame.Surface(size)))
    inside = [(rect, text) for rect, text in frame.boxes if play.costs.rect.colliderect(rect)]
    assert_text_is_apart(inside, play.costs.rect)
    assert advice in words(frame)
    assert here in [setting for _, setting in play.costs.rows]
    play.close()
