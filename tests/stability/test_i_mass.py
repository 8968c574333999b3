"""Hard cases of mass properties (section I): closed forms, exact sums, and motion that does not depend on the mass."""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Material, PixelMask, Polygon, mass_of
from physics.shapes.outline import outline_of
from tests.stability.piles import SOLVERS, floor, metres
from tests.stability.worlds import heap

OFFSETS = ((0.0, 0.0), (7.0, -3.0), (300.0, 1e3))


def forms(offset):
    """Yield (shape, mass, inertia about its own centre) of several shapes of density 1, placed at an offset from the
    origin.
    """
    x, y = offset
    for radius in (1.0, 0.3):
        yield Circle(radius, offset), math.pi * radius**2, math.pi * radius**4 / 2.0
    for width, height, angle in ((2.0, 2.0, 0.0), (3.0, 0.5, 0.7)):
        mass = width * height
        yield Polygon.box(width, height, offset, angle), mass, mass * (width**2 + height**2) / 12.0
    # A triangle by its corners a, b, c about the centroid: m (a2 + b2 + c2) / 12.
    corners = np.array([(-1.0, 0.5), (2.0, 0.5), (0.0, -2.5)])
    own = corners - corners.mean(axis=0)
    yield Polygon((corners + offset).tolist()), 4.5, 4.5 * (own**2).sum() / 12.0
    for length, radius in ((2.0, 1.0), (10.0, 0.25)):
        box, disc, half = 2 * radius * length, math.pi * radius**2, 4 * radius / (3 * math.pi)
        caps = disc * (radius**2 / 2 - half**2 + (length / 2 + half) ** 2)
        yield Capsule((x, y), (x + length, y), radius), box + disc, box * (length**2 + 4 * radius**2) / 12 + caps


@pytest.mark.parametrize("offset", OFFSETS)
def test_i2_masses_are_the_closed_forms_wherever_they_are(measured, offset):
    for (shape, mass, inertia), (here, _, _) in zip(forms(offset), forms((0.0, 0.0)), strict=True):
        found, plain = mass_of(shape, 1.0), mass_of(here, 1.0)
        if offset == OFFSETS[0] or isinstance(shape, Circle):
            measured("I2", "relative error", max(abs(found.mass / mass - 1.0), abs(found.inertia / inertia - 1.0)))
        # Corners are rounded where they are: that is a double's share of the offset, squared by nothing.
        far = 1.0 + math.hypot(*offset) / 2.0
        measured("I2", "change with the offset", abs(found.inertia / plain.inertia - 1.0) / far)
    outside = 0
    for length, radius in ((2.0, 1.0), (10.0, 0.25), (1e-3, 1.0), (300.0, 1.5)):
        found = mass_of(Capsule((0, 0), (length, 0), radius), 1.0)
        inner, outer = (mass_of(Polygon.box(each, 2 * radius), 1.0) for each in (length, length + 2 * radius))
        outside += not (inner.mass < found.mass < outer.mass and inner.inertia < found.inertia < outer.inertia)
    measured("I2", "capsules outside their hull and box", outside)


@pytest.mark.parametrize("width, height", [(1, 1), (2, 2), (8, 8), (5, 13), (40, 23)])
def test_i3_pixels_weigh_as_squares(measured, width, height):
    exact = width * height * (width**2 + height**2) / 12.0
    found = mass_of(PixelMask(np.ones((height, width), bool)), 1.0)
    measured("I3", "relative error of the inertia", abs(found.inertia / exact - 1.0))
    points = sum((i + 0.5 - width / 2) ** 2 + (j + 0.5 - height / 2) ** 2 for i in range(width) for j in range(height))
    assert 1.0 - points / exact == pytest.approx(2.0 / (width**2 + height**2), rel=1e-9), "the naive sum falls short"


@pytest.mark.parametrize("seed", range(4))
def test_i4_a_mask_weighs_as_the_polygon_along_its_pixels_edges(measured, seed):
    pytest.importorskip("shapely")
    from tests.oracles import outlines

    mask = PixelMask(np.random.default_rng(14 + seed).random((15, 22)) < 0.6, origin=(3.0, 11.0))
    exact, traced = mass_of(mask, 1.0), outlines.pixels(mask.solid.tolist(), -3.0, -11.0)
    boxes = [
        Polygon.box(right - left, bottom - top, ((left + right) / 2 - 3.0, (top + bottom) / 2 - 11.0))
        for left, top, right, bottom in mask.blocks(0)
    ]
    together = mass_of(tuple(boxes), 1.0)
    ratios = (exact.mass / traced.area, exact.mass / together.mass, exact.inertia / together.inertia)
    measured("I4", "relative error of mass and inertia", max(abs(each - 1.0) for each in ratios))
    measured("I4", "error of the centre", math.dist(exact.center, (traced.centroid.x, traced.centroid.y)))
    measured("I4", "error of the centre", math.dist(exact.center, together.center))
    parts = outlines.rounded_union([(part.shape.points, 0.0) for part in outline_of(mask)], (0, 0, 0))
    gap = parts.symmetric_difference(traced).area / traced.length
    measured("I4", "area between outline and pixels, per px of edge", gap)


@pytest.mark.parametrize("solver", [*SOLVERS, "projection"])
def test_i5_masses_that_are_none_are_refused_and_locked_bodies_stay_finite(measured, solver):
    accepted = 0
    world = metres(solver)
    floor(world)
    for value in (0.0, -1.0, math.nan, math.inf):
        for call in (
            lambda v=value: Material(density=v),
            lambda v=value: world.add_body(Circle(1.0), mass=v),
            lambda v=value: mass_of(Circle(1.0), v),
        ):
            try:
                call()
                accepted += 1
            except ValueError as error:
                assert "mass" in str(error) or "density" in str(error)
    measured("I5", "accepted", accepted)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -2.0), angle=0.4, velocity=(3.0, 0.0), fixed_rotation=True)
    odd = 0
    for _ in range(120):
        world.step()
        for name in ("normal_impulse", "tangent_impulse"):
            odd += int((~np.isfinite(world.contacts[name])).sum())
    measured("I5", "impulses not finite", odd)
    measured("I5", "turn of what is locked", abs(box.angle - 0.4) + abs(box.angular_velocity))


@pytest.mark.parametrize("solver", SOLVERS)
def test_i6_mass_cancels(measured, solver):
    ends = []
    for density in (1.0, 1e-6, 1e6):
        world = metres(solver)
        floor(world)
        box = world.add_body(Polygon.box(1, 2), position=(0.0, -3.0), angle=0.3, material=Material(density=density))
        for _ in range(90):
            world.step()
        ends.append((*box.position, box.angle))
    measured("I6", "difference of a falling, tipping box", np.abs(np.array(ends[1:]) - ends[0]).max())
    steps = 60 if JIT else 20
    plain = heap(solver=solver, steps=steps)
    for power in (2.0**-20, 2.0**20):
        differs = np.abs(heap(solver=solver, density=power, steps=steps) - plain).max()
        measured("I6", "difference of a heap, by a power of two", differs)
