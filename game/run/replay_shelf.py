"""The user's replay files: those that the player keeps, in replays/, and the last few runs, in replays/recent/.

Only files in recent/ are ever deleted, the oldest first.
"""

from itertools import chain, count
from pathlib import Path
from stat import S_ISREG

from game.errors import FileError, brief
from game.files.data_folder import data_folder, free_name, write_atomically
from game.registry import Registry
from game.run.replay import Recorder, Replay
from game.run.replay_check import load_replay_for
from game.scene import Result

RECENT = 10  # number of runs that are kept automatically
SHORTEST = 120  # frames: shorter runs are not kept


def replays_folder() -> Path:
    """Return the path of the folder of replays that the player has decided to keep.

    Replays from other people belong there, too.
    """
    return data_folder() / "replays"


def recent_folder() -> Path:
    """Return the path of the folder of runs that are saved automatically."""
    return replays_folder() / "recent"


def shelf() -> list[tuple[Path, bool]]:
    """Return a list of (path, kept) of all replays, newest first. kept: whether the player has chosen to keep it."""
    found = [(changed, path, True) for changed, path in files_of(replays_folder())]
    found += [(changed, path, False) for changed, path in files_of(recent_folder())]
    return [(path, kept) for _, path, kept in sorted(found, key=lambda each: (-each[0], each[1].name))]


def files_of(folder: Path) -> list[tuple[float, Path]]:
    """Return a list of (modification time, path) of the replays in a folder.

    Folders, broken links, and files deleted in the meantime are not included.
    """
    found = []
    try:
        paths = list(folder.glob("*.json"))
    except OSError:  # no permission to read the folder
        return []
    for path in paths:
        try:
            status = path.stat()
        except OSError:  # a broken link, or deleted meanwhile
            continue
        if S_ISREG(status.st_mode):
            found.append((status.st_mtime, path))
    return found


def put_recent(recorder: Recorder, result: Result | None = None) -> Path | None:
    """Save a run in recent/, and delete the oldest runs there.

    Return the path; None if the run is too short to be saved. result: result of the run's game, or None. Raises
    OSError.
    """
    if recorder.frames < SHORTEST:
        return None
    path = free_name(recent_folder(), recorder.head["scene"])
    recorder.save(path, result)
    # the clock may have been set back
    runs = sorted(files_of(recent_folder()), key=lambda each: (each[1] == path, each))
    for _, old in runs[:-RECENT]:
        old.unlink(missing_ok=True)
    return path


def keep(path: Path) -> Path:
    """Copy a replay from recent/ to replays/, so that it is not deleted. Return the copy's path. Raises OSError.

    If replays/ already has a file with the same name and content, nothing is copied. If the content differs, the copy
    gets another name.
    """
    content = path.read_bytes()
    names = chain((path.name,), (f"{path.stem}-{number}{path.suffix}" for number in count(2)))
    kept = next(
        place
        for place in map(replays_folder().joinpath, names)
        if not place.exists() or (place.is_file() and place.read_bytes() == content)
    )
    if not kept.exists():
        write_atomically(kept, content)
    return kept


def read_shelf_entry(path: Path, registry: Registry) -> tuple[Replay | None, str]:
    """Read a replay. Return (replay, ""), or (None, reason) if the file is damaged or no scene can play it."""
    try:
        return load_replay_for(path, registry)[0], ""
    except FileError as error:
        return None, brief(f"{error.place}: {error.reason}")
