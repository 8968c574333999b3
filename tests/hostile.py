"""Worlds and numbers for which the compiled and the plain form of a kernel might differ.

The worlds have shapes of all kinds. The numbers are invalid values for bodies.
"""

import math

import numpy as np

from physics import (
    BruteForce,
    Capsule,
    Chain,
    Character,
    Circle,
    DynamicTree,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
)

STRATEGIES = {
    "brute": BruteForce,
    "sweep": SweepAndPrune,
    "sweep both": lambda: SweepAndPrune(axes="both"),
    "hash": SpatialHashGrid,
    "hash 1": lambda: SpatialHashGrid(1.0),
    "tree": DynamicTree,
}
PUSHED = dict.fromkeys(
    (
        "response gravity drag wind rotation friction restitution continuous sensors persist one_way conveyor carving"
    ).split(),
    True,
)
KINDS = {  # effects, the solvers that go with them
    "found": (Effects(rotation=True, continuous=True, sensors=True, persist=True), (None,)),
    "pushed": (Effects(**PUSHED), ("blocking", "projection")),
    "stacked": (Effects(**PUSHED, stacking=True, sleeping=True), ("sequential_impulse", "soft_step")),
}
NUMBERS = (
    math.nan, math.inf, -math.inf, 1e300, -1e300, 1e18, -1e18, 2.0**62, 2.0**51, -(2.0**51), 2.0**40, -(2.0**40),
    2.0**32, 2.0**31, -(2.0**31) - 1.0, 2.0**31 - 1.0, 1e-310, -0.0, 5e-324,
)  # fmt: skip
COLUMNS = (
    "x", "y", "angle", "vx", "vy", "angular_velocity", "force_x", "torque", "mass", "inverse_mass", "inertia",
    "inverse_inertia", "gravity_scale", "center_x", "local_center_x", "extent", "sleep_time", "previous_x",
    "previous_angle", "min_half_extent", "inradius", "fraction", "still_x", "settled_x", "cooldown",
)  # fmt: skip
RING = np.ones((12, 12), bool)
RING[4:8, 4:8] = False
MASKS = [PixelMask(RING), PixelMask(RING, snap=False), PixelMask(np.ones((6, 9), bool))]
OPEN = PixelMask(np.ones((4, 40), bool), one_way=True)
TILES = TileGrid(
    [[0, 0, 1, 0], [1, 1, 1, 1]], 16.0, slopes=[[(0.0, 0.0), (1.0, 0.5), (0.0, 0.0), (0.0, 1.0)], [(0.0, 0.0)] * 4]
)
OPEN_TILES = TileGrid([[0, 0, 0]], 16.0, one_way=[[1, 1, 1]])
MOVING = (
    Circle(5.0), Polygon.box(10.0, 8.0), *MASKS, Capsule((-4.0, 0.0), (4.0, 0.0), 3.0),
    Polygon([(-5.0, -4.0), (6.0, -3.0), (0.0, 6.0)], 1.5),
)  # fmt: skip
STILL = (
    Polygon.box(120.0, 10.0),
    TILES,
    OPEN_TILES,
    Chain([(-60.0, 0.0), (0.0, 5.0), (60.0, 0.0)]),
    Segment((-9.0, 0.0), (9.0, 4.0)),
    OPEN,
)


def air(effects):
    """Return the World arguments for drag and wind if these effects are declared, otherwise {}."""
    return {"drag": 0.1, "wind": (5.0, 0.0)} if effects.drag and effects.wind else {}


def crowded(kind, strategy, solver=None, seed=0, walkers=True):
    """Return a world with shapes of all kinds, most of them in contact.

    kind: key of KINDS. walkers: True adds characters if the world has response.
    """
    effects, solvers = KINDS[kind]
    rng = np.random.default_rng(seed)
    world = World(effects, STRATEGIES[strategy](), solver or solvers[0], **air(effects))
    for number, shape in enumerate(STILL):
        if not effects.one_way and np.any(getattr(shape, "one_way", False)):
            continue
        world.add_body(shape, position=(50.0 * number - 100.0, 40.0), kind="static")
    world.add_body(Polygon.box(30.0, 6.0), position=(-90.0, 20.0), kind="kinematic", velocity=(20.0, 0.0))
    world.add_body(Circle(9.0), position=(0.0, 20.0), kind="static", sensor=True)
    for number in range(2 * len(MOVING)):
        world.add_body(
            MOVING[number % len(MOVING)],
            position=tuple(rng.uniform((-110.0, 0.0), (160.0, 38.0))),
            velocity=tuple(rng.normal(0.0, 60.0 if number % 3 else 3000.0, 2)),
            angular_velocity=rng.normal(),
            continuous=("auto", "ray", "swept", "toi")[number % 4],
            bullet=number % 5 == 0,
        )
    if effects.response and walkers:
        Character(world, Polygon.box(8.0, 12.0), (-90.0, 5.0), pushable=True)
        Character(world, Circle(5.0), (30.0, 5.0))
    return world


def ask(world, x=0.0, y=20.0):
    """Make each kind of query at a point."""
    world.ray_cast_all((x - 50.0, y), (100.0, 3.0))
    for shape in (Circle(4.0), Polygon.box(6.0, 6.0), MASKS[0], MASKS[1]):
        world.overlap(shape, (x, y, 0.3))
    world.shape_cast(Polygon.box(6.0, 6.0), (x - 50.0, y, 0.1), (100.0, 3.0))
    world.closest((x, y))
    world.query_point((x, y))
    world.query_aabb((x, y), (x + 9.0, y + 9.0))
