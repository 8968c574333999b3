"""Vec2 is a tuple of two numbers with vector arithmetic on either side; every point that the API returns is one."""

import copy
import math
import pickle

import numpy as np
import pytest

from physics import (
    Capsule,
    Chain,
    Character,
    Circle,
    PixelMask,
    Polygon,
    Segment,
    Vec2,
    World,
    collide,
    distance,
    mass_of,
    time_of_impact,
)

V = Vec2(3.0, -4.0)


@pytest.mark.parametrize("pair", [(1.0, 2.0), [1, 2], np.array([1.0, 2.0]), Vec2(1, 2), (np.float32(1), np.int64(2))])
def test_element_by_element_with_any_pair_from_either_side(pair):
    for found, wanted in (
        (V + pair, (4, -2)), (pair + V, (4, -2)), (V - pair, (2, -6)), (pair - V, (-2, 6)),
        (V * pair, (3, -8)), (pair * V, (3, -8)), (V / pair, (3, -2)), (pair / V, (1 / 3, -0.5)),
    ):  # fmt: skip
        assert type(found) is Vec2 and found == wanted


@pytest.mark.parametrize("number", [2, 2.0, np.float64(2), np.float32(2), np.int64(2)])
def test_by_a_number_from_either_side(number):
    for found, wanted in (
        (V + number, (5, -2)), (number + V, (5, -2)), (V - number, (1, -6)), (number - V, (-1, 6)),
        (V * number, (6, -8)), (number * V, (6, -8)), (V / number, (1.5, -2)), (number / V, (2 / 3, -0.5)),
    ):  # fmt: skip
        assert type(found) is Vec2 and found == wanted


def test_it_is_a_pair():
    x, y = V
    assert (x, y) == V == (3, -4) and V == (V.x, V.y) == V[:2] and hash(V) == hash((3, -4)) and (3, -4) in {V}
    assert -V == (-3, 4) and sum([V, V, V]) == (9, -12) and len(V) == 2 and isinstance(V, tuple)
    for again in (copy.deepcopy(V), pickle.loads(pickle.dumps(V)), Vec2(*np.array(V))):
        assert again == V and type(again) is Vec2
    many = np.ones((3, 2))
    assert np.array_equal(many - V, [[-2, 5]] * 3) and np.array_equal(V * many, [[3, -4]] * 3)


def test_lengths_and_turns():
    assert V.length == 5 and V.dot((2, 1)) == 2 and V.cross((2, 1)) == 11 and Vec2(1, 0).cross((0, 1)) == 1
    assert Vec2(0, 2).angle == math.pi / 2 and Vec2(0, 0).angle == 0 and Vec2(-1, 0).angle == math.pi
    assert Vec2(1, 0).rotated(math.pi / 2) == pytest.approx((0, 1)), "clockwise on the screen"
    assert V.normalized() == pytest.approx((0.6, -0.8)) and Vec2(1e-320, 0).normalized() == (1, 0)
    assert Vec2(3e200, 4e200).length == pytest.approx(5e200) and Vec2(3e200, 4e200).normalized() == pytest.approx(
        (0.6, 0.8)
    )


@pytest.mark.parametrize("value", ["ab", None, (1, 2, 3), (1,), ("a", 1), {}, 1j, True, (True, 1), b"ab"])
def test_what_is_no_pair_is_refused(value):
    for call in (
        lambda: V + value, lambda: value + V, lambda: V - value, lambda: value - V, lambda: V * value,
        lambda: value * V, lambda: V / value, lambda: value / V, lambda: V.dot(value), lambda: V.cross(value),
    ):  # fmt: skip
        with pytest.raises(TypeError):
            call()


def test_what_has_no_direction_is_refused():
    for vector in (Vec2(0, 0), Vec2(math.nan, 1), Vec2(math.inf, 0)):
        with pytest.raises(ValueError, match="normalized"):
            vector.normalized()
    for angle, error in ((math.inf, ValueError), (math.nan, ValueError), ("1", TypeError), (None, TypeError)):
        with pytest.raises(error, match="angle"):
            V.rotated(angle)
    with pytest.raises(ZeroDivisionError):
        V / 0


def test_all_that_is_handed_out_as_a_point_is_one():
    world = World()
    ball = world.add_body(Circle(5, (1, 0)), position=[3, 4], velocity=np.array([1, 2]))
    hero = Character(world, Polygon.box(8, 8), (90, 90))
    mask = PixelMask(np.ones((3, 5), bool))
    hit, near = world.ray_cast((-50, 4), (100, 0)), world.closest((0, 50))
    manifold = collide(Circle(5), (0, 0), Circle(5), (8, 0))
    gap = distance(Circle(5), (0, 0), Circle(5), (18, 0))
    impact = time_of_impact(Circle(5), (0, 0), (9, 0), Circle(5), (18, 0), (9, 0))
    segment, capsule = Segment((0, 0), (1, 1)), Capsule((0, 0), (1, 1), 2)
    found = [
        ball.position, ball.center, ball.velocity, ball.to_world((0, 0)), ball.to_local((0, 0)),
        ball.velocity_at((0, 0)),
        hero.position, world.gravity, world.wind, hit.point, hit.normal, near[1], manifold.normal,
        gap.point_a, gap.point_b, gap.normal, impact.point, impact.normal, mask.origin, mask.centroid,
        ball.shapes[0].center, segment.a, segment.b, capsule.a, capsule.b, *Polygon.box(2, 2).points,
        *Chain([(0, 0), (1, 1)]).points, mass_of(Circle(5), 1.0).center, mass_of((Circle(5), capsule), 1.0).center,
        mass_of(Polygon.box(2, 2), 1.0).center, mass_of(Polygon.box(2, 2).points and mask, 1.0).center,
    ]  # fmt: skip
    assert [type(each) for each in found] == [Vec2] * len(found)
    assert all(type(each.x) is float and type(each.y) is float for each in found)
