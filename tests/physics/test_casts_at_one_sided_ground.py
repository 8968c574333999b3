"""Casts and times of impact at chains and one-way masks: from their front only, for shapes of every kind."""

import itertools

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
