"""A body that falls on joined bodies in contact gives them no more energy than it has, in any step.

An impact loses energy, and joints must not return it. Before the fix they returned it as a correction of the
integrator's errors. Also, the inertia that tension adds sped up the common rotation of bodies in the air.
"""

import random

import pytest

from physics import Angle, Capsule, Circle, Distance, Effects, Polygon, Prismatic, Revolute, Weld, Wheel, World
from physics.jit import JIT

SPEED = 350.0  # [px/s] of the falling body
# Share of the falling body's energy that a step may add. 0.0068 is the greatest measured (200 seeds), 0.0051 without
# joints: the push-out lifts bodies by up to half a slop. With the whole reserve it was up to 0.35.
MOST_RISE = 0.01
SEEDS = range(20) if JIT else range(3)


def joint_of(kind, a, b):
    """Return a joint of a kind between two bodies, at the middle between them."""
    middle = (a.position + b.position) / 2
    length = (a.position - b.position).length
    return {
        "pin": lambda: Revolute(a, b, middle),
        "pin with limits": lambda: Revolute(a, b, middle, limits=(-0.3, 0.3)),
        "weld": lambda: Weld(a, b, middle),
        "rod": lambda: Distance(a, b, a.position, b.position),
        "rope": lambda: Distance(a, b, a.position, b.position, limits=(None, length)),
        "slider": lambda: Prismatic(a, b, middle, axis=(1, 0.3)),
        "slider with limits": lambda: Prismatic(a, b, middle, axis=(1, 0.3), limits=(-5, 5)),
        "groove": lambda: Prismatic(a, b, middle, axis=(0.3, 1), turns=True, limits=(-5, 5)),
        "wheel": lambda: Wheel(a, b, b.position, spring=None, limits=(-5, 5)),
        "angle": lambda: Angle(a, b, limits=(-0.1, 0.1)),
    }[kind]()


KINDS = ["pin", "pin with limits", "weld", "rod", "rope", "slider", "slider with limits", "groove", "wheel", "angle"]


def shape(rng):
    """Return a random disc, box or capsule of about 20 px."""
    kind = rng.randrange(3)
    if kind == 0:
        return Circle(rng.uniform(8, 12))
    return Polygon.box(rng.uniform(14, 26), rng.uniform(14, 26)) if kind == 1 else Capsule((-8, 0), (8, 1), 5)


def energy(world):
    """Return the kinetic plus potential energy of all dynamic bodies."""
    b = world.bodies[world.bodies["kind"] == 2]
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * world.gravity.y * b["center_y"]).sum())


def greatest_rise(kind, seed, **settings):
    """Return the greatest rise of energy in a step, divided by the kinetic energy before the impact.

    Two bodies lie on one another on a floor. A third is beside them and joined to both; a fourth falls on them.
    """
    rng = random.Random(seed)
    world = World(Effects.rigid_bodies().with_(joints=True, sleeping=False), **settings)
    world.add_body(Polygon.box(1000, 40), position=(0, 20), kind="static")
    places = [(rng.uniform(-4, 4), -14), (rng.uniform(-12, 12), -40), (rng.uniform(25, 60), rng.uniform(-60, -15))]
    a, b, c = (world.add_body(shape(rng), position=place, angle=rng.uniform(-3, 3)) for place in places)
    world.add_joint(joint_of(kind, a, c))
    world.add_joint(joint_of(kind, b, c))
    for _ in range(rng.randrange(60)):
        world.step()
    above = (b.position.x + rng.uniform(-9, 9), b.position.y - 26 - rng.uniform(0, 6))
    world.add_body(shape(rng), position=above, velocity=(0, SPEED), angle=rng.uniform(-3, 3))
    before, worst = energy(world), 0.0
    whole = sum(body.kinetic_energy for body in world if body.kind == "dynamic")
    for _ in range(30):
        world.step()
        after = energy(world)
        worst, before = max(worst, (after - before) / whole), after
    return worst


@pytest.mark.parametrize("settings", [{}, {"substeps": 4}, {"substeps": 16}, {"solver": "sequential_impulse"}], ids=str)
@pytest.mark.parametrize("kind", KINDS)
def test_no_step_of_an_impact_adds_energy(kind, settings):
    for seed in SEEDS:
        assert greatest_rise(kind, seed, **settings) < MOST_RISE, seed
