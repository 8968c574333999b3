"""A survey of settings as CSV: one row for each setting and each kind of error.

A row also contains the command that repeats the measurement.
"""

import csv
import io
import json

from game.measure.machine import machine_line
from game.measure.survey import Survey

COLUMNS = (
    "scene, broadphase, narrowphase, solver, substeps, tier, joint_solver, moments, runs, us_least, us_median, "
    "us_upper, error_kind, error, error_low, error_high, floor, false_hits, reported_hits, missed_hits, true_hits, "
    "failures, command, machine"
).split(", ")


def csv_of(survey: Survey, scene: str, command: str) -> str:
    """Return the survey as the text of a CSV file.

    scene: name of the measured scene; command: command that repeats the measurement. Times are in microseconds per
    step. Errors are in pixels, or for tiers in wrong answers per 100 encounters. A number that does not apply is an
    empty field.
    """
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    system = machine_line()
    for kind in survey.kinds:
        for setting, (cost, error) in survey.known(kind).items():
            low, high = error.interval
            false, missed = error.wrong, error.missed
            row: dict[str, object] = {
                **{name: "" if value is None else value for name, value in setting._asdict().items()},
                "scene": scene,
                "moments": survey.moments,
                "runs": cost.runs,
                **{f"us_{name}": f"{1e6 * getattr(cost, name):.3f}" for name in ("least", "median", "upper")},
                "error_kind": kind,
                "error": error.value,
                "error_low": low,
                "error_high": high,
                "floor": error.floor,
                "false_hits": "" if false is None else false.count,
                "reported_hits": "" if false is None else false.total,
                "missed_hits": "" if missed is None else missed.count,
                "true_hits": "" if missed is None else missed.total,
                "failures": json.dumps(error.failures),
                "command": command,
                "machine": system,
            }
            writer.writerow([row[name] for name in COLUMNS])
    return file.getvalue()
