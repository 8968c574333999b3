"""A ray against lines and rounded hulls: segments from both sides, the links of a chain from the front, capsules."""

from physics.ccd.closed_form import MISS, cast_on_polygon, sweep_circles
from physics.collision.clipping import ALL_EDGES, edge_normal
from physics.collision.hulls import collide_hull_circle, edge_gap
from physics.jit import subkernel
from physics.math2d import turned, unit


@subkernel
def cast_on_line(ax, ay, bx, by, x, y, dx, dy):
    """A ray from (x, y) by (dx, dy) [px] against the closed line from a to b: the fraction, or MISS.

    By the sides of the ray on which the ends lie, so that nothing slips through between two lines that share an end. A
    ray along the line meets its nearer end; a start on it is met at 0.
    """
    side_a = dx * (ay - y) - dy * (ax - x)
    side_b = dx * (by - y) - dy * (bx - x)
    if (side_a > 0.0 and side_b > 0.0) or (side_a < 0.0 and side_b < 0.0):
        return MISS
    across = side_b - side_a
    if across != 0.0:
        fraction = ((ax - x) * (by - ay) - (ay - y) * (bx - ax)) / across
        return fraction if 0.0 <= fraction <= 1.0 else MISS
    square = dx * dx + dy * dy
    if square == 0.0:
        return MISS
    to_a = (dx * (ax - x) + dy * (ay - y)) / square
    to_b = (dx * (bx - x) + dy * (by - y)) / square
    near = min(to_a, to_b)
    far = max(to_a, to_b)
    if far < 0.0 or near > 1.0:
        return MISS
    return max(0.0, near)


@subkernel
def cast_on_segment(corners, x, y, dx, dy):
    """A ray against a segment, met from both sides [px]: (fraction or MISS, normal against the ray)."""
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    if edge_gap(corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y) == 0.0:
        return 0.0, back_x, back_y
    fraction = cast_on_line(corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y, dx, dy)
    nx, ny = edge_normal(corners, 2, 0)
    facing = nx * dx + ny * dy
    if facing == 0.0:
        return fraction, back_x, back_y
    return fraction, nx if facing < 0.0 else -nx, ny if facing < 0.0 else -ny


@subkernel
def cast_on_disc(x, y, dx, dy, radius):
    """A ray from (x, y), seen from the centre of a closed disc [px]: (fraction or MISS, normal); inside: 0."""
    if x * x + y * y <= radius * radius:
        back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
        return 0.0, back_x, back_y
    return sweep_circles(x, y, dx, dy, radius)


@subkernel
def cast_on_hull(corners, count, radius, x, y, dx, dy):
    """A ray against a closed hull of two or more corners grown by a radius [px]: (fraction or MISS, normal).

    Inside at the start: 0 and the normal against the ray; of no length: the point alone.
    """
    if radius == 0.0 and count == 2:
        return cast_on_segment(corners, x, y, dx, dy)
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    _, _, _, _, _, separation, _ = collide_hull_circle(corners, count, ALL_EDGES, radius, x, y, 0.0)
    if separation <= 0.0:
        return 0.0, back_x, back_y
    if dx == 0.0 and dy == 0.0:
        return MISS, 0.0, -1.0
    if radius == 0.0:
        return cast_on_polygon(corners, count, ALL_EDGES, x, y, dx, dy)
    best = MISS
    best_x = back_x
    best_y = back_y
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        nx, ny = edge_normal(corners, count, k)
        if nx * dx + ny * dy < 0.0:
            fraction = cast_on_line(
                corners[k, 0] + radius * nx,
                corners[k, 1] + radius * ny,
                corners[n, 0] + radius * nx,
                corners[n, 1] + radius * ny,
                x,
                y,
                dx,
                dy,
            )
            if fraction < best:
                best = fraction
                best_x = nx
                best_y = ny
        fraction, nx, ny = sweep_circles(x - corners[k, 0], y - corners[k, 1], dx, dy, radius)
        if fraction < best:
            best = fraction
            best_x = nx
            best_y = ny
    return best, best_x, best_y


@subkernel
def crosses_box(x, y, dx, dy, min_x, min_y, max_x, max_y):
    """Whether a ray [px] comes near a closed box, as far as rounding goes."""
    rim = 1e-9 * (max_x - min_x + max_y - min_y + abs(dx) + abs(dy)) + 1e-15 * (abs(x) + abs(y))
    enter = 0.0
    leave = 1.0
    for axis in range(2):
        position = x if axis == 0 else y
        step = dx if axis == 0 else dy
        low = (min_x if axis == 0 else min_y) - rim
        high = (max_x if axis == 0 else max_y) + rim
        if step == 0.0:
            if position < low or position > high:
                return False
        else:
            enter = max(enter, min((low - position) / step, (high - position) / step))
            leave = min(leave, max((low - position) / step, (high - position) / step))
    return enter <= leave


@subkernel
def cast_on_chain(chains, links, blocks, chain, x, y, cosine, sine, dx, dy, block_links):
    """A ray against a chain's links from their front: (fraction or MISS, normal). Of no length: a point on the line.

    x, y [px]: the start seen from the chain's body, in the world's directions; cosine, sine: of the body's angle.
    block_links: links per block. O(blocks + links near the ray).
    """
    span = chains[chain]
    x, y = turned(x, y, cosine, -sine)
    dx, dy = turned(dx, dy, cosine, -sine)
    point = dx == 0.0 and dy == 0.0
    best = MISS
    best_x = 0.0
    best_y = -1.0
    for block in range(span.blocks):
        box = blocks[span.first_block + block]
        if not crosses_box(x, y, dx, dy, box.min_x, box.min_y, box.max_x, box.max_y):
            continue
        for k in range(block * block_links, min(span.count, (block + 1) * block_links)):
            link = links[span.offset + k]
            if point:
                if edge_gap(link.ax, link.ay, link.bx, link.by, x, y) == 0.0:
                    return 0.0, 0.0, -1.0
                continue
            nx, ny = unit(link.by - link.ay, link.ax - link.bx, 0.0, -1.0)
            if nx * dx + ny * dy >= 0.0:
                continue
            fraction = cast_on_line(link.ax, link.ay, link.bx, link.by, x, y, dx, dy)
            if fraction < best:
                best = fraction
                best_x = nx
                best_y = ny
    best_x, best_y = turned(best_x, best_y, cosine, sine)
    return best, best_x, best_y
