"""The program starts for a user without a home folder, as in services and containers."""

from pathlib import Path

import pytest

from game.errors import UsageError
from game.files.data_folder import data_folder


@pytest.mark.parametrize("platform", ["linux", "darwin", "win32"])
def test_it_is_said_what_to_do(monkeypatch, platform):
    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", homeless)
    with pytest.raises(UsageError, match="HITBOX_DATA"):
        data_folder({}, platform)
