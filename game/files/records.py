"""High scores: the ten best runs of each ranked scene, in one JSON file that is written atomically.

A damaged entry is left out, and the damaged file is kept as a copy. A file of a newer version is kept but not read.
"""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from game.errors import FileError
from game.files.data_folder import data_folder, is_there, refusal, write_atomically
from game.files.json_file import read_json
from game.files.own_levels import level_digest
from game.files.settings import LETTERS

VERSION = 1
FILE = "records.json"
PLACES = 10


@dataclass(frozen=True)
class Entry:
    """One entry of a high-score table.

    assisted: whether the run was played at lower speed, with invincibility, or with a changed rule.
    """

    name: str
    points: int
    seconds: float
    date: str  # 2026-01-31
    seed: int = 0
    assisted: bool = False


class Records:
    """High scores. tables: {key of a scene's table (see table_of): list of entries, best first}."""

    def __init__(self, path: Path | None = None) -> None:
        self.path = path or records_path()
        self.tables = {}
        self.ranking = {}  # key -> ranked_by, of the tables that got entries in this process

    def entries(self, key: str | None) -> list[Entry]:
        """Return the entries of the high-score table with the key `key`, best first. If `key` is None, return []."""
        return self.tables.get(key, [])

    def best(self, key: str | None) -> Entry | None:
        """Return the best entry of the high-score table with the key `key`, or None if the table is empty."""
        found = self.entries(key)
        return found[0] if found else None

    def place(self, key: str, ranked_by: str | None, entry: Entry) -> int | None:
        """Return the place 1..10 that an entry would take in the table with the key `key`.

        Return None if the entry is not among the ten best. Among equal entries, the earlier one ranks higher.
        ranked_by: as in Scene.
        """
        better = sum(1 for each in self.entries(key) if order(each, ranked_by) <= order(entry, ranked_by))
        return better + 1 if better < PLACES else None

    def add(self, key: str, ranked_by: str | None, entry: Entry) -> int | None:
        """Insert an entry into the table with the key `key`, and remove the entry that is now beyond the last place.

        Return the place 1..10 of the entry, or None if it has none. ranked_by: as in Scene.
        """
        place = self.place(key, ranked_by, entry)
        if place is not None:
            table = self.tables.setdefault(key, [])
            table.insert(place - 1, entry)
            del table[PLACES:]
            self.ranking[key] = ranked_by
        return place

    def save(self) -> str:
        """Write the high scores, merged with the entries that another window of the game has saved. Raises OSError.

        Return a message about a damaged existing file, as load_records() does, or "".
        """
        there, message = load_records(self.path)
        for key, table in there.tables.items():
            mine = self.tables.get(key, [])
            if key in self.ranking:
                both = mine + [entry for entry in table if entry not in mine]
                self.tables[key] = sorted(both, key=lambda entry: order(entry, self.ranking[key]))[:PLACES]
            else:
                self.tables[key] = table
        tables = {key: [asdict(entry) for entry in table] for key, table in sorted(self.tables.items())}
        write_atomically(self.path, json.dumps({"version": VERSION, "tables": tables}, indent=1) + "\n")
        return message


def order(entry: Entry, ranked_by: str | None) -> tuple[float, float]:
    """Return the sort key of an entry (smaller is better). ranked_by: as in Scene.

    For "seconds", the key sorts by least time, then most points. For "points", it sorts by most points, then least
    time.
    """
    if ranked_by == "seconds":
        return entry.seconds, -entry.points
    return -entry.points, entry.seconds


def table_of(scene_name: str, level: Path | None = None) -> str:
    """Return the key of a scene's high-score table. level: file of a level made by the player, or None.

    Such a level has its own table, whose key contains a digest of the level.
    """
    return scene_name if level is None else f"{scene_name}@{level_digest(level)}"


def records_path() -> Path:
    """Return the path of this user's high-score file."""
    return data_folder() / FILE


def load_records(path: Path | None = None) -> tuple[Records, str]:
    """Return (Records, message). path: file of the high scores; None means this user's file.

    The message is "", or one line with the file, the place, the reason and the name of the kept copy.
    """
    path = path or records_path()
    records = Records(path)
    if not is_there(path):
        return records, ""
    try:
        data = read_json(path)
        _check_head(path, data)
    except FileError as error:
        why = "newer" if error.place == "version" else "damaged"
        return records, refusal(path, error.place, error.reason, "the tables start empty", why)
    problem = None
    for key, rows in data["tables"].items():
        if not isinstance(rows, list):
            problem = problem or (f"tables.{key}", "must be a list")
            continue
        for number, row in enumerate(rows):
            reason = _refusal_of(row)
            if reason:
                problem = problem or (f"tables.{key}[{number}]", reason)
            else:
                records.tables.setdefault(key, []).append(Entry(**row))
        if key in records.tables:
            del records.tables[key][PLACES:]
    return records, refusal(path, *problem, "that is left out") if problem else ""


def _check_head(path, data):
    version = data.get("version") if isinstance(data, dict) else None
    if version != VERSION or isinstance(version, bool):
        raise FileError(path, "version", f"{version!r:.40} cannot be read here; this program reads {VERSION}")
    if not isinstance(data.get("tables"), dict):
        raise FileError(path, "tables", "must be an object of lists")


def _refusal_of(row):
    """Return the reason why `row` is unusable as a high-score entry; "" if it is usable."""
    names = [entry.name for entry in fields(Entry)]
    if not isinstance(row, dict) or set(row) != set(names):
        return f"must have {', '.join(names)}"
    if not (isinstance(row["name"], str) and len(row["name"]) == 3 and all(c in LETTERS for c in row["name"])):
        return f"name must be three of {LETTERS}"
    for name in ("points", "seed"):
        if not isinstance(row[name], int) or isinstance(row[name], bool) or row[name] < 0:
            return f"{name} must be a whole number of 0 or more (got {row[name]!r:.40})"
    seconds = row["seconds"]
    if not isinstance(seconds, (int, float)) or isinstance(seconds, bool) or not 0 <= seconds < 1e6:
        return f"seconds must be a number of 0 or more (got {seconds!r:.40})"
    if not isinstance(row["date"], str) or len(row["date"]) > 10 or not row["date"].isascii():
        return "date must be like 2026-01-31"
    return "" if isinstance(row["assisted"], bool) else "assisted must be true or false"
