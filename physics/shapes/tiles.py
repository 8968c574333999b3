"""TileGrid: ground made of tiles of one size."""

import math
import sys
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.shapes.blocks import solid_blocks
from physics.shapes.mass import NOTHING, Mass
from physics.shapes.own_values import OwnValues


class TileGrid(OwnValues):
    """Solid tiles of one size; origin at the top left corner of tile (0, 0).

    solid[row, col] bool; one_way[row, col] bool: open from below; slopes[row, col] = (left, right): height of the
    surface above the tile's bottom as a fraction 0..1, (0, 1) rises to the right, (0, 0) is no slope. Raises
    ValueError when the arrays differ in shape, a slope is out of range, or a cell is of two kinds.
    """

    def __init__(
        self, solid: ArrayLike, tile_size: float, one_way: ArrayLike | None = None, slopes: ArrayLike | None = None
    ) -> None:
        self.solid = bools("solid", solid)
        self.tile_size = checks.number("tile_size", tile_size, above=0.0)
        self.one_way = bools("one_way", one_way if one_way is not None else np.zeros_like(self.solid))
        try:
            slopes = np.zeros(self.solid.shape + (2,)) if slopes is None else np.array(slopes, dtype=np.float64)
        except (TypeError, ValueError):
            raise TypeError(f"slopes must be an array [row, col, 2] of numbers (got {type(slopes).__name__})") from None
        if self.one_way.shape != self.solid.shape:
            raise ValueError(f"one_way must have the shape of solid, {self.solid.shape} (got {self.one_way.shape})")
        if slopes.shape != self.solid.shape + (2,):
            raise ValueError(f"slopes must have shape {self.solid.shape + (2,)} (got {slopes.shape})")
        bad = ~((slopes >= 0.0) & (slopes <= 1.0)).all(axis=2)
        if bad.any():
            at = tuple(int(v) for v in np.argwhere(bad)[0])
            raise ValueError(f"slopes[{at[0]}, {at[1]}] must be within 0..1 (got {slopes[at].tolist()})")
        kinds = self.solid.astype(int) + self.one_way + (slopes > 0.0).any(axis=2)
        if (kinds > 1).any():
            at = tuple(int(v) for v in np.argwhere(kinds > 1)[0])
            raise ValueError(
                f"cell [{at[0]}, {at[1]}] must be one of solid, one_way and slope (got {kinds[at]} of them)"
            )
        self.slopes = slopes
        for array in (self.solid, self.one_way, self.slopes):
            array.flags.writeable = False

    @cached_property
    def blocks(self) -> tuple[list[tuple[int, int, int, int]], list[list[int]], list[tuple[int, int, int, int]]]:
        """Blocks (left, top, right, bottom) of solid cells, cells with a slope, and blocks of one-way cells."""
        return (
            solid_blocks(self.solid),
            np.argwhere((self.slopes > 0.0).any(axis=2)).tolist(),
            solid_blocks(self.one_way),
        )

    @cached_property
    def is_empty(self) -> bool:
        """Whether no cell holds anything."""
        return not (self.solid.any() or self.one_way.any() or (self.slopes > 0.0).any())

    @property
    def smallest_half(self) -> float:
        return self.tile_size / 2.0

    def mass_of(self, density: float) -> Mass:
        return NOTHING  # tiles are ground: they only carry

    def reach(self, x: float, y: float) -> float:
        height, width = self.solid.shape
        far_x = max(abs(x), abs(width * self.tile_size - x))
        far_y = max(abs(y), abs(height * self.tile_size - y))
        return math.hypot(far_x, far_y)

    def __repr__(self):
        return f"TileGrid({self.solid.shape[0]} x {self.solid.shape[1]} tiles of {self.tile_size} px)"


def bools(name: str, value: ArrayLike) -> np.ndarray:
    """A C-ordered bool array [row, col]. Raises TypeError, ValueError."""
    _refuse_pixels_of_pygame(name, value)
    try:
        array = np.array(value)
    except ValueError:
        raise TypeError(f"{name} must be an array [row, col] of bool (got rows of different lengths)") from None
    if array.ndim != 2:
        raise ValueError(f"{name} must be an array [row, col] (got {array.ndim} dimensions)")
    if array.dtype != np.bool_ and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{name} must be an array of bool (got {array.dtype})")
    return np.ascontiguousarray(array != 0)


def _refuse_pixels_of_pygame(name: str, value: Any) -> None:
    """NumPy would read the words of a pygame Mask, which lie in columns of bits, as numbers of pixels."""
    pygame = sys.modules.get("pygame")  # whoever has a Mask has imported it; the physics does not
    for kind, way_in in (("Mask", "from_mask(mask)"), ("Surface", "from_surface(surface)")):
        known = getattr(pygame, kind, None)
        if isinstance(known, type) and isinstance(value, known):
            raise TypeError(
                f"{name} must be an array [row, col] of bool (got the pygame {kind} {value!r}): "
                f"PixelMask.{way_in} takes it"
            )
