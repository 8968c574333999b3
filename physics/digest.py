"""The digest of a world: two worlds with the same one go on alike."""

import hashlib

import numpy as np

from physics.shapes.mask import PixelMask
from physics.tables.shape import MASK
from physics.world_state import WorldState

# Goes up with every change by which some world takes other digests: recordings of before play, and part.
PHYSICS_VERSION = 5
STATE = ("id", "x", "y", "angle", "vx", "vy", "angular_velocity", "awake", "quarantined")
CLOCK = ("still_x", "still_y", "still_angle", "sleep_time")
ASKED = ("substeps", "eased")  # where the number of substeps follows from the loads
# What bodies and shapes were given. Materials are left out: where their effect is not declared they are inert.
GIVEN = ("kind", "inverse_mass", "inverse_inertia", "gravity_scale", "continuous", "bullet")
SHAPE = ("id", "membership", "mask", "sensor")
NARROW = {"kind": np.int8, "continuous": np.int8, "membership": np.uint32, "mask": np.uint32}
KEYS = ("shape_a", "shape_b", "feature", "normal_impulse", "tangent_impulse")
WALK = (
    "body",
    "left",
    "top",
    "remainder_x",
    "remainder_y",
    "riding",
    "riding_shape",
    "slope",
    "grounded",
    "squeezed",
    "pressed",
    "carry_x",
    "carry_y",
    "belt",
    "belt_x",
    "push_vx",
    "push_vy",
    "deep",
    "wedged",
)


def digest(world: WorldState) -> str:
    """blake2b-128 over length and solver of the step, ids, poses, velocities, flags, masses, filters, characters,
    contacts and impulses in id order, and over targets and forces that wait for the next step; −0.0 as 0.0."""
    found = hashlib.blake2b(digest_size=16)
    auto = world.substeps == "auto"
    pace = (0, world.accuracy) if auto else (world.substeps,)
    numbers = np.array((world.dt, *pace, world.tolerances.pixels_per_meter), np.float64)
    found.update(world.solver.encode() + numbers.tobytes())
    tables = (
        (world.bodies, (*STATE, *CLOCK, *GIVEN, *(ASKED if auto and world.stacks else ()))),
        (world.shapes, SHAPE),
        (world.characters.rows, WALK),
        (world.contacts, KEYS),
    )
    for rows, names in tables:
        found.update(len(rows).to_bytes(8, "little"))
        for name in names:
            column = rows[name].astype(NARROW.get(name, rows.dtype[name]))
            found.update((column + 0.0 if column.dtype == np.float64 else column).tobytes())
    exact = world.shapes["id"][(world.shapes["kind"] == MASK) & ~world.shapes["snap"]]
    if len(exact):
        found.update(b"exact" + exact.tobytes())
    open_ones = [
        shape.one_way for masks in world._shapes_of.values() for shape in masks if isinstance(shape, PixelMask)
    ]
    if any(open_ones):
        found.update(b"one way" + bytes(open_ones))
    for masks in world._shapes_of.values() if world.effects.carving else ():
        for mask in masks:
            if isinstance(mask, PixelMask) and mask.carved:
                found.update(b"carved" + mask.fingerprint)
    if world.stacks and world.span not in (0.0, world.dt):
        found.update(b"span" + np.float64(world.span).tobytes())
    # What waits for the next step only; where nothing waits, nothing is added.
    targets = world._targets
    for identity in sorted(targets):
        found.update(
            b"target" + np.array([identity], np.int64).tobytes() + (np.array(targets[identity]) + 0.0).tobytes()
        )
    waiting = np.stack([world.bodies[name] for name in ("force_x", "force_y", "torque")], axis=1) + 0.0
    rows = np.flatnonzero(waiting.any(axis=1))
    if len(rows):
        found.update(b"forces" + world.bodies["id"][rows].tobytes() + waiting[rows].tobytes())
    return found.hexdigest()
