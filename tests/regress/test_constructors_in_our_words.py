"""The error of a constructor for any wrong value names the argument in the project's wording, not in NumPy's or
Python's.
"""

import numpy as np
import pytest

from physics import (
    Body,
    Bounds,
    BruteForce,
    Capsule,
    Chain,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
    fit,
)

ODD = [
    np.arange(6.0),
    np.ones((2, 3), bool),
    np.array(["a", "b"]),
    {"a": 1},
    lambda: 0,
    object,
    "x" * 5000,
    {1, 2},
    b"ab",
]
BALL, MASK = Circle(3), PixelMask(np.ones((2, 2), bool))
CONSTRUCTORS = {
    "radius": [Circle, lambda v: Capsule((0, 0), (1, 0), v), lambda v: Polygon([(0, 0), (4, 0), (0, 4)], v)],
    "center": [lambda v: Circle(1, v)],
    "a": [lambda v: Segment(v, (9, 9)), lambda v: Capsule(v, (9, 9), 1)],
    "points": [Polygon, Chain, lambda v: Chain(v, loop=True)],
    "loop": [lambda v: Chain([(0, 0), (1, 0), (1, 1)], v)],
    "ghosts": [lambda v: Chain([(0, 0), (1, 0)], ghosts=v)],
    "materials": [lambda v: Chain([(0, 0), (1, 0)], materials=v)],
    "tile_size": [lambda v: TileGrid([[True]], v)],
    "slopes": [lambda v: TileGrid([[False]], 8, slopes=v)],
    "origin": [lambda v: PixelMask(np.ones((2, 2), bool), v)],
    "snap": [lambda v: PixelMask(np.ones((2, 2), bool), None, v)],
    "shape": [Bounds, lambda v: World().add_body().add_shape(v)],
    "density": [Material],
    "membership": [Filter],
    "bits": [Filter.from_packed],
    "narrowphase": [Effects],
    "axes": [SweepAndPrune],
    "cell": [SpatialHashGrid],
    "width": [DynamicTree],
    "incremental": [BruteForce],
    "margin": [lambda v: DynamicTree(margin=v)],
    "effects": [World],
    "broadphase": [lambda v: World(broadphase=v)],
    "solver": [lambda v: World(solver=v)],
    "gravity": [lambda v: World(gravity=v)],
    "wind": [lambda v: World(wind=v)],
    "substeps": [lambda v: World(substeps=v)],
    "seed": [lambda v: World(seed=v)],
    "tier": [lambda v: fit(MASK, v)],
    "kind": [lambda v: World().add_body(BALL, kind=v)],
    "continuous": [lambda v: World().add_body(BALL, continuous=v)],
    "mass": [lambda v: World().add_body(BALL, mass=v)],
    "material": [BALL.with_, lambda v: World().add_body(BALL, material=v)],
    "filter": [lambda v: MASK.with_(filter=v), lambda v: World().add_body(BALL, filter=v)],
    "sensor": [lambda v: BALL.with_(sensor=v), lambda v: World().add_body(BALL, sensor=v)],
    "world": [lambda v: Body(v, 0)],
    "identity": [lambda v: Body(World(), v)],
    "arrays": [lambda v: Snapshot(v, {})],
    "facts": [lambda v: Snapshot({}, v)],
}
FINE = {"arrays", "facts"}  # for which a dict is right


@pytest.mark.parametrize("name, make", [(name, make) for name, makers in CONSTRUCTORS.items() for make in makers])
def test_strange_values_are_named(name, make):
    for value in ODD:
        if name in FINE and isinstance(value, dict):
            continue
        with pytest.raises((TypeError, ValueError)) as caught:
            make(value)
        text = str(caught.value)
        assert name in text and "got" in text and len(text) < 1000, text[:300]
