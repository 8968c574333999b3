"""Runner of a program's lines, one by one: it checks the world after each line and describes the first failure."""

import linecache
import random
import re
import traceback
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np

import physics
from tests.fuzz.invariants import Broken, Watch
from tests.fuzz.joint_invariants import JointWatch
from tests.fuzz.writing import Writer

PHYSICS = str(Path(physics.__file__).parent)
LINES = 60  # of a program
LOOP = re.compile(r"for _ in range\((\d+)\): (.*)")
TWIN = "twin = "
PROGRAM = "<program>"


class Failure(NamedTuple):
    """Failure of a program: its kind in one line, the line number, and all details."""

    kind: str
    line: int
    story: str


def space_of():
    """Return the namespace in which programs are run: NumPy as np, and the exports of physics."""
    return {"np": np, **{name: getattr(physics, name) for name in physics.__all__}}


def is_documented(error):
    """Return whether an error is a documented one: raised by a raise statement in physics for an invalid argument."""
    if not isinstance(error, (ValueError, TypeError, RuntimeError, KeyError, AttributeError)):
        return False
    last = traceback.extract_tb(error.__traceback__)[-1]
    if not last.filename.startswith(PHYSICS):
        return False
    said = linecache.getline(last.filename, last.lineno).strip()
    return said.startswith("raise ") or said == ")"


class Runner:
    """Runner of a program's lines in a namespace of its own.

    strategy: source text of a broad phase that replaces every one that the lines set; None to keep those of the lines.
    """

    def __init__(self, strategy=None):
        self.space, self.watches, self.strategy = space_of(), [], strategy
        self.lines, self.digests = [], []

    def run(self, line):
        """Run one line with its checks. Returns a Failure, or None if all is correct."""
        self.lines.append(line)
        if self.strategy is not None and line.startswith("world.broadphase ="):
            line = "pass"
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)
                self._run(line)
        except Broken as broken:
            return self._failure(f"invariant: {broken.name}", broken)
        except Exception as error:  # whatever it is, it is what is looked for
            last = traceback.extract_tb(error.__traceback__)[-1]
            if last.filename == PROGRAM:
                return None  # the line itself: what it needs was shrunk away
            place = f"{Path(last.filename).name}:{last.name}"
            return self._failure(f"{type(error).__name__} in {place}", error)
        world = self.space.get("world")
        self.digests.append(world.digest() if world is not None else "")
        return None

    def _failure(self, kind, error):
        story = "".join(traceback.format_exception(error))
        return Failure(kind, len(self.lines) - 1, story)

    def _run(self, line):
        loop = LOOP.fullmatch(line)
        times, line = (int(loop[1]), loop[2]) if loop else (1, line)
        code = compile(line, PROGRAM, "exec")
        for _ in range(times):
            before = [watch.before() for watch in self.watches]
            try:
                exec(code, self.space)
            except Exception as error:
                if not is_documented(error):
                    raise
                for watch, state in zip(self.watches, before, strict=True):
                    watch.unchanged(state, error)
                return
            if not self.watches:
                if "world" not in self.space:
                    return
                world = self.space["world"]
                self.watches = [Watch(world), *([JointWatch(world)] if world.effects.joints else [])]
                if self.strategy is not None:
                    world.broadphase = eval(self.strategy, self.space)
            elif line.startswith("world.step("):
                for watch in self.watches:
                    watch.after_step()
                self._step_twin(line)
            else:
                for watch in self.watches:
                    watch.after_edit(line, self.space)
                self._forget_twin(line)

    def _step_twin(self, line):
        """Step the restored copy of the world, if there is one, and check that it still equals the world."""
        if "twin" in self.space:
            exec(line.replace("world", "twin"), self.space)
            self.watches[0].alike(self.space["twin"])

    def _forget_twin(self, line):
        asks = ("world.ray", "world.shape_cast", "world.overlap", "world.query", "world.closest")
        if line.startswith(TWIN):
            self.space["twin"].restore(self.space["world"].snapshot())
        elif not line.startswith(asks):
            self.space.pop("twin", None)


def run_lines(lines, strategy=None):
    """Run a program. Return (its failure or None, the runner)."""
    runner = Runner(strategy)
    for line in lines:
        failure = runner.run(line)
        if failure:
            return failure, runner
    return None, runner


def failure_of(lines, strategy=None):
    """Return the failure of a program, or None if it passes.

    strategy: another broad phase with which the program is run again; all digests must be equal.
    """
    failure, runner = run_lines(lines)
    if failure or strategy is None:
        return failure
    failure, other = run_lines(lines, strategy)
    if failure:
        return failure
    for line, (one, two) in enumerate(zip(runner.digests, other.digests, strict=True)):
        if one != two:
            return Failure("broad phases differ", line, f"after line {line} the digest is another under {strategy}")
    return None


def write_program(seed, lines=LINES, effect=None):
    """Write a random program, and run each line as it is written. Return (lines, failure or None, strategy).

    effect: name of an effect that its world has; None: any effects.
    A program without a failure is run again with another broad phase. strategy: source text of this broad phase, None
    if the program failed before.
    """
    rng = random.Random(seed)
    writer, runner = Writer(rng, effect), Runner()
    failure = runner.run(writer.first())
    while failure is None and len(runner.lines) < lines:
        failure = runner.run(writer.next(runner.space))
    strategy = rng.choice(("BruteForce()", "SweepAndPrune()", "SpatialHashGrid()", "DynamicTree()"))
    if failure is None:
        failure = failure_of(runner.lines, strategy)
    else:
        strategy = None
    return runner.lines, failure, strategy


def script_of(lines, strategy=None):
    """Return the text of a program that can be pasted into a test."""
    text, alike = ["import numpy as np", "from physics import *", ""], False
    for line in lines:
        text.append(line)
        if line.startswith(TWIN):
            alike = True
            text.append("twin.restore(world.snapshot())")
        elif alike and "world.step(" in line:
            loop = LOOP.fullmatch(line)
            step = loop[2] if loop else line
            text[-1] = f"for _ in range({loop[1] if loop else 1}): {step}; {step.replace('world', 'twin')}"
            text.append("assert world.digest() == twin.digest()")
    if strategy is not None:
        text.append(f"# the digest is another one with world.broadphase = {strategy} after the first line")
    return "\n".join(text)
