"""Mass, centre and inertia of every shape against closed forms and bounds."""

import math

import numpy as np
import pytest

from physics import Capsule, Circle, Material, PixelMask, Polygon, Segment, World, mass_of
from tests.stability.piles import floor, metres, pile_effects

pytest.importorskip("shapely")  # the outlines' oracle stands on it
from tests.oracles import outlines  # noqa: E402

NAN, INF = math.nan, math.inf


def close(found, mass, center, inertia):
    assert found.mass == pytest.approx(mass, rel=1e-12)
    assert found.center == pytest.approx(center, abs=1e-12 * max(1.0, *map(abs, center)))
    assert found.inertia == pytest.approx(inertia, rel=1e-12)


@pytest.mark.parametrize("center", [(0.0, 0.0), (7.0, -3.0), (1e3, 1e3)])
def test_disc_and_box_in_closed_form_wherever_they_are(center):
    close(mass_of((Circle(1.0, center),), 1.0), math.pi, center, math.pi / 2)
    for angle in (0.0, 0.7):
        found = mass_of((Polygon.box(2, 2, center, angle),), 1.0)
        assert found.mass == pytest.approx(4.0, rel=1e-12) and found.inertia == pytest.approx(
            8 / 3, rel=1e-9 if center[0] > 99 else 1e-12
        )
    assert mass_of((Polygon.box(3, 0.5),), 2.0).inertia == pytest.approx(3.0 * (9 + 0.25) / 12, rel=1e-12)


def test_offset_box_is_the_box_about_its_own_centre():
    plain, moved = mass_of((Polygon.box(3, 1),), 1.0), mass_of((Polygon.box(3, 1, (40, -20)),), 1.0)
    assert moved.inertia == pytest.approx(plain.inertia, rel=1e-12) and moved.center == pytest.approx(
        (40, -20), rel=1e-14
    )


@pytest.mark.parametrize("length, radius", [(2.0, 1.0), (10.0, 0.25), (1e-3, 1.0), (300.0, 1.5)])
def test_capsule_in_closed_form_and_between_its_bounds(length, radius):
    found = mass_of((Capsule((0, 0), (length, 0), radius),), 1.0)
    box, disc = 2 * radius * length, math.pi * radius**2
    half = 4 * radius / (3 * math.pi)
    cap = disc / 2 * (radius**2 / 2 - half**2 + (length / 2 + half) ** 2)
    close(found, box + disc, (length / 2, 0), box * (length**2 + 4 * radius**2) / 12 + 2 * cap)
    inner, outer = (mass_of((Polygon.box(each, 2 * radius),), 1.0) for each in (length, length + 2 * radius))
    assert inner.mass < found.mass < outer.mass and inner.inertia < found.inertia < outer.inertia
    turned = mass_of((Capsule((5, 5), (5 + length * 0.6, 5 - length * 0.8), radius),), 1.0)
    assert turned.inertia == pytest.approx(found.inertia, rel=1e-11) and turned.mass == pytest.approx(
        found.mass, rel=1e-12
    )


@pytest.mark.parametrize("seed", range(5))
def test_polygons_equal_the_fan_of_their_triangles(seed):
    """The mass properties of a polygon equal the sums over the triangles about its centroid."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, math.tau, 3 + 2 * seed))
    points = [(50 + 9 * math.cos(a), -20 + 4 * math.sin(a)) for a in angles]
    found = mass_of((Polygon(points),), 0.5)
    truth = outlines.polygon(points, (0, 0, 0))
    assert found.mass == pytest.approx(0.5 * truth.area, rel=1e-12)
    assert found.center == pytest.approx((truth.centroid.x, truth.centroid.y), rel=1e-12)
    cx, cy = found.center
    total = 0.0
    for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True):
        ax, ay, bx, by = ax - cx, ay - cy, bx - cx, by - cy
        total += (ax * by - bx * ay) / 12 * (ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by)
    assert found.inertia == pytest.approx(0.5 * abs(total), rel=1e-11)


@pytest.mark.parametrize("width, height, radius", [(2.0, 1.0, 0.25), (4.0, 4.0, 2.0), (1.0, 0.1, 0.01)])
def test_rounded_box_is_core_strips_and_quarters(width, height, radius):
    found = mass_of((Polygon([(0, 0), (width, 0), (width, height), (0, height)], radius=radius),), 1.0)
    core = width * height * (width**2 + height**2) / 12
    strips = sum(
        2 * a * radius * ((a**2 + radius**2) / 12 + ((b + radius) / 2) ** 2)
        for a, b in ((width, height), (height, width))
    )
    quarter, off = math.pi * radius**2 / 4, 4 * radius / (3 * math.pi)
    own = quarter * radius**2 / 2 - 2 * quarter * off**2
    corners = 4 * (own + quarter * ((width / 2 + off) ** 2 + (height / 2 + off) ** 2))
    close(
        found,
        width * height + 2 * (width + height) * radius + math.pi * radius**2,
        (width / 2, height / 2),
        core + strips + corners,
    )


def test_parts_of_one_body_add_up_about_their_common_centre():
    whole = mass_of((Polygon.box(6, 2),), 1.0)
    parts = mass_of((Polygon.box(2, 2, (-2, 0)), Polygon.box(4, 2, (1, 0))), 1.0)
    close(parts, whole.mass, whole.center, whole.inertia)
    world = metres(gravity=(0, 0))
    body = world.add_body(Circle(1.0, (-3, 0)), Circle(1.0, (3, 0)), position=(10, 5), angle=0.5)
    assert body.center == pytest.approx((10, 5), abs=1e-12) and body.inertia == pytest.approx(
        math.pi + 2 * math.pi * 9, rel=1e-12
    )
    body.apply_impulse((0.0, body.mass), (10 + 3 * math.cos(0.5), 5 + 3 * math.sin(0.5)))
    assert body.angular_velocity == pytest.approx(3 * math.cos(0.5) * body.mass / body.inertia, rel=1e-12)


@pytest.mark.parametrize("width, height", [(1, 1), (2, 2), (8, 8), (5, 13)])
def test_rectangle_of_pixels_weighs_as_a_box(width, height):
    """A rectangle of pixels has the mass and inertia of a box: pixels are squares, not points."""
    found = mass_of((PixelMask(np.ones((height, width), bool)),), 2.0)
    close(found, 2.0 * width * height, (0.0, 0.0), 2.0 * width * height * (width**2 + height**2) / 12)


def test_mask_weighs_as_the_union_of_its_squares():
    rng = np.random.default_rng(3)
    solid = rng.random((9, 14)) < 0.6
    found = mass_of((PixelMask(solid, origin=(0, 0)),), 1.0)
    truth = outlines.pixels(solid, 0, 0)
    assert found.mass == pytest.approx(truth.area, rel=1e-12) and found.center == pytest.approx(
        (truth.centroid.x, truth.centroid.y), rel=1e-12
    )
    cx, cy = found.center
    own = sum(
        1 / 6 + (i + 0.5 - cx) ** 2 + (j + 0.5 - cy) ** 2
        for j, row in enumerate(solid)
        for i, on in enumerate(row)
        if on
    )
    assert found.inertia == pytest.approx(own, rel=1e-12)


def test_segments_weigh_nothing_and_do_not_break_a_body():
    assert mass_of((Segment((0, 0), (5, 0)),), 1.0).mass == 0.0
    world = metres(gravity=(0, 0))
    body = world.add_body(Polygon.box(2, 2), Segment((0, 0), (9, 0)))
    assert body.mass == pytest.approx(4.0) and body.center == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize("density", [0, -1.0, NAN, INF, "1", None])
def test_mass_that_is_none_is_refused(density):
    for call in (lambda: Material(density=density), lambda: mass_of((Circle(1.0),), density)):
        with pytest.raises((ValueError, TypeError), match="density"):
            call()


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
def test_locked_rotation_keeps_impulses_finite(solver):
    world = metres(solver)
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -2.0), angle=0.4, velocity=(3.0, 0.0), fixed_rotation=True)
    for _ in range(120):
        world.step()
        assert np.isfinite(world.contacts["normal_impulse"]).all() and box.angle == 0.4 and box.angular_velocity == 0.0
    assert world.bodies["inverse_inertia"][box.id] == 0.0 and abs(box.velocity[1]) < 0.2


def test_density_cancels_from_what_is_seen():
    """The density does not change the motion of a falling box, from 1e-6 to 1e6."""
    ends = []
    for density in (1e-6, 1.0, 1e6):
        world = World(pile_effects(), solver="soft_step", gravity=(0, 10), pixels_per_meter=1.0)
        floor(world)
        box = world.add_body(Polygon.box(1, 2), position=(0.0, -3.0), angle=0.3, material=Material(density=density))
        for _ in range(90):
            world.step()
        ends.append((*box.position, box.angle))
    assert ends[0] == pytest.approx(ends[1], abs=1e-12) and ends[2] == pytest.approx(ends[1], abs=1e-12)
