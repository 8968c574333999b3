"""Engines that simulate a scene, with the methods step() -> seconds, poses(), awake() and remove(index).

A pose is x, y, angle, vx, vy, spin; NaN for a removed body. `engines()` returns the engines that are installed.
"""

import importlib.util
import math
from functools import partial
from time import perf_counter

import numpy as np

from physics import Circle, Effects, Material, Polygon, World
from tests.stability.study.scene import STEP

COLUMNS = ("x", "y", "angle", "vx", "vy", "angular_velocity")
EFFECTS = Effects.rigid_bodies().with_(sensors=False)


class Hitbox:
    """A Hitbox world in metres."""

    def __init__(self, scene, solver="soft_step", substeps: int | str = 4):
        self.world = World(
            EFFECTS.with_(sleeping=scene.sleeping),
            solver=solver,
            gravity=(0.0, scene.gravity),
            pixels_per_meter=1.0,
            dt=STEP,
            substeps=substeps,
        )
        self.bodies = [self._add(solid) for solid in scene.solids]
        self.ids = np.array([body.id for body in self.bodies])

    def _add(self, solid):
        shapes = [Circle(part.radius) if part.radius else Polygon(part.points) for part in solid.parts]
        return self.world.add_body(
            *shapes,
            position=(solid.x, solid.y),
            angle=solid.angle,
            kind=solid.kind,
            velocity=(solid.vx, solid.vy),
            angular_velocity=solid.spin,
            material=Material(density=solid.density, friction=solid.friction, restitution=solid.restitution),
        )

    def step(self):
        started = perf_counter()
        self.world.step()
        return perf_counter() - started

    def _rows(self):
        return np.searchsorted(self.ids, self.world.bodies["id"])

    def poses(self):
        found = np.full((len(self.ids), len(COLUMNS)), np.nan)
        found[self._rows()] = np.stack([self.world.bodies[name] for name in COLUMNS], axis=1)
        return found

    def awake(self):
        found = np.zeros(len(self.ids), bool)
        found[self._rows()] = self.world.bodies["awake"]
        return found

    def remove(self, index):
        self.world.remove_body(self.bodies[index])


class Pymunk:
    """A pymunk space of 32 px/m that makes four steps of 10 iterations for each step of the study.

    pymunk multiplies friction and restitution of two bodies, so each body gets the square root.
    """

    SCALE, PARTS, ITERATIONS = 32.0, 4, 10

    def __init__(self, scene):
        import pymunk

        self.space = pymunk.Space()
        self.space.iterations, self.space.gravity = self.ITERATIONS, (0.0, scene.gravity * self.SCALE)
        if scene.sleeping:
            self.space.sleep_time_threshold = 0.5
        self.bodies = [self._add(pymunk, solid) for solid in scene.solids]
        self.gone = set()

    def _add(self, pymunk, solid):
        scale = self.SCALE
        body = pymunk.Body(body_type=getattr(pymunk.Body, solid.kind.upper()))
        body.position, body.angle = (solid.x * scale, solid.y * scale), solid.angle
        shapes = [
            pymunk.Circle(body, part.radius * scale)
            if part.radius
            else pymunk.Poly(body, [(x * scale, y * scale) for x, y in part.points])
            for part in solid.parts
        ]
        for shape in shapes:
            shape.density = solid.density
            shape.friction, shape.elasticity = math.sqrt(solid.friction), math.sqrt(solid.restitution)
        self.space.add(body, *shapes)
        if solid.kind != "static":
            body.velocity, body.angular_velocity = (solid.vx * scale, solid.vy * scale), solid.spin
        return body

    def step(self):
        started = perf_counter()
        for _ in range(self.PARTS):
            self.space.step(STEP / self.PARTS)
        return perf_counter() - started

    def poses(self):
        found = np.array([(*body.position, body.angle, *body.velocity, body.angular_velocity) for body in self.bodies])
        found[:, [0, 1, 3, 4]] /= self.SCALE
        found[list(self.gone)] = np.nan
        return found

    def awake(self):
        return np.array([k not in self.gone and not body.is_sleeping for k, body in enumerate(self.bodies)])

    def remove(self, index):
        self.gone.add(index)
        body = self.bodies[index]
        self.space.remove(body, *body.shapes)


def takes_auto():
    """Return whether this version of World accepts substeps="auto"."""
    try:
        World(substeps="auto")
    except (TypeError, ValueError):
        return False
    return True


def engines():
    """Return {name: function scene -> engine} of the available engines."""
    found = {"hb4": partial(Hitbox, substeps=4), "hb8": partial(Hitbox, substeps=8)}
    if takes_auto():
        found["auto"] = partial(Hitbox, substeps="auto")
    found["sequential"] = partial(Hitbox, solver="sequential_impulse")
    if importlib.util.find_spec("pymunk") is not None:
        found["pymunk"] = Pymunk
    return found
