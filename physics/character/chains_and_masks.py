"""Chains and masks under a character: link by link, and by the pixels' surface."""

import math

from physics.character.ground import BLOCKED, EVEN, FREE, ON_SLOPE, STEEP, allowed_depth, judge, pixels_along
from physics.character.meet import meet_link, meet_mask, place_outline
from physics.character.surface import mask_slope
from physics.collision.chain_pairs import box_in_body, misses_box
from physics.collision.chains import link_at
from physics.jit import subkernel
from physics.tables.body import KINEMATIC
from physics.tables.geometry import BLOCK_LINKS

ROUNDED = 1e-9  # of its size: by how much a character that touches pixels may seem to be in them


@subkernel
def link_depth(walk, row, link, drops, count, radius):
    """(depth [px], normal from the character) of scratch.mine in a link of a chain that holds it, else depth 0.

    A character moves by pixels and starts free, so what is deeper than that in a link came from its back, and passes;
    so does what drops through a level link.
    """
    b = walk.bodies[walk.shapes[row].body_row]
    scratch = walk.scratch
    link_at(walk.geometry.links, link, b.x, b.y, math.cos(b.angle), math.sin(b.angle), scratch.theirs)
    run = scratch.theirs[1, 0] - scratch.theirs[0, 0]
    rise = scratch.theirs[1, 1] - scratch.theirs[0, 1]
    if drops and run > 0.0 and abs(rise) <= 1e-9 * run:
        return 0.0, 0.0, 0.0
    most = 1.0 + 2.0 * walk.settings.slop
    if b.kind == KINEMATIC:
        most += 1.0 + (abs(b.vx) + abs(b.vy) + abs(b.angular_velocity) * b.extent) * walk.settings.dt
    depth, nx, ny, x, y = meet_link(walk.geometry.links, link, scratch, count, radius)
    return depth if depth <= most else 0.0, nx, ny


@subkernel
def in_chain(walk, me, row, left, top, way_x, way_y, give):
    """(FREE, STEEP, ON_SLOPE or BLOCKED, slope) of a character in a chain: see solids.in_shape."""
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
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


@subkernel
def depth_in_mask(walk, me, row, left, top):
    """As meet_mask, for a character, its box at a pixel. What it merely touches is not met, however it was rounded."""
    count, radius = place_outline(walk, me, left, top)
    c = walk.characters[me]
    if not c.is_box:
        corners = walk.scratch.mine
        for k in range(count):
            corners[k, 0] -= ROUNDED * (corners[k, 0] - (left + 0.5 * c.width))
            corners[k, 1] -= ROUNDED * (corners[k, 1] - (top + 0.5 * c.height))
        radius -= ROUNDED * radius
    return meet_mask(walk, row, count, radius)


@subkernel
def is_in_mask(walk, me, row, left, top):
    """Whether a character, its box at a pixel, shares pixels with a mask, as drawn."""
    depth, nx, ny, x, y = depth_in_mask(walk, me, row, left, top)
    return depth > 0.0


@subkernel
def in_mask(walk, me, row, left, top, way_x, way_y):
    """As in_chain, for a mask that does not turn: the slope is that of its surface around the pixels that are shared.

    A step of its staircase is ground where it is no higher than the slope rises on one pixel; else it is a wall.
    """
    c = walk.characters[me]
    depth, nx, ny, x, y = depth_in_mask(walk, me, row, left, top)
    if depth <= 0.0:
        return FREE, 0.0
    slope, is_ground = mask_slope(walk, row, x, y)
    if not is_ground:
        return BLOCKED, 0.0
    if abs(slope) > c.climb + EVEN:
        return STEEP, slope
    if way_x == 0:
        return ON_SLOPE, slope
    for lift in range(1, pixels_along(abs(slope) + 0.5) + 1):
        if not is_in_mask(walk, me, row, left, top - lift):
            return ON_SLOPE, slope
    return BLOCKED, 0.0
