"""Levels of the player: files in levels/ of the data folder. The menu lists each under the game that can load it."""

from collections.abc import Sequence
from hashlib import blake2b
from pathlib import Path

from game.errors import FileError
from game.files.data_folder import data_folder
from game.files.json_file import LARGEST


def levels_folder() -> Path:
    """Return the path of the folder of this user's levels."""
    return data_folder() / "levels"


def own_levels(suffixes: Sequence[str]) -> tuple[Path, ...]:
    """Return the paths of the player's level files that have one of these suffixes, sorted by name.

    suffixes: result of Scene.level_suffixes(). Return () if there is no readable levels folder.
    """
    try:
        return tuple(sorted(path for path in levels_folder().iterdir() if path.suffix in suffixes and path.is_file()))
    except OSError:  # there is no such folder, or it cannot be read
        return ()


def level_digest(path: str | Path) -> str:
    """Return a digest of a file's content, 12 hex digits, which identifies the level of a run. Raises FileError."""
    path = Path(path)
    try:
        if path.exists() and not path.is_file():
            raise FileError(path, "file", "is no file, but a folder or a device")
        if path.exists() and path.stat().st_size > LARGEST:
            raise FileError(path, "file", f"is larger than {LARGEST >> 20} MB")
        return blake2b(path.read_bytes(), digest_size=6).hexdigest()
    except OSError as error:
        raise FileError(path, "file", error.strerror or str(error)) from error
    except ValueError as error:  # a name from a recording that no system allows
        raise FileError(path, "file", str(error)) from error
