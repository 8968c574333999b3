"""The pixels that the masks of known manifolds share with the other side: counted anew where the bodies ended."""

import math

from physics.collision.chain_pairs import BACKING
from physics.collision.chains import link_at
from physics.collision.clipping import ALL_EDGES
from physics.collision.features import part_of
from physics.collision.manifold import circle_at, corners_of
from physics.collision.mask_hulls import collide_mask_circle, collide_mask_line, collide_mask_polygon, thick_line
from physics.collision.mask_rounded import collide_mask_rounded
from physics.collision.tiles import tile_at
from physics.jit import kernel, subkernel
from physics.raster.overlap import shared_area
from physics.shapes.placement import rounding
from physics.tables.geometry import SLOPE
from physics.tables.shape import CHAIN, CIRCLE, MASK, TILES


@subkernel
def outline_of_part(geometry, bodies, shapes, row, part, workspace):
    """Write the corners [px] of a run of tiles, or of a link with its backing, to workspace.b. Returns their number."""
    s = shapes[row]
    b = bodies[s.body_row]
    if s.kind == CHAIN:
        link = geometry.chains[s.geometry].offset + part
        link_at(geometry.links, link, b.x, b.y, math.cos(b.angle), math.sin(b.angle), workspace.a)
        thick_line(workspace.a, 0.0, BACKING, workspace.b)
        return 4
    g = geometry.grids[s.geometry]
    cell = geometry.cells[g.offset + part]
    line = part // g.columns if g.columns > 0 else 0
    column = part - line * g.columns
    count, edges = tile_at(geometry, s.geometry, b.x, b.y, line, column, workspace.b)
    if cell.kind != SLOPE:
        # A run: as far as its last tile.
        workspace.b[1, 0] += (cell.last - column) * g.tile_size
        workspace.b[2, 0] += (cell.last - column) * g.tile_size
    return count


@subkernel
def area_in_hull(geometry, mask, count, radius, workspace):
    """The pixels [px2] of a MASK, a row of SHAPE, in the hull of workspace.b, of so many corners and rounding [px]."""
    rasters = geometry.rasters
    words = geometry.words
    if radius > 0.0:
        return collide_mask_rounded(rasters, words, mask.raster, mask.left, mask.top, workspace.b, count, radius)[0]
    if count == 2:
        return collide_mask_line(rasters, words, mask.raster, mask.left, mask.top, workspace.b, workspace.depths)[0]
    return collide_mask_polygon(
        rasters, words, mask.raster, mask.left, mask.top, workspace.b, count, ALL_EDGES, workspace.depths
    )[0]


@kernel
def count_areas(
    # read
    geometry,
    bodies,
    shapes,
    # write
    workspace,
    manifolds_inout,
):
    """Write the area [px2] of every manifold that had one, at the present poses and drawings. O(pixels shared)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        if m.area_1 == 0.0:
            continue
        a = shapes[m.row_a]
        b = shapes[m.row_b]
        if a.kind == MASK and b.kind == MASK:
            m.area_1 = float(
                shared_area(geometry.rasters, geometry.words, a.raster, b.raster, b.left - a.left, b.top - a.top)
            )
            continue
        mask = a if a.kind == MASK else b
        other = m.row_b if a.kind == MASK else m.row_a
        kind = shapes[other].kind
        if kind == CIRCLE:
            x, y, radius = circle_at(bodies, shapes, other)
            m.area_1 = float(
                collide_mask_circle(geometry.rasters, geometry.words, mask.raster, mask.left, mask.top, x, y, radius)[0]
            )
        elif kind == CHAIN or kind == TILES:
            count = outline_of_part(geometry, bodies, shapes, other, part_of(m.feature_1), workspace)
            m.area_1 = float(area_in_hull(geometry, mask, count, 0.0, workspace))
            if m.count == 2:
                count = outline_of_part(geometry, bodies, shapes, other, part_of(m.feature_2), workspace)
                m.area_2 = float(area_in_hull(geometry, mask, count, 0.0, workspace))
        else:
            count = corners_of(geometry, bodies, shapes, other, workspace.b)
            m.area_1 = float(area_in_hull(geometry, mask, count, rounding(shapes, other), workspace))
