"""Where settings, recordings and screenshots of this user live, by the platform's rule."""

import os
import sys
from pathlib import Path

OVERRIDE = "HITBOX_DATA"  # a folder; set by tests, or by a player who keeps the game on a stick


def data_folder(environment=None, platform=None):
    """The folder for this user's files; not created here (see write_atomically)."""
    environment = os.environ if environment is None else environment
    platform = sys.platform if platform is None else platform
    if environment.get(OVERRIDE):
        return Path(environment[OVERRIDE])
    if platform == "win32":
        root = environment.get("APPDATA")
        return (Path(root) if root else Path.home() / "AppData" / "Roaming") / "Hitbox"
    if platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "Hitbox"
    root = environment.get("XDG_DATA_HOME")
    return (Path(root) if root else Path.home() / ".local" / "share") / "hitbox"


def write_atomically(path, text):
    """Write a text file so that a reader sees the old file or the new one, never half of one.

    Raises OSError when the folder cannot be written; the old file is then untouched.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        with open(beside, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def keep_beside(path, why="damaged"):
    """Copy a file that cannot be used to the first free `name.damaged-N` (or another word), and return that path.

    The name is claimed with exclusive creation, so an earlier kept file is never overwritten; one that already holds
    the same is enough, or every start would leave another.
    """
    path = Path(path)
    content = path.read_bytes()
    number = 1
    while True:
        kept = path.with_name(f"{path.name}.{why}-{number}")
        try:
            with open(kept, "xb") as file:
                file.write(content)
            return kept
        except FileExistsError:
            if kept.read_bytes() == content:
                return kept
            number += 1


def refusal(path, place, reason, instead, why="damaged"):
    """Keep a file that cannot be used, and say in one line what is wrong, what is used instead and where it is kept."""
    try:
        kept = f"the old file is kept as {keep_beside(path, why).name}"
    except OSError as error:
        kept = f"the old file could not be copied ({error})"
    return f"{path}: {place}: {reason}; {instead}, {kept}"
