"""Scenes of single bodies with a known closed-form motion, and a drum without one.

Slopes, a rotating plate, bounces, impacts, seams, a tumbler and free rotation.
"""

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
    """Return a scene with a box on a slope of 30 degrees. share: its friction divided by the least friction that holds
    it.
    """
    friction = share * math.tan(SLOPE)
    x, y = 0.5 * math.sin(SLOPE), -0.5 * math.cos(SLOPE)
    return Scene((floor(friction, angle=SLOPE), Solid(UNIT, x, y, angle=SLOPE, friction=friction)), seconds)


def plate(height, friction):
    """Return a scene with a plate that turns at 5 degrees a second, and a box 1 m wide and `height` m high on its
    centre.
    """
    turning = Solid((box(40.0, 1.0),), 0.0, 0.5, spin=PLATE_SPIN, kind="kinematic", friction=friction)
    return Scene((turning, Solid((box(1.0, height),), 0.0, -0.5 * height, friction=friction)), 8.0)


def bounce(restitution, seconds):
    """Return a scene in which a ball with a radius of BALL falls from a height of two metres."""
    ball = Solid((disc(BALL),), 0.0, -BALL - DROP, restitution=restitution)
    return Scene((floor(restitution=restitution), ball), seconds)


def oblique_pairs():
    """Return (offset in diameters, speed [m/s], extra distance at the start [m]) of 24 oblique impacts.

    There are eight offsets at each of three speeds. The random extra distance varies the phase of the impact within a
    step.
    """
    chance = np.random.default_rng(5)
    return [
        (0.1 + 0.8 * k / 7, speed, float(chance.uniform()) * speed / 60) for speed in (2.5, 5.0, 20.0) for k in range(8)
    ]


def oblique():
    """Return a scene of pairs of equal frictionless discs, 1 m wide, without gravity.

    One disc of each pair flies towards the other, offset from its centre.
    """
    solids = []
    for k, (offset, speed, further) in enumerate(oblique_pairs()):
        y = 100.0 * k
        solids.append(Solid((disc(0.5),), -1.5 - further, y, vx=speed, friction=0.0, restitution=1.0))
        solids.append(Solid((disc(0.5),), 0.0, y + offset, friction=0.0, restitution=1.0))
    return Scene(tuple(solids), 1.5, gravity=0.0)


def seams(seed):
    """Return a scene in which a box slides over a floor of single boxes and should stop after forty of them.

    The sliding box is the last body. Each seed has another box width and another start position.
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
    """Return a scene in which a box slides on a floor in one piece, without seams."""
    box_ = Solid(UNIT, 0.0, -0.5, vx=SLIDE_SPEED, friction=SEAM_FRICTION)
    return Scene((floor(SEAM_FRICTION), box_), 5.0)


def tumbler():
    """Return a scene of 144 discs and boxes of half a metre in a square drum that turns at 50 degrees a second.

    The drum is body 0.
    """
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
    """Return a scene with a rod that rotates in free flight."""
    return Scene((Solid((box(2.0, 0.2),), 0.0, 0.0, spin=SPIN),), 10.0, gravity=0.0)
