"""Two bitmaps, pixel by pixel."""


def shared_pixels(a, a_left, a_top, b, b_left, b_top):
    """Return [(x, y), ...] in reading order, of the pixels that two bitmaps [row][col] drawn at whole places share."""
    found = []
    for row in range(len(a)):
        for column in range(len(a[row])):
            if a[row][column]:
                i, j = column + a_left - b_left, row + a_top - b_top
                if 0 <= j < len(b) and 0 <= i < len(b[j]) and b[j][i]:
                    found.append((column + a_left, row + a_top))
    return found


def bounds(a, left, top):
    """Return (left, top, right, bottom) of the solid pixels, right and bottom exclusive; None when there is none."""
    solid = [(i + left, j + top) for j, row in enumerate(a) for i, pixel in enumerate(row) if pixel]
    if not solid:
        return None
    xs, ys = [x for x, _ in solid], [y for _, y in solid]
    return min(xs), min(ys), max(xs) + 1, max(ys) + 1


def least_overlap(a, b):
    """The shortest move along an axis that parts two rectangles."""
    return min(a[2] - b[0], b[2] - a[0], a[3] - b[1], b[3] - a[1])
