"""Test of a box of whole pixels against tile ground, tile by tile and pixel column by pixel column."""


def inside_ground(solid, slopes, size, left, top, width, height):
    """Return whether a box of whole pixels is inside tile ground.

    It is if it shares area with a solid tile, or if one of its columns reaches below the surface of a slope.
    """
    for j in range(len(solid)):
        for i in range(len(solid[j])):
            x, y = i * size, j * size
            if left >= x + size or left + width <= x or top >= y + size or top + height <= y:
                continue
            if solid[j][i]:
                return True
            start, end = slopes[j][i]
            if start == 0.0 and end == 0.0:
                continue
            for at in (max(left, x), min(left + width, x + size)):
                surface = y + size - (start + (at - x) / size * (end - start)) * size
                if top + height > surface + 1e-9:
                    return True
    return False
