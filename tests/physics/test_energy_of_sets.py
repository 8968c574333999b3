"""The limit on the energy of a set of bodies visits all contacts only if the set gained energy.

Otherwise a shorter computation must give the same velocities and the same energy reserves.
"""

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, World
from physics.solver import soft_step

EFFECTS = Effects.rigid_bodies().with_(sleeping=False)
LONG = ("vx", "vy", "angular_velocity")


def collapse(seed, substeps):
    """Return a world with a heap of boxes and discs that falls onto a floor, and some discs that meet in the air."""
    world, rng = World(EFFECTS, substeps=substeps), np.random.default_rng(seed)
    world.add_body(Polygon.box(500, 20), position=(0, 200), kind="static")
    for k in range(50):
        shape = Polygon.box(20, 20) if rng.random() < 0.5 else Circle(10)
        x, y = 23.0 * (k % 10) - 104.0 + rng.uniform(-2, 2), 180.0 - 24.0 * (k // 10)
        world.add_body(shape, position=(x, y), angle=float(rng.uniform(0, 1)), velocity=tuple(rng.uniform(-40, 40, 2)))
    for k in range(6):  # these meet each other in flight, and nothing else
        world.add_body(Circle(9), position=(600.0 + 15.0 * k, 0.0), velocity=(30.0 * (k % 2), 0.0), gravity_scale=0.0)
    return world


@pytest.mark.parametrize("substeps", [1, 4, 16, "auto"])
@pytest.mark.parametrize("seed", range(5))
def test_both_ways_leave_the_same_velocities_and_reserves(monkeypatch, seed, substeps):
    limit, calls = soft_step.limit_energy, []

    def both(blocks, count, group, links, moving, context, plan, balance, motions):
        """Run the full computation on copies, then the one under test, and compare the results.

        The full one is the one that is used beside moving kinematic bodies.
        """
        assert moving == 0
        full = balance.copy(), motions.copy()
        limit(blocks, count, group, links, 1, context, plan, *full)
        rows = group.members
        before = motions[[*LONG]].copy()
        found = limit(blocks, count, group, links, 0, context, plan, balance, motions)
        calls.append(bool((balance["excess"][rows] > 0.0).any()) and found == 0)
        assert np.allclose(balance["reserve"][rows], full[0]["reserve"][rows], rtol=1e-12, atol=0.0)
        for name in LONG:
            scale = 1e-13 * np.abs(before[name]).max(initial=1.0)
            assert np.allclose(motions[name], full[1][name], rtol=1e-12, atol=scale), name
        return found

    monkeypatch.setattr(soft_step, "limit_energy", both)
    world = collapse(seed, substeps)
    for _ in range(120):
        world.step()
    assert sum(calls) > 10  # single bodies gained, and no set did
