"""Areas [px2] that a mask shares with the shapes it touches.

The solver does not use these areas, so they are computed only when the user reads the contacts.
"""

import math

import numpy as np

from physics.collision.chains import BACKING, link_at
from physics.collision.hulls import ALL_EDGES, Hull, part_of
from physics.collision.manifold import by_parent, copy_manifold
from physics.collision.masks import offset_line
from physics.collision.masks_exact import collide_mask_part, collide_mask_shape, exact_mask_area
from physics.collision.narrow_phase import no_work
from physics.collision.tiles import tile_at
from physics.jit import kernel, subkernel
from physics.raster.bits import shared_area
from physics.shapes.library import draw_masks
from physics.tables.geometry import SLOPE
from physics.tables.shape import CHAIN, MASK, PIXELS, TILES
from physics.tables.step_state import WorldTables
from physics.tables.table import rows_of


@subkernel
def outline_of_part(geometry, bodies, shapes, row, part, workspace):
    """Write the outline of one part of a tile grid or chain to workspace.b. Return the number of corners.

    The corners are in world coordinates [px]. row: row number in SHAPE of the grid or chain. part: index of a link, or
    of the first cell of a run. A run is adjacent equal tiles in a row, treated as one rectangle. A link has no area, so
    it is widened to a rectangle of thickness BACKING.
    """
    s = shapes[row]
    b = bodies[s.body_row]
    if s.kind == CHAIN:
        link = geometry.chains[s.geometry].offset + part
        link_at(geometry.links, link, b.x, b.y, math.cos(b.angle), math.sin(b.angle), workspace.a)
        offset_line(workspace.a, 0.0, BACKING, workspace.b)
        return 4
    g = geometry.grids[s.geometry]
    cell = geometry.cells[g.offset + part]
    line = part // g.columns if g.columns > 0 else 0
    column = part - line * g.columns
    count, edges = tile_at(geometry, s.geometry, b.x, b.y, line, column, workspace.b)
    if cell.kind != SLOPE:
        # A run extends to its last tile.
        workspace.b[1, 0] += (cell.last - column) * g.tile_size
        workspace.b[2, 0] += (cell.last - column) * g.tile_size
    return count


@subkernel
def area_in_part(geometry, bodies, shapes, mask, other, part, workspace):
    """Return the area [px2] that a mask shares with one part of a tile grid or chain.

    mask: row number in SHAPE of the mask; other: row number in SHAPE of the grid or chain; part: index of a link, or of
    the first cell of a run of tiles (see outline_of_part); workspace: scratch memory.
    """
    count = outline_of_part(geometry, bodies, shapes, other, part, workspace)
    s = shapes[mask]
    body = bodies[s.body_row]
    hull = Hull(workspace.b, count, 0.0, ALL_EDGES)
    return collide_mask_part(geometry, body, s, hull, workspace.a, workspace.depths)[0]


@kernel
def count_areas(geometry, bodies, shapes, workspace, manifolds_inout):
    """Recompute area_1 and area_2 [px2], at the present poses, of every CONTACT row whose area_1 is not 0.

    The rows are updated in place. area_2 is written only for the second point of a contact with tiles or a chain.
    O(shared pixels). workspace: scratch memory.
    """
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        if m.area_1 == 0.0:
            continue
        a, b = shapes[m.row_a], shapes[m.row_b]
        if a.kind == MASK and b.kind == MASK and not (a.snap and b.snap):
            m.area_1 = exact_mask_area(geometry, bodies, a, b)
            continue
        if a.kind == MASK and b.kind == MASK:
            m.area_1 = float(
                shared_area(geometry.rasters, geometry.words, a.raster, b.raster, b.left - a.left, b.top - a.top)
            )
            continue
        mask = m.row_a if a.kind == MASK else m.row_b
        other = m.row_b if a.kind == MASK else m.row_a
        if shapes[other].kind == CHAIN or shapes[other].kind == TILES:
            m.area_1 = area_in_part(geometry, bodies, shapes, mask, other, part_of(m.feature_1), workspace)
            if m.count == 2:
                m.area_2 = area_in_part(geometry, bodies, shapes, mask, other, part_of(m.feature_2), workspace)
        else:
            m.area_1 = collide_mask_shape(geometry, bodies, shapes, mask, other, workspace)[0]


def with_areas(tables: WorldTables, manifolds: np.ndarray) -> np.ndarray:
    """Return the CONTACT rows with the areas [px2] that their two shapes share at the present poses.

    The rows name whole shapes, not the parts that touch. The area is 0 if neither shape is a mask, or if no pixels
    overlap. Each point of a contact has the area that the whole shapes share. Against tiles and chains, each point has
    only the area in the run of tiles or link that it touches. Without contact response, a step only tests whether two
    masks overlap. In this case the function also computes point, normal and depth of pairs of masks. tables: a World or
    StepState.
    """
    whole, _ = by_parent(manifolds)
    shapes = tables.shapes
    if not tables.library.masks or not len(whole):
        return whole
    if not tables.effects.response:
        return _in_full(tables, whole) if tables.effects.narrowphase else whole
    row_a, row_b = rows_of(shapes, whole["parent_a"]), rows_of(shapes, whole["parent_b"])
    masked = ((shapes["role"][row_a] == PIXELS) | (shapes["role"][row_b] == PIXELS)) & (row_a >= 0) & (row_b >= 0)
    some = whole[masked]
    if not len(some):
        return whole
    some["row_a"], some["row_b"], some["area_1"] = row_a[masked], row_b[masked], 1.0
    draw_masks(tables.library, np.union1d(row_a[masked], row_b[masked]), tables.bodies, shapes)
    count_areas(tables.library.tables, tables.bodies, shapes, tables.workspace.narrow.workspace, some)
    standing = np.isin(shapes["kind"], (CHAIN, TILES))
    alike = ~(standing[some["row_a"]] | standing[some["row_b"]])
    some["area_2"][alike] = some["area_1"][alike]
    found = whole.copy()
    found["area_1"][masked], found["area_2"][masked] = some["area_1"], some["area_2"]
    return found


@kernel
def put_back(full, places, manifolds_out):
    """Copy each CONTACT row of `full` over the row of the same candidate pair in manifolds_out.

    places (pairs,): row number in manifolds_out of each candidate pair, indexed by the column `candidate` of `full`.
    """
    for i in range(len(full)):
        copy_manifold(full, i, places[full[i].candidate], manifolds_out)


def _in_full(tables, manifolds):
    """Compute the contacts of pairs of masks again, with point, normal and depth at the present poses. Return all rows.

    Only masks that still overlap are updated; all other CONTACT rows are returned unchanged.
    """
    shapes = tables.shapes
    row_a, row_b = (_rows(shapes, manifolds, side) for side in "ab")
    masks = (row_a >= 0) & (row_b >= 0) & (shapes["kind"][row_a] == MASK) & (shapes["kind"][row_b] == MASK)
    if not masks.any():
        return manifolds
    pairs = np.stack([row_a, row_b], axis=1)[masks].astype(np.int64)
    full = tables.workspace.telling.collide(tables.library, tables.bodies, shapes, pairs, 0.0, no_work())
    found = manifolds.copy()
    put_back(full, np.flatnonzero(masks), found)
    return found


def _rows(shapes, manifolds, side):
    """Return the present SHAPE row number of each contact's shape A or B; -1 for a removed shape.

    manifolds: CONTACT rows; side: "a" or "b". The row numbers that the step stored are used, unless shapes were added
    or removed since the step.
    """
    rows, ids = np.minimum(manifolds["row_" + side], len(shapes) - 1), manifolds["shape_" + side]
    return rows if np.array_equal(shapes["id"][rows], ids) else rows_of(shapes, ids)
