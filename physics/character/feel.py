"""What a character touches after a move: ground, its slope, what carries it and how fast its surface runs, walls."""

import math

from physics.character.climb import is_wedged, steep_below
from physics.character.ground import BLOCKED, FREE, STEEP
from physics.character.solids import blocked_at
from physics.character.tiles import on_pixels
from physics.dynamics.quarantine import LARGEST
from physics.jit import subkernel
from physics.tables.body import STATIC
from physics.tables.geometry import SLOPE
from physics.tables.shape import CHAIN, TILES


@subkernel
def tile_slope(walk, row, x, y):
    """Rise per px to the right of the slope tile at a point [px] of a tile grid, 0 elsewhere."""
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    g = walk.geometry.grids[s.geometry]
    column = math.floor((x - on_pixels(b.kind, b.x)) / g.tile_size)
    line = math.floor((y - on_pixels(b.kind, b.y)) / g.tile_size)
    if not (0 <= column < g.columns and 0 <= line < g.rows):
        return 0.0
    cell = walk.geometry.cells[g.offset + line * g.columns + column]
    return cell.right - cell.left if cell.kind == SLOPE else 0.0


@subkernel
def slope_under_box(walk, me, row):
    """The slope of the tile under the middle of a box's feet; at its ends a foot beside it still stands on it."""
    c = walk.characters[me]
    bottom = c.top + c.height + 0.5
    slope = tile_slope(walk, row, c.left + 0.5 * c.width, bottom)
    if slope == 0.0:
        slope = tile_slope(walk, row, c.left + 0.5, bottom)
    if slope == 0.0:
        slope = tile_slope(walk, row, c.left + c.width - 0.5, bottom)
    return slope


@subkernel
def speed_under(walk, row, x, y):
    """Speed [px/s] at which a surface runs to the right under a point [px] that stands on it.

    Source: engines' conveyor materials (Box2D's tangent speed): along the tangent, to the right on a floor.
    """
    s = walk.shapes[row]
    if s.kind != CHAIN:
        return s.surface_speed
    b = walk.bodies[s.body_row]
    cosine = math.cos(b.angle)
    sine = math.sin(b.angle)
    span = walk.geometry.chains[s.geometry]
    nearest = math.inf
    speed = s.surface_speed
    for k in range(span.offset, span.offset + span.count):
        link = walk.geometry.links[k]
        ax = b.x + cosine * link.ax - sine * link.ay
        ay = b.y + sine * link.ax + cosine * link.ay
        bx = b.x + cosine * link.bx - sine * link.by
        by = b.y + sine * link.bx + cosine * link.by
        if ax <= x < bx:
            off = abs(ay + (by - ay) * (x - ax) / (bx - ax) - y)
            if off < nearest:
                nearest = off
                speed = link.surface_speed if link.friction >= 0.0 else s.surface_speed
    return speed


@subkernel
def feel_ground(me, walk_inout):
    """Write whether a character stands, on what, and how that slopes and runs."""
    c = walk_inout.characters[me]
    what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left, c.top + 1, 0, 1, 0.0)
    was_grounded = c.grounded
    c.grounded = what != FREE and (what != STEEP or is_wedged(walk_inout, me, walk_inout.found, slope))
    c.riding = -1
    c.riding_shape = -1
    c.belt = 0.0
    if what == FREE:
        # Sliding, it is above its ground for a moment, by less than that goes down on one pixel along.
        sliding = abs(c.slope) >= 1.0 and not was_grounded
        c.slope = steep_below(walk_inout, me, walk_inout.found, c.slope) if sliding else 0.0
        return
    c.slope = slope
    s = walk_inout.shapes[by]
    belt = speed_under(walk_inout, by, c.left + 0.5 * c.width, float(c.top + c.height))
    c.belt = belt if abs(belt) < LARGEST else 0.0  # whose surface runs at no speed is put aside by the next step
    if s.kind == TILES and c.is_box:
        c.slope = slope_under_box(walk_inout, me, by)
    if walk_inout.bodies[s.body_row].kind != STATIC:
        c.riding = s.body
        c.riding_shape = s.id


@subkernel
def feel(me, walk_inout):
    """Write what a character touches; walk_inout.found: what is near it."""
    c = walk_inout.characters[me]
    feel_ground(me, walk_inout)
    c.wall = 0
    for side in range(-1, 2, 2):
        what, by, slope = blocked_at(walk_inout, me, walk_inout.found, c.left + side, c.top, side, 0, 0.0)
        if (what == BLOCKED or what == STEEP) and c.wall == 0:
            c.wall = side
