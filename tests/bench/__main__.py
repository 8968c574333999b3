"""Command that runs the benchmarks and prints tables. Compare ratios of one run; absolute times depend on the machine.

python -m tests.bench masks                                one benchmark: masks, broadphase, solvers or moving
python -m tests.bench                                      all four, one after the other
python -m tests.bench --json docs/bench/0.1.0.json         the ratios as JSON, in a file (- or nothing: printed)
python -m tests.bench --compare docs/bench/0.1.0.json      each ratio beside the stored one, changes over 5 % marked
python -m tests.bench stability                            which piles stand, how deep they overlap: see stability.py
"""

import argparse
import contextlib
import importlib
import os
import sys

from tests.bench.record import compared, read_record, to_record, to_text
from tests.bench.timing import table

NAMES = ("masks", "broadphase", "solvers", "moving")


def read_arguments(arguments):
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description="Measure; ratios within one run.")
    parser.add_argument("name", nargs="?", choices=NAMES, help="only this one")
    parser.add_argument("--quick", action="store_true", help="smaller and fewer")
    parser.add_argument("--json", nargs="?", const="-", metavar="FILE", help="the ratios as JSON, printed or in a file")
    parser.add_argument("--compare", metavar="FILE", help="show each ratio beside those of a kept file")
    return parser.parse_args(arguments)


def measured(names, quick):
    """Run the benchmarks, which print their tables. Return {benchmark: its ratios}.

    Raises ModuleNotFoundError if a peer such as pymunk is not installed.
    """
    return {name: importlib.import_module(f"tests.bench.{name}").run(quick=quick) for name in names}


def main(arguments=None):
    """Run the benchmarks. Returns 0 whatever the speed, 2 for a file that cannot be used."""
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
    os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["stability"]:  # no ratios of times: rows, engines and a record of its own
        return importlib.import_module("tests.bench.stability").main(arguments[1:])
    options = read_arguments(arguments)
    try:
        kept = read_record(options.compare) if options.compare else None
    except (OSError, ValueError) as error:
        sys.stderr.write(f"{error}\n")
        return 2
    names = [options.name] if options.name else NAMES
    # Where JSON is printed, it is the only thing there; the tables go by on the other stream.
    with contextlib.redirect_stdout(sys.stderr) if options.json == "-" else contextlib.nullcontext():
        try:
            record = to_record(measured(names, options.quick), options.quick)
        except ModuleNotFoundError as error:
            sys.stderr.write(f'{error}; what is measured beside us comes with: pip install -e ".[bench]"\n')
            return 2
        if kept:
            rows = [row for row in compared(kept, record) if row[0].partition(":")[0] in names]
            table(f"Ours over the peer, version {kept['version']} and now", ("ratio", "kept", "now", "change"), rows)
            if kept["quick"] != options.quick:
                print("One of the two is of a --quick run: other sizes, so the ratios differ.")
    if options.json == "-":
        sys.stdout.write(to_text(record))
    elif options.json:
        try:
            with open(options.json, "w", encoding="utf-8") as file:
                file.write(to_text(record))
        except OSError as error:
            sys.stderr.write(f"{error}\n")
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
