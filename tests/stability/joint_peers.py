"""Pendulums, chains and beams in this engine and in pymunk, compared in docs/stability.md.

`python -m tests.stability.joint_peers` measures and writes docs/stability_joint_peers.json; it needs the extra `bench`.
Lengths are in metres, 60 Hz, gravity 9.8. pymunk runs with ten iterations, in one step of 1/60 s and in four of 1/240
s. The figures of Box2D are quoted: v3 at commit 617d32a, native, with 4 substeps, in the same scenes.
"""

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from physics import Circle, Effects, Filter, Polygon, Revolute, Weld, World
from tests.stability.jointed import Gaps, energy

KEPT = Path(__file__).resolve().parents[2] / "docs" / "stability_joint_peers.json"
GRAVITY, BREADTH, STEP = 9.8, 0.125, 1.0 / 60.0
# row: (scene, what is measured, unit, goal, Box2D's figure)
ROWS = {
    "pendulum period": ("a disc 2 m from its pin, let go at 1 rad, 60 s", "error of the period", "%", "0.01", "0.003"),
    "pendulum energy": ("", "energy left, of the fall", "", "0.999 to 1.001", "0.999"),
    "pendulum pin": ("", "error of the pin", "mm", "0.1", "0.38"),
    "double energy": ("a double pendulum, let go level, 30 s", "change of the energy, of the fall", "%", "2", "-9.2"),
    "double pin": ("", "error of a pin", "mm", "0.5", "2.9"),
    "chain 1 swing": ("30 links of 1 m and a ball of one link's mass", "greatest gap of the swing", "mm", "5", "95"),
    "chain 1 rest": ("", "gap after 20 s", "mm", "1", "14.5"),
    "chain 100 swing": ("the same with a ball of 100 links", "greatest gap of the swing", "mm", "5", "76"),
    "chain 100 rest": ("", "gap after 20 s", "mm", "1", "9.4"),
    "chain 1000 swing": ("the same with a ball of 1,000 links", "greatest gap of the swing", "mm", "20", "906"),
    "chain 1000 rest": ("", "gap after 20 s", "mm", "2", "41"),
    "cantilever": ("eight beams of 1 m, welded to the world, 5 s", "the tip off, at most", "mm", "20", "461"),
}
ENGINES: Mapping[str, Mapping[str, Any]] = {
    "default settings": {},
    "4 substeps": {"substeps": 4},
    "iterative, 4 substeps": {"substeps": 4, "tier": "iterative"},
    "sequential_impulse": {"solver": "sequential_impulse"},
}
PEERS = {"pymunk": 1, "pymunk, 4 steps": 4}


class Hitbox:
    """A world of this engine in metres."""

    def __init__(self, tier: str = "auto", **settings: Any):
        effects = Effects.rigid_bodies().with_(joints=True, sleeping=False)
        self.world = World(effects, gravity=(0, GRAVITY), pixels_per_meter=1.0, **settings)
        self.world.joint_solver = tier
        self.gaps: Any = None

    def disc(self, radius, place, mass=None):
        """Add a disc with its centre at `place` and return the body. mass [kg]; None: area times density."""
        return self.world.add_body(Circle(radius), position=place, mass=mass, filter=Filter(1, 0))

    def rod(self, start, end, breadth=BREADTH):
        """Add a box from point `start` to point `end` and return the body; its mass equals its area."""
        middle, turn = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), angle_of(start, end)
        shape = Polygon.box(math.dist(start, end), breadth)
        return self.world.add_body(shape, position=middle, angle=turn, filter=Filter(1, 0))

    def pin(self, a, b, at):
        """Pin two bodies together at the point `at`; a body of None stands for the world."""
        self.world.add_joint(Revolute(a, b, at=at))

    def weld(self, a, b, at):
        """Weld two bodies together at the point `at`; a body of None stands for the world."""
        self.world.add_joint(Weld(a, b, at=at))

    def step(self):
        """Advance the world by 1/60 s."""
        self.gaps = self.gaps or Gaps(self.world)
        self.world.step(STEP)

    def gap(self):
        """Return the greatest position error of any joint now [m]."""
        return self.gaps.worst()

    def energy(self):
        """Return the energy of all bodies [J]."""
        return energy(self.world, GRAVITY)

    def masses(self):
        """Return the masses of all bodies, in the order in which they were added [kg]."""
        return self.world.bodies["mass"].tolist()


class Pymunk:
    """A pymunk space in metres, without a limit on the correction speed of joints."""

    def __init__(self, steps: int):
        import pymunk

        self.pymunk, self.space, self.steps = pymunk, pymunk.Space(), steps
        self.space.gravity, self.space.iterations = (0, GRAVITY), 10
        self.pins, self.order = [], []

    def _add(self, body, shape, place, turn):
        body.position, body.angle = place, turn
        shape.filter = self.pymunk.ShapeFilter(group=1)
        self.space.add(body, shape)
        self.order.append(body)
        return body

    def disc(self, radius, place, mass=None):
        """Add a disc with its centre at `place` and return the body. mass [kg]; None: its area."""
        mass = math.pi * radius**2 if mass is None else mass
        body = self.pymunk.Body(mass, self.pymunk.moment_for_circle(mass, 0, radius))
        return self._add(body, self.pymunk.Circle(body, radius), place, 0.0)

    def rod(self, start, end, breadth=BREADTH):
        """Add a box from point `start` to point `end` and return the body; its mass equals its area."""
        size = math.dist(start, end), breadth
        body = self.pymunk.Body(size[0] * breadth, self.pymunk.moment_for_box(size[0] * breadth, size))
        middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        return self._add(body, self.pymunk.Poly.create_box(body, size), middle, angle_of(start, end))

    def pin(self, a, b, at):
        """Pin two bodies together at the point `at`; a body of None stands for the world."""
        still = self.space.static_body
        joint = self.pymunk.PivotJoint(a or still, b or still, at)
        self.pins.append(joint)
        self.space.add(joint)

    def weld(self, a, b, at):
        """Weld two bodies together at the point `at` by a pivot joint and a gear joint; None stands for the world."""
        self.pin(a, b, at)
        still = self.space.static_body
        a, b = a or still, b or still
        self.space.add(self.pymunk.GearJoint(a, b, b.angle - a.angle, 1.0))

    def step(self):
        """Advance the space by 1/60 s."""
        for _ in range(self.steps):
            self.space.step(STEP / self.steps)

    def gap(self):
        """Return the greatest position error of any pin now [m]."""
        return max(
            joint.a.local_to_world(joint.anchor_a).get_distance(joint.b.local_to_world(joint.anchor_b))
            for joint in self.pins
        )

    def energy(self):
        """Return the energy of all bodies [J]."""
        return sum(each.kinetic_energy / 2.0 - each.mass * GRAVITY * each.position.y for each in self.order)

    def masses(self):
        """Return the masses of all bodies, in the order in which they were added [kg]."""
        return [each.mass for each in self.order]


def angle_of(start, end):
    """Return the angle of the vector from `start` to `end` [rad]."""
    return math.atan2(end[1] - start[1], end[0] - start[0])


def pendulum(engine):
    """Simulate a pendulum in an engine and return {row: figure} for its rows of the table ROWS."""
    from tests.stability.test_n_joints import agm

    at = 2.0 * math.sin(1.0), 2.0 * math.cos(1.0)
    bob = engine.disc(0.25, at)
    engine.pin(None, bob, (0.0, 0.0))
    mass, length = engine.masses()[0], 2.0 + 0.25**2 / 2.0 / 2.0
    start, crossings, before, worst = engine.energy(), [], at[0], 0.0
    for n in range(3600):
        engine.step()
        now, worst = bob.position.x, max(worst, engine.gap())
        if before > 0.0 >= now:
            crossings.append((n + before / (before - now)) * STEP)
        before = now
    exact = 2.0 * math.pi * math.sqrt(length / GRAVITY) / agm(1.0, math.cos(0.5))
    period = (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    fall = mass * GRAVITY * 2.0 * (1.0 - math.cos(1.0))
    return {
        "pendulum period": 100.0 * (period / exact - 1.0),
        "pendulum energy": 1.0 + (engine.energy() - start) / fall,
        "pendulum pin": 1e3 * worst,
    }


def double_pendulum(engine):
    """Simulate a double pendulum in an engine and return {row: figure} for its rows of the table ROWS."""
    first, second = engine.rod((0.0, 0.0), (1.0, 0.0)), engine.rod((1.0, 0.0), (2.0, 0.0))
    engine.pin(None, first, (0.0, 0.0))
    engine.pin(first, second, (1.0, 0.0))
    masses, start, worst = engine.masses(), engine.energy(), 0.0
    for _ in range(1800):
        engine.step()
        worst = max(worst, engine.gap())
    fall = GRAVITY * (0.5 * masses[0] + 1.5 * masses[1])
    return {"double energy": 100.0 * (engine.energy() - start) / fall, "double pin": 1e3 * worst}


def chain(engine, ratio):
    """Simulate a hanging chain whose end ball has `ratio` times the mass of a link; return {row: figure}."""
    before = None
    for k in range(30):
        link = engine.rod((k, 0.0), (k + 1.0, 0.0))
        engine.pin(before, link, (float(k), 0.0))
        before = link
    ball = engine.disc(0.5, (30.5, 0.0), ratio * engine.masses()[0])
    engine.pin(before, ball, (30.0, 0.0))
    worst = 0.0
    for n in range(1200):
        engine.step()
        worst = max(worst, engine.gap()) if n < 720 else worst
    return {f"chain {ratio} swing": 1e3 * worst, f"chain {ratio} rest": 1e3 * engine.gap()}


def cantilever(engine):
    """Simulate a cantilever of eight welded beams and return {row: greatest displacement of its end [mm]}."""
    before, worst = None, 0.0
    for k in range(8):
        beam = engine.rod((k, 0.0), (k + 1.0, 0.0), 0.25)
        engine.weld(before, beam, (float(k), 0.0))
        before = beam
    for _ in range(300):
        engine.step()
        (x, y), turn = before.position, before.angle
        worst = max(worst, math.dist((x + 0.5 * math.cos(turn), y + 0.5 * math.sin(turn)), (8.0, 0.0)))
    return {"cantilever": 1e3 * worst}


SCENES: tuple[Callable[[Any], Mapping[str, float]], ...] = (
    pendulum,
    double_pendulum,
    lambda engine: chain(engine, 1),
    lambda engine: chain(engine, 100),
    lambda engine: chain(engine, 1000),
    cantilever,
)


def measure():
    """Run all scenes in all engines and return {row: {engine: figure}}."""
    makers = {name: lambda settings=settings: Hitbox(**settings) for name, settings in ENGINES.items()}
    makers |= {name: lambda steps=steps: Pymunk(steps) for name, steps in PEERS.items()}
    found = {row: {} for row in ROWS}
    for scene in SCENES:
        for name, make in makers.items():
            for row, value in scene(make()).items():
                found[row][name] = float(f"{value:.3g}")
    return found


def section():
    """Return the Markdown of the table "Joints beside the peers", made from the stored figures."""
    kept = json.loads(KEPT.read_text())
    names = [*ENGINES, *PEERS]
    lines = [
        "## Joints beside the peers\n",
        "Measured in one run by `python -m tests.stability.joint_peers`, at 60 Hz. pymunk takes ten iterations a step.",
        "Box2D v3 (617d32a, native, 4 substeps) is quoted from the measurement that the goals were set by.\n",
        f"| scene | figure | goal | {' | '.join(names)} | Box2D |",
        "|" + "---|" * (len(names) + 4),
    ]
    for row, (what, figure, unit, goal, quoted) in ROWS.items():
        cells = " | ".join(f"{kept[row][name]:.3g}" for name in names)
        unit = f" [{unit}]" if unit else ""
        lines.append(f"| {what} | {figure}{unit} | {goal} | {cells} | {quoted} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    KEPT.write_text(json.dumps(measure(), indent=1) + "\n")
    print(section())
