"""A settings file of the first version with values other than text as keys does not stop the program."""

import json

import pytest

from game.files.settings import load_settings, settings_path
from game.input.rebinding import default_table


@pytest.mark.parametrize("keys", [[["a"]], [{}], [5], 5, None])
def test_the_default_is_used_and_the_file_kept(keys):
    settings_path().write_text(json.dumps({"version": 1, "volume": 0.5, "keys": {"left": keys}}))
    settings, message = load_settings()
    assert settings.effects == 0.5 and settings.keys == default_table("keys")
    assert "keys: " in message and "damaged-1" in message
