"""The advice in the plot of costs, and the tuner, which applies and reports advice only if it is certain."""

import pygame
import pytest

from game.measure.advice import advised, share
from game.measure.errors import Error
from game.measure.setting import Setting
from game.measure.survey import Survey
from game.measure.timing import RUNS
from game.measure.tuner import Tuner
from game.screens.play import Play
from scenes import SCENES

HERE = Setting("hash", True)
TREE, SWEEP, BRUTE = (HERE._replace(broadphase=name) for name in ("tree", "sweep", "brute"))


def put(survey, setting, seconds, error=0.0, runs=RUNS, spread=0.02):
    """Add measured values of a setting to the survey.

    seconds: time of a step. spread: relative difference between the runs.
    """
    dot = survey.dot(setting)
    dot.steps = 60
    for k in range(runs):
        dot.took(1, seconds * (1.0 + spread * k / RUNS))
    dot.erred(1, {kind: Error(error, 0.0, 60) for kind in survey.kinds})


@pytest.fixture
def survey():
    made = Survey()
    made.kinds = ("verdict",)
    put(made, HERE, 1.0)
    return made


def test_only_what_is_sure_is_advised(survey):
    assert advised(survey, HERE) is None
    put(survey, TREE, 0.95)
    assert advised(survey, HERE) is None, "less than a tenth"
    put(survey, SWEEP, 0.5, error=3.0)
    assert advised(survey, HERE) is None, "wrong by more than is seen"
    put(survey, BRUTE, 0.5, runs=RUNS - 1)
    assert advised(survey, HERE) is None, "not run often enough"
    put(survey, BRUTE, 0.5)
    assert advised(survey, HERE) == BRUTE and share(survey, BRUTE, HERE) == pytest.approx(0.5)


def test_a_wrong_choice_is_reported_and_the_right_one_is_not(survey):
    put(survey, HERE, 1.0, error=3.0)
    put(survey, TREE, 4.0)
    assert advised(survey, HERE) == TREE
    assert advised(survey, SWEEP) is None, "nothing is known of what runs"


def test_the_tuner_reports_what_it_does_and_asks_nobody_twice_who_refuses(survey):
    put(survey, TREE, 0.5)
    taken = []
    tuner = Tuner(
        survey, lambda setting: taken.append(setting) or ("no" if setting == TREE else ""), lambda setting: 0.5
    )
    assert tuner.step(1, HERE) is None and not taken, "it is off"
    tuner.on = True
    decision = tuner.step(7, HERE)
    assert decision == (7, HERE, TREE, pytest.approx(0.5), "no") and taken == [TREE]
    assert tuner.step(8, HERE) is None and taken == [TREE]
    put(survey, SWEEP, 0.3)
    assert tuner.step(9, HERE).after == SWEEP and tuner.step(10, SWEEP) is None


@pytest.fixture
def play(drive, monkeypatch):
    monkeypatch.setattr("game.measure.surveyor.Surveyor.measure", lambda *of: None)
    monkeypatch.setattr("game.screens.parts.measuring.Measuring.prove", lambda *of: 0.5)
    driver = drive(listing=SCENES)
    driver.app.screens.play("lab/filters")
    driver.turns(10)
    driver.key(pygame.K_m)
    play = driver.screen
    assert isinstance(play, Play) and play.costs_open
    survey, here = play.measuring.surveyor.survey, play.measuring.now()
    survey.kinds = ("verdict",)
    other = here._replace(broadphase="tree" if here.broadphase != "tree" else "hash")
    put(survey, here, 2e-4)
    put(survey, other, 1e-4)
    play.measuring.surveyor.revision += 1
    driver.turns(20)
    yield driver, play, here, other
    play.close()


def words(driver):
    return " ".join(text for _, text in driver.app.arcade.picture.presenter.frame.boxes)


def test_page_up_takes_the_advice(play):
    driver, play, here, other = play
    assert "0.50 x the time over the run" in words(driver)
    driver.key(pygame.K_PAGEUP)
    driver.turns(3)
    assert play.measuring.now() == other
    driver.turns(20)
    assert "leave it" in words(driver)


def test_a_click_on_the_line_takes_it_too(play):
    driver, play, here, other = play
    place = play.costs.advice.rects[0].center
    driver.post(pygame.MOUSEBUTTONDOWN, pos=place, button=1)
    driver.turns(3)
    assert play.measuring.now() == other


def test_the_tuner_goes_on_with_the_panel_closed_and_ends_with_the_scene(play):
    driver, play, here, other = play
    driver.key(pygame.K_PAGEDOWN)
    driver.turns(5)
    assert play.measuring.now() == other and "tunes itself" in words(driver) and "tuned: " in words(driver)
    driver.key(pygame.K_m)
    assert not play.costs_open and play.measuring.tuner.on
    put(play.measuring.surveyor.survey, here._replace(broadphase="sweep"), 2e-5)
    driver.turns(5)
    assert play.measuring.now().broadphase == "sweep"
    assert [each.after.broadphase for each in play.measuring.tuner.decisions] == [other.broadphase, "sweep"]
    play.close()
    assert not play.measuring.tuner.on and play.measuring.surveyor.process is None


def test_what_is_read_of_a_dot_follows_what_is_reported_of_it(survey):
    """Cost and error of a dot are computed once, and again after every new run or error."""
    put(survey, TREE, 1e-3, 0.5, spread=0.0)
    dot, kind = survey.dot(TREE), survey.kinds[0]
    before = dot.cost, dot.error(kind)
    assert dot.cost is before[0] and dot.error(kind) is before[1]
    dot.erred(2, {kind: Error(1.5, 0.0, 60)})
    for _ in range(RUNS):
        assert dot.cost.median == pytest.approx(1e-3) and dot.error(kind).value == 0.5, "the second is not finished"
        dot.took(2, 3e-3)
    assert before[0].median == pytest.approx(1e-3) and dot.cost.median == pytest.approx(2e-3)
    assert dot.error(kind).value == pytest.approx(1.0)


@pytest.mark.parametrize("moments", [1, 2, 3])
@pytest.mark.parametrize("settings", [2, 5])
def test_nothing_that_was_known_is_unknown_again_while_a_moment_is_measured(moments, settings):
    survey = Survey()
    survey.kinds, survey.planned = ("way",), settings
    names = [HERE, TREE, SWEEP, BRUTE, HERE._replace(narrowphase=False)][:settings]
    known = []
    for moment in range(1, moments + 1):
        for setting in names:
            survey.dot(setting).steps = 60
            survey.dot(setting).erred(moment, {"way": Error(0.0, 0.0, 60)})
        for _ in range(RUNS):
            for setting in names:
                survey.dot(setting).took(moment, 1.0)
                known.append(len(survey.known("way")))
                expected = "measuring, " if known[-1] < settings else f"{settings} settings measured, {RUNS} runs each"
                assert survey.progress().startswith(expected)
    assert known == sorted(known) and known[: settings * (RUNS - 1)] == [0] * (settings * (RUNS - 1))
    assert known[settings * RUNS - 1 :] == [settings] * (settings * RUNS * (moments - 1) + 1)


def test_settings_that_cannot_be_told_apart_are_advised_in_a_fixed_order(survey):
    both = TREE._replace(narrowphase=False)
    for times in ((0.500, 0.505, 0.51), (0.51, 0.505, 0.500), (0.505, 0.500, 0.51)):
        for setting, seconds in zip((both, BRUTE, TREE), times, strict=True):
            survey.dots.pop(setting, None)
            put(survey, setting, seconds)
        assert advised(survey, HERE) == BRUTE, "one change, and the first by name"


@pytest.mark.parametrize("proof, said", ((None, "trying it on the run"), ("measured 1.20", "leave it")))
def test_advice_that_has_not_proved_itself_is_not_taken(play, monkeypatch, proof, said):
    driver, play, here, other = play
    monkeypatch.setattr("game.screens.parts.measuring.Measuring.prove", lambda *of: proof)
    play.measuring.tuner.prove = play.measuring.prove
    driver.turns(20)
    driver.key(pygame.K_PAGEUP)
    driver.key(pygame.K_PAGEDOWN)
    driver.turns(10)
    assert play.measuring.now() == here and said in words(driver)
