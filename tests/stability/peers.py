"""Doors, bowls, eccentric wheels and seams in this engine and in pymunk, compared in docs/stability.md.

`python -m tests.stability.peers` measures and writes docs/stability_peers.json; it needs the extra `bench`. Lengths are
in metres, 60 Hz; pymunk takes four steps of 1/240 s with 10 iterations and a slop of 0.005 m.
"""

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from physics import Chain, Circle, Effects, Material, Polygon, World

KEPT = Path(__file__).resolve().parents[2] / "docs" / "stability_peers.json"
GRAVITY = 9.8
ENGINES: Mapping[str, Mapping[str, Any]] = {
    "default settings": {},
    "4 substeps": {"substeps": 4},
    "sequential_impulse": {"solver": "sequential_impulse"},
}
# name: (what happens, figure, what is right, a peer's figure that a source quotes)
ROWS = {
    "door": (
        "a door closes at 7.5 m/s on a crate of 0.6 m that stands on the floor",
        "greatest speed of the crate [m/s]",
        "<= 7.5 and the push-out speed, 3",
        "",
    ),
    "bowl": (
        "a disc slides in a half circle of 240 links without friction, a minute",
        "greatest energy, of that at the start",
        "<= 1.005",
        "",
    ),
    "wheel": (
        "a disc with a weight off its centre rolls to and fro, 40 s",
        "greatest energy of the last ten seconds, of the first",
        "<= 1.005",
        "",
    ),
    "seams": (
        "a ball slides over 28 flush boxes of 0.5 m at 5.5 m/s without friction",
        "least speed, of that at the start",
        "1",
        "a slide over box seams loses 61 % of its way (Box2D 3.2, 80 % Rapier 0.21)",
    ),
}


class Hitbox:
    """A world of this engine in metres."""

    def __init__(self, settings: Mapping[str, Any]):
        effects = Effects.rigid_bodies().with_(sleeping=False)
        self.world = World(effects, gravity=(0, GRAVITY), pixels_per_meter=1.0, **settings)

    def box(self, width, height, place, kind="static", friction=0.6, velocity=(0, 0)):
        """Add a box with its centre at `place` and return the body."""
        shape, material = Polygon.box(width, height), Material(friction=friction)
        return self.world.add_body(shape, position=place, kind=kind, material=material, velocity=velocity)

    def chain(self, points):
        """Add static ground without friction along a polyline."""
        self.world.add_body(Chain(points), kind="static", material=Material(friction=0.0))

    def disc(self, radius, place, friction, velocity=(0, 0), weight=None):
        """Add a disc of density 1 and return the body.

        weight: None, or (radius, distance below the centre, density) of a second disc fixed within it. A disc with a
        weight starts at an angle of 0.5 rad.
        """
        shapes = [Circle(radius)]
        if weight is not None:
            shapes.append(Circle(weight[0], (0.0, weight[1])).with_(material=Material(weight[2], friction)))
        angle = 0.5 if weight else 0.0
        material = Material(friction=friction)
        return self.world.add_body(*shapes, position=place, angle=angle, velocity=velocity, material=material)

    def step(self):
        """Advance the world by 1/60 s."""
        self.world.step()

    def stop(self, body):
        """Set the velocity of a kinematic body to zero."""
        body.velocity = (0, 0)

    def read(self, body):
        """Return (y of the centre of mass, vx, vy, kinetic energy, mass, y of the origin) of a body."""
        return body.center.y, *body.velocity, body.kinetic_energy, body.mass, body.position.y


class Pymunk:
    """A pymunk space in metres."""

    def __init__(self, _):
        import pymunk

        self.pymunk, self.space = pymunk, pymunk.Space()
        self.space.gravity, self.space.iterations, self.space.collision_slop = (0, GRAVITY), 10, 0.005

    def _add(self, body, shapes, friction):
        for shape in shapes:
            shape.friction = friction
        self.space.add(*([] if body is self.space.static_body else [body]), *shapes)
        return body

    def box(self, width, height, place, kind="static", friction=0.6, velocity=(0, 0)):
        """Add a box with its centre at `place` and return the body."""
        pymunk = self.pymunk
        mass = width * height
        body = (
            pymunk.Body(mass, pymunk.moment_for_box(mass, (width, height)))
            if kind == "dynamic"
            else pymunk.Body(body_type=pymunk.Body.KINEMATIC if kind == "kinematic" else pymunk.Body.STATIC)
        )
        body.position, body.velocity = place, velocity
        return self._add(body, [pymunk.Poly.create_box(body, (width, height))], math.sqrt(friction))

    def chain(self, points):
        """Add static ground without friction along a polyline."""
        still = self.space.static_body
        links = zip(points[:-1], points[1:], strict=True)
        self._add(still, [self.pymunk.Segment(still, a, b, 0.0) for a, b in links], 0.0)

    def disc(self, radius, place, friction, velocity=(0, 0), weight=None):
        """Add a disc of density 1 and return the body.

        weight: None, or (radius, distance below the centre, density) of a second disc fixed within it. A disc with a
        weight starts at an angle of 0.5 rad.
        """
        pymunk = self.pymunk
        body = pymunk.Body()
        shapes = [pymunk.Circle(body, radius)]
        shapes[0].density = 1.0
        if weight is not None:
            shapes.append(pymunk.Circle(body, weight[0], (0.0, weight[1])))
            shapes[1].density = weight[2]
        body.position, body.velocity, body.angle = place, velocity, 0.5 if weight else 0.0
        return self._add(body, shapes, math.sqrt(friction))

    def step(self):
        """Advance the space by 1/60 s."""
        for _ in range(4):
            self.space.step(1.0 / 240.0)

    def stop(self, body):
        """Set the velocity of a kinematic body to zero."""
        body.velocity = (0, 0)

    def read(self, body):
        """Return (y of the centre of mass, vx, vy, kinetic energy, mass, y of the origin) of a body."""
        center = body.local_to_world(body.center_of_gravity).y
        moving = 0.5 * body.mass * body.velocity.length_squared + 0.5 * body.moment * body.angular_velocity**2
        return center, *body.velocity, moving, body.mass, body.position.y


def door(engine):
    """Close a door on a crate and return the greatest speed of the crate [m/s]."""
    engine.box(60.0, 2.0, (0.0, 1.0))
    leaf = engine.box(0.5, 3.0, (0.0, -5.0), "kinematic", velocity=(0, 7.5))
    crate, peak = engine.box(0.6, 0.6, (0.1, -0.303), "dynamic"), 0.0
    for _ in range(300):
        if engine.read(leaf)[5] >= -1.5:
            engine.stop(leaf)
        engine.step()
        peak = max(peak, math.hypot(*engine.read(crate)[1:3]))
    return peak


def bowl(engine):
    """Let a disc slide in a bowl and return its greatest energy divided by its energy at the start."""
    radius, r, turn = 12.5, 0.625, 0.7 * math.pi
    engine.chain([(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(math.pi, 0.0, 241)])
    room = radius - r - 0.002
    body = engine.disc(r, (room * math.cos(turn), room * math.sin(turn)), 0.0)
    energies = []
    for _ in range(3601):
        y, _, _, moving, mass, _ = engine.read(body)
        energies.append(moving + mass * GRAVITY * (radius - r - y))
        engine.step()
    return max(energies) / energies[0]


def wheel(engine):
    """Roll an eccentric wheel; return its greatest energy in the last ten seconds divided by that in the first ten."""
    engine.box(2000.0, 2.0, (0.0, 1.0))
    body = engine.disc(0.8, (0.0, -0.8), 0.6, weight=(0.16, 0.54, 60.0))
    lowest = engine.read(body)[0]
    offset = (lowest + 0.8) / math.cos(0.5)
    energies = []
    for _ in range(2400):
        y, _, _, moving, mass, _ = engine.read(body)
        energies.append(moving + mass * GRAVITY * (offset - 0.8 - y))
        engine.step()
    return max(energies[-600:]) / max(energies[:600])


def seams(engine):
    """Slide a ball over separate boxes and return its least speed divided by its speed at the start."""
    for k in range(28):
        engine.box(0.5, 0.5, (0.25 + 0.5 * k, 0.25), friction=0.0)
    ball, least = engine.disc(0.22, (0.5, -0.22), 0.0, velocity=(5.5, 0.0)), 1.0
    for _ in range(130):
        engine.step()
        least = min(least, engine.read(ball)[1] / 5.5)
    return least


SCENES: Mapping[str, Callable[[Any], float]] = {"door": door, "bowl": bowl, "wheel": wheel, "seams": seams}


def measure():
    """Run all scenes in all engines and return {row: {engine: figure}}."""
    makers = {name: lambda settings=settings: Hitbox(settings) for name, settings in ENGINES.items()}
    makers["pymunk"] = lambda: Pymunk(None)
    return {
        row: {name: float(f"{scene(make()):.4g}") for name, make in makers.items()} for row, scene in SCENES.items()
    }


def section():
    """Return the Markdown of the table "Beside the peers", made from the stored figures."""
    kept = json.loads(KEPT.read_text())
    names = [*ENGINES, "pymunk"]
    lines = [
        "## Beside the peers\n",
        "Measured in one run by `python -m tests.stability.peers`, in metres at 60 Hz. pymunk takes four steps of",
        "1/240 s, 10 iterations each. Quoted: the study in [tests/stability/study](../tests/stability/study).\n",
        f"| scene | figure | right | {' | '.join(names)} | quoted |",
        "|" + "---|" * (len(names) + 4),
    ]
    for row, (what, figure, right, quoted) in ROWS.items():
        cells = " | ".join(f"{kept[row][name]:.4g}" for name in names)
        lines.append(f"| {what} | {figure} | {right} | {cells} | {quoted} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    KEPT.write_text(json.dumps(measure(), indent=1) + "\n")
    print(section())
