"""Measurements of one moment of a world: settings, paths and errors, in a separate process and in that of the test."""

import gc
import json

import numpy as np
import pytest

from game.measure.errors import References, pairs_of
from game.measure.moment import Moment, here_of
from game.measure.setting import Setting, settings_around
from game.measure.survey import Survey, reported_error
from game.measure.surveyor import Surveyor
from game.measure.worker import measure
from physics import BROADPHASES, TIERS, Effects, PixelMask, Polygon, World, collide

RIGID = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)


def pile(substeps=4):
    world = World(RIGID, BROADPHASES["tree"](), substeps=substeps)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    for row in range(4):
        world.add_body(Polygon.box(16, 16), position=(0.5 * row, -8 - 16 * row))
    for _ in range(30):
        world.step()
    return world


def sprites(tier="pixels"):
    """Return a world with six pixel crosses that fly past each other. tier: collision tier of the crosses."""
    y, x = np.mgrid[0:16, 0:16] - 7.5
    cross = PixelMask((abs(x) < 3) | (abs(y) < 3))
    world = World(Effects(), BROADPHASES["sweep"]())
    for k in range(6):
        world.add_body(cross, position=(13.3 * k, 8.7 * k), angle=0.4 * k, velocity=(30 - 13 * k, 7 * k), tier=tier)
    return world


def moment_of(world, broadphase="tree"):
    return Moment(world.snapshot(), broadphase)


def test_the_moment_knows_under_what_it_was_taken():
    assert moment_of(pile()).here == Setting("tree", True, "soft_step", 4, None)
    assert moment_of(sprites("obb"), "sweep").here == Setting("sweep", True, None, None, "obb")
    assert here_of(pile("auto"), None) == Setting("tree", True, "soft_step", "auto", None)


def test_a_world_of_a_moment_goes_on_as_the_one_it_was_taken_of():
    world = pile()
    moment = moment_of(world)
    again = moment.world(moment.here)
    for _ in range(20):
        world.step()
        again.step()
    assert again.digest() == world.digest()


@pytest.mark.parametrize("make, broadphase", ((pile, "tree"), (sprites, "sweep")))
def test_every_setting_around_can_be_made_and_is_what_it_says(make, broadphase):
    moment = moment_of(make(), broadphase)
    settings = settings_around(moment.here, moment.effects)
    assert settings[0] == moment.here and len(set(settings)) == len(settings)
    assert {each.broadphase for each in settings} == set(BROADPHASES)
    for setting in settings:
        world = moment.world(setting)
        assert here_of(world, setting.tier) == setting
        tiers = {body.tier for body in world} - {None}
        assert tiers == ({setting.tier} if setting.tier else set())
    if moment.here.tier:
        assert {each.tier for each in settings} == set(TIERS)


def test_labels_name_what_differs():
    here = Setting("tree", True, "soft_step", 4, None)
    assert here.label(here) == "as it is"
    assert here._replace(substeps=1).label(here) == "1 substep"
    assert here._replace(substeps="auto").label(here) == "substeps by load"
    assert here._replace(solver="sequential_impulse", substeps=8).label(here) == "sequential impulse, 8"
    assert here._replace(solver="projection", substeps=None).label(here) == "projection"
    assert here._replace(narrowphase=False, broadphase="hash").label(here) == "hash, boxes only"


def test_the_way_of_a_broad_phase_is_no_other_and_fewer_substeps_are_worse():
    moment = moment_of(pile())
    references = References(moment)
    errors = {s: references.errors(s) for s in settings_around(moment.here, moment.effects)}
    here = moment.here
    for name in BROADPHASES:
        assert errors[here._replace(broadphase=name)] == errors[here]
    overlaps = [errors[here._replace(substeps=n)]["overlap"].value for n in (1, 2, 4, 8)]
    assert overlaps == sorted(overlaps, reverse=True) and overlaps[0] > 10 * overlaps[-1]
    exact = moment.way(references.truth)
    assert not exact.apart(references.reference.way).any(), "the reference is not wrong beside itself"


def test_a_fall_is_off_by_what_the_closed_form_says():
    """The path error of a free fall is that of semi-implicit Euler, g h t / 2.

    It is measured against a reference with a 64th of the step h.
    """
    world = World(Effects(response=True, gravity=True), BROADPHASES["tree"](), gravity=(0.0, 320.0))
    world.add_body(Polygon.box(4, 4))
    moment = moment_of(world)
    references = References(moment)
    error = references.errors(moment.here)["way"]
    h, t = 1 / 60, error.steps / 60
    assert error.value == pytest.approx(320.0 * (h - h / 64) * t / 2, rel=1e-9)


def test_verdicts_are_wrong_by_what_the_shapes_say():
    """The error counts of each tier equal those of single calls of collide() on exact masks."""
    world = sprites()
    cross = world.body(0).shapes[0]
    for place in ((300.0, 300.0), (311.0, 311.0)):  # corners of their boxes overlap, and nothing else
        world.add_body(cross, position=place, tier="pixels")
    moment = moment_of(world, "sweep")
    references, errors = References(moment), {}
    for tier in (*TIERS, "pixels"):
        setting = moment.here._replace(tier=tier)
        error = references.errors(setting)["verdict"]
        reported_world, reported, hits = moment.world(setting), set(), set()
        exact = moment.world(moment.here._replace(tier="pixels"))
        for step in range(60):
            reported_world.step()
            exact.step()
            if step % 5:
                continue
            bodies = list(exact)
            for i, a in enumerate(bodies):
                for b in bodies[i + 1 :]:
                    poses = [(*body.position, body.angle) for body in (a, b)]
                    if len(collide(a.shapes[0], poses[0], b.shapes[0], poses[1])) > 0:
                        hits.add((a.id, b.id))
                    if (a.id, b.id) in pairs_of(reported_world):
                        reported.add((a.id, b.id))
        assert error.wrong is not None and error.missed is not None and hits
        assert error.wrong == (len(reported - hits), len(reported)), "a pair counts once, however long it touches"
        assert error.missed == (len(hits - reported), len(hits))
        assert error.value == pytest.approx(100 * len(reported ^ hits) / len(reported | hits))
        errors[tier] = error.value
    assert errors["pixels"] == 0.0 < max(errors.values()), errors


def test_a_worker_reports_every_setting_five_times(tmp_path):
    moment = moment_of(sprites(), "sweep")
    moment.snapshot.save(tmp_path / "m.npz")
    lines = []
    order = {"moment": 3, "snapshot": str(tmp_path / "m.npz"), "broadphase": "sweep"}
    measure(order, lines.append, lambda: True)
    surveyor = Surveyor()
    surveyor.survey.moments = 3
    for line in lines:
        surveyor._take(json.loads(line))
    settings = settings_around(moment.here, moment.effects)
    survey = surveyor.survey
    assert surveyor.here == moment.here and set(survey.dots) == set(settings) and not surveyor.busy
    assert all(dot.sure and dot.cost.runs == 5 and dot.cost.least > 0.0 for dot in survey.dots.values())
    pareto_front = survey.pareto_front("verdict")
    errors = {s: reported_error(e) for s, (_, e) in survey.known("verdict").items()}
    assert min(errors.values()) == 0.0 and errors[pareto_front[-1]] == 0.0
    assert survey.finding("verdict", moment.here)


def test_what_cannot_be_measured_is_said(tmp_path):
    (tmp_path / "m.npz").write_bytes(b"nothing")
    with pytest.raises(ValueError, match="no snapshot of this program"):
        measure({"moment": 1, "snapshot": str(tmp_path / "m.npz"), "broadphase": "hash"}, print, lambda: True)


def test_a_process_measures_and_ends_with_its_owner():
    world = sprites()
    surveyor = Surveyor()
    try:
        surveyor.measure(world.snapshot(), "sweep")
        surveyor.wait(120.0)
        assert not surveyor.trouble and not surveyor.busy
        assert len(surveyor.survey.known("verdict")) == len(
            settings_around(moment_of(world, "sweep").here, world.effects)
        )
        process = surveyor.process
    finally:
        surveyor.stop()
    assert process is not None and process.poll() is not None


def test_a_survey_without_runs_says_nothing():
    survey = Survey()
    here = Setting("hash", True)
    survey.dot(here)
    assert (
        survey.known("verdict") == {} and survey.finding("verdict", here) == "" and survey.pareto_front("verdict") == []
    )


def test_a_surveyor_that_is_forgotten_leaves_no_process():
    surveyor = Surveyor()
    surveyor.measure(sprites().snapshot(), "sweep")
    surveyor.wait(120.0)
    process = surveyor.process
    del surveyor
    gc.collect()
    assert process is not None and process.wait(10.0) != 0
