"""Every scene: its bot reaches its goals, and nothing that must not matter changes the digest."""

import pytest

import physics
from game.drawing.canvas import Canvas
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.outcome import judge
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES

FRAMES = 600 if physics.JIT else 90
FEW = 100  # bodies where a scene lets one choose


def make(name, **chosen):
    scene = Registry(SCENES).scene_class(name)(seed=1, **chosen)
    if "bodies" in scene.values:
        scene.change("slider:bodies", FEW)
    return scene


def play(scene, frames, draw=False):
    session = Session(scene, BotSource())
    canvas = Canvas()
    for _ in range(frames):
        session.step()
        if draw:
            canvas.begin()
            scene.draw(canvas, 0.5)
    return session


@pytest.mark.parametrize("name", SCENES)
def test_the_bot_reaches_what_is_due(name):
    scene = make(name)
    session = play(scene, FRAMES)
    check = judge(scene, FRAMES)
    assert check["ok"], check["failures"]
    assert session.report.quarantined == 0 and not session.report.counters.get("cap_hits")


@pytest.mark.parametrize("name", SCENES)
def test_twice_and_drawn_and_under_every_broad_phase_the_same(name):
    frames = min(FRAMES, 150)
    first = make(name)
    play(first, frames)
    digest = scene_digest(first)
    drawn = make(name)
    play(drawn, frames, draw=True)
    assert scene_digest(drawn) == digest, "drawing changed the simulation"
    for strategy in physics.BROADPHASES:
        other = make(name, broadphase=strategy)
        play(other, frames)
        assert scene_digest(other) == digest, f"differs under {strategy}"


@pytest.mark.parametrize("name", SCENES)
def test_switching_the_broad_phase_mid_game_changes_nothing(name):
    frames = min(FRAMES, 120)
    first, switched = make(name), make(name)
    play(first, frames)
    session = Session(switched, BotSource())
    for frame in range(frames):
        if frame % 20 == 10:
            switched.set_broadphase(tuple(physics.BROADPHASES)[frame // 20 % 4])
        session.step()
    assert scene_digest(first) == scene_digest(switched)


@pytest.mark.parametrize("name", SCENES)
def test_restart_goes_back_to_the_start(name):
    scene = make(name)
    play(scene, 60)
    scene.restart()
    again = make(name)
    play(scene, 60)
    play(again, 60)
    assert scene_digest(scene) == scene_digest(again)


@pytest.mark.parametrize("name", SCENES)
def test_the_narrow_phase_switches_mid_game(name):
    scene = make(name)
    play(scene, 20)
    scene.change("narrowphase", not scene.narrowphase)
    play(scene, 20)
    scene.change("narrowphase", not scene.narrowphase)
    play(scene, 20)


@pytest.mark.parametrize("name", SCENES)
def test_every_slider_and_tier_can_be_turned_mid_game(name):
    scene = make(name)
    for slider in scene.sliders:
        for value in (slider.low, slider.clamp(slider.low * 1.3 + 20), slider.start):
            scene.change(f"slider:{slider.name}", value)
            play(scene, 3)
    for tier in scene.tiers:
        scene.change("tier", tier)
        play(scene, 10)


@pytest.mark.parametrize("name", SCENES)
def test_an_unknown_change_is_refused(name):
    with pytest.raises(ValueError, match="gravity"):
        make(name).change("gravity", 3)
