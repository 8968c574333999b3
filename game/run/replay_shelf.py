"""The replays of this user: those kept on purpose in replays/, and the last few runs in replays/recent/.

Only files in recent/ are ever deleted, the oldest first; what a player kept stays.
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

RECENT = 10  # runs that are kept unasked
SHORTEST = 120  # frames: two seconds are not worth a place


def replays_folder() -> Path:
    """Where kept replays are, and where files from friends go."""
    return data_folder() / "replays"


def recent_folder() -> Path:
    """Where the last runs are."""
    return replays_folder() / "recent"


def shelf() -> list[tuple[Path, bool]]:
    """Paths of all replays, newest first: (path, kept on purpose) each."""
    found = [(changed, path, True) for changed, path in files_of(replays_folder())]
    found += [(changed, path, False) for changed, path in files_of(recent_folder())]
    return [(path, kept) for _, path, kept in sorted(found, key=lambda each: (-each[0], each[1].name))]


def files_of(folder: Path) -> list[tuple[float, Path]]:
    """(when it was changed, path) of each replay in a folder. What is no file, or gone by now, is left out."""
    found = []
    try:
        paths = list(folder.glob("*.json"))
    except OSError:  # nobody may look into the folder
        return []
    for path in paths:
        try:
            status = path.stat()
        except OSError:  # a link to nowhere, or deleted in between
            continue
        if S_ISREG(status.st_mode):
            found.append((status.st_mtime, path))
    return found


def put_recent(recorder: Recorder, result: Result | None = None) -> Path | None:
    """Save a run as the newest of the recent ones and let the oldest go. None for a run too short; raises OSError."""
    if recorder.frames < SHORTEST:
        return None
    path = free_name(recent_folder(), recorder.head["scene"])
    recorder.save(path, result)
    runs = sorted(files_of(recent_folder()), key=lambda each: (each[1] == path, each))  # a clock may have been set back
    for _, old in runs[:-RECENT]:
        old.unlink(missing_ok=True)
    return path


def keep(path: Path) -> Path:
    """Copy a replay out of recent/ so that it stays, and return where it is now. Raises OSError.

    Another file of its name is left alone; one that holds the same is the copy.
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
    """(replay, "") or (None, reason in one line): a damaged file, or one that no scene here can play."""
    try:
        return load_replay_for(path, registry)[0], ""
    except FileError as error:
        return None, brief(f"{error.place}: {error.reason}")
