"""How much of a region lies in a box along the axes, and where: closed forms over the region's outline.

By Green's theorem the area is the integral of x dy round the outline, its x held within the box and only where y is;
so are the moments. Each line and each arc of the outline has a share of them, and the sum over all is exact: no
polygon is clipped, nothing is kept between. Everything is seen from the box's top left corner; the outline runs
clockwise on the screen, where y points down.
"""

import math

from physics.jit import subkernel


@subkernel
def between(value, low, high):
    """The value, or the bound that it is beyond."""
    return max(low, min(high, value))


@subkernel
def line_share(px, py, qx, qy, width, height):
    """Share of the line from p to q [px] in (area, moment of x, moment of y) of what lies in the box
    0..width x 0..height.

    Cut where it crosses the box's sides, it has up to three pieces; along each, x as it is held is linear.
    """
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    start = between(py, 0.0, height)
    end = between(qy, 0.0, height)
    if start == end:
        return area, moment_x, moment_y
    slope = (qx - px) / (qy - py) if qy != py else 0.0
    x0 = px if start == py else px + slope * (start - py)
    x1 = qx if end == qy else qx + slope * (end - qy)
    first = 0.0
    second = 1.0
    if x0 != x1:
        at_left = between(-x0 / (x1 - x0), 0.0, 1.0)
        at_right = between((width - x0) / (x1 - x0), 0.0, 1.0)
        first = min(at_left, at_right)
        second = max(at_left, at_right)
    for piece in range(3):
        low = 0.0 if piece == 0 else (first if piece == 1 else second)
        high = first if piece == 0 else (second if piece == 1 else 1.0)
        if high <= low:
            continue
        xa = between(x0 + low * (x1 - x0), 0.0, width)
        xb = between(x0 + high * (x1 - x0), 0.0, width)
        ya = start + low * (end - start)
        yb = start + high * (end - start)
        dy = yb - ya
        area += 0.5 * dy * (xa + xb)
        moment_x += dy * (xa * xa + xa * xb + xb * xb) / 6.0
        moment_y += dy * (xa * (2.0 * ya + yb) + xb * (ya + 2.0 * yb)) / 6.0
    return area, moment_x, moment_y


@subkernel
def arc_primitives(x, y, radius, angle):
    """Integrals from 0 to an angle of x dy, x²/2 dy and x y dy along a circle around (x, y)."""
    cosine = math.cos(angle)
    sine = math.sin(angle)
    r2 = radius * radius
    straight = x * radius * sine + r2 * (0.5 * angle + 0.5 * sine * cosine)
    squared = 0.5 * (
        x * x * radius * sine
        + 2.0 * x * r2 * (0.5 * angle + 0.5 * sine * cosine)
        + r2 * radius * (sine - sine * sine * sine / 3.0)
    )
    mixed = y * straight + 0.5 * x * r2 * sine * sine - r2 * radius * cosine * cosine * cosine / 3.0
    return straight, squared, mixed


@subkernel
def next_cut(x, y, radius, width, height, after, until):
    """The first angle behind `after`, at most `until`, at which a circle around (x, y) crosses a line of the box."""
    best = until
    for side in range(4):
        away = (0.0 - x if side == 0 else width - x) if side < 2 else (0.0 - y if side == 2 else height - y)
        if abs(away) > radius:
            continue
        across = math.sqrt(radius * radius - away * away)
        for end in range(2):
            other = across if end == 0 else -across
            angle = math.atan2(other, away) if side < 2 else math.atan2(away, other)
            angle += math.tau * math.ceil((after - angle) / math.tau)
            if angle <= after:
                angle += math.tau
            best = min(best, angle)
    return best


@subkernel
def arc_share(x, y, radius, start, end, width, height):
    """As line_share, for the arc round (x, y) [px] from an angle `start` to a greater one `end` [rad]."""
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    low = start
    while low < end:
        high = next_cut(x, y, radius, width, height, low, end)
        # Beside the middle, where an arc between two cuts may just touch a line.
        within = low + 0.4 * (high - low)
        at_x = x + radius * math.cos(within)
        at_y = y + radius * math.sin(within)
        if 0.0 < at_y < height and at_x > 0.0:
            if at_x < width:
                a0, x0, y0 = arc_primitives(x, y, radius, low)
                a1, x1, y1 = arc_primitives(x, y, radius, high)
                area += a1 - a0
                moment_x += x1 - x0
                moment_y += y1 - y0
            else:
                ya = y + radius * math.sin(low)
                yb = y + radius * math.sin(high)
                area += width * (yb - ya)
                moment_x += 0.5 * width * width * (yb - ya)
                moment_y += 0.5 * width * (yb * yb - ya * ya)
        low = high
    return area, moment_x, moment_y
