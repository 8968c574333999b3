"""Collision of chains with discs, hulls and masks, link by link, and of one-way platforms made of masks."""

import math

from physics.collision.hull_pairs import (
    NEVER,
    Meeting,
    add_circle_on_piece,
    add_points_on_piece,
    advance_to_piece,
    keep_lines_apart,
    time_to_piece,
    travel_of,
)
from physics.collision.hulls import (
    ALL_EDGES,
    CIRCLE_CORNER,
    OPEN_END,
    Hull,
    aabb_corners,
    clip_edges,
    clip_tolerance,
    corner_manifold,
    distance_to_edge,
    find_max_separation,
    least_separation,
    middle_of,
    move_corners,
    nearest_corners,
    part_feature,
    segment_distance,
    support_manifold,
    write_normals,
)
from physics.collision.manifold import CHAIN_ANY, NOTHING, SURFACE_ANY, add_point, hull_of, make_pass, sides_by_kind
from physics.collision.masks import offset_line
from physics.collision.masks_exact import collide_mask_part, tested_aabb
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm, rotate, unit
from physics.shapes.placement import hull_at, rounding
from physics.tables.geometry import BLOCK_LINKS
from physics.tables.shape import BOUNDS, CHAIN, MASK
from physics.tables.step_state import MASK_TESTS

# ---- chains ----------------------------------------------------------------------------------------------------------
# One link of a chain, touched from its front, against a disc and a hull.
#
#         before
#            \
#             a ------------> b          front: the side to which (dy, -dx) points, here up
#                              \
#                               after    a convex corner: the solid side bends away
#
# The contact normal is the link's own normal or, at a convex corner, a normal between the normals of both links: a
# corner pushes only as far as it protrudes. Of two links that share a corner, the earlier link reports the contact,
# unless the other shape is behind the earlier link. At an open end the contact normal may deviate from the link's
# normal by up to 90 degrees. Names as in physics/tables/geometry.py, LINK.

STRAIGHT = 1e-9  # sine of a bend between two links that counts as straight
ADMIT, SNAP, SKIP = (0, 1, 2)  # for a normal: use it; use the link's normal instead; leave it to the neighbour


@subkernel
def link_at(links, link, x, y, cosine, sine, corners_out):
    """Write four world points [px] to corners_out (16, 2): a link's ends a and b, and the far ends of its neighbours.

    A link is one line of a chain. The order of the points is a, b, before, after: "before" is the far end of the
    previous link, "after" is the far end of the next link. links: LINK table; link: row number in it; x, y [px],
    cosine, sine: pose of the chain's body.
    """
    k = links[link]
    for end in range(4):
        u = k.ax if end == 0 else (k.bx if end == 1 else (k.before_x if end == 2 else k.after_x))
        v = k.ay if end == 0 else (k.by if end == 1 else (k.before_y if end == 2 else k.after_y))
        u, v = rotate(u, v, cosine, sine)
        corners_out[end, 0] = x + u
        corners_out[end, 1] = y + v


@subkernel
def dot_along(points, i, j, x, y, origin):
    """Return the dot product [px2] of the vectors points[origin] -> (x, y) and points[i] -> points[j].

    points (16, 2) [px]; i, j, origin: row numbers in `points`; x, y [px].
    """
    return (points[j, 0] - points[i, 0]) * (x - points[origin, 0]) + (points[j, 1] - points[i, 1]) * (
        y - points[origin, 1]
    )


@subkernel
def height_over(points, i, j, x, y):
    """Return the signed distance [px] of (x, y) from the line through points i and j; positive on the line's left.

    points (16, 2) [px]; i, j: row numbers in `points`. The line is directed from i to j. Left and right are as seen on
    the screen, with y down.
    """
    nx, ny = unit(points[j, 1] - points[i, 1], points[i, 0] - points[j, 0], 0.0, -1.0)
    return nx * (x - points[i, 0]) + ny * (y - points[i, 1])


@subkernel
def is_convex(points, i, j, k):
    """Return whether the polyline i, j, k bends away from its front (left) side at j.

    points (16, 2) [px]; i, j, k: row numbers in `points`.
    """
    dx = points[j, 0] - points[i, 0]
    dy = points[j, 1] - points[i, 1]
    ex = points[k, 0] - points[j, 0]
    ey = points[k, 1] - points[j, 1]
    return dx * ey - dy * ex > STRAIGHT * norm(dx, dy) * norm(ex, ey)


@subkernel
def is_gentle_hollow(points, i, j, k):
    """Return whether the polyline i, j, k bends towards its front (left) side at j, by less than 30 degrees.

    points (16, 2) [px]; i, j, k: row numbers in `points`.
    """
    dx = points[j, 0] - points[i, 0]
    dy = points[j, 1] - points[i, 1]
    ex = points[k, 0] - points[j, 0]
    ey = points[k, 1] - points[j, 1]
    size = norm(dx, dy) * norm(ex, ey)
    return -0.5 * size < dx * ey - dy * ex < 0.0 and dx * ex + dy * ey > 0.0


@subkernel
def is_behind(link, points, x, y):
    """Return whether a shape with its centre at (x, y) is behind a link, and therefore does not collide with it.

    There is an exception at a gentle hollow between this link and a neighbour. A centre that has slid past the
    neighbour's end does not count as behind this link while it is in front of the neighbour's line. link: LINK row;
    points: the link's ends and the far ends of its neighbours [px], see link_at.
    """
    if height_over(points, 0, 1, x, y) >= 0.0:
        return False
    if (
        link.has_before
        and is_gentle_hollow(points, 2, 0, 1)
        and height_over(points, 2, 0, x, y) >= 0.0
        and dot_along(points, 2, 0, x, y, 0) >= 0.0
    ):
        return False
    if (
        link.has_after
        and is_gentle_hollow(points, 0, 1, 3)
        and height_over(points, 1, 3, x, y) >= 0.0
        and dot_along(points, 1, 3, x, y, 1) <= 0.0
    ):
        return False
    return True


@subkernel
def owns_start(link, points, x, y):
    """Return whether this link, not the previous one, reports contacts at its end a with a shape centred at (x, y).

    link: LINK row; points: the link's ends and the far ends of its neighbours [px], see link_at.
    """
    return link.first_owned or height_over(points, 2, 0, x, y) < 0.0


@subkernel
def collide_link_circle(link, points, x, y, radius):
    """Collide a link with a disc. Return (found, nx, ny, px, py, separation, feature); lengths in px.

    found: whether they have a contact; nx, ny: unit normal from link to disc; px, py: contact point, midway between the
    surfaces; feature: 0 for the link's face, CIRCLE_CORNER for its end a, CIRCLE_CORNER + 1 for its end b. link: LINK
    row; points: the link's ends and the far ends of its neighbours, see link_at; x, y, radius: centre and radius of the
    disc.
    """
    nx, ny = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    height = nx * (x - points[0, 0]) + ny * (y - points[0, 1])
    if is_behind(link, points, x, y):
        return False, nx, ny, x, y, 0.0, 0
    corner = -1
    if dot_along(points, 0, 1, x, y, 0) < 0.0:
        if link.has_before:
            # The previous link uses the same product, bit for bit, to decide that the point is beyond its end.
            if dot_along(points, 2, 0, x, y, 0) < 0.0:
                return False, nx, ny, x, y, 0.0, 0
            if is_convex(points, 2, 0, 1):
                if not owns_start(link, points, x, y):
                    return False, nx, ny, x, y, 0.0, 0
                corner = 0
        else:
            corner = 0
    elif dot_along(points, 0, 1, x, y, 1) >= 0.0:
        if link.has_after:
            if not is_convex(points, 0, 1, 3) or dot_along(points, 1, 3, x, y, 1) >= 0.0:
                return False, nx, ny, x, y, 0.0, 0
        corner = 1
    if corner >= 0 and height < 0.0:
        return False, nx, ny, x, y, 0.0, 0
    if corner >= 0:
        dx = x - points[corner, 0]
        dy = y - points[corner, 1]
        nx, ny = unit(dx, dy, nx, ny)
        height = norm(dx, dy)
    separation = height - radius
    middle = height - 0.5 * separation
    return True, nx, ny, x - middle * nx, y - middle * ny, separation, CIRCLE_CORNER + corner if corner >= 0 else 0


@subkernel
def is_towards_end(points, nx, ny):
    """Return whether the direction (nx, ny) points towards end b of a link rather than towards its end a.

    points (16, 2) [px]: the first two rows are the link's ends a and b.
    """
    return dot_along(points, 0, 1, points[0, 0] + nx, points[0, 1] + ny, 0) > 0.0


@subkernel
def classify_normal(link, points, towards_end, nx, ny):
    """Return how to treat the normal (nx, ny) from a link to a hull at one end of the link: ADMIT, SNAP or SKIP.

    ADMIT: use the normal. SNAP: use the link's own normal. SKIP: no contact, because the neighbouring link reports it.
    towards_end: True if the hull touches the link's end b, False for its end a. The result depends on the neighbour at
    this end. link: LINK row; points: the link's ends and the far ends of its neighbours [px], see link_at.
    """
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
    is_outward = nx * own_x + ny * own_y >= -STRAIGHT or nx * mx + ny * my >= -STRAIGHT
    # A normal that points backwards at both links belongs to neither.
    if not is_outward:
        return SNAP
    return ADMIT if inside >= -STRAIGHT else SKIP


@subkernel
def neighbour_separates(points, nx, ny, hull, x, y, face):
    """Return whether a neighbouring link is a better reference face than this link for the contact with a Hull.

    The neighbour at the end towards which (nx, ny) points is tested. This neighbour is better under two conditions. The
    Hull's centre (x, y) must be in front of the neighbour's line. Each corner of the Hull must be more than `face` in
    front of this line. face [px]: the Hull's separation from this link. points: this link's ends and the far ends of
    its neighbours [px], see link_at.
    """
    towards_end = is_towards_end(points, nx, ny)
    i = 1 if towards_end else 2
    j = 3 if towards_end else 0
    if height_over(points, i, j, x, y) < 0.0:
        return False
    for k in range(hull.count):
        if height_over(points, i, j, hull.corners[k, 0], hull.corners[k, 1]) <= face:
            return False
    return True


@subkernel
def push_at_open_end(link, points, hull, face, margin, manifold_out):
    """Write a contact point that pushes a Hull out past an open end of the chain. Return the number of points, 0 or 1.

    The reference plane goes through the open end, perpendicular to the link. A point is written only if the Hull's
    separation from this plane is greater than `face` and at most `margin`. face [px]: the Hull's separation from the
    link's face; margin [px]: largest gap of a contact. link: LINK row; points: the link's ends and the far ends of its
    neighbours [px], see link_at; manifold_out (11,): result, format in hulls.clip_edges.
    """
    ex, ey = unit(points[1, 0] - points[0, 0], points[1, 1] - points[0, 1], 1.0, 0.0)
    manifold_out[0] = 0.0
    best = face
    corners = hull.corners
    for end in range(2):
        if link.has_before if end == 0 else link.has_after:
            continue
        sign = -1.0 if end == 0 else 1.0
        nearest = 0
        least = sign * (ex * (corners[0, 0] - points[end, 0]) + ey * (corners[0, 1] - points[end, 1]))
        for k in range(1, hull.count):
            gap = sign * (ex * (corners[k, 0] - points[end, 0]) + ey * (corners[k, 1] - points[end, 1]))
            if gap < least:
                least = gap
                nearest = k
        if least > best and least - hull.radius <= margin:
            best = least
            middle = 0.5 * (least + hull.radius)
            manifold_out[0] = 1.0
            manifold_out[1] = sign * ex
            manifold_out[2] = sign * ey
            manifold_out[3] = corners[nearest, 0] - middle * sign * ex
            manifold_out[4] = corners[nearest, 1] - middle * sign * ey
            manifold_out[5] = least - hull.radius
            manifold_out[6] = float(OPEN_END + end)
    return int(manifold_out[0])


@subkernel
def keep_owned(link, points, x, y, count, manifold_out):
    """Drop contact points at a link's end a if the previous link reports them. Return the number of remaining points.

    x, y: centre of the other shape; count: number of points in the manifold before the call; manifold_out (11,): the
    manifold, format in hulls.clip_edges. link: LINK row; points: the link's ends and the far ends of its neighbours
    [px], see link_at.
    """
    nx, ny = manifold_out[1], manifold_out[2]
    if is_towards_end(points, nx, ny) or owns_start(link, points, x, y):
        return count
    length = norm(points[1, 0] - points[0, 0], points[1, 1] - points[0, 1])
    kept = 0
    for k in range(count):
        at = 3 + 4 * k
        px = manifold_out[at] - 0.5 * manifold_out[at + 2] * nx
        py = manifold_out[at + 1] - 0.5 * manifold_out[at + 2] * ny
        if dot_along(points, 0, 1, px, py, 0) > 1e-6 * length * length:
            for field in range(4):
                manifold_out[3 + 4 * kept + field] = manifold_out[at + field]
            kept += 1
    manifold_out[0] = float(kept)
    return kept


@subkernel
def collide_link_hull(link, points, hull, margin, bias, is_second, manifold_out):
    """Write the manifold of a link and a Hull of two or more corners. Return the number of points.

    At the common end of two links, only one link reports a contact. If each link expects the other link to report the
    contact, the caller tests the links a second time. is_second: True in this second pass; then the link reports all of
    its contacts. link: LINK row; points: the link's ends and the far ends of its neighbours [px], see link_at; `points`
    and the Hull need edge normals, see hulls.write_normals; margin, bias, manifold_out: as in hulls.collide_hulls.
    """
    corners = hull.corners
    count = hull.count
    radius = hull.radius
    face_hull = Hull(points, 2, 0.0, ALL_EDGES)
    x, y = middle_of(corners, count)
    manifold_out[0] = 0.0
    if is_behind(link, points, x, y):
        return 0
    _, face, _ = find_max_separation(points, 2, 1, corners, count)
    edge, other, _ = find_max_separation(corners, count, ALL_EDGES, points, 2)
    if max(face, other) > margin + radius:
        return 0
    apart = max(face, other) > 0.0 or (count == 2 and segment_distance(points, corners) > 0.0)
    verdict = SNAP
    own = clip_edges(face_hull, 0, hull, margin, False, manifold_out)
    is_over_face = own > 0 and least_separation(own, manifold_out) <= face - radius + max(
        bias if radius == 0.0 else 0.0, clip_tolerance(points, 2, 0)
    )
    if other > face + bias or (apart and not is_over_face):
        following = edge + 1 if edge + 1 < count else 0
        nx, ny = unit(corners[edge, 1] - corners[following, 1], corners[following, 0] - corners[edge, 0], 0.0, -1.0)
        verdict = classify_normal(link, points, is_towards_end(points, nx, ny), nx, ny)
        if is_second and verdict == SKIP:
            verdict = ADMIT
        if other <= face + bias:
            verdict = ADMIT if verdict == ADMIT else SNAP
        elif verdict == SKIP:
            if apart or neighbour_separates(points, nx, ny, hull, x, y, face):
                manifold_out[0] = 0.0
                return 0
            verdict = SNAP
        if verdict == ADMIT:
            found = clip_edges(hull, edge, face_hull, margin, True, manifold_out)
            least = least_separation(found, manifold_out)
            if not apart and least > -radius:
                found = support_manifold(hull, edge, face_hull, True, manifold_out)
                least = manifold_out[5]
            if not apart or (found > 0 and least <= other - radius + clip_tolerance(corners, count, edge)):
                return found if is_second else keep_owned(link, points, x, y, found, manifold_out)
        if apart:
            i, j, _ = nearest_corners(points, 2, corners, count)
            nx, ny = unit(corners[j, 0] - points[i, 0], corners[j, 1] - points[i, 1], 0.0, -1.0)
            at_corner = classify_normal(link, points, i == 1, nx, ny)
            if at_corner == ADMIT or (is_second and at_corner == SKIP):
                found = corner_manifold(face_hull, i, hull, j, margin, manifold_out)
                return found if is_second else keep_owned(link, points, x, y, found, manifold_out)
            if at_corner == SKIP:
                manifold_out[0] = 0.0
                return 0
        elif verdict == SNAP and not (link.has_before and link.has_after):
            if push_at_open_end(link, points, hull, face, margin, manifold_out) > 0:
                return 1
        own = clip_edges(face_hull, 0, hull, margin, False, manifold_out)
    if own == 0 and not apart:
        return support_manifold(face_hull, 0, hull, False, manifold_out)
    return own


# ---- chain pairs -----------------------------------------------------------------------------------------------------
# The pass over the candidate pairs with a chain, link by link. Distant links are skipped in blocks.

BACKING = 2.0  # [px] thickness added behind a link when it is tested against a mask, because a line has no area


@subkernel
def box_in_body(min_x, min_y, max_x, max_y, x, y, cosine, sine):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a world box, transformed to the local space of a body.

    min_x, min_y, max_x, max_y [px]: the box in the world; x, y [px], cosine, sine: pose of the body.
    """
    middle_x, middle_y = rotate(0.5 * (min_x + max_x) - x, 0.5 * (min_y + max_y) - y, cosine, -sine)
    half_x, half_y = 0.5 * (max_x - min_x), 0.5 * (max_y - min_y)
    reach_x = abs(cosine) * half_x + abs(sine) * half_y
    reach_y = abs(sine) * half_x + abs(cosine) * half_y
    return middle_x - reach_x, middle_y - reach_y, middle_x + reach_x, middle_y + reach_y


@subkernel
def misses_box(ax, ay, bx, by, min_x, min_y, max_x, max_y):
    """Return whether the AABB of the segment from (ax, ay) to (bx, by) is disjoint from a box.

    min_x, min_y, max_x, max_y: the box.
    """
    return max(ax, bx) < min_x or min(ax, bx) > max_x or max(ay, by) < min_y or min(ay, by) > max_y


@inlined
def collide_chain_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contacts of candidate number `pair`, a chain and another shape, link by link.

    Return the new number of contacts. The other shape is a hull or mask. O(links near the other shape). Arguments: see
    manifold.make_pass.
    """
    geometry = batch.geometry
    bodies = batch.bodies
    shapes, candidates, margin, links = batch.shapes, batch.candidates, batch.margin, geometry.links
    points = workspace.a
    sign, row, other = sides_by_kind(batch, pair, CHAIN)
    o = shapes[other]
    p, q = bodies[shapes[row].body_row], bodies[o.body_row]
    span = geometry.chains[shapes[row].geometry]
    cosine, sine = math.cos(p.angle), math.sin(p.angle)
    min_x, min_y, max_x, max_y = tested_aabb(geometry, o)
    middle_x, middle_y = 0.5 * (min_x + max_x), 0.5 * (min_y + max_y)
    travel = travel_of(batch, p, q)
    if o.kind != MASK:
        dx, dy = travel.time * travel.vx, travel.time * travel.vy
        min_x, max_x = min_x + min(dx, 0.0), max_x + max(dx, 0.0)
        min_y, max_y = min_y + min(dy, 0.0), max_y + max(dy, 0.0)
    # Slightly more than the margin, so that rounding of the rotated box does not lose a contact.
    rim = margin + 1e-9 * (max_x - min_x + max_y - min_y) + 1e-15 * (abs(p.x) + abs(p.y) + abs(q.x) + abs(q.y))
    min_x, min_y, max_x, max_y = box_in_body(min_x - rim, min_y - rim, max_x + rim, max_y + rim, p.x, p.y, cosine, sine)
    hull = Hull(workspace.b, 0, 0.0, ALL_EDGES)
    if o.kind == MASK:
        work_inout[MASK_TESTS] += 1
    else:
        hull = hull_of(geometry, bodies, shapes, other, workspace.b)
    start = found
    near = 0
    for attempt in range(2):
        # Second pass, if each link left the contact to its neighbour: only links that overlap the hull.
        if attempt == 1 and (near == 0 or found > start):
            break
        reach = travel.reach if attempt == 0 else 0.0
        for block in range(span.blocks):
            box = geometry.link_blocks[span.first_block + block]
            if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, min_x, min_y, max_x, max_y):
                continue
            for k in range(block * BLOCK_LINKS, min(span.count, (block + 1) * BLOCK_LINKS)):
                link = links[span.offset + k]
                if misses_box(link.ax, link.ay, link.bx, link.by, min_x, min_y, max_x, max_y):
                    continue
                link_at(links, span.offset + k, p.x, p.y, cosine, sine, points)
                if o.kind == MASK:
                    if height_over(points, 0, 1, middle_x, middle_y) < 0.0:
                        continue
                    offset_line(points, 0.0, BACKING, workspace.b)
                    area, nx, ny, x, y, separation, _ = collide_mask_part(
                        geometry, q, o, Hull(workspace.b, 4, 0.0, 1), points, workspace.depths
                    )
                    if area > 0.0:
                        point = (-sign * nx, -sign * ny, x, y, separation, area, part_feature(k, 0))
                        found = add_point(shapes, candidates, pair, point, manifolds_out, found)
                elif hull.count == 1:
                    piece = Hull(points, 2, 0.0, ALL_EDGES)
                    radius = hull.radius
                    time = time_to_piece(travel, margin, piece, hull.corners[0, 0], hull.corners[0, 1], radius)
                    if time == NEVER:
                        continue
                    cx = hull.corners[0, 0] + time * travel.vx
                    cy = hull.corners[0, 1] + time * travel.vy
                    contact = collide_link_circle(link, points, cx, cy, radius)
                    disc, meeting = (cx, cy, radius), Meeting(piece, travel, time, sign, part_feature(k, 0))
                    found = add_circle_on_piece(batch, pair, meeting, disc, contact, workspace, manifolds_out, found)
                else:
                    near += 1
                    time = 0.0
                    met = hull
                    write_normals(2, points)
                    piece = Hull(points, 2, 0.0, ALL_EDGES)
                    if travel.time > 0.0 and attempt == 0:
                        time = advance_to_piece(travel, margin, piece, hull, workspace.c)
                        met = Hull(workspace.c, hull.count, hull.radius, ALL_EDGES)
                    if time == NEVER:
                        continue
                    collide_link_hull(link, points, met, reach, batch.bias, attempt == 1, workspace.points)
                    keep_lines_apart(batch.skin, piece, hull, workspace.points)
                    meeting = Meeting(piece, travel, time, sign, part_feature(k, 0))
                    found = add_points_on_piece(batch, pair, meeting, workspace, manifolds_out, found)
    return found


collide_chain_pairs = make_pass(CHAIN_ANY, collide_chain_pair)


# ---- surfaces --------------------------------------------------------------------------------------------------------
# One-way surfaces: selection of the pairs that may touch the upper side of a one-way mask.
#
# Such a side is a chain. A shape whose centre is behind a chain passes through it. This is not enough for a platform: a
# body that jumps halfway through it and falls back would be lifted out when its centre is above. So a pair counts only
# if it touched in the last step, or if no part of the body was across the line before the last motion. The line is
# extended horizontally beyond both ends, so that bodies may also pass from the side. For tiles see tiles.py.


@subkernel
def line_separation(line, hull):
    """Return the separation [px] of a Hull from a line segment; negative if the Hull overlaps the segment.

    line (16, 4): its first two rows are the ends of the segment. `line` and the Hull need edge normals, see
    hulls.write_normals.
    """
    corners = hull.corners
    count = hull.count
    if count > 1:
        _, _, own = find_max_separation(line, 2, ALL_EDGES, corners, count)
        _, _, other = find_max_separation(corners, count, ALL_EDGES, line, 2)
        if max(own, other) < 0.0:
            return max(own, other) - hull.radius
    gap = math.inf
    for k in range(count):
        x = corners[k, 0]
        y = corners[k, 1]
        gap = min(gap, distance_to_edge(line[0, 0], line[0, 1], line[1, 0], line[1, 1], x, y))
        if count > 1:
            after = k + 1 if k + 1 < count else 0
            for end in range(2):
                gap = min(gap, distance_to_edge(x, y, corners[after, 0], corners[after, 1], line[end, 0], line[end, 1]))
    return gap - hull.radius


@subkernel
def lies_across(geometry, chain, x, y, angle, hull, most, line_out):
    """Return whether a Hull overlaps a chain by more than `most` [px].

    The chain is extended horizontally at both ends. The Hull needs edge normals, see hulls.write_normals. chain: row
    number in geometry.chains; x, y [px], angle [rad]: pose of the chain's body; line_out (16, 4): scratch. O(links near
    the Hull).
    """
    span = geometry.chains[chain]
    cosine, sine = math.cos(angle), math.sin(angle)
    min_x, min_y = math.inf, math.inf
    max_x, max_y = -math.inf, -math.inf
    for k in range(hull.count):
        u, v = rotate(hull.corners[k, 0] - x, hull.corners[k, 1] - y, cosine, -sine)
        min_x, min_y = min(min_x, u - hull.radius), min(min_y, v - hull.radius)
        max_x, max_y = max(max_x, u + hull.radius), max(max_y, v + hull.radius)
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, min_x, min_y, max_x, max_y):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            link = geometry.links[k]
            if not misses_box(link.ax, link.ay, link.bx, link.by, min_x, min_y, max_x, max_y):
                link_at(geometry.links, k, x, y, cosine, sine, line_out)
                write_normals(2, line_out)
                if line_separation(line_out, hull) < -most:
                    return True
    for end in range(2):
        link = geometry.links[span.offset if end == 0 else span.offset + span.count - 1]
        u = link.ax if end == 0 else link.bx
        v = link.ay if end == 0 else link.by
        beyond = min_x - (max_x - min_x) if end == 0 else max_x + (max_x - min_x)
        if (beyond < u) == (end == 0) and min_y <= v <= max_y:
            for k in range(2):
                du, dv = rotate(u if k == 0 else beyond, v, cosine, sine)
                line_out[k, 0] = x + du
                line_out[k, 1] = y + dv
            write_normals(2, line_out)
            if line_separation(line_out, hull) < -most:
                return True
    return False


@subkernel
def was_across(batch, surface, other, most, workspace):
    """Return whether, at the poses before the step, a shape overlapped a one-way surface by more than `most` [px].

    surface: row number in SHAPE of the surface, a chain; other: row number in SHAPE of the other shape; batch: input of
    the pass, a manifold.Batch; workspace: scratch memory.
    """
    s, o = batch.shapes[surface], batch.shapes[other]
    p, q = batch.bodies[s.body_row], batch.bodies[o.body_row]
    corners = workspace.b
    radius = 0.0
    if o.kind == BOUNDS:
        count = aabb_corners(o, corners)
        move_corners(count, q.previous_x - q.x, q.previous_y - q.y, corners)
    else:
        count = hull_at(batch.geometry, batch.shapes, other, q.previous_x, q.previous_y, q.previous_angle, corners)
        radius = rounding(batch.shapes, other)
    write_normals(count, corners)
    hull = Hull(corners, count, radius, ALL_EDGES)
    return lies_across(
        batch.geometry, s.geometry, p.previous_x, p.previous_y, p.previous_angle, hull, most, workspace.a
    )


@kernel
def admit_to_surfaces(batch, known, workspace, kinds_inout, counts_inout):
    """Change the kind of each SURFACE_ANY pair: to CHAIN_ANY if its shapes may collide, else to NOTHING.

    A SURFACE_ANY pair is a one-way surface and another shape. Its shapes may collide if they touched in the last step,
    or if the other shape did not overlap the surface at the previous poses. known: whether workspace.memory holds the
    contacts of the last step; kinds_inout (candidates,): kind of each pair; counts_inout: number of pairs of each kind.
    O(candidates + nearby links). batch: input of the pass, a manifold.Batch.
    """
    for i in range(batch.count):
        if kinds_inout[i] != SURFACE_ANY:
            continue
        kind = CHAIN_ANY
        if not (known and workspace.memory[i, 1] > 0):
            _, surface, other = sides_by_kind(batch, i, CHAIN)
            if was_across(batch, surface, other, batch.margin, workspace):
                kind = NOTHING
        kinds_inout[i] = kind
        counts_inout[SURFACE_ANY] -= 1
        counts_inout[kind] += 1
