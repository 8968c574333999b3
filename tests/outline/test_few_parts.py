"""Numbers of convex parts compared with published methods: Hertel and Mehlhorn 1983, and the minimum of cuts between
corners.
"""

import math

import numpy as np
import pytest
import shapely
from shapely import Polygon

from physics.outline.contour import outline
from physics.outline.decompose import convex_parts, partition
from physics.outline.mask_parts import few_parts
from tests.oracles.convex_pieces import hertel_mehlhorn, reflex_count, tangle
from tests.outline.rasters import hard, noise, sprites


def test_two_hundred_polygons_beside_published_counts():
    """Each of 200 polygons gets at least the lower bound of parts and at most those of Hertel and Mehlhorn's method.

    In total there are at least 2 % fewer parts than with Hertel and Mehlhorn's method.
    """
    rng = np.random.default_rng(2026)
    ours = theirs = 0
    for k in range(200):
        corners = tangle(rng, 6 + k % 20)
        parts, other = len(convex_parts(corners)), hertel_mehlhorn(corners)
        assert math.ceil(reflex_count(corners) / 2) + 1 <= parts <= other
        ours, theirs = ours + parts, theirs + other
    assert ours <= 0.98 * theirs, (ours, theirs)


def test_quick_parts_of_sprites_are_few():
    """The fast partition of sprites has at most 18 % more parts than the best one.

    The reason is that it also cuts where a side would be inner only for a part of its length.
    """
    quick = best = theirs = 0
    for _, solid in sprites():
        for outer, holes in outline(solid):
            quick += len(few_parts([outer, *holes]))
            best += len(partition([outer, *holes]))
            theirs += hertel_mehlhorn(outer, holes)
    assert best <= quick <= 1.18 * best and quick < 1.05 * theirs, (quick, best, theirs)


@pytest.mark.parametrize("smooth", [0.0, 0.5])
@pytest.mark.parametrize("solid", [*hard().values(), *noise(8, 40, 24)])
def test_quick_parts_are_the_outline_exactly(solid, smooth):
    for outer, holes in outline(solid, smooth):
        parts = few_parts([outer, *holes])
        whole, figures = Polygon(outer, holes), [Polygon(corners) for corners, _ in parts]
        assert sum(each.area for each in figures) == pytest.approx(whole.area, rel=1e-12)
        assert shapely.union_all(figures).symmetric_difference(whole).area <= 1e-9
        for corners, inner in parts:
            assert 3 <= len(corners) <= 16 and len(inner) == len(corners)
            sides = np.roll(corners, -1, axis=0) - corners
            onward = np.roll(sides, -1, axis=0)
            turns = sides[:, 0] * onward[:, 1] - sides[:, 1] * onward[:, 0]
            assert (turns >= 0.0).all() and (inner != np.roll(inner, -1))[turns == 0.0].all()
            for start, side, shared in zip(corners, sides, inner, strict=True):
                assert (whole.boundary.distance(shapely.Point(start + 0.3137 * side)) > 1e-9) == shared
