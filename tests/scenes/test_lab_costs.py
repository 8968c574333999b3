"""Labs show a dash for a cost until it is measured outside the frame, then figures over 300 steps of the lab's own
world.
"""

import re

import numpy as np
import pygame
import pytest

import physics
from game.measure.measured_runs import RunFigures
from game.measure.moment import Moment
from game.measure.synchronous import measure_requests
from game.measure.timing import RUNS, Cost
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from scenes.lab.costs import cost_text, microseconds
from scenes.lab.shots import END_X, GUN_X, SHOTS, steps_of_flight
from scenes.lab.tools import TOOLS
from scenes.lab.tunnelling import LANES

TIMED = re.compile(r"[\d,.]+ us$")
# And how many runs they measure.
LABS = {
    "lab/tunnelling": 4,
    "lab/stacks": 3,
    "lab/cradle": 3,
    "lab/ghost_bumps": 3,
    "lab/queries": 4,
    "lab/mask_stack": 5,
    "lab/carving": 1,
    "lab/tumbler": 2,
}
FRAMES = 125  # stacks have settled
needs_speed = pytest.mark.skipif(not physics.JIT, reason="thousands of steps, questions and carves, or a drum")

HEAVY = {"lab/queries", "lab/mask_stack", "lab/carving", "lab/tumbler"}
BY_WEIGHT = [pytest.param(name, marks=needs_speed if name in HEAVY else ()) for name in LABS]


def played(name, frames=FRAMES):
    scene = Registry(SCENES).scene_class(name)(1)
    session = Session(scene, BotSource())
    for _ in range(frames):
        session.step()
    return scene


def words(scene):
    picture = Picture(pygame.Surface((960, 540)))
    picture.draw_scene(scene, Overlays(()))
    return [text for _, text in picture.presenter.frame.boxes]


def world_of(measured_run):
    moment = Moment(measured_run.snapshots[0], measured_run.broadphase)
    return moment.world(moment.here)


def figures_of(scene, runs=RUNS, seconds=1.234e-5):
    steps = scene.measured().make(scene.measured().names[0]).steps
    return {name: RunFigures(Cost.of([seconds] * runs, steps)) for name in scene.measured().names}


@pytest.mark.parametrize("name", BY_WEIGHT)
def test_a_run_that_was_not_measured_shows_a_dash(name):
    scene = played(name)
    assert len(scene.measured().names) == LABS[name] and not scene.figures
    for figures in ({}, figures_of(scene, RUNS - 1)):
        scene.figures = figures
        texts = words(scene)
        assert sum(text in ("-", "a step: -") for text in texts) == LABS[name]
        assert not any(TIMED.search(text) for text in texts), "a film would tell what machine it was made on"
    scene.figures = figures_of(scene)
    assert sum(text.endswith("12.3 us") for text in words(scene)) == LABS[name]
    scene.change(f"slider:{scene.sliders[0].name}", scene.sliders[0].high)
    assert not any(TIMED.search(text) for text in words(scene)), "other settings cost something else"


@pytest.mark.parametrize("name", BY_WEIGHT)
def test_measured_runs_are_worlds_of_their_own_and_run_long_enough(name):
    scene = played(name)
    before = scene.state()
    request = scene.measured()
    bodies = {tuple(each.arrays["bodies"]["id"]) for n in request.names for each in request.make(n).snapshots}
    measured_runs = [request.make(n) for n in request.names]
    assert all(RUNS * measured_run.steps * len(measured_run.snapshots) >= 300 for measured_run in measured_runs)
    whole = len(scene.world.bodies)
    assert bodies and (name != "lab/tunnelling" or all(len(ids) < whole for ids in bodies))
    assert scene.state() == before, "measuring draws no random number"
    steps = [measured_run.steps for measured_run in measured_runs]
    assert steps == steps[:1] * len(measured_runs), "the same work for all"


@pytest.mark.parametrize("kind", range(len(SHOTS)))
def test_a_shot_is_measured_from_the_gun_to_the_end(kind):
    scene = played("lab/tunnelling", 1)
    scene.change("slider:shots", kind)
    request, speed = scene.measured(), scene.values["speed"]
    assert [name[-1] for name in request.names] == list(LANES)
    for name in request.names:
        measured_run = request.make(name)
        assert measured_run.steps == steps_of_flight(speed) and measured_run.steps * speed / 60 >= END_X - GUN_X
        for snapshot in measured_run.snapshots:
            rows = snapshot.arrays["bodies"]
            shots = rows[rows["vx"] != 0.0]
            assert len(shots) == (2 if SHOTS[kind] == "bullets" else 1) == len(rows) - (SHOTS[kind] != "bullets")


@needs_speed
@pytest.mark.parametrize("name", ["lab/cradle", "lab/queries", "lab/mask_stack", "lab/carving"])
def test_known_costs_come_with_the_picture(name):
    scene = played(name)
    before = scene.state()
    measure_requests(scene)
    assert all(figures.cost.least > 0.0 for figures in scene.figures.values()) and scene.state() == before
    assert sum(bool(TIMED.search(text)) for text in words(scene)) == LABS[name]


@needs_speed
def test_piles_are_measured_awake_and_questions_where_the_broad_phase_knows_all():
    piles, questions = played("lab/mask_stack", 600), played("lab/queries", 1)
    assert all(piles.asleep.values()), "they cost nothing by now"
    request = piles.measured()
    for name in request.names:
        (snapshot,) = request.make(name).snapshots
        assert "sleeping" not in snapshot.facts["effects"]
        assert snapshot.arrays["bodies"]["awake"][snapshot.arrays["bodies"]["inverse_mass"] > 0.0].all()
    request = questions.measured()
    measured_run = request.make(next(name for name in request.names if name[-1] == "tree"))
    world = world_of(measured_run)
    world.step()
    ask = measured_run.act.made_for(world)
    looked = []
    for _ in range(measured_run.steps):
        ask()
        looked.append(world.queries.counters["narrow_tests"])
    assert len(set(looked)) > 20, "another place each time"
    assert max(looked) < len(world.shapes), "the tree is asked, not each shape"


def test_a_carve_is_timed_on_solid_ground():
    scene = played("lab/carving", 1)
    (name,) = scene.measured().names
    measured_run = scene.measured().make(name)
    world = world_of(measured_run)
    carve, left = measured_run.act.made_for(world), []
    for _ in range(measured_run.steps + 1):
        carve()
        left.append(int(np.count_nonzero(world.body(scene.ground).shapes[0].solid)))
    assert sum(b < a for a, b in zip(left, left[1:], strict=False)) > 0.9 * measured_run.steps
    scene.change("slider:tool", TOOLS.index("hand"))
    assert scene.measured() is None and "-" in words(scene)


def test_microseconds_as_text():
    reported = {1.26e-6: "1.3 us", 9.99e-5: "99.9 us", 9.996e-5: "100 us", 1.5e-2: "15,000 us"}
    assert {seconds: microseconds(seconds) for seconds in reported} == reported
    assert cost_text(played("lab/cradle", 1), "of no such name") == "-"
