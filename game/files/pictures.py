"""Pictures of levels: their allowed locations, and a size limit that is checked before the pixels are decoded."""

import os
import struct
from pathlib import Path, PurePosixPath, PureWindowsPath
from stat import S_ISREG

from game.errors import FileError

HEADER = struct.Struct(">8sI4s2I")  # signature, length and kind of the first chunk, width, height
SIGNATURE, FIRST = b"\x89PNG\r\n\x1a\n", (13, b"IHDR")


def png_size(path: str | Path, most: int) -> tuple[int, int]:
    """Return (width, height) [px] of a PNG file, read from the file's header.

    Raises FileError for a file of another format, and for a width or height of more than `most` px.
    """
    try:
        with open(path, "rb") as file:
            head = file.read(HEADER.size)
    except OSError as error:
        raise FileError(path, "picture", f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:  # a name that no system allows
        raise FileError(path, "picture", f"cannot be read: {error}") from error
    signature, *first, width, height = HEADER.unpack(head.ljust(HEADER.size, b"\0"))
    if signature != SIGNATURE or tuple(first) != FIRST or len(head) < HEADER.size:
        raise FileError(path, "picture", "is no PNG file")
    if not (0 < width <= most and 0 < height <= most):
        raise FileError(path, "picture", f"is {width} x {height} px, at most {most} go each way")
    return width, height


def picture_of(level: Path, place: str, name: str, own: Path) -> Path:
    """Return the path of the picture that a level names: a file in the level's folder, or a picture of the program.

    level: path of the level's file. name: path of the picture relative to the level's folder, with slashes or
    backslashes. place: place of this name in the level's file, used in error messages.

    Editors may write paths that are valid only on the computer on which the level was made. So if `name` leads out of
    the level's folder, or if there is no such file, the file with the same name in the program's folder `own` is used.
    Raises FileError if that file does not exist either.
    """
    parts = PurePosixPath(name.replace("\\", "/"))
    leads_out = parts.is_absolute() or ".." in parts.parts or PureWindowsPath(name).anchor != ""
    try:
        if not leads_out:
            folder = Path(os.path.realpath(level.parent))
            found = Path(os.path.realpath(folder / parts))
            leads_out = not found.is_relative_to(folder)
            if not leads_out and _is_file(found):
                return found
        if parts.name and _is_file(own / parts.name):
            return own / parts.name
    except OSError as error:
        raise FileError(level, place, f"{name!r:.60} cannot be read: {error.strerror or error}") from error
    except ValueError as error:  # a name that no system allows
        raise FileError(level, place, f"{name!r:.60} cannot be read: {error}") from error
    if leads_out:
        raise FileError(level, place, f"{name!r:.60} leads out of the level's folder; put the picture beside the level")
    raise FileError(level, place, f"there is no picture {name!r:.60} beside the map")


def _is_file(path):
    """Return whether the file exists.

    Raises OSError if this cannot be checked (the name is too long, the folder is closed).
    """
    try:
        return S_ISREG(path.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError):
        return False
