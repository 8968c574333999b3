"""Linkages under load, as worlds of this project: chains, a bridge, and an arm of welded rods.

A linkage consists of rods and balls that are connected by joints, and hangs on a base. The base is a body that stays in
place and may rotate at a constant speed. The bodies pass through each other. Lengths are in pixels, 32 per metre.

The class Gaps measures how far the joints come apart.
"""

from collections.abc import Sequence
from math import atan2, cos, dist, radians, sin
from typing import NamedTuple

import numpy as np

from game.report.piles import GRAVITY
from physics import Circle, Effects, Filter, Polygon, Revolute, Weld, World
from physics.annotations import JointSolverName, Substeps

METER = 32.0  # [px]
THICK = METER / 4  # of a rod
RADIUS = METER / 2  # of a ball
BASE = 0  # index of the base among the bodies
EFFECTS = Effects(response=True, gravity=True, rotation=True, stacking=True, joints=True)
ALONE = Filter(1, 0)
SPIN = 0.5  # [rad/s] of the arm of welds
FASTEST = 4.0 * METER  # [px/s] of the ball of a bridge

Pair = tuple[float, float]


class Pin(NamedTuple):
    """A joint. a, b: indices of its two bodies; at: the point (x, y) [px] at which they are joined at the start."""

    a: int
    b: int
    at: Pair


class Linkage(NamedTuple):
    """Rods and balls, and the joints between them. The order of the bodies is: base, rods, balls.

    rods: (start, end) of each rod [px]; balls: (centre [px], mass in masses of a rod, velocity to the right [px/s]) of
    each ball; judged: the pins whose gap is the error.
    """

    rods: Sequence[tuple[Pair, Pair]]
    balls: Sequence[tuple[Pair, float, float]]
    joints: Sequence[Pin]
    judged: Sequence[Pin]
    welded: bool = False  # joints that keep the angle, too
    spin: float = 0.0  # [rad/s] of the base


def along(distance: float, angle: float, start: Pair = (0.0, 0.0)) -> Pair:
    """Return the point at `distance` [px] from `start`, in the direction `angle` [rad], clockwise from the right."""
    return start[0] + distance * cos(angle), start[1] + distance * sin(angle)


def _row_of_rods(places: Sequence[Pair]) -> tuple[list[tuple[Pair, Pair]], list[Pin]]:
    """Return (rods, pins) of rods between consecutive points. The first pin joins the first rod to the base."""
    rods = list(zip(places, places[1:], strict=False))
    return rods, [Pin(k, k + 1, at) for k, (at, _) in enumerate(rods)]


def chain(ratio: float, share: float, count: int = 20) -> Linkage:
    """Return a straight chain of `count` rods with a ball at its end. The ball has the mass of `ratio` rods.

    share: selects one of the cases, 0..1. The angle of the chain at the start grows with it, from level to 50 degrees
    down.
    """
    angle = radians(50.0 * share)
    rods, joints = _row_of_rods([along(METER * k, angle) for k in range(count + 1)])
    joints.append(Pin(count, count + 1, along(METER * count, angle)))
    return Linkage(rods, [(along(METER * (count + 0.5), angle), ratio, 0.0)], joints, joints)


def bridge(ratio: float, share: float, count: int = 20) -> Linkage:
    """Return a bridge of `count` rods in the form of a V, with a ball in its middle.

    The ball has the mass of `ratio` rods. share: selects one of the cases, 0..1. The sideways velocity of the ball at
    the start grows with it, from 0 to FASTEST.
    """
    turn, places = radians(20.0), [(0.0, 0.0)]
    for k in range(count):
        places.append(along(METER, turn if k < count / 2 else -turn, places[-1]))
    rods, joints = _row_of_rods(places)
    middle = count // 2
    joints += [Pin(BASE, count, places[-1]), Pin(middle + 1, count + 1, places[middle])]
    return Linkage(rods, [(places[middle], ratio, FASTEST * share)], joints, joints)


def arm(share: float, count: int = 8) -> Linkage:
    """Return an arm of `count` welded rods on a rotating base.

    The error of this linkage is the distance of the arm's tip from its ideal position. share: selects one of the cases,
    0..1. The angle of the arm at the start grows with it, from level to 320 degrees.
    """
    angle = radians(320.0 * share)
    rods, joints = _row_of_rods([along(METER * k, angle) for k in range(count + 1)])
    return Linkage(rods, [], joints, [Pin(BASE, count, along(METER * count, angle))], welded=True, spin=SPIN)


def world_of(linkage: Linkage, tier: JointSolverName, substeps: Substeps) -> World:
    """Return a world with the linkage. tier: joint solver of the world; substeps: its number of substeps."""
    world = World(EFFECTS, gravity=(0.0, GRAVITY), substeps=substeps)
    world.joint_solver = tier
    base = world.add_body(Circle(RADIUS), kind="kinematic", angular_velocity=linkage.spin, filter=ALONE)
    bodies = [base]
    for start, end in linkage.rods:
        shape = Polygon.box(dist(start, end), THICK)
        bodies.append(world.add_body(shape, position=middle(start, end), angle=turn_of(start, end), filter=ALONE))
    for place, ratio, speed in linkage.balls:
        mass = ratio * bodies[1].mass
        bodies.append(world.add_body(Circle(RADIUS), position=place, mass=mass, velocity=(speed, 0.0), filter=ALONE))
    kind = Weld if linkage.welded else Revolute
    for a, b, at in linkage.joints:
        world.add_joint(kind(bodies[a], bodies[b], at=at))
    return world


def middle(start: Pair, end: Pair) -> Pair:
    """Return the point halfway between two points."""
    return (start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0


def turn_of(start: Pair, end: Pair) -> float:
    """Return the direction from one point to another, as an angle [rad]."""
    return atan2(end[1] - start[1], end[0] - start[0])


def poses_in(world: World) -> np.ndarray:
    """Return x [px], y [px] and angle [rad] of all bodies, as an array of shape (3, bodies)."""
    return np.array([world.bodies[name] for name in ("x", "y", "angle")])


class Gaps:
    """Measurement of the gaps of a linkage's judged pins, of which the widest is the error.

    The poses of the bodies may come from any physics engine.
    """

    def __init__(self, linkage: Linkage, poses: np.ndarray) -> None:
        """Store the position of each judged pin in the frames of its two bodies.

        poses: poses of the bodies at the start, in the form of poses_in().
        """
        pins = linkage.judged
        self.rows = np.array([pin.a for pin in pins] + [pin.b for pin in pins])
        x, y, angle = poses[:, self.rows]
        u, v = np.array([pin.at for pin in pins] * 2).T - (x, y)
        self.local = np.cos(angle) * u + np.sin(angle) * v, np.cos(angle) * v - np.sin(angle) * u

    def widest(self, poses: np.ndarray) -> float:
        """Return the widest gap [px] of the judged pins. poses: current poses, in the form of poses_in()."""
        x, y, angle = poses[:, self.rows]
        u, v = self.local
        x, y = x + np.cos(angle) * u - np.sin(angle) * v, y + np.sin(angle) * u + np.cos(angle) * v
        half = len(self.rows) // 2
        return float(np.hypot(x[half:] - x[:half], y[half:] - y[:half]).max())
