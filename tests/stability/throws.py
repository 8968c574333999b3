"""Random throws of masks and other shapes at thin pixel walls: straight, rotated, staircases and rings.

A body has passed a wall if its centre of mass gets to the far side. There is no way around a wall.
"""

import math
from typing import NamedTuple

import numpy as np

from physics import Capsule, Circle, Effects, PixelMask, Polygon, World

STEPS = 40
SHAPES = ("full", "disc", "plus", "sprite", "stick", "circle", "box", "capsule")
WALLS = ("straight", "turned", "stairs", "ring")
REACH = 150.0  # [px] from the middle of a wall to its ends


class Throw(NamedTuple):
    """One throw at a wall; the wall passes through the origin, or is a ring around it."""

    wall: PixelMask
    wall_kind: str
    wall_angle: float
    shape: object
    position: tuple[float, float]
    angle: float
    velocity: tuple[float, float]
    spin: float


def thrown_shape(kind, rng):
    """Return a random shape of a kind, 4 to 32 px large."""
    size = int(rng.integers(4, 33))
    if kind == "circle":
        return Circle(size / 2)
    if kind == "box":
        return Polygon.box(size, max(2.0, size * float(rng.uniform(0.2, 1.0))))
    if kind == "capsule":
        return Capsule((-size / 4, 0), (size / 4, 0), size / 6)
    solid = np.ones((size, size), bool)
    if kind == "disc":
        at = np.arange(size) + 0.5 - size / 2
        solid = at[:, None] ** 2 + at[None, :] ** 2 <= size * size / 4
    elif kind == "plus":
        arm = max(1, size // 5)
        solid[:] = False
        solid[(size - arm) // 2 : (size + arm) // 2 + 1] = solid[:, (size - arm) // 2 : (size + arm) // 2 + 1] = True
    elif kind == "stick":
        solid = solid[: int(rng.integers(1, 4))]
    elif kind == "sprite":
        solid = rng.random((max(2, size // 3), max(2, size // 3))) < 0.7
        solid[len(solid) // 2] = True
        solid = np.repeat(np.repeat(solid, 3, 0), 3, 1)
    return PixelMask(solid)


def thin_wall(kind, thickness):
    """Return a pixel wall of a kind, 1 to 3 px thick, with its origin in the middle."""
    if kind == "ring":
        at = np.hypot(*np.indices((300, 300)) - 149.5)
        # The 8-connected circle is closed to bodies tested by outline; a 1 px ring is 1.5 px thick at its staircases.
        return PixelMask((at <= 149.0) & (at > 149.0 - max(1.5, thickness)))
    if kind == "stairs":
        rows, columns = np.indices((300, 300))
        return PixelMask(abs(rows - columns) < thickness)
    return PixelMask(np.ones((300, thickness), bool))


def throws(count, seed):
    """Yield `count` random throws at 100 to 3,000 px/s, with up to 20 rad/s."""
    rng = np.random.default_rng(seed)
    walls = {(kind, thickness): thin_wall(kind, thickness) for kind in WALLS for thickness in (1, 2, 3)}
    for _ in range(count):
        kind = WALLS[rng.integers(len(WALLS))]
        wall, thickness = None, int(rng.integers(1, 4))
        wall = walls[kind, thickness]
        turn = float(rng.uniform(0, math.tau)) if kind == "turned" else 0.0
        shape = thrown_shape(SHAPES[rng.integers(len(SHAPES))], rng)
        speed = float(np.exp(rng.uniform(math.log(100.0), math.log(3000.0))))
        if kind == "ring":
            way = float(rng.uniform(0, math.tau))
            place = tuple(rng.uniform(-40, 40, 2).tolist())
        else:
            normal = math.pi / 4 * -1.0 if kind == "stairs" else turn  # of the wall, away from the side it comes from
            way = normal + float(rng.uniform(-1.0, 1.0))
            along = float(rng.uniform(-40, 40))
            away = float(rng.uniform(22, 60))
            place = (
                -away * math.cos(normal) - along * math.sin(normal),
                -away * math.sin(normal) + along * math.cos(normal),
            )
        yield Throw(
            wall,
            kind,
            turn,
            shape,
            place,
            float(rng.uniform(0, math.tau)),
            (speed * math.cos(way), speed * math.sin(way)),
            float(rng.uniform(-20, 20)),
        )


def side_of(throw, x, y):
    """Return how far [px] a point is beyond the centre line of a throw's wall."""
    if throw.wall_kind == "ring":
        return math.hypot(x, y) - 148.0
    normal = -math.pi / 4 if throw.wall_kind == "stairs" else throw.wall_angle
    return x * math.cos(normal) + y * math.sin(normal)


def fly(throw, effects, solver=None, mode="auto"):
    """Simulate a throw without gravity. Return (whether the body passed the wall, whether a contact began)."""
    world = World(effects, solver=solver, gravity=(0.0, 0.0))
    wall = world.add_body(throw.wall, angle=throw.wall_angle, kind="static")
    body = world.add_body(
        throw.shape,
        position=throw.position,
        angle=throw.angle,
        velocity=throw.velocity,
        angular_velocity=throw.spin,
        continuous=mode,
    )
    met = False
    for _ in range(STEPS):
        before = body.center
        world.step()
        met = met or len(world.events.begin) > 0
        x, y = body.center
        if side_of(throw, x, y) > 2.0 and side_of(throw, *before) <= 2.0:
            # Past the wall itself, not past its end.
            return math.hypot(x, y) < REACH or throw.wall_kind == "ring", met
        if math.hypot(x, y) > 2 * REACH or (effects.response and met and body.velocity.dot(throw.velocity) < 0.0):
            break
    assert wall in world
    return False, met


PILES = Effects(response=True, rotation=True, friction=True, restitution=True, stacking=True, continuous=True)
PUSHES = Effects(response=True, rotation=True, continuous=True)
TOLD = Effects(rotation=True, continuous=True)
