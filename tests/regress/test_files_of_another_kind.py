"""A device or pipe given as output file is written to, not replaced; a screenshot without .png is still a PNG."""

import os
import threading

import pygame
import pytest

from game.files.data_folder import write_atomically
from game.run.picture import save_png


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_stays_a_pipe(tmp_path):
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    write_atomically(pipe, "a recording\n")
    reader.join(10)
    assert read == ["a recording\n"] and pipe.is_fifo()


@pytest.mark.parametrize("name", ["picture", "picture.jpg", "picture.PNG"])
def test_a_screenshot_is_a_png_whatever_it_is_called(tmp_path, name):
    save_png(pygame.Surface((4, 3)), tmp_path / name)
    assert (tmp_path / name).read_bytes().startswith(b"\x89PNG") and [each.name for each in tmp_path.iterdir()] == [
        name
    ]
