"""Convex parts equal the polygon exactly, are few, and mark their inner sides."""

import math

import numpy as np
import pytest
import shapely
from shapely import Polygon

from physics.outline.contour import outline
from physics.outline.decompose import convex_parts, shaved, simple_rings
from tests.oracles.convex_pieces import fewest, hertel_mehlhorn, reflex_count, tangle
from tests.outline.rasters import disc, hard, noise, sprites

CROSS = np.array(
    [[1, 0], [2, 0], [2, 1], [3, 1], [3, 2], [2, 2], [2, 3], [1, 3], [1, 2], [0, 2], [0, 1], [1, 1]], float
)
SQUARE = np.array([[0, 0], [10, 0], [10, 10], [0, 10]], float)


def check(outer, holes=()):
    """Return the convex parts of a polygon, after a check of their properties.

    They must cover the polygon exactly and be convex, with at most 16 corners. Sides marked as inner must be inside the
    polygon, and the others on its outline.
    """
    parts = convex_parts(outer, holes)
    whole = Polygon(outer, holes)
    size = float(np.ptp(outer, axis=0).max())
    figures = [Polygon(corners) for corners, _ in parts]
    assert sum(each.area for each in figures) == pytest.approx(whole.area, rel=1e-9)
    assert shapely.union_all(figures).symmetric_difference(whole).area <= 1e-9 * whole.area
    given = {tuple(each) for ring in (outer, *holes) for each in np.asarray(ring, float).tolist()}
    for corners, inner in parts:
        assert 3 <= len(corners) <= 16 and len(inner) == len(corners)
        sides = np.roll(corners, -1, axis=0) - corners
        onward = np.roll(sides, -1, axis=0)
        turns = sides[:, 0] * onward[:, 1] - sides[:, 1] * onward[:, 0]
        assert turns.min() >= -1e-12 * size**2, "clockwise on the screen and convex"
        straight = np.abs(turns) <= 1e-12 * size**2
        assert (inner != np.roll(inner, -1))[straight].all(), "a corner in a line parts two kinds of sides"
        assert min(map(tuple, corners[:, ::-1].tolist())) == tuple(corners[0, ::-1].tolist())
        if size > 1e-3:
            assert {tuple(np.round(each, 9)) for each in corners} <= {tuple(np.round(each, 9)) for each in given}
        for start, side, shared in zip(corners, sides, inner, strict=True):
            # Not in the middle: a line of cuts may pass a corner there.
            assert (whole.boundary.distance(shapely.Point(start + 0.3137 * side)) > 1e-9 * size) == shared
    return parts


@pytest.mark.parametrize("count", [4, 5, 7, 9])
def test_no_cuts_between_corners_leave_fewer_parts(count):
    rng = np.random.default_rng(count)
    for _ in range(8):
        corners = tangle(rng, count)
        assert len(check(corners)) == fewest(corners)


def test_never_more_parts_than_hertel_and_mehlhorn():
    rng = np.random.default_rng(5)
    ours = theirs = 0
    for count in (12, 20, 30, 40, 60):
        for _ in range(4):
            corners = tangle(rng, count)
            parts, other = len(check(corners)), hertel_mehlhorn(corners)
            assert math.ceil(reflex_count(corners) / 2) + 1 <= parts <= other
            ours, theirs = ours + parts, theirs + other
    assert ours < theirs, (ours, theirs)


def test_sprites_come_near_the_lower_bound():
    ours = least = theirs = 0
    for _, solid in sprites():
        for outer, holes in outline(solid):
            ours += len(check(outer, holes))
            theirs += hertel_mehlhorn(outer, holes)
            least += max(1, math.ceil(reflex_count(outer, holes) / 2) + 1 - len(holes))
    assert least <= ours <= 1.2 * least and ours < theirs, (least, ours, theirs)


@pytest.mark.parametrize("smooth", [0.0, 0.5])
@pytest.mark.parametrize("solid", [*hard().values(), *noise(6, 40)])
def test_outlines_of_any_pixels_can_be_cut(solid, smooth):
    for outer, holes in outline(solid, smooth):
        check(outer, holes)


def test_known_counts():
    assert len(check(SQUARE)) == 1
    assert len(check(CROSS)) == 3, "the bar goes through"
    assert len(check(SQUARE, [SQUARE / 2 + 2])) == 4, "a frame"
    assert len(check(np.array([[0, 0], [9, 0], [9, 9], [5, 2]], float))) == 2
    many = np.array([[math.cos(k * math.tau / 40), math.sin(k * math.tau / 40)] for k in range(40)])
    assert len(check(many)) == 4, "16 corners at most"


def test_large_polygons_are_halved_first():
    rng = np.random.default_rng(8)
    corners = tangle(rng, 150)
    parts = check(corners)
    assert len(parts) <= 1.0 * hertel_mehlhorn(corners)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 2.0**40])
@pytest.mark.parametrize("turned", [0.0, 0.3])
def test_size_place_and_winding_do_not_matter(scale, turned):
    turn = np.array([[math.cos(turned), math.sin(turned)], [-math.sin(turned), math.cos(turned)]])
    counts = set()
    for figure, holes in ((CROSS, []), (SQUARE, [SQUARE / 5 + 1, SQUARE / 5 + 6])):
        for direction in (1, -1):
            placed = [(each[::direction] @ turn) * scale + 3 * scale for each in (figure, *holes)]
            counts.add((len(figure), len(check(placed[0], placed[1:]))))
    assert len(counts) == 2


def test_repeated_corners_and_corners_in_a_line_are_left_out():
    corners = np.array([[0, 0], [0, 0], [3, 0], [6, 0], [6, 6], [6, 6], [6, 6], [0, 6], [0, 3]], float)
    ((part, inner),) = convex_parts(corners)
    assert part.tolist() == [[0, 0], [6, 0], [6, 6], [0, 6]] and not inner.any()


def test_holes_may_touch_in_corners():
    diamond = np.array([[5, 0], [6, 2], [5, 4], [4, 2]], float)
    outer = np.array([[0, 0], [5, 0], [10, 0.5], [10, 10], [0, 10]], float)
    check(outer, [diamond])
    check(
        SQUARE, [np.array([[2, 2], [4, 2], [4, 4], [2, 4]], float), np.array([[4, 4], [6, 4], [6, 6], [4, 6]], float)]
    )


@pytest.mark.parametrize(
    "outer, holes, words",
    [
        ([[0, 0], [9, 9], [9, 0], [0, 9]], [], r"edge 0 of points.* meets edge 2 of points"),
        ([[0, 0], [9, 0], [9, 5], [4, 0], [0, 5]], [], r"edge 0 of points.* meets edge [23] of points"),
        ([[0, 0], [5, 0], [3, 0], [9, 9]], [], r"edge 0 of points.* meets edge 1 of points"),
        (SQUARE.tolist(), [[[5, 5], [12, 5], [5, 7]]], r"edge 1 of points.* meets edge [01] of holes\[0\]"),
        (SQUARE.tolist(), [[[2, 2], [4, 2], [4, 4]], [[3, 1], [5, 1], [3, 3.5]]], r"holes\[0\].* meets .*holes\[1\]"),
        (SQUARE.tolist(), [[[20, 20], [30, 20], [20, 30]]], r"holes\[0\] must lie inside"),
        (SQUARE.tolist(), [[[2, 2], [8, 2], [8, 8], [2, 8]], [[4, 4], [6, 4], [4, 6]]], r"outside of other holes"),
        (SQUARE.tolist(), [[[0, 0], [10, 0], [5, 5]]], r"edge 0 of points.* meets edge 0 of holes\[0\]"),
        ([[0, 0], [1, 1]], [], "at least 3"),
        ([[0, 0], [1, 1], [2, 2]], [], "meet|area"),
        ([[1, 1], [1, 1], [1, 1]], [], "area"),
    ],
)
def test_what_is_no_polygon_is_told(outer, holes, words):
    with pytest.raises(ValueError, match=words):
        convex_parts(np.array(outer, float), [np.array(hole, float) for hole in holes])


@pytest.mark.parametrize("tolerance", [0.3, 1.0, 3.0])
def test_a_tolerance_leaves_out_corners_but_no_more_than_that(tolerance):
    exact = loose = 0
    for _, solid in sprites():
        for outer, holes in outline(solid):
            whole = Polygon(outer, holes)
            parts = convex_parts(outer, holes, tolerance)
            union = shapely.union_all([Polygon(corners) for corners, _ in parts])
            assert shapely.hausdorff_distance(union.boundary, whole.boundary, densify=0.05) <= tolerance + 1e-9
            exact, loose = exact + len(convex_parts(outer, holes)), loose + len(parts)
    assert loose < exact
    ((corners, _),) = convex_parts(outline(disc(12))[0].outer, (), 0.5)
    assert len(corners) <= 16


def test_a_tolerance_never_lets_sides_cross():
    slot = [
        [0, 0],
        [4, 0],
        [4, 2],
        [4.6, 2],
        [4.6, -3],
        [5.4, -3],
        [5.4, 2],
        [6, 2],
        [6, 0],
        [10, 0],
        [10, -9],
        [0, -9],
    ]
    bump = np.array([[0, 0], [5, 2], [10, 0], [10, -9], [0, -9]], float)
    hole = np.array([[4.6, 0.6], [5.4, 0.6], [5, 1.2]])
    for outer, holes in ((np.array(slot, float), []), (bump, [hole])):
        for tolerance in (1.0, 2.5, 4.0):
            rings = shaved(simple_rings(outer, holes), tolerance)
            assert Polygon(rings[0], rings[1:]).is_valid
            assert sum(Polygon(part).area for part, _ in convex_parts(outer, holes, tolerance)) == pytest.approx(
                Polygon(rings[0], rings[1:]).area
            )
