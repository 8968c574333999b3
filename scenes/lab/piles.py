"""Measurements of a pile of bodies: overlap, speed, energy, time of a step."""

import numpy as np

from physics import World

SOLVERS = ("projection", "sequential_impulse", "soft_step")


def with_effects(world, effects):
    """Return a snapshot of a world's current state with other effects. All bodies in the snapshot are awake."""
    other = _like(world)
    other.set_effects(effects)
    return other.snapshot()


def with_substeps(world, substeps):
    """Return a snapshot of a world's current state with another number of substeps, or the same number if
    it is None.
    """
    other = _like(world)
    if substeps is not None:
        other.substeps = substeps
    return other.snapshot()


def _like(world):
    other = World(world.effects, type(world.broadphase)(), world.solver)
    other.restore(world.snapshot())
    return other


def deepest(world):
    """Return the deepest overlap of the world's contacts [px]."""
    contacts = world.contacts
    return max(0.0, -float(contacts["separation"].min())) if len(contacts) else 0.0


def kinetic_energy(world, without=()):
    """Return the kinetic energy of all bodies except the ids in `without`, including rotation [mass px2/s2]."""
    bodies = _but(world.bodies, without)
    inertia = bodies["inertia"] if world.effects.rotation else 0.0
    return 0.5 * float(
        np.sum(bodies["mass"] * (bodies["vx"] ** 2 + bodies["vy"] ** 2) + inertia * bodies["angular_velocity"] ** 2)
    )


def height_energy(world, without=()):
    """Return the potential energy of all dynamic bodies except the ids in `without`, relative to y = 0
    [mass px2/s2].
    """
    bodies = _but(world.bodies, without)
    bodies = bodies[bodies["inverse_mass"] > 0.0]
    return -float(np.sum(bodies["mass"] * bodies["center_y"])) * world.gravity[1]


def _but(bodies, without):
    return bodies[~np.isin(bodies["id"], without)] if without else bodies


def fastest(world):
    """Return the highest speed of a dynamic body [px/s]."""
    bodies = world.bodies[world.bodies["inverse_mass"] > 0.0]
    return float(np.sqrt(np.max(bodies["vx"] ** 2 + bodies["vy"] ** 2))) if len(bodies) else 0.0


def step_seconds(world):
    """Return the duration of the world's last step, summed over all stages [s].

    Timings are never part of a scene's state.
    """
    return sum(world.profile.stages.values())
