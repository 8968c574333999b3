"""Collision of circles, capsules and polygons: the tests of their candidate pairs, with speculative contacts."""

import math
from typing import NamedTuple

from physics.collision.hulls import (
    ALL_EDGES,
    CIRCLE_CORNER,
    CORNERS,
    COVERED,
    COVERED_OVERLAP,
    Hull,
    collide_aabbs,
    collide_hull_circle,
    collide_hulls,
    extent_along,
    find_max_separation,
    move_corners,
    path_misses,
    pushing_edges,
    write_normals,
)
from physics.collision.manifold import (
    AABBS,
    CIRCLES,
    POLYGON_CIRCLE,
    POLYGONS,
    add_manifold,
    add_point,
    add_points,
    boxes_apart,
    center_velocity,
    circle_at,
    closing_speed_bound,
    hull_in,
    hulls_in,
    make_pass,
    queue_fallback,
    relative_velocity,
    sides_by_kind,
)
from physics.jit import inlined, subkernel
from physics.math2d import norm, unit
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import CIRCLE

# ---- speculative contacts --------------------------------------------------------------------------------------------
# Pairs that meet within the step are evaluated at the predicted contact and not at the start pose.
#
# B is moved relative to A, in a straight line, to the pose of contact or of least distance. The manifold is computed at
# this pose; its separation is the distance that B still has to move along the normal. Without this, a pair that closes
# by more than the margin in a step would first be detected as overlapping, and be pushed back along its path. The
# margin is Box2D's b2_speculativeDistance (Catto). The search is conservative advancement (Mirtich, Impulse-based
# Dynamic Simulation, 1996).

MAX_ADVANCES = 16  # most iterations for one pair; a pair that needs more is found in a later step
NEVER = -1.0  # in place of a time: the shapes do not meet


@subkernel
def needs_ccd(body, distance):
    """Return whether a body that moves by `distance` [px] in a step needs continuous collision detection.

    This is the case for a body that is not static if `distance` exceeds its inradius. Such a body gets no speculative
    contacts. body: BODY row.
    """
    return body.kind != STATIC and distance > body.inradius


@subkernel
def speculative_distance(a, b, speed, margin, lookahead):
    """Return the largest gap [px] at which two bodies get a speculative contact.

    If a body needs continuous collision detection, the result is `margin` [px]. Otherwise it is `lookahead` [s] times
    the greatest of three speeds, but at least `margin`. The speeds are `speed` and the speeds of A and B, because other
    contacts may stop one of the bodies. a, b: BODY rows; speed [px/s]: speed of B relative to A.
    """
    distance = lookahead * max(speed, norm(a.vx, a.vy), norm(b.vx, b.vy))
    return margin if needs_ccd(a, distance) or needs_ccd(b, distance) else max(margin, distance)


@subkernel
def turning_speed(a, b):
    """Return an upper bound [px/s] of the speed at which rotation closes a gap between two bodies. a, b: BODY rows."""
    return abs(a.angular_velocity) * a.extent + abs(b.angular_velocity) * b.extent


@subkernel
def speculative_rotation(a, b, speed, margin, lookahead):
    """Return the largest gap [px] that the rotation of two bodies may close in `lookahead` [s]; at least the margin.

    The distance closed by rotation is limited to half the extent of the smaller body. If a body needs continuous
    collision detection, the result is `margin` [px]. a, b: BODY rows; speed [px/s]: speed of B relative to A.
    """
    distance = lookahead * speed
    if needs_ccd(a, distance) or needs_ccd(b, distance):
        return margin
    turn = lookahead * turning_speed(a, b)
    return max(margin, min(turn, 0.5 * min(a.extent, b.extent)))


@subkernel
def collide_circles(ax, ay, a_radius, bx, by, b_radius):
    """Return the contact (nx, ny, x, y, separation) of two discs; lengths in px.

    nx, ny: unit normal from A to B, (1, 0) for discs with equal centres; x, y: contact point, midway between the
    surfaces. ax, ay, a_radius, bx, by, b_radius: centres and radii.
    """
    dx, dy = bx - ax, by - ay
    nx, ny = unit(dx, dy, 1.0, 0.0)
    distance = norm(dx, dy)
    separation = distance - (a_radius + b_radius)
    along = 0.5 * (a_radius + (distance - b_radius))
    return nx, ny, ax + along * nx, ay + along * ny, separation


@subkernel
def toi_circles(dx, dy, radii, vx, vy):
    """Return the time [s] until two moving discs touch; NEVER if they do not meet.

    dx, dy [px]: vector from the centre of the first disc to the centre of the second; radii [px]: sum of both radii;
    vx, vy [px/s]: velocity of the second disc relative to the first.
    """
    along = dx * vx + dy * vy
    square = vx * vx + vy * vy
    rest = dx * dx + dy * dy - radii * radii
    root = along * along - square * rest
    if along >= 0.0 or root < 0.0 or square == 0.0:
        return NEVER
    # This form of the root avoids cancellation.
    return rest / (-along + math.sqrt(root))


@subkernel
def time_of_closest_approach(dx, dy, vx, vy):
    """Return the time [s] of closest approach of two points; 0 without relative motion.

    dx, dy [px]: vector from the first point to the second; vx, vy [px/s]: velocity of the second point relative to the
    first.
    """
    square = vx * vx + vy * vy
    return -(dx * vx + dy * vy) / square if square > 0.0 else 0.0


@subkernel
def toi_hulls(a, vx, vy, target, most, b_inout):
    """Return the time [s] at which the gap between two Hulls has shrunk to `target` [px] (conservative advancement).

    Hull B (b_inout) moves at vx, vy [px/s] relative to Hull A. The corners of B are moved to their positions at the
    returned time. If the gap stops shrinking before it reaches the target, the time of least distance is returned. If
    the target is not reached within `most` [s], or within MAX_ADVANCES iterations, NEVER is returned. Both Hulls need
    edge normals (hulls.write_normals). O(corners²) an iteration.
    """
    time = 0.0
    corners = b_inout.corners
    for _ in range(MAX_ADVANCES):
        a_edge, _, of_a = find_max_separation(a.corners, a.count, ALL_EDGES, corners, b_inout.count)
        b_edge, _, of_b = find_max_separation(corners, b_inout.count, ALL_EDGES, a.corners, a.count)
        gap = max(of_a, of_b) - (a.radius + b_inout.radius)
        if gap <= target:
            return time
        if of_a >= of_b:
            nx, ny = a.corners[a_edge, 2], a.corners[a_edge, 3]
        else:
            nx, ny = -corners[b_edge, 2], -corners[b_edge, 3]
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time  # least distance: a deflection must not drive the bodies into each other
        if gap - target > speed * (most - time):
            return NEVER
        # Half the target gap is left, so that rounding cannot miss the target.
        span = (gap - 0.5 * target) / speed
        move_corners(b_inout.count, span * vx, span * vy, corners)
        write_normals(b_inout.count, corners)
        time += span
    return NEVER


@subkernel
def copy_corners(hull, corners_out):
    """Copy the corners and normals of a Hull to corners_out (16, 4)."""
    for k in range(hull.count):
        for column in range(4):
            corners_out[k, column] = hull.corners[k, column]


@subkernel
def advance_to_contact(margin, lookahead, p, q, a, b, corners_out):
    """Write the corners and normals of Hull B at its predicted contact with Hull A. Return (time, vx, vy, reach).

    time [s]: time until the contact, or NEVER; 0 if the pair is too slow for a prediction, and then corners_out (16, 4)
    is not valid. vx, vy [px/s]: velocity of B relative to A. reach [px]: largest separation of a contact point after
    the move; more than `margin` if rotation may close a wider gap. a, b: the Hulls; p, q: BODY rows of A and B; margin
    [px]: gap at the predicted contact; lookahead [s]: contacts are predicted up to this time.
    """
    if lookahead * closing_speed_bound(p, q) <= margin and lookahead * turning_speed(p, q) <= margin:
        return 0.0, 0.0, 0.0, margin
    vx, vy, speed = center_velocity(p, q)
    far = speculative_distance(p, q, speed, margin, lookahead)
    reach = max(far, speculative_rotation(p, q, speed, margin, lookahead))
    if far <= margin or lookahead * speed <= margin:
        return 0.0, 0.0, 0.0, reach
    copy_corners(b, corners_out)
    moved = Hull(corners_out, b.count, b.radius, b.edges)
    return toi_hulls(a, vx, vy, margin, lookahead, moved), vx, vy, reach


@subkernel
def toi_hull_circle(hull, x, y, radius, vx, vy, target, most):
    """Return the time [s] at which the gap between a Hull and a moving disc has shrunk to `target` [px].

    x, y, radius [px]: centre and radius of the disc; vx, vy [px/s]: its velocity relative to the Hull. If the gap stops
    shrinking before it reaches the target, the time of least distance is returned. If the target is not reached within
    `most` [s], or within MAX_ADVANCES iterations, NEVER is returned. O(corners) an iteration.
    """
    whole = Hull(hull.corners, hull.count, hull.radius, ALL_EDGES)
    time = 0.0
    for _ in range(MAX_ADVANCES):
        hit, nx, ny, _, _, gap, _ = collide_hull_circle(whole, x + time * vx, y + time * vy, radius)
        if not hit or gap <= target:
            return time
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time
        if gap - target > speed * (most - time):
            return NEVER
        time += (gap - 0.5 * target) / speed
    return NEVER


@subkernel
def path_offsets(time, vx, vy, nx, ny):
    """Return the motion of B in `time` [s] as (distance against the normal, distance along the tangent) [px].

    The first distance is positive if B approaches A. vx, vy [px/s]: velocity of B relative to A; nx, ny: unit normal
    from A to B; the tangent is (-ny, nx).
    """
    return -time * (vx * nx + vy * ny), time * (vy * nx - vx * ny)


@subkernel
def move_manifold_back(time, vx, vy, points_inout):
    """Transform a manifold from B's position at the predicted contact to B's present position.

    Return the distance [px] that B moves along the tangent (-ny, nx) until the contact. time [s]: time until the
    contact; vx, vy [px/s]: velocity of B until the contact; points_inout (11,): the manifold, format in
    hulls.clip_edges.
    """
    nx, ny = points_inout[1], points_inout[2]
    closed, tangential = path_offsets(time, vx, vy, nx, ny)
    for k in range(int(points_inout[0])):
        at = 3 + 4 * k
        # The point is midway between the two surfaces at their present positions.
        points_inout[at] += 0.5 * closed * nx
        points_inout[at + 1] += 0.5 * closed * ny
        points_inout[at + 2] += closed
    return tangential


class Travel(NamedTuple):
    """Motion of a shape relative to a tile grid or chain within a step; the same for all runs of tiles and links."""

    vx: float  # [px/s]
    vy: float
    reach: float  # [px] largest separation of a contact point
    time: float  # [s] contacts within this time are predicted; 0: no prediction, only gaps within the margin count


class Meeting(NamedTuple):
    """Predicted contact of a hull with a piece of ground: a run of tiles, or a link of a chain."""

    piece: Hull
    travel: Travel
    time: float  # [s] until hull and piece meet
    sign: float  # 1.0 if the ground is A, else -1.0
    part: int  # offset of the piece's feature ids, see hulls.part_feature


@inlined
def travel_of(batch, ground, body):
    """Return the Travel of a body relative to the ground. ground, body: BODY rows.

    Slow bodies, and fast bodies that need continuous collision detection, get no prediction: their Travel has reach =
    margin and time = 0. batch: input of the pass, a manifold.Batch.
    """
    if batch.lookahead == 0.0:
        return Travel(0.0, 0.0, batch.margin, 0.0)
    vx, vy, speed = center_velocity(ground, body)
    reach = speculative_distance(ground, body, speed, batch.margin, batch.lookahead)
    far = reach > batch.margin and batch.lookahead * speed > batch.margin
    return Travel(vx, vy, reach if far else batch.margin, batch.lookahead if far else 0.0)


@subkernel
def advance_to_piece(travel, margin, piece, hull, corners_out):
    """Write the corners [px] of a Hull at its predicted contact with a piece of ground to corners_out (16, 4).

    Return the time [s] until this contact, or NEVER. If travel.time is 0, there is no prediction: the Hull is not
    moved, and 0 is returned. travel: motion of the Hull; margin [px]: gap at the predicted contact; piece: Hull of a
    run of tiles or of a link; corners_out: receives edge normals too.
    """
    copy_corners(hull, corners_out)
    if travel.time == 0.0:
        return 0.0
    return toi_hulls(
        piece, travel.vx, travel.vy, margin, travel.time, Hull(corners_out, hull.count, hull.radius, ALL_EDGES)
    )


@subkernel
def move_piece_manifold_back(time, travel, sign, points_inout):
    """Transform a manifold of ground and a hull from the hull's predicted position to its present position.

    Return the distance [px] that the hull moves along the tangent until the contact. time [s]: time until the contact;
    travel: motion of the hull; sign: 1.0 if the ground is A, else -1.0; points_inout (11,): the manifold, format in
    hulls.clip_edges.
    """
    tangential = move_manifold_back(time, travel.vx, travel.vy, points_inout)
    if sign < 0.0:
        # The hull is A: move the points to its present position.
        for k in range(int(points_inout[0])):
            points_inout[3 + 4 * k] += tangential * points_inout[2]
            points_inout[4 + 4 * k] -= tangential * points_inout[1]
    return tangential


@subkernel
def piece_misses_circle(meeting, graze, disc, separation, feature, corners_out):
    """Return whether to reject a predicted contact of a disc with a corner, because the disc's path misses the piece.

    meeting: the predicted contact; graze [px]: a contact with at most this separation is never rejected; disc: (x, y,
    radius) at the predicted contact; separation [px], feature: values of this contact; corners_out (16, 4): scratch.
    """
    travel = meeting.travel
    if travel.time == 0.0 or separation <= graze or feature < CIRCLE_CORNER:
        return False
    corners_out[0, 0], corners_out[0, 1], radius = disc
    return path_misses(meeting.piece, Hull(corners_out, 1, radius, ALL_EDGES), 0.0, travel.vx, travel.vy)


# ---- hull pairs ------------------------------------------------------------------------------------------------------
# Pairs of circles and other hulls.


@subkernel
def set_tangential_offset(before, found, offset, manifolds_out):
    """Write the tangential offset [px] of the last appended contact, if a contact was appended.

    before, found: number of contacts before and after the append; found may exceed the capacity of manifolds_out.
    """
    if before < found <= len(manifolds_out):
        manifolds_out[before].tangential_offset = offset


@inlined
def time_to_piece(travel, margin, piece, x, y, radius):
    """Return the time [s] until a disc meets a piece of ground, or NEVER.

    If travel.time is 0, there is no prediction, and 0 is returned. travel: motion of the disc; margin [px]: gap at the
    meeting; piece: Hull of a run of tiles or of a link; x, y, radius [px]: centre and radius of the disc.
    """
    if travel.time == 0.0:
        return 0.0
    return toi_hull_circle(piece, x, y, radius, travel.vx, travel.vy, margin, travel.time)


@inlined
def add_circle_on_piece(batch, pair, meeting, disc, contact, workspace, manifolds_out, found):
    """Append the contact of a disc with a piece of ground: a run of tiles or a link of a chain.

    Return the new number of contacts. meeting: the predicted contact; disc: (x, y, radius) at this contact; contact:
    the tuple returned by hulls.collide_hull_circle or chains.collide_link_circle for the disc at this position. pair,
    manifolds_out, found: as in manifold.add_manifold. batch: input of the pass, a manifold.Batch; workspace: scratch
    memory.
    """
    travel, sign = meeting.travel, meeting.sign
    hit, nx, ny, x, y, separation, feature = contact
    if not hit or separation > travel.reach:
        return found
    if piece_misses_circle(meeting, batch.graze, disc, separation, feature, workspace.c):
        return found
    closed, tangential = path_offsets(meeting.time, travel.vx, travel.vy, nx, ny)
    x += 0.5 * closed * nx + (tangential * ny if sign < 0.0 else 0.0)
    y += 0.5 * closed * ny - (tangential * nx if sign < 0.0 else 0.0)
    point = (sign * nx, sign * ny, x, y, separation + closed, 0.0, meeting.part + feature)
    before = found
    found = add_point(batch.shapes, batch.candidates, pair, point, manifolds_out, found)
    set_tangential_offset(before, found, tangential, manifolds_out)
    return found


@inlined
def add_points_on_piece(batch, pair, meeting, workspace, manifolds_out, found):
    """Append the manifold of a hull and a piece of ground: a run of tiles or a link of a chain.

    Return the new number of contacts. The manifold is in workspace.points. It was computed at the predicted contact
    `meeting`, and is converted to the hull's present position. pair, manifolds_out, found: as in manifold.add_manifold.
    batch: input of the pass, a manifold.Batch.
    """
    sign = meeting.sign
    tangential = 0.0
    if meeting.time > 0.0:
        tangential = move_piece_manifold_back(meeting.time, meeting.travel, sign, workspace.points)
    before = found
    found = add_points(batch.shapes, batch.candidates, pair, sign, workspace.points, meeting.part, manifolds_out, found)
    set_tangential_offset(before, found, tangential, manifolds_out)
    return found


@inlined
def collide_circle_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contact of candidate number `pair`, two circles. Return the new number of contacts.

    Arguments: see manifold.make_pass.
    """
    bodies, shapes = batch.bodies, batch.shapes
    row_a = batch.candidates[pair, 0]
    row_b = batch.candidates[pair, 1]
    ax, ay, a_radius = circle_at(bodies, shapes, row_a)
    bx, by, b_radius = circle_at(bodies, shapes, row_b)
    nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx, by, b_radius)
    tangential = 0.0
    if separation > 0.0:
        p, q = bodies[shapes[row_a].body_row], bodies[shapes[row_b].body_row]
        if separation > batch.margin:
            _, _, speed = center_velocity(p, q)
            if separation > speculative_distance(p, q, speed, batch.margin, batch.lookahead):
                return found
        vx, vy = relative_velocity(p, q, ax, ay, bx, by)
        time = toi_circles(bx - ax, by - ay, a_radius + b_radius, vx, vy)
        if time < 0.0:
            # Least distance: a deflection must not drive the bodies into each other.
            time = time_of_closest_approach(bx - ax, by - ay, vx, vy)
        # Pairs that touch in the next step are included, because their present normal would deflect them in this step.
        if 0.0 < time <= 2.0 * batch.lookahead:
            nx, ny, x, y, separation = collide_circles(ax, ay, a_radius, bx + time * vx, by + time * vy, b_radius)
            closed, tangential = path_offsets(time, vx, vy, nx, ny)
            x += 0.5 * closed * nx
            y += 0.5 * closed * ny
            separation += closed
    before = found
    point = (nx, ny, x, y, separation, 0.0, 0)
    found = add_manifold(shapes, batch.candidates, pair, point, manifolds_out, found)
    set_tangential_offset(before, found, tangential, manifolds_out)
    return found


@inlined
def collide_polygon_circle_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contact of candidate number `pair`, a circle and a hull of two or more corners.

    Return the new number of contacts. Arguments: see manifold.make_pass.
    """
    bodies, shapes, margin = batch.bodies, batch.shapes, batch.margin
    side, circle, polygon = sides_by_kind(batch, pair, CIRCLE)
    p, q = bodies[shapes[polygon].body_row], bodies[shapes[circle].body_row]
    hull = hull_in(batch, polygon, workspace)
    x, y, radius = circle_at(bodies, shapes, circle)
    time = 0.0
    vx, vy = 0.0, 0.0
    reach = margin
    if batch.lookahead > 0.0:
        _, _, speed = center_velocity(p, q)
        reach = speculative_distance(p, q, speed, margin, batch.lookahead)
        if reach > margin and batch.lookahead * speed > margin:
            vx, vy = relative_velocity(p, q, x, y, x, y)
            time = toi_hull_circle(hull, x, y, radius, vx, vy, margin, batch.lookahead)
            if time < 0.0:
                return found
    hit, nx, ny, px, py, separation, feature = collide_hull_circle(hull, x + time * vx, y + time * vy, radius)
    if not hit and feature == COVERED:
        queue_fallback(pair, workspace.fallback)
    if not hit or separation > reach:
        return found
    if separation > batch.graze and feature >= CIRCLE_CORNER:
        wx, wy = relative_velocity(p, q, px, py, x, y)
        workspace.b[0, 0] = x
        workspace.b[0, 1] = y
        if path_misses(hull, Hull(workspace.b, 1, radius, ALL_EDGES), 0.0, wx, wy):
            return found
    closed, tangential = path_offsets(time, vx, vy, nx, ny)
    # The point is midway between the present surfaces, measured from the polygon.
    px += 0.5 * closed * nx
    py += 0.5 * closed * ny
    if side > 0.0:
        # A is the disc: move the point to the polygon's present position.
        px += tangential * ny
        py -= tangential * nx
    before = found
    point = (-side * nx, -side * ny, px, py, separation + closed, 0.0, feature)
    found = add_manifold(shapes, batch.candidates, pair, point, manifolds_out, found)
    set_tangential_offset(before, found, tangential, manifolds_out)
    return found


@subkernel
def overlaps_narrowly(a, b, most, far, manifold):
    """Return whether two Hulls have a narrow contact face, which is at most `most` [px] wide.

    The width is that of the overlap of their extents along the face. If `far` is True, the Hulls move far relative to
    each other in this step. Then the face is also narrow if its two contact points are at most `most` apart. This is
    not enough for slow Hulls, because two points close together may support a body, as on the edge of a card. manifold
    (11,): format in hulls.clip_edges.
    """
    if far and manifold[0] == 2.0 and norm(manifold[7] - manifold[3], manifold[8] - manifold[4]) <= most:
        return True
    low, high = extent_along(a.corners, a.count, -manifold[2], manifold[1])
    least, greatest = extent_along(b.corners, b.count, -manifold[2], manifold[1])
    return min(high, greatest) - max(low, least) + a.radius + b.radius <= most


@subkernel
def is_grazing(a, b, batch, p, q, manifold):
    """Return whether to drop the contact of two Hulls because they only pass each other in this step.

    Two conditions must hold. First, the path of B misses A, except for an overlap of at most batch.graze [px]. Second,
    one of three holds: the contact is between corners, its normal is mainly along the motion, or its face is no wider
    than batch.graze. Without this rule, a tile slightly higher than its neighbour would stop a sliding body. a, b: the
    Hulls; p, q: BODY rows of A and B; manifold (11,): format in hulls.clip_edges.
    """
    graze = batch.graze
    least = manifold[5] if manifold[0] == 1.0 else min(manifold[5], manifold[9])
    corners = manifold[0] == 1.0 and manifold[6] >= CORNERS
    if least <= -graze:
        return False
    vx, vy = relative_velocity(p, q, manifold[3], manifold[4], manifold[3], manifold[4])
    along = vx * manifold[1] + vy * manifold[2]
    # Only a motion along the normal passes a side; a surface on which a body slides is touched all the time.
    passes = corners or 2.0 * along * along > vx * vx + vy * vy
    far = batch.lookahead * norm(vx, vy) > graze
    passes = passes or (along < 0.0 and overlaps_narrowly(a, b, graze, far, manifold))
    return passes and path_misses(a, b, graze, vx, vy)


@subkernel
def keep_lines_apart(skin, a, b, points_inout):
    """Subtract the skin [px] from the separations of a contact of two lines, hulls of two corners without rounding.

    Two lines have no depth: as soon as one has sunk through the other by any distance, it is on its other side. With
    the skin, lines that bear a load stay on their side. a, b: the Hulls; points_inout (11,): the manifold, format in
    hulls.clip_edges.
    """
    if a.count == 2 and b.count == 2 and a.radius == 0.0 and b.radius == 0.0:
        for k in range(int(points_inout[0])):
            points_inout[5 + 4 * k] -= skin


@inlined
def collide_polygon_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contact of candidate number `pair`, two hulls of two or more corners each.

    Return the new number of contacts. Arguments: see manifold.make_pass.
    """
    bodies, shapes, candidates, margin = batch.bodies, batch.shapes, batch.candidates, batch.margin
    manifold = workspace.points
    row_a = candidates[pair, 0]
    row_b = candidates[pair, 1]
    s, o = shapes[row_a], shapes[row_b]
    p, q = bodies[s.body_row], bodies[o.body_row]
    a, b = hulls_in(batch, row_a, row_b, workspace)
    deepest = math.inf
    if s.inner != 0 or o.inner != 0:
        a_edges = a.edges & pushing_edges(a, b, True)
        b_edges = b.edges & pushing_edges(b, a, True)
        a = Hull(a.corners, a.count, a.radius, a_edges)
        b = Hull(b.corners, b.count, b.radius, b_edges)
        # Without a dynamic body there is no response, so the contact of any part is sufficient.
        deepest = margin if p.kind == DYNAMIC or q.kind == DYNAMIC else math.inf
    time, vx, vy, reach = advance_to_contact(margin, batch.lookahead, p, q, a, b, workspace.c)
    if time < 0.0:
        return found
    if time > 0.0:
        b = Hull(workspace.c, b.count, b.radius, b.edges)
    points = collide_hulls(a, b, reach, batch.bias, deepest, manifold)
    if manifold[0] == COVERED_OVERLAP:
        queue_fallback(pair, workspace.fallback)
    if points == 0 or is_grazing(a, b, batch, p, q, manifold):
        return found
    tangential = move_manifold_back(time, vx, vy, manifold) if time > 0.0 else 0.0
    keep_lines_apart(batch.skin, a, b, manifold)
    before = found
    found = add_points(shapes, candidates, pair, 1.0, manifold, 0, manifolds_out, found)
    set_tangential_offset(before, found, tangential, manifolds_out)
    return found


@inlined
def aabbs_near(batch, pair):
    """Return whether two AABBs are at most batch.margin [px] apart along each axis. pair: index of the candidate."""
    shapes, candidates = batch.shapes, batch.candidates
    return not boxes_apart(shapes[candidates[pair, 0]], shapes[candidates[pair, 1]], batch.margin)


@inlined
def collide_aabb_pair(batch, pair, workspace, manifolds_out, found, work_inout):
    """Append the contact of candidate number `pair`, two AABBs (shapes of type Bounds).

    Return the new number of contacts. Arguments: see manifold.make_pass.
    """
    shapes, candidates, manifold = batch.shapes, batch.candidates, workspace.points
    row_a = candidates[pair, 0]
    row_b = candidates[pair, 1]
    s, o = shapes[row_a], shapes[row_b]
    points = collide_aabbs(s, o, batch.margin, manifold)
    if points == 1 and manifold[5] > 0.0:
        p, q = batch.bodies[s.body_row], batch.bodies[o.body_row]
        vx, vy = relative_velocity(p, q, manifold[3], manifold[4], manifold[3], manifold[4])
        a, b = hulls_in(batch, row_a, row_b, workspace)
        if path_misses(a, b, 0.0, vx, vy):
            return found
    return add_points(shapes, candidates, pair, 1.0, manifold, 0, manifolds_out, found)


collide_aabb_pairs = make_pass(AABBS, collide_aabb_pair, aabbs_near)
collide_circle_pairs = make_pass(CIRCLES, collide_circle_pair)
collide_polygon_circle_pairs = make_pass(POLYGON_CIRCLE, collide_polygon_circle_pair)
collide_polygon_pairs = make_pass(POLYGONS, collide_polygon_pair)
