"""In a heap something leans all the time: the tumbler took 128 substeps in every step, 3.6 times as long as with four.

More substeps than the loads need are for columns, whose bodies have one body below and one above.
"""

from scenes.lab.tumbler import Tumbler
from tests.stability.piles import needs_speed


@needs_speed
def test_a_drum_of_shapes_takes_32_substeps_at_most():
    """Once it is a heap: two or three that fell aside are a column, and cost little."""
    scene = Tumbler(0)
    world = scene.world
    world.substeps = "auto"
    for _ in range(150):
        world.step()
    for _ in range(150):
        world.step()
        assert (world.bodies["substeps"] > 32).sum() <= 6
