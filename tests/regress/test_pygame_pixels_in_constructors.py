"""A pygame Mask or Surface is refused as an array of bool; NumPy would read its memory without an error."""

import numpy as np
import pygame
import pytest

from physics import PixelMask, TileGrid

MASK = pygame.Mask((70, 40), fill=True)
SURFACE = pygame.Surface((8, 8), pygame.SRCALPHA)


class OwnMask(pygame.Mask):
    """A subclass of pygame.Mask, which is refused too."""


@pytest.mark.parametrize(
    "make",
    [
        PixelMask,
        PixelMask.from_array,
        lambda value: PixelMask(value, (1, 2)),
        lambda value: TileGrid(value, 16),
        lambda value: TileGrid(np.zeros((3, 3), bool), 16, one_way=value),
    ],
)
@pytest.mark.parametrize(
    "value, hint", [(MASK, "from_mask"), (OwnMask((5, 5)), "from_mask"), (SURFACE, "from_surface")]
)
def test_it_is_refused_with_the_way_in(make, value, hint):
    with pytest.raises(TypeError, match=rf"(solid|one_way) .*{hint}"):
        make(value)


@pytest.mark.parametrize("value", [None, 5, SURFACE, np.ones((2, 2), bool), "mask"])
def test_the_way_in_takes_nothing_else(value):
    with pytest.raises(TypeError, match="mask must be a pygame.Mask"):
        PixelMask.from_mask(value)
