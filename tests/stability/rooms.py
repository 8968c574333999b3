"""Random passive scenes: rooms whose bodies come to rest, and scenes whose bodies keep their energy and never rest.

The figures of a room are a `Found`; `python -m tests.stability.rooms FIRST LAST` prints those of a range of seeds.
"""

import math
import sys
from typing import NamedTuple

import numpy as np

from physics import Capsule, Chain, Circle, Effects, Material, PixelMask, Polygon, World
from tests.stability.invariants import deepest

METER = 32.0  # [px]
SECONDS = 20  # in which a room comes to rest
POP = 1.0 * METER  # [px/s] no body at rest is suddenly faster
REST = 0.05 * METER  # [px/s] slower bodies are at rest …
STILL = 30  # … after so many steps
WALL = 64.0  # [px] thickness of walls


class Found(NamedTuple):
    """Figures measured in one simulated room."""

    bodies: int
    masks: bool
    left: int  # bodies whose centre of mass is beyond the walls at the end
    pops: int  # bodies faster than POP in a step before which all were at rest
    awake: int  # bodies awake at the end
    asleep_after: float  # [s] inf: not at all
    overlap: float  # [px] of the deepest contact at the end, asleep or not
    rise: float  # greatest rise of mechanical energy in a step, as a share of the energy at the start


def disc_mask(radius):
    """Return a pixel mask in the form of a disc; radius in pixels."""
    at = np.arange(2 * radius) + 0.5 - radius
    return PixelMask(at[:, None] ** 2 + at[None, :] ** 2 <= radius * radius, None)


def sprite(rng):
    """Return a random connected pixel mask with notches."""
    solid = rng.random((int(rng.integers(4, 9)), int(rng.integers(4, 9)))) < 0.7
    solid[len(solid) // 2] = True
    solid[:, solid.shape[1] // 2] = True
    return PixelMask(np.repeat(np.repeat(solid, 3, axis=0), 3, axis=1), None)


def shapes_of(kind, rng):
    """Return a tuple of random shapes for one body of about 12 to 28 px."""
    r = float(rng.uniform(6.0, 14.0))
    if kind == "hull":
        angles = np.sort(rng.uniform(0.0, math.tau, int(rng.integers(5, 9))))
        angles += np.arange(len(angles)) * 1e-3
        gaps = np.diff(angles, append=angles[0] + math.tau)
        if gaps.max() > 2.5 or gaps.min() < 1e-2:
            angles = np.arange(5) * math.tau / 5
        return (Polygon([(r * math.cos(a), r * math.sin(a)) for a in angles]),)
    return {
        "circle": lambda: (Circle(r),),
        "box": lambda: (Polygon.box(2.0 * r, 2.0 * r * float(rng.uniform(0.3, 1.0))),),
        "capsule": lambda: (Capsule((-r / 2, 0), (r / 2, 0), r / 2),),
        "rounded": lambda: (Polygon([(-r, -r / 2), (r, -r / 2), (r, r / 2), (-r, r / 2)], r / 5),),
        "cross": lambda: (Polygon.box(2.0 * r, r / 2), Polygon.box(r / 2, 2.0 * r)),
        "disc mask": lambda: (disc_mask(int(r)),),
        "sprite": lambda: (sprite(rng),),
    }[kind]()


def room(seed, most=300, **settings):
    """Return (world, half width [px], has_masks): a random room with the default settings.

    most: greatest number of bodies. has_masks: whether some bodies are pixel masks.
    """
    rng = np.random.default_rng([34, seed])
    count, masks = int(rng.integers(50, most + 1)), seed % 3 != 0
    kinds = ["circle", "box", "capsule", "hull", "rounded", "cross", *(["disc mask", "sprite"] if masks else [])]
    columns = max(4, int(math.sqrt(count) * rng.uniform(0.6, 1.4)))
    half, rows = 20.0 * columns, -(-count // columns)
    world = World(**settings)
    for shape in (
        Polygon.box(2 * half + 2 * WALL, WALL, (0.0, WALL / 2)),
        Polygon.box(WALL, 80.0 * rows + 400.0, (-half - WALL / 2, -40.0 * rows)),
        Polygon.box(WALL, 80.0 * rows + 400.0, (half + WALL / 2, -40.0 * rows)),
    ):
        world.add_body(shape, kind="static")
    for k in range(count):
        row, column = divmod(k, columns)
        world.add_body(
            *shapes_of(kinds[rng.integers(len(kinds))], rng),
            position=(40.0 * column - half + 20.0, -24.0 - 40.0 * row),
            angle=float(rng.uniform(0.0, math.tau)),
            velocity=tuple(rng.uniform(-60.0, 60.0, 2)),
            material=Material(
                friction=float(rng.choice([0.3, 0.6, 0.9])),
                restitution=float(rng.choice([0.0, 0.0, 0.3])),
                density=float(rng.choice([0.5, 1.0, 4.0])),
            ),
        )
    return world, half, masks


def energy(world, rows):
    """Return the mechanical energy of dynamic bodies, with the potential energy measured from y = 0.

    rows: rows of these bodies in world.bodies.
    """
    gravity = world.gravity
    moving = 0.5 * (
        rows["mass"] * (rows["vx"] ** 2 + rows["vy"] ** 2) + rows["inertia"] * rows["angular_velocity"] ** 2
    )
    return float((moving - rows["mass"] * (gravity[0] * rows["center_x"] + gravity[1] * rows["center_y"])).sum())


def play(seed, seconds=SECONDS, most=300, **settings):
    """Simulate the random room of a seed and return its figures. most: greatest number of bodies."""
    world, half, masks = room(seed, most, **settings)
    dynamic = world.bodies["kind"] == 2
    last = start = energy(world, world.bodies[dynamic])
    rise, pops, after, still = 0.0, 0, math.inf, 0
    for step in range(60 * seconds):
        world.step()
        rows = world.bodies[dynamic]
        now = energy(world, rows)
        rise, last = max(rise, now - last), now
        speeds = np.hypot(rows["vx"], rows["vy"])
        if still >= STILL:
            pops += int((speeds > POP).sum())
        still = still + 1 if speeds.max() < REST else 0
        if not rows["awake"].any():
            after = (step + 1) / 60.0
            break
    rows = world.bodies[dynamic]
    left = (np.abs(rows["center_x"]) > half) | (rows["center_y"] > 0.0) | ~np.isfinite(rows["center_x"])
    asleep = world.sleeping_contacts
    overlap = max(deepest(world), -float(asleep["separation"].min()) if len(asleep) else 0.0)
    return Found(
        int(dynamic.sum()), masks, int(left.sum()), pops, int(rows["awake"].sum()), after, overlap, rise / start
    )


PASSIVE = ("bowl", "eccentric disc", "balls", "boxes", "masks")


def passive(kind, seed, **settings):
    """Return a world of elastic, sliding or rolling bodies that keep their energy; they never sleep and start without
    overlap.
    """
    rng = np.random.default_rng([35, seed, PASSIVE.index(kind)])
    world = World(Effects.rigid_bodies().with_(sleeping=False), **settings)
    smooth = Material(friction=0.0, restitution=0.0 if kind == "bowl" else 1.0)
    if kind == "eccentric disc":
        world.add_body(Polygon.box(1e5, 40.0), position=(0.0, 20.0), kind="static")
        heavy = Circle(5.0, (0.0, 17.0)).with_(material=Material(density=60.0))
        world.add_body(Circle(25.0), heavy, position=(0.0, -25.0), angle=float(rng.uniform(0.2, 1.5)))
        return world
    if kind == "bowl":
        links = int(rng.choice([120, 240, 480]))
        rim = [(400.0 * math.cos(a), 400.0 * math.sin(a) - 400.0) for a in np.linspace(math.pi, 0.0, links + 1)]
        world.add_body(Chain(rim), kind="static", material=smooth)
        turn, r = float(rng.uniform(0.55, 0.85)) * math.pi, float(rng.uniform(8.0, 30.0))
        place = (399.5 - r) * math.cos(turn), (399.5 - r) * math.sin(turn) - 400.0
        world.add_body(Circle(r), position=place, material=smooth)
        return world
    corners = [(-200.0, -400.0), (200.0, -400.0), (200.0, 0.0), (-200.0, 0.0)]
    world.add_body(Chain(corners[::-1], loop=True), kind="static", material=smooth)
    kinds = {"balls": ["circle"], "boxes": ["box", "hull", "capsule"], "masks": ["disc mask", "sprite"]}[kind]
    for k in range(12):
        world.add_body(
            *shapes_of(kinds[rng.integers(len(kinds))], rng),
            position=(-120.0 + 80.0 * (k % 4), -60.0 - 100.0 * (k // 4)),
            angle=float(rng.uniform(0.0, math.tau)),
            velocity=tuple(rng.uniform(-100.0, 100.0, 2)),
            material=smooth,
        )
    return world


def most_energy(kind, seed, seconds, **settings):
    """Simulate a passive scene and return (greatest energy, greatest rise in a step), relative to the start energy."""
    world = passive(kind, seed, **settings)
    dynamic = world.bodies["kind"] == 2
    last = start = energy(world, world.bodies[dynamic])
    most = rise = 0.0
    for _ in range(60 * seconds):
        world.step()
        now = energy(world, world.bodies[dynamic])
        most, rise, last = max(most, now / start), max(rise, (now - last) / start), now
    return most, rise


if __name__ == "__main__":
    for number in range(int(sys.argv[1]), int(sys.argv[2])):
        print(number, play(number), flush=True)
