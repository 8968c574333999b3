"""Adding bodies: what a user asks for is checked first, then rows are appended; the world is unchanged by what is wrong."""

import numpy as np

from physics import checks
from physics.edits import shapes_for_tier
from physics.motion.integrate import refresh_centers
from physics.shape_rows import add_shapes, check_shapes, set_mass
from physics.shapes import Filter, Material, mass_of
from physics.tables import AUTO, CONTINUOUS, KINDS, STATIC


def add_rows(
    world,
    shapes,
    positions,
    velocities,
    angles,
    kind,
    angular_velocity,
    material,
    filter,
    sensor,
    bullet,
    continuous,
    fixed_rotation,
    gravity_scale,
    tier,
    user,
) -> np.ndarray:
    """Check what a user asks for, and append BODY and SHAPE rows. Returns the ids. Raises TypeError, ValueError."""
    world._unlocked()
    kind = KINDS.index(checks.choice("kind", kind, KINDS))
    for name, value, wanted in (("material", material, Material), ("filter", filter, Filter)):
        if not isinstance(value, wanted):
            raise TypeError(f"{name} must be a {wanted.__name__} (got {value!r})")
    sensor = checks.flag("sensor", sensor)
    world._needs("sensors", "sensor=True", sensor)
    continuous = CONTINUOUS.index(checks.choice("continuous", continuous, CONTINUOUS))
    bullet = checks.flag("bullet", bullet)
    world._needs("continuous", "bullet=True", bullet)
    if continuous not in (0, AUTO):
        world._needs("continuous", f"continuous={CONTINUOUS[continuous]!r}", True)
    fixed_rotation = checks.flag("fixed_rotation", fixed_rotation)
    gravity_scale = checks.number("gravity_scale", gravity_scale)
    spin = checks.number("angular_velocity", angular_velocity)
    world._needs("rotation", f"angular_velocity={spin}", spin != 0.0)
    if kind == STATIC and (np.any(np.asarray(velocities) != 0.0) or spin != 0.0):
        raise ValueError(
            f"velocity and angular_velocity must be 0 for a static body (got {np.asarray(velocities).tolist()}, {spin})"
        )
    used = shapes_for_tier(shapes, tier)
    check_shapes(used, kind, angles, continuous)
    mass = mass_of(used, material.density) if used else mass_of((), material.density)
    n = len(positions)
    ids = np.arange(world._next_body, world._next_body + n, dtype=np.int64)
    if n == 0:
        return ids
    world._next_body += n
    rows = world._bodies.append(n)
    rows["id"], rows["kind"] = ids, kind
    rows["x"], rows["y"] = np.asarray(positions).T
    rows["vx"], rows["vy"] = np.asarray(velocities).T
    rows["angle"], rows["angular_velocity"] = angles, spin
    for name in ("x", "y", "angle"):
        rows["previous_" + name] = rows[name]
    rows["gravity_scale"], rows["continuous"], rows["fixed_rotation"] = gravity_scale, continuous, fixed_rotation
    rows["awake"], rows["fraction"], rows["bullet"], rows["island"] = True, 1.0, bullet, -1
    set_mass(rows, mass, used)
    refresh_centers(rows)
    add_shapes(world, rows, world._bodies.count - n, used, material, filter, sensor)
    source = tuple(shapes)  # one for all: a swarm costs two entries each, and no object
    for identity in ids.tolist():
        world._shapes_of[identity] = used
        if user is not None:
            world._users[identity] = user
        if tier is not None:
            world._tiers[identity], world._sources[identity] = tier, source
    return ids
