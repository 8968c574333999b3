"""Scenes of `python -m tests.bench moving`: both engines get the same bodies, and every run reports its stages."""

import numpy as np
import pytest

from tests.bench import moving

SMALL = [name for name in moving.SCENES if name != "100,000 flying"]


def ours(items, **options):
    return moving.Ours(items, 4, **options)


@pytest.mark.parametrize("name", SMALL)
def test_both_engines_have_the_same_bodies_after_some_steps(name):
    pytest.importorskip("pymunk")
    build = moving.SCENES[name].build
    both = build(ours), build(moving.Pymunk)
    for _ in range(3):
        spent = [run.step() for run in both]
        assert all(seconds > 0.0 for seconds in spent)
    for mine, theirs in zip(*(run.runs if isinstance(run, moving.Several) else [run] for run in both), strict=True):
        assert len(mine.ids) == len(theirs.ids) == len(mine.world.bodies)
        places = np.array([body.position for body, _ in theirs.ids])
        own = mine.world.bodies[mine.world.rows(mine.ids)]
        still = own["kind"] == 0
        assert np.allclose(np.stack([own["x"], own["y"]], axis=1)[still], places[still])
        masses = np.array([body.mass for body, _ in theirs.ids])
        assert np.allclose(own["mass"][own["kind"] == 2], masses[own["kind"] == 2], rtol=1e-9)


def test_edits_keep_the_number_of_bodies_and_are_a_stage():
    run = moving.rain(ours, count=200)
    before = len(run.world.bodies)
    for _ in range(30):
        run.step()
    stages = moving.stages_of(run)
    assert len(run.world.bodies) == before
    assert stages["edits"] > 0.0 and stages["between stages"] > 0.0 and "soft_step" in stages
    assert list(stages.values()) == sorted(stages.values(), reverse=True)


@pytest.mark.parametrize("name", moving.OWN)
def test_scenes_of_our_own_measure_two_ways(name):
    _, build = moving.OWN[name]
    found = build(2)
    assert len(found) == 2
    for times, stages in found.values():
        assert len(times) == 2 and min(times) > 0.0 and stages


def test_the_table_names_each_run_and_the_ratios_are_of_medians(capsys):
    found = {"a": ([2.0, 4.0, 40.0], {"x": 1.0}), "b": ([1.0, 2.0, 3.0], {})}
    assert moving.show("scene", found) == {"scene, a / b": 2.0}
    lines = [line.split() for line in capsys.readouterr().out.splitlines() if line.strip()]
    assert [line[0] for line in lines] == ["scene", "p50", "a", "b"] and lines[2][1:4] == ["4.000", "39.280", "2.00"]
