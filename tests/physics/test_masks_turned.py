"""Rotated masks: always computed from the source, with the area of the source."""

import math

import numpy as np
import pytest

from physics import JIT, Effects, PixelMask, World, collide


def drawn(mask, angle, size=120):
    """Return a square pixel array with the rotated mask, its origin in the middle."""
    turned = mask.turned(angle)
    canvas = np.zeros((size, size), bool)
    left, top = size // 2 - round(turned.origin[0]), size // 2 - round(turned.origin[1])
    canvas[top : top + turned.solid.shape[0], left : left + turned.solid.shape[1]] = turned.solid
    return canvas


def random_mask(seed, w=23, h=17, density=0.6):
    solid = np.random.default_rng(seed).random((h, w)) < density
    return PixelMask(solid, origin=(10.0, 8.0))


@pytest.mark.parametrize("shape", [(1, 32), (32, 32), (5, 40), (31, 3), (1, 1), (2, 2)])
def test_turning_keeps_the_area_exactly(shape):
    mask = PixelMask(np.ones(shape, bool))
    for degrees in range(0, 360, 5 if JIT else 15):
        assert mask.turned(math.radians(degrees)).solid.sum() == mask.area, degrees


def test_turning_a_random_mask_keeps_its_area():
    for seed in range(5):
        mask = random_mask(seed)
        for degrees in range(0, 360, 13 if JIT else 45):
            assert mask.turned(math.radians(degrees)).solid.sum() == mask.area


@pytest.mark.parametrize("turns", [0, 1, 2, 3, 4, -1, -4, 7, 1000])
def test_quarter_turns_are_exact(turns):
    solid = np.random.default_rng(1).random((17, 23)) < 0.5
    mask = PixelMask(solid, origin=(23 / 2, 17 / 2))
    assert np.array_equal(mask.turned(turns * math.pi / 2).solid, np.rot90(solid, -turns))


def test_quarter_turn_carries_the_origin_along():
    solid = np.zeros((4, 6), bool)
    solid[0, 5] = True  # top right: its centre is (5.5, 0.5), from the origin (4.5, -1.5)
    mask = PixelMask(solid, origin=(1.0, 2.0))
    for turns in range(4):
        turned = mask.turned(turns * math.pi / 2)
        (y,), (x,) = np.nonzero(turned.solid)
        c, s = round(math.cos(turns * math.pi / 2)), round(math.sin(turns * math.pi / 2))
        wanted = (c * 4.5 - s * -1.5, s * 4.5 + c * -1.5)
        assert (x + 0.5 - turned.origin[0], y + 0.5 - turned.origin[1]) == wanted


def test_full_turn_in_small_steps_ends_at_the_source():
    world = World(Effects(rotation=True))
    body = world.add_body(random_mask(3), angular_velocity=math.tau)
    start = drawn(random_mask(3), 0.0)
    for _ in range(60):
        world.step()
    assert np.array_equal(drawn(body.shapes[0], body.angle), start)


def test_turned_mask_stays_over_the_turned_outline():
    """The centre of each pixel of a rotated mask, rotated back, is less than 0.8 px from a solid source pixel."""
    mask = PixelMask(np.ones((9, 30), bool))
    for degrees in (0, 11.25, 30.9375, 45, 61.875, 90, 135):
        turned = mask.turned(math.radians(degrees))
        angle = round(math.radians(degrees) * 128 / math.tau) * math.tau / 128
        c, s = math.cos(angle), math.sin(angle)
        for y, x in zip(*np.nonzero(turned.solid), strict=True):
            u, v = x + 0.5 - turned.origin[0], y + 0.5 - turned.origin[1]
            bx, by = c * u + s * v + mask.origin[0], -s * u + c * v + mask.origin[1]
            gap = max(0 - bx, bx - 30, 0 - by, by - 9, 0.0)
            assert gap <= 0.8, (degrees, gap)


def test_each_kept_pixel_shows_a_solid_source_pixel_near_it():
    mask = random_mask(2)
    turned = mask.turned(0.7)
    kept = turned.solid
    assert ((turned.source_x >= 0) == kept).all() and ((turned.source_y >= 0) == kept).all()
    assert mask.solid[turned.source_y[kept], turned.source_x[kept]].all()


def test_turning_twice_gives_the_very_same_turned_mask():
    mask = random_mask(4)
    first = mask.turned(0.5).solid.copy()
    for angle in (0.1, 0.2, 3.0, 0.5 + math.tau, 0.5):
        mask.turned(angle)
    assert np.array_equal(mask.turned(0.5).solid, first)
    assert np.array_equal(mask.turned(0.5 - 20 * math.tau).solid, first)


def test_thin_line_lets_no_pixel_ball_through_at_any_angle():
    """A rotated line of 1 x 32 pixels stays connected by edges or corners at any angle, so no pixel ball passes."""
    line = PixelMask(np.ones((1, 32), bool))
    for degrees in range(0, 91, 3):
        todo = set(zip(*map(np.ndarray.tolist, np.nonzero(line.turned(math.radians(degrees)).solid)), strict=True))
        reached = [next(iter(todo))]
        todo.discard(reached[0])
        while reached:
            y, x = reached.pop()
            near = {(y + j, x + i) for j in (-1, 0, 1) for i in (-1, 0, 1)} & todo
            todo -= near
            reached += near
        assert not todo, degrees


def test_far_turned_angles_are_drawn_and_hit():
    mask = PixelMask(np.ones((4, 20), bool))
    upright = collide(mask, (0, 0, math.pi / 2), mask, (0, 9, 0))
    far = collide(mask, (0, 0, math.pi / 2 + 1e4 * math.tau), mask, (0, 9, 0))
    assert upright.area == far.area == 4 * 3
    assert len(collide(mask, (0, 0, 0), mask, (0, 9, 0))) == 0
