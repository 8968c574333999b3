"""`--overlay bounds,all` and `none,bounds` are refused, because "all" and "none" cannot be combined with names."""

import pytest

from game.command_line import run
from game.registry import Registry
from tests.game.arena import LISTING


@pytest.mark.parametrize("layers", ["bounds,all", "none,bounds", "all,none"])
def test_all_and_none_stand_alone(capsys, layers):
    assert run(["--scene", "arena", "--headless", "--frames", "2", "--overlay", layers], Registry(LISTING)) == 2
    assert "stands alone" in capsys.readouterr().err
