"""The bodies of lab/broadphases: four layouts with their motions. The same seed gives the same bodies."""

from random import Random

import numpy as np

from physics import Circle, Effects, World

LAYOUTS = ("even", "ground", "still", "giant")
WIDTH, HEIGHT = 1580.0, 1080.0  # [px] of the world
RADIUS, GIANT = 7.0, 260.0  # [px]
FAST, SLOW = 90.0, 20.0  # [px/s]
MOVING_SHARE = 0.05  # of the bodies in the "still" layout


def populate(world, layout, count, seed):
    """Add bodies to a world: `count` small discs, and the giant disc of the layout "giant".

    The bodies depend only on layout (one of LAYOUTS), count and seed.
    """
    random = Random(f"{seed} {layout} {count}")
    positions = np.array([_place(random, layout) for _ in range(count)])
    speed = SLOW if layout == "ground" else FAST
    velocities = np.array([(random.uniform(-speed, speed), random.uniform(-speed, speed)) for _ in range(count)])
    if layout == "ground":
        velocities[:, 1] = 0.0
    moving = count if layout != "still" else max(1, int(count * MOVING_SHARE))
    if layout == "giant":
        world.add_body(Circle(GIANT), position=(WIDTH / 2, HEIGHT / 2), velocity=(SLOW, SLOW))
    world.add_bodies(Circle(RADIUS), positions[:moving], velocities[:moving])
    if moving < count:
        world.add_bodies(Circle(RADIUS), positions[moving:], kind="static")


def _place(random, layout):
    x = random.uniform(RADIUS, WIDTH - RADIUS)
    if layout == "ground":
        return x, HEIGHT - RADIUS - min(abs(random.gauss(0.0, 60.0)), HEIGHT / 2)
    return x, random.uniform(RADIUS, HEIGHT - RADIUS)


def snapshot_of(effects, seed, layout, count):
    """Return the snapshot of a world with `count` bodies of a layout, before its first step.

    effects: names of the world's effects.
    """
    world = World(Effects.named(effects))
    populate(world, layout, count, seed)
    return world.snapshot()
