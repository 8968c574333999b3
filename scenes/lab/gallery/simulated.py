"""A naive contact solver for the gallery: the world finds the contacts, and this module solves each body alone."""

from dataclasses import dataclass
from typing import NamedTuple

ITERATIONS = 10
SLOP = 0.16  # [px] overlap that is left, as in a world of 32 px to the metre
FRICTION = 0.6  # of a default Material
SEEN_ONLY = ("response", "gravity", "friction", "stacking")  # effects that the world of such a side does not have


class Motion(NamedTuple):
    """The motion of a body: velocity of its centre of mass [px/s] and angular velocity [rad/s]."""

    vx: float
    vy: float
    spin: float


@dataclass
class Push:
    """A contact of one body, with the data that this solver needs.

    normal: unit vector towards the body; arm: vector from the body's centre of mass to the contact [px]; other:
    velocity of the other body [px/s]; speed: separation speed that the solver aims at [px/s]; along, across:
    accumulated impulses in normal and tangential direction.
    """

    normal: tuple[float, float]
    arm: tuple[float, float]
    other: tuple[float, float]
    speed: float
    along: float = 0.0
    across: float = 0.0


def step_naively(side, bodies, substeps, share):
    """Step a world by sequential impulses with Baumgarte stabilisation (Box2D Lite). The world's own response is off.

    bodies: the dynamic bodies, each solved alone against static and kinematic bodies; share: part of the overlap that a
    step removes, by a velocity that the body keeps. All substeps use the moment arms of the start of the step. The kept
    velocity and the old moment arms are the two errors that the gallery shows. side: one of the page's two worlds
    (page.Side).
    """
    world, gravity = side.world, side.other.world.gravity
    ends = [solved_step(world, body, gravity, substeps, share) for body in bodies]
    world.step()
    for body, end in zip(bodies, ends, strict=True):
        body.velocity, body.angular_velocity = end[:2], end.spin


def solved_step(world, body, gravity, substeps, share):
    """Solve the contacts of a body for one step, and return its Motion at the end of the step.

    The body gets the mean velocity over the substeps, with which the world then moves it. gravity: (x, y) [px/s2];
    share: part of the overlap that the step removes, 0..1.
    """
    row = world.bodies[world.rows([body.id])[0]]
    pushes = pushes_on(world, body, row, share)
    inverse = 1.0 / float(row["mass"]), 1.0 / float(row["inertia"])
    (vx, vy), h = body.velocity, world.dt / substeps
    motion = Motion(vx, vy, body.angular_velocity)
    moved = [0.0, 0.0, 0.0]
    for _ in range(substeps):
        motion = Motion(motion.vx + gravity[0] * h, motion.vy + gravity[1] * h, motion.spin)
        for push in pushes:
            push.along = push.across = 0.0
        for _ in range(ITERATIONS):
            for push in pushes:
                motion = solved(motion, push, inverse)
        moved = [way + speed * h for way, speed in zip(moved, motion, strict=True)]
    vx, vy, spin = (way / world.dt for way in moved)
    body.velocity, body.angular_velocity = (vx, vy), spin
    return motion


def pushes_on(world, body, row, share):
    """Return a list with a Push for each contact of a body at the end of the last step.

    row: the body's row in world.bodies; share: part of the overlap that a step removes, 0..1.
    """
    found, middle = [], (float(row["center_x"]), float(row["center_y"]))
    for contact in world.contacts:
        pair = int(contact["body_a"]), int(contact["body_b"])
        if body.id not in pair:
            continue
        way = -1.0 if pair[0] == body.id else 1.0
        ground = world.body(pair[1] if pair[0] == body.id else pair[0])
        overlap = max(0.0, -float(contact["separation"]) - SLOP)
        found.append(
            Push(
                (way * float(contact["normal_x"]), way * float(contact["normal_y"])),
                (float(contact["point_x"]) - middle[0], float(contact["point_y"]) - middle[1]),
                tuple(ground.velocity) if ground.kind == "kinematic" else (0.0, 0.0),
                share * overlap / world.dt,
            )
        )
    return found


def solved(motion, push, inverse):
    """Apply the normal and friction impulses of the contact `push` to a body with `motion`. Return its new Motion.

    inverse: (1 / mass, 1 / inertia).
    """
    (nx, ny), along = push.normal, push.along
    change, arm = impulse(motion, push, (nx, ny), push.speed, inverse)
    push.along = max(0.0, along + change)
    motion = struck(motion, (nx, ny), arm, push.along - along, inverse)
    limit, across = FRICTION * push.along, push.across
    change, arm = impulse(motion, push, (-ny, nx), 0.0, inverse)
    push.across = min(max(across + change, -limit), limit)
    return struck(motion, (-ny, nx), arm, push.across - across, inverse)


def impulse(motion, push, axis, wanted, inverse):
    """Return (impulse, moment arm [px]): the impulse after which the contact `push` has a given relative speed along
    an axis.

    wanted: this speed [px/s]; motion: current Motion of the body; axis: unit vector; inverse: (1 / mass, 1 / inertia).
    """
    (rx, ry), (x, y) = push.arm, axis
    arm = rx * y - ry * x
    speed = (motion.vx - motion.spin * ry - push.other[0]) * x + (motion.vy + motion.spin * rx - push.other[1]) * y
    return (wanted - speed) / (inverse[0] + arm * arm * inverse[1]), arm


def struck(motion, axis, arm, amount, inverse):
    """Return the Motion of a body after an impulse.

    motion: Motion before the impulse; amount: size of the impulse; axis: its direction, a unit vector; arm: its moment
    arm [px]; inverse: (1 / mass, 1 / inertia).
    """
    x, y = axis
    return Motion(
        motion.vx + amount * x * inverse[0],
        motion.vy + amount * y * inverse[0],
        motion.spin + amount * arm * inverse[1],
    )
