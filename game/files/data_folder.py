"""Where settings, recordings and screenshots of this user live, by the platform's rule."""

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

LONGEST_NAME = 200  # bytes of a file name that leave room for more behind it; most systems take 255
OVERRIDE = "HITBOX_DATA"  # a folder; set by tests, or by a player who keeps the game on a stick


def data_folder(environment: Mapping[str, str] | None = None, platform: str | None = None) -> Path:
    """The folder for this user's files; not created here (see write_atomically)."""
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


def is_there(path: Path) -> bool:
    """False where there is no such file; True also where nobody may look: reading it then says why not."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError:
        return True
    return True


def free_name(folder: Path, scene_name: str, suffix: str = ".json") -> Path:
    """A path that no file has yet: the scene and the time."""
    name = f"{scene_name.replace('/', '-')}-{strftime('%Y%m%d-%H%M%S')}"
    path, number = folder / f"{name}{suffix}", 2
    while path.exists():
        path, number = folder / f"{name}-{number}{suffix}", number + 1
    return path


def write_atomically(path: str | Path, content: str | bytes, makes_folder: bool = True) -> None:
    """Write a file, text or bytes, so that a reader sees the old file or the new one, never half of one.

    A device or a pipe is written to, not replaced. makes_folder: whether a missing folder is made. What an earlier
    program left half-written of this file is removed. Raises OSError when the folder cannot be written; the old file
    is then untouched.
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
    """Return where a process writes a file that is to replace `path`; a long name is named by its digest there."""
    name = (
        path.name if len(os.fsencode(path.name)) <= LONGEST_NAME else blake2b(os.fsencode(path.name)).hexdigest()[:32]
    )
    return path.with_name(f"{name}.{process}.part")


def keep_beside(path: str | Path, why: str = "damaged") -> Path:
    """Copy a file that cannot be used to the first free `name.damaged-N` (or another word), and return that path.

    The name is claimed with exclusive creation, so an earlier kept file is never overwritten; one that already holds
    the same is enough, or every start would leave another. What cannot be read is not copied but renamed: the next save
    would write over the only one there is. Raises OSError where that is not possible either.
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
    """Keep a file that cannot be used; return a line of what is wrong, what is used instead and where it is kept."""
    try:
        kept = f"the old file is kept as {keep_beside(path, why).name}"
    except OSError as error:
        kept = f"the old file could not be put aside ({error.strerror or error})"
    file, where, what, rest = share((path, place, reason, f"{instead}, {kept}"), LONGEST - 6)
    return f"{file}: {where}: {what}; {rest}"
