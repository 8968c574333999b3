"""What a place is to a character: free, ground that it walks or slides down, or a wall.

One rule for all grounds: the normal where the character would stand in the ground, against the steepest that it walks.
"""

import math

from physics.jit import subkernel
from physics.tables.body import DYNAMIC, STATIC

FREE, STEEP, ON_SLOPE, BLOCKED = 0, 1, 2, 3  # in the order of what counts most where several are met
GIVE = 2.0  # [px] what is carried or pressed may sink this deep into loose bodies: the solver moves them on
FEET = 0.5  # [px] feet stand on the whole pixel nearest to a surface that moves
LEADS_DEEPER = 0.02  # cosine between a way and a normal from which the way leads into a body that is pushed
SHEER = 1e-9  # cosine between a wall's normal and down below which it bears nothing
EVEN = 1e-9  # by how much rounding may make a slope steeper
STEEPEST_CLIMB = 16.0  # [px] rise per px along (86 degrees): steeper ground is never walked, so a pixel costs few tests


@subkernel
def pixels_along(slope):
    """The most whole pixels that a surface of a slope rises or falls on one pixel along."""
    return math.floor(abs(slope) + 1.0 + 1e-6)


@subkernel
def is_walkable(c, nx, ny):
    """Whether ground can be walked; (nx, ny): unit normal into it."""
    return ny > SHEER and abs(nx) <= c.climb * ny + EVEN


@subkernel
def verdict(c, nx, ny):
    """(what ground is to a character that is in it, rise per px to the right); (nx, ny): unit, into the ground."""
    if ny <= SHEER:
        return BLOCKED, 0.0
    slope = nx / ny + 0.0
    return ON_SLOPE if is_walkable(c, nx, ny) else STEEP, slope


@subkernel
def allowed_depth(c, loose, nx, ny, give, slop):
    """How deep [px] a character may be in a surface. give [px]: more of that in what is loose, see solids.is_loose."""
    if not loose:
        return slop
    return give + (FEET if is_walkable(c, nx, ny) else 0.1 * slop)


@subkernel
def deepest_of(b, slop, dt):
    """How deep [px] a character may have come into an outline: by a pixel, or as far as that moved into it.

    What is deeper behind an edge of one part is told by a neighbour, see hulls.collide_hulls.
    """
    if b.kind == STATIC:
        return 1.0 + 2.0 * slop
    return 1.0 + 2.0 * slop + GIVE + (abs(b.vx) + abs(b.vy) + abs(b.angular_velocity) * b.extent) * dt


@subkernel
def judge(c, kind, beyond, nx, ny, way_x, way_y):
    """As `verdict`, for a surface that the character is in by so much more than allowed [px].

    kind: of its body. What moves may have come into the character by itself: it blocks only a way that leads deeper.
    """
    if beyond <= 0.0:
        return FREE, 0.0
    if kind != STATIC and nx * way_x + ny * way_y <= (LEADS_DEEPER if kind == DYNAMIC else EVEN):
        return FREE, 0.0
    return verdict(c, nx, ny)
