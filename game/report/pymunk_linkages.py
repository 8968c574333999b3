"""The report's linkages in pymunk, for comparison.

Without pymunk, a ModuleNotFoundError names the pip extra to install.
"""

from math import dist
from typing import Any

import numpy as np

from game.report.linkages import RADIUS, THICK, Linkage, middle, turn_of
from game.report.piles import GRAVITY
from game.report.pymunk_piles import library

BIASES = {"": 0.9**60, ", error_bias 0.1^60": 0.1**60}  # default; 90 % of an error are corrected in a step of 1/60 s


class Space:
    """A pymunk space with a linkage. bodies: the pymunk bodies of the linkage, in the linkage's order.

    iterations: iterations of pymunk's solver; substeps: number of pymunk steps per step of 1/60 s; bias: error_bias of
    all joints.
    """

    def __init__(self, linkage: Linkage, iterations: int, substeps: int, bias: float) -> None:
        self.pymunk = pymunk = library()
        self.substeps, self.bias = substeps, bias
        self.space = pymunk.Space()
        self.space.gravity, self.space.iterations = (0.0, GRAVITY), iterations
        base = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        base.angular_velocity = linkage.spin
        self.space.add(base)
        self.bodies = [base]
        for start, end in linkage.rods:
            size = dist(start, end), THICK
            body = pymunk.Body(size[0] * THICK, pymunk.moment_for_box(size[0] * THICK, size))
            body.angle = turn_of(start, end)
            self._add(body, middle(start, end), pymunk.Poly.create_box(body, size))
        for place, ratio, speed in linkage.balls:
            mass = ratio * self.bodies[1].mass
            body = pymunk.Body(mass, pymunk.moment_for_circle(mass, 0.0, RADIUS))
            body.velocity = speed, 0.0
            self._add(body, place, pymunk.Circle(body, RADIUS))
        for a, b, at in linkage.joints:
            self._hold(self.bodies[a], self.bodies[b], at, linkage.welded)

    def _add(self, body: Any, place: tuple[float, float], shape: Any) -> None:
        body.position = place
        shape.filter = self.pymunk.ShapeFilter(group=1)
        self.space.add(body, shape)
        self.bodies.append(body)

    def _hold(self, a: Any, b: Any, at: tuple[float, float], welded: bool) -> None:
        """Join two bodies at the point `at`. welded: True also fixes their relative angle, with a gear joint."""
        joints = [self.pymunk.PivotJoint(a, b, at)]
        if welded:
            joints.append(self.pymunk.GearJoint(a, b, b.angle - a.angle, 1.0))
        for joint in joints:
            joint.error_bias = self.bias
            self.space.add(joint)

    def step(self) -> None:
        """Simulate a sixtieth of a second."""
        for _ in range(self.substeps):
            self.space.step(1.0 / 60.0 / self.substeps)

    def poses(self) -> np.ndarray:
        """Return x [px], y [px] and angle [rad] of all bodies, as an array of shape (3, bodies)."""
        return np.array([(*body.position, body.angle) for body in self.bodies]).T
