"""Errors of tiers are wrong answers per 100 encounters, pooled over moments, with intervals and sentences."""

import csv
import io
import json
from itertools import pairwise

import pytest

from game.measure.advice import settings_within
from game.measure.errors import Error, Verdicts
from game.measure.setting import Setting
from game.measure.survey import LEAST_HITS, Survey, shown
from game.measure.survey_csv import COLUMNS, csv_of
from game.measure.surveyor import error_of
from game.measure.timing import RUNS
from game.measure.worker import sent

HERE = Setting("hash", True, None, None, "pixels")
BOXES = HERE._replace(tier="aabb")


def pairs(first, count):
    return frozenset((k, k + 1000) for k in range(first, first + count))


def error(reported, true, own=False):
    return Error.of(Verdicts(reported, true, own), 60, {})


def survey_of(errors, times):
    """Return a survey. errors: {setting: list of errors, one for each moment}. times: {setting: seconds a step}."""
    survey = Survey()
    survey.kinds = ("verdict",)
    for setting, found in errors.items():
        dot = survey.dot(setting)
        dot.steps = 60
        for moment, each in enumerate(found, 1):
            dot.erred(moment, {"verdict": each})
            for run in range(RUNS):
                dot.took(moment, times[setting] * (1.0 + 0.01 * run))
    return survey


@pytest.mark.parametrize("moments", (1, 2, 5, 12))
def test_a_pair_that_lasts_over_all_moments_is_one_encounter(moments):
    survey = survey_of({BOXES: [error(pairs(0, 30), pairs(0, 20))] * moments}, {BOXES: 1e-4})
    found = survey.dots[BOXES].error("verdict")
    assert found is not None and found.wrong == (10, 30) and found.missed == (0, 20)
    assert found.value == pytest.approx(100 / 3)


@pytest.mark.parametrize("moments", (2, 5, 12))
def test_a_pair_that_touches_at_a_later_moment_is_no_false_hit(moments):
    early = [error(pairs(0, 30), pairs(0, 20))] * (moments - 1)
    survey = survey_of({BOXES: [*early, error(pairs(20, 10), pairs(20, 10))]}, {BOXES: 1e-4})
    found = survey.dots[BOXES].error("verdict")
    assert found is not None and found.wrong == (0, 30)


def test_the_interval_narrows_with_the_encounters_and_holds_the_rate():
    found = [error(pairs(0, n), pairs(0, n // 2)).interval for n in (4, 10, 40, 200, 1000)]
    assert all(low < 50.0 < high for low, high in found)
    assert all(a[1] - a[0] > b[1] - b[0] for a, b in pairwise(found))


def test_no_encounter_is_no_proof_but_the_exact_test_needs_none():
    assert error(pairs(0, 0), pairs(0, 0)).interval == (0.0, 100.0)
    assert error(pairs(0, 0), pairs(0, 0), own=True).interval == (0.0, 0.0)


@pytest.mark.parametrize("count, within", ((5, False), (50, False), (1000, True)))
def test_a_tier_is_advised_only_if_enough_encounters_vouch_for_it(count, within):
    errors = {
        HERE: [error(pairs(0, count), pairs(0, count), own=True)],
        BOXES: [error(pairs(0, count), pairs(0, count))],
    }
    survey = survey_of(errors, {HERE: 1e-4, BOXES: 5e-5})
    assert (BOXES in settings_within(survey, 1.0)) == within and HERE in settings_within(survey, 1.0)


@pytest.mark.parametrize("false", (0, 7, 36, 100))
def test_the_sentence_of_boxes_and_pixels_says_the_measured_rate_and_price(false):
    exact = error(pairs(0, 100 - false), pairs(0, 100 - false), own=True)
    survey = survey_of(
        {HERE: [exact], BOXES: [error(pairs(0, 100), pairs(0, 100 - false))]}, {HERE: 1.5e-4, BOXES: 1e-4}
    )
    low, high = (round(100 * each) for each in survey.dots[BOXES].error("verdict").wrong.interval)
    expected = f"Boxes: {false} of 100 hits are false ({low} to {high}). Pixels: none, for 1.50 x the time."
    assert survey.boxes_and_pixels() == expected


@pytest.mark.parametrize("hits", (0, 1, LEAST_HITS - 1))
def test_no_rate_is_said_before_there_are_enough_hits(hits):
    exact = error(pairs(0, hits), pairs(0, hits), own=True)
    survey = survey_of({HERE: [exact], BOXES: [error(pairs(0, hits), pairs(0, 0))]}, {HERE: 1e-4, BOXES: 1e-4})
    assert survey.boxes_and_pixels() == f"Boxes and pixels: measuring, {hits} of {LEAST_HITS} hits by boxes."


@pytest.mark.parametrize("hits", (0, 1, LEAST_HITS - 1, LEAST_HITS))
def test_no_finding_on_tiers_is_said_before_there_are_enough_hits(hits):
    exact = error(pairs(0, hits), pairs(0, hits), own=True)
    survey = survey_of({HERE: [exact], BOXES: [error(pairs(0, hits), pairs(0, 0))]}, {HERE: 1.5e-4, BOXES: 1e-4})
    found = survey.finding("verdict", HERE)
    if hits < LEAST_HITS:
        assert found == f"no finding yet: {hits} of {LEAST_HITS} hits seen"
    else:
        assert found == f"nothing as exact (0 of {hits} wrong) is cheaper by more than the noise"
    assert shown(exact) == (f"0 of {hits} wrong" if hits else "no hit yet")


def test_a_price_inside_the_noise_is_no_price():
    exact = error(pairs(0, 80), pairs(0, 80), own=True)
    times = {HERE: 1.005e-4, BOXES: 1e-4}
    survey = survey_of({HERE: [exact], BOXES: [error(pairs(0, 100), pairs(0, 80))]}, times)
    assert survey.boxes_and_pixels().endswith("Pixels: none, for the same time.")


def test_nothing_is_said_of_tiers_where_there_are_none():
    setting = Setting("hash", True, "soft_step", 4, None)
    survey = survey_of({setting: [Error(0.5)]}, {setting: 1e-4})
    assert survey.boxes_and_pixels() == "" and Survey().boxes_and_pixels() == ""


def test_verdicts_survive_the_way_between_the_processes():
    found = error(pairs(0, 7), pairs(3, 9))
    assert error_of(json.loads(json.dumps(sent(found)))) == found
    assert error_of(json.loads(json.dumps(sent(Error(0.25, 0.1, 30, {"cap_hits": 2}))))) == Error(
        0.25, 0.1, 30, {"cap_hits": 2}
    )


def test_the_csv_file_holds_every_dot_with_its_command():
    exact = error(pairs(0, 80), pairs(0, 80), own=True)
    survey = survey_of({HERE: [exact], BOXES: [error(pairs(0, 100), pairs(0, 80))]}, {HERE: 2e-4, BOXES: 1e-4})
    rows = list(csv.DictReader(io.StringIO(csv_of(survey, "shooter", "python main.py --advise shooter"))))
    assert [(row["tier"], row["false_hits"], row["reported_hits"]) for row in rows] == [
        ("pixels", "0", "80"),
        ("aabb", "20", "100"),
    ]
    assert all(
        set(row) == set(COLUMNS) and row["command"].startswith("python main.py --advise shooter") for row in rows
    )
    assert [float(row["us_least"]) for row in rows] == [200.0, 100.0]
    assert float(rows[1]["error_low"]) < float(rows[1]["error"]) < float(rows[1]["error_high"])
