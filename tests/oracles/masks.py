"""Overlap of two bitmaps, pixel by pixel."""


def shared_pixels(a, a_left, a_top, b, b_left, b_top):
    """Return [(x, y), ...] of the pixels that two bitmaps [row][col] share, in reading order.

    a_left, a_top, b_left, b_top: integer positions of their top left corners.
    """
    found = []
    for row in range(len(a)):
        for column in range(len(a[row])):
            if a[row][column]:
                i, j = column + a_left - b_left, row + a_top - b_top
                if 0 <= j < len(b) and 0 <= i < len(b[j]) and b[j][i]:
                    found.append((column + a_left, row + a_top))
    return found


def bounds(a, left, top):
    """Return (left, top, right, bottom) of the solid pixels, right and bottom exclusive; None if there are none."""
    solid = [(i + left, j + top) for j, row in enumerate(a) for i, pixel in enumerate(row) if pixel]
    if not solid:
        return None
    xs, ys = [x for x, _ in solid], [y for _, y in solid]
    return min(xs), min(ys), max(xs) + 1, max(ys) + 1


def least_overlap(a, b):
    """Return the shortest move along x or y that separates two rectangles (left, top, right, bottom)."""
    return min(a[2] - b[0], b[2] - a[0], a[3] - b[1], b[3] - a[1])
