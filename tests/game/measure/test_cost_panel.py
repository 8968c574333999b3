"""The plot of what accuracy costs: reached, read and worked as a player does."""

from time import monotonic

import pygame
import pytest

from game.run.replay import Recorder
from game.run.replay_check import is_possible
from game.screens.play import Play
from scenes import SCENES
from scenes.lab.pyramid import Pyramid
from scenes.lab.stacks import Stacks
from scenes.shooter.scene import Shooter


def words(frame):
    """All text on a frame."""
    return " ".join(text for _, text in frame.boxes)


@pytest.fixture
def driver(drive):
    driver = drive(listing=SCENES)
    yield driver
    play = driver.app.screens.played
    if play is not None:
        play.close()


def look(driver, known):
    """A picture in which so much is measured: known(survey)."""
    surveyor, end = driver.screen.measuring.surveyor, monotonic() + 120.0
    while not known(surveyor.survey) and monotonic() < end:
        surveyor.wait(0.1)
    driver.turns(2)
    return driver.app.arcade.picture.presenter.frame


def test_from_the_title_to_a_finding_in_the_shooter_in_three_keys(driver):
    for key in (pygame.K_RETURN, pygame.K_RETURN, pygame.K_m):
        assert driver.name != "Play" or key == pygame.K_m
        driver.key(key)
        driver.turns(30)
    play = driver.screen
    assert isinstance(play.scene, Shooter) and play.costs_open
    frame = look(driver, lambda survey: survey.finding("verdict", play.measuring.now()))
    finding = play.measuring.surveyor.survey.finding("verdict", play.measuring.now())
    assert finding and all(word in words(frame) for word in finding.split())
    assert "What accuracy costs" in words(frame)
    rows = [rect for rect, _ in play.costs.rows]
    assert rows and all(frame.surface.get_rect().contains(rect) for rect in rows)


def open_scene(driver, name):
    driver.app.screens.play(name)
    driver.turns(20)
    driver.key(pygame.K_m)
    driver.turns(2)
    return driver.screen


def test_enter_puts_a_setting_to_work_and_a_recording_holds_it(driver):
    play = open_scene(driver, "lab/pyramid")
    assert isinstance(play.scene, Pyramid)
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


def test_a_setting_that_a_scene_does_not_play_with_is_told_and_changes_nothing(driver):
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


def test_a_process_that_dies_is_told(driver):
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
