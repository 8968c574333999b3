"""A corner of a mask's outline shared by several parts has a contact; before the fix it had none.

The contact was taken from the first part and dropped, because both edges of that part were covered at the corner. A
body on the corner had no contact. A fast one was stopped by the sweep in every step, while gravity increased its speed
without limit.
"""

import math

import numpy as np
import pytest

from physics import Effects, PixelMask, Polygon, World
from physics.shapes.outline import outline_of

EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)
SPRITE = (
    "........######..",
    "...############.",
    "..#############.",
    ".##############.",
    ".##############.",
    "..############..",
    "..############..",
    "....#########...",
    ".....#######....",
    ".....#######....",
    "......#####.....",
    "......#####.....",
    "........#.......",
)
GAP = 0.05  # [px] between the corner and the floor


def outermost(mask):
    """Yield (x, y, direction [rad]) of each corner of the convex hull of a mask's outline.

    direction: the mean outward direction of the corner's two edges.
    """
    points = sorted({tuple(point) for part in outline_of(mask) for point in part.shape.points})
    hull = []
    for row in (points, points[::-1]):
        chain = []
        for x, y in row:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1]) <= (
                chain[-1][1] - chain[-2][1]
            ) * (x - chain[-2][0]):
                chain.pop()
            chain.append((x, y))
        hull += chain[:-1]
    for (ax, ay), (x, y), (bx, by) in zip(hull[-1:] + hull[:-1], hull, hull[1:] + hull[:1], strict=True):
        into, out = math.atan2(y - ay, x - ax), math.atan2(by - y, bx - x)
        yield x, y, into + 0.5 * ((out - into) % math.tau) - 0.5 * math.pi


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("flipped", [False, True])
def test_every_corner_that_sticks_out_stands_on_a_floor(turns, flipped):
    solid = np.rot90(np.array([[dot == "#" for dot in row] for row in SPRITE]), turns)
    mask = PixelMask(solid[:, ::-1] if flipped else solid)
    missed = []
    for x, y, facing in outermost(mask):
        world = World(EFFECTS, gravity=(0, 0))
        world.add_body(Polygon.box(400, 40), position=(0.0, 20.0), kind="static")
        angle = 0.5 * math.pi - facing  # it faces down
        low = x * math.sin(angle) + y * math.cos(angle)
        world.add_body(mask, position=(0.0, -low - GAP), angle=angle)
        world.step()
        found = world.contact_rows
        if not any((abs(found[name] - GAP) < 1e-6).any() for name in ("separation_1", "separation_2")):
            missed.append((x, y))
    assert not missed
