"""A recording that begins at a restart contains the substeps chosen before; otherwise its replay diverged."""

from game.command_line import run
from game.registry import Registry
from scenes import SCENES


def test_substeps_chosen_before_a_restart_are_recorded(drive, tmp_path):
    d = drive("--scene", "lab/conveyor", listing=SCENES)
    d.turns(5)
    play = d.screen
    play.devices.change("substeps", 1)
    d.turns(5)
    assert play.scene.world.substeps == 1
    play.restart()
    d.turns(90)
    assert play.scene.world.substeps == 1
    play.recorder.save(tmp_path / "run.json")
    play.close()
    assert run(["--headless", "--replay", str(tmp_path / "run.json")], Registry(SCENES)) == 0
