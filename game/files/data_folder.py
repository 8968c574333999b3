"""The folder of this user's settings, recordings and screenshots, at the location that the platform prescribes."""

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
    """Return the path of this user's data folder. The folder is not created (write_atomically creates it).

    environment, platform: values for tests; None means os.environ and sys.platform.
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
    """Return a path as text, with ~ in place of the user's home folder."""
    home = Path(os.path.expanduser("~"))  # "~" for a user without one
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)


def is_there(path: Path) -> bool:
    """Return whether the file exists.

    The result is also True if permissions forbid the check. Reading the file then raises the error.
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

    The name is not used by an existing file.
    """
    name = f"{scene_name.replace('/', '-')}-{strftime('%Y%m%d-%H%M%S')}"
    path, number = folder / f"{name}{suffix}", 2
    while path.exists():
        path, number = folder / f"{name}-{number}{suffix}", number + 1
    return path


def write_atomically(path: str | Path, content: str | bytes, makes_folder: bool = True) -> None:
    """Write a text or binary file atomically: a reader sees either the old file or the complete new one.

    A device or a pipe is written to directly. makes_folder: whether a missing folder is created. Partial versions of
    this file that earlier processes left are removed. Raises OSError if the folder cannot be written; the old file is
    then unchanged.
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
    """Return the path of the partial file that a process writes and then renames to `path`.

    process: id of the process. If the file name is too long, a digest replaces it in the name of the partial file.
    """
    name = (
        path.name if len(os.fsencode(path.name)) <= LONGEST_NAME else blake2b(os.fsencode(path.name)).hexdigest()[:32]
    )
    return path.with_name(f"{name}.{process}.part")


def keep_beside(path: str | Path, why: str = "damaged") -> Path:
    """Copy an unusable file to the first unused name of the form `name.damaged-N`, and return the path of the copy.

    why: the word in place of "damaged". If a copy with the same content exists, its path is returned, so that repeated
    starts of the program add no copies. The copy is created exclusively, so that no earlier copy is overwritten.

    A file that cannot be read is renamed instead, because the next save would overwrite it. Raises OSError if the
    renaming fails.
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
    """Keep a copy of an unusable file (see keep_beside), and return one line about it for the player.

    The line contains the path, the place in the file, the reason, the text `instead` and the name of the copy.

    instead: text that says which values are used in place of the file's content; why: word in the name of the copy.
    """
    try:
        kept = f"the old file is kept as {keep_beside(path, why).name}"
    except OSError as error:
        kept = f"the old file could not be put aside ({error.strerror or error})"
    file, where, what, rest = share((path, place, reason, f"{instead}, {kept}"), LONGEST - 6)
    return f"{file}: {where}: {what}; {rest}"
