"""Area shared by two masks at any pose, computed from one outline: area, centroid and derivative, compared with
Shapely.
"""

import math

import numpy as np
import pytest

from physics import PixelMask
from physics.raster.exact import SquaresPair, outline_shares, shared_squares
from physics.shapes.library import Library

pytest.importorskip("shapely")
from shapely import affinity, box, unary_union  # noqa: E402

ANGLES = (0.0, 1e-9, 0.3, math.pi / 4, math.pi / 2, 2.2, math.pi, -1.1)
SIZES = ((1, 1), (3, 5), (17, 9), (40, 40), (64, 20), (65, 20), (130, 12))


def pixels_of(kind, size, rng):
    """Return a mask's pixels: noise, a solid disc, or a frame with a hole."""
    width, height = size
    y, x = np.indices((height, width))
    if kind == "noise":
        solid = rng.random((height, width)) < 0.5
    elif kind == "disc":
        solid = np.hypot((x + 0.5) / width - 0.5, (y + 0.5) / height - 0.5) < 0.5
    else:
        solid = (x == 0) | (y == 0) | (x == width - 1) | (y == height - 1)
    solid[0, 0] = True  # a mask has a pixel
    return solid


def region_of(solid):
    """Return the union of the squares of the solid pixels."""
    return unary_union([box(x, y, x + 1, y + 1) for y, x in zip(*np.nonzero(solid), strict=True)])


def pair_of(first, second, u, v, angle):
    """Return the `SquaresPair` of two arrays of pixels.

    The second has its top left corner at (u, v) [px] and is rotated about it by `angle`.
    """
    library = Library()
    masks = [library.add(PixelMask.from_array(each, snap=False))[1] for each in (first, second)]
    frame, other = (int(library.raster_of[mask, 0]) for mask in masks)
    tables = library.tables
    cosine, sine = math.cos(angle), math.sin(angle)
    if angle == 0.0:
        cosine, sine = 1.0, 0.0
    return SquaresPair(tables.rasters, tables.words, frame, other, u, v, cosine, sine)


def check(pair, first, second, tolerance):
    """Compare the `Shares` of a pair with those of the unions of pixel squares, computed by shapely.

    tolerance: allowed error of areas [px²].
    """
    frame, turned = region_of(first), region_of(second)

    def shared(dx=0.0, dy=0.0):
        terms = [pair.cosine, -pair.sine, pair.sine, pair.cosine, pair.u + dx, pair.v + dy]
        return frame.intersection(affinity.affine_transform(turned, terms))

    found, expected = outline_shares(pair), shared()
    assert abs(found.area - expected.area) <= tolerance
    centroid = expected.centroid if expected.area > 0.0 else None
    moments = (expected.area * centroid.x, expected.area * centroid.y) if centroid else (0.0, 0.0)
    assert np.hypot(found.moment_x - moments[0], found.moment_y - moments[1]) <= 200.0 * tolerance
    assert abs(found.loss_x - (shared(dx=-1.0).area - shared(dx=1.0).area)) <= tolerance
    assert abs(found.loss_y - (shared(dy=-1.0).area - shared(dy=1.0).area)) <= tolerance
    assert abs(shared_squares(pair).area - expected.area) <= tolerance


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("kind", ["noise", "disc", "frame"])
@pytest.mark.parametrize("angle", ANGLES)
def test_shares_are_those_of_the_unions_of_squares(kind, size, angle):
    rng = np.random.default_rng(len(kind) + size[0])
    first, second = pixels_of(kind, size, rng), pixels_of(kind, size[::-1] if rng.random() < 0.5 else size, rng)
    for _ in range(3):
        u, v = rng.uniform(-0.6, 0.6, 2) * size
        if rng.random() < 0.3:
            u, v = round(u), round(v)
        check(pair_of(first, second, float(u), float(v), angle), first, second, 1e-9)


@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0])
def test_the_share_of_a_sliver_is_exact_relative_to_itself(angle, depth):
    square = np.ones((20, 20), bool)
    # The corner of the turned square lies above the middle of the lower side of the first one, by `depth`.
    pair = pair_of(square, square, 9.3, 20.0 - depth, angle)
    found = shared_squares(pair)
    if angle == 0.0:
        area, low = depth * 10.7, 9.3
        assert found.moment_x / found.area == pytest.approx(0.5 * (low + 20.0), abs=1e-4)
    else:
        area = 0.5 * depth * depth * (math.tan(angle) + 1.0 / math.tan(angle))
    assert found.area == pytest.approx(area, rel=2e-3 if depth > 1e-11 else 2e-1)
    assert found.moment_y / found.area == pytest.approx(20.0, abs=2.0 * depth + 1e-4)
