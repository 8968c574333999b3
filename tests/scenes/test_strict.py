"""--strict: no scene breaks an invariant under its bot, and a recording names the first invariant that is broken."""

import json

import pytest

import physics
from game.command_line import run
from game.errors import StrictFailure
from game.invariants.watch import WatchedWorld
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from tests.lockstep import make_scene

FEW = not physics.JIT
SHORT, LONG = (240, 3600) if physics.JIT else (20, 200)  # frames


def play(name, frames):
    """Play a scene by its bot and return its monitor. Raises StrictFailure if an invariant is broken."""
    session = Session(make_scene(name, FEW), BotSource(), strict=True)
    for _ in range(frames):
        session.step()
    return session.scene.monitor


@pytest.mark.parametrize("name", SCENES)
def test_no_scene_breaks_an_invariant(name):
    monitor = play(name, SHORT)
    assert monitor.first is None and monitor.frame == SHORT
    states = {status.id: status.state for status in monitor.statuses}
    assert states["U1"] == states["U2"] == states["U11"] == "green" and states["U9"] == "grey"


@pytest.mark.nightly
@pytest.mark.parametrize("name", SCENES)
def test_no_scene_breaks_an_invariant_in_a_minute(name):
    assert play(name, LONG).first is None


@pytest.fixture
def pumped(monkeypatch):
    """Patch World.step to speed up the last body of a world in each step from the 30th on."""
    made = physics.World.step

    def step(world, dt=None):
        made(world, dt)
        if world.steps >= 30:
            world.bodies["vy"][-1] -= 60.0

    monkeypatch.setattr(physics.World, "step", step)


def test_a_broken_invariant_ends_the_run(pumped):
    with pytest.raises(StrictFailure, match=r"lab/cradle, frame 30: U\d"):
        play("lab/cradle", 60)


def test_a_recording_names_the_first_broken_frame(pumped, capsys, tmp_path):
    path, scene = tmp_path / "run.json", ["--headless", "--scene", "lab/cradle", "--frames", "50"]
    registry = Registry(SCENES)
    assert run([*scene, "--bot", "--record", str(path), "--json"], registry) == 0, "nobody watched"
    plain = json.loads(capsys.readouterr().out)
    assert plain["frames"] == 50
    assert run(["--headless", "--replay", str(path), "--json"], registry) == 0
    assert json.loads(capsys.readouterr().out)["digest"] == plain["digest"]
    assert run(["--headless", "--replay", str(path), "--strict"], registry) == 1
    said = capsys.readouterr().out
    assert "lab/cradle, frame 30: U" in said and "bodies" in said and "allowed" in said
    assert run(["--headless", "--replay", str(path), "--strict", "--json"], registry) == 1
    report = json.loads(capsys.readouterr().out)
    assert report["frames"] == 30 and not report["check"]["ok"] and "frame 30" in report["check"]["failures"][0]


def test_a_run_that_breaks_is_recorded_up_to_there(pumped, capsys, tmp_path):
    path = tmp_path / "run.json"
    arguments = ["--headless", "--scene", "lab/cradle", "--frames", "50", "--bot", "--strict", "--record", str(path)]
    assert run(arguments, Registry(SCENES)) == 1
    assert "frame 30" in capsys.readouterr().out
    assert run(["--headless", "--replay", str(path), "--json"], Registry(SCENES)) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 30


def test_watching_changes_no_digest_and_is_not_counted_as_the_scenes_time(capsys):
    arguments = ["--headless", "--scene", "lab/filters", "--frames", "40", "--bot", "--json"]
    registry = Registry(SCENES)
    assert run(arguments, registry) == 0
    plain = json.loads(capsys.readouterr().out)
    assert run([*arguments, "--strict"], registry) == 0
    strict = json.loads(capsys.readouterr().out)
    assert strict["digest"] == plain["digest"] and strict["counters"] == plain["counters"]


def test_nobody_watches_unless_asked(monkeypatch):
    session = Session(make_scene("lab/filters", FEW), BotSource())
    session.step()
    assert session.scene.monitor is None
    assert all(isinstance(world, WatchedWorld) and world.watch is None for world in session.scene.worlds)
