"""An output file that cannot be written, such as a folder, is reported at the start of the run."""

import pytest

from game.command_line import read_options, run
from game.errors import UsageError
from game.files.data_folder import write_atomically
from game.registry import Registry
from tests.game.arena import LISTING


@pytest.mark.parametrize("flag", ["--record", "--screenshot"])
@pytest.mark.parametrize("name", [".", "/", "folder"])
def test_a_folder_is_refused_before_anything_runs(tmp_path, monkeypatch, flag, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    with pytest.raises(UsageError, match=f"^{flag}: {name} is a folder"):
        read_options(["--scene", "arena", "--headless", flag, name], Registry(LISTING))


def test_it_is_one_line_and_exit_2(capsys):
    assert run(["--scene", "arena", "--headless", "--record", "."], Registry(LISTING)) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_no_file_is_written_in_place_of_a_folder():
    with pytest.raises(OSError):
        write_atomically(".", "text")
