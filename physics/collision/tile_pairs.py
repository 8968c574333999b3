"""The pass over the candidate pairs with a tile grid, run by run: like cells next to each other are one rectangle."""

import math
from collections.abc import Callable

from physics.collision.clipping import ALL_EDGES
from physics.collision.features import part_feature, part_of
from physics.collision.hulls import collide_hull_circle, collide_hulls
from physics.collision.manifold import GRID_ANY, add_point, add_points, circle_at, corners_of
from physics.collision.mask_exact import meet_polygon
from physics.collision.tiles import edges_facing, run_at, tile_at
from physics.jit import kernel, subkernel
from physics.shapes.mask_pose import box_as_tested
from physics.shapes.placement import polygon_at, rounding
from physics.tables.counters import MASK_TESTS
from physics.tables.geometry import EMPTY, ONE_WAY, SLOPE
from physics.tables.shape import BOUNDS, CIRCLE, MASK, TILES


@subkernel
def stood_on(workspace, pair, run):
    """Whether the step before had a contact of this candidate with this run of tiles."""
    if pair >= len(workspace.memory):
        return False
    first = workspace.memory[pair, 0]
    for k in range(first, first + workspace.memory[pair, 1]):
        if k >= len(workspace.previous):
            return False
        m = workspace.previous[k]
        if part_of(m.feature_1) == run or (m.count == 2 and part_of(m.feature_2) == run):
            return True
    return False


def make_grid_pass(one_way: bool) -> Callable:
    """The pass over pairs of a tile grid and anything else; one-way tiles only where the effect is declared."""

    @kernel
    def collide_grid_pairs(
        # read
        batch,
        # write
        workspace,
        manifolds_out,
        found,
        work_inout,
    ):
        """Contacts of all pairs with a tile grid, run by run, appended at `found`. Returns the new count."""
        geometry = batch.geometry
        bodies = batch.bodies
        shapes = batch.shapes
        candidates = batch.candidates
        kinds = batch.kinds
        margin = batch.margin
        grids = geometry.grids
        cells = geometry.cells
        polygons = geometry.polygons
        table = geometry.corners
        for i in range(batch.count):
            if kinds[i] != GRID_ANY:
                continue
            sign = 1.0 if shapes[candidates[i, 0]].kind == TILES else -1.0
            row = candidates[i, 0] if sign > 0.0 else candidates[i, 1]
            other = candidates[i, 1] if sign > 0.0 else candidates[i, 0]
            s = shapes[row]
            o = shapes[other]
            p = bodies[s.body_row]
            q = bodies[o.body_row]
            g = grids[s.geometry]
            min_x = o.min_x
            min_y = o.min_y
            max_x = o.max_x
            max_y = o.max_y
            if o.kind == MASK:
                min_x, min_y, max_x, max_y = box_as_tested(geometry, o)
            first_column = max(0, math.ceil((min_x - margin - p.x) / g.tile_size) - 1)
            last_column = min(g.columns - 1, math.floor((max_x + margin - p.x) / g.tile_size))
            first_row = max(0, math.ceil((min_y - margin - p.y) / g.tile_size) - 1)
            last_row = min(g.rows - 1, math.floor((max_y + margin - p.y) / g.tile_size))
            n = 0
            cx = 0.0
            cy = 0.0
            radius = 0.0
            if o.kind == MASK:
                work_inout[MASK_TESTS] += 1
            elif o.kind == CIRCLE:
                cx, cy, radius = circle_at(bodies, shapes, other)
            else:
                if o.kind == BOUNDS:
                    n = corners_of(geometry, bodies, shapes, other, workspace.b)
                else:
                    n = polygon_at(
                        polygons, table, o.geometry, q.x, q.y, math.cos(q.angle), math.sin(q.angle), workspace.b
                    )
                radius = rounding(shapes, other)
            # Columns that it overlaps, not only touches.
            low = math.floor((min_x - p.x) / g.tile_size)
            high = math.ceil((max_x - p.x) / g.tile_size) - 1
            was_above = max_y - (q.y - q.previous_y) + (p.y - p.previous_y)
            start = found
            seen = 0
            for attempt in range(2):
                # What lies deep inside may be left to a neighbour by each of them: once more, by every edge.
                if attempt == 1 and (seen == 0 or found > start):
                    break
                deepest = 0.5 * g.tile_size if attempt == 0 else math.inf
                for tile_row in range(first_row, last_row + 1):
                    next_column = first_column
                    while next_column <= last_column:
                        tile_column = next_column
                        cell = cells[g.offset + tile_row * g.columns + tile_column]
                        kind = cell.kind
                        next_column = cell.last + 1
                        if kind == EMPTY or (kind == ONE_WAY and not one_way):
                            continue
                        # Open from below: only what came from above the tile, or stood on it, stands on it.
                        if kind == ONE_WAY and (
                            attempt == 1
                            or (
                                was_above > p.y + tile_row * g.tile_size + margin
                                and not stood_on(workspace, i, tile_row * g.columns + cell.first)
                            )
                        ):
                            continue
                        if kind == SLOPE:
                            corners, edges = tile_at(geometry, s.geometry, p.x, p.y, tile_row, tile_column, workspace.a)
                        else:
                            corners, edges = run_at(
                                grids, cells, s.geometry, p.x, p.y, tile_row, tile_column, low, high, workspace.a
                            )
                        seen += 1
                        edges = edges if attempt == 0 else ALL_EDGES
                        feature = part_feature(tile_row * g.columns + cell.first, 0)
                        if o.kind == MASK:
                            area, nx, ny, x, y, separation, which = meet_polygon(
                                geometry, q, o, workspace.a, corners, edges, workspace.b, workspace.depths
                            )
                            if area > 0.0:
                                found = add_point(
                                    shapes,
                                    candidates,
                                    i,
                                    found,
                                    -sign * nx,
                                    -sign * ny,
                                    x,
                                    y,
                                    separation,
                                    area,
                                    feature,
                                    manifolds_out,
                                )
                        elif o.kind == CIRCLE:
                            hit, nx, ny, x, y, separation, which = collide_hull_circle(
                                workspace.a, corners, edges, 0.0, cx, cy, radius
                            )
                            if hit and separation <= margin:
                                found = add_point(
                                    shapes,
                                    candidates,
                                    i,
                                    found,
                                    sign * nx,
                                    sign * ny,
                                    x,
                                    y,
                                    separation,
                                    0.0,
                                    feature + which,
                                    manifolds_out,
                                )
                        else:
                            manifold = workspace.points
                            facing = edges_facing(workspace.b, n, edges) if corners == 4 else ALL_EDGES
                            points = collide_hulls(
                                workspace.a,
                                corners,
                                0.0,
                                edges,
                                workspace.b,
                                n,
                                radius,
                                facing,
                                margin,
                                batch.bias,
                                deepest,
                                manifold,
                            )
                            found = add_points(
                                shapes, candidates, i, found, sign, manifold, points, feature, manifolds_out
                            )
        return found

    return collide_grid_pairs


collide_grid_pairs_one_way = make_grid_pass(one_way=True)
collide_grid_pairs_closed = make_grid_pass(one_way=False)
