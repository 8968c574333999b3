"""Crates that rest in the platformer's level at the start sleep after one step; those in the air fall."""

import numpy as np
import pytest

from scenes.platformer.scene import Platformer
from tests.lockstep import Run

SECOND = 60  # steps


def after(steps, seed=1, lift=0.0, only=None):
    """Lift some bodies of the level by `lift` [px], and play it for some steps.

    Returns (ids of the dynamic bodies, (n, 2) positions [px] before and after the steps, (n,) whether awake). only: ids
    of the bodies to lift, None for all.
    """
    scene = Platformer(seed=seed)
    bodies = scene.world.bodies
    rows = np.flatnonzero(bodies["inverse_mass"] > 0.0)
    ids = bodies["id"][rows].copy()
    lifted = rows if only is None else rows[np.isin(ids, only)]
    for name in ("y", "center_y"):
        bodies[name][lifted] -= lift
    first = places(bodies[rows])
    run = Run("", scene)
    for _ in range(steps):
        run.step()
    bodies = scene.world.bodies[scene.world.rows(ids.tolist())]
    return ids, first, places(bodies), bodies["awake"].copy()


def places(bodies):
    return np.column_stack([bodies["x"], bodies["y"]])


def lying(seed):
    """Return the ids of the bodies that have not moved after a second; the others are on lifts and belts."""
    ids, first, then, _ = after(SECOND, seed)
    return ids[np.hypot(*(then - first).T) < 0.5]


@pytest.mark.parametrize("seed", range(3))
def test_what_lies_there_sleeps_after_one_step_where_it_lay(seed):
    still = lying(seed)
    ids, first, then, awake = after(1, seed)
    those = np.isin(ids, still)
    assert len(still) >= 4 and not awake[those].any()
    assert np.abs(then - first)[those].max() < 0.1


@pytest.mark.parametrize("gap", [0.1, 0.3, 1.0, 3.0, 16.0])
def test_what_hangs_over_the_ground_falls(gap):
    still = lying(1)
    ids, first, then, _ = after(SECOND, 1, gap, still)
    those = np.isin(ids, still)
    assert np.abs((then - first)[those, 1] - gap).max() < max(0.02, 0.1 * gap)  # a pile of two lands askew
