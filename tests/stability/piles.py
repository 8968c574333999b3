"""Scenes that several tests build: worlds in metres, floors, slopes, columns and pyramids."""

import math

import numpy as np
import pytest

from physics import JIT, Effects, Material, Polygon
from tests.stability.settings import make

needs_speed = pytest.mark.skipif(
    not JIT, reason="too long without a compiler; compiled and plain runs give the same bits"
)
SLOP = 0.005  # [m] of worlds in metres
SOLVERS = ("soft_step", "sequential_impulse")


def pile_effects(**changes):
    """Return the effects for worlds with piles of bodies; sleeping is off unless `changes` turns it on."""
    return Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True).with_(
        **changes
    )


def metres(solver="soft_step", gravity=(0, 10), pixels_per_meter=1.0, effects=None, **options):
    """Return a world in which one pixel is one metre; arguments that are not given follow the present settings
    (settings.py).
    """
    options = {"solver": solver, "gravity": gravity, "pixels_per_meter": pixels_per_meter, **options}
    return make(effects, pile_effects(), options)


def pixels(effects=None, **options):
    """Return a world; arguments that are not given follow the present settings (settings.py)."""
    return make(effects, pile_effects(), options)


def floor(world, friction=0.6, restitution=0.0, width=200.0, y=0.0, x=0.0, angle=0.0):
    """Add a floor 2 thick whose surface passes through (x, y), and return the body. A positive angle slopes it down to
    the right.
    """
    return world.add_body(
        Polygon.box(width, 2.0, center=(0.0, 1.0)),
        position=(x, y),
        angle=angle,
        kind="static",
        material=Material(friction=friction, restitution=restitution),
    )


def on_slope(angle, along, height):
    """Return the point `along` down a slope through the origin and `height` above its surface. angle: of the slope
    [rad].
    """
    return (along * math.cos(angle) + height * math.sin(angle), along * math.sin(angle) - height * math.cos(angle))


def column(world, count, gap=0.0, shift=0.0, friction=0.6, size=1.0, density=1.0):
    """Add a column of boxes on y = 0 and return the bodies, lowest first.

    shift: every box is moved by this distance, alternately to the left and to the right. gap: free space below each
    box.
    """
    return [
        world.add_body(
            Polygon.box(size, size),
            position=(shift if k % 2 else -shift, -size / 2 - k * (size + gap) - gap),
            material=Material(density=density, friction=friction),
        )
        for k in range(count)
    ]


def pyramid(world, base, size=1.0, friction=0.6, spread=1.1, x=0.0, y=0.0):
    """Add a pyramid of boxes and return the ids by row, lowest first. Each row has one box fewer than the row below.

    base: number of boxes in the lowest row. spread: distance of neighbours in units of `size`.
    """
    return [
        world.add_bodies(
            Polygon.box(size, size),
            [(x + (k - (base - 1 - row) / 2) * spread * size, y - size / 2 - row * size) for k in range(base - row)],
            material=Material(friction=friction),
        )
        for row in range(base)
    ]


def pyramid_and_load(world, density, height):
    """Build a pyramid of ten rows without its top box, and a free box at a `height` above the missing one.

    Return (ids by row, lowest first; the free box). density: density of the free box.
    """
    floor(world)
    rows = pyramid(world, 10, spread=1.01)
    world.remove_body(int(rows.pop()[0]))
    return rows, world.add_body(Polygon.box(1, 1), position=(0.0, -9.5 - height), material=Material(density=density))


def tops(world, ids):
    """Return an array of the heights of bodies' origins above y = 0. ids: sequence of body ids."""
    return -world.bodies["y"][world.rows(np.asarray(ids))]
