"""`python -m game.report.worker`: does jobs of a report, one after the other.

A line of JSON on standard input is a job; a line on standard output is what it found. The process ends with its input.
"""

import json
import sys

from game import startup
from game.report.job import run_job


def main() -> None:
    """Do jobs for as long as there is somebody to give them."""
    startup.prepare_environment()
    told, sys.stdout = sys.stdout, sys.stderr  # what a job prints is nobody's result
    for line in sys.stdin:
        order = json.loads(line)
        told.write(json.dumps(run_job(order["name"], order["work"], order["params"])) + "\n")
        told.flush()


if __name__ == "__main__":
    main()
