"""A ranked game whose window is closed before the initials are entered still gets its entry in the high scores."""

import pygame as K
import pytest

from game.files.records import load_records
from game.input.inputs import InputFrame
from game.run.sources import ScriptSource
from tests.game.test_runs import SEEN, Settings, finish_race


@pytest.mark.parametrize("on_the_result", [False, True])
def test_the_place_is_kept(drive, on_the_result):
    d = drive("--scene", "race", settings=Settings(**SEEN, initials="XYZ"))
    if on_the_result:
        finish_race(d)
        assert d.screen.entering
    else:
        d.screen.session.source = ScriptSource([InputFrame(frozenset({"right"}))] * 60)
        d.turns(60)
        assert d.name == "Play" and d.screen.scene.result is not None
    d.post(K.QUIT)
    d.turns(1)
    d.app.run()
    assert [entry.name for entry in load_records()[0].entries("race")] == ["XYZ"]


def test_only_once(drive):
    d = drive("--scene", "race", settings=Settings(**SEEN))
    finish_race(d)
    d.key(K.K_ESCAPE)
    d.post(K.QUIT)
    d.turns(1)
    d.app.run()
    assert len(load_records()[0].entries("race")) == 1


def test_a_measured_run_leaves_no_entry(drive):
    d = drive("--scene", "race", "--frames", "250", settings=Settings(**SEEN))
    d.screen.session.source = ScriptSource([InputFrame(frozenset({"right"}))] * 250)
    d.turns(255)
    assert d.screen.scene.result is not None and not d.app.arcade.running
    d.app.run()
    assert load_records()[0].tables == {}
