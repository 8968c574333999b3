"""2D physics with collision detection down to the pixels of sprites: shapes, broad and narrow phases, contacts, events.

Units are pixels, seconds and radians. x points right, y points down, and a positive angle is clockwise on the screen.
Start reading at `World.step` in physics/world.py.
"""

from physics.background import compile_in_background
from physics.body import Body
from physics.broadphase import BROADPHASES
from physics.broadphase.brute_force import BruteForce
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.character.character import Character, Moved
from physics.effects import Effects
from physics.hints import explaining_missing_names
from physics.jit import JIT
from physics.joint import Joint
from physics.joints.kinds import (
    Angle,
    Distance,
    Drive,
    Gear,
    Motor,
    NoContact,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Spring,
    Target,
    Weld,
    Wheel,
)
from physics.math2d import Vec2
from physics.queries.casts import RayHit
from physics.queries.pairs import Manifold, TimeOfImpact, collide, distance, time_of_impact
from physics.shapes.approximate import TIERS, Fit, decompose, fit, hull, measure
from physics.shapes.kinds import Bounds, mass_of
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.shape import Filter, Material
from physics.shapes.values import Capsule, Chain, Circle, Polygon, Segment, TileGrid
from physics.snapshot import PHYSICS_VERSION, Snapshot
from physics.step import SOLVERS
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.warmup import warmup
from physics.world import World

__all__ = [
    "Angle", "BROADPHASES", "Body", "Bounds", "BruteForce", "Capsule", "Chain", "Character", "Circle", "DYNAMIC",
    "Distance", "Drive", "DynamicTree", "Effects", "Filter", "Fit", "Gear", "JIT", "Joint", "KINEMATIC", "Manifold",
    "Mass", "Material", "Motor", "Moved", "NoContact", "PHYSICS_VERSION", "PixelMask", "Polygon", "Prismatic",
    "Pulley", "Ratchet", "RayHit", "Revolute", "SOLVERS", "STATIC", "Segment", "Snapshot", "SpatialHashGrid", "Spring",
    "SweepAndPrune", "TIERS", "Target", "TileGrid", "TimeOfImpact", "Vec2", "Weld", "Wheel", "World", "collide",
    "compile_in_background", "decompose", "distance", "fit", "hull", "mass_of", "measure", "time_of_impact", "warmup",
]  # fmt: skip

# A function of this name in the source would make type checkers accept every name.
globals()["__getattr__"] = explaining_missing_names(__name__, __all__)
