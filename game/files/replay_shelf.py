"""The replays of this user: those kept on purpose in replays/, and the last few runs in replays/recent/.

Only files in recent/ are ever deleted, the oldest first; what a player kept stays.
"""

import shutil
from time import strftime

from game.errors import FileError
from game.files.data_folder import data_folder
from game.files.replay_check import load_replay_for

RECENT = 10            # runs that are kept unasked
SHORTEST = 120         # frames: two seconds are not worth a place


def replays_folder():
    """Where kept replays are, and where files from friends go."""
    return data_folder() / "replays"


def recent_folder():
    """Where the last runs are."""
    return replays_folder() / "recent"


def shelf():
    """Paths of all replays, newest first: (path, kept on purpose) each."""
    found = [(path, True) for path in replays_folder().glob("*.json")]
    found += [(path, False) for path in recent_folder().glob("*.json")]
    return sorted(found, key=lambda each: (-each[0].stat().st_mtime, each[0].name))


def put_recent(recorder, result=None):
    """Save a run as the newest of the recent ones and let the oldest go. None for a run too short; raises OSError."""
    if recorder.frames < SHORTEST:
        return None
    path = free_name(recent_folder(), recorder.head["scene"])
    recorder.save(path, result)
    runs = sorted(recent_folder().glob("*.json"), key=lambda each: (each.stat().st_mtime, each.name))
    for old in runs[:-RECENT]:
        old.unlink(missing_ok=True)
    return path


def keep(path):
    """Copy a replay out of recent/ so that it stays, and return where it is now. Raises OSError."""
    kept = replays_folder() / path.name
    if not kept.exists():
        part = kept.with_name(kept.name + ".part")
        try:
            shutil.copyfile(path, part)
            part.replace(kept)
        finally:
            part.unlink(missing_ok=True)
    return kept


def free_name(folder, scene_name):
    """A path that no file has yet: the scene and the time."""
    name = f"{scene_name.replace('/', '-')}-{strftime('%Y%m%d-%H%M%S')}"
    path, number = folder / f"{name}.json", 2
    while path.exists():
        path, number = folder / f"{name}-{number}.json", number + 1
    return path


def read_shelf_entry(path, registry):
    """(replay, "") or (None, reason in one line): a damaged file, or one that no scene here can play."""
    try:
        return load_replay_for(path, registry)[0], ""
    except FileError as error:
        return None, f"{error.place}: {error.reason}"
