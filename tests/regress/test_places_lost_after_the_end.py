"""A finished game still enters the high scores if the window loses focus, the pad is lost or Restart is chosen in the
panel.
"""

import pygame as K

from game.input.inputs import InputFrame
from game.run.sources import ScriptSource
from game.screens.parts.panel import act
from game.screens.parts.panel_rows import play_rows
from tests.game.test_runs import SEEN, Settings


def ended(drive):
    d = drive("--scene", "race", settings=Settings(**SEEN))
    d.screen.session.source = ScriptSource([InputFrame(frozenset({"right"}))] * 60)
    d.turns(60)
    assert d.name == "Play" and d.screen.scene.result is not None
    return d


def test_the_focus_goes(drive):
    d = ended(drive)
    d.post(K.WINDOWFOCUSLOST)
    d.turns(2)
    assert d.name == "ResultScreen" and d.screen.entering


def test_the_pad_goes(drive):
    d = ended(drive)
    d.app.arcade.devices.lost_pad = True
    d.turns(2)
    assert d.name == "ResultScreen" and d.screen.entering


def test_restart_in_the_panel(drive):
    d = ended(drive)
    act(next(row for row in play_rows(d.screen) if row.label == "Restart"))
    d.turns(2)
    assert d.name == "ResultScreen" and d.screen.entering
