"""Shapes with their own material, filter and sensor flag keep them when the values of their body change."""

import numpy as np
import pytest

from physics import (
    Bounds,
    Capsule,
    Chain,
    Circle,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    TileGrid,
    World,
    collide,
    fit,
    mass_of,
)  # fmt: skip

ICE = Material(density=3.0, friction=0.0)
MASK = PixelMask(np.ones((12, 10), bool))
SHAPES = [
    Circle(5), Capsule((-4, 0), (4, 0), 3), Polygon.box(8, 8), Segment((0, 0), (9, 0)), Chain([(0, 0), (9, 0)]),
    TileGrid([[True, False]], 8), MASK, Bounds(Circle(5)), Bounds(MASK),
]  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES, ids=repr)
def test_the_same_shape_with_values_of_its_own(shape):
    own = shape.with_(material=ICE, filter=Filter(2, 4), sensor=True)
    assert (own.material, own.filter, own.sensor) == (ICE, Filter(2, 4), True)
    assert (shape.material, shape.filter, shape.sensor) == (None, None, None), "a value does not change"
    assert own != shape and type(own) is type(shape) and own.with_() is shape
    assert own.with_(sensor=False).material is None, "what is not said is the body's"
    if not isinstance(shape, (TileGrid, PixelMask)) and getattr(shape, "shape", None) is not MASK:
        assert own == shape.with_(ICE, Filter(2, 4), True) and hash(own) == hash(shape.with_(ICE, Filter(2, 4), True))
    if not isinstance(shape, (Segment, Chain, TileGrid)):
        plain, there = collide(shape, (0, 0), Circle(4), (3, 1)), collide(own, (0, 0), Circle(4), (3, 1))
        assert np.array_equal(plain.points, there.points) and len(plain)


@pytest.mark.parametrize("kind", ["static", "kinematic"])
@pytest.mark.parametrize("shape", SHAPES, ids=repr)
def test_they_survive_what_the_body_says(shape, kind, tmp_path):
    world = World()
    body = world.add_body(
        shape, shape.with_(ICE, Filter(2, 4), True), kind=kind, filter=Filter(8, 16), material=Material(friction=0.9)
    )
    body.filter, body.material, body.sensor = Filter(32, 64), Material(friction=0.1), False
    added = body.add_shape(shape)
    for _ in range(2):
        s = world.shapes[np.isin(world.shapes["id"], body.shape_ids)]
        assert s["membership"].tolist() == [32, 2, 32] and s["mask"].tolist() == [64, 4, 64]
        assert s["friction"].tolist() == [0.1, 0.0, 0.1] and s["sensor"].tolist() == [False, True, False]
        assert body.filter == Filter(32, 64) and body.material.friction == 0.1 and body.shape_ids[2] == added
        assert [each.sensor for each in body.shapes] == [None, True, None]
        assert body.shapes[1].filter == Filter(2, 4) and body.shapes[1].material == ICE
        world.snapshot().save(tmp_path / "s.npz")
        world.restore(Snapshot.load(tmp_path / "s.npz"))
    body.sensor = True
    assert world.shapes["sensor"].all()
    body.sensor = False
    s = world.shapes[np.isin(world.shapes["id"], body.shape_ids)]
    assert s["sensor"].tolist() == [False, True, False]


def test_densities_of_their_own_and_sensors_count_in_the_mass():
    light, heavy = Circle(5), Circle(5, (30, 0)).with_(material=ICE, sensor=True)
    body = World().add_body(light, heavy, material=Material(density=1.0))
    area = 25 * np.pi
    assert body.mass == pytest.approx(4 * area) and body.center.x == pytest.approx(22.5)
    body.material = Material(density=3.0)
    assert body.mass == pytest.approx(6 * area) and body.center.x == pytest.approx(15)
    assert mass_of((light, heavy), 3.0).mass == body.mass and mass_of(heavy, 1.0).mass == pytest.approx(3 * area)


def test_each_shape_meets_by_its_own_filter_and_rubs_by_its_own_material():
    world = World()
    world.add_body(Polygon.box(4000, 20), position=(0, 100), kind="static", filter=Filter(1, 1))
    ghost = world.add_body(Polygon.box(20, 20).with_(filter=Filter(2, 2)), position=(0, 60), filter=Filter(1, 1))
    solid = world.add_body(Polygon.box(20, 20), position=(100, 80), filter=Filter(1, 1), velocity=(100, 0))
    slides = world.add_body(
        Polygon.box(20, 20).with_(material=ICE), position=(300, 80), filter=Filter(1, 1), velocity=(100, 0)
    )
    for _ in range(60):
        world.step()
    assert ghost.position.y > 150 and solid.position.y == pytest.approx(80, abs=0.5)
    assert slides.velocity.x == pytest.approx(100, rel=1e-6) and solid.velocity.x < 50


def test_one_body_senses_with_one_shape_and_stands_on_the_other():
    world = World()
    floor = world.add_body(Polygon.box(4000, 20), position=(0, 100), kind="static")
    body = world.add_body(Polygon.box(20, 20), Polygon.box(16, 8, (0, 12)).with_(sensor=True), position=(0, 50))
    began = []
    for _ in range(60):
        world.step()
        began += world.events.sensor_begin["shape_b"].tolist()
    assert body.position.y == pytest.approx(80, abs=0.5) and began == [body.shape_ids[1]]
    assert world.query_point((0, 95), sensors=True) == [floor, body] and world.query_point((0, 95)) == [floor]


def test_tiers_and_wrappers_keep_them():
    own = MASK.with_(ICE, Filter(2, 4), True)
    for tier in ("circle", "aabb", "obb", "pixels"):
        (fitted,) = fit(own, tier)
        assert (fitted.material, fitted.filter, fitted.sensor) == (ICE, Filter(2, 4), True)
        assert fit(MASK, tier)[0].material is None
    wrapped = Bounds(own)
    assert (wrapped.material, wrapped.sensor) == (ICE, True) and wrapped.with_() == Bounds(MASK)
    world = World()
    body = world.add_body(own, tier="circle", filter=Filter(1, 1))
    body.tier = None
    assert {*world.shapes["membership"].tolist()} == {2} and world.shapes["sensor"].all()


def test_masks_made_from_masks():
    pygame = pytest.importorskip("pygame")
    surface = pygame.Surface((70, 33), pygame.SRCALPHA)
    pygame.draw.polygon(surface, "white", [(3, 2), (66, 9), (40, 31), (5, 20)])
    mask = pygame.mask.from_surface(surface)
    made = PixelMask.from_mask(mask, origin=(7, 3))
    assert np.array_equal(made.solid, PixelMask.from_surface(surface).solid) and made.origin == (7, 3)
    assert made.area == mask.count() and PixelMask.from_mask(mask).origin == (35, 16.5)
    for size in ((0, 0), (5, 0), (1, 1), (64, 1), (65, 2)):
        full = pygame.Mask(size, fill=True)
        assert PixelMask.from_mask(full).size == size and PixelMask.from_mask(full).area == full.count()
    for x, y in ((False, False), (True, False), (False, True), (True, True)):
        flipped = made.flipped(x=x, y=y)
        wanted = pygame.mask.from_surface(pygame.transform.flip(surface, x, y))
        assert np.array_equal(flipped.solid, PixelMask.from_mask(wanted).solid)
        assert flipped.origin == (70 - 7 if x else 7, 33 - 3 if y else 3) and flipped.flipped(x, y).origin == (7, 3)
    for factor in (2, 3, 1.0):
        larger = made.with_(sensor=True).scaled(factor)
        assert np.array_equal(larger.solid, np.kron(made.solid, np.ones((int(factor),) * 2, bool)))
        assert larger.origin == made.origin * factor and larger.sensor
    half = made.scaled(0.5)
    assert half.size == (35, 17) and half.area == pytest.approx(made.area / 4, rel=0.05)
    assert half.centroid == pytest.approx(made.centroid / 2, abs=0.6)
    assert made.scaled(1e-9).size == (1, 1) and PixelMask(np.zeros((0, 0), bool)).scaled(2).size == (0, 0)
