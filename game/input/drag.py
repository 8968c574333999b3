"""Dragging a body with the mouse: a critically damped spring from the grabbed point to the pointer.

The pointer is part of the step's input, so that a recording contains the drag. The spring's force is limited in
proportion to the body's mass. In a world with joints, the spring is a Target joint, which is solved together with all
other joints. The dragged body may fall asleep while the pointer does not move.

In other worlds, the spring is a force, integrated implicitly over one step (Catto, "Soft Constraints", GDC 2011). So it
is stable at any stiffness and for any mass. These worlds thus do not need the effect `joints`, which costs 18 to 31 us
a step even without a joint (five labs).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, pi, sin, sqrt
from typing import Protocol

import numpy as np
import pygame

from game.input.inputs import InputState
from physics import Body, Circle, Effects, Spring, Target, World

HERTZ = 5.0  # [1/s] of the spring: the body reaches the pointer in 0.2 s
DAMPING_RATIO = 1.0  # critical: no oscillation about the pointer
MOST_PULL = 300.0  # [m/s2] times the mass: 30 times its weight, enough to tear a crate out of a stack
SPIN_DAMPING = 2.0  # [1/s] makes a hanging body come to rest
# [m] greatest distance of a Target from the grabbed point, along the way to the pointer. The body then moves at no more
# than omega LEASH / 2 = 19 m/s. Braking from there needs omega^2 LEASH / 2e = 0.74 MOST_PULL: no body overshoots.
LEASH = 4.0 * MOST_PULL / (2.0 * pi * HERTZ) ** 2
SWING_DAMPING = 3.0  # [1/s] the same for a body on a Target, about the grabbed point
SWING_LEAST = 0.005  # [m/s] slower swings are not damped, so that the body can sleep
FOLLOW = 20.0  # [1/s] velocity per distance to the pointer, in worlds where forces do not move bodies
REACH = 4.0  # [canvas px] greatest distance of a press from a body: a card is 2 px thin


class View(Protocol):
    """The part of a camera that dragging uses: the view's top left corner in the world, the zoom, and the viewport."""

    x: float
    y: float
    zoom: float
    viewport: pygame.Rect

    def view(self, alpha: float = 1.0) -> tuple[float, float]:
        """Return the world point (x, y) that is drawn at the view's top left corner, including the camera's shake.

        alpha: position between the last two steps, 0..1.
        """
        ...


@dataclass(frozen=True)
class Hold:
    """A dragged body. grip: the grabbed point in body space [px].

    before: velocity [px/s] that the body is given on release; None if the release does not change its velocity. joint:
    id of the Target that pulls the body; None if no joint pulls it.
    """

    body: Body
    world: World
    camera: View
    grip: tuple[float, float]
    before: tuple[float, float] | None
    joint: int | None = None

    def point(self) -> tuple[float, float]:
        """Return the current position (x, y) of the grabbed point in the world [px]."""
        (x, y), angle = self.body.position, self.body.angle
        c, s = cos(angle), sin(angle)
        return x + c * self.grip[0] - s * self.grip[1], y + s * self.grip[0] + c * self.grip[1]

    def is_there(self) -> bool:
        """Return whether the body is still in its world, and also the Target that pulls it, if there is one."""
        known = self.joint is None or bool((self.world.joints["id"] == self.joint).any())
        return known and bool((self.world.bodies["id"] == self.body.id).any())


class Drag:
    """Dragging of a scene's bodies by one pointer, one body at a time. hold: the Hold of the dragged body, or None."""

    def __init__(self) -> None:
        self.hold: Hold | None = None

    @property
    def holds(self) -> bool:
        """Whether a body is being dragged."""
        return self.hold is not None

    @property
    def held(self) -> int:
        """Id of the dragged body, or -1 if no body is dragged."""
        return -1 if self.hold is None else self.hold.body.id

    def release(self) -> None:
        """Release the dragged body, if any.

        In a world without forces, the body's velocity is set to the velocity that it had when it was grabbed.
        """
        hold, self.hold = self.hold, None
        if hold is None or not hold.is_there():
            return
        if hold.joint is not None:
            hold.world.remove_joints(hold.joint)
        elif hold.before is not None:
            hold.body.velocity = hold.before

    def step(self, inputs: InputState, views: Sequence[tuple[World, View]]) -> None:
        """Grab, pull or release a body, depending on the pointer's button.

        Call this once per step, before World.step(). views: (world, camera) of each view on the canvas.
        """
        if inputs.pointer_pressed:
            self._grab(inputs.pointer, views)
        elif not inputs.pointer_down:
            self.release()
        if self.hold is not None and not _goes_on(self.hold, views):
            self.release()
        if self.hold is not None:
            _pull(self.hold, to_world(self.hold.camera, inputs.pointer))

    def _grab(self, pointer, views):
        self.release()
        for world, camera in views:
            if not camera.viewport.collidepoint(pointer):
                continue
            point = to_world(camera, pointer)
            body = body_at(world, point, REACH / camera.zoom)
            if body is not None:
                x, y = point[0] - body.position[0], point[1] - body.position[1]
                c, s = cos(body.angle), sin(body.angle)
                before = None if has_forces(world.effects) else body.velocity
                joint = _add_target(world, body, point) if takes_joints(world) else None
                self.hold = Hold(body, world, camera, (c * x + s * y, c * y - s * x), before, joint)
            return


def _goes_on(hold, views):
    """Return whether the drag of a body can continue. hold: Hold of the body; views: (world, camera) of each view.

    The drag ends if the body's world is not in `views` (the scene was rebuilt), if the body was removed, or if
    can_be_held() is False.
    """
    return any(world is hold.world for world, _ in views) and hold.is_there() and can_be_held(hold.body)


def takes_joints(world: World) -> bool:
    """Return whether a Target can pull bodies of the world.

    This requires the effect `joints` and a solver that supports joints.
    """
    return world.effects.joints and world.stacks


def _add_target(world, body, point):
    """Add a Target that holds the body's point at the world point `point` in place. Return the Target's id.

    _move_target() later moves the Target, which then pulls the body along.
    """
    force = MOST_PULL * world.tolerances.pixels_per_meter * body.mass
    return world.add_joint(Target(body, at=point, spring=Spring(HERTZ, DAMPING_RATIO), max_force=force)).id


def _move_target(hold, target):
    """Move the Target of a Hold towards the world point `target`, and damp the body's swing.

    The Target stays within LEASH of the grabbed point.
    """
    world, body, meter = hold.world, hold.body, hold.world.tolerances.pixels_per_meter
    x, y = hold.point()
    far = hypot(target[0] - x, target[1] - y)
    share = min(1.0, LEASH * meter / far) if far > 0.0 else 1.0
    # At the pointer itself the Target is the same in each step, which lets the body sleep.
    short = x + share * (target[0] - x), y + share * (target[1] - y)
    world.joint(hold.joint).point = target if share == 1.0 else short
    spin = body.angular_velocity if world.effects.rotation else 0.0
    if body.awake and abs(spin) * sqrt(body.inertia) > SWING_LEAST * meter * sqrt(body.mass):
        center_x, center_y = body.center
        about_point = body.inertia + body.mass * ((x - center_x) ** 2 + (y - center_y) ** 2)
        body.apply_torque(-spin * min(SWING_DAMPING * about_point, body.inertia / world.dt))


def _pull(hold, target):
    if hold.joint is not None:
        _move_target(hold, target)
        return
    world, body = hold.world, hold.body
    body.wake()
    turns = world.effects.rotation
    point = hold.point()
    if not has_forces(world.effects):
        body.velocity = (FOLLOW * (target[0] - point[0]), FOLLOW * (target[1] - point[1]))
        return
    row = world.bodies[world.rows([body.id])[0]]
    force = spring_force(row, point, target, world.dt, turns)
    most = MOST_PULL * world.tolerances.pixels_per_meter * body.mass
    size = hypot(*force)
    share = most / size if size > most else 1.0
    body.apply_force((force[0] * share, force[1] * share), point)
    if turns:
        body.apply_torque(-SPIN_DAMPING * float(row["inertia"]) * body.angular_velocity)


def to_world(camera: View, pointer: tuple[float, float]) -> tuple[float, float]:
    """Return the world point (x, y) at the canvas point `pointer`, without the camera's shake.

    The shake is ignored because it depends on the player's settings.
    """
    view = camera.viewport
    return (pointer[0] - view.x) / camera.zoom + camera.x, (pointer[1] - view.y) / camera.zoom + camera.y


def has_forces(effects: Effects) -> bool:
    """Return whether the effects include one that accelerates bodies: response, gravity, drag or wind."""
    return effects.response or effects.gravity or effects.drag or effects.wind


def can_be_held(body: Body) -> bool:
    """Return whether the body is dynamic, enabled, and of finite mass."""
    row = body.world.bodies[body.world.rows([body.id])[0]]
    return body.kind == "dynamic" and bool(row["inverse_mass"] > 0.0 and not row["quarantined"])


def body_at(world: World, point: tuple[float, float], reach: float) -> Body | None:
    """Return the Body to grab at the world point `point`, or None if there is none.

    The result is the uppermost body at the point. If there is no body at the point, it is the nearest body within
    `reach` [px].
    """
    held = [body for body in world.query_point(point) if can_be_held(body)]
    if held:
        return held[-1]
    near = [body for body in world.overlap(Circle(reach), (*point, 0.0)) if can_be_held(body)]
    distance = {body: hypot(body.center[0] - point[0], body.center[1] - point[1]) for body in near}
    return min(near, key=lambda body: (distance[body], body.id), default=None)


def spring_force(
    row: np.void, point: tuple[float, float], target: tuple[float, float], dt: float, turns: bool
) -> tuple[float, float]:
    """Return the force (x, y) [mass px/s2] of a spring that pulls `point` of a body to `target`.

    The force is implicit over a step of dt [s]. row: BODY row of the body; turns: whether the body can rotate. The
    impulse is J = -s K^-1 (v + b (point - target)). K is the inverse effective mass matrix, and v is the velocity at
    the point. The factors s and b follow from the soft constraint for dt.
    """
    omega = 2.0 * pi * HERTZ
    first = 2.0 * DAMPING_RATIO + dt * omega
    second = dt * omega * first
    softness, rate = second / (1.0 + second), omega / first
    inverse_mass, inverse_inertia = float(row["inverse_mass"]), float(row["inverse_inertia"]) if turns else 0.0
    spin = float(row["angular_velocity"]) if turns else 0.0
    rx, ry = point[0] - float(row["center_x"]), point[1] - float(row["center_y"])
    vx, vy = float(row["vx"]) - spin * ry, float(row["vy"]) + spin * rx
    wanted_x, wanted_y = vx + rate * (point[0] - target[0]), vy + rate * (point[1] - target[1])
    k11 = inverse_mass + inverse_inertia * ry * ry
    k12 = -inverse_inertia * rx * ry
    k22 = inverse_mass + inverse_inertia * rx * rx
    share = -softness / (dt * (k11 * k22 - k12 * k12))
    return share * (k22 * wanted_x - k12 * wanted_y), share * (k11 * wanted_y - k12 * wanted_x)
