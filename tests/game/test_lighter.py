"""Reduced load while the physics is not compiled: when it begins and ends, and that a recording contains it."""

import json

import pytest

from game.audio.sound import Sounds
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.registry import Registry
from game.run.replay import load_replay
from game.run.session import Session
from game.scene import SUBSTEPS
from game.screens.parts import lighter
from game.screens.parts.lighter import FRAMES, SLOW, Lighter
from game.screens.play import Play
from scenes import SCENES
from tests.lockstep import make_scene

REGISTRY = Registry(SCENES)
LIGHTER = [name for name in REGISTRY.names if REGISTRY.scene_class(name).lighter]


class Kernels:
    """Replacement of the kernels' state: whether any kernel is on disk, and which kernels run as plain Python."""

    def __init__(self):
        self.empty, self.background, self.load, self.wanted = False, True, id, {}


@pytest.fixture
def kernels(monkeypatch):
    reported = Kernels()
    monkeypatch.setattr(lighter, "tiers", reported)
    monkeypatch.setattr(lighter, "store", lambda: reported)
    return reported


def lighter_of(name):
    scene, devices = make_scene(name), DeviceSource()
    return Lighter(scene, devices), scene, devices


def take(scene, devices):
    """Apply the setting changes that the devices give for the next step, and return them as {name: value}."""
    changes = devices.next().changes
    for change, value in changes:
        scene.change(change, value)
    return dict(changes)


def given(name):
    return {
        key if key == "substeps" else f"slider:{key}": value
        for key, value in REGISTRY.scene_class(name).lighter.items()
    }


@pytest.mark.parametrize("name", LIGHTER)
def test_it_begins_before_the_first_step_where_nothing_is_on_disk_and_ends_when_all_runs_compiled(name, kernels):
    kernels.empty = True
    one, scene, devices = lighter_of(name)
    before = {**scene.values}, [world.substeps for world in scene.worlds]
    assert take(scene, devices) == given(name) and "until the physics is compiled" in one.line
    for key, value in REGISTRY.scene_class(name).lighter.items():
        assert (scene.worlds[0].substeps if key == "substeps" else scene.values[key]) == value  # a slider may clamp
    one.note(0.5)  # the first picture: no kernel was called yet
    assert not devices.next().changes
    kernels.wanted = {"some": None}
    one.note(0.5)
    assert not devices.next().changes
    kernels.wanted = {}
    one.note(0.01)
    take(scene, devices)
    assert ({**scene.values}, [world.substeps for world in scene.worlds]) == before and one.line == ""
    kernels.wanted = {"some": None}
    for _ in range(5 * FRAMES):
        one.note(2 * SLOW)  # it does not begin again
    assert not devices.next().changes


@pytest.mark.parametrize("name", LIGHTER)
def test_where_some_are_on_disk_it_begins_after_slow_frames_once_those_are_loaded(name, kernels):
    kernels.wanted = {"some": None}
    kernels.load = None
    one, scene, devices = lighter_of(name)
    for _ in range(9):
        one.note(2 * SLOW)
    assert not devices.next().changes
    kernels.load = id
    for busy in (2 * SLOW,) * (FRAMES - 1) + (0.5 * SLOW,):
        one.note(busy)
    assert not devices.next().changes  # a single slow frame is none
    for _ in range(FRAMES):
        one.note(2 * SLOW)
    assert dict(devices.next().changes) == given(name)


@pytest.mark.parametrize("name", LIGHTER)
def test_what_is_slow_for_another_reason_stays_as_it_is(name, kernels):
    one, _, devices = lighter_of(name)
    for _ in range(20):
        one.note(5 * SLOW)
    assert not devices.next().changes and one.line == ""


@pytest.mark.parametrize("name", LIGHTER)
def test_without_a_compiler_it_ends(name, kernels):
    kernels.empty = True
    one, scene, devices = lighter_of(name)
    take(scene, devices)
    kernels.background = False
    one.note(0.5)
    assert devices.next().changes and one.line == ""


def test_what_the_player_has_changed_since_stays(kernels):
    kernels.empty = True
    one, scene, devices = lighter_of("lab/sleeping")
    take(scene, devices)
    scene.change("slider:high", 5)
    kernels.wanted = {"some": None}
    one.note(0.5)
    kernels.wanted = {}
    one.note(0.01)
    assert "slider:high" not in take(scene, devices) and scene.values["high"] == 5


@pytest.mark.parametrize("name", ["shooter", "platformer", "lander", "lab/stacks"])
def test_other_scenes_have_none(name, kernels):
    kernels.empty = True
    one, _, devices = lighter_of(name)
    kernels.wanted = {"some": None}
    for _ in range(20):
        one.note(5 * SLOW)
    assert not devices.next().changes and one.line == ""


@pytest.mark.parametrize("name", REGISTRY.names)
def test_values_are_such_as_the_scene_takes(name):
    scene_class = REGISTRY.scene_class(name)
    sliders = {slider.name: slider for slider in scene_class.sliders}
    for key, value in scene_class.lighter.items():
        if key == "substeps":
            assert scene_class.effects.stacking and value in SUBSTEPS
            assert {world.substeps for world in scene_class().worlds} <= set(SUBSTEPS)  # so that it can be undone
        else:
            assert sliders[key].clamp(value) == value != sliders[key].start


@pytest.mark.parametrize("name", ["lab/sleeping", "lab/effects", "lab/tumbler"])
def test_a_recording_holds_it(name, kernels, tmp_path):
    kernels.empty = True
    play = Play(
        make_scene(name), DeviceSource(), Sounds(silent=True), settings=Settings(hint_seen=True, labs_seen=list(SCENES))
    )
    for step in range(12):
        kernels.wanted = {} if step > 5 else {"some": None}
        play.note_busy(0.05)
        play.step()
    assert play.lighter is not None and play.lighter.over
    path = tmp_path / "run.json.gz"
    assert play.recorder is not None
    play.recorder.save(path)
    replay = load_replay(path)
    again = make_scene(name)
    session = Session(again, replay, None, replay)
    for _ in range(12):
        session.step()
    assert again.world.digest() == play.scene.world.digest()
    assert json.dumps(again.values) == json.dumps(play.scene.values)
    play.close()
