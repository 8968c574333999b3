"""Hard cases far from the origin (section J): only the rounding of doubles may differ (2e-9 at 1e7)."""

import math

import numpy as np
import pytest

from physics import Polygon
from tests.stability.invariants import Watch, movers
from tests.stability.piles import SOLVERS, floor, metres, needs_speed, pile_effects, pyramid


def settled_pyramid(x, y, solver):
    """Simulate a pyramid at (x, y). Return (step in which it falls asleep or None, positions relative to (x, y)).

    The positions are an array (bodies, 2).
    """
    world = metres(solver, effects=pile_effects(sleeping=True))
    floor(world, x=x, y=y)
    pyramid(world, 4, x=x, y=y, spread=1.25)
    slept = None
    for n in range(250):
        world.step()
        if slept is None and not movers(world)["awake"].any():
            slept = n
    rows = movers(world)
    return slept, np.column_stack([rows["x"] - x, rows["y"] - y])


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_j1_pyramid_far_away_sleeps_at_the_same_step(measured, solver):
    here, at = settled_pyramid(0.0, 0.0, solver)
    assert here is not None
    for place in ((1e7, 0.0), (-1e7, 1e7)):
        slept, poses = settled_pyramid(*place, solver)
        assert slept is not None
        measured("J1", "steps by which it sleeps sooner or later", abs(slept - here))
        measured("J1", "difference of the poses", np.abs(poses - at).max())


def overlapping(x, y):
    world = metres()
    floor(world, x=x, y=y)
    for row in range(4):
        world.add_bodies(
            Polygon.box(1, 1), [(x + 0.75 * (k - (3 - row) / 2), y - 0.5 - 0.75 * row) for k in range(4 - row)]
        )
    Watch(world).step(60)
    return np.column_stack([movers(world)["x"] - x, movers(world)["y"] - y])


def standing(x, y):
    world = metres()
    floor(world, x=x, y=y)
    world.add_bodies(Polygon.box(1, 1), [(x, y - 0.5 - k) for k in range(10)])
    Watch(world).step(120)
    return np.column_stack([movers(world)["x"] - x, movers(world)["y"] - y])


@needs_speed
def test_j2_stacks_and_recovery_far_away_are_as_at_the_origin(measured):
    difference = "difference of stack and pyramid"
    measured("J2", difference, np.abs(standing(4e4, -2.5e4) - standing(0.0, 0.0)).max())
    far, here = (settled_pyramid(*at, "soft_step")[1] for at in ((1e5, -8e4), (0.0, 0.0)))
    measured("J2", difference, np.abs(far - here).max())
    measured("J2", "difference of the overlap", np.abs(overlapping(8e4, -7e4) - overlapping(0.0, 0.0)).max())


def test_j4_angle_after_a_million_turns_is_still_an_angle(measured):
    world = metres(gravity=(0, 0))
    body = world.add_body(Polygon.box(1, 1), angle=2e6 * math.pi, angular_velocity=1.0)
    other = world.add_body(Polygon.box(1, 1), position=(5, 0), angular_velocity=1.0)
    for _ in range(6):
        Watch(world).step(10)
        (ax, ay), (bx, by) = (each.to_world((1.0, 0.0)) - each.position for each in (body, other))
        measured("J4", "difference of sine and cosine", math.hypot(ax - bx, ay - by))
        measured("J4", "length of the axis less 1", abs(math.hypot(ax, ay) - 1.0))
