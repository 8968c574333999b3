"""Dragging in worlds with joints: a Target joint pulls without overshoot, not through walls,
and lets its body sleep.
"""

from math import cos, hypot, pi, sin

import pygame
import pytest

import physics
from game.drawing.camera import Camera
from game.input.drag import DAMPING_RATIO, HERTZ, LEASH, MOST_PULL, Drag
from game.input.inputs import InputFrame, InputState
from game.run.digest import scene_digest
from game.run.replay import Recorder, load_replay
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.sources import ScriptSource
from game.scene import Scene
from physics import BROADPHASES, Circle, Effects, Material, Polygon, Revolute, World
from tests.game.plain_scene import Plain

JOINTED = Effects.rigid_bodies().with_(joints=True)
METER = 32.0  # [px]
SAG = 9.8 * METER / (2.0 * pi * HERTZ) ** 2  # [px] below the pointer, by its weight
FASTEST = 0.5 * 2.0 * pi * HERTZ * LEASH * METER  # [px/s] at which the leash and the damping balance


class Place:
    """Camera that shows the world at a scale of 1, with a view so large that the pointer is always inside."""

    x = y = -100_000.0
    zoom = 1.0
    viewport = pygame.Rect(-100_000, -100_000, 200_000, 200_000)

    def view(self, alpha=1.0):
        return self.x, self.y


class Yard(Plain, Scene):
    """Scene with a floor, a box on it, a wall, and a chain that hangs beside it."""

    name, title, about = "jointed yard", "Yard", "For tests."
    effects = JOINTED
    draggable = True

    def build(self):
        self.camera = Camera((0, 0, 480, 270))
        world = self.add_world()
        world.add_body(Polygon.box(2000, 40), position=(0, 260), kind="static")
        self.wall = world.add_body(Polygon.box(8, 200), position=(240, 140), kind="static")
        self.box = world.add_body(Polygon.box(32, 32), position=(60, 224))
        links = world.add_bodies(Polygon.box(20, 6), [(320 + 20 * k, 60) for k in range(5)])
        world.add_joints(Revolute, [None, *links[:-1]], links, at=[(310 + 20 * k, 60) for k in range(5)])
        self.links = [world.body(each) for each in links]


class Rigid(Yard):
    """The scene Yard without joints in its effects."""

    effects = Effects.rigid_bodies()

    def build(self):
        self.camera = Camera((0, 0, 480, 270))
        world = self.add_world()
        world.add_body(Polygon.box(2000, 40), position=(0, 260), kind="static")
        self.box = world.add_body(Polygon.box(32, 32), position=(60, 224))


def pull(world, body, grip, pointer, steps, drag=None, each=lambda: None):
    """Hold a body at the point `grip` (world px) and pull it to the pointer. Return the Drag after `steps` steps.

    drag: an earlier Drag to continue, or None. each: function called after every step.
    """
    drag, view = drag or Drag(), [(world, Place())]
    inputs = InputState()
    if drag.holds:
        inputs.set(InputFrame(pointer=pointer, pointer_down=True))
    else:
        inputs.set(InputFrame(pointer=grip, pointer_down=True))
        drag.step(inputs, view)
        assert drag.held == body.id
        world.step()
    for _ in range(steps):
        inputs.set(InputFrame(pointer=pointer, pointer_down=True))
        drag.step(inputs, view)
        world.step()
        each()
    return drag


@pytest.mark.parametrize("rate", [30, 60, 240])
@pytest.mark.parametrize("substeps", [4, "auto"])
@pytest.mark.parametrize("side, density", [(4, 1.0), (32, 0.02), (32, 1.0), (32, 500.0), (300, 1.0)])
@pytest.mark.parametrize("far, turn", [(40, 0.3), (40, 4.0), (300, 1.9), (300, 5.5), (2000, 0.3), (2000, 4.0)])
def test_no_overshoot_at_any_size_mass_distance_and_rate(far, turn, side, density, substeps, rate):
    world = World(JOINTED, substeps=substeps, dt=1.0 / rate)
    body = world.add_body(Polygon.box(side, side), material=Material(density=density))
    goal = round(far * cos(turn)), round(far * sin(turn))
    way = hypot(*goal)
    beyond, speeds = [0.0], [0.0]

    def note():
        (x, y), (vx, vy) = body.center, body.velocity
        beyond.append((x * goal[0] + y * goal[1]) / way - way)
        speeds.append(hypot(vx, vy))

    seconds = 1.0 + 1.5 * way / FASTEST  # a follower of 30 Hz lags
    pull(world, body, (0, 0), goal, round(seconds * rate), each=note)
    assert max(beyond) <= 0.05 * way + SAG
    assert max(speeds) <= 1.05 * FASTEST
    assert hypot(body.center[0] - goal[0], body.center[1] - goal[1]) < 2.0 * SAG + 0.5


@pytest.mark.parametrize("side", [8, 32, 128])
@pytest.mark.parametrize("grip", [(0.0, 0.0), (0.45, 0.4), (-0.48, 0.48), (0.48, -0.48)])
@pytest.mark.parametrize("goal", [(100, 0), (0, -100), (-24, 18)])
def test_a_body_that_is_held_still_falls_asleep_and_wakes_as_the_pointer_moves(goal, grip, side):
    world = World(JOINTED)
    body = world.add_body(Polygon.box(side, side))
    start = round(grip[0] * side), round(grip[1] * side)
    pointer = start[0] + goal[0], start[1] + goal[1]
    beyond = [0.0]

    def note():
        x, y = drag.hold.point()
        along = ((x - start[0]) * goal[0] + (y - start[1]) * goal[1]) / hypot(*goal)
        beyond.append(along - hypot(*goal))

    drag = pull(world, body, start, pointer, 0)
    pull(world, body, start, pointer, 900 if physics.JIT else 600, drag, note)
    assert max(beyond) <= 0.05 * hypot(*goal) + SAG
    assert not body.awake and drag.holds
    x, y = drag.hold.point()
    assert (x - pointer[0], y - pointer[1]) == pytest.approx((0.0, SAG), abs=0.05 * SAG + 0.01)
    pull(world, body, start, (pointer[0] + 50, pointer[1]), 60, drag)
    assert drag.hold.point()[0] == pytest.approx(pointer[0] + 50, abs=3.0)


@pytest.mark.parametrize("side", [3, 16, 48])
@pytest.mark.parametrize("thick", [2, 10, 40])
@pytest.mark.parametrize("shape", ["box", "circle"])
def test_nothing_is_pulled_through_a_wall(shape, thick, side):
    world = World(JOINTED)
    world.add_body(Polygon.box(thick, 600), position=(200 + thick / 2, 0), kind="static")
    body = world.add_body(Polygon.box(side, side) if shape == "box" else Circle(side / 2))
    deepest = [0.0]
    drag = pull(world, body, (0, 0), (1500, 0), 120, each=lambda: deepest.append(body.center[0] + side / 2 - 200))
    assert max(deepest) < 0.1 * side + 1.0, "it stays on its side"
    pull(world, body, (0, 0), (-200, 0), 120, drag)
    assert hypot(body.center[0] + 200, body.center[1]) < 1.0, "and comes back"


@pytest.mark.parametrize("every", [1, 3, 20])
@pytest.mark.parametrize("side", [2.0, 32.0, 400.0])
def test_shaking_throws_nothing(side, every):
    world = World(JOINTED)
    body = world.add_body(Polygon.box(side, side))
    drag, speeds = pull(world, body, (0, 0), (0, 0), 1), [0.0]
    for n in range(120 // every):
        to = (10_000 if n % 2 else -10_000, 5_000)
        pull(world, body, None, to, every, drag, each=lambda: speeds.append(hypot(*body.velocity)))
    assert max(speeds) <= 1.05 * FASTEST
    drag.release()
    assert not len(world.joints) and hypot(*body.velocity) <= 1.05 * FASTEST


def test_the_pull_is_bounded_by_the_mass():
    world = World(JOINTED)
    body = world.add_body(Polygon.box(32, 32))
    anvil = world.add_joint(Revolute(None, body, at=(0, 0)))
    pull(world, body, (0, 0), (400, 0), 60)
    (target,) = (each for each in body.joints if each.kind == "Target")
    assert target.force <= MOST_PULL * METER * body.mass * 1.001
    assert target.force > 0.9 * MOST_PULL * METER * body.mass and abs(body.center[0]) < 0.1
    assert anvil.separation < 0.1 and DAMPING_RATIO == 1.0


def drive(frames, scene):
    session = Session(scene, ScriptSource(frames))
    for _ in frames:
        session.step()
    return scene


def held(place, steps=1):
    return [InputFrame(pointer=place, pointer_down=True)] * steps


def targets(scene):
    return [each for each in scene.world.joints["kind"].tolist() if each == 7]


def test_a_link_of_a_chain_is_dragged_and_the_chain_holds():
    scene = drive(held((390, 60), 2) + held((420, 200), 90), Yard(seed=1))
    assert scene.drag.held == scene.links[4].id and len(targets(scene)) == 1
    rows = scene.world.joints
    assert rows["separation"][rows["kind"] == 0].max() < 1.0
    scene = drive([InputFrame()] * 2, scene)
    assert not scene.drag.holds and not targets(scene) and len(scene.world.joints) == 5


@pytest.mark.parametrize("spoil", ["remove the body", "make it static", "remove the joint", "restart", "rebuild"])
def test_what_is_gone_is_let_go(spoil):
    scene = Yard(seed=1)
    session = Session(scene, ScriptSource(held((60, 224), 6)))
    session.step()
    assert scene.drag.holds and len(targets(scene)) == 1
    if spoil == "remove the body":
        scene.world.remove_body(scene.box)
    elif spoil == "make it static":
        scene.box.set_kind("static")
    elif spoil == "remove the joint":
        scene.world.remove_joints(scene.drag.hold.joint)
    elif spoil == "restart":
        scene.restart()
    else:
        scene.worlds.clear()
        scene.build()
    session.step()
    assert not scene.drag.holds and not targets(scene)


def test_without_joints_declared_nothing_is_added():
    scene = drive(held((60, 224), 2) + held((100, 150), 20), Rigid(seed=1))
    assert scene.drag.holds and scene.drag.hold.joint is None and len(scene.world.joints) == 0
    plain, declared = drive([InputFrame()] * 30, Rigid(seed=1)), Rigid(seed=1)
    declared.world.set_effects(JOINTED)
    assert plain.world.digest() == drive([InputFrame()] * 30, declared).world.digest()


SCRIPT = (
    held((60, 224), 2)
    + held((200, 60), 30)
    + [InputFrame(pointer=(200, 60))] * 10
    + held((390, 60), 2)
    + held((330, 200), 40)
    + [InputFrame()] * 6
)


@pytest.mark.parametrize("strategy", BROADPHASES)
def test_a_recorded_drag_comes_back_bit_for_bit(tmp_path, strategy):
    scene = Yard(seed=1)
    recorder = Recorder(scene)
    session = Session(scene, ScriptSource(SCRIPT), recorder)
    for _ in SCRIPT:
        session.step()
    recorder.save(tmp_path / "drag.json")
    replay = load_replay(tmp_path / "drag.json")
    again = Yard(seed=replay.seed, broadphase=strategy)
    second = Session(again, replay, replay=replay)
    for _ in range(replay.frames):
        second.step()
    assert scene_digest(again) == scene_digest(scene)
    assert scene.box.center[1] < 220, "the drag did something"


@pytest.mark.parametrize("back", [1, 8, 20, 45, 60])
def test_rewinding_into_a_drag_goes_on_with_it(back):
    """Rewinding to a step within a drag restores the Target joint and the hold, or neither."""
    scene = Yard(seed=1)
    session = Session(scene, ScriptSource(SCRIPT))
    rewind = Rewind(session)
    digests = [scene_digest(scene)]
    for _ in SCRIPT:
        session.step()
        rewind.note()
        digests.append(scene_digest(scene))
    rewind.seek(len(SCRIPT) - back)
    assert scene_digest(scene) == digests[len(SCRIPT) - back]
    assert scene.drag.holds == bool(targets(scene))
    rewind.seek(len(SCRIPT))
    assert scene_digest(scene) == digests[-1] and not targets(scene)


@pytest.mark.parametrize("name", ["sequential_impulse", "soft_step"])
def test_only_solvers_of_joints_are_offered(name):
    assert Yard(seed=1).solver_choices() == ("sequential_impulse", "soft_step")
    assert len(Rigid(seed=1).solver_choices()) == 4
    frames = [*held((60, 224)), InputFrame(pointer=(60, 224), pointer_down=True, changes=(("solver", name),))]
    scene = drive(frames + held((100, 100), 60), Yard(seed=1))
    assert scene.drag.holds and hypot(scene.box.center[0] - 100, scene.box.center[1] - 100) < 3.0
