"""Overlapping parts of one body count once in its mass, compared with closed forms and shapely's unions of polygons."""

import math

import numpy as np
import pytest
import shapely

from physics import Capsule, Circle, Effects, Material, PixelMask, Polygon, World, mass_of
from physics.shapes.mass import polygon_mass, together
from tests.outline.rasters import pixels


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
    """Where parts overlap, the greatest density counts, in either order: a core of lead in a box of wood."""
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


def test_a_mask_is_weighed_once_with_what_overlaps_it():
    mask = PixelMask.from_array(np.ones((4, 6), bool))
    assert mass_of([mask, box(10, 6)], 1.0) == mass_of([box(10, 6), mask], 1.0)
    same(mass_of([mask, box(10, 6)], 1.0), box(10, 6).mass_of(1.0))
    same(mass_of([mask, mask], 1.5), mask.mass_of(1.5))
    same(mass_of([mask, PixelMask.from_array(np.ones((4, 6), bool))], 1.5), mask.mass_of(1.5))
    lead = PixelMask.from_array(np.ones((2, 2), bool)).with_(Material(density=11.0))
    same(mass_of([mask, lead], 1.0), together([box(6, 4).mass_of(1.0), box(2, 2).mass_of(10.0)]))


def test_masks_whose_boxes_meet_and_pixels_do_not_keep_their_sums_to_the_bit():
    """Masks whose boxes overlap but not their pixels keep the exact sums, to the bit.

    A ball in a ring, combs in each other's gaps, and masks side by side.
    """
    ring, comb = np.ones((9, 9), bool), np.zeros((6, 7), bool)
    ring[1:8, 1:8] = False
    comb[0], comb[:, ::2] = True, True
    other = PixelMask.from_array(comb[::-1, 1:].copy(), origin=(0.0, -1.0))
    for shapes in (
        [PixelMask.from_array(ring, origin=(4.5, 4.5)), Circle(3.5)],
        [PixelMask.from_array(comb, origin=(0.0, 0.0)), other.with_(Material(density=3.0))],
        [PixelMask.from_array(comb, origin=(0.1, 0.0)), PixelMask.from_array(comb, origin=(0.1, 6.0))],
    ):
        found = mass_of(shapes, 1.0)
        weights = [each.mass_of(1.0 if each.material is None else each.material.density) for each in shapes]
        assert found == together(weights)


@pytest.mark.parametrize("seed", range(20))
def test_masks_with_masks_and_polygons_against_shapely(seed):
    """The mass of overlapping masks and polygons of several densities equals shapely's, at any offset and distance."""
    rng = np.random.default_rng(seed)
    shapes, figures = [], []
    for _ in range(int(rng.integers(1, 4))):
        height, width = rng.integers(2, 12, 2).tolist()
        solid = rng.random((height, width)) < 0.7
        solid[0, 0] = True
        origin = tuple((rng.integers(-4, 12, 2) + rng.choice([0.0, 0.25, 0.3], 2) + 1000.0 * (seed % 2)).tolist())
        density = float(rng.choice([1.0, 1.0, 2.5]))
        shapes.append(PixelMask.from_array(solid, origin=origin).with_(Material(density=density)))
        figures.append((shapely.transform(pixels(solid), lambda points, o=origin: points - np.array(o)), density))
    for _ in range(int(rng.integers(1, 3))):
        middle = -np.array(shapes[0].origin) + rng.uniform(-2, 9, 2)
        points = [tuple(each) for each in (middle + rng.uniform(-5, 5, (3, 2)))]
        density = float(rng.choice([1.0, 4.0]))
        shapes.append(Polygon(points).with_(Material(density=density)))
        figures.append((shapely.Polygon(points), density))
    layers = [
        (shapely.union_all([each for each, heavy in figures if heavy >= density]), density)
        for density in sorted({density for _, density in figures})
    ]
    below, parts = 0.0, []
    for union, density in layers:
        for triangle in shapely.constrained_delaunay_triangles(union).geoms:
            parts.append(
                polygon_mass(
                    np.array(shapely.orient_polygons(triangle, exterior_cw=False).exterior.coords)[:3], density - below
                )
            )
        below = density
    expected = together(parts)
    found = mass_of(shapes, 1.0)
    assert found.mass == pytest.approx(expected.mass, rel=1e-9)
    assert math.dist(found.center, expected.center) < 1e-8
    assert found.inertia == pytest.approx(expected.inertia, rel=1e-8)


def test_masks_with_round_shapes():
    """A disc over the corner of a pixel square has the mass of the union: three quarters of the disc lie outside."""
    square = PixelMask.from_array(np.ones((8, 8), bool), origin=(0.0, 0.0))
    found = mass_of([square, Circle(3.0)], 2.0)
    assert found.mass == pytest.approx(2.0 * (64.0 + 0.75 * math.pi * 9.0), rel=1e-13)
    quarter = 4.0 * 3.0 / (3.0 * math.pi)  # how far a quarter's centre is from the disc's, along each axis
    moment = 64.0 * 4.0 - 0.25 * math.pi * 9.0 * quarter
    assert found.center == pytest.approx((2.0 * moment / found.mass,) * 2, rel=1e-12)


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
    """A hammer, whose handle passes through its head, has the mass and inertia of its outline,
    and turns accordingly.
    """
    world = World(Effects(rotation=True, response=True))
    body = world.add_body(box(20, 2), box(4, 8, 8, 0), position=(50, 50))
    outline = together([box(16, 2, -2, 0).mass_of(1.0), box(4, 8, 8, 0).mass_of(1.0)])
    assert body.mass == pytest.approx(outline.mass) and body.inertia == pytest.approx(outline.inertia)
    body.apply_torque(1000.0)
    world.step()
    assert body.angular_velocity == pytest.approx(1000.0 / outline.inertia * world.dt, rel=1e-9)
