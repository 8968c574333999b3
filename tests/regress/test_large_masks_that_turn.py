"""A large rotating mask over a sensor is cheap; before the fix each angle took 0.11 s and 20 MB, and was cached."""

import math
import weakref

import numpy as np
import pytest

from physics import PixelMask
from physics.raster.bits import SAMPLES, turn

rng = np.random.default_rng(5)


def test_a_mask_keeps_little_of_the_angles_it_was_at():
    mask = PixelMask(np.ones((480, 760), bool))
    kept = [weakref.ref(mask.turned(math.tau * k / 128)) for k in range(1, 20)]
    alive = [turned for each in kept if (turned := each()) is not None]
    assert kept[-1]() is mask.turned(math.tau * 19 / 128), "the latest is not kept"
    assert len(alive) <= 4
    for turned in alive:
        assert turned.source_x.nbytes + turned.source_y.nbytes + turned.solid.nbytes == 5 * turned.solid.size


def test_a_sprite_keeps_all_angles():
    mask = PixelMask(np.ones((64, 64), bool))
    first = [mask.turned(math.tau * k / 128) for k in range(128)]
    assert all(mask.turned(math.tau * k / 128) is turned for k, turned in enumerate(first))


@pytest.mark.parametrize(
    "solid", [rng.random((23, 31)) < 0.9, np.pad(np.ones((15, 22), bool), 3), rng.random((9, 9)) < 0.2]
)
def test_pixels_kept_are_those_covered_most_as_counted_for_every_pixel(solid):
    """A rotated mask that needs more pixels to keep its area adds those that the source covers most.

    Candidates are the pixels whose centre is not solid in the rotated source. The coverage is counted over all samples
    of each pixel.
    """
    origin = (solid.shape[1] / 2, solid.shape[0] / 2)
    for bucket in (1, 7, 16, 43, 100):
        turned = turn(solid, origin, bucket, 128)
        coverage, centered = counted(solid, origin, turned, math.tau * bucket / 128)
        added, left = turned.solid & ~centered, ~turned.solid & ~centered
        assert turned.solid[centered].all() or not added.any(), "added and dropped at once"
        if added.any():
            assert coverage[added].min() >= coverage[left].max()
            assert turned.solid.sum() == solid.sum()


def counted(solid, origin, turned, angle):
    """Return (counts, centres), both (rows, columns), for the pixels of a rotated mask.

    counts: number of samples in the pixel at which the source is solid. centres: whether the source is solid at the
    pixel's centre.
    """
    height, width = turned.solid.shape
    at = (np.arange(SAMPLES) + 0.5) / SAMPLES
    y, x = np.meshgrid(
        (np.arange(height)[:, None] + at).ravel() - turned.origin[1],
        (np.arange(width)[:, None] + at).ravel() - turned.origin[0],
        indexing="ij",
    )
    u = np.floor(math.cos(angle) * x + math.sin(angle) * y + origin[0]).astype(int)
    v = np.floor(math.cos(angle) * y - math.sin(angle) * x + origin[1]).astype(int)
    inside = (u >= 0) & (u < solid.shape[1]) & (v >= 0) & (v < solid.shape[0])
    hit = np.zeros(u.shape, bool)
    hit[inside] = solid[v[inside], u[inside]]
    hit = hit.reshape(height, SAMPLES, width, SAMPLES)
    return hit.sum(axis=(1, 3)), hit[:, SAMPLES // 2, :, SAMPLES // 2]
