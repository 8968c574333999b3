"""`python -m tests.bench NAME`: measure, print a table. Ratios within one run; absolute times are this machine's today."""

import argparse
import importlib
import os
import sys

NAMES = ("masks", "broadphase", "solvers")


def main(arguments=None):
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
    os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("name", choices=NAMES)
    parser.add_argument("--quick", action="store_true", help="smaller and fewer")
    options = parser.parse_args(arguments)
    importlib.import_module(f"tests.bench.{options.name}").run(quick=options.quick)
    return 0


if __name__ == "__main__":
    sys.exit(main())
