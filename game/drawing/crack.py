"""Cracks: jagged lines of pixels across a raster, along which a shape is cut into fragments."""

from math import cos, hypot, sin

import numpy as np

JAG, SIDEWAYS = 5.0, 2.6  # [px] from corner to corner of a crack, and greatest offset of these from its line
FINE = 0.25  # [px] between the points that are drawn


def draw_crack(solid: np.ndarray, at: tuple[float, float], heading: float, random: np.random.Generator) -> None:
    """Set the pixels of a random crack in `solid`, a bool array [row, column], to True.

    The crack passes through the point `at` (x, y) [px] in the mean direction `heading` [rad], and crosses the whole
    raster. It is two pixels wide, so that the pixels on both sides of the crack do not touch at corners.
    """
    height, width = solid.shape
    reach = JAG * (1 + int(hypot(height, width) // JAG))
    corners = np.arange(-reach, reach + JAG, JAG)
    along = np.arange(-reach, reach, FINE)
    aside = np.interp(along, corners, random.uniform(-SIDEWAYS, SIDEWAYS, len(corners)))
    columns = np.floor(at[0] + along * cos(heading) - aside * sin(heading)).astype(np.int64)
    rows = np.floor(at[1] + along * sin(heading) + aside * cos(heading)).astype(np.int64)
    for dx in (0, 1):
        for dy in (0, 1):
            inside = (columns + dx >= 0) & (columns + dx < width) & (rows + dy >= 0) & (rows + dy < height)
            solid[rows[inside] + dy, columns[inside] + dx] = True
