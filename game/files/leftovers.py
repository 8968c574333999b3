"""Removal of partial files, left by processes that were killed while they wrote a file.

A partial file is named <file>.<process>.part (see data_folder.part_of). An old partial file is removed whatever its
process id is, because the process may run on another machine that shares the folder.
"""

import contextlib
import os
import re
import time
from collections.abc import Iterable
from pathlib import Path
from stat import S_ISREG

ABANDONED = 3600.0  # [s] since the last write; writing a file takes a few seconds at most
NAME = re.compile(r"(.+)\.[0-9]+\.part", re.DOTALL)
FOLDERS = ("", "ghosts", "replays", "replays/recent", "screenshots")  # of the data folder


def remove_leftovers(folder: Path, inside: Iterable[str] = FOLDERS) -> None:
    """Remove old partial files in the subfolders `inside` of a folder. inside: names of subfolders.

    Unreadable folders are ignored.
    """
    for name in inside:
        place = folder / name
        with contextlib.suppress(OSError, ValueError):
            if not name or not place.is_symlink():
                for path in _parts(place):
                    _remove_if_abandoned(path)


def remove_parts_of(part: Path) -> None:
    """Remove the old partial files that earlier processes left for the same file as `part`.

    part: path of this process's own partial file.
    """
    file = _file_of(part.name)
    with contextlib.suppress(OSError, ValueError):
        for path in _parts(part.parent):
            if _file_of(path.name) == file:
                _remove_if_abandoned(path)


def _file_of(name):
    """Return the name of the file that the partial file `name` belongs to.

    Return None if `name` is not the name of a partial file.
    """
    found = NAME.fullmatch(name)
    return found and found[1]


def _parts(folder):
    with os.scandir(folder) as entries:
        return [Path(entry.path) for entry in entries if _file_of(entry.name)]


def _remove_if_abandoned(path):
    with contextlib.suppress(OSError):
        status = path.lstat()
        if S_ISREG(status.st_mode) and time.time() - status.st_mtime > ABANDONED:
            os.unlink(path)
