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
    """A figure's name: that of the solver is told where it is not the usual one."""
    return figure if solver == "soft_step" else f"{figure}, {solver}"


def energy(world, gravity=GRAVITY):
    """Kinetic and potential energy [J] of all bodies; gravity: of the world [m/s²]."""
    b = world.bodies[world.bodies["kind"] == 2]
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * gravity * b["center_y"]).sum())


class Gaps:
    """The errors of pins, welds and rods [m], from the poses of their bodies: none when this is made."""

    def __init__(self, world):
        self.world = world
        joints = [joint for joint in map(world.joint, world.joints["id"].tolist()) if self._holds(joint)]
        self.rods = np.array([joint.kind == "Distance" for joint in joints])
        self.sides = [self._side([each(joint) for joint in joints]) for each in (self._first, self._second)]
        self.lengths = np.hypot(*self._apart().T)

    @staticmethod
    def _holds(joint):
        if joint.kind == "Distance":
            return joint.limits is not None and joint.limits[0] == joint.limits[1]
        return joint.kind in ("Revolute", "Weld")

    @staticmethod
    def _first(joint):
        return joint.body_a, joint.anchor_a

    @staticmethod
    def _second(joint):
        return joint.body_b, joint.anchor_b

    def _side(self, ends):
        """(ids of bodies, -1 for the world; anchors (n, 2) in the bodies' space) of bodies and points of the world."""
        ids = np.array([-1 if body is None else body.id for body, _ in ends])
        points = np.array([tuple(at) for _, at in ends], float)
        x, y, cos, sin = self._poses(ids)
        across = points - np.column_stack([x, y])
        local = np.column_stack([cos * across[:, 0] + sin * across[:, 1], cos * across[:, 1] - sin * across[:, 0]])
        return ids, local

    def _poses(self, ids):
        held = ids >= 0
        rows = self.world.bodies[self.world.rows(ids[held])]
        x, y, angle = (np.zeros(len(ids)) for _ in range(3))
        x[held], y[held], angle[held] = rows["x"], rows["y"], rows["angle"]
        return x, y, np.cos(angle), np.sin(angle)

    def _apart(self):
        ends = []
        for ids, local in self.sides:
            x, y, cos, sin = self._poses(ids)
            ends.append(
                np.column_stack([x + cos * local[:, 0] - sin * local[:, 1], y + sin * local[:, 0] + cos * local[:, 1]])
            )
        return ends[1] - ends[0]

    def worst(self):
        """The greatest error of any joint now."""
        lengths = np.hypot(*self._apart().T)
        return float(np.where(self.rods, np.abs(lengths - self.lengths), lengths).max())


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
    """Eight steps and a floor, and so many ragdolls that are thrown at them; turn: of all [rad]. Returns the torsos."""
    for k in range(8):
        world.add_body(Polygon.box(2.0, 0.6), position=(2.0 * k, 0.6 * k), kind="static")
    world.add_body(Polygon.box(120.0, 0.6), position=(20.0, 0.6 * 8), kind="static")
    torsos = []
    for k in range(count):
        x, y = -0.6 + 0.6 * k, -1.6 - 2.2 * (k % 2) + 0.18 * k
        torsos.append(ragdoll(world, x, y, 0.7 * math.sin(k + turn), friction))
        torsos[-1].velocity = 2.0, 0.0
    return torsos
