"""Bodies on joints in metres: chains, beams, bridges, and what is measured of them from their poses."""

import math

import numpy as np

from physics import Capsule, Circle, Drive, Filter, Polygon, Revolute
from tests.stability.piles import metres, pile_effects

ALONE = Filter(1, 0)  # bodies that pass through each other
GRAVITY = 9.8
BREADTH = 0.125  # [m] of the links of a chain
NAIVE = "iterative"  # the tier without exact trees


def jointed(solver="soft_step", gravity=(0.0, GRAVITY), tier="auto", effects=None, **options):
    """A world in metres whose bodies are held by joints; tier: its `joint_solver`; effects: changes of its effects."""
    world = metres(solver, gravity=gravity, effects=pile_effects(joints=True, **(effects or {})), **options)
    world.joint_solver = tier
    return world


def run(world, seconds, each=None):
    """Step for so many seconds; each(): called after every step."""
    for _ in range(round(seconds / world.dt)):
        world.step()
        if each is not None:
            each()


def named(figure, solver):
    """Return the name of a figure, with that of the solver if it is not the usual one."""
    return figure if solver == "soft_step" else f"{figure}, {solver}"


def energy(world, gravity=GRAVITY):
    """Return the kinetic and potential energy of all bodies [J]. gravity: gravity of the world [m/s²]."""
    b = world.bodies[world.bodies["kind"] == 2]
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * gravity * b["center_y"]).sum())


class Gaps:
    """The errors of pins, welds and rods [m], relative to the poses of their bodies when this object is made.

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
        """x, y, cosine and sine of the body of each end; A's ends, then B's."""
        b = self.world.bodies
        x, y, angle = (np.append(b[name], 0.0) for name in ("x", "y", "angle"))
        return x[self.rows], y[self.rows], np.cos(angle)[self.rows], np.sin(angle)[self.rows]

    def _apart(self):
        x, y, cos, sin = self._poses()
        u, v = self.local
        x, y, half = x + cos * u - sin * v, y + sin * u + cos * v, len(self.rods)
        return np.hypot(x[half:] - x[:half], y[half:] - y[:half])

    def worst(self):
        """The greatest error of any joint now."""
        apart = self._apart()
        return float(np.where(self.rods, np.abs(apart - self.lengths), apart).max())


class Worst:
    """The greatest of the values it is called with, and 0."""

    value = 0.0

    def __call__(self, value):
        self.value = max(self.value, float(value))


def worst_in(world, seconds):
    """Step for so many seconds and return the greatest error of any pin, weld or rod."""
    gaps, worst = Gaps(world), Worst()
    run(world, seconds, lambda: worst(gaps.worst()))
    return worst.value


class Period:
    """The mean period [s] of a value that is 0 in its middle, from its falling zeros after each step of a world."""

    def __init__(self, world, value):
        self.world, self.value, self.before, self.crossings = world, value, value(), []

    def __call__(self):
        now = self.value()
        if self.before > 0.0 >= now:
            self.crossings.append(self.world.time + now / (self.before - now) * self.world.dt)
        self.before = now

    def mean(self):
        """The period, nan for less than two zeros."""
        times = self.crossings
        return (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else math.nan


def rod(world, start, end, breadth=BREADTH, **more):
    """A thin box from one point to another."""
    (ax, ay), (bx, by) = start, end
    shape = Polygon.box(math.dist(start, end), breadth)
    turn = math.atan2(by - ay, bx - ax)
    return world.add_body(shape, position=((ax + bx) / 2, (ay + by) / 2), angle=turn, **{"filter": ALONE, **more})


def along(distance, angle):
    """The point at a distance from the origin, at an angle clockwise from the right."""
    return distance * math.cos(angle), distance * math.sin(angle)


def ragdoll(world, x, y, turn, friction=0.05):
    """A head, a torso, two arms and two legs on hinges with limits and a friction torque [N m]; returns the torso."""
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
    """Build eight steps and a floor, and `count` ragdolls that are thrown at them. Returns the torsos.

    turn: angle of all ragdolls [rad].
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
