"""Tests of the study's own measures: overlap against shapely, falling against scripted motions and closed forms.

Every row of the table also runs for a few steps. `python -m tests.bench stability` prints the figures of the engines.
"""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from tests.bench import stability
from tests.bench.__main__ import main
from tests.stability.piles import needs_speed
from tests.stability.study import measures, motions, stacks
from tests.stability.study.engines import Hitbox, engines
from tests.stability.study.overlap import Overlaps
from tests.stability.study.recording import Run, record
from tests.stability.study.rows import table
from tests.stability.study.scene import STEP, Fall, Scene, Solid, box, disc, polygon
from tests.stability.study.toppling import fall_time, overhangs, pendulum, stands
from tests.stability.study.verdict import Played, Verdict, judge, worst

PARTS = {
    "box": box(1.0, 0.6),
    "off its middle": box(0.4, 0.8, x=0.2, y=-0.1),
    "triangle": polygon([(0.0, 0.0), (1.2, 0.1), (0.3, 0.9)])[2],
    "seven corners": polygon([(math.cos(a), 0.7 * math.sin(a)) for a in np.arange(7) * math.tau / 7])[2],
    "disc": disc(0.45),
}


def poses_of(scene):
    return np.array([[each.x, each.y, each.angle, each.vx, each.vy, each.spin] for each in scene.solids])


def overlap(scene):
    return Overlaps(scene).deepest(poses_of(scene))


def corners(part, x, y, angle):
    c, s = math.cos(angle), math.sin(angle)
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in part.points]


def depth_by_shapely(a, b):
    """Return the overlap depth [m] of two parts at their poses, computed with shapely.

    It is the depth of the origin inside the Minkowski difference of the parts, plus both radii. a, b: tuples of
    arguments of `corners`, each beginning with a part.
    """
    differences = [(bx - ax, by - ay) for ax, ay in corners(*a) for bx, by in corners(*b)]
    hull, origin = shapely.MultiPoint(differences).convex_hull, shapely.Point(0, 0)
    signed = -hull.distance(origin) if not hull.contains(origin) else hull.boundary.distance(origin)
    return max(0.0, signed + a[0].radius + b[0].radius)


# --- overlap ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("first", PARTS)
@pytest.mark.parametrize("second", PARTS)
def test_overlap_is_the_least_move_that_parts_them(first, second):
    chance, met = np.random.default_rng(3), 0
    for _ in range(60):
        x, y = chance.uniform(-1.2, 1.2, 2)
        turns = chance.uniform(-4.0, 4.0, 2)
        a, b = (PARTS[first], 7.0, -3.0, turns[0]), (PARTS[second], 7.0 + x, -3.0 + y, turns[1])
        solids = tuple(Solid((part,), px, py, angle=turn) for part, px, py, turn in (a, b))
        right = depth_by_shapely(a, b)
        met += right > 0.0
        assert overlap(Scene(solids, 1.0)) == pytest.approx(right, abs=1e-12)
    assert 10 < met < 60


def test_overlap_asks_only_pairs_of_which_one_moves_and_that_are_there():
    lying = Solid((box(2.0, 1.0),), 0.0, 0.5, kind="static")
    other = replace(lying, x=0.5, kind="kinematic")
    two_parts = Solid((box(1.0, 1.0), disc(0.4)), 0.0, -0.45)
    scene = Scene((lying, other, two_parts), 1.0)
    assert overlap(scene) == pytest.approx(0.05)
    gone = poses_of(scene)
    gone[2] = np.nan
    assert Overlaps(scene).deepest(gone) == 0.0
    assert overlap(Scene((lying, replace(two_parts, y=-0.5)), 1.0)) == 0.0, "touching"


def test_overlap_at_the_end_is_that_of_the_last_tenth_in_millimetres():
    scene = stacks.tower([0.0, 0.0], seconds=1.0)
    poses = np.repeat(poses_of(scene)[None], 101, axis=0)
    poses[:85, 2, 1] += 0.5
    poses[85:, 2, 1] += 0.001
    poses[95, 2, 1] += 0.003
    run = run_of(scene, poses)
    assert measures.overlap_at_end(run) == pytest.approx(4.0)
    assert measures.overlap_share(run, 100) == pytest.approx(500.0)
    assert measures.overlap_share(run, 5) == pytest.approx(1.0)


# --- falling ----------------------------------------------------------------------------------------------------------


class Scripted:
    """Engine whose poses follow a script {step: {(body, column): change of the value at the start}}."""

    def __init__(self, scene, script):
        self.start, self.script, self.steps, self.removed = poses_of(scene), script, 0, []

    def step(self):
        self.steps += 1
        return 0.001 * self.steps

    def poses(self):
        now = self.start.copy()
        for (body, column), change in self.script.get(self.steps, {}).items():
            now[body, column] += change
        return now

    def awake(self):
        return np.full(len(self.start), self.steps < 9)

    def remove(self, index):
        self.removed.append((self.steps, index))


def run_of(scene, poses):
    count = len(poses)
    return Run(scene, np.asarray(poses), np.ones((count, poses.shape[1]), bool), np.zeros(count - 1), None)


@pytest.mark.parametrize(
    "change, falls",
    [
        ({(2, 0): 0.51}, True),
        ({(2, 0): -0.51}, True),
        ({(2, 0): 0.49}, False),
        ({(1, 2): 0.36}, True),
        ({(1, 2): -0.34, (2, 0): 0.2, (1, 1): 3.0}, False),
        ({(0, 0): 9.0, (0, 2): 9.0}, False),  # the floor
    ],
)
def test_what_has_moved_by_half_its_size_or_turned_has_fallen_and_ends_the_run(change, falls):
    scene = stacks.tower([0.0, 0.0], seconds=1.0, fall=Fall())
    run = record(Scripted(scene, {7: change}), scene)
    assert run.fell == (pytest.approx(7 * STEP) if falls else None)
    assert len(run.poses) == len(run.times) + 1 == (8 if falls else 61)


def test_removals_sway_rise_sleep_and_milliseconds():
    scene = replace(stacks.tower([0.0, 0.0, 0.0], seconds=1.0), removals=((5, 3),))
    script = {3: {(1, 0): -0.02, (2, 1): -0.5}, 8: {(2, 1): -0.003}, 60: {(1, 0): 0.01}}
    engine = Scripted(scene, script)
    run = record(engine, scene)
    assert engine.removed == [(5, 3)]
    assert measures.sway(run) == pytest.approx(20.0) and measures.lean(run) == pytest.approx(10.0)
    assert measures.rise(run, 2) == pytest.approx(3.0), "before the other is gone it does not count"
    assert measures.asleep_after(run) == pytest.approx(9 * STEP)
    assert measures.asleep_after(record(Scripted(scene, {}), scene, steps=8)) == math.inf
    assert measures.milliseconds(run) == pytest.approx(45.5)


@pytest.mark.parametrize("count", [2, 5, 10, 40])
@pytest.mark.parametrize("places", [stacks.offset_places, stacks.harmonic_places])
def test_towers_stand_up_to_their_limit_and_not_beyond(places, count):
    """A tower stands up to its limit and falls beyond it, sooner the farther beyond; the
    mirrored tower does the same.
    """
    for side in (1.0, -1.0):
        inside, outside = ([side * x for x in places(count, share)] for share in (1 - 1e-9, 1 + 1e-9))
        assert stands(inside) and fall_time(inside) == math.inf and not stands(outside)
        near, far = (fall_time([side * x for x in places(count, share)]) for share in (1.05, 1.1))
        assert far < near < math.inf


def test_harmonic_tower_reaches_half_a_harmonic_number_and_is_at_its_limit_everywhere():
    places = stacks.harmonic_places(6, 1.0)
    assert places[-1] - places[0] == pytest.approx(0.5 * sum(1 / k for k in range(1, 6)))
    beyond = [each for _, each, _ in overhangs(stacks.harmonic_places(6, 1.04))]
    assert beyond[1:] == pytest.approx([0.02] * 5) and beyond[0] < 0.0, "the lowest stands on the floor"


def test_rigid_part_turns_as_its_energy_says():
    """The fall time of a rigid part equals the integral of d(angle) / (angular speed).

    The speed follows from the lost height. The substitution angle = u² removes the singularity.
    """
    arm, height, inertia, turn = 0.025, 4.5, 27.5, 0.1
    u = np.linspace(1e-9, math.sqrt(turn), 200_001)
    angle = u * u
    lost = 2 * height * np.sin(0.5 * angle) ** 2 + arm * np.sin(angle)
    exact = np.trapezoid(2 * u / np.sqrt(2 * 10.0 * lost / inertia), u)
    assert pendulum(arm, height, inertia, turn) == pytest.approx(exact, rel=1e-4)
    assert pendulum(0.0, height, inertia, turn) == math.inf


@needs_speed
@pytest.mark.parametrize("places, count, slower", [(stacks.offset_places, 5, 10.0), (stacks.harmonic_places, 4, 10.0),
                                                   (stacks.harmonic_places, 8, 20.0)])  # fmt: skip
def test_where_contacts_hardly_give_way_towers_keep_to_the_analytic_limit(places, count, slower):
    """With reduced gravity, where contacts are almost rigid, towers fall at the analytic limit and time.

    A hundredth of gravity makes the motion ten times slower and the contact deflection a hundred times smaller.
    """
    slow = 10.0 / slower**2
    inside = replace(stacks.standing(places(count, 0.95)), gravity=slow, seconds=5.0 * slower)
    assert record(Hitbox(inside, substeps=8), inside).fell is None
    theory = slower * fall_time(places(count, 1.05))
    outside = replace(stacks.turning(places(count, 1.05), 2.0 * theory), gravity=slow)
    run = record(Hitbox(outside, substeps=8), outside)
    assert measures.fall_over_theory(run, theory) == pytest.approx(1.0, abs=0.02)


# --- motions ----------------------------------------------------------------------------------------------------------


def bouncing(restitution, seconds):
    """Return the exact heights of a bouncing ball's lowest point in every step, in metres."""
    heights, fall = [], math.sqrt(2 * motions.DROP / 10.0)
    for step in range(round(seconds / STEP) + 1):
        since, speed = step * STEP + fall, 10.0 * fall
        flight = 2 * fall
        while since >= flight and speed > 1e-3:
            since, speed = since - flight, speed * restitution
            flight = 2 * speed / 10.0
        heights.append(speed * since - 5.0 * since * since)
    return heights


@pytest.mark.parametrize("restitution, seconds", [(1.0, 25.0), (0.9, 15.0)])
def test_exact_bounces_have_no_error_and_missing_ones_are_errors(restitution, seconds):
    heights = bouncing(restitution, seconds)
    poses = np.zeros((len(heights), 2, 6))
    poses[:, 1, 1] = -np.array(heights) - motions.BALL
    scene = motions.bounce(restitution, seconds)
    assert abs(measures.bounce_error(run_of(scene, poses), restitution)) < 0.01
    assert abs(measures.bounce_error(run_of(scene, poses[:200]), restitution)) < 0.01, "later ones are not asked for"
    lost = poses.copy()
    lost[300:, 1, 1] = -motions.BALL
    assert measures.bounce_error(run_of(scene, lost), restitution) == -100.0
    higher = poses.copy()
    higher[:, 1, 1] = -1.02 * np.array(heights) - motions.BALL
    assert measures.bounce_error(run_of(scene, higher), restitution) == pytest.approx(2.0, abs=0.05)
    assert math.isnan(measures.bounce_error(run_of(scene, poses[:20]), restitution))


def test_oblique_blow_leaves_the_first_disc_what_is_along_the_touch():
    scene = motions.oblique()
    poses = np.repeat(poses_of(scene)[None], 2, axis=0)
    for k, (offset, speed, _) in enumerate(motions.oblique_pairs()):
        turn = math.asin(offset)  # of the normal at the touch
        poses[1, 2 * k, 3:5] = speed * offset * np.array([math.sin(turn), -math.cos(turn)])
    run = run_of(scene, poses)
    assert measures.oblique_worst(run) < 1e-12
    run.poses[1, 0, 3] += 0.24
    assert measures.oblique_worst(run) == pytest.approx(0.24 / 2.5)
    assert measures.oblique_mean(run) == pytest.approx(0.01 / 2.5)


def test_slope_plate_floor_drum_and_spin_are_read_as_they_are_moved():
    time = STEP * np.arange(301)
    down = motions.slope(0.99, 5.0)
    poses = np.zeros((301, 2, 6))
    right = 10.0 * math.sin(motions.SLOPE) * 0.01
    poses[:, 1, 3:5] = np.outer(1.02 * right * time, [math.cos(motions.SLOPE), math.sin(motions.SLOPE)])
    poses[:, 1, 0:2] = np.outer(np.where(time > 2.0, 1e-5, 0.0), [math.cos(motions.SLOPE), math.sin(motions.SLOPE)])
    assert measures.slide_error(run_of(down, poses), 0.99) == pytest.approx(2.0)
    assert measures.creep(run_of(down, poses)) == pytest.approx(0.01)

    poses = np.zeros((481, 2, 6))
    poses[:, 0, 2] = motions.PLATE_SPIN * STEP * np.arange(481)
    poses[:, 1, :3] = poses[:, 0, :3]
    still = run_of(motions.plate(1.0, 0.5), poses)
    assert measures.slips_late(still) == measures.tips_late(still) == math.inf
    poses[360:, 1, 0] += 0.01
    poses[336:, 1, 2] += 0.03
    theory = math.degrees(math.atan(0.5))
    assert measures.slips_late(still) == pytest.approx(30.0 - theory)
    assert measures.tips_late(still) == pytest.approx(28.0 - theory)

    tiles = motions.seams(1)
    poses = np.repeat(poses_of(tiles)[None], 3, axis=0)
    poses[2, -1, 0] += 1.01 * motions.SEAMS * motions.TILES[1]
    poses[1, -1, 1] -= 0.002
    assert measures.stop_error(run_of(tiles, poses)) == pytest.approx(1.0)
    assert measures.hop(run_of(tiles, poses)) == pytest.approx(2.0)

    drum = motions.tumbler()
    poses = np.repeat(poses_of(drum)[None], 2, axis=0)
    assert measures.out_of_room(run_of(drum, poses)) == 0.0
    poses[1, 0, 2], poses[1, 1:, :2] = 0.5, 0.0
    for body, (far, way) in enumerate([(6.9, 0.5 + 0.25 * math.pi), (6.9, 0.25 * math.pi - 0.5), (5.1, 0.5)]):
        poses[1, 1 + body, :2] = far * math.cos(way), far * math.sin(way)
    assert measures.out_of_room(run_of(drum, poses)) == 2.0, "only the first is in a corner as it is turned"

    rod = motions.free_spin()
    poses = np.zeros((61, 1, 6))
    poses[-1, 0, 2] = 1.001 * motions.SPIN
    assert measures.spin_error(run_of(rod, poses)) == pytest.approx(0.1)


# --- the table --------------------------------------------------------------------------------------------------------


def test_worst_is_the_farthest_from_nothing_and_unknown_when_one_is():
    assert math.isnan(worst([]))
    assert worst([1.0, -3.0, 2.0]) == -3.0 and math.isnan(worst([1.0, math.nan])) and worst([math.inf, 1.0]) == math.inf


def test_limits_are_two_sided_unless_said():
    assert table()["slope_slides"].met(-0.4) and not table()["slope_slides"].met(-0.6)
    assert table()["heavy_taken_away"].met(-40.0) and not table()["heavy_taken_away"].met(1.1)
    assert not table()["seams"].met(math.nan) and not table()["pyramid_20_asleep"].met(math.inf)
    assert len(table()) == 56
    for row in table().values():
        assert row.limit is not None or row.stands or row.unit == "ms", f"{row.name} asks nothing"
        assert row.scene(0) == row.scene(0), "the same scene each time, so that rows can share a run"


@needs_speed
@pytest.mark.parametrize("name", engines())
def test_every_row_can_be_played(name):
    """Every row runs for three steps, and a scene that should stand stays in its start pose."""
    make = engines()[name]
    for row in table().values():
        scene = row.scene(0)
        run = record(make(scene), scene, steps=3)
        assert len(run.poses) == 4 and run.fell is None and np.isfinite(run.poses).all()
        assert run.poses[0] == pytest.approx(poses_of(scene), abs=1e-12)
        assert isinstance(float(row.measure(run)), float)
        if row.stands:
            assert measures.depths(run, every=1).max() < 0.02
            assert np.abs(run.moving[:, :, :2] - run.moving[0, :, :2]).max() < 0.03, (
                f"{row.name} does not start at rest"
            )


def test_scenes_start_without_overlap():
    for row in table().values():
        assert overlap(row.scene(0)) < 1e-9, row.name


# --- the program ------------------------------------------------------------------------------------------------------


@needs_speed
@pytest.mark.parametrize("name", engines())
def test_a_ball_falls_alike_in_every_engine(name):
    scene = motions.bounce(1.0, 0.5)
    run = record(engines()[name](scene), scene)
    assert run.poses[-1, 1, 1] - run.poses[0, 1, 1] == pytest.approx(5.0 * 0.5**2, abs=0.05)
    assert run.poses[-1, 1, 4] == pytest.approx(5.0)


@pytest.mark.parametrize("seed", range(5))
def test_forty_seams_lie_ahead_and_the_floor_goes_on_beyond(seed):
    *tiles, slider = motions.seams(seed).solids
    width = motions.TILES[seed]
    assert slider.vx**2 / (2 * motions.SEAM_FRICTION * 10.0) == pytest.approx(motions.SEAMS * width)
    assert tiles[0].x - 0.5 * width < -0.5 and tiles[-1].x + 0.5 * width > motions.SEAMS * width + 0.5
    assert np.diff([tile.x for tile in tiles]) == pytest.approx(width)


@needs_speed
@pytest.mark.parametrize("name", engines())
def test_what_is_taken_away_is_gone_in_every_engine(name):
    scene = replace(stacks.heavy_taken_away(), removals=((2, 3),))
    run = record(engines()[name](scene), scene, steps=4)
    assert np.isnan(run.poses[3:, 3]).all() and np.isfinite(run.poses[:3]).all() and np.isfinite(run.poses[:, :3]).all()
    assert not run.awake[3:, 3].any() and run.awake[:, 1:3].all()


def played_as(script):
    """Return an engine (`Played`) whose bodies follow a script, see `Scripted`."""
    return Played(lambda scene: Scripted(scene, script))


def test_what_falls_misses_where_it_ought_to_stand_and_is_measured_where_it_ought_to_fall():
    turned = {30: {(2, 2): 0.4}}
    found = judge(table()["offset_5_in"], played_as(turned))
    assert not found.met and found.fell == pytest.approx(0.5) and stability.shown(found) == "X0.5"
    found = judge(table()["offset_5_out"], played_as(turned))
    assert found.met and 0.2 < found.figure < 0.5 and "X" not in stability.shown(found)
    found = judge(table()["offset_5_out"], played_as({}))
    assert not found.met and stability.shown(found) == "never!"


def test_seeds_are_played_and_the_worst_is_told():
    row, made = table()["crooked_15_sway"], []

    def make(scene):
        made.append(scene)
        return Scripted(scene, {60: {(2, 0): 0.01 if len(made) == 4 else -0.031}})

    played = Played(make)
    found = judge(row, played)
    assert made == [row.scene(seed) for seed in range(5)] and found.seeds == 5 and stability.shown(found) == "31!"
    assert judge(row, played, seeds=2).seeds == 2 and len(made) == 5, "a scene is played once"
    played.forget({row.scene(3)})
    assert judge(row, played).seeds == 5 and len(made) == 9


def test_of_seeds_that_fall_the_first_is_told_and_the_others_counted():
    made = []

    def make(scene):
        made.append(scene)
        return Scripted(scene, {30 * len(made): {(2, 0): 1.0}} if len(made) in (2, 4) else {})

    found = judge(table()["crooked_15"], Played(make))
    assert stability.shown(found) == "X1.0 3/5" and not found.met and math.isnan(found.figure)


@needs_speed
def test_program_prints_a_line_per_row_and_keeps_json(tmp_path, capsys):
    path = tmp_path / "study.json"
    asked = ["stability", "--rows", "free_spin,ratio_1000_on_5,plate_*", "--engines", "hb4", "--json", str(path)]
    assert main(asked) == 0
    said = capsys.readouterr()
    lines = {line.split()[0]: line for line in said.out.splitlines() if "|" in line}
    assert list(lines) == ["row", "ratio_1000_on_5", "plate_slips", "plate_tips", "free_spin"]
    assert "free_spin hb4" in said.err
    found = json.loads(path.read_text())["rows"]
    assert found["free_spin"]["engines"]["hb4"]["met"] and "!" not in lines["free_spin"]
    assert found["ratio_1000_on_5"]["limit"] == 20.0


def test_program_lists_rows_and_refuses_names_that_there_are_not(capsys):
    assert main(["stability", "--list", "--rows", "offset_*_in"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [
        f"offset_{count}_in" for count in (5, 10, 20, 30, 40)
    ]
    assert main(["stability", "--rows", "none"]) == 2 and "no row is named none" in capsys.readouterr().err
    assert main(["stability", "--engines", "none"]) == 2 and "no engine here" in capsys.readouterr().err


@pytest.mark.parametrize(
    "figure, met, fell, cell",
    [
        (1.2345, True, None, "1.23"),
        (1234.5, False, None, "1234!"),
        (-0.0004, True, None, "-4.0e-04"),
        (math.nan, False, None, "-!"),
        (math.inf, False, None, "never!"),
        (math.nan, False, 3.25, "X3.2 4/5"),
    ],
)
def test_cells(figure, met, fell, cell):
    found = Verdict(figure, met, fell, stood=4, seeds=5)
    assert stability.shown(found) == cell
    text = stability.to_text({"row": found}, quick=True)
    assert json.loads(text)["rows"]["row"]["stood"] == 4 and "NaN" not in text and "Infinity" not in text
