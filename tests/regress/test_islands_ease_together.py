"""An island takes fewer substeps when its bodies need fewer; before the fix three crates kept 32 for ever.

The crates were dropped by 5 cm. The cooldowns of the bodies ended at different times, and a request by one body alone
was dropped.
"""

from physics import Polygon
from tests.stability.piles import floor, metres


def test_three_crates_dropped_one_by_one_soon_take_few_substeps():
    world = metres(substeps="auto")
    floor(world)
    for k in range(3):
        world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 - 1.05 * k))
    most = 0
    for _ in range(90):
        world.step()
        most = max(most, int(world.bodies["substeps"].max()))
    crates = world.bodies["kind"] == 2
    assert most == 32 and world.bodies["substeps"][crates].max() <= 8
