"""The plot of a scene with joints: both joint solvers over their substeps, with the widest gap of a joint."""

import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.measure.advice import settings_within
from game.measure.errors import Error, References
from game.measure.moment import STEPS, Moment, here_of, widest_gap
from game.measure.setting import JOINT_TIERS, settings_around
from game.measure.survey import Survey
from game.measure.survey_csv import csv_of
from game.measure.timing import RUNS
from game.run.picture import Picture
from game.run.recorded_run import changes_to
from game.scene import SUBSTEPS
from game.screens.play import Play
from physics import Circle, Effects, Polygon, Revolute, World
from physics.annotations import JointSolverName, SolverName
from scenes.lab.joints import Joints
from tests.game.reading import assert_text_is_apart

needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps with many substeps")
EFFECTS = Effects(response=True, gravity=True, rotation=True, stacking=True, joints=True)


def swinging(tier: JointSolverName = "auto", solver: SolverName = "soft_step"):
    """Return a world with a swinging chain that ends in a ball of a hundred times the mass of a link. tier: joint
    solver.
    """
    world, before = World(EFFECTS, solver=solver, substeps=4), None
    world.joint_solver = tier
    for k in range(8):
        link = world.add_body(Polygon.box(20, 4), position=(20.0 * k + 10.0, 0.0))
        world.add_joint(Revolute(before, link, at=(20.0 * k, 0.0)))
        before = link
    assert before is not None
    ball = world.add_body(Circle(6), position=(166.0, 0.0), mass=100.0 * before.mass)
    world.add_joint(Revolute(before, ball, at=(160.0, 0.0)))
    for _ in range(20):
        world.step()
    return world


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("tier", ["iterative", "direct", "auto"])
def test_both_solvers_of_joints_are_among_the_settings_with_each_number_of_substeps(tier, solver):
    world = swinging(tier, solver)
    moment = Moment(world.snapshot(), world.broadphase.name)
    assert moment.here.joint_solver == tier and moment.here == here_of(world, None)
    settings = settings_around(moment.here, moment.effects)
    assert len(set(settings)) == len(settings)
    counts = {count for count in SUBSTEPS if solver == "soft_step" or count != "auto"}
    for name in JOINT_TIERS:
        found = {each.substeps for each in settings if (each.joint_solver, each.solver) == (name, solver)}
        assert found == counts
    for setting in settings:
        assert here_of(moment.world(setting), None) == setting
    other = moment.here._replace(joint_solver="direct" if tier == "iterative" else "iterative", substeps=8)
    assert other.label(moment.here) == f"8 substeps, {other.joint_solver} joints"


@pytest.mark.parametrize("effects", [EFFECTS.with_(joints=False), Effects(response=True, joints=False), Effects()])
def test_without_the_effect_there_is_no_solver_of_joints(effects):
    world = World(effects)
    moment = Moment(world.snapshot(), world.broadphase.name)
    assert moment.here.joint_solver is None and "joints" not in References(moment).kinds
    assert {each.joint_solver for each in settings_around(moment.here, effects)} == {None}


@needs_speed
def test_the_error_of_joints_is_the_widest_gap_of_the_second_half_of_a_run():
    world = swinging()
    moment = Moment(world.snapshot(), world.broadphase.name)
    references = References(moment)
    assert references.kinds == ("overlap", "way", "joints")
    gaps = {}
    for name in JOINT_TIERS:
        setting = moment.here._replace(joint_solver=name)
        again, widest = moment.world(setting), []
        for _ in range(STEPS):
            again.step()
            widest.append(widest_gap(again))
        gaps[name] = references.errors(setting)["joints"].value
        assert gaps[name] == max(widest[STEPS // 2 :])
        assert set(references.errors(setting)) == {"overlap", "way", "joints"}
    assert 0.0 < 100.0 * gaps["direct"] < gaps["iterative"]


def test_no_scene_is_changed_to_another_solver_of_joints_and_none_is_advised():
    scene = Joints(1)
    here = here_of(scene.views()[0][0], None)
    other = here._replace(joint_solver="direct")
    assert here.joint_solver == "iterative" and "direct is only measured" in changes_to(other, scene)
    survey = surveyed(settings_around(here, scene.effects))
    within = settings_within(survey, 1.0)
    assert within and {each.joint_solver for each in within} == {"iterative"}


def surveyed(settings, survey=None):
    """Return a survey of settings with made-up costs and gaps.

    Each setting costs more than the one before. Gaps are small with the direct joint solver only. survey: survey to
    fill; None for a new one.
    """
    survey = survey or Survey()
    survey.kinds, survey.planned, survey.moments = ("overlap", "way", "joints"), len(settings), 1
    for number, setting in enumerate(settings):
        dot = survey.dot(setting)
        dot.steps = STEPS
        for run in range(RUNS):
            dot.took(1, 1e-6 * (90 + 5 * number + 0.1 * run))
        gap = (1e-3 if setting.joint_solver == "direct" else 0.5) / (1 + number)
        dot.erred(1, {kind: Error(gap, 0.0, STEPS) for kind in survey.kinds})
    return survey


def test_the_csv_names_the_solver_of_joints():
    world = swinging()
    settings = settings_around(here_of(world, None), world.effects)
    lines = csv_of(surveyed(settings), "lab/joints", "command").splitlines()
    place = lines[0].split(",").index("joint_solver")
    assert {line.split(",")[place] for line in lines[1:]} == {"auto", "iterative", "direct"}


@pytest.mark.usefixtures("nothing_is_measured")
@pytest.mark.parametrize("size", [(640, 360), (960, 540), (1280, 720)])
def test_the_panel_has_a_page_of_joints(size):
    play = Play(Joints(1), DeviceSource(), Sounds(silent=True))
    play.step()
    play.toggle_costs()
    surveyed(settings_around(play.measuring.now(), play.scene.world.effects), play.measuring.surveyor.survey)
    play.costs.key(pygame.K_LEFT)
    assert play.costs.shown_kind() == "joints"
    frame = play.draw(Picture(pygame.Surface(size)))
    inside = [(rect, text) for rect, text in frame.boxes if play.costs.rect.contains(rect)]
    drawn = " ".join(text for _, text in inside)
    assert "widest joint gap [px]" in drawn and "joints" in {text for _, text in inside}, "axis and legend"
    assert_text_is_apart(inside, frame.rect)
    play.close()
