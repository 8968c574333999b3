"""The folder of this user's settings, recordings and screenshots, where the platform's rules place it."""

import errno
import os
import sys
from collections.abc import Mapping
from hashlib import blake2b
from itertools import count
from pathlib import Path
from time import strftime

from game.errors import LONGEST, UsageError, share
from game.files.leftovers import remove_parts_of

LONGEST_NAME = 200  # bytes of a file name, which leave room for a suffix; most systems allow 255
OVERRIDE = "HITBOX_DATA"  # variable with a folder; set by tests, or by a player with the game on a USB stick


def data_folder(environment: Mapping[str, str] | None = None, platform: str | None = None) -> Path:
    """Return the folder of this user's files. The folder is not created here (see write_atomically).

    environment, platform: values for tests; None: os.environ and sys.platform.
    """
    environment = os.environ if environment is None else environment
    platform = sys.platform if platform is None else platform
    if environment.get(OVERRIDE):
        return Path(environment[OVERRIDE])
    if platform == "win32":
        root = environment.get("APPDATA")
        return (Path(root) if root else _home() / "AppData" / "Roaming") / "Hitbox"
    if platform == "darwin":
        return _home() / "Library" / "Application Support" / "Hitbox"
    root = environment.get("XDG_DATA_HOME")
    return (Path(root) if root else _home() / ".local" / "share") / "hitbox"


def _home():
    try:
        return Path.home()
    except RuntimeError as error:
        raise UsageError(f"this user has no home folder; name one for the game's files in {OVERRIDE}") from error


def measurements_folder() -> Path:
    """Return the folder of the CSV files that the player saves."""
    return data_folder() / "measurements"


def short_path(path: Path) -> str:
    """Return a path as text, with ~ for the user's home folder."""
    home = Path(os.path.expanduser("~"))  # "~" for a user without one
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)


def is_there(path: Path) -> bool:
    """Return whether the file exists.

    It is also True if permissions forbid the check: reading the file then reports the reason.
    """
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError:
        return True
    return True


def free_name(folder: Path, scene_name: str, suffix: str = ".json") -> Path:
    """Return the path of a new file in `folder`, named after the scene and the time, with the given suffix.

    No file of that name exists yet.
    """
    name = f"{scene_name.replace('/', '-')}-{strftime('%Y%m%d-%H%M%S')}"
    path, number = folder / f"{name}{suffix}", 2
    while path.exists():
        path, number = folder / f"{name}-{number}{suffix}", number + 1
    return path


def write_atomically(path: str | Path, content: str | bytes, makes_folder: bool = True) -> None:
    """Write a file, text or bytes, so that a reader sees the old file or the new one, never a part of it.

    A device or a pipe is written to, not replaced. makes_folder: whether a missing folder is created. Partial versions
    of this file that an earlier process left are removed. Raises OSError if the folder cannot be written; the old file
    is then unchanged.
    """
    path, content = Path(path), content.encode() if isinstance(content, str) else content
    if not path.name:
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():
        path.write_bytes(content)
        return
    if makes_folder:
        path.parent.mkdir(parents=True, exist_ok=True)
    beside = part_of(path, os.getpid())
    remove_parts_of(beside)
    try:
        with open(beside, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def part_of(path: Path, process: int) -> Path:
    """Return the path of the partial file that a process writes before it replaces `path`.

    process: id of the process. In the partial file's name, a digest stands for a long file name.
    """
    name = (
        path.name if len(os.fsencode(path.name)) <= LONGEST_NAME else blake2b(os.fsencode(path.name)).hexdigest()[:32]
    )
    return path.with_name(f"{name}.{process}.part")


def keep_beside(path: str | Path, why: str = "damaged") -> Path:
    """Copy an unusable file to the first free name of the form `name.damaged-N`, and return the path of the copy.

    why: the word in place of "damaged". The name is claimed with exclusive creation, so an earlier copy is never
    overwritten. If a copy with the same content exists, its path is returned, so that repeated starts add no copies. An
    unreadable file is renamed instead, because the next save would overwrite it. Raises OSError if that fails, too.
    """
    path = Path(path)
    names = (path.with_name(f"{path.name}.{why}-{number}") for number in count(1))
    try:
        if not path.is_file():
            raise OSError(errno.EINVAL, "no file, but a folder or a device without end")
        content = path.read_bytes()
    except OSError:
        return path.rename(next(kept for kept in names if not kept.exists()))
    while True:
        kept = next(names)
        try:
            with open(kept, "xb") as file:
                file.write(content)
            return kept
        except FileExistsError:
            if kept.is_file() and kept.read_bytes() == content:
                return kept


def refusal(path: Path, place: str, reason: str, instead: str, why: str = "damaged") -> str:
    """Keep a copy of an unusable file, and return one line about it for the player.

    The line contains the path, the place in the file, the reason, the text `instead` and the name of the copy. instead:
    what the game uses in place of the file's content; why: word in the name of the copy, see keep_beside.
    """
    try:
        kept = f"the old file is kept as {keep_beside(path, why).name}"
    except OSError as error:
        kept = f"the old file could not be put aside ({error.strerror or error})"
    file, where, what, rest = share((path, place, reason, f"{instead}, {kept}"), LONGEST - 6)
    return f"{file}: {where}: {what}; {rest}"
