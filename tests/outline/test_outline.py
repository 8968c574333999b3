"""Outlines follow the pixels within their documented limits: distances, centres, pieces, sharp corners, few corners."""

import numpy as np
import pytest
import shapely

from physics.outline.contour import outline
from tests.outline.rasters import connected, disc, gaps, hard, lies_on_the_right_side, noise, polygons, raster, sprites

SMOOTH = (0.0, 0.1, 0.25, 0.4, 0.5, 1.0)


def check(solid, smooth):
    pieces = outline(solid, smooth)
    figures = polygons(pieces)
    assert all(each.is_valid for each in figures)
    together = shapely.union_all(figures)
    assert sum(each.area for each in figures) == pytest.approx(together.area, abs=1e-9), "pieces overlap"
    assert lies_on_the_right_side(together, solid)
    from_pixels, to_pixels = gaps(together, solid)
    assert from_pixels <= smooth + 1e-9 and to_pixels <= smooth + 0.21
    return pieces


@pytest.mark.parametrize("smooth", SMOOTH)
@pytest.mark.parametrize("name", hard())
def test_awkward_pixels(name, smooth):
    check(hard()[name], smooth)


@pytest.mark.parametrize("smooth", SMOOTH)
def test_random_pixels(smooth):
    for solid in noise(3, 40):
        if solid.any():
            pieces = check(solid, smooth)
            assert connected(solid, True) <= len(pieces) <= connected(solid, False)


def test_sprites_keep_the_contract_with_few_corners():
    cracks = lines = 0
    for _, solid in sprites():
        cracks += sum(len(outer) + sum(map(len, holes)) for outer, holes in check(solid, 0.0))
        lines += sum(len(outer) + sum(map(len, holes)) for outer, holes in check(solid, 0.5))
    assert lines <= 0.45 * cracks, (lines, cracks)


def test_a_rectangle_of_any_size_is_its_four_corners():
    for width, height in ((1, 1), (1, 6), (2, 2), (2, 9), (3, 3), (40, 7)):
        solid = np.zeros((height + 3, width + 4), bool)
        solid[1 : 1 + height, 2 : 2 + width] = True
        ((outer, holes),) = outline(solid)
        corners = [[2, 1], [2 + width, 1], [2 + width, 1 + height], [2, 1 + height]]
        assert outer.tolist() == corners and holes == []


def test_corners_between_long_runs_stay_and_staircases_go():
    solid = raster(["######....", "######....", "######....", "##########", "##########", "##########"])
    ((outer, _),) = outline(solid)
    assert outer.tolist() == [[0, 0], [6, 0], [6, 3], [10, 3], [10, 6], [0, 6]]
    stairs = np.tri(20, dtype=bool)
    ((outer, _),) = outline(stairs)
    assert len(outer) <= 5 and {(0.0, 20.0)} <= set(map(tuple, outer.tolist()))


def test_a_disc_has_far_fewer_corners_than_cracks_and_its_area():
    for radius, most in ((4, 8), (8, 24), (16, 30), (32, 44)):
        ((outer, _),) = outline(disc(radius))
        assert len(outer) <= most
        assert shapely.Polygon(outer).area == pytest.approx(disc(radius).sum(), rel=0.03)


def test_a_diagonal_of_single_pixels_is_one_band():
    ((outer, _),) = outline(np.eye(12, dtype=bool))
    assert len(outer) <= 6 and shapely.Polygon(outer).area == pytest.approx(12.0, rel=0.05)
    assert len(outline(np.eye(12, dtype=bool), smooth=0.0)) == 12


@pytest.mark.parametrize("turn", [np.fliplr, np.flipud, np.rot90, np.transpose])
def test_mirrored_and_turned_pixels_have_outlines_as_good(turn):
    for _, solid in sprites():
        a, b = (sum(len(outer) for outer, _ in outline(np.ascontiguousarray(each))) for each in (solid, turn(solid)))
        assert abs(a - b) <= 1 + 0.08 * a


def test_the_same_pixels_give_the_same_outline():
    (a,), (b,) = outline(disc(9)), outline(disc(9))
    assert np.array_equal(a.outer, b.outer)
