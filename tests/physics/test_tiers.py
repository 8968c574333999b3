"""The replacement shapes of a mask in each tier, compared with its pixels as shapely figures."""

import math

import numpy as np
import pytest
import shapely

from physics import TIERS, Capsule, Circle, Effects, PixelMask, Polygon, World, fit
from tests.outline.rasters import disc, noise, pixels, sprites
from tests.physics.figures import figure


def truth(mask):
    return shapely.transform(pixels(mask.solid), lambda points: points - np.array(mask.origin))


def masks():
    for _, solid in sprites():
        yield PixelMask.from_array(solid)
    for solid in noise(12, 20):
        if solid.any():
            yield PixelMask.from_array(solid, origin=(3, -1))


@pytest.mark.parametrize("tier", ["circle", "obb", "capsule", "hull"])
def test_what_stands_around_holds_all_pixels(tier):
    for mask in masks():
        (shape,) = fit(mask, tier)
        assert figure(shape).buffer(2e-3).covers(truth(mask).convex_hull)


def test_no_other_axis_gives_a_capsule_of_less_area():
    for mask in masks():
        (shape,) = fit(mask, "capsule")
        area = figure(shape).area
        corners = np.array(truth(mask).convex_hull.exterior.coords)
        for angle in np.linspace(0, math.pi, 37):
            along = corners @ [math.cos(angle), math.sin(angle)]
            aside = corners @ [-math.sin(angle), math.cos(angle)]
            radius = np.ptp(aside) / 2
            spare = np.sqrt(np.maximum(radius**2 - (aside - (aside.min() + aside.max()) / 2) ** 2, 0))
            length = max(0.0, (along - spare).max() - (along + spare).min())
            assert area <= (2 * radius * length + math.pi * radius**2) * (1 + 1e-3)


def test_a_hull_is_no_larger_than_it_has_to_be():
    for mask in masks():
        (shape,) = fit(mask, "hull")
        true = truth(mask).convex_hull
        assert figure(shape).area <= true.area * 1.03
        if len(true.exterior.coords) <= 17:
            assert figure(shape).symmetric_difference(true).area <= 1e-9 * true.area


@pytest.mark.parametrize("tier, farthest", [("outline", 0.711), ("parts", 1.711)])
def test_parts_and_outlines_are_as_near_as_they_say(tier, farthest):
    for mask in masks():
        union = shapely.union_all([figure(each) for each in fit(mask, tier)])
        true = truth(mask)
        assert union.symmetric_difference(true).area <= true.length * 0.5 * farthest
        lying = shapely.segmentize(true.boundary, 0.25)
        away = shapely.distance(shapely.points(shapely.get_coordinates(lying)), union.boundary.buffer(1e-6))
        round_one = any(isinstance(each, Circle) for each in fit(mask, tier))
        assert away.max() <= farthest + (0.13 if round_one else 0.0)


def test_known_sprites():
    (ball,) = fit(PixelMask.from_array(disc(9)), "outline")
    assert isinstance(ball, Circle) and ball.center == (0, 0) and ball.radius == pytest.approx(9, abs=0.2)
    crate = PixelMask.from_array(np.ones((32, 32), bool))
    for tier in ("obb", "hull", "parts", "outline"):
        assert fit(crate, tier) == (Polygon.box(32, 32),)
    (round_one,) = fit(PixelMask.from_array(np.ones((6, 6), bool)), "capsule")
    assert figure(round_one).area == pytest.approx(math.pi * 18, rel=1e-3)
    (long_one,) = fit(PixelMask.from_array(np.ones((4, 20), bool)), "capsule")
    assert isinstance(long_one, Capsule) and long_one.radius == pytest.approx(2.0, abs=0.6)


def test_a_smaller_tolerance_gives_more_parts_and_is_kept_apart():
    ship = PixelMask.from_array(dict(sprites())["planes/large_plane_b"])
    assert len(fit(ship, "parts", 4.0)) < len(fit(ship, "parts", 0.25))
    assert fit(ship, "parts", 4.0) is fit(ship, "parts", 4.0)


@pytest.mark.parametrize("tier", TIERS)
def test_every_tier_makes_a_body(tier):
    mask = PixelMask.from_array(disc(9))
    world = World(Effects())
    body = world.add_body(mask, tier=tier)
    other = world.add_body(Circle(3), position=(5, 5))
    world.step()
    assert {body.id, other.id} == set(world.contacts[["body_a", "body_b"]][0].tolist())
    assert fit(PixelMask.from_array(np.zeros((2, 2), bool)), tier) == () or tier in ("pixels", "mask")
