"""The rows that shapes need: SHAPE rows, masses, places in the broad phase."""

import numpy as np

from physics.shapes import SHAPES, Chain, PixelMask, Segment, TileGrid
from physics.tables import CONTINUOUS, DYNAMIC, KINDS, RAY, STATIC, SWEPT


def check_shapes(shapes, kind, angles, swept):
    """Refuse what is no shape, dynamic chains, turned or dynamic tiles, and swept masks. Raises TypeError, ValueError."""
    if kind == DYNAMIC and shapes and all(isinstance(shape, Segment) for shape in shapes):
        raise ValueError(f"shapes of a dynamic body must hold one with mass, a Segment has none (got {shapes!r})")
    for shape in shapes:
        if not isinstance(shape, SHAPES):
            raise TypeError(f"shapes must be shapes such as Circle(8) (got {shape!r})")
        if isinstance(shape, PixelMask) and swept in (RAY, SWEPT):
            raise ValueError(
                f"continuous must be off or auto for a PixelMask (got {CONTINUOUS[swept]!r}): "
                "masks are not swept, nor is anything against them"
            )
        if isinstance(shape, TileGrid) and (kind == DYNAMIC or np.any(np.asarray(angles) != 0.0)):
            raise ValueError(
                f"a TileGrid needs kind static or kinematic and angle 0 (got {KINDS[kind]}, "
                f"{np.asarray(angles).tolist()})"
            )
        if isinstance(shape, Chain) and kind == DYNAMIC:
            raise ValueError("a Chain needs kind static or kinematic (got dynamic): it has no inside and no mass")


def rounding_of(shape):
    """(radius, centre of a circle in body space) of a shape, or of what a Bounds wraps: what its SHAPE row holds [px]."""
    inner = getattr(shape, "shape", shape)
    return (getattr(inner, "radius", 0.0), *getattr(inner, "center", (0.0, 0.0)))


def set_mass(rows, mass, shapes):
    """Write mass, inertia and size of BODY rows of one kind of body."""
    rows["mass"], rows["inertia"] = mass.mass, mass.inertia
    rows["local_center_x"], rows["local_center_y"] = mass.center
    moves = (rows["kind"] == DYNAMIC) & (mass.mass > 0.0)
    turns = moves & (mass.inertia > 0.0) & ~rows["fixed_rotation"]
    rows["inverse_mass"] = np.where(moves, 1.0 / mass.mass if mass.mass > 0.0 else 0.0, 0.0)
    rows["inverse_inertia"] = np.where(turns, 1.0 / mass.inertia if mass.inertia > 0.0 else 0.0, 0.0)
    rows["smallest_half"] = min((shape.smallest_half for shape in shapes), default=0.0)
    rows["extent"] = max((shape.reach(*mass.center) for shape in shapes), default=0.0)


def add_shapes(world, bodies, first_row, shapes, material, filter, sensor):
    """Append the SHAPE rows of new shapes for BODY rows that start at first_row, and give them places in the broad phase."""
    n, k = len(bodies), len(shapes)
    if n * k == 0:
        return
    rows = world._shapes.append(n * k)
    rows["id"] = np.arange(world._next_shape, world._next_shape + n * k)
    world._next_shape += n * k
    rows["body"] = np.repeat(bodies["id"], k)
    rows["body_row"] = np.repeat(np.arange(first_row, first_row + n), k)
    for name in ("density", "friction", "restitution", "rolling_resistance", "surface_speed"):
        rows[name] = getattr(material, name)
    rows["sensor"] = sensor
    rows["membership"], rows["mask"] = filter.membership, filter.mask
    for i, shape in enumerate(shapes):
        kind, geometry, wrapped = world.library.add(shape)
        each = rows[i::k]
        each["kind"], each["geometry"], each["wrapped"] = kind, geometry, wrapped
        each["radius"], each["local_x"], each["local_y"] = rounding_of(shape)
    world.pairs.add_proxies(rows, np.arange(n * k), np.repeat(bodies["kind"] == STATIC, k))
