"""Simulation of a scene that stores the poses after every step, until the scene ends or a body falls."""

from dataclasses import dataclass

import numpy as np

from tests.stability.study.scene import STEP, Scene


@dataclass(frozen=True)
class Run:
    """Recorded states of a run: row 0 is the start, row k the state after k steps."""

    scene: Scene
    poses: np.ndarray  # (steps + 1, bodies, 6): x, y, angle, vx, vy, spin
    awake: np.ndarray  # (steps + 1, bodies)
    times: np.ndarray  # (steps,) [s]
    fell: float | None  # [s]

    @property
    def moving(self):
        """Return the poses of the dynamic bodies, an array (steps + 1, dynamic bodies, 6)."""
        return self.poses[:, self.scene.dynamic]


class Watch:
    """A check of whether any dynamic body of a scene has fallen.

    start: poses at the start (bodies, 6), with which later poses are compared.
    """

    def __init__(self, scene, start):
        self.fall, self.rows, self.start = scene.fall, scene.dynamic, start[scene.dynamic]
        if self.fall is not None:
            least = np.array([scene.solids[k].least for k in self.rows])
            self.shift = np.maximum(self.fall.share * least, self.fall.shift)

    def sees_fall(self, now):
        if self.fall is None:
            return False
        moved = np.abs(now[self.rows] - self.start)
        return bool(((moved[:, 0] > self.shift) | (moved[:, 2] > self.fall.turn)).any())


def record(engine, scene, steps=None):
    """Simulate a scene in an engine made for it, for at most `steps` steps (None: the whole
    scene), and return the Run.
    """
    poses, awake, times, fell = [engine.poses()], [engine.awake()], [], None
    watch = Watch(scene, poses[0])
    for step in range(scene.steps if steps is None else min(steps, scene.steps)):
        for when, index in scene.removals:
            if when == step:
                engine.remove(index)
        times.append(engine.step())
        poses.append(engine.poses())
        awake.append(engine.awake())
        if watch.sees_fall(poses[-1]):
            fell = (step + 1) * STEP
            break
    return Run(scene, np.array(poses), np.array(awake), np.array(times), fell)
