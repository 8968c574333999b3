"""Compiles the kernels that a world with given effects will need, by running small worlds with them."""

import numpy as np

from physics.broadphase.brute_force import BruteForce
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.effects import Effects
from physics.motion.character import Character
from physics.shapes import Bounds, Circle, PixelMask, Polygon, TileGrid
from physics.world import World

STRATEGIES = {each.name: each for each in (BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree)}


def warmup(effects=None, broadphase="hash", solver=None, progress=None):
    """Compile, or load from the cache, what a world with these effects calls.

    broadphase: brute, sweep, hash, tree or "all"; progress(done, total, name) is called before each piece and at the
    end. Without compiled kernels it runs the same and costs milliseconds. Raises KeyError for an unknown broad phase.
    """
    effects = Effects() if effects is None else effects
    names = list(STRATEGIES) if broadphase == "all" else [broadphase]
    pieces = [(f"broad phase {name}", lambda name=name: _small_world(effects, solver, STRATEGIES[name](),
                                                                    (Circle(4), Circle(4)))) for name in names]
    box, mask = Polygon.box(8, 8), PixelMask(np.ones((4, 4), bool))
    strategy = STRATEGIES[names[0]]
    if effects.narrowphase:
        tiles = TileGrid(np.ones((1, 2), bool), 16)
        for name, pair in (("circles and boxes", (box, Circle(4))), ("boxes", (box, Bounds(box))), ("masks", (mask, mask)),
                           ("masks and boxes", (mask, box)), ("masks and circles", (mask, Circle(4))),
                           ("tiles", (tiles, box))):
            pieces.append((name, lambda pair=pair: _small_world(effects, solver, strategy(), pair)))
    pieces.append(("queries", lambda: _queries(effects)))
    if effects.response:
        pieces.append(("characters", lambda: _character(effects)))
    for number, (name, run) in enumerate(pieces):
        if progress:
            progress(number, len(pieces), name)
        run()
    if progress:
        progress(len(pieces), len(pieces), "ready")


def _small_world(effects, solver, strategy, pair):
    world = World(effects, strategy, solver)
    first = world.add_body(pair[0], kind="kinematic" if isinstance(pair[0], TileGrid) else "dynamic", position=(0, 0))
    world.add_body(pair[1], position=(3, 2), velocity=(-900.0, 0.0))
    world.step()
    world.remove_body(first)
    world.step()


def _queries(effects):
    world = World(effects)
    world.add_body(Circle(4), kind="static")
    world.ray_cast((-20, 0), (40, 0))
    world.overlap(Circle(2), (0, 0, 0))


def _character(effects):
    world = World(effects)
    world.add_body(Polygon.box(40, 8), position=(0, 20), kind="kinematic", velocity=(60.0, 0.0))
    hero = Character(world, Polygon.box(8, 8), (0, 0))
    hero.move(1.0, 20.0)
    world.step()
