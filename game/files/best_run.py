"""Ghost of a scene: the player's positions in the fastest won run, saved in a file and drawn during later runs.

A trail is a list of rows (x, y, frame name, way), one per step. way: direction in which the player faces, -1 or 1. An
unusable ghost file is kept but not shown, and never stops a game.
"""

import json
from collections.abc import Sequence
from pathlib import Path

from game.errors import FileError
from game.files.data_folder import data_folder, is_there, refusal, write_atomically
from game.files.json_file import read_json

FORMAT, VERSION = "hitbox ghost", 1
LONGEST = 60 * 60 * 60  # number of rows: an hour of steps
FARTHEST = 1e7  # [px] from the origin; drawing rounds positions to integers


def ghost_path(table: str) -> Path:
    """Return the path of the ghost file of a high-score table. table: key of the table (see records.table_of)."""
    return data_folder() / "ghosts" / f"{table.replace('/', '-')}.json"


def load_ghost(table: str) -> tuple[list[tuple] | None, float | None, str]:
    """Return (trail, seconds, message) of the fastest run saved for a high-score table.

    trail: rows (x, y, frame name, direction -1 or 1) of the player, one per step; seconds: time of the run. Both are
    None if there is no usable file. message: text about an unusable file, otherwise "".
    """
    path = ghost_path(table)
    if not is_there(path):
        return None, None, ""
    try:
        data = read_json(path)
        _check(path, data)
    except FileError as error:
        why = "newer" if error.place == "version" else "damaged"
        return None, None, refusal(path, error.place, error.reason, "there is no ghost", why)
    return [tuple(row) for row in data["rows"]], data["seconds"], ""


def keep_ghost(table: str, trail: Sequence[tuple], seconds: float) -> bool:
    """Save the trail of a run if the run was faster than the saved one. Return whether the trail was saved.

    table: key of the high-score table; trail: as in load_ghost(); seconds: time of the run. Raises OSError if the file
    cannot be written.
    """
    best = load_ghost(table)[1]
    if not trail or (best is not None and best <= seconds):
        return False
    head = json.dumps({"format": FORMAT, "version": VERSION, "table": table, "seconds": seconds})
    rows = ",\n".join(json.dumps(list(row)) for row in trail)
    write_atomically(ghost_path(table), f'{head[:-1]}, "rows": [\n{rows}\n]}}\n')
    return True


def _check(path, data):
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FileError(path, "format", f"is not {FORMAT!r}")
    if data.get("version") != VERSION or isinstance(data["version"], bool):
        raise FileError(
            path, "version", f"{data.get('version')!r:.40} cannot be read here; this program reads {VERSION}"
        )
    if not _number(data.get("seconds")) or not 0 < data["seconds"] < 1e6:
        raise FileError(path, "seconds", "must be a number above 0")
    rows = data.get("rows")
    if not isinstance(rows, list) or not 0 < len(rows) <= LONGEST:
        raise FileError(path, "rows", f"must be a list of 1 to {LONGEST} rows")
    for number, row in enumerate(rows):
        fits = (
            isinstance(row, list)
            and len(row) == 4
            and _number(row[0])
            and _number(row[1])
            and isinstance(row[2], str)
            and _number(row[3])
        )
        if not fits or not (abs(row[0]) < FARTHEST and abs(row[1]) < FARTHEST):
            raise FileError(path, f"rows[{number}]", "must be [x, y, frame name, way]")


def _number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)
