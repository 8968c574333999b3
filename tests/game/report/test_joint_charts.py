"""Chart 16: equal linkages in both engines, their gaps, the measured settings, and the claims made from them."""

import sys
from math import cos, sin

import numpy as np
import pytest

import physics
from game.report.charts import joints
from game.report.charts.joints import CHART, DIRECT, ITERATIVE, LEAST, PEER, QUICK, SCENES, Setting
from game.report.claim import FAILS, HOLDS
from game.report.job import ReportScope
from game.report.linkages import BASE, METER, SPIN, Gaps, poses_in, world_of
from game.report.pymunk_linkages import BIASES, Space

needs_speed = pytest.mark.skipif(not physics.JIT, reason="thousands of steps")
SHARES = (0.0, 0.5, 1.0)
SCENES_AND_SHARES = [(scene, share) for scene in SCENES for share in SHARES]


@pytest.mark.parametrize("scene, share", SCENES_AND_SHARES)
def test_both_engines_start_alike(scene, share):
    pytest.importorskip("pymunk")
    linkage = SCENES[scene][0](share)
    world, space = world_of(linkage, "direct", 4), Space(linkage, 10, 4, BIASES[""])
    assert poses_in(world) == pytest.approx(space.poses())
    rows = world.bodies
    for row, body in zip(rows[1:], space.bodies[1:], strict=True):
        assert (row["vx"], row["vy"], row["angular_velocity"]) == (*body.velocity, body.angular_velocity)
        assert (row["mass"] / rows["mass"][1]) == pytest.approx(body.mass / space.bodies[1].mass)
        assert (row["inertia"] / rows["inertia"][1]) == pytest.approx(body.moment / space.bodies[1].moment)
    assert rows["angular_velocity"][BASE] == space.bodies[BASE].angular_velocity == linkage.spin
    assert len(world.joints) == len(space.space.constraints) / (1 + linkage.welded) == len(linkage.joints)
    for poses in (poses_in(world), space.poses()):
        assert Gaps(linkage, poses).widest(poses) < 1e-9


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("solver", [ITERATIVE, DIRECT, PEER])
def test_a_linkage_moves_and_its_joints_are_solved_in_each_step(scene, solver):
    if solver == PEER:
        pytest.importorskip("pymunk")
    linkage = SCENES[scene][0](1.0)
    step, poses = Setting(solver, 4, 10).started(linkage)
    start = poses()
    for _ in range(5):
        before = poses()
        step()
        assert (np.abs(poses() - before)[:, 1:].max(axis=0) > 0.0).all(), "each body moves in each step"
    assert np.abs(poses() - start).max() > 0.05
    if solver != PEER:
        world = world_of(linkage, solver, 4)
        world.step()
        assert world.profile.counters["joints_solved"] >= len(linkage.joints)


@pytest.mark.parametrize("scene", [scene for scene in SCENES if "weld" not in scene])
def test_the_widest_gap_is_that_of_the_world(scene):
    linkage = SCENES[scene][0](0.5)
    world = world_of(linkage, ITERATIVE, 1)
    gaps = Gaps(linkage, poses_in(world))
    for _ in range(30 if physics.JIT else 5):
        world.step()
        assert gaps.widest(poses_in(world)) == pytest.approx(world.joints["separation"].max(), rel=1e-9, abs=1e-12)


def test_the_error_of_an_arm_is_the_distance_of_its_tip_from_its_place():
    linkage = SCENES["arm of eight welds"][0](0.0)
    world = world_of(linkage, ITERATIVE, 1)
    gaps = Gaps(linkage, poses_in(world))
    for count in range(1, 6):
        world.step()
        turn = SPIN * count / 60.0
        x, y, angle = poses_in(world)[:, 8]
        tip = x + 0.5 * METER * cos(angle), y + 0.5 * METER * sin(angle)
        place = 8.0 * METER * cos(turn), 8.0 * METER * sin(turn)
        assert gaps.widest(poses_in(world)) == pytest.approx(np.hypot(tip[0] - place[0], tip[1] - place[1]))


@needs_speed
@pytest.mark.parametrize("scene", SCENES)
def test_more_substeps_err_less_and_direct_errs_less_than_iterative(scene):
    linkage = SCENES[scene][0](0.5)
    errors = {
        (solver, count): joints.run_case(Setting(solver, count), linkage)[0]
        for solver in (ITERATIVE, DIRECT)
        for count in (1, 4)
    }
    for solver in (ITERATIVE, DIRECT):
        assert 0.0 < 1.5 * errors[solver, 4] < errors[solver, 1]
    for count in (1, 4):
        assert 10.0 * errors[DIRECT, count] < errors[ITERATIVE, count]


def test_all_settings_are_named_apart_and_a_quick_report_has_fewer():
    full, quick = joints.settings_of(False), joints.settings_of(True)
    assert len({each.label for each in full}) == len(full) and set(quick) < set(full)
    assert {each.iterations for each in full if each.solver == PEER} == {5, 10, 20, 40, 80}
    jobs = {quick: CHART.jobs(ReportScope(quick, {})) for quick in (False, True)}
    assert [job.params["scene"] for job in jobs[True]] == list(QUICK)
    assert [job.params["scene"] for job in jobs[False]] == list(SCENES)
    for quick, made in jobs.items():
        assert all(job.params["quick"] is quick for job in made)


@needs_speed
@pytest.mark.parametrize("missing", [False, True])
def test_a_scene_has_a_row_for_each_setting_and_names_the_peer_that_is_missing(missing, monkeypatch):
    if missing:
        monkeypatch.setitem(sys.modules, "pymunk", None)
    else:
        pytest.importorskip("pymunk")
    scene = QUICK[1]
    rows = joints.measure(scene, quick=True)
    ours = [row for row in rows if row.get("solver") in (ITERATIVE, DIRECT)]
    assert len(ours) == 6 and len(rows) == (7 if missing else 10)
    for row in rows[: len(rows) - missing]:
        low, middle, high = row["error"]
        assert 0.0 < low <= middle <= high and row["cost"]["runs"] == len(row["cases"]) == 2
        assert row["cost"]["seconds"][0] > 0.0
    claims = CHART.claims(rows)
    named = [claim for claim in claims if "pymunk is not installed" in claim.figure]
    assert len(named) == missing and all(claim.text == f"{scene}: beside pymunk" for claim in named)
    assert any("the closest of pymunk" in claim.text for claim in claims) is not missing


def row(solver, substeps, cases, microseconds, iterations=0):
    setting = Setting(solver, substeps, iterations)
    return joints.row_of("scene", setting, cases, [1e-6 * microseconds * share for share in (0.9, 1.0, 1.1)])


def test_what_is_claimed_follows_from_the_cases():
    loose, tight = row(ITERATIVE, 4, [20.0, 33.0, 2.0], 100.0), row(DIRECT, 4, [0.1, 0.2, 0.15], 110.0)
    near, far = row(PEER, 8, [0.9, 0.8, 0.7], 300.0, 80), row(PEER, 1, [90.0, 90.0, 90.0], 10.0, 10)
    first, ten, cheap, peer = joints.claims_of("scene", [loose, tight, near, far])
    assert first.order == (tight["label"],) and first.verdict == HOLDS, "of those within a pixel"
    assert ten.verdict == HOLDS and ten.figure.startswith("165 x (13.3 to 200)"), "ratios case by case"
    assert cheap.verdict == HOLDS and peer.verdict == FAILS and "pymunk, 8 substeps x 80 iterations" in peer.text
    assert loose["failures"] == {"cases with a joint torn": 1} and far["failures"] == {"cases with a joint torn": 3}
    assert loose["error"] == [2.0, 20.0, 33.0]


def test_rounding_errors_are_not_compared():
    exact, loose = row(DIRECT, 4, [0.0, 1e-14, 0.0], 1.0), row(ITERATIVE, 4, [1.0, 1.0, 1.0], 1.0)
    assert joints.times_wider(loose, exact) == (1.0 / LEAST,) * 3
    assert joints.times_wider(exact, exact) == (1.0,) * 3


def test_of_two_biases_the_closer_one_is_kept():
    rows = [row(PEER, 4, [3.0] * 3, 1.0, 10), row(PEER, 4, [2.0] * 3, 1.0, 10), row(PEER, 4, [1.0] * 3, 1.0, 20)]
    assert [each["error"][1] for each in joints.best_biases(rows)] == [2.0, 1.0]
