"""The shots of lab/tunnelling: their starts, the plate, and the geometric test that tells whether a shot must hit.

In this module the centre line of a lane is at y = 0.
"""

from math import ceil, pi

import numpy as np

from physics import Capsule, Circle, Polygon

SHOTS = ("balls", "rods", "bullets")
GUN_X, PLATE_X, END_X = 30.0, 300.0, 380.0  # [px]
RADIUS, PLATE_HALF = 5.0, 11.0  # [px]
ROD_HALF, ROD_RADIUS = 14.0, 1.5  # [px]
ROD_SPIN = (24.0, 46.0)  # [rad/s] up to an eighth of a turn per step
BULLET_RADIUS = 2.5  # [px]
SPREAD = {
    "balls": (0.0, 18.0),
    "rods": (13.0, 24.0),
    "bullets": (0.0, 3.4),
}  # [px] off the middle; rods: beyond the plate
SAMPLE = 0.1  # [px] between two samples of the slow reference for rods


def aim(kind, speed, plate, random):
    """Choose a random shot, and return (shots, gap).

    kind: one of SHOTS; speed: speed of the shot [px/s]; plate: width of the plate [px]; random: random.Random.

    shots: list of (shape, position, velocity along x, angle, angular velocity), two for bullets that fly at each
    other. The start varies by the distance of one step, so that impacts occur at any time within a step. gap: least
    distance between the shot and its target by geometry [px], negative if they must meet.
    """
    start = GUN_X + random.uniform(0.0, speed / 60)
    if kind == "balls":
        offset = _aside(kind, random)
        return [(Circle(RADIUS), (start, offset), speed, 0.0, 0.0)], abs(offset) - PLATE_HALF - RADIUS
    if kind == "rods":
        offset = _aside(kind, random)
        angle = random.uniform(0.0, pi)
        spin = random.choice((-1, 1)) * random.uniform(*ROD_SPIN)
        rod = Capsule((-ROD_HALF, 0), (ROD_HALF, 0), ROD_RADIUS)
        return [(rod, (start, offset), speed, angle, spin)], rod_gap(start, offset, speed, angle, spin, plate)
    offset, other = _aside(kind, random), _aside(kind, random)
    back = END_X - random.uniform(0.0, speed / 60)
    bullet = Circle(BULLET_RADIUS)
    shots = [(bullet, (start, offset), speed, 0.0, 0.0), (bullet, (back, other), -speed, 0.0, 0.0)]
    return shots, abs(offset - other) - 2.0 * BULLET_RADIUS


def _aside(kind, random):
    return random.choice((-1, 1)) * random.uniform(*SPREAD[kind])


def shoot(world, shots, kind, lane, middle=0.0):
    """Add the shots of aim() to a world, and return the list of their bodies.

    kind: one of SHOTS; lane: argument `continuous` of the bodies; middle: y of the lane's centre line [px].
    """
    return [
        world.add_body(
            shape,
            position=(x, middle + y),
            velocity=(vx, 0.0),
            angle=angle,
            angular_velocity=spin,
            continuous=lane,
            bullet=lane == "toi" and kind == "bullets",
        )
        for shape, (x, y), vx, angle, spin in shots
    ]


def raise_plate(world, width, middle=0.0):
    """Add the static plate at which shots are fired, `width` px wide, with its centre at y = `middle`. Return its
    body.
    """
    return world.add_body(Polygon.box(width, 2 * PLATE_HALF), position=(PLATE_X, middle), kind="static")


def steps_of_flight(speed):
    """Return how many steps of 1/60 s a shot needs from the gun to the end of the lane. speed: its speed [px/s]."""
    return ceil(60.0 * (END_X - GUN_X) / speed)


def flights(world, kind, lane, speed, plate, count, random):
    """Return a list of `count` snapshots of the world. Each contains the plate and one shot that has just been fired.

    The shots are random. kind: one of SHOTS; there is no plate for "bullets", which fly at each other. lane: argument
    `continuous` of the shots; speed: speed of the shots [px/s]; plate: width of the plate [px]; random: random.Random.
    """
    if kind != "bullets":
        raise_plate(world, plate)
    found = []
    for _ in range(count):
        bodies = shoot(world, aim(kind, speed, plate, random)[0], kind, lane)
        found.append(world.snapshot())
        world.remove_bodies([body.id for body in bodies])
    return found


def rod_gap(start, offset, speed, angle, spin, plate):
    """Return the least distance between a flying, spinning rod and the plate by geometry [px], negative if they meet.

    (start, offset): first position of the rod's centre [px]; speed [px/s], angle [rad], spin [rad/s]: motion of the
    rod; plate: width of the plate [px].
    """
    reach = ROD_HALF + ROD_RADIUS + plate
    first, last = max((PLATE_X - reach - start) / speed, 0.0), (PLATE_X + reach - start) / speed
    count = int((last - first) * (speed + abs(spin) * ROD_HALF) / SAMPLE) + 2
    times = np.linspace(first, last, count)[:, None]
    along = np.linspace(-ROD_HALF, ROD_HALF, 65)[None, :]
    x = start + speed * times + along * np.cos(angle + spin * times) - PLATE_X
    y = offset + along * np.sin(angle + spin * times)
    dx, dy = np.maximum(np.abs(x) - plate / 2, 0.0), np.maximum(np.abs(y) - PLATE_HALF, 0.0)
    depth = np.minimum(np.maximum(np.abs(x) - plate / 2, np.abs(y) - PLATE_HALF), 0.0)
    return float((np.sqrt(dx * dx + dy * dy) + depth).min()) - ROD_RADIUS
