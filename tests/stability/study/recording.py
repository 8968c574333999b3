"""A scene played and kept: its poses after every step, until it ends or something falls."""

from dataclasses import dataclass

import numpy as np

from tests.stability.study.scene import STEP, Scene


@dataclass(frozen=True)
class Run:
    """What became of a scene. Row 0 is its start, row k what it was after k steps."""

    scene: Scene
    poses: np.ndarray  # (steps + 1, bodies, 6): x, y, angle, vx, vy, spin
    awake: np.ndarray  # (steps + 1, bodies)
    times: np.ndarray  # (steps,) [s]
    fell: float | None  # [s]

    @property
    def moving(self):
        """Poses of the dynamic bodies."""
        return self.poses[:, self.scene.dynamic]


def fallen(scene, start, now):
    """Whether any of the dynamic bodies has fallen; start, now: (bodies, 6)."""
    for k in scene.dynamic:
        shift, turn = abs(now[k, 0] - start[k, 0]), abs(now[k, 2] - start[k, 2])
        if turn > scene.fall.turn or shift > max(scene.fall.share * scene.solids[k].least, scene.fall.shift):
            return True
    return False


def record(engine, scene, steps=None):
    """Play a scene with an engine made for it, at most so many steps (None: all of it)."""
    poses, awake, times, fell = [engine.poses()], [engine.awake()], [], None
    for step in range(scene.steps if steps is None else min(steps, scene.steps)):
        for when, index in scene.removals:
            if when == step:
                engine.remove(index)
        times.append(engine.step())
        poses.append(engine.poses())
        awake.append(engine.awake())
        if scene.fall is not None and fallen(scene, poses[0], poses[-1]):
            fell = (step + 1) * STEP
            break
    return Run(scene, np.array(poses), np.array(awake), np.array(times), fell)
