"""Overlapping parts of one body are weighed once: against closed forms, and shapely's unions of polygons."""

import math

import numpy as np
import pytest
import shapely

from physics import Capsule, Circle, Effects, Material, PixelMask, Polygon, World, mass_of
from physics.shapes.mass import polygon_mass, together


def same(found, expected, within=1e-12):
    size = math.sqrt(expected.inertia / expected.mass)
    assert found.mass == pytest.approx(expected.mass, rel=within)
    assert math.dist(found.center, expected.center) <= within * (size + math.hypot(*expected.center)) * 10
    assert found.inertia == pytest.approx(expected.inertia, rel=10 * within)


def box(width, height, x=0.0, y=0.0):
    return Polygon.box(width, height, center=(x, y))


def test_what_is_inside_another_adds_nothing():
    whole = box(10, 6).mass_of(1.0)
    same(mass_of([box(10, 6), box(2, 2, 1, 1)], 1.0), whole)
    same(mass_of([Circle(2.0), box(10, 6), Capsule((-2, 0), (2, 0), 1.0)], 1.0), whole)
    same(mass_of([Circle(3.0), Circle(1.0)], 2.0), Circle(3.0).mass_of(2.0))


def test_a_shape_given_twice_weighs_once():
    for shape in (box(10, 6, 3, 4), Circle(3.0, (5, 1)), Polygon([(0, 0), (9, 1), (4, 7)], radius=1.5)):
        same(mass_of([shape, shape], 1.5), shape.mass_of(1.5))


def test_a_cross_is_two_bars_less_the_square_in_its_middle():
    found = mass_of([box(12, 4), box(4, 12)], 1.0)
    expected = together([box(12, 4).mass_of(1.0), box(4, 4, 0, 4).mass_of(1.0), box(4, 4, 0, -4).mass_of(1.0)])
    same(found, expected)


def test_two_discs_share_a_lens():
    r, apart = 5.0, 6.0
    lens = 2.0 * r * r * math.acos(apart / (2.0 * r)) - 0.5 * apart * math.sqrt(4.0 * r * r - apart * apart)
    found = mass_of([Circle(r, (-3, 0)), Circle(r, (3, 0))], 1.0)
    assert found.mass == pytest.approx(2.0 * math.pi * r * r - lens, rel=1e-13)
    assert math.dist(found.center, (0, 0)) < 1e-12


def test_where_densities_differ_the_densest_counts():
    """A core of lead in a box of wood, whichever is told first."""
    wood, lead = box(10, 6).with_(Material(density=1.0)), Circle(2.0, (1, 0)).with_(Material(density=11.0))
    expected = together([box(10, 6).mass_of(1.0), Circle(2.0, (1, 0)).mass_of(10.0)])
    same(mass_of([wood, lead], 3.0), expected)
    same(mass_of([lead, wood], 3.0), expected)
    sunk = box(10, 6).with_(Material(density=11.0))
    same(mass_of([sunk, Circle(2.0, (1, 0)).with_(Material(density=1.0))], 3.0), box(10, 6).mass_of(11.0))


def test_what_touches_keeps_its_sums_to_the_bit():
    tiles = [box(4, 4, 4 * k, 0) for k in range(5)]
    found, sums = mass_of(tiles, 1.0), together([each.mass_of(1.0) for each in tiles])
    assert (found.mass, found.center, found.inertia) == (sums.mass, sums.center, sums.inertia)


def test_masks_weigh_by_themselves():
    mask = PixelMask(np.ones((4, 6), bool))
    found = mass_of([mask, box(10, 6)], 1.0)
    assert found.mass == 24.0 + 60.0


@pytest.mark.parametrize("seed", range(30))
def test_polygons_against_shapely(seed):
    rng = np.random.default_rng(seed)
    shapes = []
    for _ in range(int(rng.integers(2, 7))):
        angles = np.sort(rng.uniform(0, math.tau, int(rng.integers(3, 8))))
        if np.diff(np.append(angles, angles[0] + math.tau)).max() > 3.0:
            continue
        radius = rng.uniform(2, 9)
        points = rng.uniform(-8, 8, 2) + 100.0 * (seed % 2) + radius * np.stack([np.cos(angles), np.sin(angles)], 1)
        shapes.append(Polygon([tuple(each) for each in points]))
    if len(shapes) < 2:
        return
    union = shapely.unary_union([shapely.Polygon(shape.points) for shape in shapes])
    rings = []
    for part in getattr(union, "geoms", [union]):
        part = shapely.geometry.polygon.orient(part, -1.0)
        rings += [part.exterior, *part.interiors]
    found = mass_of(shapes, 1.0)
    assert found.mass == pytest.approx(union.area, rel=1e-9)
    assert math.dist(found.center, (union.centroid.x, union.centroid.y)) < 1e-7
    second = 0.0
    for ring in rings:  # signed: holes turn the other way
        weight = polygon_mass([(x - found.center[0], y - found.center[1]) for x, y in ring.coords[:-1]], 1.0)
        away = weight.center[0] ** 2 + weight.center[1] ** 2
        second += weight.inertia + weight.mass * away
    assert found.inertia == pytest.approx(abs(second), rel=1e-8)


def test_a_body_of_overlapping_parts_falls_and_turns_as_its_outline_does():
    """A hammer: handle through the head. What a torque gives it is what the outline's inertia says."""
    world = World(Effects(rotation=True, response=True))
    body = world.add_body(box(20, 2), box(4, 8, 8, 0), position=(50, 50))
    outline = together([box(16, 2, -2, 0).mass_of(1.0), box(4, 8, 8, 0).mass_of(1.0)])
    assert body.mass == pytest.approx(outline.mass) and body.inertia == pytest.approx(outline.inertia)
    body.apply_torque(1000.0)
    world.step()
    assert body.angular_velocity == pytest.approx(1000.0 / outline.inertia * world.dt, rel=1e-9)
