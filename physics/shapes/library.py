"""The corners, tiles and pixels of all shapes of a world, in flat arrays that kernels read.

A shape that is used by a thousand bodies stands here once. Masks are added per angle as they come up. What no shape
uses any longer stays until it may be half of all; then what is used is put into a library of its own.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import chain
from typing import NamedTuple

import numpy as np

from physics.fitting.hull import mask_hull
from physics.raster.bits import halo, packed
from physics.raster.pieces import TILE
from physics.raster.rotate import bucket_of
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.kinds import Shape
from physics.shapes.lines import Chain, Segment
from physics.shapes.mask import PixelMask
from physics.shapes.outline_tiles import is_tiled
from physics.shapes.tiles import TileGrid
from physics.tables.geometry import (
    BLOCK_LINKS,
    CELL,
    CHAIN_SPAN,
    CORNER,
    EMPTY,
    GRID,
    LINK,
    LINK_BLOCK,
    ONE_WAY,
    RASTER,
    SLOPE,
    SOLID,
    SPAN,
    Geometry,
)
from physics.tables.shape import BOUNDS, CAPSULE, CHAIN, CIRCLE, MASK, POLYGON, SEGMENT, TILES
from physics.tables.table import Table

SLACK = 1 << 16  # [bytes] of geometry, and …
FEW = 64  # … shapes, that are not worth tidying up for
KIND_OF = {
    Circle: CIRCLE,
    Polygon: POLYGON,
    Capsule: CAPSULE,
    Segment: SEGMENT,
    Chain: CHAIN,
    TileGrid: TILES,
    PixelMask: MASK,
}


class Geometries(NamedTuple):
    """The shapes of a library by kind and row. Lists; shapes never change."""

    outlines: list  # polygons, capsules, segments
    chains: list
    grids: list
    masks: list


class Library:
    """Adds shapes to the flat arrays. The same grid or mask, and equal other shapes, are added once."""

    def __init__(self) -> None:
        self.polygons, self.corners = Table(SPAN), Table(CORNER)
        self.chains, self.links, self.link_blocks = Table(CHAIN_SPAN), Table(LINK), Table(LINK_BLOCK)
        self.grids, self.cells = Table(GRID), Table(CELL)
        self.rasters, self.words = Table(RASTER), Table(np.uint64, 64)
        self.raster_of = np.full((4, MASK_ANGLE_BUCKETS), -1, np.int64)
        self.shapes = {}  # key -> (row, shape); holds the shape, so that an id cannot be given twice
        self.masks, self.tile_grids = [], []
        self.outlines, self.chain_shapes = [], []  # polygons, capsules and segments by their row; chains by theirs
        self.gone = 0  # shape rows dropped since it was made
        self.least = 0  # [bytes] when it was made
        self.tables = self._tables()

    @property
    def grown(self) -> tuple[Table, ...]:
        """The tables that every shape adds to."""
        return (
            self.polygons,
            self.corners,
            self.chains,
            self.links,
            self.link_blocks,
            self.grids,
            self.cells,
            self.rasters,
            self.words,
        )

    @property
    def size(self) -> int:
        """[bytes] in use."""
        return sum(table.count * table.data.itemsize for table in self.grown)

    def may_be_half_unused(self, shapes: int) -> bool:
        """Whether more was dropped than the shapes that are left, or more was added than there was."""
        return self.gone > shapes + (FEW if shapes else 0) or self.size > 2 * self.least + SLACK

    def without_unused(self, shapes: np.ndarray) -> "Library":
        """A library of what these SHAPE rows use; their columns `geometry` and `raster` are set to its rows."""
        fresh = Library()
        kinds = np.where(shapes["kind"] == BOUNDS, shapes["wrapped"], shapes["kind"])
        rasters = np.zeros(self.rasters.count + 1, np.int64)
        for of, known in (
            ((POLYGON, CAPSULE, SEGMENT), self.outlines),
            ((CHAIN,), self.chain_shapes),
            ((TILES,), self.tile_grids),
            ((MASK,), self.masks),
        ):
            mine = np.flatnonzero(np.isin(kinds, of))
            used, which = np.unique(shapes["geometry"][mine], return_inverse=True)
            if known is self.outlines:
                rows = fresh._add_known_hulls(self, used)
            else:
                rows = np.array([fresh.add(known[row])[1] for row in used.tolist()], np.int64)
            shapes["geometry"][mine] = rows[which]
            if known is self.masks:
                for old, new in zip(used.tolist(), rows.tolist(), strict=True):
                    for bucket in np.flatnonzero(self.raster_of[old] >= 0).tolist():
                        if fresh.raster_of[new, bucket] < 0:
                            fresh.add_raster(new, bucket)
                        rasters[self.raster_of[old, bucket]] = fresh.raster_of[new, bucket]
        # What was drawn for a question is gone with it (visited): who asks next has it drawn anew.
        shapes["raster"] = rasters[np.minimum(shapes["raster"], self.rasters.count)]
        fresh.least = fresh.size
        return fresh

    def _tables(self):
        return Geometry(
            self.polygons.data,
            self.corners.data,
            self.chains.data,
            self.links.data,
            self.link_blocks.data,
            self.grids.data,
            self.cells.data,
            self.rasters.data,
            self.words.data,
            self.raster_of,
        )

    def add(self, shape: Shape) -> tuple[int, int, int]:
        """(kind, geometry row, kind inside a Bounds) of a shape."""
        if isinstance(shape, Bounds):
            kind, row, _ = self.add(shape.shape)
            return BOUNDS, row, kind
        if isinstance(shape, Circle):
            return CIRCLE, -1, -1
        shape = shape.bare
        key = id(shape) if isinstance(shape, (TileGrid, PixelMask)) else shape
        if key not in self.shapes:
            add = {TileGrid: self._add_grid, PixelMask: self._add_mask, Chain: self._add_chain}.get(
                type(shape), self._add_hull
            )
            self.shapes[key] = (add(shape), shape)
            self.tables = self._tables()
        return KIND_OF[type(shape)], self.shapes[key][0], -1

    def _add_hull(self, shape):
        return self._add_hulls([shape])[0]

    def _add_hulls(self, shapes):
        counts = np.array([len(each.points) for each in shapes], np.int64)
        rows = np.arange(self.polygons.count, self.polygons.count + len(shapes))
        spans = self.polygons.append(len(shapes))
        spans["offset"], spans["count"] = self.corners.count + np.cumsum(counts) - counts, counts
        points = chain.from_iterable(chain.from_iterable(each.points for each in shapes))
        self.corners.append(int(counts.sum()))[:] = np.fromiter(points, np.float64).view(CORNER)
        self.outlines += shapes
        return rows

    def _add_known_hulls(self, library, rows):
        """Those in some rows of another library: all at once, and looked for later on if they were there."""
        new = self._add_hulls([library.outlines[row] for row in rows.tolist()])
        place = dict(zip(rows.tolist(), new.tolist(), strict=True))
        for key, (row, shape) in library.shapes.items():
            if isinstance(shape, (Polygon, Capsule, Segment)) and row in place:
                self.shapes[key] = (place[row], shape)
        self.tables = self._tables()
        return new

    def _add_chain(self, shape):
        row, count = self.chains.count, shape.links
        blocks = -(-count // BLOCK_LINKS)
        self.chains.append()[:] = (self.links.count, count, self.link_blocks.count, blocks)
        a = np.array(shape.points)
        b = np.roll(a, -1, axis=0)[:count]
        # Neighbours: the listed ones, round the loop, or the ghosts at the ends of an open chain.
        before, after = np.roll(a, 1, axis=0)[:count], np.roll(a, -2, axis=0)[:count]
        links = self.links.append(count)
        links["has_before"] = links["has_after"] = links["last_owned"] = True
        if not shape.loop:
            ghosts = shape.ghosts or (None, None)
            links["has_before"][0], links["has_after"][-1] = (each is not None for each in ghosts)
            links["first_owned"][0] = True
            before[0] = a[0] if ghosts[0] is None else ghosts[0]
            after[-1] = b[-1] if ghosts[1] is None else ghosts[1]
        for name, points in (("a", a[:count]), ("b", b), ("before_", before), ("after_", after)):
            links[name + "x"], links[name + "y"] = points.T
        for name, as_shape in (
            ("friction", -1.0),
            ("restitution", -1.0),
            ("rolling_resistance", -1.0),
            ("surface_speed", np.nan),
        ):
            links[name] = as_shape if shape.materials is None else [getattr(each, name) for each in shape.materials]
        for block, box in enumerate(self.link_blocks.append(blocks)):
            part = slice(block * BLOCK_LINKS, (block + 1) * BLOCK_LINKS)
            ends = np.concatenate([a[:count][part], b[part]])
            box["min_x"], box["min_y"] = ends.min(axis=0)
            box["max_x"], box["max_y"] = ends.max(axis=0)
        self.chain_shapes.append(shape)
        return row

    def _add_grid(self, shape):
        row = self.grids.count
        rows, columns = shape.solid.shape
        self.grids.append()[:] = (self.cells.count, rows, columns, shape.tile_size)
        cells = self.cells.append(rows * columns)
        kind = np.where(shape.solid, SOLID, np.where(shape.one_way, ONE_WAY, EMPTY))
        cells["kind"] = np.where((shape.slopes > 0).any(axis=2), SLOPE, kind).ravel()
        cells["left"], cells["right"] = shape.slopes.reshape(-1, 2).T
        kinds = cells["kind"].reshape(rows, columns)
        first = np.tile(np.arange(columns), (rows, 1))
        last = first.copy()
        merges = np.isin(kinds, (SOLID, ONE_WAY))
        joined = merges[:, 1:] & (kinds[:, 1:] == kinds[:, :-1])
        for column in range(1, columns):
            first[:, column] = np.where(joined[:, column - 1], first[:, column - 1], column)
            last[:, -1 - column] = np.where(joined[:, -column], last[:, -column], columns - 1 - column)
        cells["first"], cells["last"] = first.ravel(), last.ravel()
        self.tile_grids.append(shape)
        return row

    def _add_mask(self, shape):
        self.masks.append(shape)
        row = len(self.masks) - 1
        if row >= len(self.raster_of):
            self.raster_of = np.concatenate([self.raster_of, np.full_like(self.raster_of, -1)])
        self.add_raster(row, 0)
        return row

    def add_parts(self, shapes: Sequence[Circle | Capsule | Polygon | Chain]) -> np.ndarray:
        """(n, 3): what `add` tells. Convex shapes are new: they are not looked for among those there."""
        kinds = [KIND_OF[type(shape)] for shape in shapes]
        if CHAIN in kinds:
            return np.array([self.add(shape) for shape in shapes], np.int64)
        found = np.full((len(shapes), 3), -1)
        found[:, 0] = kinds
        hulls = [k for k, kind in enumerate(kinds) if kind != CIRCLE]
        if hulls:
            found[hulls, 1] = self._add_hulls([shapes[k] for k in hulls])
            self.tables = self._tables()
        return found

    @classmethod
    def of(cls, shapes: Geometries) -> "Library":
        """With these shapes in these rows."""
        library = cls()
        library.add_parts(shapes.outlines)
        for row, shape in reversed([*enumerate(shapes.outlines)]):
            library.shapes[shape] = (row, shape)
        for shape in (*shapes.chains, *shapes.grids, *shapes.masks):
            library.add(shape)
        return library

    def replace(self, old: Shape, new: PixelMask, changed: Sequence[int] | None, shapes: np.ndarray) -> int:
        """The row of a mask that takes the place of another in one of the SHAPE rows.

        changed: the tiles in which they differ, None: any. Of a large mask that no other row has only these are
        written, and its hull stays: turned, its box may be larger than what is left. O(words that change), or as add.
        """
        row = self.shapes[id(old)][0]
        users = (shapes["kind"] == MASK) & (shapes["geometry"] == row)
        if changed is None or not is_tiled(new) or id(new) in self.shapes or users.sum() > 1 or not new.snap:
            return self.add(new)[1]
        del self.shapes[id(old)]
        self.shapes[id(new)] = (row, new)
        self.masks[row] = new
        self.raster_of[row, 1:] = -1
        raster = self.rasters.data[self.raster_of[row, 0]]
        stride, rows, left = int(raster["stride"]), new.size[1], int(raster["offset"])
        words = self.words.data[left : left + rows * stride].reshape(rows, stride)
        for tile in changed:
            line, column = divmod(tile, new.tiles.columns)
            part = words[line * TILE : (line + 1) * TILE, column]
            part[:] = new.tiles.words[tile][: len(part)]
        bounds = new.solid_box or (1, 1, 0, 0)
        for name, value in zip(("set_left", "set_top", "set_right", "set_bottom"), bounds, strict=True):
            raster[name] = value
        raster["area"] = new.area
        return row

    def _add_exact(self, shape):
        """What the exact test of a mask that is not snapped, and its tight box, read at the angle 0:
        (halo, its stride, hull, corners)."""
        hull = _hull_of(shape)
        around = np.zeros((0, 0), np.uint64) if shape.snap else halo(shape.solid)
        first = -1 if shape.snap else self.words.count, around.shape[1], self.corners.count, len(hull)
        self.words.append(around.size)[:] = around.ravel()
        corners = self.corners.append(len(hull))
        corners["x"], corners["y"] = hull.T
        return first

    def add_raster(self, mask: int, bucket: int) -> None:
        """Add a mask at an angle bucket: turned from its source, once."""
        shape = self.masks[mask]
        words, (width, height), origin, box = _drawn(shape, bucket)
        self.raster_of[mask, bucket] = self.rasters.count
        exact = self._add_exact(shape) if bucket == 0 else (-1, 0, 0, 0)
        self.rasters.append()[:] = (
            *(
                self.words.count,
                width,
                height,
                words.shape[1],
                *origin,
                *(box or (1, 1, 0, 0)),
                int(np.bitwise_count(words).sum()),
            ),
            *exact,
        )
        self.words.append(words.size)[:] = words.ravel()
        self.tables = self._tables()

    def shapes_by_row(self) -> Geometries:
        """Its shapes. Added in this order to another library they get the same rows there."""
        return Geometries([*self.outlines], [*self.chain_shapes], [*self.tile_grids], [*self.masks])

    def shape_of(self, row: np.void) -> Shape:
        """The shape that a SHAPE row stands for."""
        kind = int(row["kind"])
        inner = int(row["wrapped"]) if kind == BOUNDS else kind
        if inner == CIRCLE:
            shape = Circle(float(row["radius"]), (float(row["local_x"]), float(row["local_y"])))
        else:
            shape = {TILES: self.tile_grids, MASK: self.masks, CHAIN: self.chain_shapes}.get(inner, self.outlines)[
                int(row["geometry"])
            ]
        return Bounds(shape) if kind == BOUNDS else shape

    @contextmanager
    def visited(self) -> Iterator[None]:
        """Whatever is added inside the with block is taken out again at its end: shapes that only ask a question."""
        kept = [(table, table.count) for table in self.grown]
        lists = [(each, len(each)) for each in (self.masks, self.tile_grids, self.outlines, self.chain_shapes)]
        known = len(self.shapes)
        try:
            yield
        finally:
            for key in list(self.shapes)[known:]:
                del self.shapes[key]
            for table, count in kept:
                table.count = count
            for each, count in lists:
                del each[count:]
            self.raster_of[self.raster_of >= self.rasters.count] = -1
            self.tables = self._tables()

    def raster(self, mask: int, angle: float) -> np.void:
        """The raster of a mask at an angle, added where it is missing."""
        bucket = bucket_of(angle, MASK_ANGLE_BUCKETS)
        if self.raster_of[mask, bucket] < 0:
            self.add_raster(mask, bucket)
        return self.rasters.data[int(self.raster_of[mask, bucket])]


def _drawn(shape, bucket):
    """(words, size, origin, box of the solid pixels or None) of a mask at an angle bucket; at 0 as it is."""
    if bucket == 0:
        return shape.words, shape.size, shape.origin, shape.solid_box
    turned = shape.turned_to(bucket)
    rows, columns = np.nonzero(turned.solid)
    box = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1) if len(rows) else None
    return packed(turned.solid), turned.solid.shape[::-1], turned.origin, box


def _hull_of(shape):
    """Corners of a mask's hull; of a large one's box: that is known without a look at its pixels."""
    if shape.area and is_tiled(shape) and shape.snap:
        left, top, right, bottom = shape.bounds
        return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    return mask_hull(shape) if shape.area else np.zeros((0, 2))
