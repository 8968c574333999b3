"""Jointed bodies in metres (chains, beams, ragdolls), and measures of joint error and energy,
computed from body poses.
"""

import math

import numpy as np

from physics import Capsule, Circle, Drive, Filter, Polygon, Revolute
from tests.stability.piles import metres, pile_effects

ALONE = Filter(1, 0)  # bodies that pass through each other
GRAVITY = 9.8
BREADTH = 0.125  # [m] of the links of a chain
NAIVE = "iterative"  # the tier without exact trees


def jointed(solver="soft_step", gravity=(0.0, GRAVITY), tier="auto", effects=None, **options):
    """Return a world in metres for jointed bodies.

    tier: value of its `joint_solver`. effects: {name: value} of effects that differ from those of `pile_effects`.
    """
    world = metres(solver, gravity=gravity, effects=pile_effects(joints=True, **(effects or {})), **options)
    world.joint_solver = tier
    return world


def run(world, seconds, each=None):
    """Step a world for a duration [s]; each: function without arguments, called after every step."""
    for _ in range(round(seconds / world.dt)):
        world.step()
        if each is not None:
            each()


def named(figure, solver):
    """Return the name of a figure; the solver's name is appended unless it is "soft_step"."""
    return figure if solver == "soft_step" else f"{figure}, {solver}"


def energy(world, gravity=GRAVITY):
    """Return the kinetic plus potential energy of all dynamic bodies [J]. gravity: gravity of the world [m/s²]."""
    b = world.bodies[world.bodies["kind"] == 2]
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * gravity * b["center_y"]).sum())


class Gaps:
    """Position errors of pins, welds and rods [m], relative to the body poses at the creation of this object.

    No body may be added or removed afterwards.
    """

    def __init__(self, world):
        self.world = world
        joints = [joint for joint in map(world.joint, world.joints["id"].tolist()) if self._holds(joint)]
        self.rods = np.array([joint.kind == "Distance" for joint in joints])
        ends = [(joint.body_a, joint.anchor_a) for joint in joints] + [
            (joint.body_b, joint.anchor_b) for joint in joints
        ]
        fixed = len(world.bodies)  # the row of the world, see _poses
        self.rows = np.array([fixed if body is None else world.rows([body.id])[0] for body, _ in ends])
        x, y, cos, sin = self._poses()
        u, v = np.array([tuple(at) for _, at in ends]).T - (x, y)
        self.local = cos * u + sin * v, cos * v - sin * u
        self.lengths = self._apart()

    @staticmethod
    def _holds(joint):
        if joint.kind == "Distance":
            return joint.limits is not None and joint.limits[0] == joint.limits[1]
        return joint.kind in ("Revolute", "Weld")

    def _poses(self):
        """Return four arrays (x, y, cosine and sine of the angle) of the body at each joint end: all A ends, then all B
        ends.
        """
        b = self.world.bodies
        x, y, angle = (np.append(b[name], 0.0) for name in ("x", "y", "angle"))
        return x[self.rows], y[self.rows], np.cos(angle)[self.rows], np.sin(angle)[self.rows]

    def _apart(self):
        x, y, cos, sin = self._poses()
        u, v = self.local
        x, y, half = x + cos * u - sin * v, y + sin * u + cos * v, len(self.rods)
        return np.hypot(x[half:] - x[:half], y[half:] - y[:half])

    def worst(self):
        """Return the greatest position error of any joint now [m]."""
        apart = self._apart()
        return float(np.where(self.rods, np.abs(apart - self.lengths), apart).max())


class Worst:
    """Running maximum: each call passes a value, and `value` is the greatest of them, at least 0."""

    value = 0.0

    def __call__(self, value):
        self.value = max(self.value, float(value))


def worst_in(world, seconds):
    """Step a world for a duration [s] and return the greatest position error of any pin, weld or rod [m]."""
    gaps, worst = Gaps(world), Worst()
    run(world, seconds, lambda: worst(gaps.worst()))
    return worst.value


class Period:
    """Mean period [s] of a quantity that oscillates about 0, measured between its zero crossings from plus to minus.

    The object is called after each step of a world.
    """

    def __init__(self, world, value):
        self.world, self.value, self.before, self.crossings = world, value, value(), []

    def __call__(self):
        now = self.value()
        if self.before > 0.0 >= now:
            self.crossings.append(self.world.time + now / (self.before - now) * self.world.dt)
        self.before = now

    def mean(self):
        """Return the mean period [s]; NaN if fewer than two zero crossings were seen."""
        times = self.crossings
        return (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else math.nan


def rod(world, start, end, breadth=BREADTH, **more):
    """Add a thin box from point `start` to point `end` and return the body; it collides with nothing unless `more` says
    so.
    """
    (ax, ay), (bx, by) = start, end
    shape = Polygon.box(math.dist(start, end), breadth)
    turn = math.atan2(by - ay, bx - ax)
    return world.add_body(shape, position=((ax + bx) / 2, (ay + by) / 2), angle=turn, **{"filter": ALONE, **more})


def along(distance, angle):
    """Return the point at a distance from the origin; angle [rad] clockwise from the positive x axis."""
    return distance * math.cos(angle), distance * math.sin(angle)


def ragdoll(world, x, y, turn, friction=0.05):
    """Add a ragdoll and return its torso: a head, a torso, two arms and two legs on hinges with limits.

    (x, y): position of the torso. turn: angle of all parts [rad]. friction: friction torque of each hinge [N m].
    """
    torso = world.add_body(Capsule((0.0, -0.4), (0.0, 0.4), 0.2), position=(x, y), angle=turn)

    def limb(shape, local, low, high):
        at = torso.to_world(local)
        part = world.add_body(shape, position=at, angle=turn)
        world.add_joint(Revolute(torso, part, at=at, limits=(low, high), motor=Drive(0.0, max=friction)))

    limb(Circle(0.25, (0.0, -0.3)), (0.0, -0.5), -0.6, 0.6)
    for side in (-1, 1):
        limb(Capsule((0, 0), (0, 0.7), 0.12), (0.2 * side, -0.3), -2.5, 2.5)
        limb(Capsule((0, 0), (0, 0.7), 0.12), (0.15 * side, 0.5), -1.2, 1.2)
    return torso


def stairs(world, count, turn, friction=0.05):
    """Build eight stairs and a floor, and `count` ragdolls thrown at the stairs. Return the torsos.

    turn: phase [rad] that varies the angles of the ragdolls.
    """
    for k in range(8):
        world.add_body(Polygon.box(2.0, 0.6), position=(2.0 * k, 0.6 * k), kind="static")
    world.add_body(Polygon.box(120.0, 0.6), position=(20.0, 0.6 * 8), kind="static")
    torsos = []
    for k in range(count):
        x, y = -0.6 + 0.6 * k, -1.6 - 2.2 * (k % 2) + 0.18 * k
        torsos.append(ragdoll(world, x, y, 0.7 * math.sin(k + turn), friction))
        torsos[-1].velocity = 2.0, 0.0
    return torsos
