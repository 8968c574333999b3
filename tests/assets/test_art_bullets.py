"""Enemy bullets are visible on every background and under every cloud, and distinguishable by colour-blind viewers."""

import numpy as np
import pytest

from assets.shooter.enemy_bullets import ROUND, SAFE
from tests.assets.art_reading import backdrop, load, oklab

GROUNDS = {
    "sea": ("clouds_low", "clouds_high"),
    "coast": ("clouds_low", "clouds_high"),
    "storm": ("clouds_storm", "clouds_high"),
}
FRAMES = [f"{safe}{name}_{frame}" for safe in ("", "safe_") for name in ROUND for frame in range(2)]
FRAMES += ["bullet_needle", "safe_bullet_needle"]
CORE_LEAST, RING_LEAST, INNER_LEAST = 0.30, 0.18, 0.25  # OKLab lightness differences


def seen(ground):
    """Return the lightness of all pixels of a shooter's background, two arrays (n,).

    The first is of the background alone, the second of the background under all its clouds. ground: name of the
    background.
    """
    bare = backdrop(ground)[..., :3].astype(float)
    under = bare.copy()
    for name in GROUNDS[ground]:
        cloud = backdrop(name).astype(float)
        share = cloud[..., 3:] / 255
        under = under * (1 - share) + cloud[..., :3] * share
    return [oklab(picture.reshape(-1, 3))[:, 0] for picture in (bare, under)]


def parts(frame):
    """Return the lightness (dark ring, saturated ring, core) of a bullet's frame."""
    pixels = frame[frame[..., 3] > 0][:, :3]
    light = oklab(pixels)[:, 0]
    chroma = np.sqrt((oklab(pixels)[:, 1:] ** 2).sum(1))
    assert chroma.max() > 0.06, "no saturated ring"
    return light.min(), light[chroma > 0.8 * chroma.max()].mean(), light.max()


@pytest.mark.parametrize("ground", GROUNDS)
def test_bullets_stand_out_from_the_ground(ground):
    effects = load("effects")[0]
    for behind in seen(ground):
        low, middle, high = np.percentile(behind, (5, 50, 95))
        for name in FRAMES:
            dark, ring, core = parts(effects[name])
            assert core - high >= CORE_LEAST, f"{name}: core {core:.2f}, ground up to {high:.2f}"
            for level in (low, middle, high):
                assert max(abs(ring - level), abs(dark - level)) >= RING_LEAST, f"{name} on {level:.2f}"
            assert ring - dark >= INNER_LEAST, name


def test_every_bullet_has_a_dark_ring_all_around():
    effects = load("effects")[0]
    for name in FRAMES:
        frame = effects[name]
        solid = np.pad(frame[..., 3] > 0, 1)
        inner = solid[:-2, 1:-1] & solid[2:, 1:-1] & solid[1:-1, :-2] & solid[1:-1, 2:]
        edge = solid[1:-1, 1:-1] & ~inner
        assert oklab(frame[edge][:, :3])[:, 0].max() < 0.25, name


def test_safe_twins_collide_alike():
    effects = load("effects")[0]
    for name in FRAMES:
        if not name.startswith("safe_"):
            assert (effects[name][..., 3] == effects[f"safe_{name}"][..., 3]).all(), name
    for name in ROUND:
        assert (effects[f"{name}_0"][..., 3] == effects[f"{name}_1"][..., 3]).all(), name


def test_safe_kinds_are_told_apart_by_shape_or_size():
    """Any two safe kinds of bullets of one colour differ in their core or size."""
    kinds = [(SAFE[name][0], SAFE[name][1], ROUND.get(name, (0, 0))[1]) for name in SAFE]
    assert len(set(kinds)) == len(kinds)
    shapes = [(shape, ROUND.get(name, (0, 0))[1]) for name, (_, shape) in SAFE.items()]
    assert len(set(shapes)) == len(shapes), "even without any colour"
