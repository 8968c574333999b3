"""A heap takes no more substeps than its loads need.

The tumbler once took 128 in every step, which cost 3.6 times as much time as four substeps. Extra substeps are only for
columns, in which every body has one body below and one above.
"""

from scenes.lab.tumbler import Tumbler
from tests.stability.piles import needs_speed


@needs_speed
def test_a_drum_of_shapes_takes_32_substeps_at_most():
    """A drum of shapes takes at most 32 substeps once the shapes form a heap.

    Two or three bodies beside the heap may count as a column, at a low cost.
    """
    scene = Tumbler(0)
    world = scene.world
    world.substeps = "auto"
    for _ in range(150):
        world.step()
    for _ in range(150):
        world.step()
        assert (world.bodies["substeps"] > 32).sum() <= 6
