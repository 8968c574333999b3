"""Joints between small and heavy bodies, and nets of many joints."""

import math

import numpy as np

from physics import JIT, Circle, Filter, Revolute
from tests.stability.invariants import Watch, movers
from tests.stability.piles import metres, pile_effects
from tests.stability.settings import phase

ALONE = Filter(1, 0)  # balls pass through each other
STEP = 0.25  # [m] between the balls of a chain or a net


def jointed():
    """Return a world in metres with the effect of joints."""
    return metres(effects=pile_effects(joints=True))


def ball(world, x, y, mass=None):
    return world.add_body(Circle(0.1), position=(x, y), mass=mass, filter=ALONE)


def chain(world, links, x, angle, ratio=1.0):
    """Add a straight chain of balls that hangs on the world at (x, 0).

    The last ball has `ratio` times the mass of any other. angle [rad]: direction of the chain, clockwise from the
    right.
    """
    before = None
    for k in range(links):
        far = STEP * (k + 0.5)
        mass = ratio * before.mass if before and k == links - 1 else None
        last = ball(world, x + far * math.cos(angle), far * math.sin(angle), mass)
        at = STEP * k
        world.add_joint(Revolute(before, last, at=(x + at * math.cos(angle), at * math.sin(angle))))
        before = last


def test_f29_a_chain_of_small_balls_holds_a_heavy_one(measured):
    """A chain of small balls with a heavy end swings for 5 s, from horizontal or below, and no joint separates."""
    world = jointed()
    chain(world, 16, 0.0, phase(0.5 * math.pi), 1000.0)
    watch, stretch = Watch(world, passive=True, capped=True), 0.0
    for _ in range(300 if JIT else 20):
        watch.step()
        stretch = max(stretch, world.joints["separation"].max())
    measured("F29", "greatest separation of a joint", stretch)


def test_f30_chains_and_a_net_of_joints_gain_no_energy(measured):
    """Chains and a net of joints, released from horizontal or below, gain no energy in 10 s.

    The net hangs on two corners.
    """
    world, wide = jointed(), 16 if JIT else 4
    for k in range(10):
        chain(world, 8, -4.0 - k, phase(0.5 * math.pi))
    net = [[ball(world, STEP * i, STEP * j) for i in range(wide)] for j in range(wide)]
    for j in range(wide):
        for i in range(wide):
            at = net[j][i].position
            if i:
                world.add_joint(Revolute(net[j][i - 1], net[j][i], at=(at.x - STEP / 2, at.y)))
            if j:
                world.add_joint(Revolute(net[j - 1][i], net[j][i], at=(at.x, at.y - STEP / 2)))
    for corner in (net[0][0], net[0][-1]):
        world.add_joint(Revolute(None, corner, at=corner.position))
    watch, out = Watch(world, passive=True, capped=True), 0
    for _ in range(600 if JIT else 10):
        watch.step()
        rows = movers(world)
        out += int((np.hypot(rows["x"], rows["y"]) > 40.0).sum())
    measured("F30", "greatest speed", watch.fastest)
    measured("F30", "bodies outside", out)
