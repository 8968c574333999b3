"""PixelMask.outline and its argument `smooth`: the documented guarantees, checked on results with shapely."""

import math

import numpy as np
import pygame
import pytest
import shapely

from physics import Circle, Effects, Filter, PixelMask, Polygon, World
from physics.snapshot import Snapshot
from tests.outline.rasters import connected, disc, gaps, hard, lies_on_the_right_side, noise, raster, sprites
from tests.physics.figures import figure

SMOOTH = (0.0, 0.25, 0.5, 1.0)


def slope(run, rise, size=48):
    """Return the pixels of ground that rises by `rise` px for every `run` px."""
    y, x = np.mgrid[:size, :size]
    return (size - 1 - y) * run < x * rise + 0.5


def letters():
    drawn = pygame.font.Font(None, 40).render("Sg&8", True, (255, 255, 255))
    return pygame.surfarray.array_alpha(drawn).T > 127


def drawn(draw):
    surface = pygame.Surface((48, 40), pygame.SRCALPHA)
    draw(surface, (255, 255, 255))
    return pygame.surfarray.array_alpha(surface).T > 127


def drawings():
    pygame.font.init()
    yield "letters", letters()
    yield "ellipse", drawn(lambda s, c: pygame.draw.ellipse(s, c, (2, 4, 41, 27)))
    yield "ring", drawn(lambda s, c: pygame.draw.circle(s, c, (24, 20), 17, 3))
    yield "polygon", drawn(lambda s, c: pygame.draw.polygon(s, c, [(3, 3), (44, 9), (30, 36), (22, 17), (8, 30)]))
    yield "line", drawn(lambda s, c: pygame.draw.line(s, c, (2, 5), (45, 31), 2))
    yield "thin line", drawn(lambda s, c: pygame.draw.line(s, c, (2, 5), (45, 31)))
    yield "arc", drawn(lambda s, c: pygame.draw.arc(s, c, (3, 3, 40, 30), 0.3, 4.0, 4))
    yield "rounded box", drawn(lambda s, c: pygame.draw.rect(s, c, (4, 4, 37, 25), border_radius=9))
    for radius in (3, 7, 12.5):
        yield f"disc {radius}", disc(radius)
    for run, rise in ((1, 1), (3, 1), (2, 5), (17, 4)):
        yield f"slope {run}:{rise}", slope(run, rise)


def check(solid, smooth, origin=(0.0, 0.0)):
    """Return the outline of a mask, after a check of all that its documentation guarantees."""
    mask = PixelMask.from_array(solid, origin, smooth=smooth)
    parts = [figure(each) for each in mask.outline]
    together = shapely.transform(shapely.union_all(parts), lambda points: points + np.array(origin))
    round_one = any(isinstance(each, Circle) for each in mask.outline)
    assert lies_on_the_right_side(together, solid, 0.2 if round_one else 0.0)
    # The boundary of a union has slivers of rounding where parts meet in one line.
    whole = together.buffer(1e-7).buffer(-1e-7) if len(parts) > 1 else together
    from_pixels, to_pixels = gaps(whole, solid)
    spare = 0.13 if round_one else 0.0
    assert from_pixels <= smooth + spare + 1e-3 and to_pixels <= smooth + spare + 0.21
    if len(parts) > 1:
        assert sum(each.area for each in parts) == pytest.approx(together.area, abs=1e-6), "shapes overlap"
    pieces = list(getattr(whole, "geoms", [whole]))
    assert connected(solid, True) <= len(pieces) <= connected(solid, False)
    return mask


@pytest.mark.parametrize("smooth", SMOOTH)
@pytest.mark.parametrize("name, solid", [*drawings(), *hard().items(), *sprites()])
def test_what_is_drawn_keeps_the_contract(name, solid, smooth):
    check(solid, smooth)


@pytest.mark.parametrize("smooth", SMOOTH)
def test_noise_keeps_the_contract(smooth):
    for solid in noise(21, 25):
        if solid.any():
            check(solid, smooth, origin=(2.5, -1.0))


@pytest.mark.parametrize("width, height", [(1, 1), (1, 9), (2, 2), (7, 3), (32, 32), (33, 64), (200, 90)])
def test_a_full_rectangle_is_its_box_to_the_bit(width, height):
    mask = PixelMask.from_array(np.ones((height, width), bool))
    assert mask.outline == (Polygon.box(width, height),)
    assert mask.outline is mask.outline


def test_nothing_has_no_outline():
    for shape in ((0, 0), (0, 5), (4, 3)):
        assert PixelMask.from_array(np.zeros(shape, bool)).outline == ()


def test_corners_between_long_runs_stay():
    solid = raster(["######....", "######....", "######....", "##########", "##########", "##########"])
    corners = {tuple(each) for part in check(solid, 0.5).outline for each in part.points}
    assert {(0.0, 0.0), (6.0, 0.0), (6.0, 3.0), (10.0, 3.0), (10.0, 6.0), (0.0, 6.0)} <= corners


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf, -math.inf])
def test_a_smooth_below_zero_or_without_end_is_told(value):
    for make in (PixelMask, PixelMask.from_array):
        with pytest.raises(ValueError, match="smooth must be finite and >= 0"):
            make(np.ones((2, 2), bool), smooth=value)
    with pytest.raises(ValueError, match="smooth"):
        PixelMask.from_surface(pygame.Surface((2, 2), pygame.SRCALPHA), smooth=value)
    with pytest.raises(ValueError, match="smooth"):
        PixelMask.from_mask(pygame.Mask((2, 2), fill=True), smooth=value)


@pytest.mark.parametrize("value", ["0.5", None, True, [0.5]])
def test_a_smooth_that_is_no_number_is_told(value):
    with pytest.raises(TypeError, match="smooth must be a number"):
        PixelMask(np.ones((2, 2), bool), smooth=value)


def test_smooth_goes_with_copies_and_is_shown(tmp_path):
    stairs = np.tri(6, dtype=bool)
    mask = PixelMask(stairs, smooth=0.25)
    surface = pygame.mask.Mask((6, 6), fill=True)
    for other in (
        mask.flipped(x=True),
        mask.scaled(2.0),
        mask.with_(filter=Filter(2)),
        PixelMask.from_mask(surface, smooth=0.25),
        PixelMask.from_surface(surface.to_surface(), smooth=0.25),
        PixelMask.from_array(stairs, smooth=0.25),
    ):
        assert other.smooth == 0.25 and repr(other).endswith(", smooth=0.25)")
    assert PixelMask(stairs).smooth == 0.5 and "smooth" not in repr(PixelMask(stairs))
    world = World(Effects.rigid_bodies())
    body = world.add_body(PixelMask(stairs, smooth=0.0), PixelMask(stairs, smooth=1.0))
    world.snapshot().save(tmp_path / "taken.npz")
    fresh = World(Effects.rigid_bodies())
    fresh.restore(Snapshot.load(tmp_path / "taken.npz"))
    assert [each.smooth for each in fresh.body(body.id).shapes] == [0.0, 1.0]


def test_smooth_decides_what_a_body_collides_by():
    stairs = np.tri(6, dtype=bool)
    assert len(PixelMask(stairs, smooth=0.0).outline) > len(PixelMask(stairs).outline) == 1
    world = World(Effects.rigid_bodies())
    for smooth in (0.0, 0.5):
        world.add_body(PixelMask(stairs, smooth=smooth))
    counts = np.unique(world.shapes["body"], return_counts=True)[1]
    assert counts.tolist() == [1 + len(PixelMask(stairs, smooth=each).outline) for each in (0.0, 0.5)]


@pytest.mark.parametrize("radius", [6, 8, 12, 16, 20, 24, 32, 40, 48])
@pytest.mark.parametrize("more", [0, 1])
def test_what_pygame_draws_as_a_circle_is_one(radius, more):
    surface = pygame.Surface((2 * radius + more,) * 2, pygame.SRCALPHA)
    pygame.draw.circle(surface, (255, 255, 255), (radius, radius), radius)
    mask = PixelMask.from_surface(surface)
    (ball,) = check(mask.solid, 0.5).outline
    assert isinstance(ball, Circle) and ball.radius == pytest.approx(math.sqrt(mask.area / math.pi), abs=0.15)
    assert ball.center == pytest.approx((radius, radius), abs=0.1)


def test_a_round_sprite_is_a_circle():
    (ball,) = check(disc(9), 0.5).outline
    assert isinstance(ball, Circle) and ball.radius == pytest.approx(9, abs=0.3)
