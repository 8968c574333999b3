"""Single bodies whose motion is known in closed form, and a drum whose is not: slopes, a turning plate, bounces, blows,
seams, a tumbler, free spin."""

import math

import numpy as np

from tests.stability.study.scene import GRAVITY, Scene, Solid, box, disc, floor

UNIT = (box(1.0, 1.0),)
SLOPE = math.radians(30.0)
PLATE_FRICTION, PLATE_SPIN = 0.5, math.radians(5.0)  # [rad/s]
BALL, DROP = 0.5, 2.0  # [m] radius; height of its lowest point
SEAMS, SEAM_FRICTION = 40, 0.2
TILES = (1.0, 0.75, 0.5, 0.4, 0.25)  # [m] widths
SLIDE_SPEED = 8.0  # [m/s]
SPIN = 100.0  # [rad/s]
ROOM, WALL = 10.0, 0.5  # [m] of the tumbler: between the middles of opposite walls; their thickness


def slope(share, seconds):
    """Return a scene with a box on a slope of 30 degrees. share: its friction over the least that holds it."""
    friction = share * math.tan(SLOPE)
    x, y = 0.5 * math.sin(SLOPE), -0.5 * math.cos(SLOPE)
    return Scene((floor(friction, angle=SLOPE), Solid(UNIT, x, y, angle=SLOPE, friction=friction)), seconds)


def plate(height, friction):
    """A plate that turns by 5 degrees a second, on its middle a box 1 m wide and this high."""
    turning = Solid((box(40.0, 1.0),), 0.0, 0.5, spin=PLATE_SPIN, kind="kinematic", friction=friction)
    return Scene((turning, Solid((box(1.0, height),), 0.0, -0.5 * height, friction=friction)), 8.0)


def bounce(restitution, seconds):
    """A ball of 1 m falls two metres."""
    ball = Solid((disc(BALL),), 0.0, -BALL - DROP, restitution=restitution)
    return Scene((floor(restitution=restitution), ball), seconds)


def oblique_pairs():
    """Return (offset in diameters, speed [m/s], extra distance at the start [m]) of 24 glancing blows.

    Eight offsets at each of three speeds. The extra distance is random, so that they meet at different times in a step.
    """
    chance = np.random.default_rng(5)
    return [
        (0.1 + 0.8 * k / 7, speed, float(chance.uniform()) * speed / 60) for speed in (2.5, 5.0, 20.0) for k in range(8)
    ]


def oblique():
    """Pairs of equal discs of 1 m without friction, one of each flying past the middle of the other. No gravity."""
    solids = []
    for k, (offset, speed, further) in enumerate(oblique_pairs()):
        y = 100.0 * k
        solids.append(Solid((disc(0.5),), -1.5 - further, y, vx=speed, friction=0.0, restitution=1.0))
        solids.append(Solid((disc(0.5),), 0.0, y + offset, friction=0.0, restitution=1.0))
    return Scene(tuple(solids), 1.5, gravity=0.0)


def seams(seed):
    """A box slides over a floor of single boxes and ought to stop after forty of them. It is the last body.

    Each seed has boxes of another width, and starts elsewhere on one.
    """
    width, start = TILES[seed % len(TILES)], float(np.random.default_rng(seed).uniform())
    speed = math.sqrt(2 * SEAM_FRICTION * GRAVITY * SEAMS * width)
    tile, around = (box(width, 1.0),), math.ceil(1.0 / width) + 1
    tiles = [
        Solid(tile, (k + start) * width, 0.5, kind="static", friction=SEAM_FRICTION)
        for k in range(-around, SEAMS + around)
    ]
    return Scene((*tiles, Solid(UNIT, 0.0, -0.5, vx=speed, friction=SEAM_FRICTION)), 7.0)


def slide():
    """The same on a floor in one piece."""
    box_ = Solid(UNIT, 0.0, -0.5, vx=SLIDE_SPEED, friction=SEAM_FRICTION)
    return Scene((floor(SEAM_FRICTION), box_), 5.0)


def tumbler():
    """144 discs and boxes of half a metre in a square drum that turns by 50 degrees a second. The drum is body 0."""
    half, across = 0.5 * ROOM, ROOM
    walls = (
        box(WALL, across, half, 0.0),
        box(WALL, across, -half, 0.0),
        box(across, WALL, 0.0, half),
        box(across, WALL, 0.0, -half),
    )
    solids = [Solid(walls, 0.0, 0.0, spin=math.radians(50.0), kind="kinematic")]
    for row in range(12):
        for column in range(12):
            part = disc(0.25) if (row + column) % 2 else box(0.5, 0.5)
            solids.append(Solid((part,), -3.5 + 0.62 * column, -3.5 + 0.62 * row))
    return Scene(tuple(solids), 20.0)


def free_spin():
    """A rod spins in free flight."""
    return Scene((Solid((box(2.0, 0.2),), 0.0, 0.0, spin=SPIN),), 10.0, gravity=0.0)
