"""Round pieces get round outlines within the documented limits, and masks are divided into parts."""

import math

import numpy as np
import pytest
import shapely
from shapely import LineString, Point, Polygon

from physics.outline.mask_parts import mask_parts
from physics.outline.rounding import DISC_CLEAR, DISC_SPARE
from tests.assets.art_reading import load
from tests.outline.rasters import disc, gaps, hard, lies_on_the_right_side, noise, raster, sprites

QUARTER = math.pi / 4


def figure(part):
    """Return a part as a shapely polygon: its corners, grown by its radius."""
    corners, _, radius = part
    core = (Point, Point, LineString, Polygon)[min(len(corners), 3)]
    return (core(corners[0]) if len(corners) == 1 else core(corners)).buffer(radius, quad_segs=256)


def check(solid, smooth=0.5):
    parts = mask_parts(solid, smooth)
    together = shapely.union_all([figure(each) for each in parts], grid_size=None)
    assert lies_on_the_right_side(together, solid, DISC_CLEAR if len(parts[0].corners) == 1 else 0.0)
    # The boundary of a union has slivers of rounding where parts meet in one line.
    whole = together.buffer(1e-7).buffer(-1e-7) if len(parts) > 1 else together
    from_pixels, to_pixels = gaps(whole, solid)
    spare = DISC_SPARE if len(parts[0].corners) == 1 else 0.0
    assert from_pixels <= smooth + spare + 1e-3 and to_pixels <= smooth + spare + 0.21
    for corners, inner, radius in parts:
        assert 1 <= len(corners) <= 16 and len(inner) == len(corners) and radius >= 0.0
        assert len(corners) > 2 or radius > 0.0
    return parts


def field(shape, size=60):
    """Return the pixels whose centre lies in a shape, a signed distance function of x and y from the middle."""
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2.0
    return shape(x, y) <= 0.0


def rounded_box(half_width, half_height, radius, angle=0.0):
    c, s = math.cos(angle), math.sin(angle)
    return field(
        lambda x, y: (
            np.hypot(np.maximum(abs(c * x + s * y) - half_width, 0), np.maximum(abs(c * y - s * x) - half_height, 0))
            - radius
        )
    )


@pytest.mark.parametrize("radius", [3, 4, 5, 8, 11.5, 16, 20, 24, 32, 48])
def test_a_disc_is_one_corner_in_the_middle(radius):
    solid = disc(radius)
    ((corners, inner, found),) = check(solid)
    assert corners.tolist() == [[solid.shape[1] / 2, solid.shape[0] / 2]] and not inner.any()
    assert found == pytest.approx(radius, abs=0.3)
    assert math.pi * found**2 == pytest.approx(solid.sum(), rel=0.05 if radius < 8 else 0.01)


@pytest.mark.parametrize("radius", [4, 8, 15.5, 16.3])
@pytest.mark.parametrize("around", [(0.5, 0.5), (0.5, 0.0), (0.2, 0.3)])
def test_a_disc_between_the_pixels_is_round_too(radius, around):
    ((corners, _, found),) = check(disc(radius, around))
    assert len(corners) <= 2 and found == pytest.approx(radius, abs=0.3)


@pytest.mark.parametrize(
    "half, radius, angle", [(10, 6, 0), (4, 4, 0), (12, 5, QUARTER), (12, 5, 2 * QUARTER), (12, 5, 0.3), (15, 8, 1.1)]
)
def test_a_pill_is_two_corners(half, radius, angle):
    ((corners, _, found),) = check(rounded_box(half, 0, radius, angle))
    assert len(corners) == 2 and found == pytest.approx(radius, abs=0.3)
    assert math.dist(*corners) == pytest.approx(2 * half, abs=1.0)
    assert corners.mean(axis=0) == pytest.approx([30, 30], abs=0.1)


@pytest.mark.parametrize("box", [(10, 6, 6), (8, 8, 4), (10, 6, 3), (6, 6, 8, 0.2)])
def test_a_rounded_box_is_four_corners(box):
    ((corners, _, radius),) = check(rounded_box(*box))
    assert len(corners) == 4 and radius >= 0.7 * box[2]


def test_a_sharp_corner_is_never_rounded():
    solid = disc(8)
    solid[10:18, 10:18] = True  # a drop: round on three sides
    parts = check(solid)
    assert all(radius == 0.0 for _, _, radius in parts)
    assert any([18.0, 18.0] in corners.tolist() for corners, _, _ in parts)
    for width, height in ((1, 1), (2, 2), (1, 7), (6, 6), (40, 3)):
        ((corners, inner, radius),) = check(np.ones((height, width), bool))
        assert corners.tolist() == [[0, 0], [width, 0], [width, height], [0, height]] and radius == 0.0
        assert not inner.any()


@pytest.mark.parametrize("smooth", [0.0, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("name", hard())
def test_awkward_pixels_have_parts(name, smooth):
    check(hard()[name], smooth)


def test_random_pixels_have_parts():
    for solid in noise(9, 60):
        if solid.any():
            check(solid)
    assert mask_parts(np.zeros((3, 3), bool)) == []


def test_sprites_have_parts_and_few():
    counts = {name: len(check(solid)) for name, solid in sprites()}
    things, _ = load("things")
    for name in ("crate_large", "coin_0"):
        assert len(check(things[name][:, :, 3] > 127)) == 1, name
    assert max(counts.values()) <= 40 and sum(counts.values()) <= 200, counts


def test_inner_sides_are_shared_and_others_are_not():
    bar = raster(["###...", "###...", "######", "######", "######"])
    parts = check(bar)
    assert len(parts) == 2
    shared = [
        tuple(sorted((tuple(a), tuple(b))))
        for corners, inner, _ in parts
        for a, b in zip(corners[inner].tolist(), np.roll(corners, -1, axis=0)[inner].tolist(), strict=True)
    ]
    assert len(shared) == 2 and shared[0] == shared[1]
