"""Removal of ghost collisions: drops contacts at the seam between two flush pieces of ground."""

import math
from typing import NamedTuple

import numpy as np

from physics.collision.chains import link_at, misses_box
from physics.collision.hulls import (
    ALL_EDGES,
    CIRCLE_CORNER,
    CORNERS,
    PART,
    Hull,
    distance_to_edge,
    extent_along,
    part_feature,
    part_of,
)
from physics.collision.manifold import NOTHING, drop_empty, hull_of
from physics.collision.tiles import run_at, tile_at
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate, rotation_of
from physics.tables.body import DYNAMIC
from physics.tables.geometry import BLOCK_LINKS, EMPTY, SLOPE
from physics.tables.shape import CHAIN, CIRCLE, MASK, TILES

# ---- seams -----------------------------------------------------------------------------------------------------------
# Contacts of a dynamic body with several pieces of ground: runs of tiles, links, static boxes, segments, parts.
#
#            body            a face contact with piece A supports the body: normal up, plane along the surface
#        ____________
#     -------+-------        piece B is no higher than that plane near the body: its side and its corner are inside
#        A   |   B           the ground, and a contact with them is a ghost collision
#
# The plane of a face contact separates the body from A. If it also separates the body from another piece, up to the
# tolerance for passing bodies, the other piece can push only along the plane's normal. Any other contact with this
# piece is dropped if the contact lies ahead of the body, or if its points lie on another piece of ground. A piece that
# stands higher than the tolerance keeps its contacts, and so does a corner next to a gap.
#
# Whether a corner is exposed depends on the neighbouring pieces, so it cannot be determined from a single pair. Source:
# Catto, Ghost Collisions, box2d.org, 2020, where a chain's neighbours are known; here they are found among the
# candidates.

PARALLEL = 0.996  # least cosine between the normals of two faces that may support a body together (5 degrees)
SAME_NORMAL = 1.0 - 1e-12  # least cosine between normals that count as equal
WIDE = 4.0  # a face contact wider than this multiple of the tolerance (batch.graze) is not at a seam
NONE = -1


class BodyLists(NamedTuple):
    """A linked list of row numbers for each body. The caller decides which table the row numbers belong to."""

    heads: np.ndarray  # (bodies,) int64 first row number of each body, or NONE
    links: np.ndarray  # int64: the row number that follows each row number in its list, or NONE


@subkernel
def ground_side(bodies, shapes, manifold):
    """Return which side of a CONTACT row is ground touched by a dynamic body: 0 for A, 1 for B, or NONE.

    NONE: both bodies are dynamic, or neither is, or one of the shapes is a mask. manifold: CONTACT row.
    """
    m = manifold
    a_moves = bodies[m.body_row_a].kind == DYNAMIC
    if a_moves == (bodies[m.body_row_b].kind == DYNAMIC):
        return NONE
    if shapes[m.row_a].kind == MASK or shapes[m.row_b].kind == MASK:
        return NONE
    return 1 if a_moves else 0


@subkernel
def is_at_corner(shapes, manifold):
    """Return whether a contact is between two corners, or between a corner and a disc.

    The normal of such a contact is not a face normal. manifold: CONTACT row.
    """
    part = manifold.feature_1 % PART
    disc = shapes[manifold.row_a].kind == CIRCLE or shapes[manifold.row_b].kind == CIRCLE
    return part >= (CIRCLE_CORNER if disc else CORNERS)


@subkernel
def piece_at(batch, row, feature, corners_out):
    """Return the Hull of the piece of ground that a feature id names: a run of tiles, a link, or the whole shape.

    row: row number in SHAPE; corners_out (16, 2) receives the corners [px]; batch: input of the pass, a manifold.Batch.
    """
    geometry = batch.geometry
    s = batch.shapes[row]
    p = batch.bodies[s.body_row]
    part = part_of(feature)
    if s.kind == TILES:
        g = geometry.grids[s.geometry]
        tile_row = part // g.columns
        column = part % g.columns
        if geometry.cells[g.offset + part].kind == SLOPE:
            corners, _ = tile_at(geometry, s.geometry, p.x, p.y, tile_row, column, corners_out)
        else:
            corners, _ = run_at(geometry, s.geometry, p.x, p.y, tile_row, column, (column, column), corners_out)
        return Hull(corners_out, corners, 0.0, ALL_EDGES)
    if s.kind == CHAIN:
        cosine, sine = rotation_of(p.angle)
        link_at(geometry.links, geometry.chains[s.geometry].offset + part, p.x, p.y, cosine, sine, corners_out)
        return Hull(corners_out, 2, 0.0, ALL_EDGES)
    return hull_of(geometry, batch.bodies, batch.shapes, row, corners_out)


@subkernel
def may_be_seam(batch, side, manifold, corners_out):
    """Return whether a contact with ground may be at a seam: it is near an end of its piece of ground (see piece_at).

    The result is also True if a point of the contact does not touch yet. The result is False for a contact over a wide
    face, and for a contact between a disc and a face. side: 0 if A is the ground, 1 if B is; manifold: CONTACT row;
    corners_out (16, 2): scratch; batch: input of the pass, a manifold.Batch.
    """
    m = manifold
    row = m.row_a if side == 0 else m.row_b
    if batch.shapes[row].kind == CIRCLE or batch.shapes[m.row_b if side == 0 else m.row_a].kind == CIRCLE:
        return is_at_corner(batch.shapes, m)
    near = WIDE * batch.graze
    if max(m.separation_1, m.separation_2 if m.count == 2 else m.separation_1) > batch.graze:
        return True
    if m.count == 2 and norm(m.x_2 - m.x_1, m.y_2 - m.y_1) > near:
        return False
    piece = piece_at(batch, row, m.feature_1, corners_out)
    for k in range(piece.count):
        if norm(piece.corners[k, 0] - m.x_1, piece.corners[k, 1] - m.y_1) <= near + piece.radius:
            return True
    return False


@subkernel
def highest_within(hull, nx, ny, low, high):
    """Return the greatest coordinate [px] along (nx, ny) of the part of a Hull inside a strip; -inf if none is inside.

    The strip consists of the points whose coordinate along (-ny, nx) is in low..high [px].
    """
    corners = hull.corners
    low -= hull.radius
    high += hull.radius
    best = -math.inf
    for k in range(hull.count):
        n = k + 1 if k + 1 < hull.count else 0
        start = nx * corners[k, 1] - ny * corners[k, 0]
        end = nx * corners[n, 1] - ny * corners[n, 0]
        from_height = nx * corners[k, 0] + ny * corners[k, 1]
        rise = nx * corners[n, 0] + ny * corners[n, 1] - from_height
        if max(start, end) < low or min(start, end) > high:
            continue
        best = max(best, from_height) if low <= start <= high else best
        span = end - start
        for side in range(2):
            bound = low if side == 0 else high
            if span != 0.0 and min(start, end) <= bound <= max(start, end):
                best = max(best, from_height + (bound - start) / span * rise)
    return best + hull.radius


@subkernel
def distance_to_hull(hull, x, y):
    """Return the distance [px] of the point (x, y) from a Hull; 0 inside."""
    corners = hull.corners
    if hull.count == 1:
        return max(0.0, norm(x - corners[0, 0], y - corners[0, 1]) - hull.radius)
    least = math.inf
    inside = hull.count > 2
    for k in range(hull.count):
        n = k + 1 if k + 1 < hull.count else 0
        ax = corners[k, 0]
        ay = corners[k, 1]
        bx = corners[n, 0]
        by = corners[n, 1]
        least = min(least, distance_to_edge(ax, ay, bx, by, x, y))
        inside = inside and (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0
    return 0.0 if inside else max(0.0, least - hull.radius)


@subkernel
def is_behind_plane(batch, seam, support, workspace):
    """Return whether a piece of ground is behind the contact plane of another piece, at least near the body.

    A contact with such a piece may be a ghost collision. A tolerance of batch.graze [px] is allowed. seam: CONTACT row
    of the body with the first piece; support: CONTACT row of the body with the other piece, whose plane is used;
    workspace: scratch memory.
    """
    shapes = batch.shapes
    side = ground_side(batch.bodies, shapes, seam)
    other_side = ground_side(batch.bodies, shapes, support)
    ground = seam.row_a if side == 0 else seam.row_b
    mover = seam.row_b if side == 0 else seam.row_a
    own = ground == (support.row_a if other_side == 0 else support.row_b)
    if own and part_of(seam.feature_1) == part_of(support.feature_1):
        return False
    # A disc over the joint of two pieces touches a corner of each; neither of these contacts shows the surface.
    if is_at_corner(shapes, support) and norm(seam.x_1 - support.x_1, seam.y_1 - support.y_1) <= 2.0 * batch.graze:
        return False
    sign = 1.0 if other_side == 0 else -1.0
    nx, ny = sign * support.normal_x, sign * support.normal_y
    cosine = (nx * seam.normal_x + ny * seam.normal_y) * (1.0 if side == 0 else -1.0)
    if cosine >= (SAME_NORMAL if is_at_corner(shapes, seam) else PARALLEL):
        return False
    # The surface of the supporting piece, and the depth of the body in it.
    level = nx * support.x_1 + ny * support.y_1 - 0.5 * support.separation_1
    deepest = support.separation_1
    if support.count == 2:
        level = max(level, nx * support.x_2 + ny * support.y_2 - 0.5 * support.separation_2)
        deepest = min(deepest, support.separation_2)
    hull = hull_of(batch.geometry, batch.bodies, shapes, mover, workspace.a)
    if mover != (support.row_b if other_side == 0 else support.row_a):
        lowest, _ = extent_along(hull.corners, hull.count, nx, ny)
        if lowest - hull.radius < level + min(0.0, deepest) - batch.graze:
            return False
    body = batch.bodies[shapes[mover].body_row]
    reach = hull.radius + batch.margin + batch.lookahead * norm(body.vx, body.vy)
    low, high = extent_along(hull.corners, hull.count, -ny, nx)
    piece = piece_at(batch, ground, seam.feature_1, workspace.b)
    return highest_within(piece, nx, ny, low - reach, high + reach) <= level + batch.graze


@subkernel
def is_on_piece(batch, row, x, y, own_part, workspace):
    """Return whether the point (x, y) is on a shape of the ground, or within the tolerance batch.graze [px] of it.

    row: row number in SHAPE; own_part: a part of this shape that is ignored (index of a link, or of a run's first
    cell), or NONE; workspace: scratch memory.
    """
    geometry = batch.geometry
    near = batch.graze
    s = batch.shapes[row]
    p = batch.bodies[s.body_row]
    if s.kind == TILES:
        g = geometry.grids[s.geometry]
        for k in range(4):
            column = math.floor((x - p.x + (near if k % 2 == 0 else -near)) / g.tile_size)
            tile_row = math.floor((y - p.y + (near if k < 2 else -near)) / g.tile_size)
            if column < 0 or column >= g.columns or tile_row < 0 or tile_row >= g.rows:
                continue
            cell = geometry.cells[g.offset + tile_row * g.columns + column]
            if cell.kind == EMPTY:
                continue
            part = tile_row * g.columns + (column if cell.kind == SLOPE else cell.first)
            if part != own_part:
                piece = piece_at(batch, row, part_feature(part, 0), workspace.b)
                if distance_to_hull(piece, x, y) <= near:
                    return True
        return False
    if s.kind == CHAIN:
        span = geometry.chains[s.geometry]
        cosine, sine = rotation_of(p.angle)
        u, v = rotate(x - p.x, y - p.y, cosine, -sine)
        for block in range(span.blocks):
            box = geometry.link_blocks[span.first_block + block]
            if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, u - near, v - near, u + near, v + near):
                continue
            for part in range(block * BLOCK_LINKS, min(span.count, (block + 1) * BLOCK_LINKS)):
                k = geometry.links[span.offset + part]
                if part != own_part and distance_to_edge(k.ax, k.ay, k.bx, k.by, u, v) <= near:
                    return True
        return False
    if s.kind == MASK or own_part != NONE:
        return False
    return distance_to_hull(hull_of(geometry, batch.bodies, batch.shapes, row, workspace.b), x, y) <= near


@subkernel
def is_covered(batch, seam, first, others, workspace):
    """Return whether each touching point of a contact is also on a second piece of ground.

    seam: CONTACT row of a dynamic body; first, others: linked list of this body's candidate pairs with ground. `first`
    is the index of the first pair, others[pair] the index of the next one, or NONE. batch: input of the pass, a
    manifold.Batch; workspace: scratch memory.
    """
    shapes = batch.shapes
    side = ground_side(batch.bodies, shapes, seam)
    ground = seam.row_a if side == 0 else seam.row_b
    half = 0.5 if side == 0 else -0.5
    for point in range(seam.count):
        separation = seam.separation_1 if point == 0 else seam.separation_2
        if separation > batch.graze:
            continue
        x = (seam.x_1 if point == 0 else seam.x_2) - half * separation * seam.normal_x
        y = (seam.y_1 if point == 0 else seam.y_2) - half * separation * seam.normal_y
        found = False
        pair = first
        while pair != NONE and not found:
            a = batch.candidates[pair, 0]
            b = batch.candidates[pair, 1]
            row = b if batch.bodies[shapes[a].body_row].kind == DYNAMIC else a
            if not shapes[row].sensor:
                found = is_on_piece(batch, row, x, y, part_of(seam.feature_1) if row == ground else NONE, workspace)
            pair = others[pair]
        if not found:
            return False
    return True


@subkernel
def list_ground(batch, lists_out):
    """Write a linked list of candidate pairs for each dynamic body: its pairs with ground.

    Ground means bodies that are not dynamic. lists_out: BodyLists of candidate indices. O(bodies + candidates). batch:
    input of the pass, a manifold.Batch.
    """
    for row in range(len(batch.bodies)):
        lists_out.heads[row] = NONE
    for pair in range(batch.count):
        a = batch.shapes[batch.candidates[pair, 0]].body_row
        b = batch.shapes[batch.candidates[pair, 1]].body_row
        a_moves = batch.bodies[a].kind == DYNAMIC
        if a_moves != (batch.bodies[b].kind == DYNAMIC):
            row = a if a_moves else b
            lists_out.links[pair] = lists_out.heads[row]
            lists_out.heads[row] = pair


@kernel
def has_seams(batch, manifolds, count, workspace):
    """Return whether at least one of the first `count` CONTACT rows may be at a seam, see may_be_seam. O(contacts)."""
    for i in range(count):
        side = ground_side(batch.bodies, batch.shapes, manifolds[i])
        if side != NONE and may_be_seam(batch, side, manifolds[i], workspace.a):
            return True
    return False


@subkernel
def is_recycled(batch, contact):
    """Return whether a contact of the last step is reused because its candidate pair is not tested in this step.

    contact: CONTACT row of the last step.
    """
    pair = contact.candidate
    if pair < 0 or pair >= batch.count or batch.kinds[pair] != NOTHING:
        return False
    a = batch.candidates[pair, 0]
    b = batch.candidates[pair, 1]
    if contact.row_a != a or contact.row_b != b:
        return False
    return batch.shapes[a].id == contact.shape_a and batch.shapes[b].id == contact.shape_b


@subkernel
def link_contact(batch, contact, place, lists_inout):
    """Add a contact to the linked list of its dynamic body, if the other body is ground.

    contact: CONTACT row; place: the number to store for it in the list; lists_inout: BodyLists; batch: input of the
    pass, a manifold.Batch.
    """
    side = ground_side(batch.bodies, batch.shapes, contact)
    if side != NONE:
        row = contact.body_row_b if side == 0 else contact.body_row_a
        lists_inout.links[place] = lists_inout.heads[row]
        lists_inout.heads[row] = place


@kernel
def drop_seams(batch, previous, count, workspace, contacts_out, ground_out, manifolds_inout):
    """Drop the contacts of dynamic bodies at seams between pieces of ground. Return the number of remaining contacts.

    manifolds_inout: CONTACT rows, of which the first `count` are in use; the remaining ones keep their order. previous:
    CONTACT rows of the last step. Rows of `previous` that are recycled (see is_recycled) also count as support of the
    body. contacts_out, ground_out: scratch, BodyLists for contacts and candidates. O(contacts · contacts of a body).
    batch: input of the pass, a manifold.Batch; workspace: scratch memory.
    """
    bodies = batch.bodies
    shapes = batch.shapes
    for row in range(len(bodies)):
        contacts_out.heads[row] = NONE
    for i in range(count):
        link_contact(batch, manifolds_inout[i], i, contacts_out)
    for i in range(len(previous)):
        if is_recycled(batch, previous[i]):
            link_contact(batch, previous[i], count + i, contacts_out)
    listed = False
    for i in range(count):
        m = manifolds_inout[i]
        side = ground_side(bodies, shapes, m)
        if side != NONE and may_be_seam(batch, side, m, workspace.a):
            head = contacts_out.heads[m.body_row_b if side == 0 else m.body_row_a]
            ahead = (min(m.separation_1, m.separation_2) if m.count == 2 else m.separation_1) > batch.graze
            behind = False
            j = head
            while j != NONE and not behind:
                if j >= count:
                    behind = is_behind_plane(batch, m, previous[j - count], workspace)
                elif j != i and manifolds_inout[j].count > 0:
                    behind = is_behind_plane(batch, m, manifolds_inout[j], workspace)
                j = contacts_out.links[j]
            body = m.body_row_b if side == 0 else m.body_row_a
            if behind and not ahead and not listed:
                list_ground(batch, ground_out)
                listed = True
            if behind and (ahead or is_covered(batch, m, ground_out.heads[body], ground_out.links, workspace)):
                m.count = 0
    return drop_empty(count, manifolds_inout)
