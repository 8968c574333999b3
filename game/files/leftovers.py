"""What a killed program has left: files that it was writing, beside those that they were to replace.

They are known by their names, <file>.<process>.part (see data_folder.part_of), and removed once they are old: the other
process may be at work on another machine that shares the folder, so its age is asked about, not its number.
"""

import contextlib
import os
import re
import time
from collections.abc import Iterable
from pathlib import Path
from stat import S_ISREG

ABANDONED = 3600.0  # [s] since the last byte was written; writing a file takes a few seconds at most
NAME = re.compile(r"(.+)\.[0-9]+\.part", re.DOTALL)
FOLDERS = ("", "ghosts", "replays", "replays/recent", "screenshots")  # of the data folder


def remove_leftovers(folder: Path, inside: Iterable[str] = FOLDERS) -> None:
    """Remove what is old and half-written in these folders of a folder; what cannot be looked at is left."""
    for name in inside:
        place = folder / name
        with contextlib.suppress(OSError, ValueError):
            if not name or not place.is_symlink():
                for path in _parts(place):
                    _remove_if_abandoned(path)


def remove_parts_of(part: Path) -> None:
    """Remove what earlier programs left of one file. part: the name that this program writes it under."""
    file = _file_of(part.name)
    with contextlib.suppress(OSError, ValueError):
        for path in _parts(part.parent):
            if _file_of(path.name) == file:
                _remove_if_abandoned(path)


def _file_of(name):
    """Return the name of the file that a part belongs to, None where it is no part of ours."""
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
