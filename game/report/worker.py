"""`python -m game.report.worker`: worker process that runs jobs of a report, one after another.

Each line of standard input is a job as JSON. For each job, one line with its result is written to standard output. The
process ends when its standard input closes.
"""

import json
import sys

from game import startup
from game.report.job import run_job


def main() -> None:
    """Run jobs from standard input until it closes."""
    startup.prepare_environment()
    results, sys.stdout = sys.stdout, sys.stderr  # prints of a job must not mix with the results
    for line in sys.stdin:
        order = json.loads(line)
        results.write(json.dumps(run_job(order["name"], order["work"], order["params"])) + "\n")
        results.flush()


if __name__ == "__main__":
    main()
