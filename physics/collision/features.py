"""Feature ids: by what a point of a manifold is known again in the next step.

A feature is a whole number that says which edge, corner, tile, link or pixel met which. It is the same in the next step
as long as the same parts meet, whatever the poses; a point that finds its feature among those of the step before goes
on with its impulses. One layout for all colliders:

    hulls, a face     ((edge * 16 + corner) * 2 + side) * 2 + flipped           0 .. 1023
    hulls, a support  (edge * 16 + corner) * 4 + flipped                        0 .. 1023
    hulls, corners    CORNERS + corner of A * 16 + corner of B               2048 .. 2303
    a link's open end OPEN_END + end                                         3000 .. 3001
    a disc            the edge, or CIRCLE_CORNER + corner                       0 .. 47
    tiles, links      the number of the run or link * PART + one of the above
    masks             the pixel: row * width + column
"""

from physics.jit import subkernel

CIRCLE_CORNER = 32  # a disc on a corner, + its number
CORNERS = 2048  # two corners of hulls, + i * 16 + j
OPEN_END = 3000  # the face across an open end of a chain, + 0 at a or 1 at b
PART = 4096  # features of one tile run or one link


@subkernel
def clipped_feature(edge, corner, side, flipped):
    """A point clipped against a face: reference edge, incident corner, which end, 1 where the face is B's."""
    return ((edge * 16 + corner) * 2 + side) * 2 + flipped


@subkernel
def support_feature(edge, corner, flipped):
    """The deepest corner under a face."""
    return (edge * 16 + corner) * 4 + flipped


@subkernel
def corners_feature(i, j):
    """A corner of A against a corner of B."""
    return CORNERS + i * 16 + j


@subkernel
def part_feature(part, feature):
    """A feature of one run of tiles, or of one link."""
    return part * PART + feature


@subkernel
def part_of(feature):
    """The run of tiles, or the link, that a feature belongs to."""
    return feature // PART


@subkernel
def pixel_feature(row, column, width):
    """A pixel of a mask."""
    return row * width + column
