"""One link of a chain, met from its front, against a disc and a hull.

        before
           \\
            a ------------> b          front: the side of (dy, -dx), up here
                             \\
                              after    a convex corner: the solid side bends away

What is pushed goes along the link's own normal, or, at a convex corner, along one between the normals of both links: so
a corner between two links is felt only as far as it sticks out. Of two links that share a corner, the earlier one
reports it, unless what meets it is behind that one. An open end may push up to a quarter turn around. Names as in
tables.LINK.
"""

from physics.collision.clipping import ALL_EDGES, best_edge, clip_edges, support_manifold
from physics.collision.features import CIRCLE_CORNER, OPEN_END
from physics.collision.hulls import corner_manifold, least_separation, nearest_corners, segments_gap, slack_of
from physics.jit import subkernel
from physics.math2d import length_of, turned, unit

STRAIGHT = 1e-9  # sine of a bend between two links that counts as none
ADMIT, SNAP, SKIP = 0, 1, 2  # a normal that a link may have; that of the link instead; a neighbour's


@subkernel
def link_at(links, link, x, y, cosine, sine, corners_out):
    """Write a link's ends a, b and its neighbours' far ends before, after [px, world] to corners_out (16, 2)."""
    k = links[link]
    for end in range(4):
        u = k.ax if end == 0 else (k.bx if end == 1 else (k.before_x if end == 2 else k.after_x))
        v = k.ay if end == 0 else (k.by if end == 1 else (k.before_y if end == 2 else k.after_y))
        u, v = turned(u, v, cosine, sine)
        corners_out[end, 0] = x + u
        corners_out[end, 1] = y + v


@subkernel
def along(points, i, j, x, y, origin):
    """The component [px2] of (x, y), seen from point `origin`, along the line from point i to j."""
    return (points[j, 0] - points[i, 0]) * (x - points[origin, 0]) + (points[j, 1] - points[i, 1]) * (
        y - points[origin, 1]
    )


@subkernel
def in_front(points, i, j, x, y):
    """Distance [px] of (x, y) in front of the line from point i to j."""
    nx, ny = unit(points[j, 1] - points[i, 1], points[i, 0] - points[j, 0], 0.0, -1.0)
    return nx * (x - points[i, 0]) + ny * (y - points[i, 1])


@subkernel
def is_convex(points, i, j, k):
    """Whether the solid side bends away at point j, on the way from i to k."""
    dx = points[j, 0] - points[i, 0]
    dy = points[j, 1] - points[i, 1]
    ex = points[k, 0] - points[j, 0]
    ey = points[k, 1] - points[j, 1]
    return dx * ey - dy * ex > STRAIGHT * length_of(dx, dy) * length_of(ex, ey)


@subkernel
def is_gentle_hollow(points, i, j, k):
    """Whether the chain bends towards its front at point j, on the way from i to k, by less than about 30 degrees."""
    dx = points[j, 0] - points[i, 0]
    dy = points[j, 1] - points[i, 1]
    ex = points[k, 0] - points[j, 0]
    ey = points[k, 1] - points[j, 1]
    size = length_of(dx, dy) * length_of(ex, ey)
    return -0.5 * size < dx * ey - dy * ex < 0.0 and dx * ex + dy * ey > 0.0


@subkernel
def is_behind(link, points, x, y):
    """Whether what has its centre at (x, y) is behind a link, and so does not meet it.

    In a hollow of many short links a centre that was pressed close to one slides past its end, behind the next: as long
    as it is in front of the one it comes from it still meets that next one.
    """
    if in_front(points, 0, 1, x, y) >= 0.0:
        return False
    if (
        link.has_before
        and is_gentle_hollow(points, 2, 0, 1)
        and in_front(points, 2, 0, x, y) >= 0.0
        and along(points, 2, 0, x, y, 0) >= 0.0
    ):
        return False
    if (
        link.has_after
        and is_gentle_hollow(points, 0, 1, 3)
        and in_front(points, 1, 3, x, y) >= 0.0
        and along(points, 1, 3, x, y, 1) <= 0.0
    ):
        return False
    return True


@subkernel
def owns_start(link, points, x, y):
    """Whether the corner at a is this link's to report to what has its centre at (x, y)."""
    return link.first_owned or in_front(points, 2, 0, x, y) < 0.0


@subkernel
def collide_link_circle(link, points, x, y, radius):
    """A link against a disc [px]: (found, normal to the disc, point midway, separation, feature).

    link: its row of LINK; points: see link_at. Features as in hulls.collide_line_circle.
    """
    nx, ny = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    height = nx * (x - points[0, 0]) + ny * (y - points[0, 1])
    if is_behind(link, points, x, y):
        return False, nx, ny, x, y, 0.0, 0
    corner = -1
    if along(points, 0, 1, x, y, 0) < 0.0:
        if link.has_before:
            # The same product, to the bit, by which the link before decides that this is beyond its end.
            if along(points, 2, 0, x, y, 0) < 0.0:
                return False, nx, ny, x, y, 0.0, 0
            if is_convex(points, 2, 0, 1):
                if not owns_start(link, points, x, y):
                    return False, nx, ny, x, y, 0.0, 0
                corner = 0
        else:
            corner = 0
    elif along(points, 0, 1, x, y, 1) >= 0.0:
        if link.has_after:
            if not is_convex(points, 0, 1, 3) or along(points, 1, 3, x, y, 1) >= 0.0:
                return False, nx, ny, x, y, 0.0, 0
        corner = 1
    if corner >= 0 and height < 0.0:
        return False, nx, ny, x, y, 0.0, 0
    if corner >= 0:
        dx = x - points[corner, 0]
        dy = y - points[corner, 1]
        nx, ny = unit(dx, dy, nx, ny)
        height = length_of(dx, dy)
    separation = height - radius
    middle = height - 0.5 * separation
    return True, nx, ny, x - middle * nx, y - middle * ny, separation, CIRCLE_CORNER + corner if corner >= 0 else 0


@subkernel
def judge_normal(link, points, nx, ny):
    """What a link makes of a normal from it to a hull: ADMIT, SNAP to its own, SKIP: a neighbour's."""
    towards_end = along(points, 0, 1, points[0, 0] + nx, points[0, 1] + ny, 0) > 0.0
    has_neighbour = link.has_after if towards_end else link.has_before
    own_x, own_y = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    if not has_neighbour:
        return ADMIT if nx * own_x + ny * own_y >= -STRAIGHT else SNAP
    if towards_end:
        if not is_convex(points, 0, 1, 3):
            return SNAP
        mx, my = unit(points[3, 1] - points[1, 1], points[1, 0] - points[3, 0], 0.0, -1.0)
        inside = nx * my - ny * mx
    else:
        if not is_convex(points, 2, 0, 1):
            return SNAP
        mx, my = unit(points[0, 1] - points[2, 1], points[2, 0] - points[0, 0], 0.0, -1.0)
        inside = mx * ny - my * nx
    ahead = nx * own_x + ny * own_y >= -STRAIGHT or nx * mx + ny * my >= -STRAIGHT
    # What points back through both is nobody's.
    if not ahead:
        return SNAP
    return ADMIT if inside >= -STRAIGHT else SKIP


@subkernel
def neighbour_separates(points, nx, ny, hull, count, x, y, face):
    """Whether the neighbour at a normal's side meets a hull with its centre at (x, y), less than `face` [px] deep."""
    towards_end = along(points, 0, 1, points[0, 0] + nx, points[0, 1] + ny, 0) > 0.0
    i = 1 if towards_end else 2
    j = 3 if towards_end else 0
    if in_front(points, i, j, x, y) < 0.0:
        return False
    for k in range(count):
        if in_front(points, i, j, hull[k, 0], hull[k, 1]) <= face:
            return False
    return True


@subkernel
def push_at_open_end(link, points, hull, count, radius, face, margin, manifold_out):
    """One point on the face across an open end, where it separates more than the link's own [px]; the number."""
    ex, ey = unit(points[1, 0] - points[0, 0], points[1, 1] - points[0, 1], 1.0, 0.0)
    manifold_out[0] = 0.0
    best = face
    for end in range(2):
        if link.has_before if end == 0 else link.has_after:
            continue
        sign = -1.0 if end == 0 else 1.0
        nearest = 0
        least = sign * (ex * (hull[0, 0] - points[end, 0]) + ey * (hull[0, 1] - points[end, 1]))
        for k in range(1, count):
            gap = sign * (ex * (hull[k, 0] - points[end, 0]) + ey * (hull[k, 1] - points[end, 1]))
            if gap < least:
                least = gap
                nearest = k
        if least > best and least - radius <= margin:
            best = least
            middle = 0.5 * (least + radius)
            manifold_out[0] = 1.0
            manifold_out[1] = sign * ex
            manifold_out[2] = sign * ey
            manifold_out[3] = hull[nearest, 0] - middle * sign * ex
            manifold_out[4] = hull[nearest, 1] - middle * sign * ey
            manifold_out[5] = least - radius
            manifold_out[6] = float(OPEN_END + end)
    return int(manifold_out[0])


@subkernel
def keep_owned(link, points, x, y, count, manifold_out):
    """Drop the points of a manifold at a corner that is the link before's to report. Returns how many stay."""
    nx = manifold_out[1]
    ny = manifold_out[2]
    if along(points, 0, 1, points[0, 0] + nx, points[0, 1] + ny, 0) > 0.0 or owns_start(link, points, x, y):
        return count
    length = length_of(points[1, 0] - points[0, 0], points[1, 1] - points[0, 1])
    kept = 0
    for k in range(count):
        at = 3 + 4 * k
        px = manifold_out[at] - 0.5 * manifold_out[at + 2] * nx
        py = manifold_out[at + 1] - 0.5 * manifold_out[at + 2] * ny
        if along(points, 0, 1, px, py, 0) > 1e-6 * length * length:
            for field in range(4):
                manifold_out[3 + 4 * kept + field] = manifold_out[at + field]
            kept += 1
    manifold_out[0] = float(kept)
    return kept


@subkernel
def collide_link_hull(link, points, hull, count, radius, margin, bias, alone, manifold_out):
    """A link against a hull of two or more corners: see hulls.collide_hulls. Returns the number of points.

    alone: nothing is left to neighbours, after none of them told.
    """
    x = 0.0
    y = 0.0
    for k in range(count):
        x += hull[k, 0] / count
        y += hull[k, 1] / count
    manifold_out[0] = 0.0
    if is_behind(link, points, x, y):
        return 0
    _, face, _ = best_edge(points, 2, 1, hull, count)
    edge, other, _ = best_edge(hull, count, ALL_EDGES, points, 2)
    if max(face, other) > margin + radius:
        return 0
    apart = max(face, other) > 0.0 or (count == 2 and segments_gap(points, hull) > 0.0)
    verdict = SNAP
    own = clip_edges(points, 2, 0.0, 0, hull, count, radius, margin, False, manifold_out)
    stands = own > 0 and least_separation(own, manifold_out) <= face - radius + max(
        bias if radius == 0.0 else 0.0, slack_of(points, 2, 0)
    )
    if other > face + bias or (apart and not stands):
        nx, ny = unit(
            hull[edge, 1] - hull[edge + 1 if edge + 1 < count else 0, 1],
            hull[edge + 1 if edge + 1 < count else 0, 0] - hull[edge, 0],
            0.0,
            -1.0,
        )
        verdict = judge_normal(link, points, nx, ny)
        if alone and verdict == SKIP:
            verdict = ADMIT
        if other <= face + bias:
            verdict = ADMIT if verdict == ADMIT else SNAP
        elif verdict == SKIP:
            if apart or neighbour_separates(points, nx, ny, hull, count, x, y, face):
                manifold_out[0] = 0.0
                return 0
            verdict = SNAP
        if verdict == ADMIT:
            found = clip_edges(hull, count, radius, edge, points, 2, 0.0, margin, True, manifold_out)
            least = least_separation(found, manifold_out)
            if not apart and least > -radius:
                found = support_manifold(hull, count, radius, edge, points, 2, 0.0, True, manifold_out)
                least = manifold_out[5]
            if not apart or (found > 0 and least <= other - radius + slack_of(hull, count, edge)):
                return found if alone else keep_owned(link, points, x, y, found, manifold_out)
        if apart:
            i, j, _ = nearest_corners(points, 2, hull, count)
            nx, ny = unit(hull[j, 0] - points[i, 0], hull[j, 1] - points[i, 1], 0.0, -1.0)
            at_corner = judge_normal(link, points, nx, ny)
            if at_corner == ADMIT or (alone and at_corner == SKIP):
                found = corner_manifold(points, i, 0.0, hull, j, radius, margin, manifold_out)
                return found if alone else keep_owned(link, points, x, y, found, manifold_out)
            if at_corner == SKIP:
                manifold_out[0] = 0.0
                return 0
        elif verdict == SNAP and not (link.has_before and link.has_after):
            if push_at_open_end(link, points, hull, count, radius, face, margin, manifold_out) > 0:
                return 1
        own = clip_edges(points, 2, 0.0, 0, hull, count, radius, margin, False, manifold_out)
    if own == 0 and not apart:
        return support_manifold(points, 2, 0.0, 0, hull, count, radius, False, manifold_out)
    return own
