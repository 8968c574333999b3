"""What labs tell of costs: a dash until it was measured off the frame, over 300 steps of the lane's own world."""

import re

import pygame
import pytest

from game.measure.knowing import know
from game.measure.lanes import LaneFigures
from game.measure.timing import RUNS, Cost
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from scenes.lab.costs import cost_text, microseconds
from scenes.lab.shots import END_X, GUN_X, SHOTS, steps_of_flight
from scenes.lab.tunnelling import LANES

TIMED = re.compile(r"[\d,.]+ us$")
LABS = {"lab/tunnelling": 4, "lab/stacks": 3, "lab/cradle": 3, "lab/ghost_bumps": 3}  # and how many lanes they have
FRAMES = 125  # stacks have settled


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


def of_lanes(scene, runs=RUNS, seconds=1.234e-5):
    steps = scene.measured().make(scene.measured().names[0]).steps
    return {name: LaneFigures(Cost.of([seconds] * runs, steps)) for name in scene.measured().names}


@pytest.mark.parametrize("name", LABS)
def test_a_lane_that_was_not_measured_shows_a_dash(name):
    scene = played(name)
    assert len(scene.measured().names) == LABS[name] and not scene.figures
    for figures in ({}, of_lanes(scene, RUNS - 1)):
        scene.figures = figures
        texts = words(scene)
        assert sum(text in ("-", "a step: -") for text in texts) == LABS[name]
        assert not any(TIMED.search(text) for text in texts), "a film would tell what machine it was made on"
    scene.figures = of_lanes(scene)
    assert sum(text.endswith("12.3 us") for text in words(scene)) == LABS[name]
    scene.change(f"slider:{scene.sliders[0].name}", scene.sliders[0].high)
    assert not any(TIMED.search(text) for text in words(scene)), "other settings cost something else"


@pytest.mark.parametrize("name", LABS)
def test_lanes_are_worlds_of_their_own_and_run_long_enough(name):
    scene = played(name)
    before = scene.state()
    wish = scene.measured()
    bodies = {tuple(each.arrays["bodies"]["id"]) for n in wish.names for each in wish.make(n).snapshots}
    lanes = [wish.make(n) for n in wish.names]
    assert all(RUNS * lane.steps * len(lane.snapshots) >= 300 for lane in lanes)
    whole = len(scene.world.bodies)
    assert bodies and (name != "lab/tunnelling" or all(len(ids) < whole for ids in bodies))
    assert scene.state() == before, "measuring draws no random number"
    steps = [lane.steps for lane in lanes]
    assert steps == steps[:1] * len(lanes), "the same work for all"


@pytest.mark.parametrize("kind", range(len(SHOTS)))
def test_a_shot_is_measured_from_the_gun_to_the_end(kind):
    scene = played("lab/tunnelling", 1)
    scene.change("slider:shots", kind)
    wish, speed = scene.measured(), scene.values["speed"]
    assert [name[-1] for name in wish.names] == list(LANES)
    for name in wish.names:
        lane = wish.make(name)
        assert lane.steps == steps_of_flight(speed) and lane.steps * speed / 60 >= END_X - GUN_X
        for snapshot in lane.snapshots:
            rows = snapshot.arrays["bodies"]
            shots = rows[rows["vx"] != 0.0]
            assert len(shots) == (2 if SHOTS[kind] == "bullets" else 1) == len(rows) - (SHOTS[kind] != "bullets")


def test_known_costs_come_with_the_picture():
    scene = played("lab/cradle")
    know(scene)
    assert all(figures.cost.least > 0.0 for figures in scene.figures.values())
    assert sum(bool(TIMED.search(text)) for text in words(scene)) == LABS["lab/cradle"]


def test_microseconds_as_text():
    told = {1.26e-6: "1.3 us", 9.99e-5: "99.9 us", 9.996e-5: "100 us", 1.5e-2: "15,000 us"}
    assert {seconds: microseconds(seconds) for seconds in told} == told
    assert cost_text(played("lab/cradle", 1), "of no such name") == "-"
