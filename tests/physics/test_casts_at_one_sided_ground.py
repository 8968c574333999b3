"""Casts and times of impact at chains and one-way masks: from their front only, for shapes of every kind.

Two parallel lines are never deep in each other; they must meet all the same.
"""

import itertools
import math

import numpy as np
import pytest

from physics import (
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
    collide,
    time_of_impact,
)

YY, XX = np.mgrid[:20, :20]
L_FORM = ~((YY < 10) & (XX < 10))
MASKS = {
    f"{name}, {'snapped' if snap else 'exact'}": PixelMask(solid, snap=snap)
    for name, solid in (
        ("square", np.ones((20, 20), bool)),
        ("disc", (XX - 9.5) ** 2 + (YY - 9.5) ** 2 < 100.0),
        ("L", L_FORM),
    )
    for snap in (True, False)
}
SHAPES = {
    "circle": Circle(10),
    "box": Polygon.box(20, 20),
    "rounded": Polygon([(-8, -8), (8, -8), (8, 8), (-8, 8)], 2.0),
    "capsule": Capsule((-5, 0), (5, 0), 5),
    "segment": Segment((-5, 0), (5, 0)),
    "upright segment": Segment((0, -5), (0, 5)),
    "box of a mask": Bounds(PixelMask(np.ones((20, 20), bool))),
    **MASKS,
}
TARGETS = {
    "chain": (Chain([(0, 200), (300, 200)]), (0, 0)),
    "chain of four": (Chain([(0, 200), (90, 200), (210, 200), (300, 200)]), (0, 0)),
    "one-way tiles": (TileGrid(np.zeros((1, 20), bool), 16, one_way=np.ones((1, 20), bool)), (0, 200)),
    "one-way mask": (PixelMask(np.ones((8, 300), bool), one_way=True), (150, 204)),
}
CHAINS = {
    "flat": [(0, 200), (300, 200)],
    "ridge": [(0, 200), (150, 180), (300, 200)],
    "valley": [(0, 200), (150, 220), (300, 200)],
    "waves": [(0, 200), (100, 180), (200, 220), (320, 200)],
}


def world_with(target, position):
    world = World(Effects.rigid_bodies().with_(one_way=True))
    world.add_body(target, position=position, kind="static")
    return world


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("shape", SHAPES)
def test_a_cast_hits_one_sided_ground_from_above_only(shape, target):
    world = world_with(*TARGETS[target])
    cast = SHAPES[shape]
    low = cast.bounds[3]
    hit = world.shape_cast(cast, (150, 150), (0, 100))
    assert hit is not None and hit.fraction == pytest.approx((50.0 - low) / 100.0, abs=5e-3)
    assert hit.normal == pytest.approx((0.0, -1.0), abs=1e-6)
    assert world.shape_cast(cast, (150, 250), (0, -100)) is None


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("mask", MASKS)
def test_a_cast_of_a_mask_at_a_chain_is_its_time_of_impact(mask, chain):
    """From above, below and across a chain, a cast hits exactly if its motion has an impact, and at its fraction."""
    shape, target = MASKS[mask], Chain(CHAINS[chain])
    world = world_with(target, (0, 0))
    hits = 0
    for y, angle, x, (dx, dy) in itertools.product(
        (150, 205, 212, 230), (0.0, 0.4, 1.0), (120, 150), ((0, -100), (60, -60), (0, 100))
    ):
        found = world.shape_cast(shape, (x, y, angle), (dx, dy))
        wanted = time_of_impact(shape, (x, y, angle), (x + dx, y + dy, angle), target, (0, 0), (0, 0))
        assert (found is not None) == wanted.hit, (y, angle, x, dx, dy)
        if found is not None and not len(collide(shape, (x, y, angle), target, (0, 0))):
            assert found.fraction == pytest.approx(wanted.fraction, abs=1e-9), (y, angle, x, dx, dy)
            hits += 1
    assert hits > 5


ANGLES = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.3, -1e-9, -0.1)
LINES = {"segment": Segment((-10, 0), (10, 0)), "capsule": Capsule((-10, 0), (10, 0), 1), "polygon": Polygon.box(20, 2)}


@pytest.mark.parametrize("offset", [0.0, 1000.0, 1e5])
@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("line", LINES)
def test_a_line_meets_a_parallel_chain_from_its_front_only(line, angle, offset):
    shape = LINES[line]
    target = Chain([(offset - 200, offset), (offset + 200, offset)])
    half = {"segment": 0.0, "capsule": 1.0, "polygon": math.cos(angle)}[line]
    below = 10.0 * abs(math.sin(angle)) + half
    start, end = (offset, offset - 5, angle), (offset, offset + 5, angle)
    found = time_of_impact(shape, start, end, target, (0, 0), (0, 0))
    assert found.hit
    assert found.fraction == pytest.approx((5.0 - below) / 10.0, abs=1e-8 + 1e-13 * offset)
    assert found.normal == pytest.approx((0.0, 1.0), abs=1e-6)
    assert not time_of_impact(shape, end, start, target, (0, 0), (0, 0)).hit


@pytest.mark.parametrize("turn", [0.0, 0.3, math.pi / 2, 2.0, math.pi])
@pytest.mark.parametrize("way", [1.0, 10.0, 400.0])
def test_a_line_meets_a_turned_chain_and_a_turned_segment(turn, way):
    """A segment that moves along the normal of a parallel line meets it halfway, wherever both point."""
    nx, ny = math.sin(turn), -math.cos(turn)
    shape, line = Segment((-10, 0), (10, 0)), [(-200, 0), (200, 0)]
    start = (0.5 * way * nx, 0.5 * way * ny, turn)
    end = (-0.5 * way * nx, -0.5 * way * ny, turn)
    for target, back in ((Chain(line), False), (Segment(*line), True)):
        found = time_of_impact(shape, start, end, target, (0, 0, turn), (0, 0, turn))
        assert found.hit and found.fraction == pytest.approx(0.5, abs=1e-7)
        assert time_of_impact(shape, end, start, target, (0, 0, turn), (0, 0, turn)).hit == back
