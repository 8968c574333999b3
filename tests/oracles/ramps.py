"""Pose of a convex shape on a straight slope, in closed form."""

import math


def reach(points, radius, x, y):
    """Return the greatest extent [px] of a rounded hull from its origin along the unit direction (x, y)."""
    return max(px * x + py * y for px, py in points) + radius


def resting_y(points, radius, x, slope, through=(0.0, 0.0)):
    """Return the y [px] of the origin of a shape at x that touches a line from above; y points down the screen.

    The line rises by `slope` per px to the right and passes through the point `through`.
    """
    length = math.sqrt(1.0 + slope * slope)
    nx, ny = slope / length, 1.0 / length  # into the ground
    # (x, y) in front of the line by as far as the shape reaches.
    return through[1] - ((x - through[0]) * nx + reach(points, radius, nx, ny)) / ny


def slide(slope, way):
    """Return the projection (x, down) [px] of a motion straight down on a slope. way: length of the motion [px]."""
    angle = math.atan(slope)
    return -way * math.sin(angle) * math.cos(angle), way * math.sin(angle) ** 2
