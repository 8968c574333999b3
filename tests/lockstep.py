"""Comparison of variants of one scene that are stepped side by side, by their digests after every frame.

No variant may change the result. The variants are the scene itself, drawn, under each broad phase, with the broad phase
switched during the run, and without compiled kernels. If one differs, the first frame that differs is reported, with
the part of the scene.

The regular tests use one run that compares all broad phases in each step (tests/all_broadphases.py). The runs under
each broad phase are nightly tests.

`python -m tests.lockstep NAME FRAMES` plays a scene by its bot and prints its digests, one a line. It is used to run a
process without compiled kernels, and to compare two versions of the sources (with `diff`).
"""

import argparse
import os
import subprocess
import sys
from itertools import cycle
from pathlib import Path

from game.input.inputs import InputFrame
from game.overlays.stack import Overlays, layer_names
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.headless import start_dummy_display
from game.run.outcome import judge
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from physics import BROADPHASES
from scenes import SCENES
from tests.all_broadphases import scene_asking_all

ROOT = Path(__file__).resolve().parent.parent
FEW = 100  # bodies of a world without compiled kernels, where its scene lets one choose
DRAWN_EVERY = 7  # frames; drawing everything costs ten steps, and every kind of frame has its turn
SWITCHES = {
    frame: (("broadphase", name),) for frame, name in zip(range(10, 4000, 20), cycle(BROADPHASES), strict=False)
}


class Diverged(AssertionError):
    """Error: two runs that should be equal differ; the message names the run, the first frame and the part."""


def make_scene(name, few=False, seed=1, asks_all=False, **chosen):
    """Return a scene of the game.

    few: True for few bodies, if the scene has a slider for them. asks_all: True for worlds that compare all broad
    phases. chosen: further arguments of the scene.
    """
    scene_class = Registry(SCENES).scene_class(name)
    scene = (scene_asking_all(scene_class) if asks_all else scene_class)(seed, **chosen)
    if few and "bodies" in scene.values:
        scene.change("slider:bodies", FEW)
    return scene


class Run:
    """A scene played by a source of input, by default its bot."""

    def __init__(self, label, scene, source=None, recorder=None, replay=None):
        self.label, self.scene = label, scene
        self.session = Session(scene, source or BotSource(), recorder, replay)

    def step(self):
        """Make one step and return the digest."""
        self.session.step()
        return scene_digest(self.scene)


class DrawnRun(Run):
    """A run that is drawn with every overlay, every DRAWN_EVERY frames."""

    def __init__(self, label, scene, source=None, replay=None):
        super().__init__(label, scene, source, replay=replay)
        self.picture, self.overlays = Picture(), Overlays(layer_names())

    def step(self):
        """Make one step, draw the scene every DRAWN_EVERY frames, and return the digest."""
        self.session.step()
        self.overlays.note(self.scene)
        if self.scene.frame % DRAWN_EVERY == 0:
            self.picture.draw_scene(self.scene, self.overlays)
        return scene_digest(self.scene)


class Changing:
    """Source of input that adds changes of settings to another source, by default the scene's bot.

    changes: {frame (from 0): ((name, value), ...)}.
    """

    def __init__(self, changes, source=None):
        self.changes, self.source = changes, source or BotSource()

    def next(self, scene):
        """Return the input of the next step."""
        frame = self.source.next(scene)
        more = self.changes.get(scene.frame, ())
        return InputFrame(frame.actions, frame.pointer, frame.pointer_down, frame.wheel, (*frame.changes, *more))


class PlainRun:
    """Scenes with few bodies, played one after another in a process without compiled kernels. close() ends the process.

    The process runs ahead of the reader until the pipe is full.
    """

    scene = None

    def __init__(self, label, names, frames):
        self.label = label
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.lockstep", *names, str(frames), "--few"],
            cwd=ROOT,
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def step(self):
        """Return the next digest that the process prints. Raises RuntimeError with its last output if it has ended."""
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.label} ended early: {self.process.stderr.read()}")
        return line.strip()

    def close(self):
        """Kill the process, whether it has finished or not."""
        self.process.kill()
        self.process.communicate()


def ways_to_run(name, recorder=None, few=False, seed=1):
    """Yield a run for each condition that must not change the result; the first is the reference for the others.

    recorder: function that makes the recorder of the first run from its scene, or None. One of the runs uses the
    scene's own broad phase, so it repeats the first one.
    """
    first = make_scene(name, few, seed)
    yield Run("the scene", first, recorder=recorder and recorder(first))
    yield DrawnRun("drawn with every overlay", make_scene(name, few, seed))
    yield Run("with the broad phase switched mid-game", make_scene(name, few, seed), Changing(SWITCHES))
    for strategy in BROADPHASES:
        yield Run(f"under broad phase {strategy}", make_scene(name, few, seed, broadphase=strategy))


def lockstep(runs, frames):
    """Step all runs. Raises Diverged at the first frame after which a run differs from the first run."""
    first, *others = runs
    for frame in range(1, frames + 1):
        wanted = first.step()
        for run in others:
            found = run.step()
            if found != wanted:
                raise Diverged(
                    f"{run.label} differs from {first.label} since frame {frame}{place_of(first.scene, run.scene)}: "
                    f"digest {found}, not {wanted}"
                )


def first_difference(one, other, frames):
    """Return the first frame after which two runs differ; None if they are equal in all frames."""
    return next((frame for frame in range(1, frames + 1) if one.step() != other.step()), None)


def place_of(scene, other):
    """Return a text with the parts whose digests differ, such as " in world 0, the scene's state".

    The text is "" if one of the scenes is None, because it runs in another process.
    """
    if scene is None or other is None:
        return ""
    places = [
        f"world {number}"
        for number, (one, two) in enumerate(zip(scene.worlds, other.worlds, strict=False))
        if one.digest() != two.digest()
    ]
    places += ["the number of worlds"] * (len(scene.worlds) != len(other.worlds))
    places += ["the scene's state"] * (repr(scene.state()) != repr(other.state()))
    places += ["its random numbers"] * (scene.random.getstate() != other.random.getstate())
    return " in " + ", ".join(places)


def failures_of(run, frames):
    """Return the failures of a run in this process: goals that are due but not met, and failures of --strict."""
    return judge(run.scene, frames, run.session.report.strict_failures())["failures"]


def main():
    """Print the digests of scenes, one a line, as chosen on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", choices=SCENES, nargs="+", metavar="NAME")
    parser.add_argument("frames", type=int, metavar="FRAMES")
    parser.add_argument("--few", action="store_true", help="with few bodies, where the scene lets one choose")
    options = parser.parse_args()
    start_dummy_display()
    for name in options.names:
        run = Run(name, make_scene(name, options.few))
        for _ in range(options.frames):
            print(run.step(), flush=True)


if __name__ == "__main__":
    main()
