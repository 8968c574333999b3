"""Partial files that killed processes left beside the files that they were writing.

A partial file is named <file>.<process>.part (see data_folder.part_of). A partial file is removed once it is old,
whatever its process id, because the process may run on another machine that shares the folder.
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
    """Remove old partial files in some subfolders of a folder. inside: names of the subfolders.

    Folders that cannot be read are ignored.
    """
    for name in inside:
        place = folder / name
        with contextlib.suppress(OSError, ValueError):
            if not name or not place.is_symlink():
                for path in _parts(place):
                    _remove_if_abandoned(path)


def remove_parts_of(part: Path) -> None:
    """Remove the old partial files of one file, which earlier processes left.

    part: path of this process's own partial file of the same file.
    """
    file = _file_of(part.name)
    with contextlib.suppress(OSError, ValueError):
        for path in _parts(part.parent):
            if _file_of(path.name) == file:
                _remove_if_abandoned(path)


def _file_of(name):
    """Return the name of the file to which a partial file belongs; None if `name` is not that of a partial file."""
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
