"""Chains under a character, link by link."""

import math

from physics.character.ground import BLOCKED, FREE, allowed_depth, judge
from physics.character.meet import meet_link, place_outline
from physics.collision.chain_pairs import box_in_body, misses_box
from physics.collision.chains import link_at
from physics.collision.surfaces import lies_across
from physics.jit import subkernel
from physics.tables.body import KINEMATIC
from physics.tables.geometry import BLOCK_LINKS
from physics.tables.shape import PART


@subkernel
def deepest_on(walk, body):
    """How deep [px] a character may stand in a link of a body's chain that it came to from its front."""
    most = 1.0 + 2.0 * walk.settings.slop
    if body.kind == KINEMATIC:
        most += 1.0 + (abs(body.vx) + abs(body.vy) + abs(body.angular_velocity) * body.extent) * walk.settings.dt
    return most


@subkernel
def link_depth(walk, row, link, drops, count, radius):
    """(depth [px], normal from the character) of scratch.mine in a link of a chain that holds it, else depth 0.

    A character moves by pixels and starts free, so what is deeper than that in a link came from its back, and passes;
    so does what drops through a level link, or through a surface.
    """
    b = walk.bodies[walk.shapes[row].body_row]
    scratch = walk.scratch
    link_at(walk.geometry.links, link, b.x, b.y, math.cos(b.angle), math.sin(b.angle), scratch.theirs)
    run = scratch.theirs[1, 0] - scratch.theirs[0, 0]
    rise = scratch.theirs[1, 1] - scratch.theirs[0, 1]
    if drops and (walk.shapes[row].role == PART or (run > 0.0 and abs(rise) <= 1e-9 * run)):
        return 0.0, 0.0, 0.0
    depth, nx, ny, x, y = meet_link(walk.geometry.links, link, scratch, count, radius)
    return depth if depth <= deepest_on(walk, b) else 0.0, nx, ny


@subkernel
def is_across(walk, me, row, left, top):
    """Whether a character lies across a surface, and so passes it; any other chain it meets."""
    s = walk.shapes[row]
    if s.role != PART:
        return False
    b = walk.bodies[s.body_row]
    count, radius = place_outline(walk, me, left, top)
    # In what stands it was free before it moved: what is deeper came from elsewhere, or dropped.
    most = walk.settings.slop
    if b.kind == KINEMATIC:
        most = deepest_on(walk, b)
        # What goes down comes no nearer to who stands on it, and does not take up whom it passes.
        most -= max(0.0, b.vy * math.cos(b.angle) - b.vx * math.sin(b.angle)) * walk.settings.dt
    return lies_across(
        walk.geometry, s.geometry, b.x, b.y, b.angle, walk.scratch.mine, count, radius, most, walk.scratch.theirs
    )


@subkernel
def in_chain(walk, me, row, left, top, way_x, way_y, give):
    """(FREE, STEEP, ON_SLOPE or BLOCKED, slope) of a character in a chain: see solids.in_shape."""
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if is_across(walk, me, row, c.left, c.top):
        return FREE, 0.0
    links = walk.geometry.links
    span = walk.geometry.chains[s.geometry]
    low_x, low_y, high_x, high_y = box_in_body(
        float(left),
        float(top),
        float(left + c.width),
        float(top + c.height),
        b.x,
        b.y,
        math.cos(b.angle),
        math.sin(b.angle),
    )
    count, radius = place_outline(walk, me, left, top)
    result = FREE
    slope = 0.0
    for block in range(span.blocks):
        box = walk.geometry.link_blocks[span.first_block + block]
        if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, low_x, low_y, high_x, high_y):
            continue
        for k in range(span.offset + block * BLOCK_LINKS, span.offset + min(span.count, (block + 1) * BLOCK_LINKS)):
            link = links[k]
            if misses_box(link.ax, link.ay, link.bx, link.by, low_x, low_y, high_x, high_y):
                continue
            depth, nx, ny = link_depth(walk, row, k, c.drop, count, radius)
            allowed = allowed_depth(c, b.kind == KINEMATIC, nx, ny, give, walk.settings.slop)
            # Open from its back, a link blocks only what leads deeper, like something that moves.
            what, rise = judge(c, KINEMATIC, depth - allowed, nx, ny, way_x, way_y)
            if what == BLOCKED:
                return BLOCKED, 0.0
            if what != FREE and what >= result:
                result = what
                slope = rise
    return result, slope


@subkernel
def deepest_link(walk, me, row, left, top):
    """(depth [px], normal from the character) in the link of a chain that a character is deepest in."""
    c = walk.characters[me]
    span = walk.geometry.chains[walk.shapes[row].geometry]
    if is_across(walk, me, row, left, top):
        return 0.0, 0.0, 0.0
    count, radius = place_outline(walk, me, left, top)
    deepest = 0.0
    best_x = 0.0
    best_y = 0.0
    for k in range(span.offset, span.offset + span.count):
        depth, nx, ny = link_depth(walk, row, k, c.drop, count, radius)
        if depth > deepest:
            deepest = depth
            best_x = nx
            best_y = ny
    return deepest, best_x, best_y
