"""What a pile of bodies does, in numbers: how deep it overlaps, how fast it moves, what energy it holds."""

import numpy as np

from physics import World

SOLVERS = ("projection", "sequential_impulse", "soft_step")


def with_effects(world, effects):
    """The snapshot of a world as it is, to be stepped on with these effects; all are awake."""
    other = _like(world)
    other.set_effects(effects)
    return other.snapshot()


def with_substeps(world, substeps):
    """The snapshot of a world as it is, to be stepped on with another number of substeps; None: with its own."""
    other = _like(world)
    if substeps is not None:
        other.substeps = substeps
    return other.snapshot()


def _like(world):
    other = World(world.effects, type(world.broadphase)(), world.solver)
    other.restore(world.snapshot())
    return other


def deepest(world):
    """The deepest overlap of the world's contacts [px]."""
    contacts = world.contacts
    return max(0.0, -float(contacts["separation"].min())) if len(contacts) else 0.0


def kinetic_energy(world, without=()):
    """Of all moving bodies but those with the ids in `without`, turning included [mass px2/s2]."""
    bodies = _but(world.bodies, without)
    inertia = bodies["inertia"] if world.effects.rotation else 0.0
    return 0.5 * float(
        np.sum(bodies["mass"] * (bodies["vx"] ** 2 + bodies["vy"] ** 2) + inertia * bodies["angular_velocity"] ** 2)
    )


def height_energy(world, without=()):
    """Of all dynamic bodies but those in `without` in the world's gravity, against y = 0 [mass px2/s2]."""
    bodies = _but(world.bodies, without)
    bodies = bodies[bodies["inverse_mass"] > 0.0]
    return -float(np.sum(bodies["mass"] * bodies["center_y"])) * world.gravity[1]


def _but(bodies, without):
    return bodies[~np.isin(bodies["id"], without)] if without else bodies


def fastest(world):
    """The highest speed of a dynamic body [px/s]."""
    bodies = world.bodies[world.bodies["inverse_mass"] > 0.0]
    return float(np.sqrt(np.max(bodies["vx"] ** 2 + bodies["vy"] ** 2))) if len(bodies) else 0.0


def step_seconds(world):
    """What the last step took, all stages [s]. Never part of a scene's state."""
    return sum(world.profile.stages.values())
