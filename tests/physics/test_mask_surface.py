"""Masks from pygame surfaces and from arrays, and their mass."""

import numpy as np
import pygame
import pytest

from physics import PixelMask, mass_of


def surface(alphas, **colours):
    """Return a pygame surface with one row of pixels that have these alphas.

    colours: keyword at0=(r, g, b) sets the colour of pixel 0, at1 that of pixel 1, and so on.
    """
    made = pygame.Surface((len(alphas), 1), pygame.SRCALPHA)
    for x, alpha in enumerate(alphas):
        made.set_at((x, 0), (*colours.get(f"at{x}", (9, 9, 9)), alpha))
    return made


def row(mask):
    return mask.solid[0].astype(int).tolist()


def test_solid_is_what_has_more_alpha_than_the_threshold():
    alphas = surface([0, 1, 126, 127, 128, 254, 255])
    assert row(PixelMask.from_surface(alphas)) == [0, 0, 0, 0, 1, 1, 1]
    assert row(PixelMask.from_surface(alphas, threshold=0)) == [0, 1, 1, 1, 1, 1, 1]
    assert row(PixelMask.from_surface(alphas, threshold=254)) == [0, 0, 0, 0, 0, 0, 1]
    assert row(PixelMask.from_surface(alphas, threshold=255)) == [0] * 7


def test_mask_agrees_with_pygames_own():
    rng = np.random.default_rng(0)
    made = pygame.Surface((37, 21), pygame.SRCALPHA)
    for x in range(37):
        for y in range(21):
            made.set_at((x, y), tuple(int(v) for v in rng.integers(0, 256, 4)))
    ours, theirs = PixelMask.from_surface(made), pygame.mask.from_surface(made)
    assert ours.area == theirs.count()
    assert all(ours.solid[y, x] == bool(theirs.get_at((x, y))) for x in range(37) for y in range(21))


@pytest.mark.parametrize("depth", [8, 16, 24, 32])
def test_colour_key_is_clear_at_every_depth(depth):
    made = pygame.Surface((3, 1), 0, depth)
    if depth == 8:
        made.set_palette([(255, 0, 255), (10, 20, 30)] + [(0, 0, 0)] * 254)
    made.fill((255, 0, 255))
    made.set_at((1, 0), (10, 20, 30))
    made.set_colorkey((255, 0, 255))
    assert row(PixelMask.from_surface(made)) == [0, 1, 0]


BYTES = [255 << 8 * place for place in range(4)]
LAYOUTS = [
    (32, tuple(BYTES[place] for place in places)) for places in ((0, 1, 2, 3), (2, 1, 0, 3), (3, 2, 1, 0), (1, 2, 3, 0))
]
LAYOUTS += [
    (16, (15 << 8, 15 << 4, 15, 15 << 12)),
    (16, (31 << 11, 63 << 5, 31, 0)),
    (32, (255 << 16, 255 << 8, 255, 0)),
]


@pytest.mark.parametrize("cut", [None, (2, 1, 9, 4)])
@pytest.mark.parametrize("threshold", [0, 90, 127])
@pytest.mark.parametrize(("depth", "masks"), LAYOUTS)
def test_alpha_is_read_wherever_it_lies(depth, masks, threshold, cut):
    made = pygame.Surface((13, 7), pygame.SRCALPHA if masks[3] else 0, depth, masks)
    random = np.random.default_rng(depth)
    for x in range(13):
        for y in range(7):
            made.set_at((x, y), (10, 200, 30, int(random.integers(0, 256))))
    seen = made if cut is None else made.subsurface(cut)
    wanted = [[seen.get_at((x, y)).a > threshold for x in range(seen.get_width())] for y in range(seen.get_height())]
    assert PixelMask.from_surface(seen, threshold).solid.tolist() == wanted


def test_colour_key_and_alpha_are_both_clear():
    made = surface([255, 0, 255, 100], at0=(255, 0, 255))
    made.set_colorkey((255, 0, 255))
    assert row(PixelMask.from_surface(made)) == [0, 0, 1, 0]


def test_surface_without_alpha_is_solid_and_an_empty_one_is_empty():
    assert PixelMask.from_surface(pygame.Surface((5, 4), 0, 24)).area == 20
    assert PixelMask.from_surface(pygame.Surface((0, 4), pygame.SRCALPHA)).size == (0, 4)
    assert PixelMask.from_surface(pygame.Surface((6, 3), pygame.SRCALPHA)).area == 0


def test_sub_surface_and_locked_surface_are_read():
    parent = surface([0, 255, 255, 0, 255])
    assert row(PixelMask.from_surface(parent.subsurface((1, 0, 3, 1)))) == [1, 1, 0]
    parent.lock()
    try:
        assert row(PixelMask.from_surface(parent)) == [0, 1, 1, 0, 1]
    finally:
        parent.unlock()
    assert not parent.get_locked()


def test_rows_and_columns_are_not_swapped():
    made = pygame.Surface((7, 3), pygame.SRCALPHA)
    made.set_at((6, 0), (255, 255, 255, 255))
    mask = PixelMask.from_surface(made)
    assert mask.size == (7, 3) and mask.solid.shape == (3, 7) and mask.solid[0, 6]
    assert mask.origin == (3.5, 1.5) and mask.bounds == (2.5, -1.5, 3.5, -0.5) and mask.centroid == (3.0, -1.0)


def test_later_changes_of_surface_or_array_do_not_reach_the_mask():
    solid = np.ones((3, 3), bool)
    mask = PixelMask.from_array(solid)
    solid[:] = False
    assert mask.area == 9 and mask.solid.all()
    with pytest.raises(ValueError):
        mask.solid[0, 0] = False


@pytest.mark.parametrize(
    "make",
    [
        lambda a: a.tolist(),
        lambda a: a.astype(np.uint8),
        lambda a: a.astype(np.int64) * 5,
        np.asfortranarray,
        lambda a: np.repeat(np.repeat(a, 2, 0), 2, 1)[::2, ::2],
    ],
)
def test_any_array_of_truth_makes_the_same_mask(make):
    solid = np.random.default_rng(1).random((9, 70)) < 0.5
    solid_again = make(solid)
    assert np.array_equal(PixelMask(solid_again).words, PixelMask(solid).words)


def test_mass_of_a_mask_is_that_of_its_squares():
    for solid in (np.ones((3, 8), bool), np.array([[1, 0], [1, 1]], bool)):
        mask = PixelMask(solid, origin=(1.0, -2.0))
        pixels = [(i - 1.0, j + 2.0) for j, i in zip(*np.nonzero(solid), strict=True)]
        n = len(pixels)
        cx, cy = sum(x for x, _ in pixels) / n + 0.5, sum(y for _, y in pixels) / n + 0.5
        inertia = sum((x + 0.5 - cx) ** 2 + (y + 0.5 - cy) ** 2 + 1 / 6 for x, y in pixels)
        found = mass_of(mask, 2.5)
        assert found.mass == 2.5 * n and found.center == pytest.approx((cx, cy), abs=1e-12) == mask.centroid
        assert found.inertia == pytest.approx(2.5 * inertia, rel=1e-12)


def test_flipping_mirrors_the_centre_exactly():
    solid = np.random.default_rng(2).random((12, 19)) < 0.4
    x, y = PixelMask(solid).centroid
    assert PixelMask(solid[:, ::-1]).centroid == pytest.approx((-x, y), abs=1e-12)
    assert PixelMask(np.kron(solid, np.ones((3, 3), bool)).astype(bool)).area == 9 * solid.sum()
