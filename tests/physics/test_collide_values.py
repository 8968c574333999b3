"""collide(), mass_of and Polygon in cases whose exact result is known."""

import math

import numpy as np
import pytest

from physics import Bounds, Circle, Effects, Filter, Material, PixelMask, Polygon, TileGrid, World, collide, mass_of


def test_circles_in_closed_form():
    found = collide(Circle(5.0), (0, 0, 0), Circle(3.0), (6, 0, 0))
    assert (found.normal, found.separations.tolist(), found.points.tolist(), found.area) == ((1, 0), [-2], [[4, 0]], 0)
    assert len(collide(Circle(5.0), (0, 0, 0), Circle(3.0), (8, 0, 0))) == 1, "touching is a contact"
    assert collide(Circle(5.0), (0, 0, 0), Circle(3.0), (8, 0, 0)).separations.tolist() == [0.0]
    assert len(collide(Circle(5.0), (0, 0, 0), Circle(3.0), (8.0000001, 0, 0))) == 0
    apart = collide(Circle(5.0), (0, 0, 0), Circle(3.0), (0, 9, 0), margin=1.0)
    assert apart.separations.tolist() == [1.0] and apart.points.tolist() == [[0, 5.5]] and apart.normal == (0, 1)


def test_boxes_face_to_face_have_two_points():
    found = collide(Polygon.box(1, 1), (0, 0, 0), Polygon.box(1, 1), (0.9, 0, 0))
    assert len(found) == 2 and found.normal == (1.0, 0.0)
    assert found.separations == pytest.approx([-0.1, -0.1], abs=1e-12)
    assert sorted(found.points[:, 1].tolist()) == [-0.5, 0.5] and found.points[:, 0] == pytest.approx(0.45)
    assert len(set(found.features.tolist())) == 2


@pytest.mark.parametrize("exponent", range(-12, -3))
@pytest.mark.parametrize("sign", [-1, 1])
def test_nearly_parallel_faces_keep_two_points_and_their_normal(exponent, sign):
    angle = sign * 10.0**exponent
    found = collide(Polygon.box(1, 1), (0, 0, 0), Polygon.box(1, 1), (0.9, 0, angle))
    assert len(found) == 2
    assert math.hypot(found.normal[0] - 1.0, found.normal[1]) <= abs(angle) + 1e-12


def test_touching_edges_and_corners_are_contacts():
    box = Polygon.box(10, 10)
    for pose in ((10, 0, 0), (0, 10, 0), (10, 10, 0), (-10, 10, 0), (10, 4, 0)):
        found = collide(box, (0, 0, 0), box, pose)
        assert len(found) >= 1 and found.separations.tolist() == [0.0] * len(found), pose
        assert len(collide(box, (0, 0, 0), box, (pose[0] * 1.0001, pose[1] * 1.0001, 0))) == 0
    assert collide(box, (0, 0, 0), Circle(2), (7, 0, 0)).separations.tolist() == [0.0]
    assert len(collide(TileGrid(np.ones((1, 1), bool), 8), (0, 0, 0), Circle(2), (10, 4, 0))) == 1


def test_concentric_shapes_have_their_documented_way_out():
    found = collide(Circle(5.0), (3, 3, 0), Circle(5.0), (3, 3, 0))
    assert (found.normal, found.separations.tolist()) == ((1.0, 0.0), [-10.0])
    boxes = collide(Polygon.box(8, 4), (0, 0, 0), Polygon.box(8, 4), (0, 0, 0))
    assert boxes.separations.min() == -4.0 and abs(boxes.normal[1]) == 1.0
    middle = collide(Polygon.box(8, 4), (0, 0, 0), Circle(1.0), (0, 0, 0))
    assert middle.separations.tolist() == [-3.0] and abs(middle.normal[1]) == 1.0
    on_edge = collide(Polygon.box(8, 4), (0, 0, 0), Circle(1.0), (4, 0, 0))
    assert (on_edge.normal, on_edge.separations.tolist()) == ((1.0, 0.0), [-1.0])
    on_corner = collide(Polygon.box(8, 4), (0, 0, 0), Circle(1.0), (4, 2, 0))
    assert on_corner.separations.tolist() == [-1.0] and math.hypot(*on_corner.normal) == pytest.approx(1.0)


def test_circle_centre_follows_the_turned_body():
    found = collide(Circle(1.0, center=(10, 0)), (0, 0, math.pi / 2), Circle(1.0), (0, 11.5, 0))
    assert found.separations == pytest.approx([-0.5]) and found.normal == pytest.approx((0, 1))


def test_bounds_are_the_aabb_at_the_pose():
    bar = Bounds(Polygon.box(10, 2))
    assert len(collide(bar, (0, 0, math.pi / 4), Circle(0.1), (4.0, -4.0, 0))) == 1
    assert len(collide(Polygon.box(10, 2), (0, 0, math.pi / 4), Circle(0.1), (4.0, -4.0, 0))) == 0
    assert len(collide(Bounds(Circle(5)), (0, 0, 0), Circle(0.1), (4.9, 4.9, 0))) == 1
    mask = Bounds(PixelMask(np.eye(8, dtype=bool)))
    assert len(collide(mask, (4, 4, 0), Circle(0.1), (7.9, 0.1, 0))) == 1


def test_deep_box_leaves_by_the_nearest_side():
    found = collide(Polygon.box(100, 100), (0, 0, 0), Polygon.box(1, 1), (30, 49, 0))
    assert found.normal == (0.0, 1.0) and found.separations.min() == pytest.approx(-1.5)


def test_masses_in_closed_form():
    disc, box = mass_of(Circle(3.0, (5, -1)), 2.0), mass_of(Polygon.box(4, 6, (1, 2), 0.7), 3.0)
    assert (disc.mass, disc.center, disc.inertia) == (
        2 * math.pi * 9,
        (5, -1),
        pytest.approx(2 * math.pi * 81 / 2, rel=1e-14),
    )
    assert box.mass == pytest.approx(72) and box.center == pytest.approx((1, 2))
    assert box.inertia == pytest.approx(72 * (16 + 36) / 12, rel=1e-12)
    far = mass_of(Polygon.box(2, 2, (1e8, -1e8)), 1.0)
    assert (far.mass, far.center, far.inertia) == (
        pytest.approx(4),
        pytest.approx((1e8, -1e8)),
        pytest.approx(8 / 3, rel=1e-9),
    )
    both = mass_of((Circle(1.0, (-3, 0)), Circle(1.0, (3, 0))), 1.0)
    assert both.center == (0, 0) and both.inertia == pytest.approx(2 * (math.pi / 2 + 9 * math.pi), rel=1e-14)
    assert mass_of(TileGrid(np.ones((2, 2), bool), 8), 1.0).mass == 0.0


def test_polygons_of_either_winding_are_the_same_shape():
    corners = [(0, 0), (10, 0), (10, 5), (0, 5)]
    one, two = Polygon(corners), Polygon(corners[::-1])
    assert mass_of(one, 1) == mass_of(two, 1) or mass_of(one, 1).inertia == pytest.approx(mass_of(two, 1).inertia)
    for shape in (one, two):
        assert collide(shape, (0, 0, 0), Circle(1), (5, 5.5, 0)).normal == (0.0, 1.0)


@pytest.mark.parametrize(
    "corners, word",
    [
        ([(0, 0), (1, 0)], "3..16"),
        ([(math.cos(t), math.sin(t)) for t in range(17)], "3..16"),
        ([(0, 0), (10, 0), (5, 2), (5, 10)], "convex"),
        ([(0, 0), (1, 1), (2, 2)], "line"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "equal"),
        ([(0, 0), (5, 0), (10, 0), (5, 8)], "line"),
        ([(math.cos(4 * k * math.pi / 5), math.sin(4 * k * math.pi / 5)) for k in range(5)], "convex"),
        ([(0, 0), (10, 10), (10, 0), (0, 10)], "convex"),
    ],
)
def test_polygons_that_are_none_are_refused(corners, word):
    with pytest.raises(ValueError, match=word):
        Polygon(corners)


def test_narrowphase_off_makes_a_contact_of_every_aabb_overlap():
    world = World(Effects(narrowphase=False))
    world.add_body(Circle(5.0))
    world.add_body(Circle(5.0), position=(9.0, 8.0))  # apart as discs
    world.step()
    (contact,) = world.contacts
    assert (contact["normal_x"], contact["normal_y"], contact["separation"]) == (1.0, 0.0, -1.0)
    assert (contact["point_x"], contact["point_y"]) == (4.5, 4.0) and world.profile.counters["mask_tests"] == 0
    world.set_narrowphase(True)
    world.step()
    assert len(world.contacts) == 0 and len(world.events.end) == 1


def test_filters_pack_and_meet_both_ways():
    assert Filter.from_packed(0xABCD1234) == Filter(0x1234, 0xABCD)
    assert Filter.ALL == Filter(0xFFFFFFFF, 0xFFFFFFFF) and Filter() == Filter(1, 0xFFFFFFFF)
    assert Material() == Material(1.0, 0.6, 0.0)
