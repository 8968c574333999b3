"""Ground shapes and the closed area that each encloses, which no body's centre may enter."""

import itertools

import numpy as np
import shapely
from shapely import affinity

from physics import Chain, TileGrid

EMPTY, FULL, RISES, FALLS, HALF_RISES, HALF_FALLS = range(6)  # what a cell is
HEIGHTS = {RISES: (0.0, 1.0), FALLS: (1.0, 0.0), HALF_RISES: (0.5, 1.0), HALF_FALLS: (1.0, 0.5)}


def grid_of(cells, size):
    """Return the TileGrid with the given kinds of cells."""
    cells = np.asarray(cells)
    slopes = np.zeros((*cells.shape, 2))
    for kind, heights in HEIGHTS.items():
        slopes[cells == kind] = heights
    return TileGrid(cells == FULL, size, slopes=slopes)


def pieces_of(cells, size):
    """Return the solid part of each cell as a list of corners, clockwise on the screen."""
    found = []
    for row, column in itertools.product(*map(range, np.shape(cells))):
        kind = cells[row][column]
        if kind != EMPTY:
            left, right = HEIGHTS.get(kind, (1.0, 1.0))
            x, y = column * size, (row + 1) * size
            corners = [(x, y - left * size), (x + size, y - right * size), (x + size, y), (x, y)]
            found.append([each for k, each in enumerate(corners) if each != corners[k - 1]])
    return found


def area_of(pieces, pose=(0.0, 0.0, 0.0)):
    """Return the union of polygons at a pose as a shapely geometry."""
    union = shapely.union_all([shapely.Polygon(each) for each in pieces])
    turned = affinity.rotate(union, pose[2], origin=(0.0, 0.0), use_radians=True)
    return affinity.translate(turned, pose[0], pose[1])


def loop_of(rng, links, size, concave):
    """Return the corners of a random simple loop, clockwise on the screen.

    concave: True gives it random radii, so that corners may turn inwards.
    """
    while True:
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, links))
        if np.diff(np.append(angles, angles[0] + 2.0 * np.pi)).max() > 3.0:
            continue
        radii = rng.uniform(0.25, 1.0, links) * size if concave else np.full(links, size)
        points = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
        area = shapely.Polygon(points)
        short = np.hypot(*(points - np.roll(points, 1, axis=0)).T).min()
        if area.is_valid and area.area > 0.1 * size * size and short > 0.05 * size:
            return points


def island(points):
    """Return a chain along a closed loop whose inside is solid. points: corners, clockwise on the screen."""
    return Chain([tuple(each) for each in points], loop=True)


def room(points):
    """Return a chain along a closed loop whose outside is solid. points: corners, clockwise on the screen."""
    return Chain([tuple(each) for each in points[::-1]], loop=True)
