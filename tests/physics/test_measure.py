"""measure() compared with shapely: areas, distances and moments of the shapes that replace a mask."""

import math

import numpy as np
import pytest
import shapely

from physics import TIERS, Bounds, Capsule, Circle, Filter, Fit, PixelMask, Polygon, Segment, fit, measure
from tests.outline.rasters import disc, hard, noise, pixels, raster, sprites
from tests.physics.figures import figure

ROUND = 2e-4  # relative: what a circle of 1024 corners is off by
GAP = 0.05  # [px] between the points at which shapely measures distances


def union(shapes):
    return shapely.union_all([figure(each) for each in shapes])


def second_moment(figure):
    """Return the second moment of area of a figure about its centroid, by triangles."""
    total = 0.0
    center = np.array(figure.centroid.coords[0])
    for triangle in shapely.constrained_delaunay_triangles(figure).geoms:
        corners = np.array(triangle.exterior.coords)[:3] - center
        total += triangle.area / 12.0 * ((corners.sum(axis=0) ** 2).sum() + (corners**2).sum())
    return total


def check(mask, shapes, round_off=ROUND):
    found = measure(mask, shapes)
    ours = union(shapes)
    true = shapely.transform(pixels(mask.solid), lambda points: points - np.array(mask.origin))
    off = round_off * max(ours.area, true.area) + 1e-9
    assert found.over == pytest.approx(ours.difference(true).area, abs=off)
    assert found.missed == pytest.approx(true.difference(ours).area, abs=off)
    assert found.iou == pytest.approx(ours.intersection(true).area / ours.union(true).area, abs=2 * round_off + 1e-9)
    boundary = ours.buffer(1e-9).buffer(-1e-9).boundary if len(shapes) > 1 else ours.boundary
    # shapely looks at the corners of both boundaries; between two of them the distance may be half a gap more.
    distance = shapely.hausdorff_distance(*(shapely.segmentize(each, GAP) for each in (boundary, true.boundary)))
    assert -1e-3 <= found.hausdorff - distance <= 0.5 * GAP + 1e-3
    assert found.area_error == pytest.approx(abs(ours.area - true.area) / true.area, rel=1e-4, abs=round_off + 1e-9)
    assert found.center_error == pytest.approx(ours.centroid.distance(true.centroid), abs=10 * round_off + 1e-7)
    inertia = second_moment(true)
    assert found.inertia_error == pytest.approx(
        abs(second_moment(ours) - inertia) / inertia, rel=1e-4, abs=2 * round_off + 1e-8
    )
    return found


def masks():
    for name, solid in (*hard().items(), *sprites()):
        if solid.any():
            yield pytest.param(PixelMask.from_array(solid, origin=(2.25, -1.0)), id=name)


@pytest.mark.parametrize("mask", [*masks()])
def test_tiers_are_measured_as_shapely_does(mask):
    for tier in ("circle", "obb", "capsule", "hull", "parts", "outline"):
        check(mask, fit(mask, tier))


def test_noise_and_overlapping_shapes():
    rng = np.random.default_rng(4)
    for solid in noise(31, 30):
        if not solid.any():
            continue
        mask = PixelMask.from_array(solid)
        shapes = []
        for _ in range(int(rng.integers(1, 6))):
            x, y, angle = *rng.uniform(-6, 6, 2), rng.uniform(0, 7)
            kind = rng.integers(0, 4)
            if kind == 0:
                shapes.append(Circle(rng.uniform(0.5, 5), (x, y)))
            elif kind == 1:
                shapes.append(Capsule((x, y), (x + 3, y - 2), rng.uniform(0.5, 3)))
            elif kind == 2:
                shapes.append(Polygon.box(rng.uniform(1, 6), rng.uniform(1, 6), (x, y), angle))
            else:
                shapes.append(Polygon(((x, y), (x + 4, y + 1), (x + 1, y + 3)), rng.uniform(0.1, 2)))
        check(mask, tuple(shapes))


def test_aligned_and_repeated_shapes_are_a_union():
    mask = PixelMask.from_array(np.ones((8, 8), bool))
    box = Polygon.box(8, 8)
    exact = measure(mask, (box,))
    for shapes in (
        (box, box),
        (Polygon.box(4, 8, (-2, 0)), Polygon.box(4, 8, (2, 0))),
        (Polygon.box(6, 8, (-1, 0)), Polygon.box(5, 8, (1.5, 0))),
        (box, Polygon.box(8, 3, (0, 2.5)), Polygon.box(2, 2)),
    ):
        assert measure(mask, shapes)[:7] == pytest.approx((0, 0, 1, 0, 0, 0, 0), abs=1e-9), shapes
    assert exact[:7] == pytest.approx((0, 0, 1, 0, 0, 0, 0), abs=1e-12)
    check(mask, (Circle(3), Circle(3), Circle(3, (2, 0))))
    check(mask, (Circle(2), Circle(2, (4, 0)), Capsule((0, 0), (4, 0), 2)))


def test_known_values():
    mask = PixelMask.from_array(np.ones((4, 6), bool))
    found = measure(mask, Polygon.box(6, 5, (0, 0.5)))
    assert found[:6] == pytest.approx((6.0, 0.0, 0.8, 1.0, 0.25, 0.5))
    assert found.inertia_error == pytest.approx(30 * (36 + 25) / (24 * (36 + 16)) - 1)
    assert found.corners == 4 and isinstance(found, Fit)
    ring = measure(mask, Circle(1.0))
    assert ring.missed == pytest.approx(24 - math.pi, rel=1e-12) and ring.over == pytest.approx(0.0, abs=1e-12)
    assert ring.hausdorff == pytest.approx(math.hypot(3, 2) - 1, abs=1e-6)
    bar = PixelMask.from_array(raster(["#"]))
    assert measure(bar, Circle(0.5)).hausdorff == pytest.approx(math.sqrt(0.5) - 0.5, abs=1e-6)


@pytest.mark.parametrize("scale", [2.0**-12, 2.0**12])
def test_far_origins_lose_no_digits(scale):
    solid = disc(7)
    near, far = (PixelMask.from_array(solid, origin) for origin in ((9.0, 9.0), (9.0 + 2.0**30, 9.0 - 2.0**30)))
    a, b = (measure(mask, fit(mask, "hull")) for mask in (near, far))
    assert a[:7] == pytest.approx(b[:7], abs=1e-6)


def test_the_mask_itself_and_its_bounds():
    for solid in (*hard().values(), *(each for _, each in sprites())):
        mask = PixelMask.from_array(solid)
        for tier in ("pixels", "mask"):
            found = measure(mask, fit(mask, tier))
            assert found[:7] == pytest.approx((0, 0, 1, 0, 0, 0, 0), abs=1e-7)
            assert found.corners >= 4
        left, top, right, bottom = mask.bounds
        box = Polygon.box(right - left, bottom - top, ((left + right) / 2, (top + bottom) / 2))
        assert measure(mask, Bounds(mask))[:7] == pytest.approx(measure(mask, box)[:7], abs=1e-9)


def test_bytes_grow_with_what_is_kept():
    mask = PixelMask.from_array(dict(sprites())["planes/large_plane_b"])
    size = {tier: measure(mask, fit(mask, tier)).bytes for tier in TIERS}
    assert size["circle"] < size["capsule"] < size["hull"] < size["outline"]
    assert size["pixels"] < size["mask"]
    assert measure(mask, fit(mask, "parts", 4.0)).bytes < size["outline"]


def test_nothing_beside_something():
    nothing, one = PixelMask.from_array(np.zeros((3, 3), bool)), PixelMask.from_array(np.ones((2, 2), bool))
    assert measure(nothing, ())[:7] == (0, 0, 1, 0, 0, 0, 0)
    assert measure(one, ())[:7] == (0, 4, 0, math.inf, 1, math.inf, 1)
    found = measure(nothing, Circle(1.0))
    assert found[:7] == (pytest.approx(math.pi), 0, 0, math.inf, math.inf, math.inf, math.inf)


@pytest.mark.parametrize("shapes", [None, "Circle", (Circle(1), 3), Segment((0, 0), (1, 1)), {}])
def test_what_has_no_area_is_told(shapes):
    with pytest.raises(TypeError, match="shapes must be Circle"):
        measure(PixelMask.from_array(np.ones((2, 2), bool)), shapes)
    with pytest.raises(TypeError, match="mask must be a PixelMask"):
        measure(shapes, Circle(1))


def test_tiers_pixels_and_mask_are_the_mask_drawn_and_exact():
    drawn = PixelMask.from_array(disc(5), smooth=0.25).with_(filter=Filter(4))
    assert fit(drawn, "pixels") == (drawn,)
    (exact,) = fit(drawn, "mask")
    assert (
        not exact.snap
        and exact.smooth == 0.25
        and exact.filter == Filter(4)
        and np.array_equal(exact.solid, drawn.solid)
    )
    assert fit(exact, "mask") == (exact,) and fit(drawn, "mask")[0].bare is exact.bare
    (again,) = fit(exact, "pixels")
    assert again.snap and again.filter == Filter(4)
