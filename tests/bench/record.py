"""Results of the benchmarks as one JSON object: ratios by name, the machine, and the disk space of the installed
libraries.

A ratio is this project's time over the peer's in the same run: less is better, and it is nearly the same on other
machines.
"""

import json
from importlib import metadata
from pathlib import Path

from game import VERSION
from game.measure.machine import installed as version_of
from game.measure.machine import machine

KEPT = Path(__file__).resolve().parents[2] / "docs" / "bench"  # a file per release
LIBRARIES = ("numpy", "numba", "llvmlite", "pygame-ce", "pygame")  # numba can be left out, either pygame will do
NOTABLE = 0.05  # a ratio that moved by more than this share of the kept one is pointed at


def to_record(ratios, quick):
    """Return the record of a run as a dict. ratios: {benchmark: {name: our time over the peer's}}."""
    rounded = {bench: {name: float(f"{value:.4g}") for name, value in found.items()} for bench, found in ratios.items()}
    found = {"version": VERSION, "quick": quick, "machine": machine(), "installed_mb": round(installed() / 1e6)}
    return found | {"ratios": rounded}


def installed():
    """Return the total size in bytes of the installed run-time libraries."""
    files = [metadata.distribution(name).files or () for name in LIBRARIES if version_of(name)]
    places = [Path(str(each.locate())) for some in files for each in some]
    return sum(place.stat().st_size for place in places if place.exists())


def to_text(record):
    """Return the text of the file for a record."""
    return json.dumps(record, indent=1) + "\n"


def read_record(path):
    """Return the record in a file. Raises ValueError naming the file if it is no record,
    OSError if it cannot be read.
    """
    with open(path, encoding="utf-8") as file:
        try:
            record = json.load(file)
            ratios = record["ratios"]
            sound = all(value > 0 for found in ratios.values() for value in found.values())
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"{path} is no record of ratios: {error!r}") from error
    if not sound:
        raise ValueError(f"{path} is no record of ratios: one is not above 0")
    return record


def compared(kept, measured):
    """Return a row (benchmark and name, stored ratio, measured ratio, change) for every ratio in either record."""
    rows = []
    for bench in dict.fromkeys([*kept["ratios"], *measured["ratios"]]):
        before, now = kept["ratios"].get(bench, {}), measured["ratios"].get(bench, {})
        for name in dict.fromkeys([*before, *now]):
            rows.append((f"{bench}: {name}", *_cells(before.get(name), now.get(name))))
    return rows


def _cells(before, now):
    if before is None:
        return "-", f"{now:.4g}", "new"
    if now is None:
        return f"{before:.4g}", "-", "not measured"
    change = now / before - 1.0
    word = "" if abs(change) <= NOTABLE else "slower" if change > 0 else "faster"
    return f"{before:.4g}", f"{now:.4g}", f"{100 * change:+.1f} % {word}".strip()
