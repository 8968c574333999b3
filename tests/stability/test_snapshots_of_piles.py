"""A pile restored from a snapshot repeats six hundred steps to the bit, including all state of contacts and islands."""

import numpy as np
import pytest

from physics import JIT, Circle, Material, Polygon, Snapshot
from tests.stability.piles import floor, metres

STEPS = 600 if JIT else 40


def piles(substeps):
    """Return a world with a crooked column, a heavy box on a light one, and a ball that rolls into them."""
    world = metres(substeps=substeps)
    floor(world)
    rng = np.random.default_rng(7)
    for k in range(8):
        world.add_body(Polygon.box(1, 1), position=(rng.uniform(-0.02, 0.02), -0.5 - k))
    world.add_body(Polygon.box(1, 1), position=(6.0, -0.5))
    world.add_body(Polygon.box(1, 1), position=(6.0, -1.5), material=Material(density=1000.0))
    world.add_body(Circle(0.5), position=(-25.0, -0.5), velocity=(5.0, 0.0), material=Material(rolling_resistance=0.0))
    return world


@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("kept", ["memory", "file"])
def test_six_hundred_steps_again_from_a_snapshot_are_the_same_to_the_bit(substeps, kept, tmp_path):
    world = piles(substeps)
    for _ in range(STEPS // 4):
        world.step()
    if substeps == "auto" and JIT:
        assert world.bodies["substeps"].max() == 32
    taken = world.snapshot()
    if kept == "file":
        taken.save(tmp_path / "piles.npz")
        taken = Snapshot.load(tmp_path / "piles.npz")

    def go_on():
        digests = []
        for k in range(STEPS):
            world.step(1e-4 if k % 7 == 0 else None)  # a short step, too, whose forces count by its length
            digests.append(world.digest())
        return digests, world.bodies.tobytes(), world.contacts.tobytes()

    first = go_on()
    world.restore(taken)
    assert go_on() == first
    if JIT:
        ball = world.bodies[-1]
        assert ball["x"] > -3.0, "it has met the column"
