"""lab/joints: six machines work and break under both joint solvers, and the displayed numbers
are those of the worlds.
"""

from math import pi

import numpy as np
import pygame
import pytest

import physics
from game.drawing.canvas import SMALL
from game.drawing.font import load_font
from game.input.inputs import InputFrame, InputState
from game.measure.measured_runs import RunFigures
from game.measure.moment import widest_gap
from game.measure.timing import RUNS, Cost
from game.overlays.stack import Overlays
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from physics import DYNAMIC, Circle, Distance, Polygon, Revolute, Target, World
from scenes.lab.joints import BOXES, NAMES, RUN_AFTER, TIERS, TURN, Joints, gap_text
from scenes.lab.machines import walker
from scenes.lab.machines.gears import RADII, Gears, count_of
from scenes.lab.machines.kinds import MACHINES
from scenes.lab.machines.machine import HALF

needs_speed = pytest.mark.skipif(not physics.JIT, reason="thousands of steps")
EXACT = {"bridge": 0.2, "doll": 0.2, "car": 0.5, "crane": 0.2, "gears": 0.01, "walker": 1.0}  # [px] widest gap


def step(scene, *actions, pointer=(0, 0), down=False, inputs=None):
    inputs = inputs or InputState()
    inputs.set(InputFrame(frozenset(actions), pointer, down))
    scene.step(inputs)


def opened(name, tier="direct", seed=1, **settings):
    scene = Joints(seed, **settings)
    scene.change("slider:machine", NAMES.index(name))
    scene.change("slider:joints", TIERS.index(tier))
    return scene


@needs_speed
@pytest.mark.parametrize("seed", range(5))
def test_the_bot_reaches_every_goal(seed):
    scene = Joints(seed)
    session = Session(scene, BotSource())
    for _ in range(len(NAMES) * TURN + 1):
        session.step()
    goals = scene.check()
    assert len(goals) >= 2 * len(NAMES) and max(goal.due for goal in goals) <= len(NAMES) * TURN
    assert not [f"{goal.name}: {goal.detail}" for goal in goals if not goal.met]


@needs_speed
@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("machine", MACHINES, ids=lambda machine: machine.name)
def test_a_machine_holds_and_moves_for_ten_seconds(machine, tier):
    scene = opened(machine.name, tier)
    for _ in range(600):
        step(scene)
    made = scene.machine
    assert made.broken == 0 and not made.disturbed and made.steps == 600
    assert np.isfinite([made.worst, *made.figures()]).all()
    bodies = made.world.bodies[made.world.bodies["kind"] == DYNAMIC]
    assert (np.abs(bodies["center_x"]) < HALF).all() and (bodies["center_y"] < 0.0).all(), "it is in the view"
    assert made.worst <= (EXACT[machine.name] if tier != "iterative" else 10.0)


@needs_speed
@pytest.mark.parametrize("name", ["bridge", "crane", "doll"])
def test_a_tree_of_heavy_and_light_parts_is_tighter_when_solved_directly(name):
    scene = opened(name)
    for _ in range(250):
        step(scene)
    loose, tight = (machine.worst for machine in scene.machines)
    assert loose > 4.0 * tight > 0.0
    assert "times smaller" in scene.sentence()


@needs_speed
def test_a_mesh_of_loops_is_solved_exactly_too():
    scene = opened("walker")
    for _ in range(250):
        step(scene)
    loose, tight = (machine.worst for machine in scene.machines)
    assert tight < 0.01 < loose and "times smaller" in scene.sentence()


@needs_speed
@pytest.mark.parametrize("tier", ["iterative", "direct"])
@pytest.mark.parametrize("machine", MACHINES, ids=lambda machine: machine.name)
def test_breaking_breaks_and_it_goes_on(machine, tier):
    scene = opened(machine.name, tier)
    for _ in range(60):
        step(scene)
    step(scene, "bomb")
    for _ in range(200):
        step(scene)
    assert scene.machine.broken >= 1 and scene.machine.disturbed
    assert np.isfinite(scene.worlds[0].bodies["x"]).all() and np.isfinite(scene.worlds[1].bodies["x"]).all()
    figures = scene.machine.figure()
    step(scene, "bomb")  # what is gone cannot break again
    step(scene, "fire")
    assert isinstance(figures, str) and scene.machine.broken >= 1


@pytest.mark.parametrize("name", ["car", "walker", "gears", "crane"])
def test_the_motor_stops_and_starts(name):
    scene, inputs = opened(name), InputState()
    steps = 90 if physics.JIT else 20
    for _ in range(steps):
        step(scene, inputs=inputs)
    assert all(machine.running for machine in scene.machines)
    step(scene, "fire", inputs=inputs)
    assert not any(machine.running for machine in scene.machines)
    motors = scene.machine.world.joints
    assert (motors["motor_speed"][motors["motor_max"] > 0.0] == 0.0).all()
    step(scene, inputs=inputs)
    step(scene, "fire", inputs=inputs)
    assert all(machine.running for machine in scene.machines)
    assert (motors["motor_speed"] != 0.0).any()


def test_keys_choose_machines_and_tiers():
    scene, inputs = Joints(1), InputState()
    seen = []
    for _ in range(len(NAMES)):
        step(scene, "right", inputs=inputs)
        step(scene, inputs=inputs)
        seen.append(scene.machine.name)
    assert seen == [*NAMES[1:], NAMES[0]]
    step(scene, "left", inputs=inputs)
    assert scene.machine.name == NAMES[-1] and len(scene.worlds) == 2
    shown = []
    for _ in TIERS:
        step(scene, inputs=inputs)
        step(scene, "up", inputs=inputs)
        shown.append(scene.views()[0][0].joint_solver)
    assert shown == ["direct", "auto", "iterative"]
    assert [world.joint_solver for world in scene.worlds] == ["iterative", "direct"]


@pytest.mark.parametrize("name", NAMES)
def test_another_tier_shows_the_other_world_as_it_is(name):
    scene = opened(name, "iterative")
    for _ in range(5):
        step(scene)
    other = scene.worlds[1].digest()
    scene.change("slider:joints", 1)
    assert scene.views()[0][0].digest() == other and scene.machine is scene.machines[1]


def test_both_worlds_are_dragged_alike_and_let_go_of_what_is_hidden():
    scene, inputs = opened("doll"), InputState()
    x, y = (round(each) for each in scene.camera.to_canvas(*scene.machine.handle()))
    step(scene, pointer=(x, y), down=True, inputs=inputs)
    assert scene.drag.holds and scene.mirror.holds and scene.drag.held == scene.mirror.held
    for _ in range(10):
        step(scene, pointer=(x + 60, y - 10), down=True, inputs=inputs)
    assert all(machine.disturbed for machine in scene.machines)
    targets = [int((world.joints["kind"] == 7).sum()) for world in scene.worlds]
    assert targets == [1, 1]
    step(scene, inputs=inputs)
    assert [int((world.joints["kind"] == 7).sum()) for world in scene.worlds] == [0, 0]
    assert not scene.drag.holds and not scene.mirror.holds


def test_the_gap_is_that_of_the_joints_that_hold_and_not_of_the_mouse():
    world = World(Joints.effects)
    a, b = world.add_body(Circle(5)), world.add_body(Polygon.box(8, 8), position=(40, 0))
    world.add_joint(Revolute(None, a, at=(0, 0)))
    world.add_joint(Distance(a, b, at_a=(0, 0), at_b=(40, 0)))
    world.add_joint(Target(b, at=(40, 0), point=(400, 300)))
    world.joints["separation"][:] = 0.25, 0.75, 500.0
    assert widest_gap(world) == 0.75
    world.joints["enabled"][0] = world.joints["enabled"][1] = True
    world.joints["separation"][:] = 1.5, 0.75, 500.0
    assert widest_gap(world) == 1.5
    assert widest_gap(World(Joints.effects)) == 0.0


@pytest.mark.parametrize("phase", [k * pi / 6 for k in range(12)])
@pytest.mark.parametrize("side", [1, -1])
def test_the_legs_of_the_walker_are_built_without_gaps(side, phase):
    """The distances between the joints of a walker's leg equal those of the plan at any angle of its crank."""
    plan = {
        name: (side * x, y)
        for name, (x, y) in {
            "hip": walker.HIP, "top": walker.TOP, "tie": walker.TIE, "knee": walker.KNEE, "side": walker.SIDE,
        }.items()
    }  # fmt: skip
    pin = walker.CRANK * np.sin(phase), walker.AXLE[1] - walker.CRANK * np.cos(phase)
    reach = 0.0, walker.AXLE[1] - walker.CRANK
    for name, way in (("top", -side), ("tie", side)):
        lengths = walker.apart(plan["hip"], plan[name]), walker.apart(reach, plan[name])
        place = walker.circles(plan["hip"], pin, *lengths, way)
        assert walker.apart(place, plan["hip"]) == pytest.approx(lengths[0])
        assert walker.apart(place, pin) == pytest.approx(lengths[1])
        if phase == 0.0:
            assert place == pytest.approx(plan[name]), "the plan itself"


def test_the_walker_starts_without_a_gap():
    world = World(Joints.effects)
    walker.Walker(world)
    assert widest_gap(world) < 1e-9 and len(world.joints) == 31


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.1, -2.0])
def test_the_drawn_gears_mesh(turn):
    """Drawn gears mesh at any rotation: a tooth of one is at a gap of the other."""
    gears = Gears(World(Joints.effects))
    angles = [turn, -turn * RADII[0] / RADII[1], turn * RADII[0] / RADII[2]]
    for k in (0, 1):
        (ax, ay), (bx, by) = gears.places[k], gears.places[k + 1]
        toward = np.arctan2(by - ay, bx - ax)
        share_a, share_b = (
            (toward + flip - angles[j] - gears.phases[j]) * count_of(RADII[j]) / (2 * pi)
            for j, flip in ((k, 0.0), (k + 1, pi))
        )
        assert (share_a + share_b) % 1.0 == pytest.approx(0.5, abs=1e-9)


@needs_speed
@pytest.mark.parametrize("tier", ["iterative", "direct"])
def test_gears_keep_their_ratio(tier):
    scene = opened("gears", tier)
    for _ in range(900):
        step(scene)
    made = scene.machine
    turned = made.axles[0].angle, made.axles[1].angle, made.axles[2].angle
    assert made.turned > 20.0 and made.error < 1e-3
    for angle, radius in zip(turned, RADII, strict=True):
        assert abs(angle) * radius == pytest.approx(abs(turned[0]) * RADII[0], abs=0.1)  # [px] at the rims


@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("machine", MACHINES, ids=lambda machine: machine.name)
def test_the_measured_run_is_the_machine_that_is_shown(machine, tier):
    scene = opened(machine.name, tier)
    names = scene.measured().names
    assert [name[1] for name in names] == list(TIERS) and len(set(names)) == 3
    run = scene._make(next(name for name in names if name[1] == tier))
    if not physics.JIT and machine.name != "gears":
        return
    world = World(scene.effects)
    world.restore(run.snapshots[0].make())
    assert world.joint_solver == tier and len(world.joints) == len(scene.worlds[0].joints)
    assert world.substeps == scene.world.substeps and world.effects == scene.effects
    shown = opened(machine.name, tier)
    for _ in range(RUN_AFTER):
        step(shown)
    assert shown.views()[0][0].digest() == world.digest()


def test_costs_are_shown_once_they_are_known_and_never_inside_their_noise():
    scene = opened("bridge")
    for _ in range(70):
        step(scene)
    assert "a step" not in scene.finding() and scene.finding().startswith("bridge")
    names = {name[1]: name for name in scene.measured().names}
    cost = {tier: Cost.of([seconds] * RUNS, 60) for tier, seconds in (("iterative", 1e-4), ("direct", 1.5e-4))}
    scene.figures = {names[tier]: RunFigures(each, 0.0, 0.0) for tier, each in cost.items()}
    assert "50 us more a step" in scene.sentence() and "exactness costs +50 us" in scene.finding()
    noisy = Cost.of([1e-4 + 1e-4 * (k % 2) for k in range(RUNS)], 60)
    scene.figures = {names[tier]: RunFigures(noisy, 0.0, 0.0) for tier in cost}
    assert "us" not in scene.sentence()


@pytest.mark.parametrize("name", NAMES)
def test_its_words_fit(name):
    scene = opened(name)
    font = load_font(SMALL)
    machine = scene.machine
    assert font.measure(machine.seen, 1)[0] <= BOXES[0][0] - 10
    for text in (f"X {machine.breaks}", f"Space {machine.starts}"):
        assert font.measure(text, 1)[0] <= BOXES[0][0] - 50, "room for the number of broken joints"


@pytest.mark.parametrize("name", NAMES)
def test_drawing_and_the_overlay_change_nothing(name):
    scene = opened(name)
    for _ in range(4):
        step(scene)
    before = scene_digest(scene)
    plain = Picture().draw_scene(scene, Overlays(())).surface.copy()
    shown = Picture().draw_scene(scene, Overlays(("joints",))).surface
    assert scene_digest(scene) == before
    assert (pygame.surfarray.array2d(plain) != pygame.surfarray.array2d(shown)).any()


@pytest.mark.parametrize("text, gap", [("0", 0.0), ("0", 1e-8), ("<0.001", 2e-5), ("0.002", 0.0016), ("0.11", 0.1106),
                                       ("7.87", 7.868), ("17", 16.9)])  # fmt: skip
def test_gaps_are_short(text, gap):
    assert gap_text(gap) == text


@pytest.mark.parametrize("name", NAMES)
def test_a_run_is_the_same_twice(name):
    script = [InputFrame()] * 5 + [InputFrame(pointer=(240, 150), pointer_down=True)] * 5
    script += [InputFrame(frozenset(("bomb",)))] + [InputFrame(frozenset(("fire",)))] + [InputFrame()] * 8
    found = []
    for _ in range(2):
        scene = opened(name)
        session = Session(scene, ScriptSource(script))
        for _ in script:
            session.step()
        found.append(scene_digest(scene))
    assert found[0] == found[1]


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("seed", [1, 2])
def test_ten_minutes_break_no_invariant(seed):
    scene = Joints(seed)
    scene.watch_invariants(True, strict=True)
    session = Session(scene, BotSource())
    for _ in range(36_000):
        session.step()
    assert all(world.bodies["quarantined"].sum() == 0 for world in scene.worlds)
