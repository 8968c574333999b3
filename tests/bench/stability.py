"""The stability study: every row of tests/stability/study/rows.py on each available engine, in one run.

python -m tests.bench stability                                  all rows, all engines
python -m tests.bench stability --list                           the rows' names and limits
python -m tests.bench stability --rows crooked_20,"offset_*"     some rows, as shell patterns
python -m tests.bench stability --engines hb4,pymunk --quick     some engines; one seed instead of five
python -m tests.bench stability --json FILE                      the figures as JSON, printed (-) or in a file

A cell shows the figure to which the row's limit applies, with "!" if it is beyond the limit. If a pile falls that must
stand, the cell shows X, the second of the fall, and for how many seeds the pile stood. "-" means that the run does not
show the figure. Hitbox is soft_step with 4 and 8 substeps ("hb4", "hb8"), soft_step with the substeps that the world
chooses ("auto"), and sequential_impulse. pymunk takes four steps of 1/240 s with 10 iterations. The column "quoted" is
not measured here: it has figures of the study.
"""

import argparse
import contextlib
import json
import math
import sys
from dataclasses import asdict
from fnmatch import fnmatchcase
from time import perf_counter

from game import VERSION
from game.measure.machine import machine
from tests.stability.study.engines import engines
from tests.stability.study.rows import table
from tests.stability.study.verdict import Played, Verdict, judge, scenes_of

NAME, LIMIT, CELL = 20, 12, 12  # [characters]


def shown(verdict):
    """Return the cell of the table for a verdict."""
    if verdict.fell is not None:
        return f"X{verdict.fell:.1f}" + (f" {verdict.stood}/{verdict.seeds}" if verdict.seeds > 1 else "")
    figure = verdict.figure
    text = "-" if math.isnan(figure) else "never" if math.isinf(figure) else number(figure)
    return text + ("" if verdict.met else "!")


def number(value):
    """Return a number as text with three digits, without an exponent down to a thousandth."""
    size = abs(value)
    if size >= 100.0:
        return f"{value:.0f}"
    if size >= 1e-3:
        return f"{value:.3g}"
    return "0" if size < 1e-9 else f"{value:.1e}"


def limit_of(row):
    if row.limit is None:
        return "stands" if row.stands else row.unit
    return f"{row.limit:g} {row.unit}".strip()


def line(name, limit, cells, quoted):
    return " | ".join([name.ljust(NAME), limit.ljust(LIMIT), *(cell.rjust(CELL) for cell in cells), quoted])


def study(chosen, names, seeds):
    """Simulate the rows with each engine, and print each row when it is finished.

    Return {row: {limit, unit, source, engines: {name: its verdict}}}. chosen: rows; names: names of engines; seeds:
    number of seeds of each row, None for all.
    """
    made, found, started = engines(), {}, perf_counter()
    played = {name: Played(made[name]) for name in names}
    print(line("row", "limit", names, "quoted"), flush=True)
    for place, row in enumerate(chosen):
        verdicts = {}
        for name in names:
            sys.stderr.write(f"{perf_counter() - started:6.1f} s  {place + 1}/{len(chosen)} {row.name} {name}\n")
            verdicts[name] = judge(row, played[name], seeds)
        print(line(row.name, limit_of(row), [shown(each) for each in verdicts.values()], row.quoted), flush=True)
        found[row.name] = {"limit": row.limit, "unit": row.unit, "source": row.source, "engines": verdicts}
        following = {scene for each in chosen[place + 1 : place + 3] for scene in scenes_of(each, seeds)}
        for each in played.values():
            each.forget(following)
    for name in names:
        met = sum(each["engines"][name].met for each in found.values())
        print(f"{name}: {met} of {len(chosen)} rows within their limits")
    print(f"{perf_counter() - started:.0f} s")
    return found


def finite(value):
    """Return a value in a form that JSON can represent: verdicts as dicts, NaN and inf as texts."""
    if isinstance(value, Verdict):
        value = asdict(value)
    if isinstance(value, dict):
        return {key: finite(each) for key, each in value.items()}
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def to_text(found, quick):
    """Return the study as JSON text, with the machine on which it ran."""
    record = {"version": VERSION, "quick": quick, "machine": machine(), "rows": finite(found)}
    return json.dumps(record, indent=1) + "\n"


def chosen_names(text, known, what):
    """Return the known names that match any of the comma-separated patterns in `text`.

    Raises ValueError for a pattern that no name matches. what: kind of the names, for the message.
    """
    found = []
    for pattern in filter(None, text.split(",")):
        fitting = [name for name in known if fnmatchcase(name, pattern)]
        if not fitting:
            raise ValueError(f"no {what} is named {pattern}; there are {', '.join(known)}")
        found += fitting
    return [name for name in known if name in found]


def read_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="python -m tests.bench stability", description="What stands, how deep it overlaps."
    )
    parser.add_argument("--rows", default="*", metavar="NAME,…", help="only these; * stands for anything")
    parser.add_argument("--engines", default="*", metavar="NAME,…", help="only these")
    parser.add_argument("--quick", action="store_true", help="one seed instead of five")
    parser.add_argument("--list", action="store_true", help="name the rows and their limits, play none")
    parser.add_argument(
        "--json", nargs="?", const="-", metavar="FILE", help="the figures as JSON, printed or in a file"
    )
    return parser.parse_args(arguments)


def main(arguments=None):
    """Run the study. Returns 0 whatever the figures, 2 for an unknown name or a file that cannot be written."""
    options = read_arguments(arguments)
    known = table()
    try:
        chosen = [known[name] for name in chosen_names(options.rows, list(known), "row")]
        names = chosen_names(options.engines, list(engines()), "engine here")
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        return 2
    if options.list:
        for row in chosen:
            print(f"{row.name.ljust(NAME)}  {limit_of(row).ljust(LIMIT)}  {row.source}")
        return 0
    with contextlib.redirect_stdout(sys.stderr) if options.json == "-" else contextlib.nullcontext():
        found = study(chosen, names, 1 if options.quick else None)
    if options.json == "-":
        sys.stdout.write(to_text(found, options.quick))
    elif options.json:
        try:
            with open(options.json, "w", encoding="utf-8") as file:
                file.write(to_text(found, options.quick))
        except OSError as error:
            sys.stderr.write(f"{error}\n")
            return 2
    return 0
