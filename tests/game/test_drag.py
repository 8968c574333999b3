"""Dragging: which bodies can be held, how they follow the pointer, and that a recording contains the drag."""

from math import hypot

import pytest

from game.audio.sound import Sounds
from game.drawing.camera import Camera
from game.input.devices import DeviceSource
from game.input.drag import MOST_PULL
from game.input.inputs import InputFrame
from game.overlays.stack import Overlays
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.replay import Recorder, load_replay
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.scene import Scene
from game.screens.play import Play
from physics import BROADPHASES, Circle, Effects, Material, Polygon
from tests.game.plain_scene import Plain

PILE = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, sleeping=True)


class Yard(Plain, Scene):
    """Scene with a floor, a box on it, a thin card, a wall and a lift, in two views."""

    name, title, about = "yard", "Yard", "For tests."
    effects = PILE
    draggable = True

    def build(self):
        self.cameras = [Camera((0, 0, 240, 270), 1.0), Camera((240, 0, 240, 270), 0.5)]
        for _ in self.cameras:
            self.add_world()
        near, far = self.worlds
        for world in self.worlds:
            world.add_body(Polygon.box(2000, 40), position=(0, 260), kind="static")
        self.box = near.add_body(Polygon.box(32, 32), position=(60, 224), material=Material(density=1.0))
        self.card = near.add_body(Polygon.box(48, 2), position=(160, 239))
        self.wall = near.add_body(Polygon.box(20, 20), position=(200, 100), kind="static")
        self.lift = near.add_body(Polygon.box(20, 20), position=(200, 160), kind="kinematic")
        self.ball = far.add_body(Circle(20.0), position=(100, 220))

    def views(self):
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        canvas.text("yard", 4, 4)


class Shut(Yard):
    """The scene Yard without draggable bodies."""

    draggable = False


def hold(place, steps=1):
    return [InputFrame(pointer=place, pointer_down=True)] * steps


def drive(frames, steps=None, scene=None):
    scene = scene or Yard(seed=1)
    session = Session(scene, ScriptSource(frames))
    for _ in range(len(frames) if steps is None else steps):
        session.step()
    return scene


def path(start, end, steps):
    """Return input frames in which the pressed pointer moves from start to end in `steps` steps."""
    return [
        InputFrame(
            pointer=(
                round(start[0] + (end[0] - start[0]) * n / steps),
                round(start[1] + (end[1] - start[1]) * n / steps),
            ),
            pointer_down=True,
        )
        for n in range(steps + 1)
    ]


def test_the_grabbed_point_comes_to_the_pointer_and_stays_without_swinging():
    scene = drive(hold((60, 224)) + path((60, 224), (120, 120), 20) + hold((120, 120), 60))
    assert scene.drag.hold.body == scene.box
    assert hypot(scene.box.center[0] - 120, scene.box.center[1] - 120) < 2.0
    assert hypot(*scene.box.velocity) < 5.0


def test_a_step_of_the_pointer_is_answered_without_overshoot():
    frames = hold((60, 224)) + hold((60, 120), 60)
    scene, heights = Yard(seed=1), []
    session = Session(scene, ScriptSource(frames))
    for _ in range(60):
        session.step()
        heights.append(scene.box.center[1])
    assert scene.drag.holds and min(heights) > 120 - 3.0 and abs(heights[-1] - 120) < 2.0


def test_a_corner_is_held_at_that_corner():
    scene = drive(hold((48, 214)) + hold((100, 120), 300))
    x, y = scene.drag.hold.point()
    assert hypot(x - 100, y - 120) < 2.5
    assert scene.box.center[1] > 120, "it hangs below the hand"


@pytest.mark.parametrize("place", [(200, 100), (200, 160), (60, 255), (20, 30)])
def test_nothing_static_or_kinematic_and_no_air_is_grabbed(place):
    scene = drive(hold(place, 3))
    assert not scene.drag.holds
    assert scene.wall.position == (200, 100) and scene.lift.position == (200, 160)


def test_a_thin_thing_is_found_a_little_beside_it():
    scene = drive(hold((160, 235)))
    assert scene.drag.hold.body == scene.card


def test_each_view_has_its_own_world_and_zoom():
    scene = drive(hold((290, 110)) + hold((300, 60), 90))
    assert scene.drag.hold.world is scene.worlds[1] and scene.drag.hold.body == scene.ball
    assert hypot(scene.ball.center[0] - 120, scene.ball.center[1] - 120) < 3.0


def test_letting_go_lets_go_and_a_restart_too():
    scene = drive([*hold((60, 224), 3), InputFrame()])
    assert not scene.drag.holds
    scene = drive([*hold((60, 224), 3), InputFrame(pointer=(60, 224), pointer_down=True, changes=(("restart", True),))])
    assert not scene.drag.holds


def test_what_is_removed_or_made_static_is_let_go():
    for spoil in (lambda scene: scene.worlds[0].remove_body(scene.box), lambda scene: scene.box.set_kind("static")):
        scene = Yard(seed=1)
        session = Session(scene, ScriptSource(hold((60, 224), 6)))
        session.step()
        assert scene.drag.holds
        spoil(scene)
        session.step()
        assert not scene.drag.holds


def test_a_sleeper_wakes():
    scene = Yard(seed=1)
    drive([InputFrame()] * 120, scene=scene)
    assert not scene.box.awake
    drive(hold((60, 224)) + hold((60, 150), 30), scene=scene)
    assert scene.box.awake and scene.box.center[1] < 200


@pytest.mark.parametrize("side", [1.0, 32.0, 400.0])
@pytest.mark.parametrize("target", [(239, 0), (0, 269), (5, 200)])
def test_no_pull_explodes(side, target):
    scene = Yard(seed=1)
    scene.worlds[0].remove_body(scene.box)
    scene.box = scene.worlds[0].add_body(Polygon.box(side, side), position=(60, 239 - side / 2))
    frames = hold((60, round(239 - side / 2)))
    for n in range(120):
        frames += hold(target if n % 2 else (60, 100))
    drive(frames, scene=scene)
    pixels = scene.worlds[0].tolerances.pixels_per_meter
    assert hypot(*scene.box.velocity) < 2.0 * MOST_PULL * pixels / 6.0
    assert abs(scene.box.center[0]) < 2000 and abs(scene.box.center[1]) < 2000
    assert not scene.worlds[0].bodies["quarantined"].any()


def test_scenes_that_do_not_ask_are_left_alone():
    scene = drive(hold((60, 224), 5), scene=Shut(seed=1))
    assert not scene.drag.holds
    assert scene_digest(scene) == scene_digest(drive([InputFrame()] * 5, scene=Shut(seed=1)))


def test_a_bot_never_drags_unless_it_says_so():
    scene = Yard(seed=1)
    session = Session(scene, BotSource())
    for _ in range(30):
        session.step()
    assert not scene.drag.holds


@pytest.mark.parametrize("strategy", BROADPHASES)
def test_a_recorded_drag_comes_back_bit_for_bit(tmp_path, strategy):
    scene = Yard(seed=1)
    recorder = Recorder(scene)
    script = ScriptSource(
        path((60, 224), (180, 60), 40) + [InputFrame(pointer=(180, 60))] * 10 + path((290, 110), (400, 50), 30)
    )
    session = Session(scene, script, recorder)
    for _ in range(90):
        session.step()
    file = tmp_path / "drag.json"
    recorder.save(file)
    replay = load_replay(file)
    again = Yard(seed=replay.seed, broadphase=strategy)
    second = Session(again, replay, replay=replay)
    for _ in range(replay.frames):
        second.step()
    assert scene_digest(again) == scene_digest(scene)
    assert hypot(scene.ball.center[0] - 100, scene.ball.center[1] - 220) > 20, "the drag did something"


def test_the_hand_is_drawn_and_drawing_changes_nothing():
    scene = drive(hold((60, 224), 2) + hold((90, 180), 2))
    before = scene_digest(scene)
    held = Picture().draw_scene(scene, Overlays(())).surface.copy()
    assert scene_digest(scene) == before
    scene.drag.release()
    free = Picture().draw_scene(scene, Overlays(())).surface
    assert held.get_buffer().raw != free.get_buffer().raw


def test_the_pointer_is_shown_where_it_can_drag():
    shows = [Play(kind(seed=1), DeviceSource(), Sounds(silent=True)).shows_pointer for kind in (Yard, Shut)]
    assert shows == [True, False]


class Sky(Yard):
    """Scene without response: one flying disc."""

    effects = Effects(sensors=True)

    def build(self):
        self.cameras = [Camera((0, 0, 480, 270), 1.0)]
        self.add_world()
        self.disc = self.world.add_body(Circle(12.0), position=(100, 100), velocity=(30.0, 0.0))


def test_where_nothing_is_pushed_a_held_body_follows_and_then_flies_on():
    scene = Sky(seed=1)
    held = [InputFrame(pointer=(100, 100), pointer_down=True)] + [
        InputFrame(pointer=(220, 180), pointer_down=True)
    ] * 60
    session = Session(scene, ScriptSource(held + [InputFrame(pointer=(220, 180))] * 3))
    for _ in range(61):
        session.step()
    assert hypot(scene.disc.position[0] - 220, scene.disc.position[1] - 180) < 1.0
    session.step()
    assert scene.disc.velocity == (30.0, 0.0)
