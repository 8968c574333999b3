"""A scene's measurement requests run outside its frames; each run is measured five times and cached by name."""

import json

import numpy as np
import pytest

from game.input.devices import DeviceSource
from game.measure.measured_runs import WARM_STEPS, RunFigures, measure_runs
from game.measure.surveyor import Surveyor
from game.measure.synchronous import measure_requests
from game.measure.timing import RUNS, Cost
from game.measure.worker import measure_stored_runs
from game.measurement_requests import STEPS, Act, MeasuredRun, RunRequest
from game.screens.parts.measuring import Measuring
from physics import Effects, Polygon, World
from tests.game.arena import Arena

PILE = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)


def pile(count):
    world = World(PILE)
    world.add_body(Polygon.box(400, 20), kind="static")
    for number in range(count):
        world.add_body(Polygon.box(20, 20), position=(0.0, -20.0 - 19.0 * number))
    return world.snapshot()


def run_of(count, **more):
    return MeasuredRun([pile(count)], "hash", **more)


class Requesting(Arena):
    """Scene that requests the costs of the piles in `piles`. made: number of times that it made a pile to measure."""

    piles, made = (1, 2), 0

    def measured(self):
        return RunRequest(self.piles, self.make)

    def make(self, name):
        self.made += 1
        return run_of(name, steps=3)


def test_every_measured_run_is_made_five_times_in_turns():
    reported = []
    measure_runs([run_of(1), run_of(12)], lambda *found: reported.append(found), lambda: True)
    assert [number for number, *_ in reported[:2]] == [0, 1]
    assert sorted(number for number, *_ in reported) == [0] * RUNS + [1] * RUNS
    least = {which: min(spent for number, spent, *_ in reported if number == which) for which in (0, 1)}
    assert 0.0 < least[0] < least[1], "twelve boxes cost more than one"


def test_a_stage_costs_less_than_the_step_and_an_unknown_one_nothing():
    reported = {}
    measured_runs = [run_of(8), run_of(8, stage="broad_phase"), run_of(8, stage="none of this name")]
    measure_runs(measured_runs, lambda number, spent, *_: reported.setdefault(number, []).append(spent), lambda: True)
    assert min(reported[0]) > min(reported[1]) > 0.0 and max(reported[2]) == 0.0


def counting(world, record):
    """Return a function that appends (record, number of the world's steps) to ACTS at each call."""
    return lambda: ACTS.append((record, world.steps))


ACTS = []


def test_an_act_is_done_in_place_of_steps_in_a_world_that_was_stepped_once():
    ACTS.clear()
    reported, act = [], Act("tests.game.measure.test_measured_runs:counting", ("kept",))
    measure_runs([run_of(2, steps=7, act=act)], lambda *found: reported.append(found), lambda: True)
    assert len(reported) == RUNS and all(spent > 0.0 for _, spent, *_ in reported)
    assert ACTS == [("kept", 1)] * (WARM_STEPS + 1 + RUNS * 8), "one call of each run comes first"


def test_an_overlap_and_a_way_are_those_of_the_steps_that_are_judged():
    reported, snapshot = [], pile(5)
    measure_runs([MeasuredRun([snapshot], "hash", judged=(3, 7))], lambda *found: reported.append(found), lambda: True)
    world, deepest, farthest = World(PILE), [], []
    world.restore(snapshot)
    for _ in range(7):
        before = world.bodies.copy()
        world.step()
        deepest.append(max(0.0, -float(world.contacts["separation"].min())))
        ways = [world.bodies[name] - before[name] for name in ("center_x", "center_y")]
        farthest.append(float(np.hypot(*ways).max()))
    assert {overlap for _, _, overlap, _ in reported} == {max(deepest[2:])} and deepest[0] > max(deepest[2:]) > 0.0
    assert [far for *_, far in reported] == pytest.approx([max(farthest[2:])] * RUNS) and farthest[0] > max(
        farthest[2:]
    )


def test_who_is_asked_for_something_else_stops():
    reported = []
    measure_runs([run_of(1)] * 3, lambda *found: reported.append(found), lambda: len(reported) < 2)
    assert len(reported) == 2


def test_a_process_measures_runs_and_remembers_them_by_name():
    surveyor = Surveyor()
    try:
        surveyor.measure_runs(RunRequest([("pile", 1), ("pile", 4)], lambda name: run_of(name[1])))
        surveyor.wait(120.0)
        assert not surveyor.trouble and not surveyor.busy
        found = dict(surveyor.figures)
        assert set(found) == {("pile", 1), ("pile", 4)} and all(map(surveyor.knows, found))
        assert all(figures.cost.pieces == STEPS and figures.cost.least > 0.0 for figures in found.values())
        asked = []
        surveyor.measure_runs(
            RunRequest([("pile", 4), ("pile", 2)], lambda name: asked.append(name) or run_of(name[1]))
        )
        surveyor.wait(120.0)
        assert asked == [("pile", 2)] and surveyor.figures.items() > found.items()
    finally:
        surveyor.stop()


def test_what_a_worker_reports_is_what_the_measured_runs_are_made_of(tmp_path):
    pile(2).save(tmp_path / "pile.npz")
    act = Act("tests.game.measure.test_measured_runs:counting", ("far",))
    stored = run_of(2, steps=4, act=act)._replace(snapshots=[str(tmp_path / "pile.npz")] * 3)._asdict()
    stored = json.loads(json.dumps(stored))
    ACTS.clear()
    lines = []
    measure_stored_runs({"moment": "runs 0", "runs": [stored]}, lines.append, lambda: True)
    reported = [json.loads(line) for line in lines]
    assert [each.get("run") for each in reported] == [0] * RUNS + [None]
    assert reported[-1] == {"moment": "runs 0", "done": True} and ("far", 1) in ACTS
    (tmp_path / "pile.npz").write_bytes(b"nothing")
    with pytest.raises(ValueError, match="no snapshot of this program"):
        measure_stored_runs({"moment": "runs 1", "runs": [stored]}, print, lambda: True)


def test_a_screen_asks_once_for_each_name():
    scene = Requesting()
    measuring = Measuring(scene, DeviceSource(), lambda: None)
    try:
        for piles in ((1, 2), (2, 3), (1, 3)):
            scene.piles = piles
            for _ in range(3):
                measuring.beside(0.0, False)
            measuring.bench.wait(120.0)
            measuring.beside(0.0, False)
        assert scene.made == 3 and set(scene.figures) == {1, 2, 3}
        assert all(figures.sure for figures in scene.figures.values())
    finally:
        measuring.leave()


def test_where_nobody_plays_it_is_known_at_once():
    scene = Requesting()
    measure_requests(scene)
    measure_requests(scene)
    assert scene.made == 2 and all(figures.cost.runs == RUNS for figures in scene.figures.values())
    assert not RunFigures(Cost.of([1.0] * (RUNS - 1), 1)).sure


def test_figures_are_no_part_of_a_scene():
    plain, known = Requesting(), Requesting()
    measure_requests(known)
    assert plain.state() == known.state() and known.measured().names == plain.measured().names
