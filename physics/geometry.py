"""The corners, tiles and pixels of all shapes of a world, in flat arrays that kernels read.

A shape that is used by a thousand bodies stands here once. Masks are added per angle as they come up.
"""

from typing import NamedTuple

import numpy as np

from physics import tables
from physics.masks.rotate import bucket_of
from physics.settings import MASK_ANGLE_BUCKETS
from physics.shapes import Bounds, Circle, PixelMask, Polygon, TileGrid, packed
from physics.tables import GRID, RASTER, Table

SPAN = np.dtype([("offset", np.int64), ("count", np.int64)])
CORNER = np.dtype([("x", np.float64), ("y", np.float64)])
CELL = np.dtype([("kind", np.int64), ("left", np.float64), ("right", np.float64)])


class Geometry(NamedTuple):
    """What kernels read of the shapes' geometry."""
    polygons: np.ndarray        # SPAN of corners
    corners: np.ndarray         # CORNER [px] body space, clockwise on the screen
    grids: np.ndarray           # GRID
    cells: np.ndarray           # CELL: kind, surface heights of a slope as fractions
    rasters: np.ndarray         # RASTER
    words: np.ndarray           # uint64 pixels of all rasters
    raster_of: np.ndarray       # (masks, buckets) raster row, -1 where not drawn at that angle yet


class Library:
    """Adds shapes to the flat arrays. The same shape object, and equal polygons, are added once."""

    def __init__(self):
        self.polygons, self.corners = Table(SPAN), Table(CORNER)
        self.grids, self.cells = Table(GRID), Table(CELL)
        self.rasters, self.words = Table(RASTER), Table(np.uint64, 64)
        self.raster_of = np.full((4, MASK_ANGLE_BUCKETS), -1, np.int64)
        self.shapes = {}            # key -> (row, shape); holds the shape, so that an id cannot be given twice
        self.masks, self.tile_grids, self.outlines = [], [], []
        self.tables = self._tables()

    def _tables(self):
        return Geometry(self.polygons.data, self.corners.data, self.grids.data, self.cells.data, self.rasters.data,
                        self.words.data, self.raster_of)

    def add(self, shape) -> tuple[int, int, int]:
        """(kind, geometry row, kind inside a Bounds) of a shape."""
        if isinstance(shape, Bounds):
            kind, row, _ = self.add(shape.shape)
            return tables.BOUNDS, row, kind
        if isinstance(shape, Circle):
            return tables.CIRCLE, -1, -1
        key = shape if isinstance(shape, Polygon) else id(shape)
        if key not in self.shapes:
            add = {Polygon: self._add_polygon, TileGrid: self._add_grid, PixelMask: self._add_mask}[type(shape)]
            self.shapes[key] = (add(shape), shape)
            self.tables = self._tables()
        kind = {Polygon: tables.POLYGON, TileGrid: tables.TILES, PixelMask: tables.MASK}[type(shape)]
        return kind, self.shapes[key][0], -1

    def _add_polygon(self, shape):
        row = self.polygons.count
        self.polygons.append()[:] = (self.corners.count, len(shape.points))
        self.corners.append(len(shape.points))[:] = list(shape.points)
        self.outlines.append(shape)
        return row

    def _add_grid(self, shape):
        row = self.grids.count
        rows, columns = shape.solid.shape
        self.grids.append()[:] = (self.cells.count, rows, columns, shape.tile_size)
        cells = self.cells.append(rows * columns)
        kind = np.where(shape.solid, tables.SOLID, np.where(shape.one_way, tables.ONE_WAY, tables.EMPTY))
        cells["kind"] = np.where((shape.slopes > 0).any(axis=2), tables.SLOPE, kind).ravel()
        cells["left"], cells["right"] = shape.slopes.reshape(-1, 2).T
        self.tile_grids.append(shape)
        return row

    def _add_mask(self, shape):
        self.masks.append(shape)
        row = len(self.masks) - 1
        if row >= len(self.raster_of):
            self.raster_of = np.concatenate([self.raster_of, np.full_like(self.raster_of, -1)])
        self.add_raster(row, 0)
        return row

    def add_raster(self, mask: int, bucket: int):
        """Add a mask at an angle bucket: turned from its source, once."""
        shape = self.masks[mask]
        turned = shape.turned_to(bucket)
        words = shape.words if bucket == 0 else packed(turned.solid)
        rows, columns = np.nonzero(turned.solid)
        bounds = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1) if len(rows) else (1, 1, 0, 0)
        height, width = turned.solid.shape
        self.raster_of[mask, bucket] = self.rasters.count
        self.rasters.append()[:] = (self.words.count, width, height, words.shape[1], *turned.origin, *bounds, len(rows))
        self.words.append(words.size)[:] = words.ravel()
        self.tables = self._tables()

    def shape_of(self, row) -> object:
        """The shape that a SHAPE row stands for."""
        kind = int(row["kind"])
        inner = int(row["wrapped"]) if kind == tables.BOUNDS else kind
        if inner == tables.CIRCLE:
            shape = Circle(float(row["radius"]), (float(row["local_x"]), float(row["local_y"])))
        else:
            shape = {tables.POLYGON: self.outlines, tables.TILES: self.tile_grids,
                     tables.MASK: self.masks}[inner][int(row["geometry"])]
        return Bounds(shape) if kind == tables.BOUNDS else shape

    def raster(self, mask: int, angle: float) -> np.void:
        """The raster of a mask at an angle, added where it is missing."""
        bucket = bucket_of(angle, MASK_ANGLE_BUCKETS)
        if self.raster_of[mask, bucket] < 0:
            self.add_raster(mask, bucket)
        return self.rasters.data[self.raster_of[mask, bucket]]
