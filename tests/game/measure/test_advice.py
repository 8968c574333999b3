"""Advice names only settings that were measured and whose error is small enough, and is given only if it is certain."""

import json

import numpy as np
import pytest

import physics
from game.command_line import run
from game.measure.advice import advise
from game.measure.moment import Moment
from game.measure.survey import Survey
from game.measure.timing import Cost
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource
from physics import BROADPHASES, Effects, PixelMask, Polygon, World
from scenes import SCENES
from tests.lockstep import make_scene

needs_speed = pytest.mark.skipif(not physics.JIT, reason="thousands of steps")


class Table(Moment):
    """Moment whose settings have costs and errors from a table, so that the right advice is known."""

    table: dict = {}

    def time_run(self, setting, steps=60):
        return 1e-3 * self.table[key(setting)][0] if key(setting) in self.table else 2e-3

    def way(self, setting, steps=60, divided=1):
        way = super().way(setting, 3)
        return way._replace(overlap=way.overlap * 0.0 + self.table.get(key(setting), (0.0, 5.0))[1])


def key(setting):
    return setting.broadphase, setting.solver, setting.substeps, setting.narrowphase


def pile():
    world = World(Effects(response=True, gravity=True, stacking=True), BROADPHASES["hash"](), gravity=(0.0, 320.0))
    world.add_body(Polygon.box(80, 8), position=(0.0, 20.0), kind="static")
    world.add_body(Polygon.box(8, 8), position=(0.0, 12.0))
    world.substeps = 4
    return world


def moment(table):
    made = Table(pile().snapshot(), "hash")
    made.table = table
    return made


NOW = ("hash", "soft_step", 4, True)


@pytest.mark.parametrize(
    "error, table, wanted",
    [
        (1.0, {NOW: (1.0, 0.1), ("tree", "soft_step", 4, True): (0.5, 0.1)}, ("tree", "soft_step", 4)),
        (1.0, {NOW: (1.0, 0.1), ("tree", "soft_step", 4, True): (0.95, 0.1)}, ("hash", "soft_step", 4)),
        (1.0, {NOW: (1.0, 0.1), ("tree", "soft_step", 4, True): (0.5, 3.0)}, ("hash", "soft_step", 4)),
        (1.0, {NOW: (1.0, 3.0), ("hash", "soft_step", 8, True): (1.5, 0.2)}, ("hash", "soft_step", 8)),
        (0.05, {NOW: (1.0, 3.0), ("hash", "soft_step", 8, True): (1.5, 0.2)}, None),
        (
            1.0,
            {
                NOW: (1.0, 0.1),
                ("tree", "soft_step", 4, True): (0.8, 0.1),
                ("hash", "soft_step", 1, True): (0.7, 0.1),
                ("tree", "soft_step", 1, True): (0.5, 0.1),
            },
            ("tree", "soft_step", 1),
        ),
    ],
    ids=["cheaper", "a tie", "too wrong", "dearer, for now is too wrong", "nothing", "together"],
)
def test_the_cheapest_within_the_error_is_advised_where_that_is_sure(error, table, wanted):
    found, survey = advise([moment(table)], error)
    if wanted is None:
        assert found.best is None and found.within == ()
        return
    assert found.best is not None
    assert (found.best.broadphase, found.best.solver, found.best.substeps) == wanted
    assert isinstance(survey, Survey) and found.here in survey.dots


def test_no_moments_are_refused():
    with pytest.raises(ValueError, match="moments must be one at least"):
        advise([], 1.0)


@needs_speed
def test_a_real_scene_is_measured_whole():
    scene = make_scene("lab/filters")
    session = Session(scene, BotSource())
    for _ in range(20):
        session.step()
    taken = Moment(scene.world.snapshot(), scene.world.broadphase.name)
    reported = []
    found, survey = advise([taken], 1.0, lambda done, of: reported.append((done, of)))
    assert reported[-1][0] == reported[-1][1] and [done for done, _ in reported[:5]] == [1, 2, 3, 4, 5]
    assert {setting.broadphase for setting in survey.dots} == set(BROADPHASES)
    assert all(isinstance(dot.cost, Cost) and dot.cost.runs >= 5 for dot in survey.dots.values())
    assert found.best in survey.dots and found.here == taken.here


@needs_speed
def test_the_command_line_reports_it_as_text_and_as_json(capsys):
    registry = Registry(SCENES)
    assert run(["--advise", "lab/sensors", "--frames", "300"], registry) == 0
    assert "advice:" in capsys.readouterr().out
    assert run(["--advise", "lab/sensors", "--frames", "300", "--error", "0.5", "--json"], registry) == 0
    reported = json.loads(capsys.readouterr().out)
    assert (
        reported["scene"] == "lab/sensors"
        and reported["error"] == 0.5
        and reported["here"]["broadphase"] in BROADPHASES
    )
    assert len(reported["settings"]) >= 4 and all(each["cost"]["runs"] >= 5 for each in reported["settings"])


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--advise", "lab/nothing"], "lab/nothing"),
        (["--error", "1"], "--error needs --advise"),
        (["--advise", "lab/sensors", "--error", "0"], "more than 0 px"),
        (["--advise", "lab/sensors", "--error", "nan"], "more than 0 px"),
        (["--advise", "lab/sensors", "--scene", "shooter"], "leave out --scene"),
        (["--advise", "lab/sensors", "--record", "x"], "leave out --record"),
    ],
)
def test_wrong_use_is_one_line_and_exit_2(arguments, said, capsys):
    assert run(arguments, Registry(SCENES)) == 2
    assert said in capsys.readouterr().err


def test_sprites_are_advised_a_tier_only_within_the_error():
    world = World(Effects(), BROADPHASES["hash"]())
    solid = np.eye(24, dtype=bool)
    for number in range(6):
        world.add_body(PixelMask(solid), position=(14.0 * number, 4.0 * number), kind="kinematic", tier="pixels")
    world.step()
    found, survey = advise([Moment(world.snapshot(), "hash")], 0.01)
    for setting in found.within:
        error = survey.dots[setting].error("verdict")
        assert error is not None and error.value <= 0.01
    assert any(setting.tier == "circle" for setting in survey.dots)
    assert not any(setting.tier == "circle" for setting in found.within), "the circles of two diagonals meet"
