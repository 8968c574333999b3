"""Every scene follows its advice in docs/advice.json or states a reason in its source, and the file matches the scenes.

`python -m tests.advised SCENE` measures again; no test measures times.
"""

import json

import pytest

import physics
from game.measure.moment import here_of
from game.measure.pareto_front import TIE
from game.measure.setting import Setting
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from tests.advised import KEPT, TIMES, agreed, frames_of
from tests.lockstep import make_scene

ROWS = json.loads(KEPT.read_text(encoding="utf-8"))["scenes"]


def keeps(name):
    return Registry(SCENES).scene_class(name).keeps


def test_there_is_an_advice_on_every_scene():
    assert list(ROWS) == list(SCENES), "python -m tests.advised measures those that are missing"
    assert all(len(row["runs"]) == TIMES and row["frames"] == frames_of(name) for name, row in ROWS.items())


@pytest.mark.skipif(not physics.JIT, reason="scenes have fewer bodies then")
@pytest.mark.parametrize("name", SCENES)
def test_the_advice_is_about_the_scene_as_it_is(name):
    scene = make_scene(name)
    Session(scene, BotSource()).step()  # a lab starts in its failing state: its bot leaves that with its first input
    world = scene.views()[0][0]
    tier = next((body.tier for body in world if body.tier is not None), None)
    here, measured = here_of(world, tier), Setting(**ROWS[name]["here"])
    if not scene.switches_broadphase:  # a world for each: the one that is looked at is measured
        here = here._replace(broadphase=measured.broadphase)
    assert measured == here, f"python -m tests.advised {name} measures it anew"


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_takes_the_advice_or_says_why_not(name):
    advised, kept = agreed(ROWS[name]["runs"]), keeps(name)
    assert set(kept) <= set(Setting._fields) and all(len(why.split()) > 5 for why in kept.values())
    # Who keeps a solver keeps its substeps: another one means something else by them.
    refused = set(advised) - set(kept) - ({"substeps"} if "solver" in kept else set())
    assert not refused, f"{name}: {advised} was advised twice; set it, or say in `keeps` why not"
    stale = set(kept) - set(advised)
    assert not stale, f"{name} keeps {stale}, which nobody would change"


def test_what_is_advised_is_surely_cheaper_and_only_what_both_runs_say_counts():
    found = [run for row in ROWS.values() for run in row["runs"] if run["changes"] and run["within"]]
    assert found and all(run["share"] < 1.0 - TIE and run["interval"][1] < 1.0 for run in found)
    one, other = {"changes": {"solver": "a", "substeps": 1}}, {"changes": {"solver": "a", "substeps": 2}}
    assert agreed([one, other]) == {"solver": "a"} and agreed([one, {"changes": {}}]) == {} and agreed([one]) != {}
