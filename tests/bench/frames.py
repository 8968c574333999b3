"""`python -m tests.bench.frames [SCENE …] [--scale 2] [--seconds 20]`: time of a frame with and without the plot of
costs.

The whole program runs under the dummy driver, with one step per frame and 60 frames a second. A bot plays the scene. In
the second run the plot is opened after the first second, and its measuring process runs, too. Two times of each frame
are printed [ms]: the time on the clock without the wait for the next frame, and the processor time of the thread. If
other programs run, only the second one is reliable.
"""

import argparse
import os
import tempfile
from time import perf_counter, sleep, thread_time
from unittest.mock import patch

import numpy as np
import pygame

from game.app import App
from game.command_line import read_options
from game.drawing.window import open_window
from game.files.settings import Settings
from game.registry import Registry
from game.run.headless import start_dummy_display
from scenes import SCENES

FIRST = 60  # frames before the plot opens, of which nothing is told
STEP = 1 / 60  # [s]


def frames_of(name: str, scale: int, seconds: float, opens: bool) -> np.ndarray:
    """Return (n, 2) milliseconds of each frame: time on the clock, and processor time of the program's own thread.

    opens: True opens the plot of costs after the first second.
    """
    registry, settings = Registry(SCENES), Settings(window_scale=scale, labs_seen=list(SCENES))
    app = App(read_options(["--scene", name, "--bot"], registry), registry, settings, open_window(settings))
    app._rest = lambda started: None  # the wait for the next frame is ours
    rows, due, now = [], perf_counter(), 100.0
    for number in range(FIRST + round(seconds / STEP)):
        if number == FIRST and opens:
            pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_m, mod=0, unicode="m"))
        now += STEP
        started, worked = perf_counter(), thread_time()
        with patch("game.app.perf_counter", lambda now=now: now):  # a late frame has no more steps to make than others
            app.turn()
        rows.append((1e3 * (perf_counter() - started), 1e3 * (thread_time() - worked)))
        due = max(due + STEP, perf_counter())
        sleep(max(0.0, due - perf_counter()))
    play = app.screens.played
    assert play is not None and play.costs_open == opens
    dots = len(play.measuring.surveyor.survey.dots)
    if opens:
        print(f"  {dots} settings measured meanwhile, {play.measuring.surveyor.survey.moments} moments")
    app.screens.quit()
    return np.array(rows[FIRST:])


def main() -> None:
    """Measure the scenes of the command line, and print two lines for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=["shooter", "platformer"], metavar="SCENE")
    parser.add_argument("--scale", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["HITBOX_DATA"] = folder
        start_dummy_display()
        for name in options.scenes:
            for opens in (False, True):
                found = frames_of(name, options.scale, options.seconds, opens)
                for what, column in zip(("clock", "worked"), found.T, strict=True):
                    p50, p99 = np.quantile(column, (0.5, 0.99))
                    over = int((column > 16.0).sum())
                    told = (
                        f"p50 {p50:5.1f}  p99 {p99:5.1f}  max {column.max():5.1f} ms, {over} of {len(column)} over 16"
                    )
                    print(f"{name:<12} plot {'open' if opens else 'shut'}  {what:<6}  {told}", flush=True)


if __name__ == "__main__":
    main()
