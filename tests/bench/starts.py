"""`python -m tests.bench.starts [SCENE ...] [--first] [--seconds 10] [--runs 5]`: time from the start of the program to
play.

It runs the whole program in a process of its own, as a user starts it, under the dummy driver or on the display
(--display). Without a scene the title is measured. Games are played by their bots; labs get no input. --first starts
each run with an empty cache.

It prints medians over the runs: seconds from the start of the process to the first picture, and steps and pictures in
each of the first seconds. It also prints milliseconds of a frame (p50, p99, longest) without the wait for the next.
Further figures are the number of kernels compiled in the program itself, and seconds until all called kernels run
compiled.
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CHILD = """
import json, os, sys, time
started = float(sys.argv[1])
seconds = float(sys.argv[2])
import main
from game import startup
startup.prepare_environment()
from game import app as module
turn, rest = module.App.turn, module.App._rest
frames, ready, worked = [], [], []

def noted_rest(self, began):
    worked.append(time.perf_counter() - began)
    rest(self, began)

def noted_turn(self):
    before = time.time()
    steps = self.screens.played.session.report.steps if self.screens.played else 0
    turn(self)
    now = time.time()
    frames.append((now - started, steps))
    if self.beside is not None and self.beside.share >= 1.0:
        ready.append(now - started)
    else:
        ready.clear()
    if now - started > seconds + frames[0][0]:
        self.arcade.running = False

module.App.turn, module.App._rest = noted_turn, noted_rest
code = main.main(sys.argv[3:])
from physics.jit import kernels as totals
print(json.dumps({"frames": frames, "worked": worked, "ready": ready[:1], "compiled": totals.compiled,
                  "loaded": totals.loaded}))
"""


def start(arguments, seconds, cache, display):
    """Run the program once and return its measurements of itself, a dict.

    arguments: of the command line; seconds: duration of play; cache: folder of compiled kernels; display: False for the
    dummy driver.
    """
    environment = {**os.environ, "HITBOX_CACHE_DIR": cache, "PYTHONPATH": str(ROOT)}
    with tempfile.TemporaryDirectory() as data:
        environment["HITBOX_DATA"] = data
        if not display:
            environment |= {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}
        run = subprocess.run(
            [sys.executable, "-c", CHILD, str(time.time()), str(seconds), *arguments],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
    return json.loads(run.stdout.strip().splitlines()[-1])


def figures(found, seconds):
    """Return the figures {name: value} of one run. found: result of `start`."""
    times = [at for at, _ in found["frames"]]
    steps, pictures = [0] * int(seconds), [0] * int(seconds)
    for (at, before), (_, after) in zip(found["frames"], found["frames"][1:], strict=False):
        second = int(at - times[0])
        if second < len(steps):
            steps[second] += after - before
            pictures[second] += 1
    worked = sorted(1e3 * each for each in found["worked"][1:])
    return {
        "first picture [s]": times[0],
        "steps a second": steps,
        "pictures a second": pictures,
        "frame p50 [ms]": worked[len(worked) // 2],
        "frame p99 [ms]": worked[int(0.99 * len(worked))],
        "longest [ms]": worked[-1],
        "compiled here": found["compiled"],
        "loaded": found["loaded"],
        "all compiled [s]": found["ready"][0] if found["ready"] else None,
    }


def main() -> None:
    """Measure the scenes of the command line, and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=[""], metavar="SCENE")
    parser.add_argument("--first", action="store_true")
    parser.add_argument("--display", action="store_true")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    for scene in options.scenes:
        runs = []
        for _ in range(options.runs):
            with tempfile.TemporaryDirectory() as empty:
                cache = empty if options.first else os.environ.get("HITBOX_CACHE_DIR", "")
                arguments = ["--scene", scene, *([] if scene.startswith("lab/") else ["--bot"])] if scene else []
                runs.append(figures(start(arguments, options.seconds, cache, options.display), options.seconds))
                shutil.rmtree(empty, ignore_errors=True)
                os.makedirs(empty, exist_ok=True)
        told = []
        for name in runs[0]:
            values = [run[name] for run in runs]
            if isinstance(values[0], list):
                told.append(f"{name} {[statistics.median(column) for column in zip(*values, strict=True)]}")
            else:
                known = [each for each in values if each is not None]
                told.append(f"{name} {statistics.median(known):.4g}" if known else f"{name} -")
        print(f"{scene or 'title':<18} {'first' if options.first else 'warm'}: {'  '.join(told)}", flush=True)


if __name__ == "__main__":
    main()
