"""Files written by version 0.1.0 are read, or refused with a message that names the version.

`python -m tests.regress.test_files_of_0_1_0` wrote the files beside this test with version 0.1.0; it is not run again.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest

from game.errors import ReplayDiverged
from game.files.best_run import ghost_path, keep_ghost, load_ghost
from game.files.records import Entry, Records, load_records
from game.files.settings import Settings, load_settings, save_settings
from game.registry import Registry
from game.run.replay import Recorder, load_replay
from game.run.session import Session
from game.run.sources import BotSource
from physics import PHYSICS_VERSION, Chain, Circle, Effects, PixelMask, Polygon, Revolute, Snapshot, TileGrid, World
from scenes import SCENES

FOLDER = Path(__file__).with_name("files_of_0_1_0")
EFFECTS = Effects.rigid_bodies().with_(joints=True, carving=True, one_way=True)
SCENE, FRAMES = "lab/cradle", 60


def small_world():
    """Return a world with every kind of row: shapes of all sorts, a carved mask and a joint; no body has a `user`
    value.
    """
    world = World(EFFECTS, gravity=(0, 500), seed=7)
    world.add_body(TileGrid([[True, False], [True, True]], 16), position=(0, 100), kind="static")
    world.add_body(Chain([(0, 90), (200, 90)]), kind="static")
    ball = world.add_body(Circle(5), position=(50, 60), velocity=(20, 0))
    world.add_joint(Revolute(None, ball, at=(50, 40)))
    rock = world.add_body(PixelMask(np.ones((20, 30), bool)), position=(120, 60))
    rock.carve(Circle(6), (120, 50))
    world.add_body(Polygon.box(10, 10), position=(160, 50), angle=0.3)
    for _ in range(20):
        world.step()
    return world


def write():
    """Write the files. The ghost is first written to the player's data folder, so run this with HITBOX_DATA set."""
    FOLDER.mkdir(exist_ok=True)
    world = small_world()
    world.snapshot().save(FOLDER / "world.npz")
    (FOLDER / "world.txt").write_text(world.digest() + "\n")
    save_settings(Settings(), FOLDER / "settings.json")
    records = Records(FOLDER / "records.json")
    records.add("shooter", "points", Entry("ADA", 12_300, 95.5, "2026-11-28", seed=3))
    records.save()
    keep_ghost("platformer", [(x / 2, 100.0, "run", 1) for x in range(8)], 61.25)
    shutil.copy(ghost_path("platformer"), FOLDER / "ghost.json")
    scene = Registry(SCENES).scene_class(SCENE)(seed=3)
    recorder = Recorder(scene, bot=True)
    session = Session(scene, BotSource(), recorder)
    for _ in range(FRAMES):
        session.step()
    recorder.save(FOLDER / "replay.json")


def test_a_snapshot_continues_or_names_its_version():
    try:
        taken = Snapshot.load(FOLDER / "world.npz")
    except ValueError as error:
        assert "world.npz" in str(error) and "it has version 15, this program reads" in str(error)
        return
    world = World(EFFECTS)
    world.restore(taken)
    assert world.digest() == (FOLDER / "world.txt").read_text().strip() and len(world) == 5 and len(world.joints) == 1
    world.step()
    assert round(world.time, 6) == round(21 / 60, 6)


@pytest.mark.parametrize("load, name", [(load_settings, "settings.json"), (load_records, "records.json")])
def test_settings_and_scores_are_read_without_a_message(load, name, tmp_path):
    shutil.copy(FOLDER / name, tmp_path)
    found, message = load(tmp_path / name)
    assert not message and [each.name for each in tmp_path.iterdir()] == [name]
    if name == "records.json":
        assert found.best("shooter") == Entry("ADA", 12_300, 95.5, "2026-11-28", seed=3)


def test_a_ghost_is_read(tmp_path, monkeypatch):
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    ghost_path("platformer").parent.mkdir(parents=True)
    shutil.copy(FOLDER / "ghost.json", ghost_path("platformer"))
    trail, seconds, message = load_ghost("platformer")
    assert not message and seconds == 61.25 and trail is not None and trail[-1] == (3.5, 100.0, "run", 1)


def test_a_recording_is_played_or_names_its_version_and_the_frame():
    replay = load_replay(FOLDER / "replay.json")
    scene = Registry(SCENES).scene_class(replay.scene)(
        seed=replay.seed, broadphase=replay.broadphase, solver=replay.solver
    )
    session = Session(scene, replay, replay=replay)
    for _ in range(replay.frames):
        try:
            session.step()
        except ReplayDiverged as error:  # another processor may round a sine otherwise
            assert "diverged at frame" in str(error)
            break
    assert replay.frames == FRAMES and replay.scene == SCENE
    assert replay.physics == PHYSICS_VERSION or f"recorded under physics {replay.physics}" in replay.outdated


if __name__ == "__main__":
    write()
