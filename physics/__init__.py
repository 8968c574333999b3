"""2D collision that understands sprites: shapes, broad phases, narrow phase down to pixels, contacts, events.

Pixels, seconds, radians; x right, y down; a positive angle turns clockwise on the screen. Start reading at
`World.step` in physics/world.py.
"""

from physics.body import Body
from physics.broadphase.brute_force import BruteForce
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.collide import Manifold, collide
from physics.distance import Distance, distance
from physics.effects import Effects
from physics.fitting import TIERS, fit
from physics.impact import TimeOfImpact, time_of_impact
from physics.jit import JIT
from physics.motion.character import Character, Moved
from physics.queries import RayHit
from physics.shapes import (
    Bounds,
    Capsule,
    Chain,
    Circle,
    Filter,
    Mass,
    Material,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    mass_of,
)
from physics.snapshot import Snapshot
from physics.tables import DYNAMIC, KINEMATIC, STATIC
from physics.warmup import warmup
from physics.world import SOLVERS, World

BROADPHASES = {each.name: each for each in (BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree)}

__all__ = [
    "BROADPHASES",
    "Body",
    "Bounds",
    "BruteForce",
    "Capsule",
    "Chain",
    "Character",
    "Circle",
    "DYNAMIC",
    "Distance",
    "DynamicTree",
    "Effects",
    "Filter",
    "JIT",
    "KINEMATIC",
    "Manifold",
    "Mass",
    "Material",
    "Moved",
    "PixelMask",
    "Polygon",
    "RayHit",
    "SOLVERS",
    "STATIC",
    "Segment",
    "Snapshot",
    "SpatialHashGrid",
    "SweepAndPrune",
    "TIERS",
    "TileGrid",
    "TimeOfImpact",
    "World",
    "collide",
    "distance",
    "fit",
    "mass_of",
    "time_of_impact",
    "warmup",
]
