"""The slope of a mask's surface: a line over the outer corners of its staircase of pixels.

Of a straight edge drawn in pixels that line has the edge's own slope where the pattern of the staircase repeats within
half the columns that are looked at, and one within 0.03 rad of it elsewhere: the sides of the hull of a digital line
are fractions near its slope (Klette and Rosenfeld, Digital straightness, 2004).
"""

import math

from physics.character.workspace import COLUMNS
from physics.jit import subkernel
from physics.raster.bits import is_set
from physics.shapes.placement import raster_at, snapped

HIGHEST_STEP = 4  # [px] between two columns of one surface: what rises higher is a wall


@subkernel
def is_solid(geometry, raster, column, line):
    """Whether a pixel of a raster is solid; beside the raster none is."""
    r = geometry.rasters[raster]
    if column < 0 or column >= r.width or line < 0 or line >= r.height:
        return False
    return is_set(geometry.words, r.offset + line * r.stride, column)


@subkernel
def surface_near(geometry, raster, column, line):
    """The row of the topmost solid pixel of a column, near that of the column beside it; -1: a step too far."""
    at = line
    if is_solid(geometry, raster, column, at):
        while is_solid(geometry, raster, column, at - 1):
            at -= 1
            if line - at > HIGHEST_STEP:
                return -1
        return at
    while not is_solid(geometry, raster, column, at):
        at += 1
        if at - line > HIGHEST_STEP:
            return -1
    return at


@subkernel
def trace_surface(geometry, raster, column, line, surface_out):
    """Write the rows of the surface around a column to surface_out (COLUMNS,), -1 where it ends; is there one?"""
    middle = COLUMNS // 2
    for k in range(COLUMNS):
        surface_out[k] = -1
    at = surface_near(geometry, raster, column, line)
    if at < 0:
        return False
    surface_out[middle] = at
    for side in range(-1, 2, 2):
        before = at
        for k in range(1, middle + 1):
            found = surface_near(geometry, raster, column + side * k, before)
            if found < 0:
                break
            surface_out[middle + side * k] = found
            before = found
    return True


@subkernel
def corner_row(surface, at):
    """The pixel row of the surface at the border before a column: the higher of its two columns; -1 where it ends."""
    before = surface[at - 1] if at > 0 else -1
    after = surface[at] if at < COLUMNS else -1
    if before < 0 or after < 0:
        return max(before, after)
    return min(before, after)


@subkernel
def slope_over(surface):
    """The slope, positive up to the right, of the line that lies on a surface's corners, over its middle column."""
    middle = COLUMNS // 2
    best = math.inf
    slope = 0.0
    for first in range(middle + 1):
        left = corner_row(surface, first)
        if left < 0:
            continue
        for last in range(middle + 1, COLUMNS + 1):
            right = corner_row(surface, last)
            if right < 0:
                break
            run = float(last - first)
            if run > 0.0:
                height = left + (right - left) * (middle + 0.5 - first) / run
                if height < best:
                    best = height
                    slope = (left - right) / run
    return slope


@subkernel
def mask_slope(walk, row, x, y):
    """(slope of a mask's surface at a point [px] just within it, whether there is a surface and no wall)."""
    b = walk.bodies[walk.shapes[row].body_row]
    geometry = walk.geometry
    raster = raster_at(geometry, walk.shapes[row].geometry, b.angle)
    r = geometry.rasters[raster]
    column = math.floor(x) - snapped(b.x, r.origin_x)
    line = math.floor(y) - snapped(b.y, r.origin_y)
    if not trace_surface(geometry, raster, column, line, walk.scratch.surface):
        return 0.0, False
    return slope_over(walk.scratch.surface), True
