"""`python -m game.report.worker`: run jobs of a report, one after the other.

Each line of JSON on standard input is a job; each line on standard output is its result. The process ends with its
input.
"""

import json
import sys

from game import startup
from game.report.job import run_job


def main() -> None:
    """Run jobs until standard input ends."""
    startup.prepare_environment()
    results, sys.stdout = sys.stdout, sys.stderr  # prints of a job must not mix with the results
    for line in sys.stdin:
        order = json.loads(line)
        results.write(json.dumps(run_job(order["name"], order["work"], order["params"])) + "\n")
        results.flush()


if __name__ == "__main__":
    main()
