"""The result of a sweep depends only on its pair, not on earlier contents of the workspace.

A restored or copied world has another workspace and must continue to the same bit.
"""

import numpy as np
import pytest

from physics.ccd.rotational import Mover, new_rotational_workspace, sweep_hull
from physics.jit import JIT, kernel

SLACK = 0.16  # [px]


@kernel
def sweep(count, other_count, half, slack, workspace):
    """Return the sweep result of two hulls without rounding whose corners are in the workspace.

    count, other_count: numbers of corners.
    """
    return sweep_hull(Mover(count, 0.0, half, slack, False), 0.0, other_count, 0.0, workspace)


def hull(rng, count):
    turns = np.sort(rng.uniform(0, 2 * np.pi, count))
    return np.stack([10 * np.cos(turns), 7 * np.sin(turns)], axis=1)


@pytest.mark.parametrize("half", [0.0, 4.0])
def test_a_used_workspace_finds_what_a_new_one_finds(half):
    rng = np.random.default_rng(3)
    for _ in range(300 if JIT else 100):
        count, other_count = (int(n) for n in rng.integers(3, 17, 2))
        mover, other = hull(rng, count), hull(rng, other_count)
        motion = np.array([0, 0, rng.uniform(-3, 3), *rng.uniform(-30, 30, 2), rng.uniform(-3, 3)])
        still = np.array([*rng.uniform(-25, 25, 2), rng.uniform(-3, 3), 0, 0, 0])
        found = []
        for used in (False, True, True):
            workspace = new_rotational_workspace()
            if used:
                for array in (workspace.advance.gap.gap, workspace.advance.gap.simplex, workspace.advance.a):
                    array[:] = rng.uniform(0, 15, array.shape)
            workspace.mover[:count], workspace.advance.local_b[:other_count] = mover, other
            workspace.advance.motion_a[:], workspace.advance.motion_b[:] = motion, still
            fraction, nx, ny = sweep(count, other_count, half, SLACK, workspace)
            gap = workspace.advance.gap.gap.tobytes() if fraction <= 1.0 else b""
            found.append((fraction, nx, ny, gap, workspace.advance.totals.tobytes()))
        assert found[0] == found[1] == found[2]
