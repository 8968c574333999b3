"""Jobs for tests of the report, which do the work of real jobs in milliseconds."""

import os
import time
from pathlib import Path

from game.measure.timing import timed_in_turns
from game.report.job import spread
from physics import Circle, Effects, World


def fall(bodies: int):
    """Return a row with a digest that is equal in every process, and with a time that differs in each."""
    world = World(Effects(gravity=True))
    world.add_bodies(Circle(4.0), [(20.0 * k, 0.0) for k in range(bodies)])
    world.step()
    cost = timed_in_turns({"step": world.step}, {"step": 1})["step"]
    return [{"series": "fall", "label": str(bodies), "digest": world.digest(), "n": bodies, "cost": spread(cost)}]


def fail():
    """Raise an error, as a job that cannot measure does."""
    raise ValueError("nothing can be measured here")


def die(path: str, times: int):
    """End the process abruptly in the first `times` calls, as a crash does; then return a row.
    path: folder for marks.
    """
    marks = Path(path)
    count = len(list(marks.iterdir()))
    if count < times:
        (marks / str(count)).touch()
        os._exit(9)
    return [{"series": "s", "label": "came through", "n": count}]


def wait(path: str):
    """Create a file that shows that the job ran, and wait 0.05 s."""
    Path(path).touch()
    time.sleep(0.05)
    return [{"series": "s", "label": path, "n": 1}]
