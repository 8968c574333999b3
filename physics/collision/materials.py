"""What two materials are together: friction, restitution, rolling resistance, surface speed of a contact."""

import math

from physics.collision.features import part_of
from physics.jit import inlined
from physics.tables.shape import CHAIN, MASK, TILES


@inlined
def mixed(geometry, a, b, manifold):
    """(friction, restitution, rolling resistance [px], surface speed [px/s]) of a manifold of two shapes, SHAPE rows; a
    chain's link has its own.

    Friction is the geometric mean, restitution and rolling resistance the greater, surface speeds add up. Rolling
    resistance is a length here: the coefficient times the greater radius (Catto, Box2D v3.1).
    """
    friction = 1.0
    restitution = 0.0
    rolling = 0.0
    radius = 0.0
    speed = 0.0
    for side in range(2):
        s = a if side == 0 else b
        own_friction = s.friction
        own_restitution = s.restitution
        own_rolling = s.rolling_resistance
        own_speed = s.surface_speed
        if s.kind == CHAIN:
            link = geometry.links[geometry.chains[s.geometry].offset + part_of(manifold.feature_1)]
            if link.friction >= 0.0:
                own_friction = link.friction
                own_restitution = link.restitution
                own_rolling = link.rolling_resistance
                own_speed = link.surface_speed
        friction *= own_friction
        restitution = max(restitution, own_restitution)
        rolling = max(rolling, own_rolling)
        speed += own_speed
        if s.kind != TILES and s.kind != CHAIN and s.kind != MASK:
            radius = max(radius, s.radius)
    return math.sqrt(friction), restitution, rolling * radius, speed
